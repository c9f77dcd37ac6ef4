//! The crate's WGSL in a fragment shader: `cargo run --release -p npr-hatch --features wgpu --example wgpu_hatch --
//! sphere.ppm` hatches a sphere by three planes, with the six tones of a tonal art map in two textures.

use npr_hatch::upload::{hatch_sampler, upload_tam};
use npr_hatch::{LOOKUP_WGSL, TamParameters, WGSL, draw};
use wgpu::*;

/// Width and height in pixels. Rows of 2048 bytes, a multiple of 256, need no padding in buffer copies.
const SIZE: u32 = 512;
const FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;
/// A sphere with a radius of 230 pixels, seen along -Z by an orthographic camera. Its radius is 1.5 tiles of the map.
const SHADER: &str = "
    @group(0) @binding(0) var light: texture_2d<f32>;
    @group(0) @binding(1) var dark: texture_2d<f32>;
    @group(0) @binding(2) var trilinear: sampler;
    @vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
        return vec4(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
    }
    @fragment fn fs(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
        let p = (pixel.xy - 256.0) * vec2(1.0, -1.0) / 230.0;
        let normal = vec3(p, sqrt(max(1.0 - dot(p, p), 0.0)));
        let tone = mix(0.1, 1.0, saturate(dot(normal, normalize(vec3(-0.5, 0.7, 0.6)))));
        let at = normal * 1.5;
        let at_dx = dpdx(at);
        let at_dy = dpdy(at);
        let texels = f32(textureDimensions(light).x);
        let last_level = f32(textureNumLevels(light) - 1u);
        // Where planes overlap, each gets a lighter tone, and the results are multiplied.
        let shares = hatch_plane_weights(normal);
        var paper = 1.0;
        for (var axis = 0u; axis < 3u; axis++) {
            let footprint =
                hatch_footprint(hatch_plane(at_dx, axis), hatch_plane(at_dy, axis), texels, last_level);
            let share_of_tone = hatch_share_tone(tone, shares[axis]);
            let weights = hatch_weights(hatch_level_of_tone(LIGHT_TONES, DARK_TONES, share_of_tone));
            let found = hatch_texels(light, dark, trilinear, hatch_plane(at, axis), footprint);
            let strokes = hatch_blend(found.light, found.dark, weights);
            let flat_tone = hatch_blend(LIGHT_TONES, DARK_TONES, weights);
            let left = mix(strokes, flat_tone, hatch_flat_weight(footprint.level, last_level));
            paper *= select(1.0, left, shares[axis] > 0.0);
        }
        let color = hatch_color(paper, vec3(0.98, 0.97, 0.94), vec3(0.12, 0.1, 0.2));
        return vec4(mix(vec3(0.95), color, saturate((1.0 - length(p)) * 230.0 + 0.5)), 1.0);
    }";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let instance = Instance::new(InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
    let tam = draw(&TamParameters::default(), None)?.tam;
    let map = upload_tam(&device, &queue, &tam, Default::default())?;
    // The libraries are prepended to the shader.
    let [a, b, c, d, e, f] = tam.tones[..] else { return Err("the map has six tones".into()) };
    let tones =
        format!("const LIGHT_TONES = vec3<f32>({a}, {b}, {c});\nconst DARK_TONES = vec3<f32>({d}, {e}, {f});\n");
    let source = ShaderSource::Wgsl(format!("{WGSL}{LOOKUP_WGSL}{tones}{SHADER}").into());
    let module = &device.create_shader_module(ShaderModuleDescriptor { label: None, source });
    let targets = &[Some(FORMAT.into())];
    let compilation_options = PipelineCompilationOptions::default();
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: VertexState { module, entry_point: None, compilation_options: Default::default(), buffers: &[] },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(FragmentState { module, entry_point: None, compilation_options, targets }),
        multiview_mask: None,
        cache: None,
    });
    let [light, dark] = [&map.light, &map.dark].map(|tones| tones.create_view(&Default::default()));
    let sampler = hatch_sampler(&device);
    let entries = &[
        BindGroupEntry { binding: 0, resource: BindingResource::TextureView(&light) },
        BindGroupEntry { binding: 1, resource: BindingResource::TextureView(&dark) },
        BindGroupEntry { binding: 2, resource: BindingResource::Sampler(&sampler) },
    ];
    let layout = &pipeline.get_bind_group_layout(0);
    let group = device.create_bind_group(&BindGroupDescriptor { label: None, layout, entries });

    let picture = device.create_texture(&TextureDescriptor {
        label: None,
        size: Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: FORMAT,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let (size, usage) = (u64::from(4 * SIZE * SIZE), BufferUsages::COPY_DST | BufferUsages::MAP_READ);
    let copy = device.create_buffer(&BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
    let mut encoder = device.create_command_encoder(&Default::default());
    let (view, ops) = (&picture.create_view(&Default::default()), Default::default());
    let target = RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops };
    let targets = &[Some(target)];
    let mut pass =
        encoder.begin_render_pass(&RenderPassDescriptor { color_attachments: targets, ..Default::default() });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    drop(pass);
    let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE), rows_per_image: None };
    let whole = TexelCopyBufferInfo { buffer: &copy, layout };
    encoder.copy_texture_to_buffer(picture.as_image_copy(), whole, picture.size());
    queue.submit([encoder.finish()]);
    copy.map_async(MapMode::Read, .., |mapped| mapped.expect("a buffer for reading can be mapped"));
    device.poll(PollType::wait_indefinitely())?;

    let mut ppm = format!("P6 {SIZE} {SIZE} 255\n").into_bytes();
    copy.get_mapped_range(..)?.chunks(4).for_each(|rgba| ppm.extend_from_slice(&rgba[..3]));
    Ok(std::fs::write(std::env::args().nth(1).unwrap_or_else(|| "sphere.ppm".into()), ppm)?)
}

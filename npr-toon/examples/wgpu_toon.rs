//! The crate's WGSL in a fragment shader: `cargo run -p npr-toon --example wgpu_toon -- sphere.ppm`.

use npr_toon::{Bands, TOON_BANDS_OVERRIDE, ToonUniform, WGSL};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::*;

/// Width and height in pixels. Rows of 2048 bytes, a multiple of 256, need no padding in buffer copies.
const SIZE: u32 = 512;
const FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;
/// A sphere with a radius of 230 pixels, seen along -Z by an orthographic camera.
const SHADER: &str = "
    @group(0) @binding(0) var<uniform> u_bands: ToonBands;
    @vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
        return vec4(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
    }
    @fragment fn fs(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
        let p = (at.xy - 256.0) * vec2(1.0, -1.0) / 230.0;
        let normal = vec3(p, sqrt(max(1.0 - dot(p, p), 0.0)));
        let n_dot_l = toon_n_dot_l(normal, vec3(-0.5, 0.7, 0.6));
        let n_dot_h = toon_n_dot_h(normal, vec3(-0.5, 0.7, 0.6), vec3(0.0, 0.0, 1.0));
        let nl_width = toon_pixel_border_width(n_dot_l);
        let nh_width = toon_pixel_border_width(n_dot_h);
        let color = toon_shade(u_bands, vec3(0.93, 0.45, 0.25), n_dot_l, nl_width, n_dot_h, nh_width);
        return vec4(mix(vec3(0.95), color, saturate((1.0 - length(p)) * 230.0 + 0.5)), 1.0);
    }";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let instance = Instance::new(InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
    // The library is prepended to the shader. The override is the number of bands, so that the loop over them is unrolled.
    let source = ShaderSource::Wgsl(format!("{WGSL}{SHADER}").into());
    let module = &device.create_shader_module(ShaderModuleDescriptor { label: None, source });
    let bands = Bands::default();
    let uniform = ToonUniform::new(&bands)?;
    let contents = bytemuck::bytes_of(&uniform);
    let uniform = BufferInitDescriptor { label: None, contents, usage: BufferUsages::UNIFORM };
    let uniform = device.create_buffer_init(&uniform);
    let constants = &[(TOON_BANDS_OVERRIDE, bands.tones.len() as f64)];
    let compilation_options = PipelineCompilationOptions { constants, ..Default::default() };
    let targets = &[Some(FORMAT.into())];
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
    let entries = &[BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }];
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

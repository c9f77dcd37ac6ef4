//! The crate's WGSL in a fragment shader: `cargo run -p npr-gooch --example wgpu_gooch -- sphere.ppm`.

use npr_gooch::{Gooch, GoochUniform, WGSL};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::*;

/// Width and height in pixels. Rows of 2048 bytes, a multiple of 256, need no padding in buffer copies.
const SIZE: u32 = 512;
const FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;
/// A sphere with a radius of 230 pixels, seen along -Z by an orthographic camera.
const SHADER: &str = "
    @group(0) @binding(0) var<uniform> u_model: GoochModel;
    @vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
        return vec4(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
    }
    @fragment fn fs(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
        let p = (at.xy - 256.0) * vec2(1.0, -1.0) / 230.0;
        let normal = vec3(p, sqrt(max(1.0 - dot(p, p), 0.0)));
        // The light is nearly perpendicular to the view, so that the full tone range is visible.
        let color = gooch_shade(u_model, vec3(0.85, 0.35, 0.3), normal, vec3(-0.7, 0.7, 0.3), vec3(0.0, 0.0, 1.0));
        return vec4(mix(vec3(0.95), color, saturate((1.0 - length(p)) * 230.0 + 0.5)), 1.0);
    }";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let instance = Instance::new(InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
    // The library is prepended to the shader.
    let source = ShaderSource::Wgsl(format!("{WGSL}{SHADER}").into());
    let module = &device.create_shader_module(ShaderModuleDescriptor { label: None, source });
    let uniform = GoochUniform::new(&Gooch::default())?;
    let contents = bytemuck::bytes_of(&uniform);
    let uniform = BufferInitDescriptor { label: None, contents, usage: BufferUsages::UNIFORM };
    let uniform = device.create_buffer_init(&uniform);
    let compilation_options = PipelineCompilationOptions::default();
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

//! Checks of npr-toon: widths that need derivatives and therefore a fragment shader.

use crate::check::SMALL;
use glam::{DVec2, Vec4};
use npr_toon::border::toon_border_width;
use npr_toon::toon_width;

/// The picture's side. Every block of 2 × 2 pixels, in which derivatives are taken, has its own slope.
const SIDE: u32 = 256;

/// The slopes are computed, not loaded: pixels at a triangle's edge take derivatives from neighbours outside it, for
/// which some drivers do not execute loads.
const SHADER: &str = "
    @vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
        return vec4(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
    }
    @fragment fn fs(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
        let block = floor(at.xy / 2.0);
        // No slope in the first column, then from flat to steep to the right, and from rising to equally falling
        // downwards.
        let along_x = select(pow(10.0, block.x / 16.0 - 6.0), 0.0, block.x == 0.0);
        let slope = along_x * vec2(1.0, block.y / 64.0 - 1.0);
        let x = dot(slope, at.xy - 2.0 * block);
        return vec4(toon_pixel_width(x), toon_pixel_border_width(x), slope);
    }";

pub fn calls() -> Vec<&'static str> {
    vec![SHADER]
}

#[test]
fn pixel_widths_are_those_of_the_derivatives() {
    let Some(gpu) = crate::device() else { return };
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(format!("{}{SHADER}", npr_toon::WGSL).into()),
    });
    let format = wgpu::TextureFormat::Rgba32Float;
    let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs"),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let picture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIDE, height: SIDE, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let row = SIDE * size_of::<Vec4>() as u32;
    let copy = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row * SIDE),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &picture.create_view(&Default::default()),
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations::default(),
        })],
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.draw(0..3, 0..1);
    drop(pass);
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    let whole = wgpu::TexelCopyBufferInfo { buffer: &copy, layout };
    encoder.copy_texture_to_buffer(picture.as_image_copy(), whole, picture.size());
    gpu.queue.submit([encoder.finish()]);
    copy.map_async(wgpu::MapMode::Read, .., |result| result.expect("a buffer for reading can be mapped"));
    gpu.wait().expect("the shader compiles and runs");
    let mapped = copy.get_mapped_range(..).expect("it is mapped");
    let found: &[Vec4] = bytemuck::cast_slice(&mapped);

    let mut most = DVec2::ZERO;
    for found in found {
        let [width, border, along_x, along_y] = found.as_dvec4().to_array();
        let expected = DVec2::new(toon_width(along_x, along_y), toon_border_width(along_x, along_y));
        let apart = (DVec2::new(width, border) - expected).abs() / expected.max(DVec2::splat(1e-300));
        most = most.max(apart);
    }
    println!(
        "toon_pixel_width {:.1e}, toon_pixel_border_width {:.1e}, relative, {} pixels",
        most.x,
        most.y,
        found.len()
    );
    assert!(most.max_element() <= SMALL, "{most}");
}

//! Regions as packed texels have room for them.

use crate::device::{Gpu, gpu, view};
use npr_imagespace::format::FORMAT_WGSL;
use npr_imagespace::format::texel::ink_fold_region;
use wgpu::TextureFormat;

/// Each region folded to one 32-bit word's numbers and to 64 bits'.
fn folded(gpu: &Gpu, regions: &[u32]) -> Vec<[u32; 2]> {
    let size = [regions.len() as u32, 1];
    let source = format!(
        "{FORMAT_WGSL}
        @group(0) @binding(0) var regions: texture_2d<u32>;
        @vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {{
            return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
        }}
        @fragment fn fs(@builtin(position) p: vec4<f32>) -> @location(0) vec4<u32> {{
            let region = textureLoad(regions, vec2<i32>(p.xy), 0).x;
            let narrow = ink_fold_region(region, INK_TEXEL32_REGION_MAX);
            return vec4<u32>(narrow, ink_fold_region(region, INK_TEXEL64_REGION_MAX), 0u, 0u);
        }}"
    );
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
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
            targets: &[Some(TextureFormat::Rg32Uint.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let from = view(&gpu.upload(TextureFormat::R32Uint, size, bytemuck::cast_slice(regions)));
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&from) }],
    });
    let target = gpu.texture(TextureFormat::Rg32Uint, size);
    gpu.run(|encoder| {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view(&target),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    });
    bytemuck::pod_collect_to_vec(&gpu.read(&target))
}

#[test]
fn regions_are_folded_to_1_up_to_the_largest_and_0_stays_0() {
    let Some(gpu) = gpu() else { return };
    let wide = (1 << 24) - 1;
    for (region, expected) in [
        (0, [0, 0]),
        (1, [1, 1]),
        (254, [254, 254]),
        (255, [255, 255]),
        (256, [1, 256]),
        (510, [255, 510]),
        (511, [1, 511]),
        (wide, [255, wide]),
        (wide + 1, [1, 1]),
        // 2^32 - 1 is 255 times 16843009, and 256 times the largest and 255 more.
        (u32::MAX, [255, 255]),
    ] {
        assert_eq!(folded(gpu, &[region]), [expected], "{region}");
        assert_eq!([ink_fold_region(region, 255), ink_fold_region(region, wide)], expected, "{region}");
    }
}

//! The resolve pass: averages the samples of each pixel.

use super::targets::COLOR_FORMAT;
use std::cell::RefCell;
use std::collections::HashMap;

const RESOLVE_WGSL: &str = include_str!("resolve.wgsl");

/// The pipelines of the pass, created for each number of samples on first use.
#[derive(Default)]
pub(super) struct ResolvePass {
    pipelines: RefCell<HashMap<u32, wgpu::RenderPipeline>>,
}

impl ResolvePass {
    /// Averages `fine` into `picture`; `fine` is `samples` times as large along each axis.
    pub(super) fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        samples: u32,
        fine: &wgpu::TextureView,
        picture: &wgpu::TextureView,
    ) {
        let mut pipelines = self.pipelines.borrow_mut();
        let pipeline = pipelines.entry(samples).or_insert_with(|| pipeline(device, samples));
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("resolve"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(fine) }],
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("resolve"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: picture,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn pipeline(device: &wgpu::Device, samples: u32) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("resolve"),
        source: wgpu::ShaderSource::Wgsl(RESOLVE_WGSL.into()),
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("resolve"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs_resolve"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs_resolve"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &[("resolve_samples", f64::from(samples))],
                ..Default::default()
            },
            targets: &[Some(COLOR_FORMAT.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

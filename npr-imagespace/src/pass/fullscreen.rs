//! What all passes share: a triangle over the target, bindings in a row, and how ink is put out.

use super::{INK_FORMAT, InkTarget, Onto};
use crate::composite::{Composite, CompositeUniform};
use glam::Vec3;
use wgpu::util::DeviceExt;

const FULLSCREEN_WGSL: &str = include_str!("fullscreen.wgsl");

/// What a pass binds after the uniform that says how ink is put out.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bound {
    Uniform,
    /// A texture of whole numbers.
    Whole,
    /// A texture of floats, read texel by texel.
    Float,
}

/// A pipeline that runs a fragment shader over a target.
#[derive(Debug)]
pub(super) struct Fullscreen {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    target: InkTarget,
    label: &'static str,
}

impl Fullscreen {
    /// - `source`: after the library and `fullscreen.wgsl`; its entry point is `label` with `fs_` before it.
    /// - `bound`: what it binds, from binding 1 of group 0 on.
    pub(super) fn new(
        device: &wgpu::Device,
        label: &'static str,
        source: &str,
        bound: &[Bound],
        constants: &[(&str, f64)],
        target: InkTarget,
    ) -> Self {
        let entries: Vec<_> = std::iter::once(&Bound::Uniform)
            .chain(bound)
            .zip(0u32..)
            .map(|(bound, binding)| wgpu::BindGroupLayoutEntry {
                binding,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: binding_type(*bound),
                count: None,
            })
            .collect();
        let layout =
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(label),
            source: wgpu::ShaderSource::Wgsl([crate::WGSL, FULLSCREEN_WGSL, source].concat().into()),
        });
        let (format, blend) = match target {
            InkTarget::Ink => (INK_FORMAT, None),
            InkTarget::Picture(format) => (format, Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING)),
        };
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(label),
            layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            })),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs_fullscreen"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(&format!("fs_{label}")),
                compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
                // A picture's alpha stays.
                targets: &[Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::COLOR })],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { pipeline, layout, target, label }
    }

    /// Runs it. `resources` are those of [`Fullscreen::new`]'s `bound`.
    pub(super) fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        resources: &[wgpu::BindingResource<'_>],
        onto: &Onto<'_>,
    ) {
        let (how, load) = match self.target {
            InkTarget::Ink => {
                (Composite::Over { color: Vec3::ONE, opacity: 1.0 }, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT))
            }
            InkTarget::Picture(_) => (*onto.composite, wgpu::LoadOp::Load),
        };
        let how = uniform(device, bytemuck::bytes_of(&CompositeUniform::from(&how)));
        let entries: Vec<_> = std::iter::once(how.as_entire_binding())
            .chain(resources.iter().cloned())
            .zip(0u32..)
            .map(|(resource, binding)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.label),
            layout: &self.layout,
            entries: &entries,
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(self.label),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: onto.view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        if let Some([x, y, width, height]) = onto.area {
            if width == 0 || height == 0 {
                return;
            }
            pass.set_scissor_rect(x, y, width, height);
        }
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn binding_type(bound: Bound) -> wgpu::BindingType {
    let texture = |sample_type| wgpu::BindingType::Texture {
        sample_type,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    match bound {
        Bound::Uniform => wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        Bound::Whole => texture(wgpu::TextureSampleType::Uint),
        Bound::Float => texture(wgpu::TextureSampleType::Float { filterable: false }),
    }
}

pub(super) fn uniform(device: &wgpu::Device, contents: &[u8]) -> wgpu::Buffer {
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("ink uniform"),
        contents,
        usage: wgpu::BufferUsages::UNIFORM,
    })
}

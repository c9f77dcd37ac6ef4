//! Common parts of the passes: a triangle over the target, consecutive bindings, and how ink is written.

use super::target::{INK_FORMAT, InkTarget, PassTarget, assemble, texture_size_px};
use crate::ImageSpaceError;
use crate::composite::{Composite, CompositeUniform};
use crate::picture::Taps;
use glam::Vec3;

const FULLSCREEN: (&str, &str) = ("pass/fullscreen.wgsl", include_str!("fullscreen.wgsl"));
/// The steps to a filter's taps, whose constants are [`tap_constants`].
pub(super) const TAPS: (&str, &str) = ("pass/taps.wgsl", include_str!("taps.wgsl"));

/// The shader of a pass: the library, the triangle and the pass's own files.
pub(super) fn module_source(files: &[(&str, &str)]) -> String {
    assemble(&[crate::LIBRARY, &[FULLSCREEN], files].concat())
}

/// The pipeline constants of [`TAPS`].
pub(super) fn tap_constants(taps: Taps) -> [(&'static str, f64); 4] {
    let steps = taps.steps().as_dvec4();
    [("step0_x", steps.x), ("step0_y", steps.y), ("step1_x", steps.z), ("step1_y", steps.w)]
}

/// A binding of a pass, after that of the composite uniform.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bound {
    Uniform,
    /// A texture of unsigned integers.
    Whole,
    /// A texture of floats, loaded without filtering.
    Float,
    /// A sampler that does not filter.
    Nearest,
}

/// What a pass writes to its target.
#[derive(Clone, Copy, Debug)]
pub(super) enum Output {
    /// Ink, as ink or composited over a picture.
    Ink(InkTarget),
    /// Intermediate unsigned integers of a format. Outside the area they become 0.
    Whole(wgpu::TextureFormat),
}

/// A pipeline that runs a fragment shader over a target.
#[derive(Debug)]
pub(super) struct Fullscreen {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    output: Output,
    label: &'static str,
}

impl Fullscreen {
    /// - `files`: the pass's own WGSL, names and texts; its entry point is `label` with `fs_` before it.
    /// - `bound`: the bindings, from binding 1 of group 0 on.
    pub(super) fn new(
        device: &wgpu::Device,
        label: &'static str,
        files: &[(&str, &str)],
        bound: &[Bound],
        constants: &[(&str, f64)],
        output: Output,
    ) -> Self {
        let how = matches!(output, Output::Ink(_)).then_some((&Bound::Uniform, 0));
        let entries: Vec<_> = how
            .into_iter()
            .chain(bound.iter().zip(1..))
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
            source: wgpu::ShaderSource::Wgsl(module_source(files).into()),
        });
        // A picture's alpha is not written.
        let (format, blend, write_mask) = match output {
            Output::Ink(InkTarget::Ink) => (INK_FORMAT, None, wgpu::ColorWrites::ALL),
            Output::Ink(InkTarget::Picture(format)) => {
                (format, Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING), wgpu::ColorWrites::COLOR)
            }
            Output::Whole(format) => (format, None, wgpu::ColorWrites::ALL),
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
                targets: &[Some(wgpu::ColorTargetState { format, blend, write_mask })],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { pipeline, layout, output, label }
    }

    /// Refuses a target that the pipeline is not made for. Returns its size, px.
    pub(super) fn check(&self, target: &PassTarget<'_>) -> Result<[u32; 2], ImageSpaceError> {
        match self.output {
            Output::Ink(kind) => target.check(kind),
            Output::Whole(_) => Ok(texture_size_px(target.view)),
        }
    }

    /// The bind group of `resources`, which are those of `bound` in [`Fullscreen::new`]; `composite` is used for
    /// pictures only.
    pub(super) fn group(
        &self,
        device: &wgpu::Device,
        resources: &[wgpu::BindingResource<'_>],
        composite: &Composite,
    ) -> wgpu::BindGroup {
        let how = match self.output {
            Output::Ink(InkTarget::Ink) => Some(Composite::Over { color: Vec3::ONE, opacity: 1.0 }),
            Output::Ink(InkTarget::Picture(_)) => Some(*composite),
            Output::Whole(_) => None,
        };
        let how = how.map(|how| uniform(device, bytemuck::bytes_of(&CompositeUniform::from(&how))));
        let entries: Vec<_> = how
            .iter()
            .map(|how| (how.as_entire_binding(), 0))
            .chain(resources.iter().cloned().zip(1..))
            .map(|(resource, binding)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.label),
            layout: &self.layout,
            entries: &entries,
        })
    }

    /// Draws over `area` of `view`.
    pub(super) fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        group: &wgpu::BindGroup,
        view: &wgpu::TextureView,
        area: Option<[u32; 4]>,
    ) {
        let load = match self.output {
            Output::Ink(InkTarget::Picture(_)) => wgpu::LoadOp::Load,
            _ => wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(self.label),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        if let Some([x, y, width, height]) = area {
            if width == 0 || height == 0 {
                return;
            }
            pass.set_scissor_rect(x, y, width, height);
        }
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }

    /// [`Fullscreen::group`] and [`Fullscreen::draw`].
    pub(super) fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        resources: &[wgpu::BindingResource<'_>],
        target: &PassTarget<'_>,
    ) {
        let group = self.group(device, resources, target.composite);
        self.draw(encoder, &group, target.view, target.area);
    }
}

/// A pipeline constant of type bool.
pub(super) fn flag(name: &str, is: bool) -> (&str, f64) {
    (name, f64::from(u8::from(is)))
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
        Bound::Nearest => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
    }
}

pub(super) fn uniform(device: &wgpu::Device, contents: &[u8]) -> wgpu::Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("ink uniform"),
        // WebGL2 needs uniform sizes that are multiples of 16 bytes.
        size: (contents.len() as u64).next_multiple_of(16),
        usage: wgpu::BufferUsages::UNIFORM,
        mapped_at_creation: true,
    });
    // `DeviceExt::create_buffer_init` panics where the device is lost. Here the buffer is invalid then, and the device
    // reports the error.
    if let Ok(mut mapped) = buffer.get_mapped_range_mut(..) {
        mapped.slice(..contents.len()).copy_from_slice(contents);
        drop(mapped);
        buffer.unmap();
    }
    buffer
}

//! The geometry pass.

use super::scene::{Batch, GpuScene, is_looked_up};
use super::targets::{COLOR_FORMAT, DEPTH_FORMAT, Targets};
use crate::camera::Camera;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::style::{Shade, Style};
use npr_toon::ToonUniform;
use std::cell::RefCell;
use std::collections::HashMap;
use wgpu::util::DeviceExt;

/// `SurfaceView` of `surface.wgsl`.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct SurfaceUniform {
    pub(super) clip_from_world: [[f32; 4]; 4],
    pub(super) to_eye: [f32; 4],
    pub(super) to_eye_dx: [f32; 4],
    pub(super) to_eye_dy: [f32; 4],
    pub(super) to_light: [f32; 4],
}

/// `SurfaceMaterial` of `surface.wgsl`.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct MaterialUniform {
    pub(super) base_color: [f32; 4],
    pub(super) texture_size: [f32; 2],
    pub(super) last_level: f32,
    pub(super) cutoff: f32,
}

/// How a batch's fragments are shaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Paint {
    Depth,
    Lambert,
    Toon,
}

/// What tells one pipeline from another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Variant {
    paint: Paint,
    looked_up: bool,
    cull_back: bool,
    blended: bool,
    /// How many tones.
    bands: u32,
    highlight: bool,
}

/// The pipelines of the geometry pass.
pub(super) struct SurfacePass {
    module: wgpu::ShaderModule,
    view_layout: wgpu::BindGroupLayout,
    material_layout: wgpu::BindGroupLayout,
    layout: wgpu::PipelineLayout,
    pipelines: RefCell<HashMap<Variant, wgpu::RenderPipeline>>,
}

const SURFACE_WGSL: &str = include_str!("surface.wgsl");

/// The whole shader of the pass.
pub(super) fn wgsl() -> String {
    [npr_toon::WGSL, SURFACE_WGSL].concat()
}

impl SurfacePass {
    pub(super) fn new(device: &wgpu::Device) -> Self {
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let uniform = |binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: both,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let fragment = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let layout = |label, entries: &[_]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let view_layout = layout("surface view", &[uniform(0), uniform(1)]);
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let material_layout = layout("surface material", &[uniform(0), fragment(1, texture), fragment(2, sampler)]);
        Self {
            module: device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("surface"),
                source: wgpu::ShaderSource::Wgsl(wgsl().into()),
            }),
            layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("surface"),
                bind_group_layouts: &[Some(&view_layout), Some(&material_layout)],
                immediate_size: 0,
            }),
            view_layout,
            material_layout,
            pipelines: RefCell::default(),
        }
    }

    pub(super) fn material_group(
        &self,
        device: &wgpu::Device,
        uniform: &MaterialUniform,
        texture: &wgpu::TextureView,
        sampler: &wgpu::Sampler,
    ) -> wgpu::BindGroup {
        let uniform = uniform_buffer(device, bytemuck::bytes_of(uniform));
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("material"),
            layout: &self.material_layout,
            entries: &[
                entry(0, uniform.as_entire_binding()),
                entry(1, wgpu::BindingResource::TextureView(texture)),
                entry(2, wgpu::BindingResource::Sampler(sampler)),
            ],
        })
    }

    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own; a struct would only rename them")]
    pub(super) fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        uploaded: &GpuScene,
        scene: &Scene,
        style: &Style,
        plan: &Plan,
        camera: &Camera,
        (uniform, toon_uniform): (&SurfaceUniform, &ToonUniform),
        targets: &Targets,
    ) {
        let (view, toon) = (
            uniform_buffer(device, bytemuck::bytes_of(uniform)),
            uniform_buffer(device, bytemuck::bytes_of(toon_uniform)),
        );
        let view_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("surface view"),
            layout: &self.view_layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: view.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: toon.as_entire_binding() },
            ],
        });
        let paint = match style.shade {
            Shade::Paper => Paint::Depth,
            Shade::Lambert { .. } => Paint::Lambert,
            Shade::Toon(_) => Paint::Toon,
        };
        let blended = if plan.blended { back_to_front(scene, &uploaded.blended_faces, camera) } else { Vec::new() };
        let blended_indices = (!blended.is_empty()).then(|| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("blended faces"),
                contents: bytemuck::cast_slice(
                    &blended.iter().map(|f| scene.model.faces[*f as usize]).collect::<Vec<_>>(),
                ),
                usage: wgpu::BufferUsages::INDEX,
            })
        });
        let paper = style.paper.as_dvec3();
        let clear = wgpu::Color { r: paper.x, g: paper.y, b: paper.z, a: 1.0 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("geometry"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &targets.color_view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth_view,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, &view_group, &[]);
        pass.set_vertex_buffer(0, uploaded.vertices.slice(..));
        if let Some(lookups) = &uploaded.lookups {
            pass.set_vertex_buffer(1, lookups.slice(..));
        }
        let mut draw = |batch: &Batch, blended: bool| {
            let double_sided = scene.model.materials[batch.material].double_sided;
            let variant = Variant {
                paint,
                looked_up: is_looked_up(scene, batch.material) && (paint != Paint::Depth || plan.cut_out),
                cull_back: plan.cull_back || !double_sided,
                blended,
                bands: toon_uniform.count.max(1),
                highlight: toon_uniform.highlight_strength > 0.0,
            };
            let mut pipelines = self.pipelines.borrow_mut();
            let pipeline = pipelines.entry(variant).or_insert_with(|| self.pipeline(device, variant));
            pass.set_pipeline(pipeline);
            pass.set_bind_group(1, &uploaded.materials[batch.material], &[]);
            if let Some(indices) = if blended { blended_indices.as_ref() } else { uploaded.indices.as_ref() } {
                pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(batch.indices.clone(), 0, 0..1);
            }
        };
        for batch in &uploaded.batches {
            draw(batch, false);
        }
        let material_of = |face: &u32| scene.model.face_material[*face as usize];
        let mut start = 0;
        for run in blended.chunk_by(|a, b| material_of(a) == material_of(b)) {
            let end = start + 3 * run.len() as u32;
            draw(&Batch { material: material_of(&run[0]) as usize, indices: start..end }, true);
            start = end;
        }
    }

    fn pipeline(&self, device: &wgpu::Device, variant: Variant) -> wgpu::RenderPipeline {
        let Variant { paint, looked_up, cull_back, blended, bands, highlight } = variant;
        let (vertex, fragment) = match (paint, looked_up) {
            (Paint::Depth, false) => ("vs_depth", None),
            (Paint::Depth, true) => ("vs_textured", Some("fs_cut_out")),
            (Paint::Lambert, false) => ("vs_plain", Some("fs_lambert")),
            (Paint::Lambert, true) => ("vs_textured", Some("fs_lambert_textured")),
            (Paint::Toon, false) => ("vs_plain", Some("fs_toon")),
            (Paint::Toon, true) => ("vs_textured", Some("fs_toon_textured")),
        };
        let geometry = wgpu::VertexBufferLayout {
            array_stride: 24,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3],
        };
        let lookups = wgpu::VertexBufferLayout {
            array_stride: 24,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &wgpu::vertex_attr_array![2 => Float32x2, 3 => Float32x4],
        };
        let buffers = [Some(geometry), Some(lookups)];
        let target = wgpu::ColorTargetState {
            format: COLOR_FORMAT,
            blend: blended.then_some(wgpu::BlendState::ALPHA_BLENDING),
            write_mask: if paint == Paint::Depth {
                wgpu::ColorWrites::empty()
            } else if blended {
                wgpu::ColorWrites::ALL
            } else {
                // A solid surface's alpha is what the clear left: 1.
                wgpu::ColorWrites::COLOR
            },
        };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("surface"),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some(vertex),
                compilation_options: Default::default(),
                buffers: &buffers[..if looked_up { 2 } else { 1 }],
            },
            primitive: wgpu::PrimitiveState { cull_mode: cull_back.then_some(wgpu::Face::Back), ..Default::default() },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(!blended),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                // Without colour nothing but depth is written; the attachment is there all the same.
                entry_point: Some(fragment.unwrap_or("fs_nothing")),
                compilation_options: wgpu::PipelineCompilationOptions {
                    // The loop over bands is unrolled for as many as there are.
                    constants: &[
                        (npr_toon::TOON_BANDS_OVERRIDE, f64::from(bands)),
                        ("surface_highlight", f64::from(u8::from(highlight))),
                    ],
                    ..Default::default()
                },
                targets: &[Some(target)],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Blended faces from the farthest to the nearest, by the eye depth of their middle; equals in the file's order.
fn back_to_front(scene: &Scene, faces: &[u32], camera: &Camera) -> Vec<u32> {
    let back = camera.axes()[2];
    let depth = |face: u32| {
        let middle: glam::DVec3 =
            scene.model.faces[face as usize].iter().map(|&v| scene.model.positions[v as usize].as_dvec3()).sum();
        middle.dot(back)
    };
    let mut keyed: Vec<(f64, u32)> = faces.iter().map(|&face| (depth(face), face)).collect();
    keyed.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    keyed.into_iter().map(|(_, face)| face).collect()
}

fn uniform_buffer(device: &wgpu::Device, contents: &[u8]) -> wgpu::Buffer {
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("uniform"),
        contents,
        usage: wgpu::BufferUsages::UNIFORM,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use naga::TypeInner;
    use std::mem::offset_of;

    #[test]
    fn the_uniforms_lie_as_the_shader_has_them() {
        let module = naga::front::wgsl::parse_str(&wgsl()).expect("the shader parses");
        let layout = |name: &str| {
            let (_, ty) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)).expect("it is there");
            let TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is no struct") };
            let members: Vec<_> =
                members.iter().map(|m| (m.name.clone().expect("a name"), m.offset as usize)).collect();
            (members, *span as usize)
        };
        let ours = |members: &[(&str, usize)], size: usize| {
            (members.iter().map(|&(name, at)| (name.to_owned(), at)).collect::<Vec<_>>(), size)
        };
        let view = [
            ("clip_from_world", offset_of!(SurfaceUniform, clip_from_world)),
            ("to_eye", offset_of!(SurfaceUniform, to_eye)),
            ("to_eye_dx", offset_of!(SurfaceUniform, to_eye_dx)),
            ("to_eye_dy", offset_of!(SurfaceUniform, to_eye_dy)),
            ("to_light", offset_of!(SurfaceUniform, to_light)),
        ];
        assert_eq!(layout("SurfaceView"), ours(&view, size_of::<SurfaceUniform>()));
        let material = [
            ("base_color", offset_of!(MaterialUniform, base_color)),
            ("texture_size", offset_of!(MaterialUniform, texture_size)),
            ("last_level", offset_of!(MaterialUniform, last_level)),
            ("cutoff", offset_of!(MaterialUniform, cutoff)),
        ];
        assert_eq!(layout("SurfaceMaterial"), ours(&material, size_of::<MaterialUniform>()));
    }
}

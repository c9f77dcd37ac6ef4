//! Draws inverted hulls on wgpu: see [`crate::hull`].
//!
//! Needs the scene drawn before, with its depth buffer, `Depth32Float` and reversed. Hulls are solid ink without
//! antialiasing. They are hidden by the scene and write their own depth, so that they hide what is drawn afterwards
//! with a depth test.

use crate::OutlineError;
use crate::filled_buffer::filled_buffer;
use crate::hull::{HULL_WGSL, Hull, HullVertex, HullView};
use crate::shader::assemble;
use crate::target::{check_color_format, check_reversed, check_view, is_same, size, towards_viewer};

const PASS: (&str, &str) = ("hull_pass.wgsl", include_str!("hull_pass.wgsl"));

/// The whole shader of the pass.
pub(crate) fn wgsl() -> String {
    assemble(&[("hull.wgsl", HULL_WGSL), PASS])
}

/// `HullView` of `hull.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct HullUniform {
    clip_from_world: [[f32; 4]; 4],
    /// Columns of three, each padded to four.
    view_from_normal: [[f32; 4]; 3],
    viewport_px: [f32; 2],
    depth_per_px: [f32; 2],
    ink: [f32; 4],
    width_px: f32,
    padding: [u32; 3],
}

impl HullUniform {
    fn new(view: &HullView, ink: [f32; 4]) -> Self {
        let column = |column: glam::DVec3| column.as_vec3().extend(0.0).to_array();
        let normal = view.view_from_normal;
        Self {
            clip_from_world: view.clip_from_world.as_mat4().to_cols_array_2d(),
            view_from_normal: [normal.x_axis, normal.y_axis, normal.z_axis].map(column),
            viewport_px: view.viewport_px.as_vec2().to_array(),
            depth_per_px: view.depth_per_px.as_vec2().to_array(),
            ink,
            width_px: view.width_px as f32,
            padding: [0; 3],
        }
    }
}

/// A hull in buffers: 24 bytes a vertex and 12 bytes a face.
#[derive(Debug)]
pub struct HullOnDevice {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    index_count: u32,
}

impl HullOnDevice {
    /// Uploads a hull.
    ///
    /// # Errors
    /// [`OutlineError::HullTooLarge`] where a buffer would be larger than the device allows.
    pub fn new(device: &wgpu::Device, hull: &Hull) -> Result<Self, OutlineError> {
        let limit = device.limits().max_buffer_size;
        let (vertices, faces): (&[u8], &[u8]) =
            (bytemuck::cast_slice(&hull.vertices), bytemuck::cast_slice(&hull.faces));
        let bytes = vertices.len().max(faces.len()) as u64;
        if bytes > limit {
            return Err(OutlineError::HullTooLarge { bytes, limit });
        }
        Ok(Self {
            vertices: filled_buffer(device, "hull", vertices, wgpu::BufferUsages::VERTEX),
            indices: filled_buffer(device, "hull's faces", faces, wgpu::BufferUsages::INDEX),
            index_count: 3 * hull.faces.len() as u32,
        })
    }
}

/// A hull and the view that it is drawn for.
#[derive(Clone, Copy, Debug)]
pub struct PlacedHull<'a> {
    /// The hull.
    pub hull: &'a HullOnDevice,
    /// Its view, from the space of its vertices, with reversed depth.
    pub view: HullView,
}

/// The pipelines that draw hulls.
#[derive(Debug)]
pub struct HullPass {
    layout: wgpu::BindGroupLayout,
    /// Index 1: of mirrored views.
    pipelines: [wgpu::RenderPipeline; 2],
    color_format: wgpu::TextureFormat,
}

impl HullPass {
    /// Makes the pipelines for a colour target of `color_format`, of floats and without sRGB.
    ///
    /// # Errors
    /// [`OutlineError::SrgbTarget`]; [`OutlineError::ViewFormat`] for a format that is no colour of floats.
    pub fn new(device: &wgpu::Device, color_format: wgpu::TextureFormat) -> Result<Self, OutlineError> {
        check_color_format(device, color_format)?;
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("hulls"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("hulls"),
            source: wgpu::ShaderSource::Wgsl(wgsl().into()),
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("hulls"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = |front_face| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("hulls"),
                layout: Some(&pipeline_layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("vs_hull"),
                    compilation_options: Default::default(),
                    buffers: &[Some(wgpu::VertexBufferLayout {
                        array_stride: size_of::<HullVertex>() as u64,
                        step_mode: wgpu::VertexStepMode::Vertex,
                        attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3],
                    })],
                },
                primitive: wgpu::PrimitiveState {
                    front_face,
                    cull_mode: Some(wgpu::Face::Front),
                    ..Default::default()
                },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: wgpu::TextureFormat::Depth32Float,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("fs_hull"),
                    compilation_options: Default::default(),
                    targets: &[Some(wgpu::ColorTargetState {
                        format: color_format,
                        blend: None,
                        write_mask: wgpu::ColorWrites::ALL,
                    })],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let pipelines = [wgpu::FrontFace::Ccw, wgpu::FrontFace::Cw].map(pipeline);
        Ok(Self { layout, pipelines, color_format })
    }

    /// Records drawing a frame's hulls, in one render pass.
    ///
    /// - `ink`: display-referred colour and alpha, 0..=1, written as they are.
    /// - `color`: of the format that the pass was made for, `RENDER_ATTACHMENT`; kept outside the hulls.
    /// - `depth`: the scene's, `Depth32Float`, reversed, `RENDER_ATTACHMENT`, of the same size; the hulls' is added.
    ///
    /// Both are views of the first level of textures with one sample a pixel.
    ///
    /// # Errors
    /// If a texture is not as said; [`OutlineError::Width`] for a width that is negative or not finite;
    /// [`OutlineError::ViewSize`] if the targets have another size than a view; [`OutlineError::StandardDepth`], where
    /// the matrix can be judged. Nothing is recorded then.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        hulls: &[PlacedHull<'_>],
        ink: [f32; 4],
        color: &wgpu::TextureView,
        depth: &wgpu::TextureView,
    ) -> Result<(), OutlineError> {
        let needed = "the format that the pass was made for";
        check_view("a target", color, needed, |format| is_same(format, self.color_format), None)?;
        let is_depth = |format| format == wgpu::TextureFormat::Depth32Float;
        check_view("the scene's depth", depth, "Depth32Float", is_depth, Some(size(color)))?;
        for PlacedHull { view, .. } in hulls {
            if !(view.width_px.is_finite() && view.width_px >= 0.0) {
                return Err(OutlineError::Width { width_px: view.width_px as f32 });
            }
            let needed_px = view.viewport_px.as_uvec2().to_array();
            if size(color) != needed_px {
                return Err(OutlineError::ViewSize { what: "a target", size_px: size(color), needed_px });
            }
            let towards = towards_viewer(&view.clip_from_world) * if view.mirrored { -1.0 } else { 1.0 };
            check_reversed(&view.clip_from_world, Some(towards))?;
        }
        let drawn = || hulls.iter().filter(|placed| placed.hull.index_count > 0);
        let group = |placed: &PlacedHull<'_>| {
            let uniform = HullUniform::new(&placed.view, ink);
            let usage = wgpu::BufferUsages::UNIFORM;
            let uniform = filled_buffer(device, "hull's view", bytemuck::bytes_of(&uniform), usage);
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("hull"),
                layout: &self.layout,
                entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }],
            })
        };
        let groups: Vec<wgpu::BindGroup> = drawn().map(group).collect();
        if groups.is_empty() {
            return Ok(());
        }
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("hulls"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        for (PlacedHull { hull, view }, group) in drawn().zip(&groups) {
            pass.set_pipeline(&self.pipelines[usize::from(view.mirrored)]);
            pass.set_bind_group(0, group, &[]);
            pass.set_vertex_buffer(0, hull.vertices.slice(..));
            pass.set_index_buffer(hull.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..hull.index_count, 0, 0..1);
        }
        Ok(())
    }
}

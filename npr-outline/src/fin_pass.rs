//! Draws the fins of Card & Mitchell 2002 on wgpu: see [`crate::fin_printed`].
//!
//! Needs the scene drawn before, with its depth buffer, `Depth32Float` and reversed. Fins are solid ink without
//! antialiasing, as in 2002.

use crate::OutlineError;
use crate::filled_buffer::filled_buffer;
use crate::fin_printed::{FIN_PRINTED_WGSL, FinDepth, FinView, PrintedFins};
use crate::normal_format::{NORMAL_FORMAT_WGSL, NormalFormat};
use crate::shader::assemble;
use crate::target::{check_color_format, check_reversed, check_view, is_same, size};

const PASS: (&str, &str) = ("fin_pass.wgsl", include_str!("fin_pass.wgsl"));

/// The whole shader of the pass.
pub(crate) fn wgsl() -> String {
    assemble(&[("normal_format.wgsl", NORMAL_FORMAT_WGSL), ("fin_printed.wgsl", FIN_PRINTED_WGSL), PASS])
}

/// `FinPrintedView` of `fin_printed.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct FinUniform {
    pub clip_from_world: [[f32; 4]; 4],
    pub eye: [f32; 3],
    pub thickness: f32,
    pub ink: [f32; 4],
    pub near: f32,
    pub far: f32,
    pub as_printed: u32,
    pub reversed: u32,
}

/// Fins in vertex buffers: one of positions and smooth normals, one of face normals in the pass's format.
#[derive(Debug)]
pub struct FinsOnDevice {
    vertices: wgpu::Buffer,
    normals: wgpu::Buffer,
    indices: wgpu::Buffer,
    index_count: u32,
}

/// The pipeline that draws fins.
#[derive(Debug)]
pub struct FinPass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    format: NormalFormat,
    color_format: wgpu::TextureFormat,
}

impl FinPass {
    /// Makes the pipeline for a colour target of `color_format`, of floats and without sRGB, and face normals stored in
    /// `format`.
    ///
    /// # Errors
    /// [`OutlineError::SrgbTarget`]; [`OutlineError::ViewFormat`] for a format that is no colour of floats.
    pub fn new(
        device: &wgpu::Device,
        color_format: wgpu::TextureFormat,
        format: NormalFormat,
    ) -> Result<Self, OutlineError> {
        check_color_format(device, color_format)?;
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("printed fins"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX | wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("printed fins"),
            source: wgpu::ShaderSource::Wgsl(wgsl().into()),
        });
        let (vertex_format, entry_point) = match format {
            NormalFormat::F32 => (wgpu::VertexFormat::Float32x3, "vs_fin"),
            NormalFormat::Snorm16 => (wgpu::VertexFormat::Snorm16x4, "vs_fin"),
            NormalFormat::Snorm8 => (wgpu::VertexFormat::Snorm8x4, "vs_fin"),
            NormalFormat::Oct16 => (wgpu::VertexFormat::Snorm16x2, "vs_fin_oct"),
            NormalFormat::Oct8 => (wgpu::VertexFormat::Snorm8x2, "vs_fin_oct"),
        };
        let attribute = |format, offset, shader_location| wgpu::VertexAttribute { format, offset, shader_location };
        let normal_size = vertex_format.size();
        let buffer = |array_stride, attributes| {
            Some(wgpu::VertexBufferLayout { array_stride, step_mode: wgpu::VertexStepMode::Vertex, attributes })
        };
        let placed = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];
        let faces = [attribute(vertex_format, 0, 2), attribute(vertex_format, normal_size, 3)];
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("printed fins"),
            layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("printed fins"),
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            })),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(entry_point),
                compilation_options: Default::default(),
                buffers: &[buffer(24, &placed), buffer(2 * normal_size, &faces)],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: wgpu::TextureFormat::Depth32Float,
                depth_write_enabled: Some(false),
                depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fs_fin"),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: color_format,
                    blend: None,
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        });
        Ok(Self { layout, pipeline, format, color_format })
    }

    /// Uploads fins: [`NormalFormat::bytes_per_fin`] and 24 bytes of indices each.
    ///
    /// # Errors
    /// [`OutlineError::TooManyEdges`] where a buffer would be larger than the device allows.
    pub fn upload(&self, device: &wgpu::Device, fins: &PrintedFins) -> Result<FinsOnDevice, OutlineError> {
        let limit = device.limits().max_buffer_size;
        let vertex_bytes = 24.max(2 * self.format.bytes_per_normal() as u64);
        let bytes = (fins.vertices.len() as u64 * vertex_bytes).max(4 * fins.indices.len() as u64);
        if bytes > limit {
            return Err(OutlineError::TooManyEdges { bytes, limit });
        }
        let buffer = |label, contents: &[u8], usage| filled_buffer(device, label, contents, usage);
        let placed: Vec<[f32; 6]> = fins
            .vertices
            .iter()
            .map(|vertex| {
                let ([x, y, z], [u, v, w]) = (vertex.position.to_array(), vertex.smooth_normal.to_array());
                [x, y, z, u, v, w]
            })
            .collect();
        let mut normals = Vec::with_capacity(2 * fins.vertices.len() * self.format.bytes_per_normal());
        for vertex in &fins.vertices {
            self.format.encode(vertex.n_face0, &mut normals);
            self.format.encode(vertex.n_face1, &mut normals);
        }
        Ok(FinsOnDevice {
            vertices: buffer("printed fins", bytemuck::cast_slice(&placed), wgpu::BufferUsages::VERTEX),
            normals: buffer("printed fins' normals", &normals, wgpu::BufferUsages::VERTEX),
            indices: buffer("printed fins' indices", bytemuck::cast_slice(&fins.indices), wgpu::BufferUsages::INDEX),
            index_count: fins.indices.len() as u32,
        })
    }

    /// Records drawing a frame's fins.
    ///
    /// - `view`: with reversed depth.
    /// - `ink`: display-referred colour and alpha, 0..=1, written as they are.
    /// - `color`: of the format that the pass was made for, `RENDER_ATTACHMENT`; kept outside the fins.
    /// - `depth`: the scene's, `Depth32Float`, reversed, `RENDER_ATTACHMENT`, of the same size; only read.
    ///
    /// Both are views of the first level of textures with one sample a pixel. `fins` must come from this pass or one of
    /// the same normal format.
    ///
    /// # Errors
    /// If a texture is not as said; [`OutlineError::StandardDepth`], where the matrix can be judged. Nothing is
    /// recorded then.
    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own; a struct would only rename them")]
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        fins: &FinsOnDevice,
        view: &FinView,
        ink: [f32; 4],
        color: &wgpu::TextureView,
        depth: &wgpu::TextureView,
    ) -> Result<(), OutlineError> {
        check_reversed(&view.clip_from_world, None)?;
        let needed = "the format that the pass was made for";
        check_view("a target", color, needed, |format| is_same(format, self.color_format), None)?;
        let is_depth = |format| format == wgpu::TextureFormat::Depth32Float;
        check_view("the scene's depth", depth, "Depth32Float", is_depth, Some(size(color)))?;
        if fins.index_count == 0 {
            return Ok(());
        }
        let uniform = FinUniform::new(view, ink);
        let usage = wgpu::BufferUsages::UNIFORM;
        let uniform = filled_buffer(device, "printed fins' view", bytemuck::bytes_of(&uniform), usage);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("printed fins"),
            layout: &self.layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }],
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("printed fins"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            // Without operations, the attachment is read-only.
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: None,
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_vertex_buffer(0, fins.vertices.slice(..));
        pass.set_vertex_buffer(1, fins.normals.slice(..));
        pass.set_index_buffer(fins.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..fins.index_count, 0, 0..1);
        Ok(())
    }
}

impl FinUniform {
    fn new(view: &FinView, ink: [f32; 4]) -> Self {
        let (near, far, as_printed) = match view.depth {
            FinDepth::Printed { near, far } => (near as f32, far as f32, 1),
            // Two different values keep the unused branch finite.
            FinDepth::Eye => (0.0, 1.0, 0),
        };
        Self {
            clip_from_world: view.clip_from_world.as_mat4().to_cols_array_2d(),
            eye: view.eye.as_vec3().to_array(),
            thickness: view.thickness as f32,
            ink,
            near,
            far,
            as_printed,
            reversed: u32::from(view.reversed),
        }
    }
}

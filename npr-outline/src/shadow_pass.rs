//! Shadow volumes into a stencil buffer on wgpu.
//!
//! Counted behind the surface (depth fail), so that the eye may stand inside a volume: where
//! [`crate::shadow_volume::outline_in_shadow`] says so of the stencil after the pass, what the depth buffer holds is in
//! shadow, or turned away from the light. Volumes end at infinity, so the
//! matrix must have no far plane, or the pass be made without depth clipping.
//!
//! The depth buffer must hold the same faces, placed by the same product of matrix and position with an `@invariant`
//! result: a cap lies exactly on its face, equal depth counts as behind, and so a lit face does not shadow itself. No
//! bias is needed, and none is there.
//!
//! 8 bits: a pixel under 128 to 256 layers of faces between it and the light is taken for lit.

use crate::OutlineError;
use crate::shadow_volume::{ShadowCasters, VolumeEdge, VolumeFace};
use glam::{DMat4, DVec4};
use wgpu::util::DeviceExt;

/// WGSL of [`crate::shadow_volume`]: no bindings, no entry points.
pub const SHADOW_WGSL: &str = include_str!("shadow_volume.wgsl");
const PASS_WGSL: &str = include_str!("shadow_pass.wgsl");

/// `ShadowView` of `shadow_pass.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct ShadowUniform {
    clip_from_world: [[f32; 4]; 4],
    light: [f32; 4],
    local_light: [f32; 4],
}

/// Edges and faces on the device: all of a model, from which the device takes its own, or those of one light.
#[derive(Debug)]
pub struct CastersOnDevice {
    edges: Option<wgpu::Buffer>,
    edge_count: u32,
    faces: Option<wgpu::Buffer>,
    face_count: u32,
    origin: glam::Vec3,
    open: bool,
}

impl CastersOnDevice {
    /// Uploads all that can cast, for lights that the device sorts out itself: 64 bytes an edge and a face.
    ///
    /// # Errors
    /// [`OutlineError::TooManyEdges`].
    pub fn new(device: &wgpu::Device, casters: &ShadowCasters) -> Result<Self, OutlineError> {
        upload(device, casters, &casters.edges, &casters.faces)
    }

    /// Uploads what casts for one light, found on the CPU: [`ShadowCasters::scan`]. The way of choice where the device is
    /// software. Good for as long as the light stays where it is.
    ///
    /// # Errors
    /// [`OutlineError::TooManyEdges`].
    pub fn scanned(device: &wgpu::Device, casters: &ShadowCasters, light: DVec4) -> Result<Self, OutlineError> {
        let (mut edges, mut faces) = (Vec::new(), Vec::new());
        casters.scan(light, &mut edges, &mut faces);
        upload(device, casters, &edges, &faces)
    }
}

/// The pipelines.
#[derive(Debug)]
pub struct ShadowPass {
    layout: wgpu::BindGroupLayout,
    /// For a light far away, and for one near.
    sides: [wgpu::RenderPipeline; 2],
    /// Turned towards the light, and away from it.
    caps: [wgpu::RenderPipeline; 2],
}

/// Vertices of one sweep of an edge, and of the caps of a face, for a light far away and for one near.
const SWEEP_VERTICES: [u32; 2] = [3, 6];
const CAP_VERTICES: [u32; 2] = [3, 6];

impl ShadowPass {
    /// Makes the pipelines.
    ///
    /// - `format`: of the depth buffer, reversed, with a stencil: `Depth32FloatStencil8` where there is that.
    /// - `unclipped`: needed for parallel views, whose depth ends; asks for `Features::DEPTH_CLIP_CONTROL`.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat, unclipped: bool) -> Self {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("shadow volumes"),
            source: wgpu::ShaderSource::Wgsl(wgsl().into()),
        });
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("shadow volumes"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("shadow volumes"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let counted = |operation| wgpu::StencilFaceState {
            compare: wgpu::CompareFunction::Always,
            fail_op: wgpu::StencilOperation::Keep,
            depth_fail_op: operation,
            pass_op: wgpu::StencilOperation::Keep,
        };
        let pipeline = |entry_point, buffer, constants: &[(&str, f64)], turned: bool| {
            let (more, less) = (wgpu::StencilOperation::IncrementWrap, wgpu::StencilOperation::DecrementWrap);
            let (front, back) = if turned { (more, less) } else { (less, more) };
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(entry_point),
                layout: Some(&pipeline_layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some(entry_point),
                    compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
                    buffers: &[Some(buffer)],
                },
                primitive: wgpu::PrimitiveState { unclipped_depth: unclipped, ..Default::default() },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format,
                    depth_write_enabled: Some(false),
                    // Reversed: what is strictly nearer than the surface is not counted.
                    depth_compare: Some(wgpu::CompareFunction::Greater),
                    stencil: wgpu::StencilState {
                        front: counted(front),
                        back: counted(back),
                        read_mask: 0xff,
                        write_mask: 0xff,
                    },
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: None,
                multiview_mask: None,
                cache: None,
            })
        };
        let side_buffer = wgpu::VertexBufferLayout {
            array_stride: size_of::<VolumeEdge>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &[
                attribute(0, 0, wgpu::VertexFormat::Float32x3),
                attribute(1, 12, wgpu::VertexFormat::Uint32),
                attribute(2, 16, wgpu::VertexFormat::Float32x3),
                attribute(3, 32, wgpu::VertexFormat::Float32x4),
                attribute(4, 48, wgpu::VertexFormat::Float32x4),
            ],
        };
        let cap_buffer = wgpu::VertexBufferLayout {
            array_stride: size_of::<VolumeFace>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &[
                attribute(0, 0, wgpu::VertexFormat::Float32x3),
                attribute(1, 12, wgpu::VertexFormat::Uint32),
                attribute(2, 16, wgpu::VertexFormat::Float32x3),
                attribute(3, 32, wgpu::VertexFormat::Float32x3),
                attribute(4, 48, wgpu::VertexFormat::Float32x4),
            ],
        };
        let side =
            |vertices: u32| pipeline("vs_side", side_buffer.clone(), &[("sweep_vertices", f64::from(vertices))], false);
        let cap = |turn: f64| pipeline("vs_cap", cap_buffer.clone(), &[("cap_turn", turn)], turn < 0.0);
        Self { sides: SWEEP_VERTICES.map(side), caps: [cap(1.0), cap(-1.0)], layout }
    }

    /// Records the pass: clears the stencil, and counts the volumes against the depth that is there.
    ///
    /// - `light`: world space, a point with w = 1 or the direction to the light with w = 0;
    /// - `clip_from_world`: of the depth buffer, reversed, rounded to f32 as the scene's own was.
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        casters: &CastersOnDevice,
        light: DVec4,
        clip_from_world: DMat4,
        depth_stencil: &wgpu::TextureView,
    ) {
        let local = light - casters.origin.as_dvec3().extend(0.0) * light.w;
        let uniform = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("shadow view"),
            contents: bytemuck::bytes_of(&ShadowUniform {
                clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
                light: light.as_vec4().to_array(),
                local_light: local.as_vec4().to_array(),
            }),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadow view"),
            layout: &self.layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }],
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow volumes"),
            color_attachments: &[],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth_stencil,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
                stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }),
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, &group, &[]);
        let near = usize::from(light.w != 0.0);
        if let Some(edges) = &casters.edges {
            let sweeps = if casters.open { 2 } else { 1 };
            pass.set_pipeline(&self.sides[near]);
            pass.set_vertex_buffer(0, edges.slice(..));
            pass.draw(0..sweeps * SWEEP_VERTICES[near], 0..casters.edge_count);
        }
        if let Some(faces) = &casters.faces {
            pass.set_vertex_buffer(0, faces.slice(..));
            // Of a closed model none casts that is turned away.
            for pipeline in &self.caps[..if casters.open { 2 } else { 1 }] {
                pass.set_pipeline(pipeline);
                pass.draw(0..CAP_VERTICES[near], 0..casters.face_count);
            }
        }
    }
}

/// The whole shader of the pass.
pub fn wgsl() -> String {
    [SHADOW_WGSL, PASS_WGSL].concat()
}

const fn attribute(shader_location: u32, offset: u64, format: wgpu::VertexFormat) -> wgpu::VertexAttribute {
    wgpu::VertexAttribute { format, offset, shader_location }
}

fn upload(
    device: &wgpu::Device,
    casters: &ShadowCasters,
    edges: &[VolumeEdge],
    faces: &[VolumeFace],
) -> Result<CastersOnDevice, OutlineError> {
    let buffer = |label, contents: &[u8]| {
        let (bytes, limit) = (contents.len() as u64, device.limits().max_buffer_size);
        if bytes > limit {
            return Err(OutlineError::TooManyEdges { bytes, limit });
        }
        let usage = wgpu::BufferUsages::VERTEX;
        let descriptor = wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage };
        Ok((!contents.is_empty()).then(|| device.create_buffer_init(&descriptor)))
    };
    Ok(CastersOnDevice {
        edges: buffer("volume edges", bytemuck::cast_slice(edges))?,
        edge_count: edges.len() as u32,
        faces: buffer("volume faces", bytemuck::cast_slice(faces))?,
        face_count: faces.len() as u32,
        origin: casters.origin,
        open: casters.open,
    })
}

//! Counts shadow volumes in a stencil buffer on wgpu.
//!
//! Volumes are counted behind the surface (depth fail), so that the eye may be inside a volume. Where
//! [`crate::shadow_volume::outline_in_shadow`] holds for the stencil after the pass, the surface in the depth buffer is
//! in shadow or faces away from the light. Volumes reach to infinity, so that either the matrix has no far plane or the
//! pass is made without depth clipping.
//!
//! The depth buffer must hold the same faces, placed by the same product of matrix and position with an `@invariant`
//! result: a cap lies exactly on its face, equal depth counts as behind, and so a lit face does not shadow itself.
//! There is no depth bias.
//!
//! The stencil has 8 bits: a pixel with 128 to 256 layers of faces between it and the light is classified as lit.

use crate::OutlineError;
use crate::filled_buffer::filled_buffer;
use crate::shader::assemble;
use crate::shadow_volume::{ShadowCasters, VolumeEdge, VolumeFace};
use crate::target::{check_area, check_no_far_plane, check_reversed, check_view, size, towards_viewer};
use glam::{DAffine3, DMat4, DVec4};
use std::sync::OnceLock;

/// WGSL of [`crate::shadow_volume`]: no bindings, no entry points.
pub const SHADOW_WGSL: &str = include_str!("shadow_volume.wgsl");
const PASS: (&str, &str) = ("shadow_pass.wgsl", include_str!("shadow_pass.wgsl"));

/// `ShadowView` of `shadow_pass.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct ShadowUniform {
    clip_from_world: [[f32; 4]; 4],
    world_from_mesh: [[f32; 4]; 3],
    light: [f32; 4],
    local_light: [f32; 4],
}

/// The casters of a mesh that is placed in a scene.
#[derive(Clone, Copy, Debug)]
pub struct PlacedCasters<'a> {
    /// The casters, in the space of the mesh.
    pub casters: &'a CastersOnDevice,
    /// Rounded to f32 as for the scene's own faces: with equal bits a cap lies exactly on its face.
    pub world_from_mesh: DAffine3,
    /// The light in the space of the mesh: a point with w = 1 or the direction to the light with w = 0. Of
    /// [`CastersOnDevice::of_light`] the same.
    pub light: DVec4,
}

/// The shadow casters of a model in buffers of the device.
#[derive(Debug)]
pub struct CastersOnDevice {
    origin: glam::Vec3,
    source: Source,
}

#[derive(Debug)]
enum Source {
    /// All edges and faces of a model, from which vertex shaders select those that bound volumes.
    All { edges: Option<wgpu::Buffer>, edge_count: u32, faces: Option<wgpu::Buffer>, face_count: u32, open: bool },
    /// The triangles of one light's volumes: those of sides and of caps towards the light, then the other caps.
    Triangles { vertices: Option<wgpu::Buffer>, towards: u32, away: u32 },
}

impl CastersOnDevice {
    /// Uploads all edges and faces that can cast, for any light: 64 bytes for each edge and each face.
    ///
    /// # Errors
    /// [`OutlineError::TooManyEdges`].
    pub fn new(device: &wgpu::Device, casters: &ShadowCasters) -> Result<Self, OutlineError> {
        let source = Source::All {
            edges: upload(device, "volume edges", bytemuck::cast_slice(&casters.edges().collect::<Vec<_>>()))?,
            edge_count: casters.edges().len() as u32,
            faces: upload(device, "volume faces", bytemuck::cast_slice(&casters.faces().collect::<Vec<_>>()))?,
            face_count: casters.faces().len() as u32,
            open: casters.open,
        };
        Ok(Self { origin: casters.origin, source })
    }

    /// Uploads the volumes of one light, found on the CPU: [`ShadowCasters::triangles`]. Faster on software
    /// adapters, which are slow at many small instances. Valid until the light changes.
    ///
    /// # Errors
    /// [`OutlineError::TooManyEdges`].
    pub fn of_light(device: &wgpu::Device, casters: &ShadowCasters, light: DVec4) -> Result<Self, OutlineError> {
        let (corners, towards) = casters.triangles(light);
        let source = Source::Triangles {
            vertices: upload(device, "volumes", bytemuck::cast_slice(&corners))?,
            towards: towards as u32,
            away: (corners.len() - towards) as u32,
        };
        Ok(Self { origin: casters.origin, source })
    }
}

/// The pipelines.
#[derive(Debug)]
pub struct ShadowPass {
    layout: wgpu::BindGroupLayout,
    module: wgpu::ShaderModule,
    plain: Pipelines,
    /// For meshes that are placed mirrored, which turns the windings on the screen; made when needed.
    mirrored: OnceLock<Pipelines>,
    format: wgpu::TextureFormat,
    unclipped: bool,
}

#[derive(Debug)]
struct Pipelines {
    /// For a directional light, and for a point light.
    sides: [wgpu::RenderPipeline; 2],
    /// For faces towards the light, and for faces away from it.
    caps: [wgpu::RenderPipeline; 2],
    /// The same for triangles made on the CPU.
    placed: [wgpu::RenderPipeline; 2],
}

/// Vertices of one sweep of an edge, and of the caps of a face, for a light far away and for one near.
const SWEEP_VERTICES: [u32; 2] = [3, 6];
const CAP_VERTICES: [u32; 2] = [3, 6];

impl ShadowPass {
    /// Makes the pipelines.
    ///
    /// - `format`: of the depth buffer, reversed, with a stencil: `Depth32FloatStencil8` where there is that.
    /// - `unclipped`: needed for parallel views and others with a far plane; needs `Features::DEPTH_CLIP_CONTROL`.
    ///
    /// # Errors
    /// [`OutlineError::ViewFormat`] for a format without depth or without stencil.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat, unclipped: bool) -> Result<Self, OutlineError> {
        check_depth_stencil_format(format)?;
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
        let plain = Pipelines::new(device, &layout, &module, (format, unclipped), wgpu::FrontFace::Ccw);
        Ok(Self { layout, module, plain, mirrored: OnceLock::new(), format, unclipped })
    }

    /// Records the pass: clears the stencil, and counts the volumes of all casters against the depth that is there.
    ///
    /// - `clip_from_world`: of the depth buffer, reversed, rounded to f32 as the scene's own was;
    /// - `endless`: of a parallel view the sum of what [`ShadowCasters::endless`] says of its direction, else 0;
    /// - `area`: left, top, width and height, px, in which there are surfaces: volumes reach to infinity, and counting
    ///   where there is no surface is wasted. `None` for the whole target.
    ///
    /// # Errors
    /// If `depth_stencil` is no view of the first level of a texture of the pass's format with one sample a pixel;
    /// [`OutlineError::Area`]; [`OutlineError::StandardDepth`] and, of a pass with depth clipping,
    /// [`OutlineError::FarPlane`], where the matrix can be judged. Nothing is recorded then.
    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own; a struct would only rename them")]
    pub fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        casters: &[PlacedCasters<'_>],
        clip_from_world: DMat4,
        depth_stencil: &wgpu::TextureView,
        endless: u32,
        area: Option<[u32; 4]>,
    ) -> Result<(), OutlineError> {
        check_reversed(&clip_from_world, Some(towards_viewer(&clip_from_world)))?;
        if !self.unclipped {
            check_no_far_plane(&clip_from_world)?;
        }
        let needed = "the format that the pass was made for";
        check_view("depth and stencil", depth_stencil, needed, |format| format == self.format, None)?;
        check_area(area, size(depth_stencil))?;
        let groups: Vec<_> = casters.iter().map(|placed| self.group(device, placed, clip_from_world)).collect();
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow volumes"),
            color_attachments: &[],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth_stencil,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
                stencil_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(endless & 0xff),
                    store: wgpu::StoreOp::Store,
                }),
            }),
            ..Default::default()
        });
        if let Some([x, y, width, height]) = area {
            if width == 0 || height == 0 {
                return Ok(());
            }
            pass.set_scissor_rect(x, y, width, height);
        }
        for (placed, group) in casters.iter().zip(&groups) {
            pass.set_bind_group(0, group, &[]);
            let pipelines = if placed.world_from_mesh.matrix3.determinant() < 0.0 {
                let state = (self.format, self.unclipped);
                let new = || Pipelines::new(device, &self.layout, &self.module, state, wgpu::FrontFace::Cw);
                self.mirrored.get_or_init(new)
            } else {
                &self.plain
            };
            pipelines.draw(&mut pass, placed);
        }
        Ok(())
    }

    fn group(&self, device: &wgpu::Device, placed: &PlacedCasters<'_>, clip_from_world: DMat4) -> wgpu::BindGroup {
        let PlacedCasters { casters, world_from_mesh, light } = placed;
        let local = *light - casters.origin.as_dvec3().extend(0.0) * light.w;
        let uniform = ShadowUniform {
            clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
            world_from_mesh: affine_rows(world_from_mesh),
            light: light.as_vec4().to_array(),
            local_light: local.as_vec4().to_array(),
        };
        let usage = wgpu::BufferUsages::UNIFORM;
        let uniform = filled_buffer(device, "shadow view", bytemuck::bytes_of(&uniform), usage);
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadow view"),
            layout: &self.layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }],
        })
    }
}

impl Pipelines {
    fn new(
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        module: &wgpu::ShaderModule,
        (format, unclipped): (wgpu::TextureFormat, bool),
        front_face: wgpu::FrontFace,
    ) -> Self {
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("shadow volumes"),
            bind_group_layouts: &[Some(layout)],
            immediate_size: 0,
        });
        let counted = |operation| wgpu::StencilFaceState {
            compare: wgpu::CompareFunction::Always,
            fail_op: wgpu::StencilOperation::Keep,
            depth_fail_op: operation,
            pass_op: wgpu::StencilOperation::Keep,
        };
        let pipeline = |entry_point, buffer, constants: &[(&str, f64)], faces_away: bool| {
            let (more, less) = (wgpu::StencilOperation::IncrementWrap, wgpu::StencilOperation::DecrementWrap);
            let (front, back) = if faces_away { (more, less) } else { (less, more) };
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(entry_point),
                layout: Some(&pipeline_layout),
                vertex: wgpu::VertexState {
                    module,
                    entry_point: Some(entry_point),
                    compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
                    buffers: &[Some(buffer)],
                },
                primitive: wgpu::PrimitiveState { unclipped_depth: unclipped, front_face, ..Default::default() },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format,
                    depth_write_enabled: Some(false),
                    // Reversed depth: fragments strictly nearer than the surface are not counted.
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
        let placed_buffer = wgpu::VertexBufferLayout {
            array_stride: 16,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &wgpu::vertex_attr_array![0 => Float32x4],
        };
        let placed = [false, true].map(|faces_away| pipeline("vs_placed", placed_buffer.clone(), &[], faces_away));
        let (sides, caps) = (SWEEP_VERTICES.map(side), [cap(1.0), cap(-1.0)]);
        Self { sides, caps, placed }
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, PlacedCasters { casters, light, .. }: &PlacedCasters<'_>) {
        let near = usize::from(light.w != 0.0);
        match &casters.source {
            Source::All { edges, edge_count, faces, face_count, open } => {
                // In a closed model no edge sweeps twice, and no face casts that faces away from the light.
                let times = if *open { 2 } else { 1 };
                if let Some(edges) = edges {
                    pass.set_pipeline(&self.sides[near]);
                    pass.set_vertex_buffer(0, edges.slice(..));
                    pass.draw(0..times * SWEEP_VERTICES[near], 0..*edge_count);
                }
                if let Some(faces) = faces {
                    pass.set_vertex_buffer(0, faces.slice(..));
                    for pipeline in &self.caps[..times as usize] {
                        pass.set_pipeline(pipeline);
                        pass.draw(0..CAP_VERTICES[near], 0..*face_count);
                    }
                }
            }
            Source::Triangles { vertices, towards, away } => {
                let Some(vertices) = vertices else { return };
                pass.set_vertex_buffer(0, vertices.slice(..));
                for (pipeline, range) in self.placed.iter().zip([0..*towards, *towards..towards + away]) {
                    if !range.is_empty() {
                        pass.set_pipeline(pipeline);
                        pass.draw(range, 0..1);
                    }
                }
            }
        }
    }
}

/// The rows of an affine matrix in f32, as shaders place positions by: x, y and z are a row's product with the position.
pub fn affine_rows(matrix: &DAffine3) -> [[f32; 4]; 3] {
    let rows = matrix.matrix3.transpose();
    let translation = matrix.translation;
    [(rows.x_axis, translation.x), (rows.y_axis, translation.y), (rows.z_axis, translation.z)]
        .map(|(row, along)| row.extend(along).as_vec4().to_array())
}

/// Refuses formats without depth or without stencil.
pub(crate) fn check_depth_stencil_format(format: wgpu::TextureFormat) -> Result<(), OutlineError> {
    if format.has_depth_aspect() && format.has_stencil_aspect() {
        return Ok(());
    }
    let needed = "a format of depth and stencil, such as Depth32FloatStencil8,";
    Err(OutlineError::ViewFormat { what: "depth and stencil", format, needed })
}

/// The whole shader of the pass.
pub(crate) fn wgsl() -> String {
    assemble(&[("shadow_volume.wgsl", SHADOW_WGSL), PASS])
}

const fn attribute(shader_location: u32, offset: u64, format: wgpu::VertexFormat) -> wgpu::VertexAttribute {
    wgpu::VertexAttribute { format, offset, shader_location }
}

fn upload(device: &wgpu::Device, label: &'static str, contents: &[u8]) -> Result<Option<wgpu::Buffer>, OutlineError> {
    let (bytes, limit) = (contents.len() as u64, device.limits().max_buffer_size);
    if bytes > limit {
        return Err(OutlineError::TooManyEdges { bytes, limit });
    }
    let usage = wgpu::BufferUsages::VERTEX;
    Ok((!contents.is_empty()).then(|| filled_buffer(device, label, contents, usage)))
}

//! A scene on the GPU.

use super::context::GpuContext;
use super::index_format::IndexFormat;
use super::instances::Instances;
use super::materials::{Materials, buffer};
use crate::error::HarnessError;
use crate::geometry::{Batch, Split, Streams, add_batches, blended_faces, index_bytes, sources, splits};
use crate::hatch::HatchVertex;
use crate::hatch::gpu::HatchTextures;
use crate::plan::{PaintPlan, Plan, corner_texture_size};
use crate::scene::Scene;
use crate::shadow::gpu::ShadowCasting;
use bytemuck::Zeroable;
use glam::{Vec3, Vec4};
use npr_hatch::upload::TamChannels;
use npr_mesh::Model;
use npr_outline::ContourEdges;
use npr_outline::fin_pass::FinsOnDevice;
use npr_outline::hull_pass::HullOnDevice;
use npr_outline::line_pass::EdgesOnDevice;
use std::cell::RefCell;
use std::ops::Range;
use std::sync::Arc;
use wgpu::util::DeviceExt;

/// The maximum number of draws per pass on a software adapter; see [`HarnessError::TooManyDraws`].
const SOFTWARE_DRAWS: usize = 2048;

/// The edges of an object, and the contours that they were made from.
pub(super) type ObjectEdges = (Arc<ContourEdges>, EdgesOnDevice);

/// The GPU data of a scene that do not change from frame to frame.
pub struct GpuScene {
    /// Positions, mesh by mesh.
    pub(crate) positions: wgpu::Buffer,
    /// The other attributes of vertices, those of [`Streams`].
    pub(super) streams: VertexStreams,
    /// The indices of unblended faces, sorted by mesh and material.
    pub(crate) indices: Option<wgpu::Buffer>,
    /// The format of all indices.
    pub(crate) index_format: IndexFormat,
    /// Per mesh: its batches.
    pub(super) batches: Vec<Vec<Batch>>,
    /// Per mesh: its range in the index buffer.
    pub(crate) solid: Vec<Range<u32>>,
    /// Per mesh: the index of its first vertex.
    pub(super) first_vertices: Vec<u32>,
    /// Blended faces, as (object, face); re-sorted for each view.
    pub(super) blended_faces: Vec<[u32; 2]>,
    /// The instance data of the objects.
    pub(crate) instances: RefCell<Instances>,
    pub(super) materials: Materials,
    /// The maximum number of draws per pass.
    pub(super) most_draws: usize,
    /// The edges of each object that has lines, with the contours that they were made from, if lines are found on the
    /// device.
    pub(super) edges: Option<RefCell<Vec<Option<ObjectEdges>>>>,
    /// The version of the scene's materials that was uploaded.
    pub(super) materials_version: u64,
    /// Per mesh: its hull, if inverted hulls are drawn.
    pub(super) hulls: Option<Vec<HullOnDevice>>,
    /// Per mesh: fins for all edges, if printed fins are drawn.
    pub(super) fins: Option<Vec<FinsOnDevice>>,
    /// The shadow casters, if shadow volumes are drawn.
    pub(super) casting: Option<ShadowCasting>,
    /// The corners of all faces, if light is constant over faces or pieces of faces. Each face then has vertices of its own,
    /// in the order of the faces.
    pub(super) facets: Option<wgpu::TextureView>,
    /// The tonal art map, if surfaces are hatched.
    pub(super) hatch: Option<HatchTextures>,
}

/// The attributes of vertices that a plan reads, a buffer each.
pub(super) struct VertexStreams {
    /// Which there are.
    pub(super) present: Streams,
    /// In the order of the slots: normals, texture coordinates, colours, regions, directions and octaves of strokes.
    pub(super) buffers: [Option<wgpu::Buffer>; 6],
}

impl GpuScene {
    pub(super) fn new(
        context: &GpuContext,
        material_layout: &wgpu::BindGroupLayout,
        scene: &Scene,
        plan: &Plan,
    ) -> Result<Self, HarnessError> {
        let buffer = |what, contents: &[u8], usage| buffer(context, what, contents, usage);
        let lights_faces = plan.paint.as_ref().is_some_and(PaintPlan::lights_faces);
        let present = Streams::new(scene, plan);
        let splits = splits(scene, plan, present);
        let meshes = || scene.meshes().iter().map(|mesh| mesh.model()).zip(&splits);
        let (mut positions, mut first_vertices) = (Vec::<Vec3>::new(), Vec::new());
        for (model, split) in meshes() {
            first_vertices.push(positions.len() as u32);
            positions.extend(sources(model, split).map(|i| model.positions[i]));
        }
        let index_format = IndexFormat { is_short: index_bytes(positions.len()) == 2 };
        let vertex = wgpu::BufferUsages::VERTEX;
        let positions = buffer("positions", bytemuck::cast_slice(&positions), vertex)?;
        let streams = VertexStreams {
            present,
            buffers: [
                stream(context, present.normals, "normals", meshes(), |model, i| model.normals[i])?,
                stream(context, present.uvs, "texture coordinates", meshes(), |model, i| {
                    model.uvs.get(i).copied().unwrap_or_default()
                })?,
                stream(context, present.colors, "vertex colours", meshes(), |model, i| {
                    model.colors.get(i).copied().unwrap_or(Vec4::ONE)
                })?,
                if present.regions {
                    let regions: Vec<u32> = splits.iter().flatten().flat_map(|split| &split.regions).copied().collect();
                    Some(buffer("regions", bytemuck::cast_slice(&regions), vertex)?)
                } else {
                    None
                },
                stroke_stream(context, present.directions, "directions of strokes", plan, meshes(), |vertex| {
                    [vertex.diagonal, vertex.others]
                })?,
                stroke_stream(context, present.octaves, "octaves of strokes", plan, meshes(), |vertex| vertex.octave)?,
            ],
        };
        let channels = if plan.half_float_maps { TamChannels::HalfFloats } else { TamChannels::Bytes };
        let hatch = plan.hatch().map(|hatch| HatchTextures::new(context, hatch, channels)).transpose()?;
        let materials = Materials::new(context, material_layout, scene, plan)?;
        let (mut indices, mut batches, mut solid) = (Vec::new(), Vec::new(), Vec::new());
        for (number, mesh) in scene.meshes().iter().enumerate() {
            let faces = splits[number].as_ref().map_or(&mesh.model().faces, |split| &split.faces);
            let duplicates = &materials.duplicates[scene.materials_of(number)];
            let start = indices.len() as u32;
            batches.push(add_batches(mesh, faces, duplicates, first_vertices[number], &mut indices));
            solid.push(start..indices.len() as u32);
        }
        let blended_faces = blended_faces(scene);
        let indices = if indices.is_empty() {
            None
        } else {
            Some(buffer("faces", &index_format.bytes(&indices), wgpu::BufferUsages::INDEX)?)
        };
        Ok(Self {
            positions,
            streams,
            indices,
            index_format,
            batches,
            solid,
            first_vertices,
            blended_faces,
            instances: RefCell::new(Instances::new(context, scene, plan.regions(), plan.object_pairs())?),
            materials,
            most_draws: if context.is_software() { SOFTWARE_DRAWS } else { usize::MAX },
            edges: None,
            materials_version: scene.materials_version(),
            hulls: None,
            fins: None,
            casting: None,
            facets: match &plan.paint {
                Some(paint) if lights_faces => Some(upload_facets(context, scene, paint)?),
                _ => None,
            },
            hatch,
        })
    }

    /// The vertices of a face, given as (object, face).
    pub(super) fn face_vertices(&self, scene: &Scene, [object, face]: [u32; 2]) -> [u32; 3] {
        let (object, mesh) = scene.placed(object);
        let own = if self.facets.is_some() {
            [0, 1, 2].map(|corner| 3 * face + corner)
        } else {
            mesh.model().faces[face as usize]
        };
        own.map(|vertex| self.first_vertices[object.mesh()] + vertex)
    }
}

/// The meshes' models and their splits.
type Meshes<'a> = (&'a Model, &'a Option<Split>);

/// Uploads an attribute of all vertices, if it is `needed`.
fn stream<'a, T: bytemuck::Pod>(
    context: &GpuContext,
    needed: bool,
    what: &'static str,
    meshes: impl Iterator<Item = Meshes<'a>>,
    attribute: impl Fn(&Model, usize) -> T,
) -> Result<Option<wgpu::Buffer>, HarnessError> {
    if !needed {
        return Ok(None);
    }
    let mut values = Vec::new();
    for (model, split) in meshes {
        values.extend(sources(model, split).map(|i| attribute(model, i)));
    }
    buffer(context, what, bytemuck::cast_slice(&values), wgpu::BufferUsages::VERTEX).map(Some)
}

/// As [`stream`], of the vertices' data for strokes.
fn stroke_stream<'a, T: bytemuck::Pod>(
    context: &GpuContext,
    needed: bool,
    what: &'static str,
    plan: &Plan,
    meshes: impl Iterator<Item = Meshes<'a>>,
    attribute: impl Fn(&HatchVertex) -> T,
) -> Result<Option<wgpu::Buffer>, HarnessError> {
    let Some(hatch) = plan.hatch().filter(|_| needed) else { return Ok(None) };
    let mut values = Vec::new();
    for ((model, split), of_mesh) in meshes.zip(&hatch.vertices) {
        let none = HatchVertex::zeroed();
        values.extend(sources(model, split).map(|i| attribute(of_mesh.get(i).unwrap_or(&none))));
    }
    buffer(context, what, bytemuck::cast_slice(&values), wgpu::BufferUsages::VERTEX).map(Some)
}

/// Uploads what `facets.wgsl` reads: a position and a normal per face, or per corner.
fn upload_facets(context: &GpuContext, scene: &Scene, paint: &PaintPlan) -> Result<wgpu::TextureView, HarnessError> {
    let limit = context.device.limits().max_texture_dimension_2d;
    let (width, height) = corner_texture_size(paint.corner_texels(scene), limit);
    if height > limit {
        return Err(HarnessError::TextureTooLarge { what: "the faces' corners", width, height, limit });
    }
    let texel = |vector: Vec3| vector.extend(0.0).to_array();
    let mut texels: Vec<[f32; 4]> = Vec::with_capacity(width as usize * height as usize);
    for (number, mesh) in scene.meshes().iter().enumerate() {
        let model = mesh.model();
        match paint.facets.get(number) {
            Some(facets) => texels.extend(facets.iter().flat_map(|facet| [texel(facet.centroid), texel(facet.normal)])),
            None => {
                texels.extend(model.faces.iter().flatten().flat_map(|&vertex| {
                    [texel(model.positions[vertex as usize]), texel(model.normals[vertex as usize])]
                }))
            }
        }
    }
    texels.resize(width as usize * height as usize, [0.0; 4]);
    let texture = context.device.create_texture_with_data(
        &context.queue,
        &wgpu::TextureDescriptor {
            label: Some("corners of faces"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        bytemuck::cast_slice(&texels),
    );
    Ok(texture.create_view(&Default::default()))
}

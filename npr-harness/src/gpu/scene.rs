//! A scene on the GPU.

use super::context::GpuContext;
use super::instances::Instances;
use super::materials::{Materials, buffer};
use crate::error::HarnessError;
use crate::hatch::HatchVertex;
use crate::hatch::gpu::HatchTextures;
use crate::plan::{PaintPlan, Plan, corner_texture_size};
use crate::scene::{Mesh, Object, Scene};
use crate::shadow::gpu::ShadowCasting;
use bytemuck::Zeroable;
use glam::{Vec3, Vec4};
use npr_hatch::upload::TamChannels;
use npr_mesh::{AlphaMode, Model};
use npr_outline::ContourEdges;
use npr_outline::fin_pass::FinsOnDevice;
use npr_outline::hull_pass::HullOnDevice;
use npr_outline::line_pass::EdgesOnDevice;
use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::Arc;
use wgpu::util::DeviceExt;

/// The maximum number of draws per pass on a software adapter; see [`HarnessError::TooManyDraws`].
const SOFTWARE_DRAWS: usize = 2048;

/// The edges of an object, and the contours that they were made from.
pub(super) type ObjectEdges = (Arc<ContourEdges>, EdgesOnDevice);

/// Faces of a mesh that have the same material, or materials of the same appearance, drawn by one call.
pub(super) struct Batch {
    /// The index in the mesh of the first of these materials.
    pub(super) material: usize,
    pub(super) indices: Range<u32>,
}

/// The GPU data of a scene that do not change from frame to frame.
pub struct GpuScene {
    /// Interleaved positions and normals, mesh by mesh.
    pub(crate) vertices: wgpu::Buffer,
    /// Texture coordinates and vertex colours, if any surface reads them.
    pub(super) lookups: Option<wgpu::Buffer>,
    /// Per vertex: its region, if lines are found in the image.
    pub(super) regions: Option<wgpu::Buffer>,
    /// The indices of unblended faces, sorted by mesh and material.
    pub(crate) indices: Option<wgpu::Buffer>,
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
    /// The edges of each object, with the contours that they were made from, if lines are found on the device.
    pub(super) edges: Option<RefCell<Vec<ObjectEdges>>>,
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
    /// The per-vertex data that position strokes, and the tonal art map, if surfaces are hatched.
    pub(super) hatch: Option<(wgpu::Buffer, HatchTextures)>,
}

impl GpuScene {
    pub(super) fn new(
        context: &GpuContext,
        material_layout: &wgpu::BindGroupLayout,
        scene: &Scene,
        plan: &Plan,
    ) -> Result<Self, HarnessError> {
        let interpolates_light = plan.paint.as_ref().is_some_and(|paint| paint.interpolates_light);
        let buffer = |what, contents: &[u8], usage| buffer(context, what, contents, usage);
        let regions_of = plan.image.as_ref().map(|image| &image.regions);
        let lights_faces = plan.paint.as_ref().is_some_and(PaintPlan::lights_faces);
        let split = |(number, mesh): (usize, &Arc<Mesh>)| {
            let model = mesh.model();
            let regions = regions_of.map(|of| of.of_meshes[number].as_slice());
            if lights_faces {
                return Some(split_all(&model.faces, regions));
            }
            regions.map(|regions| split_by_region(&model.faces, regions, model.positions.len()))
        };
        let splits: Vec<Option<Split>> = scene.meshes().iter().enumerate().map(split).collect();
        let meshes = || scene.meshes().iter().map(|mesh| mesh.model()).zip(&splits);
        let (mut vertices, mut first_vertices) = (Vec::<[f32; 6]>::new(), Vec::new());
        for (model, split) in meshes() {
            first_vertices.push(vertices.len() as u32);
            vertices.extend(sources(model, split).map(|i| {
                let (p, n) = (model.positions[i], model.normals[i]);
                [p.x, p.y, p.z, n.x, n.y, n.z]
            }));
        }
        let count = vertices.len();
        let vertices = buffer("vertices", bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX)?;
        let lookups = if plan.looks_up || interpolates_light {
            let mut lookups = Vec::<[f32; 6]>::with_capacity(count);
            for (model, split) in meshes() {
                lookups.extend(sources(model, split).map(|i| {
                    let uv = model.uvs.get(i).copied().unwrap_or_default();
                    let color = model.colors.get(i).copied().unwrap_or(Vec4::ONE);
                    [uv.x, uv.y, color.x, color.y, color.z, color.w]
                }));
            }
            Some(buffer("texture coordinates and colours", bytemuck::cast_slice(&lookups), wgpu::BufferUsages::VERTEX)?)
        } else {
            None
        };
        let regions = if regions_of.is_some() || interpolates_light {
            let mut regions: Vec<u32> = splits.iter().flatten().flat_map(|split| &split.regions).copied().collect();
            regions.resize(count, 0);
            Some(buffer("regions", bytemuck::cast_slice(&regions), wgpu::BufferUsages::VERTEX)?)
        } else {
            None
        };
        let hatch = match plan.hatch() {
            Some(hatch) => {
                let mut vertices = Vec::<HatchVertex>::with_capacity(count);
                for ((model, split), of_mesh) in meshes().zip(&hatch.vertices) {
                    let vertex = |i: usize| of_mesh.get(i).copied().unwrap_or(HatchVertex::zeroed());
                    vertices.extend(sources(model, split).map(vertex));
                }
                let channels = if plan.half_float_maps { TamChannels::HalfFloats } else { TamChannels::Bytes };
                let vertices = buffer("strokes", bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX)?;
                Some((vertices, HatchTextures::new(context, hatch, channels)?))
            }
            None => None,
        };
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
            Some(buffer("faces", bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX)?)
        };
        Ok(Self {
            vertices,
            lookups,
            regions,
            indices,
            batches,
            solid,
            first_vertices,
            blended_faces,
            instances: RefCell::new(Instances::new(context, scene, regions_of, plan.object_pairs())?),
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

/// The vertices of a mesh that its vertices on the device are copies of.
fn sources<'a>(model: &Model, split: &'a Option<Split>) -> impl Iterator<Item = usize> + use<'a> {
    let copied = split.as_ref().map(|split| split.sources.as_slice());
    (0..copied.map_or(model.positions.len(), <[u32]>::len)).map(move |i| copied.map_or(i, |of| of[i] as usize))
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

/// A vertex list in which each vertex belongs to one region, or to one face.
struct Split {
    /// Per vertex: the vertex of the model that it is a copy of.
    sources: Vec<u32>,
    /// Per vertex: its region; empty if there are no regions.
    regions: Vec<u32>,
    faces: Vec<[u32; 3]>,
}

/// Gives each face vertices of its own, in the order of the faces.
fn split_all(faces: &[[u32; 3]], face_region: Option<&[u32]>) -> Split {
    let of_corners = |regions: &[u32]| regions.iter().flat_map(|&region| [region; 3]).collect();
    Split {
        sources: faces.as_flattened().to_vec(),
        regions: face_region.map_or_else(Vec::new, of_corners),
        faces: (0..faces.len() as u32).map(|face| [0, 1, 2].map(|corner| 3 * face + corner)).collect(),
    }
}

/// Assigns each vertex the region of its first face, and duplicates it for faces of other regions.
fn split_by_region(faces: &[[u32; 3]], face_region: &[u32], vertices: usize) -> Split {
    let mut split = Split {
        sources: (0..vertices as u32).collect(),
        regions: vec![0; vertices],
        faces: Vec::with_capacity(faces.len()),
    };
    let mut added = HashMap::new();
    for (face, &region) in faces.iter().zip(face_region) {
        split.faces.push(face.map(|vertex| {
            let first = &mut split.regions[vertex as usize];
            if *first == 0 {
                *first = region;
            }
            if *first == region {
                return vertex;
            }
            *added.entry((vertex, region)).or_insert_with(|| {
                split.sources.push(vertex);
                split.sources.len() as u32 - 1
            })
        }));
    }
    split.regions.resize(split.sources.len(), 0);
    for ((_, region), vertex) in added {
        split.regions[vertex as usize] = region;
    }
    split
}

/// Adds a mesh's unblended faces to the index buffer, sorted by material, and returns their batches.
///
/// - `faces`: their vertices, relative to the mesh's first;
/// - `duplicates`: per material of the mesh, the scene index of the first material with the same appearance.
fn add_batches(
    mesh: &Mesh,
    faces: &[[u32; 3]],
    duplicates: &[usize],
    first_vertex: u32,
    indices: &mut Vec<u32>,
) -> Vec<Batch> {
    let (model, edges) = (mesh.model(), mesh.edges());
    let material = |face: u32| model.face_material[face as usize] as usize;
    let mut solid: Vec<u32> =
        (0..faces.len() as u32).filter(|&f| model.materials[material(f)].alpha_mode != AlphaMode::Blend).collect();
    // The sort is stable: the faces of a material keep the order of the file, in which neighbours share vertices.
    solid.sort_by_key(|&face| duplicates[material(face)]);
    // A duplicate face never passes the depth test after the face with the same corners, so it is dropped; some files
    // have half a million of them. Alpha-tested duplicates are kept, because the first face may be discarded where the
    // second is visible.
    if !edges.further_faces.is_empty() || edges.skipped.iter().any(|&skipped| skipped) {
        let mut seen = HashSet::new();
        solid.retain(|&face| {
            let corners = model.faces[face as usize].map(|v| edges.representative[v as usize]);
            let material = material(face);
            matches!(model.materials[material].alpha_mode, AlphaMode::Mask { .. })
                || seen.insert((duplicates[material], corners))
        });
    }
    let mut batches: Vec<Batch> = Vec::new();
    indices.reserve(3 * solid.len());
    for face in solid {
        let start = indices.len() as u32;
        indices.extend(faces[face as usize].map(|vertex| first_vertex + vertex));
        match batches.last_mut() {
            Some(batch) if duplicates[batch.material] == duplicates[material(face)] => batch.indices.end += 3,
            _ => batches.push(Batch { material: material(face), indices: start..start + 3 }),
        }
    }
    batches
}

/// The blended faces of all objects.
fn blended_faces(scene: &Scene) -> Vec<[u32; 2]> {
    let of_object = |(number, (_, mesh)): (u32, (&Object, &Mesh))| {
        let faces = if mesh.has_blend() { mesh.model().faces.len() as u32 } else { 0 };
        (0..faces).map(move |face| [number, face])
    };
    let is_blended = |&[object, face]: &[u32; 2]| scene.material(object, face).alpha_mode == AlphaMode::Blend;
    (0u32..).zip(scene.placed_objects()).flat_map(of_object).filter(is_blended).collect()
}

//! A scene on the GPU.

use super::context::GpuContext;
use super::instances::Instances;
use super::materials::{Materials, buffer};
use crate::error::HarnessError;
use crate::hatch::HatchVertex;
use crate::hatch::gpu::HatchTextures;
use crate::plan::Plan;
use crate::scene::{Mesh, Object, Scene};
use crate::shadow::gpu::ShadowCasting;
use bytemuck::Zeroable;
use glam::Vec4;
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
        let split = |(number, mesh): (usize, &Arc<Mesh>)| {
            let model = mesh.model();
            regions_of.map(|of| split_by_region(&model.faces, &of.of_meshes[number], model.positions.len()))
        };
        let splits: Vec<Option<Split>> = scene.meshes().iter().enumerate().map(split).collect();
        let meshes = || scene.meshes().iter().map(|mesh| mesh.model()).zip(&splits);
        // All vertices of each mesh, followed by copies of those that belong to several regions.
        let sources = |model: &Model, split: &Option<Split>| {
            let more = split.as_ref().map_or(Vec::new(), |split| split.more.clone());
            (0..model.positions.len()).chain(more.into_iter().map(|vertex| vertex as usize))
        };
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
            instances: RefCell::new(Instances::new(context, scene, regions_of)?),
            materials,
            most_draws: if context.is_software() { SOFTWARE_DRAWS } else { usize::MAX },
            edges: None,
            materials_version: scene.materials_version(),
            hulls: None,
            fins: None,
            casting: None,
            hatch,
        })
    }
}

/// A vertex list in which each vertex belongs to one region.
struct Split {
    /// The regions of all vertices, including the added ones.
    regions: Vec<u32>,
    /// For each added vertex, the vertex that it duplicates.
    more: Vec<u32>,
    faces: Vec<[u32; 3]>,
}

/// Assigns each vertex the region of its first face, and duplicates it for faces of other regions.
fn split_by_region(faces: &[[u32; 3]], face_region: &[u32], vertices: usize) -> Split {
    let mut split = Split { regions: vec![0; vertices], more: Vec::new(), faces: Vec::with_capacity(faces.len()) };
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
                split.more.push(vertex);
                (vertices + split.more.len() - 1) as u32
            })
        }));
    }
    split.regions.resize(vertices + split.more.len(), 0);
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

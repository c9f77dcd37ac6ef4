//! A scene on the device.

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
use npr_outline::fin_pass::FinsOnDevice;
use npr_outline::line_pass::EdgesOnDevice;
use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::Arc;

/// On a software adapter, see [`HarnessError::TooManyDraws`].
const SOFTWARE_DRAWS: usize = 2048;

/// Faces of a mesh of one material, or of several materials with the same appearance, drawn by one call.
pub(super) struct Batch {
    /// The first of them, as the mesh counts them.
    pub(super) material: usize,
    pub(super) indices: Range<u32>,
}

/// What of a scene stays the same from frame to frame.
pub struct GpuScene {
    /// Position and normal, interleaved; those of one mesh after those of the other.
    pub(crate) vertices: wgpu::Buffer,
    /// Texture coordinate and colour, where any surface looks one up.
    pub(super) lookups: Option<wgpu::Buffer>,
    /// Per vertex its region, where lines are found in the image.
    pub(super) regions: Option<wgpu::Buffer>,
    /// Faces that are not blended, by mesh and material.
    pub(crate) indices: Option<wgpu::Buffer>,
    /// Per mesh.
    pub(super) batches: Vec<Vec<Batch>>,
    /// Per mesh where its faces lie among the indices.
    pub(crate) solid: Vec<Range<u32>>,
    /// Per mesh the number of its first vertex.
    pub(super) first_vertices: Vec<u32>,
    /// Faces that are blended, as object and face; sorted anew for each view.
    pub(super) blended_faces: Vec<[u32; 2]>,
    /// Where the objects are.
    pub(crate) instances: RefCell<Instances>,
    pub(super) materials: Materials,
    /// How many draws a pass may take.
    pub(super) most_draws: usize,
    /// Per object its edges, where lines are found on the device.
    pub(super) edges: Option<Vec<EdgesOnDevice>>,
    /// Per mesh fins for all edges, where the printed form is drawn.
    pub(super) fins: Option<Vec<FinsOnDevice>>,
    /// What casts shadows, where volumes are drawn.
    pub(super) casting: Option<ShadowCasting>,
    /// Per vertex the data that positions strokes, and their tonal art map, where surfaces are hatched.
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
        // Of each mesh all vertices, and again those that stand in several regions.
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
            fins: None,
            casting: None,
            hatch,
        })
    }
}

/// Faces whose vertices are each in one region.
struct Split {
    /// Of all vertices, the added ones included.
    regions: Vec<u32>,
    /// The vertices that are added, by what they repeat.
    more: Vec<u32>,
    faces: Vec<[u32; 3]>,
}

/// Gives each vertex the region of its first face, and the others' faces vertices of their own.
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

/// Adds a mesh's faces that are not blended to the indices, sorted by material, and returns their batches.
///
/// - `faces`: their vertices, counted from the mesh's first;
/// - `duplicates`: per material of the mesh the number, in the scene, of the first that looks the same.
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
    // Stable, so that the faces of a material keep the order of the file, whose neighbours share vertices.
    solid.sort_by_key(|&face| duplicates[material(face)]);
    // Behind a face with the same corners, drawn before, none passes the depth test; a file with half a million of them
    // is to be drawn all the same. Where alpha cuts out, the first may leave the second to be seen.
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

/// The faces of all objects that are blended over what is behind them.
fn blended_faces(scene: &Scene) -> Vec<[u32; 2]> {
    let of_object = |(number, (_, mesh)): (u32, (&Object, &Mesh))| {
        let faces = if mesh.has_blend() { mesh.model().faces.len() as u32 } else { 0 };
        (0..faces).map(move |face| [number, face])
    };
    let is_blended = |&[object, face]: &[u32; 2]| scene.material(object, face).alpha_mode == AlphaMode::Blend;
    (0u32..).zip(scene.placed_objects()).flat_map(of_object).filter(is_blended).collect()
}

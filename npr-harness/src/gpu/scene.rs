//! A scene on the device.

use super::context::GpuContext;
use super::materials::{Materials, buffer};
use crate::error::HarnessError;
use crate::hatch::HatchVertex;
use crate::hatch::gpu::HatchTextures;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::shadow::gpu::ShadowCasting;
use bytemuck::Zeroable;
use glam::Vec4;
use npr_hatch::upload::TamChannels;
use npr_mesh::AlphaMode;
use npr_outline::fin_pass::FinsOnDevice;
use npr_outline::line_pass::EdgesOnDevice;
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// On a software adapter, see [`HarnessError::TooManyDraws`].
const SOFTWARE_DRAWS: usize = 2048;

/// Faces of one material, or of several materials with the same appearance, drawn by one call.
pub(super) struct Batch {
    /// The first of them.
    pub(super) material: usize,
    pub(super) indices: Range<u32>,
}

/// What of a scene stays the same from frame to frame.
pub struct GpuScene {
    /// Position and normal, interleaved.
    pub(super) vertices: wgpu::Buffer,
    /// Texture coordinate and colour, where any surface looks one up.
    pub(super) lookups: Option<wgpu::Buffer>,
    /// Per vertex its region, where lines are found in the image.
    pub(super) regions: Option<wgpu::Buffer>,
    /// Faces that are not blended, by material.
    pub(super) indices: Option<wgpu::Buffer>,
    pub(super) batches: Vec<Batch>,
    /// Faces that are blended; sorted anew for each view.
    pub(super) blended_faces: Vec<u32>,
    pub(super) materials: Materials,
    /// How many draws a pass may take.
    pub(super) most_draws: usize,
    /// Edges, where lines are found on the device.
    pub(super) edges: Option<EdgesOnDevice>,
    /// Fins for all edges, where the printed form is drawn.
    pub(super) fins: Option<FinsOnDevice>,
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
        let model = &scene.model;
        let buffer = |what, contents: &[u8], usage| buffer(context, what, contents, usage);
        let split =
            plan.image.as_ref().map(|image| split_by_region(&model.faces, &image.face_region, model.positions.len()));
        let more: &[u32] = split.as_ref().map_or(&[], |split| &split.more);
        // All vertices, and again those that stand in several regions.
        let sources = || (0..model.positions.len()).chain(more.iter().map(|&vertex| vertex as usize));
        let vertices: Vec<[f32; 6]> = sources()
            .map(|i| {
                let (p, n) = (model.positions[i], model.normals[i]);
                [p.x, p.y, p.z, n.x, n.y, n.z]
            })
            .collect();
        let vertices = buffer("vertices", bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX)?;
        let lookups = if plan.looks_up || interpolates_light {
            let lookups: Vec<[f32; 6]> = sources()
                .map(|i| {
                    let uv = model.uvs.get(i).copied().unwrap_or_default();
                    let color = model.colors.get(i).copied().unwrap_or(Vec4::ONE);
                    [uv.x, uv.y, color.x, color.y, color.z, color.w]
                })
                .collect();
            Some(buffer("texture coordinates and colours", bytemuck::cast_slice(&lookups), wgpu::BufferUsages::VERTEX)?)
        } else {
            None
        };
        let no_regions = (split.is_none() && interpolates_light).then(|| vec![0u32; model.positions.len()]);
        let regions = match split.as_ref().map(|split| &split.regions).or(no_regions.as_ref()) {
            Some(regions) => Some(buffer("regions", bytemuck::cast_slice(regions), wgpu::BufferUsages::VERTEX)?),
            None => None,
        };
        let hatch = match plan.hatch() {
            Some(hatch) => {
                let vertex = |i: usize| hatch.vertices.get(i).copied().unwrap_or(HatchVertex::zeroed());
                let vertices: Vec<HatchVertex> = sources().map(vertex).collect();
                let channels = if plan.half_float_maps { TamChannels::HalfFloats } else { TamChannels::Bytes };
                let vertices = buffer("strokes", bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX)?;
                Some((vertices, HatchTextures::new(context, hatch, channels)?))
            }
            None => None,
        };
        let faces = split.as_ref().map_or(&model.faces, |split| &split.faces);
        let materials = Materials::new(context, material_layout, scene, plan)?;
        let (indices, batches, blended_faces) = batches(scene, faces, &materials.duplicates);
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
            blended_faces,
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

fn batches(scene: &Scene, faces: &[[u32; 3]], duplicates: &[usize]) -> (Vec<u32>, Vec<Batch>, Vec<u32>) {
    let model = &scene.model;
    let first = |face: u32| duplicates[model.face_material[face as usize] as usize];
    let is_blended =
        |face: u32| model.materials[model.face_material[face as usize] as usize].alpha_mode == AlphaMode::Blend;
    let (blended, mut solid): (Vec<u32>, Vec<u32>) = (0..model.faces.len() as u32).partition(|&f| is_blended(f));
    // Stable, so that the faces of a material keep the order of the file, whose neighbours share vertices.
    solid.sort_by_key(|&face| first(face));
    // Behind a face with the same corners, drawn before, none passes the depth test; a file with half a million of them
    // is to be drawn all the same. Where alpha cuts out, the first may leave the second to be seen.
    if !scene.edges.further_faces.is_empty() || scene.edges.skipped.iter().any(|&skipped| skipped) {
        let mut seen = HashSet::new();
        solid.retain(|&face| {
            let corners = model.faces[face as usize].map(|v| scene.edges.representative[v as usize]);
            let material = first(face);
            matches!(model.materials[material].alpha_mode, AlphaMode::Mask { .. }) || seen.insert((material, corners))
        });
    }
    let mut batches: Vec<Batch> = Vec::new();
    let mut indices = Vec::with_capacity(3 * solid.len());
    for face in solid {
        let material = first(face);
        let start = indices.len() as u32;
        indices.extend(faces[face as usize]);
        match batches.last_mut() {
            Some(batch) if batch.material == material => batch.indices.end += 3,
            _ => batches.push(Batch { material, indices: start..start + 3 }),
        }
    }
    (indices, batches, blended)
}

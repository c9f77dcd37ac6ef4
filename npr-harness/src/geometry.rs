//! The vertices, faces and materials of a scene as an adapter gets them: which attributes of a vertex a plan reads, which
//! vertices are copied, which faces are drawn together.

use crate::color::encode_rgb;
use crate::hatch::HatchMapping;
use crate::plan::{Emission, PaintPlan, Plan};
use crate::scene::{Mesh, Object, Scene};
use crate::texel_format::level_count;
use glam::Vec3;
use npr_mesh::{AlphaMode, Model};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// The data of an object, bytes.
pub(crate) const INSTANCE_BYTES: u64 = 84;

/// The attributes of vertices that surfaces are drawn with, besides positions. Each has a buffer of its own, so that none
/// is uploaded that no pixel depends on; a shader that declares another gets the same value at every vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Streams {
    pub(crate) normals: bool,
    pub(crate) uvs: bool,
    pub(crate) colors: bool,
    /// Regions, where they differ within a mesh.
    pub(crate) regions: bool,
    /// The directions of strokes.
    pub(crate) directions: bool,
    /// The densities of texture coordinates, for strokes.
    pub(crate) octaves: bool,
}

/// The sizes of a vertex in the buffers, bytes.
pub(crate) const POSITION_BYTES: u64 = 12;
pub(crate) const NORMAL_BYTES: u64 = 12;
pub(crate) const UV_BYTES: u64 = 8;
pub(crate) const COLOR_BYTES: u64 = 16;
pub(crate) const REGION_BYTES: u64 = 4;
pub(crate) const DIRECTION_BYTES: u64 = 24;
pub(crate) const OCTAVE_BYTES: u64 = 4;

impl Streams {
    pub(crate) fn new(scene: &Scene, plan: &Plan) -> Self {
        let mapping = plan.hatch().map(|hatch| hatch.shade.mapping);
        let has_colors = || scene.meshes().iter().any(|mesh| !mesh.model().colors.is_empty());
        Self {
            normals: plan.paint.is_some() || plan.image.is_some(),
            uvs: plan.textures.contains(&true) || mapping == Some(HatchMapping::Coordinates),
            colors: plan.looks_up && has_colors(),
            regions: plan.image.as_ref().is_some_and(|image| image.regions.of_whole_meshes.contains(&None)),
            directions: mapping == Some(HatchMapping::Form),
            octaves: mapping == Some(HatchMapping::Coordinates),
        }
    }
}

/// Per mesh: its vertices, if they are not those of the model.
pub(crate) fn splits(scene: &Scene, plan: &Plan, streams: Streams) -> Vec<Option<Split>> {
    let lights_faces = plan.paint.as_ref().is_some_and(PaintPlan::lights_faces);
    let regions_of = plan.image.as_ref().filter(|_| streams.regions).map(|image| &image.regions);
    let split = |(number, mesh): (usize, &Arc<Mesh>)| {
        let model = mesh.model();
        let regions = regions_of.map(|of| of.of_meshes[number].as_slice());
        if lights_faces {
            return Some(split_all(&model.faces, regions));
        }
        regions.map(|regions| split_by_region(&model.faces, regions, model.positions.len()))
    };
    scene.meshes().iter().enumerate().map(split).collect()
}

/// The vertices of a mesh that its vertices on the device are copies of.
pub(crate) fn sources<'a>(model: &Model, split: &'a Option<Split>) -> impl Iterator<Item = usize> + use<'a> {
    let copied = split.as_ref().map(|split| split.sources.as_slice());
    (0..copied.map_or(model.positions.len(), <[u32]>::len)).map(move |i| copied.map_or(i, |of| of[i] as usize))
}

/// A vertex list in which each vertex belongs to one region, or to one face.
pub(crate) struct Split {
    /// Per vertex: the vertex of the model that it is a copy of.
    pub(crate) sources: Vec<u32>,
    /// Per vertex: its region; empty if there are no regions.
    pub(crate) regions: Vec<u32>,
    pub(crate) faces: Vec<[u32; 3]>,
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

/// Faces of a mesh that have the same material, or materials of the same appearance, drawn by one call.
pub(crate) struct Batch {
    /// The index in the mesh of the first of these materials.
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "a device alone reads it"))]
    pub(crate) material: usize,
    /// Whether only the fronts of its faces are shown, whatever the material says.
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "a device alone reads it"))]
    pub(crate) one_sided: bool,
    pub(crate) indices: Range<u32>,
}

/// Adds a mesh's unblended faces to the index buffer, sorted by material, and returns their batches.
///
/// - `faces`: their vertices, relative to the mesh's first;
/// - `duplicates`: per material of the mesh, the scene index of the first material with the same appearance.
pub(crate) fn add_batches(
    mesh: &Mesh,
    faces: &[[u32; 3]],
    duplicates: &[usize],
    first_vertex: u32,
    indices: &mut Vec<u32>,
) -> Vec<Batch> {
    let model = mesh.model();
    let material = |face: u32| model.face_material[face as usize] as usize;
    let look = |face: u32| (duplicates[material(face)], model.is_one_sided(face));
    let mut solid: Vec<u32> =
        (0..faces.len() as u32).filter(|&f| model.materials[material(f)].alpha_mode != AlphaMode::Blend).collect();
    // The sort is stable: the faces of a material keep the order of the file, in which neighbours share vertices.
    solid.sort_by_key(|&face| look(face));
    // What is left of a cut-out is seen on an opaque face at its place, and of several the later in the file.
    if mesh.has_coincident_cut_outs() {
        let is_cut_out = |face: u32| matches!(model.materials[material(face)].alpha_mode, AlphaMode::Mask { .. });
        solid.sort_by_key(|&face| (is_cut_out(face), if is_cut_out(face) { face } else { 0 }));
    }
    let mut batches: Vec<Batch> = Vec::new();
    indices.reserve(3 * solid.len());
    let mut last = None;
    for face in solid {
        let start = indices.len() as u32;
        indices.extend(faces[face as usize].map(|vertex| first_vertex + vertex));
        match batches.last_mut() {
            Some(batch) if last == Some(look(face)) => batch.indices.end += 3,
            _ => batches.push(Batch {
                material: material(face),
                one_sided: model.is_one_sided(face),
                indices: start..start + 3,
            }),
        }
        last = Some(look(face));
    }
    batches
}

/// The blended faces of all objects.
pub(crate) fn blended_faces(scene: &Scene) -> Vec<[u32; 2]> {
    let of_object = |(number, (_, mesh)): (u32, (&Object, &Mesh))| {
        let faces = if mesh.has_blend() { mesh.model().faces.len() as u32 } else { 0 };
        (0..faces).map(move |face| [number, face])
    };
    let is_blended = |&[object, face]: &[u32; 2]| scene.material(object, face).alpha_mode == AlphaMode::Blend;
    (0u32..).zip(scene.placed_objects()).flat_map(of_object).filter(is_blended).collect()
}

/// The size of an index, bytes: 2 if all vertices have numbers of 16 bits.
pub(crate) const fn index_bytes(vertices: usize) -> u64 {
    if vertices <= 1 << 16 { 2 } else { 4 }
}

/// The number of indices of all unblended faces.
pub(crate) fn index_count(scene: &Scene, splits: &[Option<Split>], duplicates: &[usize]) -> u64 {
    let mut indices = Vec::new();
    let mut count = 0;
    for (number, mesh) in scene.meshes().iter().enumerate() {
        let faces = splits[number].as_ref().map_or(&mesh.model().faces, |split| &split.faces);
        add_batches(mesh, faces, &duplicates[scene.materials_of(number)], 0, &mut indices);
        count += indices.len() as u64;
        indices.clear();
    }
    count
}

/// Whether a material's colour varies over a face or its alpha is tested.
pub(crate) fn is_looked_up(scene: &Scene, plan: &Plan, material: usize) -> bool {
    let m = &scene.materials()[material];
    let colored = || scene.meshes().iter().any(|mesh| !mesh.model().colors.is_empty());
    m.texture.is_some()
        || matches!(m.alpha_mode, AlphaMode::Mask { .. })
        || plan.emission(m) == Emission::Textured
        || colored()
}

/// `SurfaceMaterial` of `surface.wgsl`.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct MaterialUniform {
    pub(crate) base_color: [f32; 4],
    pub(crate) texture_size: [f32; 2],
    pub(crate) last_level: f32,
    pub(crate) cutoff: f32,
    pub(crate) wrap: [u32; 2],
    pub(crate) emissive_size: [f32; 2],
    pub(crate) emissive: [f32; 4],
}

/// The materials of a scene as a device gets them.
pub(crate) struct MaterialTable {
    /// Per material: the first material with the same appearance.
    pub(crate) duplicates: Vec<usize>,
    /// The pairs of textures that are bound together, of the colour and of the emission: their numbers among those that are
    /// read, or the number of these where there is none.
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "a device alone reads it"))]
    pub(crate) pairs: Vec<[usize; 2]>,
    /// Per material: the index of its pair of textures, and its offset in the uniform buffer, bytes.
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "a device alone reads it"))]
    pub(crate) places: Vec<(usize, u32)>,
    /// The uniforms of all distinct materials, at multiples of a stride; those of one where there are none.
    pub(crate) uniforms: Vec<u8>,
}

/// `stride`: the distances between uniforms are multiples of it, bytes.
pub(crate) fn material_table(scene: &Scene, plan: &Plan, stride: usize) -> MaterialTable {
    let stride = size_of::<MaterialUniform>().next_multiple_of(stride);
    let read = plan.textures.iter().filter(|&&used| used).count();
    let mut next = 0..read;
    let mut group = |used: &bool| if *used { next.next() } else { None }.unwrap_or(read);
    let groups: Vec<usize> = plan.textures.iter().map(&mut group).collect();
    // Those without an emissive texture come first, in the order of the textures.
    let mut pairs: Vec<[usize; 2]> = (0..=read).map(|texture| [texture, read]).collect();
    let mut pair_of: HashMap<[usize; 2], usize> = pairs.iter().copied().zip(0..).collect();
    let mut uniforms: Vec<u8> = Vec::new();
    let mut first: HashMap<_, usize> = HashMap::new();
    let (mut duplicates, mut places) = (Vec::new(), Vec::new());
    for (number, material) in scene.materials().iter().enumerate() {
        let texture = material.texture.map(|texture| texture as usize).filter(|&texture| plan.textures[texture]);
        let (width, height) = texture.map_or((1, 1), |texture| {
            let texture = &scene.textures()[texture];
            (texture.width, texture.height)
        });
        let cutoff = if let AlphaMode::Mask { cutoff } = material.alpha_mode { cutoff } else { f32::MIN };
        let emission = plan.emission(material);
        let emissive_texture = material.emissive_texture.filter(|_| emission == Emission::Textured);
        let emissive_size = emissive_texture.map_or((1, 1), |texture| {
            let texture = &scene.textures()[texture as usize];
            (texture.width, texture.height)
        });
        let emissive = match emission {
            Emission::None => Vec3::ZERO,
            Emission::Constant => encode_rgb(material.emissive.as_dvec3()).as_vec3(),
            Emission::Textured => material.emissive,
        };
        let base_color = if is_looked_up(scene, plan, number) {
            material.base_color
        } else {
            scene.material_colors[number].as_vec3().extend(material.base_color.w)
        };
        let uniform = MaterialUniform {
            base_color: base_color.to_array(),
            texture_size: [width as f32, height as f32],
            last_level: (level_count((width, height)) - 1) as f32,
            cutoff,
            wrap: material.texture.map_or([0; 2], |t| scene.textures()[t as usize].wrap.map(|wrap| wrap as u32)),
            emissive_size: [emissive_size.0 as f32, emissive_size.1 as f32],
            emissive: emissive.extend((level_count(emissive_size) - 1) as f32).to_array(),
        };
        let bytes: [u8; size_of::<MaterialUniform>()] = bytemuck::cast(uniform);
        // Further properties on which the pipeline of a draw depends.
        let line_kind = plan.image.as_ref().and_then(|image| image.line_kinds.get(number)).map(|&kind| kind as u32);
        let is_blended = material.alpha_mode == AlphaMode::Blend;
        // Where only depth is drawn, materials differ by what is left of their faces.
        let is_hidden = plan.paint.is_none()
            && plan.image.is_none()
            && !is_blended
            && !matches!(material.alpha_mode, AlphaMode::Mask { .. });
        let read_textures = [material.texture, emissive_texture];
        let (seen, read_textures) = if is_hidden { (None, [None; 2]) } else { (Some(bytes), read_textures) };
        let looked_up = !is_hidden && is_looked_up(scene, plan, number);
        let key = (seen, read_textures, emission, material.double_sided, looked_up, is_blended, line_kind);
        let same = *first.entry(key).or_insert(number);
        duplicates.push(same);
        if same == number {
            let group = |texture: Option<usize>| texture.map_or(read, |texture| groups[texture]);
            let pair = [group(texture), group(emissive_texture.map(|texture| texture as usize))];
            let pair = *pair_of.entry(pair).or_insert_with(|| {
                pairs.push(pair);
                pairs.len() - 1
            });
            places.push((pair, uniforms.len() as u32));
            uniforms.extend(bytes);
            uniforms.resize(uniforms.len().next_multiple_of(stride), 0);
        } else {
            places.push(places[same]);
        }
    }
    if uniforms.is_empty() {
        uniforms.resize(stride, 0);
    }
    MaterialTable { duplicates, pairs, places, uniforms }
}

//! Finer meshes of the same shape.

use glam::Vec3;

use crate::Model;

/// Each triangle cut into four at the midpoints of its edges; the shape stays.
///
/// Positions, texture coordinates and colours of the new vertices are means, normals are means of unit length (where
/// two are opposite, one of them). Two faces that share both vertices of an edge share its midpoint too; across a seam
/// the two midpoints stand at one position, to the last bit. The old vertices keep their numbers, the new ones follow
/// in the order in which the faces meet them, and the four faces
/// from face f are 4f to 4f + 3: at its corners, then the middle one. They belong to its polygon, and are polygons by
/// themselves where [`Model::face_polygon`] is empty.
pub fn subdivide_midpoint(model: &Model) -> Model {
    // Sorted by edge; equal edges then stand together and get one vertex. Sorting beats hashing here.
    let mut sides = Vec::with_capacity(model.faces.len() * 3);
    for (face, &[a, b, c]) in model.faces.iter().enumerate() {
        for (side, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
            let edge = (u64::from(from.min(to)) << 32) | u64::from(from.max(to));
            sides.push((edge, face as u32, side as u32));
        }
    }
    sides.sort_unstable();
    let mut midpoints = vec![[0; 3]; model.faces.len()];
    for (number, edge) in (0u32..).zip(sides.chunk_by(|a, b| a.0 == b.0)) {
        for &(_, face, side) in edge {
            midpoints[face as usize][side as usize] = number;
        }
    }
    // Numbered as the faces meet them, so that what a face needs stands together in memory.
    let mut edges: Vec<[usize; 2]> = Vec::with_capacity(sides.len() / 2);
    let mut numbered = vec![u32::MAX; sides.len()];
    for (&[a, b, c], of_face) in model.faces.iter().zip(&mut midpoints) {
        for (midpoint, ends) in of_face.iter_mut().zip([[a, b], [b, c], [c, a]]) {
            let number = &mut numbered[*midpoint as usize];
            if *number == u32::MAX {
                *number = (model.positions.len() + edges.len()) as u32;
                edges.push(ends.map(|end| end as usize));
            }
            *midpoint = *number;
        }
    }

    let mut fine = Model {
        positions: model.positions.clone(),
        normals: model.normals.clone(),
        uvs: model.uvs.clone(),
        colors: model.colors.clone(),
        faces: Vec::with_capacity(model.faces.len() * 4),
        face_material: four_each(&model.face_material),
        face_mesh: four_each(&model.face_mesh),
        face_polygon: four_each(&model.face_polygon),
        materials: model.materials.clone(),
        textures: model.textures.clone(),
    };
    fine.positions.extend(edges.iter().map(|&[a, b]| model.positions[a].midpoint(model.positions[b])));
    fine.normals.extend(edges.iter().map(|&[a, b]| mean_normal(model.normals[a], model.normals[b])));
    if !model.uvs.is_empty() {
        fine.uvs.extend(edges.iter().map(|&[a, b]| model.uvs[a].midpoint(model.uvs[b])));
    }
    if !model.colors.is_empty() {
        fine.colors.extend(edges.iter().map(|&[a, b]| model.colors[a].midpoint(model.colors[b])));
    }
    for (&[a, b, c], &[ab, bc, ca]) in model.faces.iter().zip(&midpoints) {
        fine.faces.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    fine
}

fn four_each(values: &[u32]) -> Vec<u32> {
    values.iter().flat_map(|&value| [value; 4]).collect()
}

fn mean_normal(a: Vec3, b: Vec3) -> Vec3 {
    (a + b).normalize_or(a)
}

//! Midpoint subdivision.

use glam::Vec3;

use crate::{Model, SideVisibility};

/// Splits each triangle into four at the midpoints of its edges. The shape is unchanged.
///
/// Positions, texture coordinates and colours of new vertices are means. Normals are normalised means, or one of the
/// two if they are opposite. Two faces that share both vertices of an edge share its midpoint; across a seam both
/// midpoints have bitwise equal positions. Existing vertices keep their numbers, and new ones follow in the order in
/// which the faces use them. The four faces of face f are 4f to 4f + 3, first those at its corners and then the
/// middle one. They belong to its polygon, or are polygons of their own if [`Model::face_polygon`] is empty.
pub fn subdivide_midpoint(model: &Model) -> Model {
    // Sorted by edge, so that equal edges are adjacent and get one vertex. Sorting is faster than hashing here.
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
    // Numbered in the order in which the faces use them, so that the vertices of a face are close in memory.
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
        one_sided: model.one_sided.iter().flat_map(|&one_sided| [one_sided; 4]).collect(),
        lines: model.lines.clone(),
        side_visibility: model.side_visibility.iter().flat_map(four_sides).collect(),
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

/// Both halves of a side are what the side is; the sides of the middle face are diagonals, which are never lines.
fn four_sides(&[ab, bc, ca]: &[SideVisibility; 3]) -> [[SideVisibility; 3]; 4] {
    let inner = if ab == SideVisibility::Unstated { ab } else { SideVisibility::Hidden };
    [[ab, inner, ca], [ab, bc, inner], [inner, bc, ca], [inner; 3]]
}

fn mean_normal(a: Vec3, b: Vec3) -> Vec3 {
    (a + b).normalize_or(a)
}

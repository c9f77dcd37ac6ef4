//! Which faces are shown from one side only.

use npr_mesh::Model;
use npr_mesh::edges::Edges;
use std::collections::HashSet;

/// Per face whether an eye behind it does not see it; empty if all faces are shown from both sides.
///
/// `double_sided`: that of all faces; `None` for what their materials say. `edges`: of this model.
///
/// Of faces with the same corners only the first is among the edges; it is shown from behind if one of the others is shown
/// there.
pub fn single_sided_faces(model: &Model, edges: &Edges, double_sided: Option<bool>) -> Vec<bool> {
    let is_double = |face: u32| {
        double_sided.unwrap_or_else(|| model.material_of(face).is_none_or(|material| material.double_sided))
    };
    // Most models have materials of one kind, which need no look at their faces.
    if double_sided.unwrap_or_else(|| model.face_material.is_empty() || model.materials.iter().all(|m| m.double_sided))
    {
        return Vec::new();
    }
    let mut single: Vec<bool> = (0..model.faces.len() as u32).map(|face| !is_double(face)).collect();
    let corners = |face: u32| rotated(model.faces[face as usize].map(|vertex| edges.representative[vertex as usize]));
    let mut shown_behind = HashSet::new();
    for (face, _) in (0u32..).zip(&edges.skipped).filter(|&(_, &skipped)| skipped) {
        let [a, b, c] = corners(face);
        shown_behind.insert(rotated([a, c, b]));
        if is_double(face) {
            shown_behind.insert([a, b, c]);
        }
    }
    if !shown_behind.is_empty() {
        for (face, single) in (0u32..).zip(&mut single) {
            *single &= !shown_behind.contains(&corners(face));
        }
    }
    single
}

/// The corners of a face, beginning with the lowest, in the order of its winding.
fn rotated([a, b, c]: [u32; 3]) -> [u32; 3] {
    match a.min(b).min(c) {
        low if low == a => [a, b, c],
        low if low == b => [b, c, a],
        _ => [c, a, b],
    }
}

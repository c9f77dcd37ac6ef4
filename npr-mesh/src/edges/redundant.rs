//! Selects the redundant faces to skip.

use crate::weld::Rounding;
use glam::Vec3;
use std::collections::HashMap;

/// The duplicates and the faces with two corners at one position, of those that are polygons of their own.
///
/// A triangle of a larger polygon may coincide with a triangle of another polygon although the polygons differ, so
/// triangles of larger polygons are kept. Of the others the first is kept, if no larger polygon has the same triangle.
pub(super) fn skip_redundant(
    skipped: &mut Vec<bool>,
    collapsed: &[u32],
    twins: &mut [[u32; 2]],
    faces: usize,
    face_polygon: &[u32],
) {
    let is_cut = |face: u32| {
        let face = face as usize;
        !face_polygon.is_empty()
            && (face.checked_sub(1).is_some_and(|before| face_polygon[before] == face_polygon[face])
                || face_polygon.get(face + 1) == Some(&face_polygon[face]))
    };
    let mut skip = |face: u32| {
        skipped.resize(faces, false);
        skipped[face as usize] = true;
    };
    collapsed.iter().copied().filter(|&face| !is_cut(face)).for_each(&mut skip);
    // Faces with the same corners form a chain of pairs.
    twins.sort_unstable_by_key(|pair| pair[1]);
    let mut first_of = HashMap::new();
    let mut members = Vec::new();
    for &[before, face] in &*twins {
        let first = first_of.get(&before).copied().unwrap_or(before);
        first_of.insert(face, first);
        members.extend([(first, before), (first, face)]);
    }
    members.sort_unstable();
    members.dedup();
    for same in members.chunk_by(|a, b| a.0 == b.0) {
        let in_larger = same.iter().any(|of| is_cut(of.1));
        let whole = same.iter().map(|of| of.1).filter(|&face| !is_cut(face));
        whole.skip(usize::from(!in_larger)).for_each(&mut skip);
    }
}

/// The polygons of which no triangle has an area that rounding does not account for.
///
/// The sum of the area vectors does not decide, since that of an outline that crosses itself may be zero.
pub(super) fn skip_without_area(
    skipped: &mut Vec<bool>,
    positions: &[Vec3],
    faces: &[[u32; 3]],
    face_polygon: &[u32],
    rounding: &Rounding,
) {
    let is_flat = |face: &u32| rounding.has_no_area(faces[*face as usize].map(|vertex| positions[vertex as usize]));
    let polygon = |face: u32| face_polygon.get(face as usize).copied();
    // The thin faces of one polygon, of which there may be others.
    for thin in rounding.thin.chunk_by(|&a, &b| polygon(a).is_some() && polygon(a) == polygon(b)) {
        let (first, last) = (thin[0], thin[thin.len() - 1]);
        let is_whole = polygon(first).is_none()
            || (last - first + 1 == thin.len() as u32
                && (first == 0 || polygon(first - 1) != polygon(first))
                && polygon(last + 1) != polygon(last));
        if is_whole && thin.iter().all(is_flat) {
            skipped.resize(faces.len(), false);
            skipped[first as usize..=last as usize].fill(true);
        }
    }
}

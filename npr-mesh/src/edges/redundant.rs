//! Selects the redundant faces to skip.

/// Which faces to skip; empty if none.
///
/// A triangle of a larger polygon may coincide with a triangle of another polygon although the polygons differ, so
/// triangles of larger polygons are kept.
pub(super) fn skippable(redundant: &[u32], faces: usize, face_polygon: &[u32]) -> Vec<bool> {
    let is_cut = |face: usize| {
        !face_polygon.is_empty()
            && (face.checked_sub(1).is_some_and(|before| face_polygon[before] == face_polygon[face])
                || face_polygon.get(face + 1) == Some(&face_polygon[face]))
    };
    let mut skipped = Vec::new();
    for &face in redundant.iter().filter(|&&face| !is_cut(face as usize)) {
        skipped.resize(faces, false);
        skipped[face as usize] = true;
    }
    skipped
}

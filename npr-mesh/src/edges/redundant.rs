//! Faces that add nothing to be seen: which of those found to lie on others are left out.

/// Which faces to leave out; empty if none.
///
/// A triangle cut from a larger polygon may coincide with one cut from another without the polygons doing so; such
/// polygons are left alone.
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

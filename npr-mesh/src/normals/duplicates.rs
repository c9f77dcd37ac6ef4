//! Finds faces that are there more than once.

use std::ops::Range;

/// Per face whether its polygon has the same corners as an earlier one, in any order; empty if none has.
///
/// - `face_polygon`: as [`crate::Model::face_polygon`].
/// - `representative`: per vertex the representative of its position.
///
/// A bit set over hash values finds candidates; only these are sorted by their corners. The expected time is linear if few
/// are there twice.
pub(super) fn duplicates(faces: &[[u32; 3]], face_polygon: &[u32], representative: &[u32]) -> Vec<bool> {
    let bits = (8 * faces.len()).next_power_of_two().max(64);
    let shift = 64 - bits.trailing_zeros();
    let mut met = vec![0u64; bits / 64];
    let mut met_twice = Vec::new();
    let mut corners = Vec::new();
    for polygon in polygons(faces.len(), face_polygon) {
        corners_of(&faces[polygon], representative, &mut corners);
        let (word, bit) = place(&corners, shift);
        if met[word] & bit != 0 {
            met_twice.push((word, bit));
        }
        met[word] |= bit;
    }
    if met_twice.is_empty() {
        return Vec::new();
    }
    let mut shared = met;
    shared.fill(0);
    for (word, bit) in met_twice {
        shared[word] |= bit;
    }
    let mut candidates: Vec<(Vec<u32>, Range<usize>)> = Vec::new();
    for polygon in polygons(faces.len(), face_polygon) {
        corners_of(&faces[polygon.clone()], representative, &mut corners);
        let (word, bit) = place(&corners, shift);
        if shared[word] & bit != 0 && corners.len() > 2 {
            candidates.push((corners.clone(), polygon));
        }
    }
    candidates.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.start.cmp(&b.1.start)));
    let mut found = Vec::new();
    for pair in candidates.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        found.resize(faces.len(), false);
        found[pair[1].1.clone()].fill(true);
    }
    found
}

/// The faces of each polygon.
fn polygons(faces: usize, face_polygon: &[u32]) -> impl Iterator<Item = Range<usize>> {
    let mut next = 0;
    std::iter::from_fn(move || {
        let start = next;
        if start == faces {
            return None;
        }
        next += 1;
        while next < faces && face_polygon.get(next).is_some_and(|polygon| *polygon == face_polygon[start]) {
            next += 1;
        }
        Some(start..next)
    })
}

/// The different corners of a polygon, ascending.
fn corners_of(faces: &[[u32; 3]], representative: &[u32], corners: &mut Vec<u32>) {
    corners.clear();
    corners.extend(faces.iter().flatten().map(|&vertex| representative[vertex as usize]));
    corners.sort_unstable();
    corners.dedup();
}

/// The word and the bit of a polygon in a set of 2^(64 − `shift`) bits.
fn place(corners: &[u32], shift: u32) -> (usize, u64) {
    let mix = |hash: u64, corner: &u32| (hash ^ u64::from(*corner)).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    let bit = corners.iter().fold(0, mix).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> shift;
    ((bit / 64) as usize, 1 << (bit % 64))
}

//! Finds the side of a face that an edge runs along.

use glam::Vec3;

/// The side of a face that an edge runs along: i for the side from corner i to the next, and whether the side runs in the
/// direction of the edge.
///
/// - `corners`: the face's corners, as representatives ([`super::Edges::representative`]).
/// - `ends`: the edge's.
///
/// An edge at a T-junction may be a part of the side; then it is the side whose line is nearest to both ends. If two
/// corners coincide with both ends, it is the first such side.
pub fn side_of(positions: &[Vec3], corners: [u32; 3], ends: [u32; 2]) -> (usize, bool) {
    let sides = [[corners[0], corners[1]], [corners[1], corners[2]], [corners[2], corners[0]]];
    if let Some(side) = sides.iter().position(|side| *side == ends) {
        return (side, true);
    }
    if let Some(side) = sides.iter().position(|side| [side[1], side[0]] == ends) {
        return (side, false);
    }
    let place = |vertex: u32| positions[vertex as usize].as_dvec3();
    let [from, to] = ends.map(place);
    let off = |side: &[u32; 2]| {
        let [start, end] = side.map(place);
        let along = (end - start).normalize_or_zero();
        let beside = |point: glam::DVec3| (point - start).cross(along).length_squared();
        beside(from).max(beside(to))
    };
    let is_long = |side: &&[u32; 2]| side[0] != side[1];
    let nearest = sides.iter().filter(is_long).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(&sides[0]);
    let side = sides.iter().position(|side| side == nearest).unwrap_or(0);
    let [start, end] = nearest.map(place);
    (side, (end - start).dot(to - from) > 0.0)
}

/// Whether a face traverses an edge in the direction from its first to its second end. Arguments as for [`side_of`].
pub fn runs_along(positions: &[Vec3], corners: [u32; 3], ends: [u32; 2]) -> bool {
    side_of(positions, corners, ends).1
}

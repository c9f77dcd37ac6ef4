//! Folded polygons.

use super::edge::Edge;
use super::triangle_normal;
use glam::Vec3;
use std::f32::consts::PI;

/// Keeps only the diagonals of folded polygons: of polygons whose normals differ by more than `fold_rad` at one of
/// their diagonals.
///
/// Faces of zero area have no normal and are ignored. So are opposite triangles in one plane, which occur in flat
/// outlines that intersect themselves.
pub(super) fn keep_folded(
    diagonals: &mut Vec<Edge>,
    positions: &[Vec3],
    faces: &[[u32; 3]],
    face_polygon: &[u32],
    fold_rad: f32,
) {
    let turns = |edge: &&Edge| {
        let [n0, n1] = edge.faces().map(|face| triangle_normal(positions, &faces[face as usize]));
        // Well-conditioned at any angle, and 0 if a normal is zero.
        let turn_rad = n0.cross(n1).length().atan2(n0.dot(n1));
        turn_rad > fold_rad && turn_rad < PI - fold_rad
    };
    let polygon = |edge: &Edge| face_polygon[edge.faces()[0] as usize];
    let mut folded: Vec<u32> = diagonals.iter().filter(turns).map(polygon).collect();
    folded.sort_unstable();
    folded.dedup();
    diagonals.retain(|edge| folded.binary_search(&polygon(edge)).is_ok());
    diagonals.shrink_to_fit();
}

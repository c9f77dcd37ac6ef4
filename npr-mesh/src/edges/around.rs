//! The faces around an edge.
//!
//! Each face at an edge begins as a half-plane there. Faces that overlap at the edge (duplicates in any winding, the
//! same polygon cut along other diagonals, a mark that lies in a larger face) have one half-plane in common and count
//! as one face of the edge.

use super::edge::{Edge, SURROUNDED};
use super::unique::edge_of;
use glam::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};

/// The mesh of the edges.
pub(super) struct Surface<'a> {
    pub positions: &'a [Vec3],
    pub faces: &'a [[u32; 3]],
    pub face_normals: &'a [Vec3],
    /// Distances up to this are rounding.
    pub tolerance: f32,
    /// Whether faces that overlap count once.
    pub merge_overlaps: bool,
}

/// A face at an edge: its number, and whether it traverses the edge from the lower to the upper vertex.
pub(super) type Side = (u32, bool);

/// An edge with all of its faces.
pub(super) struct Around {
    pub edge: Edge,
    /// The third and further faces.
    pub further: Vec<u32>,
    /// Pairs of a face that the edge has and one that overlaps with it there and was left out.
    pub overlaps: Vec<[u32; 2]>,
}

/// Normals are rounded to f32.
const ROUNDED_RAD: f64 = 1e-6;
/// Faces at a larger angle do not overlap, however small they are.
const WIDEST_RAD: f64 = 0.02;

impl Surface<'_> {
    /// The edge of these faces, at least one and in ascending order, of which those that overlap count once.
    ///
    /// If all faces of a non-manifold edge lie within a half-space, the edge is a silhouette where the outer two of them
    /// make it one; these are its first two faces. Of overlapping faces the one with the lowest number remains.
    pub fn edge(&self, [low, high]: [u32; 2], sides: &[Side]) -> Around {
        if !self.merge_overlaps {
            let further = sides.iter().skip(2).map(|side| side.0).collect();
            return Around { edge: edge_of(low, high, sides), further, overlaps: Vec::new() };
        }
        let mut overlaps = Vec::new();
        let mut fans = self.fans([low, high], sides, &mut overlaps);
        let mut flags = 0;
        let mut sides: Vec<Side> = if fans.len() > 2 && fans.iter().all(|fan| fan.angle_rad.is_some()) {
            // The fans are sorted by angle; the widest gap is before the first of them or between two.
            let angle = |at: usize| fans[at % fans.len()].angle_rad.unwrap_or(0.0);
            let gap = |at: usize| (angle(at + 1) - angle(at)).rem_euclid(TAU);
            let widest = (0..fans.len()).max_by(|&a, &b| gap(a).total_cmp(&gap(b))).unwrap_or(0);
            if gap(widest) > PI - 4.0 * ROUNDED_RAD {
                let after = (widest + 1) % fans.len();
                let mut outer = [fans[widest].side, fans[after].side];
                outer.sort_unstable();
                let mut inner: Vec<Side> =
                    fans.iter().map(|fan| fan.side).filter(|side| !outer.contains(side)).collect();
                inner.sort_unstable();
                outer.into_iter().chain(inner).collect()
            } else {
                flags = SURROUNDED;
                fans.iter().map(|fan| fan.side).collect()
            }
        } else {
            fans.sort_unstable_by_key(|fan| fan.side);
            fans.iter().map(|fan| fan.side).collect()
        };
        if flags != 0 {
            sides.sort_unstable();
        }
        let mut edge = edge_of(low, high, &sides);
        edge.packed[1] |= flags;
        Around { edge, further: sides.iter().skip(2).map(|side| side.0).collect(), overlaps }
    }

    /// The half-planes at an edge, sorted by angle, each with one of its faces; faces without a direction are kept apart.
    fn fans(&self, ends: [u32; 2], sides: &[Side], overlaps: &mut Vec<[u32; 2]>) -> Vec<Fan> {
        let [from, to] = ends.map(|vertex| self.positions[vertex as usize].as_dvec3());
        let along = (to - from).normalize_or_zero();
        let direction = |&(face, up): &Side| {
            let inwards = self.face_normals[face as usize].as_dvec3().cross(along).normalize_or_zero();
            if up { inwards } else { -inwards }
        };
        let Some(axis) = sides.iter().map(direction).find(|direction| *direction != DVec3::ZERO) else {
            return sides.iter().map(|&side| Fan { side, angle_rad: None, height: 0.0 }).collect();
        };
        let other_axis = along.cross(axis);
        let mut fans: Vec<Fan> = sides
            .iter()
            .map(|&side| {
                let direction = direction(&side);
                let angle_rad =
                    (direction != DVec3::ZERO).then(|| direction.dot(other_axis).atan2(direction.dot(axis)));
                Fan { side, angle_rad, height: self.height(side.0, from, along) }
            })
            .collect();
        let angle = |fan: &Fan| fan.angle_rad.unwrap_or(f64::INFINITY);
        fans.sort_by(|a, b| angle(a).total_cmp(&angle(b)).then(a.side.cmp(&b.side)));
        let overlap = |a: &Fan, b: &Fan| {
            let (Some(from), Some(to)) = (a.angle_rad, b.angle_rad) else { return false };
            let turn_rad = (to - from).rem_euclid(TAU);
            let tolerance = 4.0 * ROUNDED_RAD + 2.0 * f64::from(self.tolerance) / a.height.min(b.height);
            turn_rad.min(TAU - turn_rad) <= tolerance.min(WIDEST_RAD) && a.side.0 != b.side.0
        };
        // Angles are a circle: begin after a gap, if there is one.
        let count = fans.len();
        let first = (0..count).find(|&at| !overlap(&fans[(at + count - 1) % count], &fans[at])).unwrap_or(0);
        fans.rotate_left(first);
        let mut merged: Vec<Fan> = Vec::with_capacity(count);
        let mut start = 0;
        for end in 1..=count {
            if end < count && overlap(&fans[end - 1], &fans[end]) {
                continue;
            }
            let same = &fans[start..end];
            start = end;
            let kept = *same.iter().min_by_key(|fan| fan.side).unwrap_or(&same[0]);
            overlaps.extend(same.iter().filter(|fan| fan.side.0 != kept.side.0).map(|fan| [kept.side.0, fan.side.0]));
            merged.push(kept);
        }
        merged
    }

    /// The distance of a face's farthest corner from the line of an edge.
    fn height(&self, face: u32, from: DVec3, along: DVec3) -> f64 {
        let corners = self.faces[face as usize].map(|vertex| self.positions[vertex as usize].as_dvec3());
        corners.iter().map(|&corner| (corner - from).cross(along).length()).fold(0.0, f64::max)
    }
}

/// A half-plane at an edge.
#[derive(Clone, Copy)]
struct Fan {
    side: Side,
    /// The angle around the edge; `None` for a face without a normal.
    angle_rad: Option<f64>,
    /// How far the face reaches from the edge.
    height: f64,
}

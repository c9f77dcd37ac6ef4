//! Rays against triangles, in f64: what every other picture of a scene is measured against.
//!
//! A bounding volume hierarchy in f32 (obvhs, a binary one) only proposes triangles, from boxes that are padded by
//! more than its rounding. Whether a triangle is hit, and where, is decided in f64 by the watertight test of Woop,
//! Benthin & Wald 2013 ("Watertight Ray/Triangle Intersection", JCGT 2:1): the corners are moved and sheared so that
//! the ray becomes the z axis, and the signs of three 2D edge functions decide. A sheared corner depends on the ray
//! and that corner only, and the signs are exact for the sheared corners, so a ray through a shared edge or corner
//! hits at least one of the faces there.

use glam::{DVec3, Vec3};
use npr_mesh::edges::has_zero_area;
use obvhs::{BvhBuildParams, aabb::Aabb, bvh2::Bvh2, bvh2::builder::build_bvh2, fast_stack};
use obvhs::{ray::Ray, ray::RayHit};
use std::{ops::ControlFlow, time::Duration};

/// Finds the faces that a ray hits. It is read-only once made, so that several threads can share it.
///
/// Distances are exact to a few units in the last place of f64 times the distance of the ray's origin, up to
/// origins 10⁹ scene sizes away; farther off a face at a silhouette can be missed.
pub struct RayCaster {
    bvh: Bvh2,
    /// In the order of the hierarchy's leaves, so that a leaf's triangles lie together in memory.
    triangles: Vec<Triangle>,
    /// The hierarchy works on (position − centre) / half_size, which is within −1..1.
    center: DVec3,
    half_size: f64,
}

#[derive(Clone, Copy)]
struct Triangle {
    corners: [Vec3; 3],
    face: u32,
}

/// Where a ray meets a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// How far along, in units of the ray's direction.
    pub t: f64,
    /// Which face.
    pub face: u32,
    /// The weight of each of the face's corners, 0..=1; together 1 but for rounding.
    pub barycentric: [f64; 3],
    /// Whether the corners run counter-clockwise as seen from the ray's origin.
    pub front: bool,
}

/// The boxes' padding, where the scene's larger half size is 1. A ray's start and direction are rounded to f32
/// (2⁻²⁴ of at most 2.7), so is a box, its slab test rounds three times on distances of at most 5, and obvhs takes
/// a direction's component under 1.2e-7 for 1.2e-7: together under 2e-6.
const PADDING: f64 = 4e-6;

/// The scene in the hierarchy's units lies within √3 of the origin; the rest is for rounding.
const REACH: f64 = 1.75;

impl RayCaster {
    /// Builds the hierarchy.
    ///
    /// - `positions`: any unit and size within f32.
    /// - `faces`: three vertices each. Faces of zero area and faces with a corner that is not finite are left out:
    ///   no ray hits them.
    ///
    /// # Panics
    /// If a face names a vertex that is not there.
    pub fn new(positions: &[Vec3], faces: &[[u32; 3]]) -> Self {
        let triangles: Vec<Triangle> = (0u32..)
            .zip(faces)
            .map(|(number, face)| (number, face, face.map(|v| positions[v as usize])))
            .filter(|(_, face, corners)| corners.iter().all(|c| c.is_finite()) && !has_zero_area(positions, face))
            .map(|(face, _, corners)| Triangle { corners, face })
            .collect();
        let Some(first) = triangles.first() else {
            return Self { bvh: Bvh2::default(), triangles, center: DVec3::ZERO, half_size: 1.0 };
        };
        let (low, high) = triangles
            .iter()
            .flat_map(|t| t.corners)
            .fold((first.corners[0], first.corners[0]), |(low, high), corner| (low.min(corner), high.max(corner)));
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let center = (low + high) / 2.0;
        let half_size = (high - low).max_element() / 2.0;
        let boxes: Vec<Aabb> = triangles
            .iter()
            .map(|Triangle { corners: [a, b, c], .. }| Aabb {
                min: ((a.min(*b).min(*c).as_dvec3() - center) / half_size - PADDING).as_vec3a(),
                max: ((a.max(*b).max(*c).as_dvec3() - center) / half_size + PADDING).as_vec3a(),
            })
            .collect();
        let mut bvh = build_bvh2(&boxes, BvhBuildParams::fast_build(), &mut Duration::default());
        let triangles = bvh.primitive_indices.iter().map(|&index| triangles[index as usize]).collect();
        // obvhs sizes the traversal's stack by this, counts it before it has optimised the tree, and loses nodes
        // where the stack is full.
        bvh.max_depth = depth(&bvh) + 2;
        Self { bvh, triangles, center, half_size }
    }

    /// The nearest hit with t in `t_range` (both ends included) that `accept` takes; of several at equal t the one
    /// on the lowest-numbered face. `None` too where the origin or direction is not finite or the direction zero.
    ///
    /// `direction` has any length; t is in its units. `accept` sees hits in no particular order and not all of
    /// them, so its answer must depend on the hit only.
    pub fn closest(
        &self,
        origin: DVec3,
        direction: DVec3,
        t_range: (f64, f64),
        mut accept: impl FnMut(&Hit) -> bool,
    ) -> Option<Hit> {
        let mut nearest: Option<Hit> = None;
        self.visit(origin, direction, t_range, |hit| {
            if nearest.is_none_or(|n| hit.t < n.t || (hit.t == n.t && hit.face < n.face)) && accept(&hit) {
                nearest = Some(hit);
            }
            ControlFlow::Continue(nearest.map_or(t_range.1, |n| n.t))
        });
        nearest
    }

    /// Every hit with t in `t_range` (both ends included) that `accept` takes, by ascending t, then by face.
    pub fn all(
        &self,
        origin: DVec3,
        direction: DVec3,
        t_range: (f64, f64),
        mut accept: impl FnMut(&Hit) -> bool,
    ) -> Vec<Hit> {
        let mut hits = Vec::new();
        self.visit(origin, direction, t_range, |hit| {
            if accept(&hit) {
                hits.push(hit);
            }
            ControlFlow::Continue(t_range.1)
        });
        hits.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.face.cmp(&b.face)));
        hits
    }

    /// Whether there is a hit with t in `t_range` (both ends included) that `accept` takes.
    pub fn any(
        &self,
        origin: DVec3,
        direction: DVec3,
        t_range: (f64, f64),
        mut accept: impl FnMut(&Hit) -> bool,
    ) -> bool {
        let mut found = false;
        self.visit(origin, direction, t_range, |hit| {
            found = accept(&hit);
            if found { ControlFlow::Break(()) } else { ControlFlow::Continue(t_range.1) }
        });
        found
    }

    /// Shows `visitor` the hits within `t_range`. It answers with the largest t that still matters.
    fn visit(
        &self,
        origin: DVec3,
        direction: DVec3,
        (t_min, mut t_max): (f64, f64),
        mut visitor: impl FnMut(Hit) -> ControlFlow<(), f64>,
    ) {
        if !(origin.is_finite() && direction.is_finite()) || direction == DVec3::ZERO {
            return;
        }
        // The squares of very long and very short directions leave the range of f64.
        let largest = direction.abs().max_element();
        let length = (direction / largest).length();
        let unit = direction / largest / length;
        // The ray in the hierarchy's units, started near the scene: f32 has no precision to spend on the way there.
        let start = (origin - self.center) / self.half_size;
        let per_t = largest / self.half_size * length;
        let middle = -start.dot(unit);
        if (start + middle * unit).length_squared() > REACH * REACH {
            return;
        }
        let enter = (t_min * per_t).max(middle - REACH);
        let leave = |t: f64| ((t * per_t).min(middle + REACH) - enter) as f32 + PADDING as f32;
        let t_max_f32 = leave(t_max);
        // Not `<`: a NaN in the range means no hit.
        if !(t_min <= t_max && t_max_f32 >= 0.0) {
            return;
        }
        let ray = Ray::new((start + enter * unit).as_vec3a(), unit.as_vec3a(), 0.0, t_max_f32);
        let frame = Frame::new(origin, direction);
        let mut in_leaf = |node: &obvhs::bvh2::node::Bvh2Node, ray: &mut Ray, _: &mut RayHit| {
            let first = node.first_index as usize;
            for triangle in &self.triangles[first..first + node.prim_count as usize] {
                let Some(hit) = frame.intersect(triangle) else { continue };
                if !(t_min <= hit.t && hit.t <= t_max) {
                    continue;
                }
                match visitor(hit) {
                    ControlFlow::Break(()) => return false,
                    ControlFlow::Continue(t) if t < t_max => {
                        t_max = t;
                        ray.tmax = leave(t);
                    }
                    ControlFlow::Continue(_) => {}
                }
            }
            true
        };
        fast_stack!(u32, (96, 192), self.bvh.max_depth, stack, {
            self.bvh.ray_traverse_dynamic(&mut stack, ray, &mut RayHit::none(), &mut in_leaf);
        });
    }
}

/// The ray as the z axis: axes permuted so that its largest component is the third, without changing the handedness,
/// then sheared.
struct Frame {
    origin: DVec3,
    axes: [usize; 3],
    shear_x: f64,
    shear_y: f64,
    along: f64,
}

impl Frame {
    /// `direction` must not be zero.
    fn new(origin: DVec3, direction: DVec3) -> Self {
        let z = direction.abs().max_position();
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        let along = direction[z];
        if along < 0.0 {
            std::mem::swap(&mut x, &mut y);
        }
        Self { origin, axes: [x, y, z], shear_x: direction[x] / along, shear_y: direction[y] / along, along }
    }

    /// A corner relative to the ray: how far beside it, and its depth along the ray's largest component.
    #[inline(always)]
    fn place(&self, corner: Vec3) -> [f64; 3] {
        let p = (corner.as_dvec3() - self.origin).to_array();
        let z = p[self.axes[2]];
        [p[self.axes[0]] - self.shear_x * z, p[self.axes[1]] - self.shear_y * z, z]
    }

    #[inline(always)]
    fn intersect(&self, triangle: &Triangle) -> Option<Hit> {
        let [a, b, c] = triangle.corners.map(|corner| self.place(corner));
        let u = cross(b, c);
        let v = cross(c, a);
        let w = cross(a, b);
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        // Seldom reached: here every weight is made good to two units in its last place.
        let (u, v, w) = (precise_cross(b, c), precise_cross(c, a), precise_cross(a, b));
        let sum = u + v + w;
        if sum == 0.0 {
            return None;
        }
        let barycentric = [u / sum, v / sum, w / sum];
        let z = barycentric[0] * a[2] + barycentric[1] * b[2] + barycentric[2] * c[2];
        Some(Hit { t: z / self.along, face: triangle.face, barycentric, front: sum < 0.0 })
    }
}

/// The third component of the cross product of the first two, with an exact sign.
#[inline(always)]
fn cross(a: [f64; 3], b: [f64; 3]) -> f64 {
    let (p, q) = (a[0] * b[1], a[1] * b[0]);
    let difference = p - q;
    if difference.abs() > 4.0 * f64::EPSILON * (p.abs() + q.abs()) { difference } else { precise_cross(a, b) }
}

/// As [`cross`], to two units in the last place: Kahan's difference of products (Jeannerod, Louvet & Muller 2013,
/// "Further Analysis of Kahan's Algorithm for the Accurate Computation of 2×2 Determinants").
fn precise_cross(a: [f64; 3], b: [f64; 3]) -> f64 {
    let q = a[1] * b[0];
    let rounding = (-a[1]).mul_add(b[0], q);
    a[0].mul_add(b[1], -q) + rounding
}

/// The number of edges on the longest way from the root to a leaf.
fn depth(bvh: &Bvh2) -> usize {
    let mut deepest = 0;
    let mut open: Vec<(u32, usize)> = if bvh.nodes.is_empty() { Vec::new() } else { vec![(0, 0)] };
    while let Some((node, depth)) = open.pop() {
        deepest = deepest.max(depth);
        let node = &bvh.nodes[node as usize];
        if !node.is_leaf() {
            open.extend([(node.first_index, depth + 1), (node.first_index + 1, depth + 1)]);
        }
    }
    deepest
}

#[cfg(test)]
mod tests;

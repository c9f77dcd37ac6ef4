//! Ray casting against triangles in f64, the reference for all other renderings of a scene.
//!
//! A bounding volume hierarchy in f32 (built in `hierarchy.rs` and, where large faces pass through one another, in
//! `cells.rs`; walked by obvhs) only proposes triangles, from boxes that are padded by more than its rounding. Whether a
//! triangle is hit, and where, is decided in f64 by the watertight test of Woop, Benthin & Wald 2013 ("Watertight
//! Ray/Triangle Intersection", JCGT 2:1): the corners are moved and sheared so that the ray becomes the z axis, and the
//! signs of three 2D edge functions decide. A sheared corner depends on the ray and that corner only, and the signs are
//! exact for the sheared corners, so a ray through a shared edge or corner hits at least one of the faces there.

mod boxes;
mod cells;
mod clusters;
mod duplicates;
mod hash;
mod hierarchy;
mod threads;
mod triangle;

use boxes::Boxes;
use cells::{Cell, Content, References, Tree, Whole};
use clusters::CELL;
use glam::{DVec3, Vec3};
use obvhs::{fast_stack, ray::Ray, ray::RayHit};
use std::collections::HashMap;
use std::ops::ControlFlow;
use triangle::{DUPLICATES, Duplicate, PADDING, Triangle};

/// Finds the faces that a ray hits. Threads can share it: the parts of the hierarchy that rays build on demand do not
/// change the results.
///
/// Distances are exact to a few units in the last place of f64 times the distance of the ray's origin, up to
/// origins 10⁹ scene sizes away; farther off a face at a silhouette can be missed.
pub struct RayCaster {
    tree: Tree,
    /// The hierarchy works on (position − centre) / half_size, which is within −1..1.
    whole: Whole,
    /// Groups of duplicate faces with the same winding; each group is represented by one triangle.
    alike: Vec<Vec<Duplicate>>,
}

/// The visitor's response to a hit.
struct Seen {
    /// The upper end of the t range for further hits.
    t_max: f64,
    /// Whether further faces with the same corners can be skipped.
    enough: bool,
}

/// An intersection of a ray and a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The distance in units of the ray's direction.
    pub t: f64,
    /// The index of the object; always 0 in a [`RayCaster`], which has one object.
    pub object: u32,
    /// The index of the face.
    pub face: u32,
    /// The barycentric weights of the corners, 0..=1; they sum to 1 up to rounding.
    pub barycentric: [f64; 3],
    /// Whether the corners run counter-clockwise as seen from the ray's origin.
    pub front: bool,
}

/// The scene in the hierarchy's units lies within √3 of the origin; the margin covers rounding.
const REACH: f64 = 1.75;

impl RayCaster {
    /// The memory of its hierarchy and triangles, bytes, without what rays build on demand.
    pub(crate) fn bytes(&self) -> u64 {
        let Tree { bvh, triangles, .. } = &self.tree;
        let of_tree =
            size_of_val(&bvh.nodes[..]) + size_of_val(&bvh.primitive_indices[..]) + size_of_val(&triangles[..]);
        (of_tree + size_of_val(&self.whole.triangles[..])) as u64
    }

    /// Builds the hierarchy.
    ///
    /// - `positions`: in any unit, within the range of f32.
    /// - `faces`: three vertices each. Faces of zero area and faces with a corner that is not finite are ignored:
    ///   no ray hits them.
    ///
    /// # Panics
    /// If a face refers to a vertex that does not exist, or there are 2³¹ faces.
    pub fn new(positions: &[Vec3], faces: &[[u32; 3]]) -> Self {
        assert!(faces.len() <= DUPLICATES as usize, "more faces than numbers");
        let mut found = Boxes::new(positions, faces);
        let alike = duplicates::join(positions, faces, &mut found);
        let stands_for: HashMap<u32, u32> = (0..).zip(&alike).map(|(group, faces)| (faces[0].face, group)).collect();
        let triangle = |face: u32| Triangle {
            corners: faces[face as usize].map(|vertex| positions[vertex as usize]),
            face: stands_for.get(&face).map_or(face, |group| DUPLICATES | group),
        };
        let Boxes { boxes, faces: numbers, center, half_size, .. } = found;
        let mut whole = Whole::new(boxes.len(), center, half_size);
        let tree = Tree::new(References { faces: numbers, boxes }, Some((0, 0)), triangle);
        if !tree.cells.is_empty() {
            whole.triangles = (0..faces.len() as u32).map(triangle).collect();
        }
        Self { tree, whole, alike }
    }

    /// The nearest hit with t in `t_range` (both ends included) that `accept` accepts; among hits at equal t, the one
    /// on the face with the lowest index. `None` also if the origin or direction is not finite or the direction is
    /// zero.
    ///
    /// `direction` has any length; t is in its units. `accept` is called with hits in no particular order, with some
    /// more than once and not with all of them, so its answer must depend only on the hit.
    pub fn closest(
        &self,
        origin: DVec3,
        direction: DVec3,
        t_range: (f64, f64),
        mut accept: impl FnMut(&Hit) -> bool,
    ) -> Option<Hit> {
        let mut nearest: Option<Hit> = None;
        self.visit(origin, direction, t_range, |hit| {
            let nearer = nearest.is_none_or(|n| hit.t < n.t || (hit.t == n.t && hit.face < n.face));
            let accepted = nearer && accept(&hit);
            if accepted {
                nearest = Some(hit);
            }
            // Faces with the same corners follow in ascending order.
            let enough = accepted || !nearer;
            ControlFlow::Continue(Seen { t_max: nearest.map_or(t_range.1, |n| n.t), enough })
        });
        nearest
    }

    /// All hits with t in `t_range` (both ends included) that `accept` accepts, sorted by t, then by face.
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
            ControlFlow::Continue(Seen { t_max: t_range.1, enough: false })
        });
        hits.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.face.cmp(&b.face)));
        hits.dedup_by_key(|hit| hit.face);
        hits
    }

    /// Whether there is a hit with t in `t_range` (both ends included) that `accept` accepts.
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
            if found { ControlFlow::Break(()) } else { ControlFlow::Continue(Seen { t_max: t_range.1, enough: false }) }
        });
        found
    }

    /// Calls `visitor` with the hits within `t_range`, those of duplicate faces in ascending order. A face in several
    /// cells may be passed several times, with the same hit.
    fn visit(
        &self,
        origin: DVec3,
        direction: DVec3,
        (t_min, t_max): (f64, f64),
        visitor: impl FnMut(Hit) -> ControlFlow<(), Seen>,
    ) {
        if !(origin.is_finite() && direction.is_finite()) || direction == DVec3::ZERO {
            return;
        }
        // Divided by the largest component first, because the squares of extreme components leave the range of f64.
        let largest = direction.abs().max_element();
        let length = (direction / largest).length();
        let unit = direction / largest / length;
        // The ray in the hierarchy's units. Its start is moved close to the scene to keep the precision of f32.
        let start = (origin - self.whole.center) / self.whole.half_size;
        let per_t = largest / self.whole.half_size * length;
        let middle = -start.dot(unit);
        if (start + middle * unit).length_squared() > REACH * REACH {
            return;
        }
        let enter = (t_min * per_t).max(middle - REACH);
        let frame = Frame::new(origin, direction);
        let mut walk =
            Walk { caster: self, frame, t_min, t_max, per_t, enter, exit: middle + REACH, visitor, stopped: false };
        // Not `<`: a NaN in the range means no hit.
        if !(t_min <= t_max && walk.leave() >= 0.0) {
            return;
        }
        let ray = Ray::new((start + enter * unit).as_vec3a(), unit.as_vec3a(), 0.0, walk.leave());
        walk.through(&self.tree, ray);
    }
}

/// The state of a traversal.
struct Walk<'a, V> {
    caster: &'a RayCaster,
    frame: Frame,
    t_min: f64,
    /// The upper end of the t range for further hits.
    t_max: f64,
    /// The hierarchy's units per unit of t. `enter` and `exit` are where the ray enters and leaves the scene's
    /// surroundings.
    per_t: f64,
    enter: f64,
    exit: f64,
    visitor: V,
    /// Whether the visitor has ended the traversal.
    stopped: bool,
}

impl<V: FnMut(Hit) -> ControlFlow<(), Seen>> Walk<'_, V> {
    /// The end of the ray in the hierarchy's units.
    fn leave(&self) -> f32 {
        ((self.t_max * self.per_t).min(self.exit) - self.enter) as f32 + PADDING as f32
    }

    fn through(&mut self, tree: &Tree, ray: Ray) {
        let mut in_leaf = |node: &obvhs::bvh2::node::Bvh2Node, ray: &mut Ray, _: &mut RayHit| {
            let first = node.first_index as usize;
            if node.prim_count == CELL {
                self.through_cell(&tree.cells[first], *ray);
                ray.tmax = self.leave();
            } else {
                self.over(&tree.triangles[first..first + node.prim_count as usize], ray);
            }
            !self.stopped
        };
        // A hierarchy is at most 3 · 31 + 3 deep.
        fast_stack!(u32, (96), tree.bvh.max_depth, stack, {
            tree.bvh.ray_traverse_dynamic(&mut stack, ray, &mut RayHit::none(), &mut in_leaf);
        });
    }

    /// Visits the nearer half first.
    #[cold]
    fn through_cell(&mut self, cell: &Cell, mut ray: Ray) {
        let halves = cell.halves(&self.caster.whole);
        let mut on_way = [0, 1].map(|half: usize| (halves[half].bounds.intersect_ray(&ray), &halves[half].content));
        if on_way[0].0 > on_way[1].0 {
            on_way.swap(0, 1);
        }
        for (t, content) in on_way {
            if self.stopped || t >= ray.tmax {
                break;
            }
            match content {
                Content::Cell(cell) => self.through_cell(cell, ray),
                Content::Tree(tree) => self.through(tree, ray),
            }
            ray.tmax = self.leave();
        }
    }

    #[inline(always)]
    fn over(&mut self, triangles: &[Triangle], ray: &mut Ray) {
        for triangle in triangles {
            let Some(hit) = self.frame.intersect(triangle) else { continue };
            if !(self.t_min <= hit.t && hit.t <= self.t_max) {
                continue;
            }
            let one = [Duplicate { face: triangle.face, first: 0 }];
            let faces = match triangle.face & DUPLICATES {
                0 => &one[..],
                _ => &self.caster.alike[(triangle.face & !DUPLICATES) as usize],
            };
            for &Duplicate { face, first } in faces {
                let [u, v, w] = hit.barycentric;
                let barycentric = [[u, v, w], [v, w, u], [w, u, v]][first];
                let ControlFlow::Continue(seen) = (self.visitor)(Hit { face, barycentric, ..hit }) else {
                    self.stopped = true;
                    return;
                };
                if seen.t_max < self.t_max {
                    self.t_max = seen.t_max;
                    ray.tmax = self.leave();
                }
                if seen.enough {
                    break;
                }
            }
        }
    }
}

/// The transformation that makes the ray the z axis: a permutation of axes that makes its largest component the third
/// and preserves handedness, then a shear.
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

    /// The position of a corner relative to the ray: its 2D offset, and its depth along the ray's largest component.
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
        // Rarely reached: recomputes every weight to within two units in its last place.
        let (u, v, w) = (precise_cross(b, c), precise_cross(c, a), precise_cross(a, b));
        let sum = u + v + w;
        if sum == 0.0 {
            return None;
        }
        let barycentric = [u / sum, v / sum, w / sum];
        let z = barycentric[0] * a[2] + barycentric[1] * b[2] + barycentric[2] * c[2];
        Some(Hit { t: z / self.along, object: 0, face: triangle.face, barycentric, front: sum < 0.0 })
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

#[cfg(test)]
mod tests;

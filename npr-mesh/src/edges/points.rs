//! Finds points on line segments.

use glam::{DVec3, Vec3};

/// Points per leaf.
const LEAF: usize = 8;

/// A binary tree of boxes over points, each split at the median along its longest side.
pub(super) struct PointTree {
    /// The points, as vertices.
    vertices: Vec<u32>,
    /// The boxes: the root at 1, the children of box i at 2 i and 2 i + 1, and the leaves in the last half.
    boxes: Vec<[Vec3; 2]>,
}

impl PointTree {
    /// The time is n log n.
    pub fn new(positions: &[Vec3], mut vertices: Vec<u32>) -> Self {
        let leaves = vertices.len().div_ceil(LEAF).next_power_of_two();
        let mut boxes = vec![[Vec3::INFINITY, Vec3::NEG_INFINITY]; 2 * leaves];
        split(positions, &mut vertices, &mut boxes, 1, leaves);
        Self { vertices, boxes }
    }

    /// Visits the points within `tolerance` of the segment between two vertices, and farther than that from both its
    /// ends along it, in any order: the distance from the first end, and the vertex. Ends if `visit` returns `false`, and
    /// returns whether it did not.
    pub fn on_segment(
        &self,
        positions: &[Vec3],
        ends: [u32; 2],
        tolerance: f64,
        mut visit: impl FnMut(f64, u32) -> bool,
    ) -> bool {
        let [from, to] = ends.map(|vertex| positions[vertex as usize].as_dvec3());
        let length = from.distance(to);
        if length <= 2.0 * tolerance || !length.is_finite() {
            return true;
        }
        let along = (to - from) / length;
        let segment = Segment::new(from, to, tolerance);
        let leaves = self.boxes.len() / 2;
        // A tree of at most 32 levels: at each, one box is left to visit.
        let mut waiting = [0usize; 40];
        let mut count = 1;
        waiting[0] = 1;
        while count > 0 {
            count -= 1;
            let at = waiting[count];
            if !segment.may_touch(&self.boxes[at]) {
                continue;
            }
            if at < leaves {
                waiting[count] = 2 * at;
                waiting[count + 1] = 2 * at + 1;
                count += 2;
                continue;
            }
            let first = (at - leaves) * LEAF;
            for &vertex in self.vertices.iter().skip(first).take(LEAF) {
                let here = positions[vertex as usize].as_dvec3() - from;
                let distance = here.dot(along);
                let is_inside = distance > tolerance && distance < length - tolerance;
                if is_inside
                    && (here - along * distance).length_squared() <= tolerance * tolerance
                    && !ends.contains(&vertex)
                    && !visit(distance, vertex)
                {
                    return false;
                }
            }
        }
        true
    }
}

/// A segment, for tests against boxes.
struct Segment {
    low: DVec3,
    high: DVec3,
    middle: DVec3,
    half: DVec3,
    tolerance: f64,
}

impl Segment {
    fn new(from: DVec3, to: DVec3, tolerance: f64) -> Self {
        let slack = DVec3::splat(tolerance);
        Self {
            low: from.min(to) - slack,
            high: from.max(to) + slack,
            middle: from.midpoint(to),
            half: (to - from) * 0.5,
            tolerance,
        }
    }

    /// By separating axes: those of the box, and their cross products with the segment (C. Ericson, "Real-Time Collision
    /// Detection", 2005, section 5.3.3).
    fn may_touch(&self, [low, high]: &[Vec3; 2]) -> bool {
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        if low.cmpgt(self.high).any() || high.cmplt(self.low).any() {
            return false;
        }
        let extent = (high - low) * 0.5 + DVec3::splat(self.tolerance);
        let across = (self.middle - low.midpoint(high)).cross(self.half).abs();
        let half = self.half.abs();
        let most = DVec3::new(
            extent.y * half.z + extent.z * half.y,
            extent.z * half.x + extent.x * half.z,
            extent.x * half.y + extent.y * half.x,
        );
        // Rounding of the products is far below the tolerance.
        across.cmple(most * (1.0 + 1e-9)).all()
    }
}

/// Fills a box and those below it, of `leaves` leaves, and sorts the points into them.
fn split(positions: &[Vec3], vertices: &mut [u32], boxes: &mut [[Vec3; 2]], at: usize, leaves: usize) {
    let place = |vertex: &u32| positions[*vertex as usize];
    let around = vertices.iter().map(place).fold(boxes[at], |[low, high], p| [low.min(p), high.max(p)]);
    boxes[at] = around;
    if leaves == 1 {
        return;
    }
    let half = (leaves / 2 * LEAF).min(vertices.len());
    if half < vertices.len() {
        // Halves, since the difference may exceed the range.
        let axis = (around[1] * 0.5 - around[0] * 0.5).max_position();
        vertices.select_nth_unstable_by(half, |a, b| place(a)[axis].total_cmp(&place(b)[axis]));
    }
    let (lower, upper) = vertices.split_at_mut(half);
    split(positions, lower, boxes, 2 * at, leaves / 2);
    split(positions, upper, boxes, 2 * at + 1, leaves / 2);
}

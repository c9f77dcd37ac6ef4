//! The hierarchy of boxes that rays are walked through: from the top down, by the surface area heuristic over bins
//! (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies").
//!
//! obvhs, which walks the hierarchy, has a builder too. It works from the bottom up, in rounds of joining boxes that
//! are each other's nearest. Faces that lie on or within one another have one such pair a round: 20,000 of them took
//! 14 s and made a tree 19,994 deep, where this takes 14 ms and 14 levels. On models (bunny, teapot, beetle, fandisk,
//! rocker arm, suzanne) a ray takes 0.82 to 0.88 of its time with obvhs's fast build, building 1.1 to 1.8 of it.
//!
//! Here a face is in one leaf. Where faces are so large that this does not do, [`super::cells`] takes over.

use super::PADDING;
use super::cells::{CELL, is_crowd};
use glam::Vec3A;
use obvhs::{aabb::Aabb, bvh2::Bvh2, bvh2::node::Bvh2Node};

/// How many bins a box is divided into along each axis.
const BINS: usize = 16;

/// A leaf has at most so many boxes.
const LEAF: usize = 8;

/// What one step down costs, in intersections with a triangle.
const STEP: f32 = 1.5;

/// Boxes in and around a part of a bin's, or a split's, boxes.
#[derive(Clone, Copy)]
struct Group {
    bounds: Aabb,
    count: u32,
}

impl Group {
    const NONE: Self = Self { bounds: Aabb::INVALID, count: 0 };

    fn with(self, other: Self) -> Self {
        Self { bounds: self.bounds.union(&other.bounds), count: self.count + other.count }
    }

    /// The cost of a ray through it, times the area of the box that holds it.
    fn cost(self) -> f32 {
        if self.count == 0 { 0.0 } else { self.bounds.half_area() * self.count as f32 }
    }
}

/// A hierarchy over `boxes`, which must be finite. Takes n log n steps and is at most 3 log₂ n + 3 deep, whatever they
/// are; `Bvh2::max_depth` is the depth itself.
///
/// With `cells`, nodes whose boxes lie much over one another are leaves that say so, with [`CELL`] for a count and the
/// place in the second result of which boxes they have. Those boxes are not among the hierarchy's.
pub fn hierarchy(boxes: &[Aabb], cells: bool) -> (Bvh2, Vec<Vec<u32>>) {
    let mut bvh = Bvh2 { max_depth: 0, ..Bvh2::default() };
    let mut crowds = Vec::new();
    if boxes.is_empty() {
        return (bvh, crowds);
    }
    // From there on ranges are halved.
    let deep = 2 * boxes.len().ilog2() as usize + 2;
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    let mut open = vec![(0, 0..boxes.len(), 0)];
    bvh.nodes.push(Bvh2Node::default());
    while let Some((node, range, depth)) = open.pop() {
        bvh.max_depth = bvh.max_depth.max(depth);
        let part = &mut order[range.clone()];
        let bounds = part.iter().fold(Aabb::INVALID, |all, &number| all.union(&boxes[number as usize]));
        if cells && is_crowd(&bounds, part.iter().map(|&number| &boxes[number as usize])) {
            bvh.nodes[node] = Bvh2Node::new(bounds, CELL, crowds.len() as u32);
            crowds.push(part.to_vec());
            continue;
        }
        let Some(left) = divide(boxes, part, &bounds, depth >= deep) else {
            bvh.nodes[node] = Bvh2Node::new(bounds, part.len() as u32, range.start as u32);
            continue;
        };
        let (middle, child) = (range.start + left, bvh.nodes.len());
        bvh.nodes[node] = Bvh2Node::new(bounds, 0, child as u32);
        bvh.nodes.extend([Bvh2Node::default(); 2]);
        open.extend([(child, range.start..middle, depth + 1), (child + 1, middle..range.end, depth + 1)]);
    }
    if !crowds.is_empty() {
        order = leaves_alone(&mut bvh, &order);
    }
    bvh.primitive_indices = order;
    bvh.children_are_ordered_after_parents = true;
    (bvh, crowds)
}

/// `order` without what is in no leaf but in cells.
fn leaves_alone(bvh: &mut Bvh2, order: &[u32]) -> Vec<u32> {
    let mut kept = Vec::new();
    for leaf in bvh.nodes.iter_mut().filter(|node| node.is_leaf() && node.prim_count != CELL) {
        let first = leaf.first_index as usize;
        leaf.first_index = kept.len() as u32;
        kept.extend_from_slice(&order[first..first + leaf.prim_count as usize]);
    }
    kept
}

/// Orders `part`, so that its first boxes are one child's: how many, or `None` for a leaf.
fn divide(boxes: &[Aabb], part: &mut [u32], bounds: &Aabb, halve: bool) -> Option<usize> {
    if part.len() <= 2 {
        return None;
    }
    // Twice the centre, which has the same order.
    let middle = |number: u32| boxes[number as usize].min + boxes[number as usize].max;
    let (low, high) = part.iter().fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(low, high), &number| {
        (low.min(middle(number)), high.max(middle(number)))
    });
    let extent = high - low;
    // Middles nearer than the padding are one place: what tells such boxes apart is their size.
    let one_place = extent.max_element() <= PADDING as f32;
    if one_place || halve {
        let (half, axis) = (part.len() / 2, extent.max_position());
        let key = |number: u32| {
            if one_place { boxes[number as usize].half_area() } else { middle(number)[axis] }
        };
        return (part.len() > LEAF).then(|| {
            part.select_nth_unstable_by(half, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
            half
        });
    }
    let scale = BINS as f32 / extent.max(Vec3A::splat(f32::MIN_POSITIVE));
    let bin = |number: u32| ((middle(number) - low) * scale).min(Vec3A::splat(BINS as f32 - 1.0)).as_uvec3();
    let mut bins = [[Group::NONE; BINS]; 3];
    for &number in part.iter() {
        let one = Group { bounds: boxes[number as usize], count: 1 };
        for (bins, bin) in bins.iter_mut().zip(bin(number).to_array()) {
            bins[bin as usize] = bins[bin as usize].with(one);
        }
    }
    let mut best = (f32::INFINITY, 0, 0);
    for (axis, bins) in bins.iter().enumerate() {
        let mut above = [Group::NONE; BINS];
        for place in (1..BINS).rev() {
            above[place - 1] = above[place].with(bins[place]);
        }
        let mut below = Group::NONE;
        for place in 0..BINS - 1 {
            below = below.with(bins[place]);
            if below.count > 0 && above[place].count > 0 {
                let cost = below.cost() + above[place].cost();
                if cost < best.0 {
                    best = (cost, axis, place);
                }
            }
        }
    }
    let (cost, axis, place) = best;
    let area = bounds.half_area();
    if part.len() <= LEAF && cost + STEP * area >= area * part.len() as f32 {
        return None;
    }
    // The smallest and the largest middle along the longest axis are in different bins, so some split was found.
    let mut left = 0;
    for at in 0..part.len() {
        if bin(part[at])[axis] as usize <= place {
            part.swap(left, at);
            left += 1;
        }
    }
    Some(left)
}

//! The bounding volume hierarchy that rays traverse, built from the top down by the surface area heuristic over bins
//! (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies").
//!
//! obvhs, which traverses the hierarchy, has a builder too. It works from the bottom up, in rounds of joining boxes that
//! are each other's nearest. Faces that lie on or within one another have one such pair a round: 20,000 of them make a
//! tree 19,994 deep.
//!
//! Boxes are moved to their part of the hierarchy, so that every pass over a part is sequential. Large parts are divided
//! by a sample of their boxes. The halves of parts of more than [`FORK`] boxes may be built by different threads; which
//! parts those are depends on the boxes only, so that any number of threads builds the same hierarchy.
//!
//! With the boxes and the triangles in order, 1.1 million faces of a scanned model take 0.26 s of processor time, 4.4
//! million 1.1 s, on two threads 0.57 of that.
//!
//! Here a face is in one leaf. Where faces are so large that this does not do, [`super::cells`] takes over.

use super::clusters::{CELL, SAMPLE, is_overlapping};
use super::threads;
use super::triangle::PADDING;
use glam::Vec3A;
use obvhs::{aabb::Aabb, bvh2::Bvh2, bvh2::node::Bvh2Node};
use std::ops::Range;

/// Up to so many boxes are sorted into 8 bins along each axis, more into 16. With 16 always building takes 1.04 times as
/// long, and rays the same time.
const FEW: usize = 128;

/// A leaf has at most so many boxes.
const LEAF: usize = 8;

/// What one step down costs, in intersections with a triangle.
const STEP: f32 = 1.5;

/// The halves of parts of more boxes, at most [`FORKS`] steps down, have room for nodes of their own.
const FORK: usize = 1 << 13;
const FORKS: usize = 6;

/// A hierarchy over boxes.
pub struct Hierarchy {
    /// Its primitive indices are the boxes' numbers, leaf by leaf. Between its nodes there may be unused ones, which are
    /// zero: those count that are reached from the first.
    pub bvh: Bvh2,
    /// For each leaf that is a cell the numbers and boxes in it, which are not among `bvh`'s.
    pub crowds: Vec<(Vec<u32>, Vec<Aabb>)>,
}

/// The hierarchy over `boxes`, which must be finite, each with a number that stands for it in the result. Takes
/// n log n steps and is at most 3 log₂ n + 3 deep, whatever they are; `Bvh2::max_depth` is the depth itself.
///
/// With `cells`, nodes whose boxes lie much over one another are leaves that say so, with [`CELL`] for a count and the
/// index of the result's crowd.
pub fn hierarchy(boxes: Vec<Aabb>, numbers: Vec<u32>, cells: bool) -> Hierarchy {
    let threads = threads::count(boxes.len());
    hierarchy_by(boxes, numbers, cells, threads)
}

/// On so many threads.
pub fn hierarchy_by(mut boxes: Vec<Aabb>, mut numbers: Vec<u32>, cells: bool, threads: usize) -> Hierarchy {
    let mut bvh = Bvh2 { max_depth: 0, ..Bvh2::default() };
    if boxes.is_empty() {
        return Hierarchy { bvh, crowds: Vec::new() };
    }
    let rules = Rules { cells, deep: 2 * boxes.len().ilog2() as usize + 2, threads };
    // Below the node of a part there are at most two for each of its boxes but one.
    let mut nodes: Vec<Bvh2Node> = bytemuck::zeroed_vec(2 * boxes.len() - 1);
    let (root, below) = nodes.split_at_mut(1);
    let part = Part { boxes: &mut boxes, numbers: &mut numbers, first: 0, depth: 0 };
    let built = fork(part, &mut root[0], Room { nodes: below, first: 1 }, &rules);
    if boxes.len() <= FORK {
        nodes.truncate(1 + built.nodes);
        nodes.shrink_to_fit();
    }
    bvh.nodes = nodes;
    bvh.max_depth = built.depth;
    bvh.children_are_ordered_after_parents = true;
    let mut crowds = Vec::new();
    if !built.crowds.is_empty() {
        let taken = |places: &Range<usize>| (numbers[places.clone()].to_vec(), boxes[places.clone()].to_vec());
        crowds = built.crowds.iter().map(taken).collect();
        numbers = without_crowds(&mut bvh, &numbers, &built.crowds);
    }
    bvh.primitive_indices = numbers;
    Hierarchy { bvh, crowds }
}

/// `numbers` without those that are in no leaf but in cells. `crowds`: their places, ascending.
fn without_crowds(bvh: &mut Bvh2, numbers: &[u32], crowds: &[Range<usize>]) -> Vec<u32> {
    let mut kept = Vec::new();
    for leaf in bvh.nodes.iter_mut().filter(|node| node.is_leaf()) {
        let first = leaf.first_index as usize;
        if leaf.prim_count == CELL {
            leaf.first_index = crowds.partition_point(|crowd| crowd.start < first) as u32;
            continue;
        }
        leaf.first_index = kept.len() as u32;
        kept.extend_from_slice(&numbers[first..first + leaf.prim_count as usize]);
    }
    kept
}

/// What is the same for all parts.
struct Rules {
    cells: bool,
    /// From this depth on parts are halved.
    deep: usize,
    threads: usize,
}

/// Boxes that become a node and what is below it.
struct Part<'a> {
    boxes: &'a mut [Aabb],
    numbers: &'a mut [u32],
    /// The place of its first box among all.
    first: usize,
    depth: usize,
}

/// Where the nodes below a part's own go.
struct Room<'a> {
    nodes: &'a mut [Bvh2Node],
    /// The index of the first of them in the hierarchy.
    first: usize,
}

/// What a built part is, besides its nodes.
#[derive(Default)]
struct Built {
    /// Of the deepest node.
    depth: usize,
    /// How many nodes there are below the part's own, if they are in one piece.
    nodes: usize,
    /// The places of the boxes of each leaf that is a cell, ascending.
    crowds: Vec<Range<usize>>,
}

/// What a part becomes.
enum Shape {
    Leaf,
    Cell,
    /// Two children, of which the first has so many boxes.
    Inner(usize),
}

/// Builds a large part, both halves at the same time.
fn fork(mut part: Part, root: &mut Bvh2Node, room: Room, rules: &Rules) -> Built {
    if part.boxes.len() <= FORK || part.depth >= FORKS {
        return grow(part, root, room, rules);
    }
    let (node, shape) = part.node(room.first, rules);
    *root = node;
    let Shape::Inner(left) = shape else { return part.end(&shape) };
    let depth = part.depth + 1;
    let (left_boxes, right_boxes) = part.boxes.split_at_mut(left);
    let (left_numbers, right_numbers) = part.numbers.split_at_mut(left);
    let (roots, below) = room.nodes.split_at_mut(2);
    let (left_root, right_root) = roots.split_at_mut(1);
    let (left_below, right_below) = below.split_at_mut(2 * left - 2);
    let mut build_left = || {
        let part = Part { boxes: left_boxes, numbers: left_numbers, first: part.first, depth };
        fork(part, &mut left_root[0], Room { nodes: left_below, first: room.first + 2 }, rules)
    };
    let mut build_right = || {
        let part = Part { boxes: right_boxes, numbers: right_numbers, first: part.first + left, depth };
        fork(part, &mut right_root[0], Room { nodes: right_below, first: room.first + 2 * left }, rules)
    };
    // More halves than threads, since they are not equally large.
    let at_once = rules.threads > 1 && part.depth <= rules.threads.ilog2() as usize + 1;
    let (mut left, right) =
        if at_once { threads::join(build_left, build_right) } else { (build_left(), build_right()) };
    left.depth = left.depth.max(right.depth);
    left.crowds.extend(right.crowds);
    left
}

/// Builds a part, its nodes in one piece.
fn grow(part: Part, root: &mut Bvh2Node, room: Room, rules: &Rules) -> Built {
    let Part { boxes, numbers, first, depth } = part;
    let mut built = Built::default();
    let mut open = vec![(None, 0..boxes.len(), depth)];
    while let Some((at, range, depth)) = open.pop() {
        let mut part = Part {
            boxes: &mut boxes[range.clone()],
            numbers: &mut numbers[range.clone()],
            first: first + range.start,
            depth,
        };
        let (node, shape) = part.node(room.first + built.nodes, rules);
        *at.map_or(&mut *root, |at: usize| &mut room.nodes[at]) = node;
        if let Shape::Inner(left) = shape {
            let (middle, child) = (range.start + left, built.nodes);
            built.nodes += 2;
            open.push((Some(child + 1), middle..range.end, depth + 1));
            open.push((Some(child), range.start..middle, depth + 1));
        } else {
            let Built { depth, crowds, .. } = part.end(&shape);
            built.depth = built.depth.max(depth);
            built.crowds.extend(crowds);
        }
    }
    built
}

impl Part<'_> {
    /// Decides what the part becomes, and orders its boxes by children. `child`: the index of its children's nodes.
    fn node(&mut self, child: usize, rules: &Rules) -> (Bvh2Node, Shape) {
        let extent = Extent::of(self.boxes);
        let count = self.boxes.len();
        if rules.cells && is_overlapping(&extent.bounds, self.boxes) {
            return (Bvh2Node::new(extent.bounds, CELL, self.first as u32), Shape::Cell);
        }
        match self.divide(&extent, self.depth >= rules.deep) {
            None => (Bvh2Node::new(extent.bounds, count as u32, self.first as u32), Shape::Leaf),
            Some(left) => (Bvh2Node::new(extent.bounds, 0, child as u32), Shape::Inner(left)),
        }
    }

    /// What is built of a part without children.
    fn end(&self, shape: &Shape) -> Built {
        let mut built = Built { depth: self.depth, ..Built::default() };
        if matches!(shape, Shape::Cell) {
            built.crowds.push(self.first..self.first + self.boxes.len());
        }
        built
    }

    /// Orders the boxes, so that the first ones are one child's: how many, or `None` for a leaf.
    fn divide(&mut self, extent: &Extent, halve: bool) -> Option<usize> {
        let count = self.boxes.len();
        if count <= 2 {
            return None;
        }
        // Middles nearer than the padding are one place: what distinguishes such boxes is their size.
        let size = extent.middles.diagonal();
        let one_place = size.max_element() <= PADDING as f32;
        if !(one_place || halve) {
            let split =
                if count <= FEW { best_split::<8>(extent, self.boxes) } else { best_split::<16>(extent, self.boxes) };
            let area = extent.bounds.half_area();
            if let Some(Split { cost, .. }) = split
                && count <= LEAF
                && cost + STEP * area >= area * count as f32
            {
                return None;
            }
            if let Some(split) = split {
                return Some(self.partition(&split));
            }
            // The sample was all in one bin.
        }
        let axis = size.max_position();
        (count > LEAF).then(|| self.halve(if one_place { None } else { Some(axis) }))
    }

    /// Moves the boxes in the lower bins to the front: how many.
    fn partition(&mut self, Split { bins, axis, last, .. }: &Split) -> usize {
        let (low, per_unit) = (bins.low[*axis], bins.per_unit[*axis]);
        let is_lower =
            |middle: f32| ((middle - low) * per_unit - 0.5).clamp(0.0, bins.most) + WHOLE <= WHOLE + *last as f32;
        match axis {
            0 => self.bring_forward(|one| is_lower(one.min.x + one.max.x)),
            1 => self.bring_forward(|one| is_lower(one.min.y + one.max.y)),
            _ => self.bring_forward(|one| is_lower(one.min.z + one.max.z)),
        }
    }

    /// Without a branch that depends on a box: every box changes places with the first that stays behind.
    fn bring_forward(&mut self, is_lower: impl Fn(&Aabb) -> bool) -> usize {
        let mut left = 0;
        for at in 0..self.boxes.len() {
            let lower = is_lower(&self.boxes[at]);
            self.boxes.swap(left, at);
            self.numbers.swap(left, at);
            left += usize::from(lower);
        }
        left
    }

    /// Orders the boxes by their middles along an axis, or by their size, as far as that the lower half is in front.
    fn halve(&mut self, axis: Option<usize>) -> usize {
        let key = |one: &Aabb| axis.map_or_else(|| one.half_area(), |axis| middle(one)[axis]);
        let mut keyed: Vec<(f32, u32, Aabb)> =
            self.boxes.iter().zip(&*self.numbers).map(|(one, &number)| (key(one), number, *one)).collect();
        let half = keyed.len() / 2;
        keyed.select_nth_unstable_by(half, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for ((one, number), (_, of, from)) in self.boxes.iter_mut().zip(&mut *self.numbers).zip(keyed) {
            (*one, *number) = (from, of);
        }
        half
    }
}

/// Twice a box's centre.
fn middle(one: &Aabb) -> Vec3A {
    one.min + one.max
}

/// A box around boxes, and one around their [`middle`]s.
struct Extent {
    bounds: Aabb,
    middles: Aabb,
}

impl Extent {
    fn of(boxes: &[Aabb]) -> Self {
        let empty = Self { bounds: Aabb::INVALID, middles: Aabb::INVALID };
        boxes.iter().fold(empty, |all, one| {
            let middle = middle(one);
            Self {
                bounds: all.bounds.union(one),
                middles: Aabb { min: all.middles.min.min(middle), max: all.middles.max.max(middle) },
            }
        })
    }
}

/// Equal ranges of the boxes' middles along each axis.
#[derive(Clone, Copy)]
struct Bins {
    low: Vec3A,
    per_unit: Vec3A,
    /// How many there are, less one.
    most: f32,
}

/// From here on floats are whole numbers, whose last bits are those of the integer.
const WHOLE: f32 = (1u32 << 23) as f32;

impl Bins {
    fn new(extent: &Extent, count: usize) -> Self {
        let size = extent.middles.diagonal().max(Vec3A::splat(1e-30));
        Self { low: extent.middles.min, per_unit: Vec3A::splat(count as f32) / size, most: count as f32 - 1.0 }
    }

    /// A box's bin along each axis, in the last bits.
    fn of(&self, one: &Aabb) -> [u32; 3] {
        let at = (middle(one) - self.low) * self.per_unit - 0.5;
        (at.clamp(Vec3A::ZERO, Vec3A::splat(self.most)) + WHOLE).to_array().map(f32::to_bits)
    }
}

/// The best way to divide boxes: those up to the bin `last` along an axis, and those after it.
struct Split {
    cost: f32,
    bins: Bins,
    axis: usize,
    last: usize,
}

/// `COUNT` bins, a power of two. `None` if all boxes that are looked at are in one bin along each axis.
fn best_split<const COUNT: usize>(extent: &Extent, boxes: &[Aabb]) -> Option<Split> {
    let bins = Bins::new(extent, COUNT);
    let mut bounds = [[Aabb::INVALID; COUNT]; 3];
    let mut counts = [[0u32; COUNT]; 3];
    for one in boxes.iter().step_by(boxes.len().div_ceil(SAMPLE)) {
        for (axis, bin) in bins.of(one).into_iter().enumerate() {
            let bin = bin as usize % COUNT;
            bounds[axis][bin] = bounds[axis][bin].union(one);
            counts[axis][bin] += 1;
        }
    }
    let (mut cost, mut place) = (f32::INFINITY, None);
    for axis in 0..3 {
        // The cost of a ray through boxes, times the area of the box that holds them: not a number for no boxes.
        let mut above = [f32::NAN; COUNT];
        let (mut around, mut count) = (Aabb::INVALID, 0);
        for bin in (1..COUNT).rev() {
            around = around.union(&bounds[axis][bin]);
            count += counts[axis][bin];
            above[bin - 1] = around.half_area() * count as f32;
        }
        let (mut around, mut count) = (Aabb::INVALID, 0);
        for bin in 0..COUNT - 1 {
            around = around.union(&bounds[axis][bin]);
            count += counts[axis][bin];
            let both = around.half_area() * count as f32 + above[bin];
            if both < cost {
                (cost, place) = (both, Some((axis, bin)));
            }
        }
    }
    place.map(|(axis, last)| Split { cost, bins, axis, last })
}

//! The bounding volume hierarchy that rays traverse, built from the top down by the surface area heuristic over bins
//! (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies").
//!
//! obvhs, which traverses the hierarchy, also has a builder. It works bottom-up, in rounds that merge boxes which are
//! each other's nearest neighbours. Overlapping or nested faces have only one such pair per round: 20,000 of them make
//! a tree of depth 19,994.
//!
//! Boxes are reordered by subtree, so that every pass over a subtree is sequential. Splits of large subtrees are chosen
//! from a sample of their boxes. The halves of subtrees with more than [`FORK`] boxes may be built on different
//! threads. This depends on the boxes only, so any number of threads builds the same hierarchy.
//!
//! Including boxes and triangles, 1.1 million faces of a scanned model take 0.26 s of processor time and 4.4 million
//! 1.1 s; two threads take 0.57 of that.
//!
//! Each face is in exactly one leaf. Where faces are too large for that, [`super::cells`] splits them.

use super::clusters::{CELL, SAMPLE, is_overlapping};
use super::threads;
use super::triangle::PADDING;
use glam::Vec3A;
use obvhs::{aabb::Aabb, bvh2::Bvh2, bvh2::node::Bvh2Node};
use std::ops::Range;

/// Up to this many boxes are sorted into 8 bins along each axis, more into 16. With 16 bins always, building takes 1.04
/// times as long, and rays take the same time.
const FEW: usize = 128;

/// The maximum number of boxes in a leaf.
const LEAF: usize = 8;

/// The cost of a traversal step, relative to a triangle intersection.
const STEP: f32 = 1.5;

/// The halves of subtrees with more boxes, at most [`FORKS`] levels down, get separate ranges of nodes.
const FORK: usize = 1 << 13;
const FORKS: usize = 6;

/// A hierarchy over boxes.
pub struct Hierarchy {
    /// Its primitive indices are the boxes' numbers, leaf by leaf. Unused nodes, filled with zeros, may lie between its
    /// nodes; only nodes reachable from the root count.
    pub bvh: Bvh2,
    /// For each leaf that is a cell: its numbers and boxes, which `bvh` does not contain.
    pub crowds: Vec<(Vec<u32>, Vec<Aabb>)>,
}

/// Builds the hierarchy over `boxes`, which must be finite, each with a number that represents it in the result. Takes
/// O(n log n) time and is at most 3 log₂ n + 3 deep for any boxes; `Bvh2::max_depth` is the actual depth.
///
/// With `cells`, nodes whose boxes overlap too much become leaves with the count [`CELL`] and the index into the
/// result's clusters.
pub fn hierarchy(boxes: Vec<Aabb>, numbers: Vec<u32>, cells: bool) -> Hierarchy {
    let threads = threads::count(boxes.len());
    hierarchy_by(boxes, numbers, cells, threads)
}

/// As [`hierarchy`], on a number of threads.
pub fn hierarchy_by(mut boxes: Vec<Aabb>, mut numbers: Vec<u32>, cells: bool, threads: usize) -> Hierarchy {
    let mut bvh = Bvh2 { max_depth: 0, ..Bvh2::default() };
    if boxes.is_empty() {
        return Hierarchy { bvh, crowds: Vec::new() };
    }
    let rules = Rules { cells, deep: 2 * boxes.len().ilog2() as usize + 2, threads };
    // A subtree of n boxes has at most 2 (n - 1) nodes below its root.
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

/// `numbers` without those that only cells contain. `crowds`: their positions, ascending.
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

/// The settings shared by all subtrees.
struct Rules {
    cells: bool,
    /// The depth from which subtrees are split at the median.
    deep: usize,
    threads: usize,
}

/// The boxes of a subtree.
struct Part<'a> {
    boxes: &'a mut [Aabb],
    numbers: &'a mut [u32],
    /// The position of its first box among all.
    first: usize,
    depth: usize,
}

/// The range for the nodes below the root of a subtree.
struct Room<'a> {
    nodes: &'a mut [Bvh2Node],
    /// The index of the first of these nodes in the hierarchy.
    first: usize,
}

/// The properties of a built subtree.
#[derive(Default)]
struct Built {
    /// The depth of the deepest node.
    depth: usize,
    /// The number of nodes below the root, if they are contiguous.
    nodes: usize,
    /// The positions of the boxes of each leaf that is a cell, ascending.
    crowds: Vec<Range<usize>>,
}

/// The kind of node at the root of a subtree.
enum Shape {
    Leaf,
    Cell,
    /// Two children; the first has this many boxes.
    Inner(usize),
}

/// Builds a large subtree, both halves concurrently.
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
    // More halves than threads, since their sizes differ.
    let at_once = rules.threads > 1 && part.depth <= rules.threads.ilog2() as usize + 1;
    let (mut left, right) =
        if at_once { threads::join(build_left, build_right) } else { (build_left(), build_right()) };
    left.depth = left.depth.max(right.depth);
    left.crowds.extend(right.crowds);
    left
}

/// Builds a subtree with contiguous nodes.
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
    /// Chooses the kind of node and orders the boxes by children. `child`: the index of the children's nodes.
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

    /// The result for a subtree without children.
    fn end(&self, shape: &Shape) -> Built {
        let mut built = Built { depth: self.depth, ..Built::default() };
        if matches!(shape, Shape::Cell) {
            built.crowds.push(self.first..self.first + self.boxes.len());
        }
        built
    }

    /// Orders the boxes by child and returns the number of boxes of the first child, or `None` for a leaf.
    fn divide(&mut self, extent: &Extent, halve: bool) -> Option<usize> {
        let count = self.boxes.len();
        if count <= 2 {
            return None;
        }
        // Centres nearer than the padding count as equal; such boxes are ordered by size.
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
            // All sampled boxes were in one bin.
        }
        let axis = size.max_position();
        (count > LEAF).then(|| self.halve(if one_place { None } else { Some(axis) }))
    }

    /// Moves the boxes in the lower bins to the front and returns their number.
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

    /// Branchless: every box is swapped with the first that stays behind.
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

    /// Partially orders the boxes by their centres along an axis, or by size, so that the lower half comes first.
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

/// The bounding box of boxes, and that of their [`middle`]s.
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

/// Equal intervals of the boxes' centres along each axis.
#[derive(Clone, Copy)]
struct Bins {
    low: Vec3A,
    per_unit: Vec3A,
    /// The number of bins minus one.
    most: f32,
}

/// From 2²³ on, floats are integers, whose lowest bits are those of the integer.
const WHOLE: f32 = (1u32 << 23) as f32;

impl Bins {
    fn new(extent: &Extent, count: usize) -> Self {
        let size = extent.middles.diagonal().max(Vec3A::splat(1e-30));
        Self { low: extent.middles.min, per_unit: Vec3A::splat(count as f32) / size, most: count as f32 - 1.0 }
    }

    /// A box's bin along each axis, in the lowest bits.
    fn of(&self, one: &Aabb) -> [u32; 3] {
        let at = (middle(one) - self.low) * self.per_unit - 0.5;
        (at.clamp(Vec3A::ZERO, Vec3A::splat(self.most)) + WHOLE).to_array().map(f32::to_bits)
    }
}

/// The best split of boxes: those up to the bin `last` along an axis, and those after it.
struct Split {
    cost: f32,
    bins: Bins,
    axis: usize,
    last: usize,
}

/// Uses `COUNT` bins, a power of two. `None` if all sampled boxes are in one bin along each axis.
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
        // The expected cost of a ray through boxes, times the area of their parent's box; NaN for no boxes.
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

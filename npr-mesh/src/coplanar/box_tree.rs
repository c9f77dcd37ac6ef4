//! A tree over axis-aligned boxes, for finding those that touch another box.

use glam::DVec3;

/// The maximum number of boxes in a leaf.
const LEAF: usize = 8;

/// Boxes, halved at the median of their centres along the longest side until [`LEAF`] are left.
///
/// Building takes n log n time. Memory: 56 bytes per box, and 112 bytes per leaf.
pub(super) struct BoxTree {
    nodes: Vec<Node>,
    /// The boxes in the order of the leaves, with their numbers.
    items: Vec<([DVec3; 2], u32)>,
}

struct Node {
    low: DVec3,
    high: DVec3,
    /// The first item of a leaf, or the second child of an inner node, whose first child follows it.
    next: u32,
    /// The number of items of a leaf; 0 for an inner node.
    count: u32,
}

impl BoxTree {
    /// `boxes`: the low and high corner of each; finite.
    pub fn new(boxes: impl IntoIterator<Item = [DVec3; 2]>) -> Self {
        let mut items: Vec<_> = boxes.into_iter().zip(0..).collect();
        let mut nodes = Vec::new();
        if !items.is_empty() {
            build(&mut items, 0, &mut nodes);
        }
        Self { nodes, items }
    }

    /// Calls `visit` with the number of each box that has a point in common with this one.
    pub fn touching(&self, [low, high]: [DVec3; 2], mut visit: impl FnMut(u32)) {
        let apart = |of: [DVec3; 2]| of[0].cmpgt(high).any() || of[1].cmplt(low).any();
        let mut open = Vec::with_capacity(64);
        open.extend((!self.nodes.is_empty()).then_some(0));
        while let Some(at) = open.pop() {
            let node = &self.nodes[at as usize];
            if apart([node.low, node.high]) {
                continue;
            }
            if node.count == 0 {
                open.extend([node.next, at + 1]);
            } else {
                let items = &self.items[node.next as usize..][..node.count as usize];
                items.iter().filter(|item| !apart(item.0)).for_each(|&(_, number)| visit(number));
            }
        }
    }

    /// Calls `visit` once with each two boxes that have a point in common.
    pub fn pairs(&self, mut visit: impl FnMut(u32, u32)) {
        let mut open = Vec::with_capacity(64);
        for (leaf, node) in self.nodes.iter().enumerate().filter(|(_, node)| node.count > 0) {
            let items = &self.items[node.next as usize..][..node.count as usize];
            open.extend((!self.nodes.is_empty()).then_some(0));
            while let Some(at) = open.pop() {
                let other = &self.nodes[at as usize];
                if other.low.cmpgt(node.high).any() || other.high.cmplt(node.low).any() {
                    continue;
                }
                if other.count == 0 {
                    open.extend([other.next, at + 1]);
                } else if at as usize >= leaf {
                    let others = &self.items[other.next as usize..][..other.count as usize];
                    for (number, &([low, high], first)) in items.iter().enumerate() {
                        let from = if at as usize == leaf { number + 1 } else { 0 };
                        for &([other_low, other_high], second) in &others[from..] {
                            if !(other_low.cmpgt(high).any() || other_high.cmplt(low).any()) {
                                visit(first, second);
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Adds the node of some items, which are at `first` in the list of all. The depth is the logarithm of their number.
fn build(items: &mut [([DVec3; 2], u32)], first: u32, nodes: &mut Vec<Node>) {
    let around = |(low, high): (DVec3, DVec3), item: &([DVec3; 2], u32)| (low.min(item.0[0]), high.max(item.0[1]));
    let (low, high) = items.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), around);
    let at = nodes.len();
    let is_leaf = items.len() <= LEAF;
    nodes.push(Node { low, high, next: first, count: if is_leaf { items.len() as u32 } else { 0 } });
    if is_leaf {
        return;
    }
    let axis = (high - low).max_position();
    let half = items.len() / 2;
    let center = |&([low, high], number): &([DVec3; 2], u32)| (low[axis] + high[axis], number);
    items.select_nth_unstable_by(half, |a, b| {
        let ((a, first), (b, second)) = (center(a), center(b));
        a.total_cmp(&b).then(first.cmp(&second))
    });
    let (left, right) = items.split_at_mut(half);
    build(left, first, nodes);
    nodes[at].next = nodes.len() as u32;
    build(right, first + half as u32, nodes);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_a_comparison_with_every_box_finds() {
        let mut bits = 1u64;
        let mut random = || {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (bits >> 40) as f64 / (1u64 << 24) as f64
        };
        let boxes: Vec<[DVec3; 2]> = (0..300)
            .map(|_| {
                let low = DVec3::new(random(), random(), random());
                [low, low + DVec3::new(random(), random(), random()) * 0.1]
            })
            .collect();
        let tree = BoxTree::new(boxes.clone());
        for (number, &[low, high]) in boxes.iter().enumerate() {
            let mut found = Vec::new();
            tree.touching([low, high], |other| found.push(other as usize));
            found.sort_unstable();
            let touches = |of: &[DVec3; 2]| !(of[0].cmpgt(high).any() || of[1].cmplt(low).any());
            let expected: Vec<usize> = (0..boxes.len()).filter(|&other| touches(&boxes[other])).collect();
            assert_eq!(found, expected, "box {number}");
        }
        let mut pairs = Vec::new();
        tree.pairs(|a, b| pairs.push((a.min(b) as usize, a.max(b) as usize)));
        pairs.sort_unstable();
        let touches =
            |a: usize, b: usize| !(boxes[a][0].cmpgt(boxes[b][1]).any() || boxes[a][1].cmplt(boxes[b][0]).any());
        let expected: Vec<(usize, usize)> = (0..boxes.len())
            .flat_map(|a| (a + 1..boxes.len()).map(move |b| (a, b)))
            .filter(|&(a, b)| touches(a, b))
            .collect();
        assert_eq!(pairs, expected);
        BoxTree::new(Vec::new()).touching([DVec3::ZERO, DVec3::ONE], |_| unreachable!("there is no box"));
    }
}

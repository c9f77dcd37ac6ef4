//! A bounding volume hierarchy over the objects' boxes, in f64, rebuilt when an object moves.

use glam::DVec3;

/// A binary tree over boxes, split at the median of the longest axis: 2n - 1 nodes of 56 bytes for n boxes.
#[derive(Clone, Debug, Default)]
pub(super) struct BoxHierarchy {
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// In an inner node, the index of the second child (the first child is the next node); in a leaf, the number of the
    /// box.
    next: u32,
    is_leaf: bool,
}

impl BoxHierarchy {
    /// Its memory, bytes.
    pub(super) fn bytes(&self) -> u64 {
        size_of_val(&self.nodes[..]) as u64
    }

    /// `boxes`: the number and the two extreme corners of each box.
    pub(super) fn new(mut boxes: Vec<(u32, (DVec3, DVec3))>) -> Self {
        let mut hierarchy = Self { nodes: Vec::with_capacity(2 * boxes.len()) };
        if !boxes.is_empty() {
            hierarchy.add(&mut boxes);
        }
        hierarchy
    }

    fn add(&mut self, boxes: &mut [(u32, (DVec3, DVec3))]) {
        let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = boxes.iter().fold(empty, |(l, h), (_, (low, high))| (l.min(*low), h.max(*high)));
        let at = self.nodes.len();
        self.nodes.push(Node { low, high, next: boxes[0].0, is_leaf: boxes.len() == 1 });
        if boxes.len() == 1 {
            return;
        }
        let axis = (high - low).max_position();
        let middle = boxes.len() / 2;
        // Ties are broken by number, so that the tree is deterministic.
        let key = |(number, (low, high)): &(u32, (DVec3, DVec3))| (low[axis] + high[axis], *number);
        boxes.select_nth_unstable_by(middle, |a, b| {
            let ((a, a_number), (b, b_number)) = (key(a), key(b));
            a.total_cmp(&b).then(a_number.cmp(&b_number))
        });
        let (first, second) = boxes.split_at_mut(middle);
        self.add(first);
        self.nodes[at].next = self.nodes.len() as u32;
        self.add(second);
    }

    /// Calls `visit` with the number of each box that the ray intersects, in no particular order, and the current
    /// largest t. `visit` returns the new largest t.
    pub(super) fn visit(
        &self,
        origin: DVec3,
        direction: DVec3,
        (t_min, mut t_max): (f64, f64),
        mut visit: impl FnMut(u32, f64) -> f64,
    ) {
        let inverse = direction.recip();
        let entry = |node: &Node| {
            let (a, b) = ((node.low - origin) * inverse, (node.high - origin) * inverse);
            let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
            for axis in 0..3 {
                if direction[axis] == 0.0 {
                    // The ray stays between the two sides, or never comes there.
                    if origin[axis] < node.low[axis] || origin[axis] > node.high[axis] {
                        return (f64::INFINITY, f64::NEG_INFINITY);
                    }
                } else {
                    enter = enter.max(a[axis].min(b[axis]));
                    leave = leave.min(a[axis].max(b[axis]));
                }
            }
            // Absorbs the rounding of the box corners and of the product.
            let slack = 1e-12 * (enter.abs() + leave.abs());
            (enter - slack, leave + slack)
        };
        let mut stack = Vec::with_capacity(64);
        if !self.nodes.is_empty() {
            stack.push(0u32);
        }
        while let Some(at) = stack.pop() {
            let node = &self.nodes[at as usize];
            let (enter, leave) = entry(node);
            if enter > leave || leave < t_min || enter > t_max {
                continue;
            }
            if node.is_leaf {
                t_max = visit(node.next, t_max);
                continue;
            }
            // The nearer child is visited first.
            let (mut near, mut far) = (at + 1, node.next);
            if entry(&self.nodes[far as usize]).0 < entry(&self.nodes[near as usize]).0 {
                std::mem::swap(&mut near, &mut far);
            }
            stack.extend([far, near]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_box_that_a_ray_meets_is_visited() {
        let boxes: Vec<(u32, (DVec3, DVec3))> = (0..200u32)
            .map(|i| {
                let at = DVec3::new(f64::from(i * 37 % 100), f64::from(i * 61 % 89), f64::from(i * 17 % 53));
                (i, (at, at + DVec3::new(3.0, 2.0, 5.0)))
            })
            .collect();
        let hierarchy = BoxHierarchy::new(boxes.clone());
        let mut met = 0;
        for step in 0..500u32 {
            let origin = DVec3::new(-10.0, f64::from(step % 90), f64::from(step * 7 % 50));
            // Every third ray is parallel to an axis, where two of the three quotients are infinite.
            let direction =
                if step % 3 == 0 { DVec3::X } else { DVec3::new(1.0, 0.3, f64::from(step % 5) * 0.1 - 0.2) };
            let mut visited = vec![false; boxes.len()];
            hierarchy.visit(origin, direction, (0.0, f64::INFINITY), |number, t_max| {
                visited[number as usize] = true;
                t_max
            });
            for (number, (low, high)) in &boxes {
                let middle = low.midpoint(*high);
                let nearest = origin + direction * ((middle - origin).dot(direction) / direction.length_squared());
                if nearest.cmpge(*low).all() && nearest.cmple(*high).all() {
                    assert!(visited[*number as usize], "ray {step} meets box {number}");
                    met += 1;
                }
            }
        }
        assert!(met > 200, "{met}");
    }

    /// Along an axis two of the three quotients are infinite, and must not let every box pass.
    #[test]
    fn a_ray_along_an_axis_visits_only_the_boxes_on_its_way() {
        let at = |x: f64, y: f64| (DVec3::new(x, y, 0.0), DVec3::new(x + 1.0, y + 1.0, 1.0));
        let boxes = (0..400).map(|i| (i, at(f64::from(i % 20) * 2.0, f64::from(i / 20) * 2.0)));
        let hierarchy = BoxHierarchy::new(boxes.collect());
        // On a side of the boxes, too.
        for y in [6.5, 6.0, 7.0] {
            let mut visited = Vec::new();
            hierarchy.visit(DVec3::new(-5.0, y, 0.5), DVec3::X, (0.0, f64::INFINITY), |number, t_max| {
                visited.push(number);
                t_max
            });
            visited.sort_unstable();
            assert_eq!(visited, (60..80).collect::<Vec<_>>(), "{y}");
        }
        hierarchy.visit(DVec3::new(-5.0, 5.5, 0.5), DVec3::X, (0.0, f64::INFINITY), |_, _| panic!("between the boxes"));
    }

    #[test]
    fn boxes_behind_what_was_found_are_passed_over() {
        let at = |x: f64| (DVec3::new(x, -1.0, -1.0), DVec3::new(x + 1.0, 1.0, 1.0));
        let hierarchy = BoxHierarchy::new((0..64).map(|i| (i, at(f64::from(i) * 2.0))).collect());
        let mut visited = Vec::new();
        hierarchy.visit(DVec3::new(-5.0, 0.0, 0.0), DVec3::X, (0.0, f64::INFINITY), |number, _| {
            visited.push(number);
            6.0
        });
        assert_eq!(visited, [0]);
        BoxHierarchy::new(Vec::new()).visit(DVec3::ZERO, DVec3::X, (0.0, 1.0), |_, _| panic!("there is no box"));
    }
}

//! Unions of boxes on a grid, as boolean operations leave them.

use glam::{IVec3, Vec3};
use std::collections::BTreeSet;

/// Cells of the grid along each axis.
pub const CELLS: i32 = 5;

/// A box of cells of a grid.
pub type Cells = ([i32; 3], [i32; 3]);

/// Whether a cell is in one of the boxes.
pub fn is_full(boxes: &[Cells], cell: IVec3) -> bool {
    boxes.iter().any(|(a, b)| (0..3).all(|axis| (a[axis].min(b[axis])..=a[axis].max(b[axis])).contains(&cell[axis])))
}

/// The rectangles of the surface of a union.
#[derive(Clone, Copy, PartialEq)]
pub enum Cut {
    /// As wide as possible, and then as high, or the other way round, by axis.
    Wide,
    /// The reverse.
    High,
    /// Unit squares, without T-junctions.
    #[allow(dead_code)]
    Unit,
}

/// The surface of a union of boxes, as positions, which are whole numbers, and rectangles, each with vertices of its own,
/// counter-clockwise seen from outside.
pub fn union(boxes: &[Cells], cut: Cut) -> (Vec<Vec3>, Vec<Vec<u32>>) {
    let (mut positions, mut polygons) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for layer in 0..=CELLS {
            for outwards in [-1, 1] {
                let mut open: BTreeSet<(i32, i32)> = BTreeSet::new();
                for a in 0..CELLS {
                    for b in 0..CELLS {
                        let mut cell = IVec3::ZERO;
                        (cell[axis], cell[u], cell[v]) = (layer - i32::from(outwards > 0), a, b);
                        let mut beyond = cell;
                        beyond[axis] = layer - i32::from(outwards < 0);
                        if is_full(boxes, cell) && !is_full(boxes, beyond) {
                            open.insert((a, b));
                        }
                    }
                }
                while let Some(&(a, b)) = open.first() {
                    let (mut wide, mut high) = (1, 1);
                    let fits =
                        |wide: i32, high: i32| (0..wide).all(|i| (0..high).all(|j| open.contains(&(a + i, b + j))));
                    for turn in 0..if cut == Cut::Unit { 0 } else { 2 } {
                        if (turn + axis + usize::from(cut == Cut::Wide)).is_multiple_of(2) {
                            while fits(wide + 1, high) {
                                wide += 1;
                            }
                        } else {
                            while fits(wide, high + 1) {
                                high += 1;
                            }
                        }
                    }
                    for i in 0..wide {
                        for j in 0..high {
                            open.remove(&(a + i, b + j));
                        }
                    }
                    let first = positions.len() as u32;
                    for (i, j) in [(0, 0), (wide, 0), (wide, high), (0, high)] {
                        let mut at = IVec3::ZERO;
                        (at[axis], at[u], at[v]) = (layer, a + i, b + j);
                        positions.push(at.as_vec3());
                    }
                    let mut quad: Vec<u32> = (first..first + 4).collect();
                    if outwards < 0 {
                        quad.reverse();
                    }
                    polygons.push(quad);
                }
            }
        }
    }
    (positions, polygons)
}

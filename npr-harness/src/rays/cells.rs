//! Spatial splits, where faces are large and pass through one another: there no order of whole faces has small boxes.
//!
//! A node of the hierarchy whose boxes are an overlapping cluster becomes a cell. When the first ray comes to a
//! cell it is halved by a plane across its longest side, and the boxes of what lies on both sides are clipped to either
//! (Stich, Friedrich & Dietrich 2009, "Spatial Splits in Bounding Volume Hierarchies", section 4). Halves are cells
//! again, or a hierarchy of their own. On demand, because of such faces a ray sees the first few: a tree that is built
//! only where rays go (Hunt, Mark & Fussell 2007, "Fast and Lazy Build of Acceleration Structures from Scene
//! Hierarchies") is fine at the skin and coarse within, where splitting everything as finely would take hundreds of
//! references a face.
//!
//! There are at most 5 n + 2²² references in all, of about 80 bytes, and a reference is halved at most 64 times. What a
//! ray hits does not depend on which cells others have opened.
//!
//! The picture of a polygon with 20,000 random corners, 1280 by 720 px, takes 3.8 s of processor time where it took 50 s
//! without cells; two million random faces as large as the scene stay slow, 0.2 ms a ray. Models (bunny, teapot, beetle,
//! fandisk, rocker arm, suzanne) have no cells.

use super::clusters::is_overlapping;
use super::hierarchy::{Hierarchy, hierarchy};
use super::threads;
use super::triangle::{PADDING, Triangle};
use glam::{DVec3, Vec3A};
use obvhs::{aabb::Aabb, bvh2::Bvh2};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

/// Halving in the middle takes at most this part of the references that are left.
const AT_ONCE: usize = 32;

/// Where that is too much, this share of the cell is cut off.
const SKIN: f32 = 1.0 / 16.0;

/// Cells of so many halvings become a hierarchy.
const LEVELS: u8 = 64;

/// So do those where so many times in a row both halves had nearly all that the cell had.
const STALLED: u8 = 6;

/// Nearly all.
const NEARLY: f64 = 0.95;

/// References beyond one a face: so many for each face, and so many more in any scene.
const REFERENCES: (usize, usize) = (4, 1 << 22);

/// A hierarchy with its triangles in the order of its leaves.
#[derive(Default)]
pub struct Tree {
    pub bvh: Bvh2,
    pub triangles: Vec<Triangle>,
    pub cells: Vec<Cell>,
}

/// What a ray comes to in a cell.
pub struct Half {
    pub bounds: Aabb,
    pub content: Content,
}

pub enum Content {
    Cell(Cell),
    Tree(Tree),
}

/// Faces that lie over one another, halved when a ray comes.
pub struct Cell {
    /// Until it is halved.
    references: Mutex<References>,
    halves: OnceLock<Box<[Half; 2]>>,
    level: u8,
    stalled: u8,
}

/// Parts of triangles: of which faces, and boxes around what of them lies in some cell.
#[derive(Default)]
pub struct References {
    pub faces: Vec<u32>,
    /// Padded by [`PADDING`].
    pub boxes: Vec<Aabb>,
}

/// What cells are parts of.
pub struct Whole {
    /// Per face; empty where there are no cells.
    pub triangles: Vec<Triangle>,
    /// The hierarchy works on (position − centre) / half_size.
    pub center: DVec3,
    pub half_size: f64,
    /// So many references more may be made.
    left: AtomicUsize,
}

impl Whole {
    pub fn new(faces: usize, center: DVec3, half_size: f64) -> Self {
        let left = AtomicUsize::new(REFERENCES.0.saturating_mul(faces).saturating_add(REFERENCES.1));
        Self { triangles: Vec::new(), center, half_size, left }
    }

    /// Whether so many references may be made; then they count as made.
    fn take(&self, count: usize) -> bool {
        let take = |left: usize| left.checked_sub(count);
        self.left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, take).is_ok()
    }

    fn corners(&self, face: u32) -> [Vec3A; 3] {
        self.triangles[face as usize].corners.map(|c| ((c.as_dvec3() - self.center) / self.half_size).as_vec3a())
    }
}

impl Tree {
    /// `cells`: how deep in cells it is, and [`Cell::stalled`]; none are made without.
    pub fn new(references: References, cells: Option<(u8, u8)>, triangle: impl Fn(u32) -> Triangle + Sync) -> Self {
        let References { faces, boxes } = references;
        let Hierarchy { bvh, crowds } = hierarchy(boxes, faces, cells.is_some());
        let (level, stalled) = cells.unwrap_or_default();
        let cell = |(faces, boxes)| Cell::new(References { faces, boxes }, level, stalled);
        let in_order = &bvh.primitive_indices;
        let mut triangles: Vec<Triangle> = bytemuck::zeroed_vec(in_order.len());
        let piece = in_order.len().div_ceil(threads::count(in_order.len())).max(1);
        threads::each(triangles.chunks_mut(piece).zip(in_order.chunks(piece)), |(triangles, faces)| {
            for (place, &face) in triangles.iter_mut().zip(faces) {
                *place = triangle(face);
            }
        });
        Self { triangles, bvh, cells: crowds.into_iter().map(cell).collect() }
    }
}

impl Cell {
    fn new(references: References, level: u8, stalled: u8) -> Self {
        Self { references: Mutex::new(references), halves: OnceLock::new(), level, stalled }
    }

    /// Its halves. The first ray that comes makes them; others wait for it.
    pub fn halves(&self, whole: &Whole) -> &[Half; 2] {
        self.halves.get_or_init(|| {
            let mut references = self.references.lock().unwrap_or_else(PoisonError::into_inner);
            Box::new(self.halve(std::mem::take(&mut references), whole))
        })
    }

    fn halve(&self, references: References, whole: &Whole) -> [Half; 2] {
        let bounds = references.boxes.iter().fold(Aabb::INVALID, |all, one| all.union(one));
        let count = references.faces.len();
        let (axis, at) = plane(&bounds, &references.boxes, whole.left.load(Ordering::Relaxed));
        // Everything might lie on both sides.
        if self.level >= LEVELS || self.stalled >= STALLED || !whole.take(count) {
            return [references, References::default()].map(|half| Half::new(half, None, whole));
        }
        let mut halves = [References::default(), References::default()];
        for (face, bounds) in references.faces.into_iter().zip(references.boxes) {
            let within = (bounds.min[axis] + PADDING as f32, bounds.max[axis] - PADDING as f32);
            let parts = if within.1 <= at {
                [bounds, Aabb::INVALID]
            } else if within.0 >= at {
                [Aabb::INVALID, bounds]
            } else {
                clipped(whole.corners(face), &bounds, axis, at)
            };
            for (half, part) in halves.iter_mut().zip(parts) {
                if part.min.cmple(part.max).all() {
                    half.faces.push(face);
                    half.boxes.push(part);
                }
            }
        }
        let least = halves.iter().map(|half| half.faces.len()).min().unwrap_or(0);
        let more = halves.iter().map(|half| half.faces.len()).sum::<usize>().saturating_sub(count);
        whole.left.fetch_add(count - more, Ordering::Relaxed);
        let stalled = if least as f64 > NEARLY * count as f64 { self.stalled + 1 } else { 0 };
        halves.map(|half| Half::new(half, Some((self.level + 1, stalled)), whole))
    }
}

impl Half {
    fn new(references: References, cells: Option<(u8, u8)>, whole: &Whole) -> Self {
        let bounds = references.boxes.iter().fold(Aabb::INVALID, |all, one| all.union(one));
        let content = match cells {
            Some((level, stalled)) if is_overlapping(&bounds, &references.boxes) => {
                Content::Cell(Cell::new(references, level, stalled))
            }
            _ => Content::Tree(Tree::new(references, cells, |face| whole.triangles[face as usize])),
        };
        Self { bounds, content }
    }
}

#[cfg(test)]
impl Tree {
    /// How many references it and its cells have, and how often its cells are halved cells.
    pub fn count(&self) -> (usize, u8) {
        self.cells
            .iter()
            .map(Cell::count)
            .fold((self.triangles.len(), 0), |(sum, deep), (references, level)| (sum + references, deep.max(level)))
    }
}

#[cfg(test)]
impl Cell {
    fn count(&self) -> (usize, u8) {
        let Some(halves) = self.halves.get() else {
            return (self.references.lock().unwrap_or_else(PoisonError::into_inner).faces.len(), self.level);
        };
        let [a, b] = [0, 1].map(|half: usize| match &halves[half].content {
            Content::Cell(cell) => cell.count(),
            Content::Tree(tree) => tree.count(),
        });
        (a.0 + b.0, a.1.max(b.1).max(self.level))
    }
}

/// Where a cell is halved: an axis, the longest, and a place on it. In the middle, unless that takes too large a share
/// of the references that are left; then near the end where fewer boxes are, so that few of them are on both sides.
fn plane(bounds: &Aabb, boxes: &[Aabb], left: usize) -> (usize, f32) {
    let size = bounds.diagonal();
    let axis = size.max_position();
    let below = |at: f32| boxes.iter().filter(|one| one.min[axis] + (PADDING as f32) < at).count();
    let above = |at: f32| boxes.iter().filter(|one| one.max[axis] - (PADDING as f32) > at).count();
    let middle = bounds.min[axis] + size[axis] * 0.5;
    if (below(middle) + above(middle)).saturating_sub(boxes.len()) <= left / AT_ONCE {
        return (axis, middle);
    }
    let ends = [bounds.min[axis] + size[axis] * SKIN, bounds.max[axis] - size[axis] * SKIN];
    (axis, if below(ends[0]) <= above(ends[1]) { ends[0] } else { ends[1] })
}

/// Boxes around what of a triangle lies below and above a plane across an axis, padded, and within `bounds`, which are
/// padded too. Such without an inside are of nothing.
///
/// Both have the points in which edges cross the plane as they are computed, so that nothing is lost between them: what
/// is between the triangle and the two parts of it is rounding, and the padding is more.
fn clipped(corners: [Vec3A; 3], bounds: &Aabb, axis: usize, at: f32) -> [Aabb; 2] {
    let [mut below, mut above] = [Aabb::INVALID; 2];
    for (from, to) in [(0, 1), (1, 2), (2, 0)].map(|(from, to)| (corners[from], corners[to])) {
        if from[axis] <= at {
            below.extend(from);
        }
        if from[axis] >= at {
            above.extend(from);
        }
        if (from[axis] < at && to[axis] > at) || (from[axis] > at && to[axis] < at) {
            let share = ((at - from[axis]) / (to[axis] - from[axis])).clamp(0.0, 1.0);
            let crossing = from + (to - from) * share;
            below.extend(crossing);
            above.extend(crossing);
        }
    }
    [below, above].map(|part| Aabb {
        min: (part.min - PADDING as f32).max(bounds.min),
        max: (part.max + PADDING as f32).min(bounds.max),
    })
}

#[cfg(test)]
mod tests;

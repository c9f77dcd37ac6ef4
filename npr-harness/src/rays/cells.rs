//! Spatial splits for large intersecting faces, for which no hierarchy over whole faces has small boxes.
//!
//! A node of the hierarchy whose boxes form an overlapping cluster becomes a cell. When the first ray reaches a cell,
//! the cell is split by a plane across its longest side, and the boxes of faces on both sides are clipped to each half
//! (Stich, Friedrich & Dietrich 2009, "Spatial Splits in Bounding Volume Hierarchies", section 4). Each half is again a
//! cell, or an ordinary hierarchy. Cells are built on demand (Hunt, Mark & Fussell 2007, "Fast and Lazy Build of
//! Acceleration Structures from Scene Hierarchies"), because a ray only hits the outermost of such faces: the tree
//! becomes fine at the surface of the cluster and stays coarse within, where an equally fine split would need hundreds
//! of references per face.
//!
//! There are at most 5 n + 2²² references in total, of about 80 bytes each, and a reference is split at most 64 times.
//! The hits of a ray do not depend on which cells have been split.
//!
//! With cells, the picture of a polygon with 20,000 random corners, 1280 × 720 px, takes 3.8 s of processor time,
//! without them 50 s. Two million random faces as large as the scene remain slow, at 0.2 ms per ray. Models (bunny,
//! teapot, beetle, fandisk, rocker arm, suzanne) have no cells.

use super::clusters::is_overlapping;
use super::hierarchy::{Hierarchy, hierarchy};
use super::threads;
use super::triangle::{PADDING, Triangle};
use glam::{DVec3, Vec3A};
use obvhs::{aabb::Aabb, bvh2::Bvh2};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

/// A split in the middle may use at most 1 / AT_ONCE of the remaining references.
const AT_ONCE: usize = 32;

/// Otherwise this fraction of the cell is split off.
const SKIN: f32 = 1.0 / 16.0;

/// Cells split this many times become an ordinary hierarchy.
const LEVELS: u8 = 64;

/// So do cells where both halves had nearly all references for this many splits in a row.
const STALLED: u8 = 6;

/// The fraction of the references that counts as nearly all.
const NEARLY: f64 = 0.95;

/// The maximum number of additional references: per face, and in total for any scene.
const REFERENCES: (usize, usize) = (4, 1 << 22);

/// A hierarchy with its triangles in the order of its leaves.
#[derive(Default)]
pub struct Tree {
    pub bvh: Bvh2,
    pub triangles: Vec<Triangle>,
    pub cells: Vec<Cell>,
}

/// The content of half a cell.
pub struct Half {
    pub bounds: Aabb,
    pub content: Content,
}

pub enum Content {
    Cell(Cell),
    Tree(Tree),
}

/// An overlapping cluster of faces, split when the first ray reaches it.
pub struct Cell {
    /// The references, until the cell is split.
    references: Mutex<References>,
    halves: OnceLock<Box<[Half; 2]>>,
    level: u8,
    stalled: u8,
}

/// References to parts of triangles: their faces, and the boxes of the parts within a cell.
#[derive(Default)]
pub struct References {
    pub faces: Vec<u32>,
    /// Padded by [`PADDING`].
    pub boxes: Vec<Aabb>,
}

/// The data shared by all cells.
pub struct Whole {
    /// Per face; empty where there are no cells.
    pub triangles: Vec<Triangle>,
    /// The hierarchy works on (position − centre) / half_size.
    pub center: DVec3,
    pub half_size: f64,
    /// The number of further references that may be created.
    left: AtomicUsize,
}

impl Whole {
    pub fn new(faces: usize, center: DVec3, half_size: f64) -> Self {
        let left = AtomicUsize::new(REFERENCES.0.saturating_mul(faces).saturating_add(REFERENCES.1));
        Self { triangles: Vec::new(), center, half_size, left }
    }

    /// Reserves references, if so many are left.
    fn take(&self, count: usize) -> bool {
        let take = |left: usize| left.checked_sub(count);
        self.left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, take).is_ok()
    }

    fn corners(&self, face: u32) -> [Vec3A; 3] {
        self.triangles[face as usize].corners.map(|c| ((c.as_dvec3() - self.center) / self.half_size).as_vec3a())
    }
}

impl Tree {
    /// `cells`: the depth of nested cells and [`Cell::stalled`]; `None` to create no cells.
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

    /// Its halves. The first ray creates them; other threads wait for it.
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
        // `count` allows for references that lie on both sides.
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
    /// The number of references in the tree and its cells, and the depth of nested cells.
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

/// The plane that splits a cell: its longest axis, and a position on it. The position is the middle, unless that needs
/// too many of the remaining references; then it is near the end with fewer boxes, so that few boxes are on both sides.
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

/// The boxes of the parts of a triangle below and above a plane across an axis, padded and clipped to `bounds`, which
/// are padded too. Empty parts have inverted boxes.
///
/// Both boxes contain the computed intersections of edges and plane, so that nothing is lost between them: the parts
/// differ from the triangle by rounding only, which is less than the padding.
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

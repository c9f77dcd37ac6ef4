//! Overlapping clusters: nodes of the hierarchy whose boxes overlap so much that no hierarchy over whole faces
//! separates them.

use super::triangle::PADDING;
use obvhs::aabb::Aabb;

/// The least overlap of a cell's boxes: the sum of their surfaces over the surface of their bounding box, which is the
/// mean number of boxes that a random line through it intersects.
pub const OVERLAP: f32 = 32.0;

/// The least mean surface of a cell's boxes, relative to the cell's surface: smaller boxes are separated without
/// splits.
const SHARE: f32 = 1.0 / 16.0;

/// The `prim_count` that marks a cell; its `first_index` is the cell's index in the tree.
pub const CELL: u32 = u32::MAX;

/// The approximate number of boxes, at equal steps, that are sampled to choose a split.
pub const SAMPLE: usize = 1024;

/// Whether boxes in `bounds` overlap enough to form a cell; large numbers of boxes are sampled.
pub fn is_overlapping(bounds: &Aabb, boxes: &[Aabb]) -> bool {
    // Boxes of the size of the padding overlap regardless of their content.
    if boxes.len() as f32 <= OVERLAP || bounds.diagonal().max_element() < 64.0 * PADDING as f32 {
        return false;
    }
    let least = OVERLAP.max(SHARE * boxes.len() as f32);
    let step = boxes.len().div_ceil(SAMPLE);
    step as f32 * boxes.iter().step_by(step).map(Aabb::half_area).sum::<f32>() > least * bounds.half_area()
}

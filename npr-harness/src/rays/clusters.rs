//! Overlapping clusters: where the boxes of a part of the hierarchy lie so much over one another that no order of whole
//! faces separates them.

use super::triangle::PADDING;
use obvhs::aabb::Aabb;

/// More boxes than this lie over one another in a cell: their surface over that of the box around them, which is how
/// many of them a line through it meets in the mean.
pub const OVERLAP: f32 = 32.0;

/// Nor are a cell's boxes smaller than this in the mean, as a share of its surface: small ones are told apart whole.
const SHARE: f32 = 1.0 / 16.0;

/// A cell's `prim_count`; its `first_index` is its number among the tree's cells.
pub const CELL: u32 = u32::MAX;

/// Where a part is divided is decided by about so many of its boxes, at equal steps.
pub const SAMPLE: usize = 1024;

/// Whether boxes in `bounds` lie so much over one another that they are a cell; of many, by a sample of them.
pub fn is_overlapping(bounds: &Aabb, boxes: &[Aabb]) -> bool {
    // Boxes of the padding's size lie over one another whatever is in them.
    if boxes.len() as f32 <= OVERLAP || bounds.diagonal().max_element() < 64.0 * PADDING as f32 {
        return false;
    }
    let least = OVERLAP.max(SHARE * boxes.len() as f32);
    let step = boxes.len().div_ceil(SAMPLE);
    step as f32 * boxes.iter().step_by(step).map(Aabb::half_area).sum::<f32>() > least * bounds.half_area()
}

//! Ground truth: lines, bands, tones, shadows and normals computed by independent definitions, and the errors of
//! pictures relative to them.

pub mod bands;
pub mod hatch;
pub mod lines;
pub mod normal_use;
pub mod pieces;
pub mod shadows;
pub mod width;

/// The shift of a reference's samples that finds where it is sensitive to sampling, px.
pub const SHIFT_PX: f64 = 1.0 / 32.0;
/// The grid to which a GPU rounds the corners of faces, px: Vulkan requires at least 1/16 px, all tested devices have
/// this.
pub const ROUNDED_PX: f64 = 1.0 / 256.0;

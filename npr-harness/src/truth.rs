//! What is exactly right: lines, bands, tones, shadows and normals by definitions of their own, and how far pictures are
//! from them.

pub mod bands;
pub mod hatch;
pub mod lines;
pub mod normal_use;
pub mod shadows;

/// How far a reference's samples are moved to find out where it is sensitive, px.
pub const SHIFT_PX: f64 = 1.0 / 32.0;
/// What the corners of faces are rounded to on a device, px: Vulkan asks for a 16th at least, all that were seen have
/// this.
pub const ROUNDED_PX: f64 = 1.0 / 256.0;

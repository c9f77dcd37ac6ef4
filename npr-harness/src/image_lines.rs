//! Image-space lines: edge detection in normals, regions and depths that are rendered with the picture.

pub(crate) mod cpu;
pub mod gbuffer;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
pub mod plan;
pub(crate) mod schema;
pub mod style;
mod variants;

pub use plan::{ImageLines, ImagePlan};
pub use style::{ImageInk, InkScale, Regions};
pub(crate) use variants::{VARIANTS, width_px};

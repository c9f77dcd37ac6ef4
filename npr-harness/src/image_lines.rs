//! Lines that are found in the image: of normals, regions and depths beside its colours.

pub(crate) mod cpu;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
pub mod plan;
pub(crate) mod schema;
pub mod style;

pub use plan::{ImageLines, ImagePlan};
pub use style::{ImageInk, InkScale, Regions};

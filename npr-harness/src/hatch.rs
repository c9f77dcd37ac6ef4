//! Hatching with strokes from a tonal art map, denser where a surface is darker.

pub(crate) mod cpu;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
pub mod plan;
pub(crate) mod schema;
pub mod style;
mod variants;

pub use plan::{HatchPlan, HatchVertex};
pub use style::{HatchEncoding, HatchGround, HatchMap, HatchMapping, HatchShade, HatchSource, HatchTransfer, read_map};
pub(crate) use variants::VARIANTS;

//! Outlines by the inverted hull: a model's back faces, displaced outwards and drawn in ink behind its surface.

pub(crate) mod cpu;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
pub mod plan;
pub(crate) mod schema;
mod variants;

pub use plan::{HullLines, HullPlan};
pub(crate) use variants::VARIANTS;

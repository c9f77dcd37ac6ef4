//! Lines along the edges of a mesh: silhouettes, boundaries, creases and borders between materials.

pub(crate) mod cpu;
pub mod plan;
pub(crate) mod schema;
mod variants;

pub use plan::{EdgeLineMethod, EdgeLinePlan};
pub(crate) use variants::VARIANTS;

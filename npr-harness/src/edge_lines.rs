//! Lines along the edges of a mesh: silhouettes, boundaries, creases, borders between materials, and lines that the
//! file itself draws.

pub(crate) mod authored;
pub(crate) mod cpu;
pub mod plan;
pub(crate) mod schema;
mod variants;

pub use plan::{EdgeLineMethod, EdgeLinePlan};
pub(crate) use variants::VARIANTS;

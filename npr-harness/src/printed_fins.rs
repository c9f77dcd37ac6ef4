//! Outlines as printed in Card & Mitchell 2002 (listing 1): a fin for every edge, for comparison.

pub(crate) mod cpu;
pub mod plan;
pub(crate) mod schema;
mod variants;

pub use plan::{PrintedFinPlan, PrintedLines};
pub(crate) use variants::VARIANTS;

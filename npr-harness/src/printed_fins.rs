//! Outlines as Card & Mitchell 2002 printed them (listing 1): a fin for every edge, to be compared with.

pub(crate) mod cpu;
pub mod plan;
pub(crate) mod schema;

pub use plan::{PrintedFinPlan, PrintedLines};

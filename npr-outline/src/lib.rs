//! Which edges are contours, and the geometry that draws them.
#![warn(missing_docs)]

pub mod contour;
mod error;
#[cfg(feature = "wgpu")]
pub mod fin_pass;
pub mod fin_printed;
pub mod line_look;
#[cfg(feature = "wgpu")]
pub mod line_pass;
pub mod normal_format;
pub mod segment;

pub use contour::{ContourEdges, ContourOptions, LineKind, contour_edges};
pub use error::OutlineError;

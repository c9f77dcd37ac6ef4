//! Which edges are contours, and the geometry that draws them.
//!
//! ```
//! use glam::DVec4;
//! use npr_mesh::{edges, embedded};
//!
//! let model = embedded::cube();
//! let found =
//!     edges::find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &Default::default());
//! let contours = npr_outline::contour_edges(&model, &found, &Default::default())?;
//! let mut lines = Vec::new();
//! contours.scan(DVec4::new(3.0, 4.0, 5.0, 1.0), &mut lines); // an eye; with w = 0 a parallel view
//! assert_eq!(lines.len(), 12); // the cube's edges are creases, lines for every eye
//! # Ok::<(), npr_outline::OutlineError>(())
//! ```
//!
//! From an edge to a line on the screen:
//!
//! 1. [`contour`]: which edges are lines for an eye, decided once per edge. The records are flat, 32 bytes an edge.
//! 2. [`segment`]: an edge cut at the near plane, projected, widened by px and hidden where its centreline is hidden.
//! 3. [`line_look`]: width by kind of line, and ink.
//! 4. With the feature `wgpu`, `line_pass` draws them: with lines found by a scan on the CPU and sent as records, or
//!    found by a compute pass and drawn indirectly.
//!
//! [`fin_printed`] (and `fin_pass`) are the fins of 2002 as they were printed, all edges of a model in a vertex buffer,
//! to be measured against. [`normal_format`] has their face normals in f32, i16, i8 and octahedral records.
//!
//! Seen from a light, the same edges bound the model's shadows: [`shadow_volume`], which `shadow_pass` counts in a stencil
//! buffer, and `shadow_mask` turns the counts into a texture that every device can read.
//!
//! Formulas stand here twice, in Rust (f64, the reference) and in WGSL under the same names.
//!
//! # Sources
//!
//! - D. Card, J. L. Mitchell: *Non-Photorealistic Rendering with Pixel and Vertex Shaders*, in *Direct3D ShaderX*,
//!   2002, "Rendering Outlines" and listing 1. Where it disagrees with itself is told in [`fin_printed`], what is done
//!   instead in [`contour`] and [`segment`].
#![warn(missing_docs)]

pub mod contour;
mod error;
#[cfg(feature = "wgpu")]
pub mod filled_buffer;
#[cfg(feature = "wgpu")]
pub mod fin_pass;
pub mod fin_printed;
pub mod line_look;
#[cfg(feature = "wgpu")]
pub mod line_pass;
pub mod normal_format;
pub mod segment;
#[cfg(feature = "wgpu")]
mod shader;
#[cfg(feature = "wgpu")]
pub mod shadow_mask;
#[cfg(feature = "wgpu")]
pub mod shadow_pass;
pub mod shadow_volume;
#[cfg(feature = "wgpu")]
mod target;

/// The crate of the vectors and matrices in this API.
pub use glam;
/// The crate of the models and edges in this API.
pub use npr_mesh;
/// The crate of the devices, textures and encoders in this API.
#[cfg(feature = "wgpu")]
pub use wgpu;

pub use contour::{ContourEdges, ContourOptions, LineKind, contour_edges};
pub use error::OutlineError;

/// Compiles the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadMe;

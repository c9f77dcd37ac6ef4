//! Finds the edges of a model that are contours, and draws them as lines.
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
//! The stages from an edge to a line on the screen:
//!
//! 1. [`contour`]: which edges are lines for an eye, decided once for each edge from a record of 32 bytes.
//! 2. [`segment`]: an edge clipped, projected, with a width in px, and hidden where its centreline is hidden.
//! 3. [`line_style`]: the line style: width by kind of line, colour and opacity.
//! 4. With the feature `wgpu`, `line_pass` draws them: with lines found by a scan on the CPU and sent as records, or
//!    found by a compute pass and drawn indirectly.
//!
//! [`fin_printed`] and `fin_pass` are the fins of 2002 as printed, with all edges of a model in a vertex buffer, for
//! comparison. [`normal_format`] has their face normals in f32, i16, i8 and octahedral records.
//!
//! [`hull`] and `hull_pass` are the inverted hull, the outline that games use most: displaced back faces in ink, without
//! edges. [`raster`] draws its triangles and the fins' on the CPU.
//!
//! [`shadow_volume`] makes shadow volumes from the same edges, `shadow_pass` counts them in a stencil buffer, and
//! `shadow_mask` converts the counts to a texture that every device can read in a shader.
//!
//! Formulas are written twice with the same names and parameters: in Rust, mostly in f64, as the reference, and in
//! WGSL.
//!
//! # Sources
//!
//! - D. Card, J. L. Mitchell: *Non-Photorealistic Rendering with Pixel and Vertex Shaders*, in *Direct3D ShaderX*,
//!   2002, "Rendering Outlines" and listing 1. Its contradictions are listed in [`fin_printed`], the corrections
//!   are in [`contour`] and [`segment`].
//! - R. Raskar, M. Cohen: *Image Precision Silhouette Edges*, I3D 1999, and R. Raskar: *Hardware Support for
//!   Non-photorealistic Rendering*, Graphics Hardware 2001: back faces, extended ([`hull`]).
#![warn(missing_docs)]

pub mod contour;
mod error;
#[cfg(feature = "wgpu")]
pub mod filled_buffer;
#[cfg(feature = "wgpu")]
pub mod fin_pass;
pub mod fin_printed;
pub mod hull;
#[cfg(feature = "wgpu")]
pub mod hull_pass;
#[cfg(feature = "wgpu")]
pub mod line_pass;
pub mod line_style;
pub mod normal_format;
pub mod raster;
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

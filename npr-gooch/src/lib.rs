//! Cool-to-warm light: Gooch shading, for technical illustration.
//!
//! ```
//! use glam::{DVec3, Vec3};
//! use npr_gooch::{Gooch, gooch_shade};
//!
//! let model = Gooch::default();
//! model.validate()?;
//! let red = DVec3::X;
//! // Seen from +Z, a surface that faces the eye, with the light from the side: halfway between cool and warm.
//! let color = gooch_shade(&model, red, DVec3::Z, DVec3::X, DVec3::Z);
//! let (cool, warm) = (DVec3::new(0.25, 0.0, 0.55), DVec3::new(0.8, 0.3, 0.0));
//! assert!(color.abs_diff_eq((cool + warm) / 2.0, 1e-6));
//! # Ok::<(), npr_gooch::GoochError>(())
//! ```
//!
//! N·L, all of −1..=1, goes from a cool colour to a warm one: hue tells where a surface faces, and its lightness stays
//! in the middle, so that black lines and white highlights are seen everywhere.
//!
//! The same functions under the same names, `gooch_`, stand here twice: in Rust in f64, the reference, and in [`WGSL`],
//! a library without bindings or entry points to put in front of a shader. [`GoochUniform`] is what carries a
//! [`Gooch`] from one to the other. The object's colour k_d is given with every point: one for the object, or a
//! texture's. The example `wgpu_gooch` is such a shader, with all of wgpu that it takes.
//!
//! # Sources
//!
//! - A. Gooch, B. Gooch, P. Shirley, E. Cohen: *A Non-Photorealistic Lighting Model for Automatic Technical
//!   Illustration*, SIGGRAPH 1998, sections on matte objects: the model, its four numbers, and the highlight, "the
//!   traditional exponential term from the Phong lighting model".
//! - D. Card, J. L. Mitchell: *Non-Photorealistic Rendering with Pixel and Vertex Shaders*, in *Direct3D ShaderX*,
//!   2002, section "Gooch Lighting", listings 6 (vertex shader) and 7 (pixel shader).
//!
//! # What was wrong in print
//!
//! - Gooch 1998 writes I = (1 + l·n)/2 k_cool + (1 − (1 + l·n)/2) k_warm. With l toward the light, as there, the lit
//!   side would be cool; its text and figures have it warm, and so has the equation in Card & Mitchell.
//! - Listing 7 pairs α with k_yellow and β with k_blue, the reverse of both equations, and its comments call the yellow
//!   term cool and the blue one warm. The lit side is yellow all the same. It is here as [`Gooch::listing_7`],
//!   [`Tones::Listing7`].
//! - Listing 7's example for k_d is {0.0, 0.0, 0.4}, the same as for k_blue in the line before: perhaps a slip. It is
//!   kept as [`LISTING_7_K_D`].
//! - No listing has the highlight that the text keeps clear.
//!
//! # Colours and clamping
//!
//! Colours are display-referred (sRGB-encoded), as the listing computes them; the equations name no space. The cool and
//! the warm colour are each clamped to 0..=1 *before* they are mixed, as listing 7's `_sat` does; what is mixed is
//! then within 0..=1 by itself, and changes evenly from one end to the other. (Clamped only afterwards, a warm colour
//! beyond 1 would leave part of the lit side without any change of tone.) With the default numbers nothing is
//! clamped: no component exceeds 0.8.
//!
//! # Several lights
//!
//! The model has one. Since N·L is not clamped at zero, the sum of several directions, each by its brightness, gives
//! just the sum of their N·L, for every normal: [`gooch_aggregate`] is that direction. It is found once for an
//! object, and has no form in WGSL.
#![warn(missing_docs)]

mod error;
mod model;
mod shade;
mod uniform;

/// The crate of the vectors and matrices in this API.
pub use glam;

pub use error::GoochError;
pub use model::{Gooch, Highlight, LISTING_7_K_D, Tones};
pub use shade::{
    gooch_aggregate, gooch_cool, gooch_highlight, gooch_n_dot_l, gooch_over, gooch_r_dot_e, gooch_r_dot_e_of,
    gooch_shade, gooch_tone, gooch_warm, gooch_weight,
};
pub use uniform::GoochUniform;

/// The functions of this crate in WGSL: no bindings, no entry points, every name begins with `gooch_` or `Gooch`.
///
/// They take [`GoochUniform`] by value, as WGSL cannot pass a uniform by reference.
pub const WGSL: &str = include_str!("gooch.wgsl");

/// Compiles the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadMe;

//! Gooch shading: cool-to-warm lighting for technical illustration.
//!
//! ```
//! use glam::{DVec3, Vec3};
//! use npr_gooch::{Gooch, gooch_shade};
//!
//! let model = Gooch::default();
//! model.validate()?;
//! let red = DVec3::X;
//! // The light is perpendicular to the normal: the tone is halfway between cool and warm.
//! let color = gooch_shade(&model, red, DVec3::Z, DVec3::X, DVec3::Z);
//! let (cool, warm) = (DVec3::new(0.25, 0.0, 0.55), DVec3::new(0.8, 0.3, 0.0));
//! assert!(color.abs_diff_eq((cool + warm) / 2.0, 1e-6));
//! # Ok::<(), npr_gooch::GoochError>(())
//! ```
//!
//! The range −1..=1 of N·L is mapped from a cool colour to a warm colour. Orientation is shown by hue at medium lightness,
//! so that black lines and white highlights remain visible on every surface.
//!
//! Every function exists twice under one name with the prefix `gooch_`: in Rust in f64 as the reference, and in [`WGSL`], a
//! library without bindings or entry points to prepend to a shader. [`GoochUniform`] transfers a [`Gooch`] to the shader.
//! The object's colour k_d is an argument, so it can be constant or come from a texture. The example `wgpu_gooch` is a
//! complete wgpu program that uses the library.
//!
//! # Sources
//!
//! - A. Gooch, B. Gooch, P. Shirley, E. Cohen: *A Non-Photorealistic Lighting Model for Automatic Technical
//!   Illustration*, SIGGRAPH 1998, sections on matte objects: the model, its four parameters, and the highlight, "the
//!   traditional exponential term from the Phong lighting model".
//! - D. Card, J. L. Mitchell: *Non-Photorealistic Rendering with Pixel and Vertex Shaders*, in *Direct3D ShaderX*,
//!   2002, section "Gooch Lighting", listings 6 (vertex shader) and 7 (pixel shader).
//!
//! # Errors in print
//!
//! - Gooch et al. 1998 print I = (1 + l·n)/2 k_cool + (1 − (1 + l·n)/2) k_warm. With l pointing to the light, as defined
//!   there, the lit side would be cool. Their text and figures, and the equation of Card & Mitchell, make it warm, as here.
//! - Listing 7 pairs α with k_yellow and β with k_blue, the reverse of both equations, and its comments call the yellow
//!   term cool and the blue term warm. Its lit side is yellow. It is provided as [`Gooch::swapped_shares`] and
//!   [`Tones::SwappedShares`].
//! - Listing 7's example of k_d, {0.0, 0.0, 0.4}, is equal to k_blue in the preceding line and may be a misprint. It is
//!   provided as [`EXAMPLE_K_D`].
//! - No listing contains the highlight that the text describes.
//!
//! # Colours and clamping
//!
//! Colours are display-referred (sRGB-encoded), as in the listing; the equations do not specify a colour space. The cool
//! and the warm colour are each clamped to 0..=1 *before* they are mixed, as by `_sat` in listing 7. The mixture is then
//! within 0..=1 and linear in N·L. Clamping only the mixture would leave a part of the lit side without variation where
//! the warm colour exceeds 1. The default parameters need no clamping: no component exceeds 0.8.
//!
//! # Several lights
//!
//! The model has one light. Since N·L is not clamped at zero, the sum of several light directions, each weighted by its
//! brightness, gives the sum of the N·L terms for every normal: [`gooch_aggregate`] computes its direction. It is intended
//! to be computed once per object and has no WGSL counterpart.
#![warn(missing_docs)]

mod error;
mod model;
mod shade;
mod uniform;

/// The vector and matrix types in this API.
pub use glam;

pub use error::GoochError;
pub use model::{EXAMPLE_K_D, Gooch, Highlight, Tones};
pub use shade::{
    gooch_aggregate, gooch_cool, gooch_highlight, gooch_n_dot_l, gooch_over, gooch_r_dot_e, gooch_r_dot_e_unit,
    gooch_shade, gooch_tone, gooch_warm, gooch_weight,
};
pub use uniform::GoochUniform;

/// The functions of this crate in WGSL: no bindings, no entry points, every name begins with `gooch_` or `Gooch`.
///
/// They take [`GoochUniform`] by value, since WGSL functions cannot take a uniform by reference.
pub const WGSL: &str = include_str!("shade.wgsl");

/// Compiles the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadMe;

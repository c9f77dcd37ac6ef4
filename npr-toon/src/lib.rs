//! Banded light: cartoon shading with any number of N·L bands and an N·H highlight, with ramps, and with two lights.
//!
//! ```
//! use glam::DVec3;
//! use npr_toon::{Bands, toon_band_hard, toon_n_dot_l};
//!
//! let bands = Bands::listing_3();
//! bands.validate()?;
//! let n_dot_l = toon_n_dot_l(DVec3::Z, DVec3::new(0.0, 3.0, 4.0)); // 0.8
//! assert_eq!(toon_band_hard(&bands, n_dot_l - 1e-6), DVec3::splat(f64::from(0.6_f32)));
//! assert_eq!(toon_band_hard(&bands, 1.0), bands.tones[2].as_dvec3());
//! # Ok::<(), npr_toon::ToonError>(())
//! ```
//!
//! The same things under the same names stand here twice: as Rust functions in f64, the reference, and in
//! [`WGSL`], a library without bindings or entry points to put in front of a shader. [`ToonUniform`] is what
//! carries [`Bands`] from one to the other. Functions that stand in both begin with `toon_`; [`row::toon_row`],
//! [`table::toon_table`] and [`normal::toon_n_dot_l_across`], which read texels and vertices, stand in Rust only.
//! The example `wgpu_toon` is such a shader, with all of wgpu that it takes.
//!
//! - [`Bands`], [`toon_shade`]: steps of N·L and a highlight, here at the crate's root.
//! - [`ramp`], [`row`]: any colours by light, computed from stops or read from an image.
//! - [`table`], [`painter`]: two lights, each an axis of a 2D ramp, under one colour.
//! - [`half_lambert`]: light that reaches around; [`source`]: lights, and several of them as one.
//! - [`border`]: how wide a border is where derivatives are of no use; [`normal`]: what interpolated normals cost.
//!
//! # Sources
//!
//! - A. Lake, C. Marshall, M. Harris, M. Blackstein: *Stylized Rendering Techniques for Scalable Real-Time 3D
//!   Animation*, NPAR 2000. Two colours, the border where N·L crosses zero, antialiased by a 1D texture
//!   ([`Bands::hard_shading`]).
//! - D. Card, J. L. Mitchell: *Non-Photorealistic Rendering with Pixel and Vertex Shaders*, in *Direct3D ShaderX*,
//!   2002, listings 2 (vertex shader) and 3 (pixel shader). The bands are computed, no texture is read. The
//!   light of *Half-Life* is told in its section "Gooch Lighting".
//! - *The Evolution of a Cartoon Renderer*, GDNet: the painter, listings 1 and 2, figures 1 and 2.
//!
//! What was wrong in print: the last instruction but one of listing 2, which normalises the half vector, has lost its
//! opcode (`mul`). The text describes one threshold on N·L and one on N·H; listing 3 has two on N·L and never
//! reads the half vector. Both are here, as [`Bands::chapter_text`] and [`Bands::listing_3`].
//!
//! # Colours
//!
//! All colours are display-referred (sRGB-encoded, 0..=1), as artists pick them and as the listings compute them. A
//! band's tone *multiplies* the surface's colour; on a white surface it is the colour that one sees.
//!
//! # Borders
//!
//! A hard band is a sum of steps, and a pixel's colour the mean of the bands that it covers. Where N·L changes
//! linearly across the pixel by `width`, the share of the pixel above a threshold t is `clamp((N·L - t) / width +
//! 1/2, 0, 1)`, and band i covers what is above its lower border less what is above its upper one. These shares are
//! never negative and sum to 1, however many borders fall into one pixel, and where they are 0 or 1 the tone comes
//! out bit for bit. In a shader the width is [`border::toon_border_width`] of N·L's derivatives. (Mixing border by
//! border, `mix(c, tone, share)`, agrees for one border in a pixel, but counts a band thinner than a pixel wrongly.)
//! What is left is that a pixel is a square and its gradient seldom runs along a side. Over all directions that is 7% of a
//! hard border's error, root mean square; the exact share of a square takes three times the operations, for each border.
#![warn(missing_docs)]

mod bands;
pub mod border;
mod error;
pub mod half_lambert;
mod light;
pub mod normal;
pub mod painter;
pub mod ramp;
pub mod row;
pub mod source;
pub mod table;
mod uniform;

/// The crate of the vectors and matrices in this API.
pub use glam;

pub use bands::{Bands, Highlight};
pub use error::ToonError;
pub use light::{
    MIN_SUM, MIN_WIDTH, toon_band_hard, toon_band_smooth, toon_coverage, toon_half, toon_highlight, toon_n_dot_h,
    toon_n_dot_h_interpolated, toon_n_dot_h_of, toon_n_dot_l, toon_n_dot_l_interpolated, toon_shade, toon_width,
};
pub use uniform::{MAX_BANDS, ToonUniform};

/// The functions of this crate in WGSL: no bindings, no entry points, every name begins with `toon_` or `Toon`.
///
/// Set the override [`TOON_BANDS_OVERRIDE`] to the number of bands in use (in wgpu,
/// `PipelineCompilationOptions::constants`), and [`ramp::TOON_STOPS_OVERRIDE`] to that of stops. Unset, the result is
/// the same and slower.
///
/// `toon_band` and `toon_shade` take [`ToonUniform`] by value, as WGSL cannot pass a uniform by reference. Since the
/// loop over the bands has a length that is known when the pipeline is made, compilers unroll it and read only the
/// fields they need; with a length from the uniform a software rasteriser copies the whole struct for every pixel,
/// and took ten times as long.
pub const WGSL: &str = concat!(
    include_str!("toon.wgsl"),
    include_str!("border.wgsl"),
    include_str!("half_lambert.wgsl"),
    include_str!("source.wgsl"),
    include_str!("ramp.wgsl"),
    include_str!("row.wgsl"),
    include_str!("table.wgsl"),
    include_str!("painter.wgsl"),
);

/// The name of the override in [`WGSL`] that says how many bands its functions look at: 1..=[`MAX_BANDS`], at least
/// as many as [`ToonUniform::count`], by default all.
pub const TOON_BANDS_OVERRIDE: &str = "toon_bands";

/// Compiles the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadMe;

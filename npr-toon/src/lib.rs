//! Cartoon shading: any number of bands of N·L with an N·H highlight, colour ramps, and two-light painting.
//!
//! ```
//! use glam::DVec3;
//! use npr_toon::{Bands, toon_band_hard, toon_n_dot_l};
//!
//! let bands = Bands::three_diffuse_bands();
//! bands.validate()?;
//! let n_dot_l = toon_n_dot_l(DVec3::Z, DVec3::new(0.0, 3.0, 4.0)); // 0.8
//! assert_eq!(toon_band_hard(&bands, n_dot_l - 1e-6), DVec3::splat(f64::from(0.6_f32)));
//! assert_eq!(toon_band_hard(&bands, 1.0), bands.tones[2].as_dvec3());
//! # Ok::<(), npr_toon::ToonError>(())
//! ```
//!
//! Every function exists twice under one name with the prefix `toon_`: in Rust in f64 as the reference, and in [`WGSL`], a
//! library without bindings or entry points to prepend to a shader. [`ToonUniform`] transfers [`Bands`] to the shader.
//! [`row::toon_row`], [`table::toon_table`] and [`normal::toon_n_dot_l_across`], which read texels and vertices, exist in
//! Rust only. The example `wgpu_toon` is a complete wgpu program that uses the library.
//!
//! - [`Bands`], [`toon_shade`]: bands of N·L and a highlight, at the crate's root.
//! - [`ramp`], [`row`]: colour ramps over the diffuse term, computed from stops or read from an image.
//! - [`table`], [`painter`]: two lights, one per axis of a 2D ramp, with one common light colour.
//! - [`x_toon`]: bands that fade with depth or near the silhouette.
//! - [`half_lambert`]: half-Lambert lighting; [`source`]: lights, and the aggregate of several lights.
//! - [`border`]: limits on the width of antialiased borders; [`normal`]: light per pixel, from interpolated normals, per
//!   vertex, per face and per piece of a face.
//!
//! # Sources
//!
//! - A. Lake, C. Marshall, M. Harris, M. Blackstein: *Stylized Rendering Techniques for Scalable Real-Time 3D
//!   Animation*, NPAR 2000. Two colours, the border where N·L crosses zero, antialiased by a 1D texture
//!   ([`Bands::hard_shading`]).
//! - D. Card, J. L. Mitchell: *Non-Photorealistic Rendering with Pixel and Vertex Shaders*, in *Direct3D ShaderX*,
//!   2002, listings 2 (vertex shader) and 3 (pixel shader). The bands are computed, no texture is read. Its section
//!   "Gooch Lighting" describes the lighting of *Half-Life*.
//! - *The Evolution of a Cartoon Renderer*, GDNet: the painter, listings 1 and 2, figures 1 and 2.
//!
//! Errors in print: the second to last instruction of Card & Mitchell's listing 2, which normalises the half vector, lacks
//! its opcode (`mul`). Their text describes one threshold on N·L and one on N·H; their listing 3 has two on N·L and never
//! reads the half vector. Both variants are provided: [`Bands::diffuse_and_specular`] and [`Bands::three_diffuse_bands`].
//!
//! # Colours
//!
//! All colours are display-referred (sRGB-encoded, 0..=1), as in the listings. A band's tone *multiplies* the surface's
//! colour, unless [`Bands::absolute`] makes it the colour itself, as listing 3 does.
//!
//! # Borders
//!
//! The colour of a pixel is the mean over the bands that it covers. Where N·L changes linearly across the pixel by
//! `width`, the fraction of the pixel above a threshold t is `clamp((N·L - t) / width + 1/2, 0, 1)`, and the fraction
//! covered by a band is the fraction above its lower threshold minus the fraction above its upper threshold. These
//! fractions are never negative and sum to 1, however many borders fall into one pixel, and where they are 0 or 1 the
//! tone is reproduced exactly. In a shader the width is [`border::toon_border_width`] of the derivatives of N·L.
//! Blending border by border, `mix(c, tone, fraction)`, agrees for one border per pixel but misweights bands thinner than
//! a pixel. The remaining error comes from treating the pixel as one-dimensional along the gradient: over all directions
//! it is 7 % of the error of a hard border (root mean square). The exact area of a square would take three times the
//! operations per border.
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
pub mod x_toon;

/// The vector and matrix types in this API.
pub use glam;

pub use bands::{Bands, Highlight};
pub use error::ToonError;
pub use light::{
    MIN_SUM, MIN_WIDTH, toon_band, toon_band_hard, toon_coverage, toon_half, toon_highlight, toon_n_dot_h,
    toon_n_dot_h_from_dots, toon_n_dot_h_interpolated, toon_n_dot_l, toon_n_dot_l_interpolated, toon_shade, toon_width,
};
pub use uniform::{MAX_BANDS, ToonUniform};

/// The functions of this crate in WGSL: no bindings, no entry points, every name begins with `toon_` or `Toon`.
///
/// Set the override [`TOON_BANDS_OVERRIDE`] to the number of bands in use (in wgpu,
/// `PipelineCompilationOptions::constants`), and [`ramp::TOON_STOPS_OVERRIDE`] to the number of stops. If unset, the result
/// is the same but slower to compute.
///
/// `toon_band` and `toon_shade` take [`ToonUniform`] by value, since WGSL functions cannot take a uniform by reference.
/// The length of the loop over the bands is known when the pipeline is created, so compilers unroll it and read only the
/// required fields. With a length from the uniform, a software rasteriser copied the whole struct for each pixel and took
/// ten times as long.
pub const WGSL: &str = concat!(
    include_str!("light.wgsl"),
    include_str!("border.wgsl"),
    include_str!("half_lambert.wgsl"),
    include_str!("source.wgsl"),
    include_str!("ramp.wgsl"),
    include_str!("row.wgsl"),
    include_str!("table.wgsl"),
    include_str!("painter.wgsl"),
    include_str!("normal.wgsl"),
    include_str!("x_toon.wgsl"),
);

/// The name of the override in [`WGSL`] for the number of bands that its functions read: 1..=[`MAX_BANDS`] and at least
/// [`ToonUniform::count`]. The default is [`MAX_BANDS`].
pub const TOON_BANDS_OVERRIDE: &str = "toon_bands";

/// Compiles the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadMe;

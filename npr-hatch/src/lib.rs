//! Tonal art maps: hatching strokes nested in tones and mip levels, tone weights by light, and one-channel thresholds.
//!
//! ```
//! use npr_hatch::{TamParameters, Thresholds, draw, store};
//!
//! let parameters = TamParameters { side: 64, ..TamParameters::default() };
//! let drawing = draw(&parameters, None)?;
//! assert!((drawing.tam.mean(2, 0) - 4.0 / 7.0).abs() < 0.005);
//! let thresholds = Thresholds::new(&drawing, &parameters, None);
//! let bytes = store::to_bytes(&drawing.tam, Some(&thresholds))?;
//! assert_eq!(store::from_bytes(&bytes)?.tam, drawing.tam);
//! # Ok::<(), npr_hatch::HatchError>(())
//! ```
//!
//! - [`draw`] draws the images of a [`Tam`] from [`TamParameters`], with tapered strokes or with strokes from a
//!   [`StrokeImage`]. [`store`] serialises a map to one file, the modules `png` and `sheet` (feature `image`, on by default)
//!   write pictures, and [`files`] writes files atomically.
//! - [`hatch_weights`] and [`hatch_blend`] weight and blend six tones by light (Card & Mitchell 2002, listings 4 and 5).
//!   [`weights`] describes the transfer curve: with a brightness of 7 and the default tones the hatched tone is N·L, with a
//!   minimum of 1/7. [`hatch_color`] applies a tone to a coloured surface, [`hatch_tone_in_shadow`] limits the tone in shadows.
//! - [`Thresholds`] and [`hatch_threshold`]: all tones in one channel.
//! - [`lookup`]: level selection and filtering that preserves the tone. [`mapping`]: texture coordinates on surfaces by
//!   planar projection, rotated by a [`field`] of directions, or by texture coordinates of any [`density`].
//!
//! Functions with the prefix `hatch_` exist twice: in Rust in f64 as the reference, and in [`WGSL`], a library without
//! bindings or entry points to prepend to a shader. [`LOOKUP_WGSL`], to be appended to it, reads textures. With the feature
//! `wgpu` the module `upload` creates the textures.
//!
//! # Sources
//!
//! - E. Praun, H. Hoppe, M. Webb, A. Finkelstein: *Real-Time Hatching*, SIGGRAPH 2001: tonal art maps, strokes nested
//!   in tones and mip levels, the best of several candidates, weights of six tones in two textures.
//! - D. Card, J. L. Mitchell: *Non-Photorealistic Rendering with Pixel and Vertex Shaders*, in *Direct3D ShaderX*, 2002,
//!   section "Hatching", listings 4 (vertex shader) and 5 (pixel shader), and figure 10.
//! - M. Webb, E. Praun, A. Finkelstein, H. Hoppe: *Fine Tone Control in Hardware Hatching*, NPAR 2002: thresholds.
//! - W. T. Reeves, D. H. Salesin, R. L. Cook: *Rendering Antialiased Shadows with Depth Maps*, SIGGRAPH 1987: comparing
//!   before filtering.
//! - S. Rusinkiewicz: *Estimating Curvatures and Their Derivatives on Triangle Meshes*, 3DPVT 2004: curvature.
//! - A. B. Owen: *Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences*, 1995: stroke positions.
//!
//! Errors in print: the comment in Card & Mitchell's listing 4 says that N·L is multiplied by six and clamped at zero. The
//! factor is a program constant ("brightness") without a stated value, and no instruction clamps. Clamping is not needed,
//! since the darkest tone has all the weight up to a factor of 1. With a brightness of six no point becomes white.
//!
//! # How a map is drawn
//!
//! Praun et al. 2001 choose the strokes of each image separately: an image starts with the strokes of the lighter tone and
//! of the coarser level, and further strokes are selected from random candidates. This crate uses *one* sequence of strokes
//! per direction, of which every image draws a prefix. Nesting then follows from the sequence alone, coarse and fine levels
//! share strokes, and intermediate tones are possible. Every prefix of the sequence must be distributed evenly: either by a
//! low-discrepancy sequence ([`Placement::Sequence`]), or by the selection among candidates of the paper, by the added ink
//! relative to the candidate's own ink ([`Placement::BestOf`]). Where the paper evaluates candidates on a pyramid filtered
//! from one image, this crate uses the levels of the map itself. Both placements are equally even, measured as the deviation
//! of the mean tones of 16 × 16 blocks over six tones: 0.6 of that of random strokes, candidates being better in the
//! lightest tone. The sequence is the default because it takes less than 1/30 of the time of 32 candidates. Candidates
//! overlap less: the darkest tone needs a quarter fewer strokes.
//!
//! Ink is composited by its maximum in 8 bits, so a texel is never lighter in a darker tone. Each image has its tone up to
//! rounding: its last stroke is drawn with reduced pressure, and with full pressure in darker tones and finer levels. The
//! exception is a level of few texels that contains more strokes of the coarser level than its tone needs: with strokes one
//! texel wide the 2 × 2 level may be a few percent too dark.
//!
//! A map depends on its parameters alone: neither threads nor time nor the platform's math library affect it. Maps are
//! periodic: strokes wrap around at the borders, and stroke centres are integers that wrap exactly.
#![warn(missing_docs)]

pub mod density;
mod draw;
mod error;
pub mod field;
pub mod files;
mod footprint;
pub mod lookup;
pub mod mapping;
mod order;
mod parameters;
#[cfg(feature = "image")]
pub mod png;
#[cfg(feature = "image")]
pub mod sheet;
pub mod store;
mod stroke;
mod tam;
pub mod threshold;
#[cfg(feature = "wgpu")]
pub mod upload;
pub mod weights;

/// The vector and matrix types in this API.
pub use glam;
/// The device and texture types in this API.
#[cfg(feature = "wgpu")]
pub use wgpu;

pub use draw::{Drawing, Extent, Mark, draw};
pub use error::HatchError;
pub use parameters::{MAX_CANDIDATES, MAX_SIDE, MAX_TONES, MIN_SIDE, Placement, TamParameters, even_tones};
pub use stroke::{Stroke, StrokeImage};
pub use tam::Tam;
pub use threshold::{Thresholds, hatch_threshold};
pub use weights::{
    HATCH_TONES, HatchWeights, hatch_blend, hatch_color, hatch_level, hatch_level_of_tone, hatch_tone_in_shadow,
    hatch_transfer, hatch_weights,
};

/// The functions of this crate in WGSL: no bindings, no entry points, every name begins with `hatch_` or `Hatch`.
pub const WGSL: &str = concat!(
    include_str!("weights.wgsl"),
    include_str!("threshold.wgsl"),
    include_str!("footprint.wgsl"),
    include_str!("mapping.wgsl"),
);

/// Lookups in textures that the caller passes as arguments, to append to [`WGSL`]. No bindings and no entry points either.
pub const LOOKUP_WGSL: &str = include_str!("lookup.wgsl");

/// Compiles the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadMe;

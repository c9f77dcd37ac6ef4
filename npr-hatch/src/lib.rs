//! Tonal art maps: hatching strokes nested in tones and mips; their weights by light; and one-channel thresholds.
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
//! - [`draw`] makes the images of a [`Tam`] from [`TamParameters`], with strokes that thin out at their ends or that look
//!   like a [`StrokeImage`]; [`store`] puts a map into one file, the modules `png` and `sheet` (feature `image`, on by
//!   default) into pictures, and [`files`] those into files that are never half there.
//! - [`hatch_weights`] and [`hatch_blend`], listings 4 and 5: six tones by light; [`weights`] tells the transfer
//!   curve: with a brightness of 7 and the default tones the hatched tone is N·L, down to 1/7. [`hatch_color`] puts
//!   it over a coloured surface. [`hatch_shadowed`] has the darkest tone in shadows.
//! - [`Thresholds`] and [`hatch_threshold`]: all tones in one channel.
//! - [`lookup`]: which level a pixel shows of a map, and how it is filtered without changing the tone; [`mapping`]: where a
//!   map lies on a surface, by planes, turned by a [`field`] of directions that follow the form, or by texture
//!   coordinates of any [`density`].
//!
//! Functions that begin with `hatch_` stand here twice, in Rust in f64, the reference, and in [`WGSL`], a library without
//! bindings or entry points to put in front of a shader; lookups in textures are in [`LOOKUP_WGSL`], to be put after it.
//! With the feature `wgpu` the module `upload` makes the textures.
//!
//! # Sources
//!
//! - E. Praun, H. Hoppe, M. Webb, A. Finkelstein: *Real-Time Hatching*, SIGGRAPH 2001: tonal art maps, strokes nested
//!   in tones and mips, the best of several candidates, weights of six tones in two textures.
//! - D. Card, J. L. Mitchell: *Non-Photorealistic Rendering with Pixel and Vertex Shaders*, in *Direct3D ShaderX*, 2002,
//!   section "Hatching", listings 4 (vertex shader) and 5 (pixel shader), and figure 10.
//! - M. Webb, E. Praun, A. Finkelstein, H. Hoppe: *Fine Tone Control in Hardware Hatching*, NPAR 2002: thresholds.
//! - W. T. Reeves, D. H. Salesin, R. L. Cook: *Rendering Antialiased Shadows with Depth Maps*, SIGGRAPH 1987: compare, then
//!   filter.
//! - S. Rusinkiewicz: *Estimating Curvatures and Their Derivatives on Triangle Meshes*, 3DPVT 2004: curvature.
//! - A. B. Owen: *Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences*, 1995: where strokes go.
//!
//! What was wrong in print: the comment in listing 4 says that N·L is multiplied by six and clamped at zero. The
//! factor is a constant of the program that the listing does not give a value ("brightness"), and no instruction
//! clamps. None needs to: up to 1 the darkest tone has all the weight. With a factor of six no place is white.
//!
//! # How a map is made
//!
//! Praun 2001 chooses strokes image by image: each one begins with the strokes of the lighter tone and of the coarser
//! level, and new ones are drawn from random candidates. Here there is *one* order of strokes for each direction,
//! and every image draws its beginning, as far as its tone needs. That makes nesting follow from the order alone, lets
//! coarse levels use the strokes that fine ones have already instead of others, and gives tones in between.
//! What it asks for is an order of which every beginning is even: a low-discrepancy sequence
//! ([`Placement::Sequence`]), or the paper's choice among candidates, by the ink that each adds to the levels, as a share
//! of its own ([`Placement::BestOf`]; the paper's pyramid is made of one filtered image, this one of the map's own
//! levels). Measured as the deviation of the mean tones of 16 × 16 blocks, on the mean of six tones, the two are equally
//! even (0.6 of random strokes'; in the lightest tone the candidates are better), so the sequence, which takes less
//! than a thirtieth of the time of 32 candidates, is the default. Candidates
//! avoid touching strokes better: the darkest tone takes a quarter fewer of them.
//!
//! Ink is composited by its maximum, in 8 bits, so a texel is never lighter in a darker tone. Each image has its tone to
//! within a rounding: its last stroke is drawn with less pressure there, and fully in darker tones and finer levels.
//! Only where a coarser level of few texels forces more strokes on an image than its tone needs does that not
//! hold: with strokes one texel wide the level of 2 × 2 may be a few percent too dark.
//!
//! A map depends on its parameters alone: no thread, no clock, and no function of the machine's own mathematics has a
//! part in it. Any texel's neighbours across the border are its neighbours, and centres are whole numbers that wrap.
#![warn(missing_docs)]

pub mod density;
mod draw;
mod error;
pub mod field;
pub mod files;
pub mod lookup;
pub mod mapping;
mod parameters;
mod place;
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

/// The crate of the vectors and matrices in this API.
pub use glam;
/// The crate of the devices, textures and encoders in this API.
#[cfg(feature = "wgpu")]
pub use wgpu;

pub use draw::{Drawing, Extent, Mark, draw};
pub use error::HatchError;
pub use parameters::{MAX_CANDIDATES, MAX_SIDE, MAX_TONES, MIN_SIDE, Placement, TamParameters, even_tones};
pub use stroke::{Stroke, StrokeImage};
pub use tam::Tam;
pub use threshold::{Thresholds, hatch_threshold};
pub use weights::{
    HATCH_TONES, HatchWeights, hatch_blend, hatch_color, hatch_level, hatch_linear, hatch_shadowed, hatch_transfer,
    hatch_weights,
};

/// The functions of this crate in WGSL: no bindings, no entry points, every name begins with `hatch_` or `Hatch`.
pub const WGSL: &str = include_str!("hatch.wgsl");

/// Lookups in textures that the caller hands on, to put after [`WGSL`]: as little bound, as well named.
pub const LOOKUP_WGSL: &str = include_str!("lookup.wgsl");

/// Compiles the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadMe;

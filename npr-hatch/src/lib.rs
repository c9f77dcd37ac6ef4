//! Tonal art maps: hatching strokes nested in tones and mips; their weights by light; and one-channel thresholds.
//!
//! ```
//! use npr_hatch::{TamParameters, draw, store};
//!
//! let parameters = TamParameters { side: 64, ..TamParameters::default() };
//! let drawing = draw(&parameters, None)?;
//! assert!((drawing.tam.mean(2, 0) - 4.0 / 7.0).abs() < 0.005);
//! let bytes = store::to_bytes(&drawing.tam)?;
//! assert_eq!(store::from_bytes(&bytes)?, drawing.tam);
//! # Ok::<(), npr_hatch::HatchError>(())
//! ```
#![warn(missing_docs)]

mod draw;
mod error;
mod parameters;
mod place;
#[cfg(feature = "image")]
pub mod png;
pub mod store;
mod stroke;
mod tam;
pub mod threshold;
mod weights;

pub use draw::{Drawing, Extent, Mark, draw};
pub use error::HatchError;
pub use parameters::{MAX_CANDIDATES, MAX_SIDE, MAX_TONES, MIN_SIDE, Placement, TamParameters, even_tones};
pub use stroke::{Stroke, StrokeImage};
pub use tam::Tam;
pub use threshold::{Thresholds, hatch_threshold};
pub use weights::{
    HATCH_TONES, HatchWeights, hatch_blend, hatch_color, hatch_level, hatch_linear, hatch_transfer, hatch_weights,
};

/// The functions of this crate in WGSL: no bindings, no entry points, every name begins with `hatch_` or `Hatch`.
pub const WGSL: &str = include_str!("hatch.wgsl");

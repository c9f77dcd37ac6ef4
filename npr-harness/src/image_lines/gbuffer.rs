//! Image-space lines as the documents of 2002 find them: over a G-buffer whose formats, filters and steps of morphology
//! a style names one by one, instead of the packed texels and the fused filter.
//!
//! The geometry pass writes unquantised texels ([`texel`]). They are encoded in the style's formats, filtered, worked
//! on by morphology, and composited like other lines.

pub(crate) mod cpu;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
pub mod plan;
pub(crate) mod schema;
pub mod style;
#[cfg(feature = "gpu")]
pub(crate) mod targets;
pub mod texel;

//! Half-Lambert lighting: a diffuse term that varies over the whole sphere of normals.
//!
//! K. Birdwell's lighting for the characters of *Half-Life*, as described by Card & Mitchell 2002, section "Gooch
//! Lighting": N·L of one aggregate light ([`crate::source::aggregate`]), -1..=1, is scaled and biased to 0..=1 instead of
//! being clamped at zero, so that the unlit side is not flat. The Source engine squares the result (J. L. Mitchell,
//! M. McTaggart, C. Green: *Shading in Valve's Source Engine*, SIGGRAPH 2006), which darkens the terminator from 1/2 to
//! 1/4.
//!
//! The result can be used to look up a [`crate::ramp::Ramp`] or [`crate::Bands`]. The widths of antialiased borders must
//! then be taken from derivatives of the result, not of N·L.

use crate::ToonError;
use crate::light::saturate;

/// The parameters that map N·L to 0..=1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(default, rename_all = "kebab-case", deny_unknown_fields))]
pub struct HalfLambert {
    /// The factor on N·L, above 0.
    pub scale: f32,
    /// The summand after scaling.
    pub bias: f32,
    /// Whether the clamped result is squared.
    pub squared: bool,
}

impl HalfLambert {
    /// *Half-Life*: N·L / 2 + 1/2.
    pub const HALF_LIFE: Self = Self { scale: 0.5, bias: 0.5, squared: false };
    /// The Source engine: (N·L / 2 + 1/2)².
    pub const SOURCE: Self = Self { squared: true, ..Self::HALF_LIFE };

    /// Checks that scale and bias are finite and that the scale is above 0.
    pub fn validate(&self) -> Result<(), ToonError> {
        if self.scale > 0.0 && self.scale.is_finite() && self.bias.is_finite() {
            Ok(())
        } else {
            Err(ToonError::HalfLambert { scale: self.scale, bias: self.bias })
        }
    }
}

impl Default for HalfLambert {
    fn default() -> Self {
        Self::HALF_LIFE
    }
}

/// scale · N·L + bias clamped to 0..=1, and squared if the parameters say so. NaN gives 0.
///
/// ```
/// use npr_toon::half_lambert::{HalfLambert, toon_half_lambert};
/// assert_eq!(toon_half_lambert(&HalfLambert::HALF_LIFE, 0.0), 0.5);
/// assert_eq!(toon_half_lambert(&HalfLambert::SOURCE, 0.0), 0.25);
/// ```
pub fn toon_half_lambert(parameters: &HalfLambert, n_dot_l: f64) -> f64 {
    let scaled = saturate(f64::from(parameters.scale) * n_dot_l + f64::from(parameters.bias));
    if parameters.squared { scaled * scaled } else { scaled }
}

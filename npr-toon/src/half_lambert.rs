//! Half-Lambert: light that reaches around to the side that is turned away.
//!
//! K. Birdwell's light for the characters of *Half-Life*, as Card & Mitchell tell it (section "Gooch Lighting"): N·L
//! of one aggregate light ([`crate::source::aggregate`]), -1..=1, is scaled and biased to 0..=1 instead of being
//! clamped at zero, so that the far side is not flat. The engine that came after it squares the result (J. L.
//! Mitchell, M. McTaggart, C. Green: *Shading in Valve's Source Engine*, SIGGRAPH 2006), which darkens the terminator
//! from 1/2 to 1/4.
//!
//! What comes out is what a [`crate::ramp::Ramp`] or [`crate::Bands`] can be looked up with. Borders take their
//! width from the derivative of what they are looked up with: of the result, not of N·L.

use crate::ToonError;
use crate::light::saturate;

/// How N·L becomes 0..=1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfLambert {
    /// What N·L is multiplied with, above 0.
    pub scale: f32,
    /// What is added then.
    pub bias: f32,
    /// Whether the result is squared.
    pub squared: bool,
}

impl HalfLambert {
    /// Half-Life: a half, plus a half.
    pub const HALF_LIFE: Self = Self { scale: 0.5, bias: 0.5, squared: false };
    /// The Source engine: the same, squared.
    pub const SOURCE: Self = Self { squared: true, ..Self::HALF_LIFE };

    /// Refuses a scale that is not above 0, and what is not finite.
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

/// scale · N·L + bias, clamped to 0..=1 and then perhaps squared.
///
/// ```
/// use npr_toon::half_lambert::{HalfLambert, toon_half_lambert};
/// assert_eq!(toon_half_lambert(&HalfLambert::HALF_LIFE, 0.0), 0.5);
/// assert_eq!(toon_half_lambert(&HalfLambert::SOURCE, 0.0), 0.25);
/// ```
pub fn toon_half_lambert(how: &HalfLambert, n_dot_l: f64) -> f64 {
    let scaled = saturate(f64::from(how.scale) * n_dot_l + f64::from(how.bias));
    if how.squared { scaled * scaled } else { scaled }
}

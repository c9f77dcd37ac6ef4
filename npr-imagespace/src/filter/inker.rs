//! The inker of "The Evolution of a Cartoon Renderer", listings 3 and 4: four neighbours, the diagonal ones in its text,
//! compared in two opposite pairs, and no centre.
//!
//! With taps 0 and 2 opposite, 1 and 3 opposite, normals n and depths z (0..=1, as encoded), sat = clamp to 0..=1:
//!
//! ```text
//! T  = 0.9 − 0.25 z₀                    the normal threshold falls with depth
//! Nⱼ = sat(4 (nⱼ · nⱼ₊₂ − T))           for j = 0, 1
//! N  = sat(4 N₀ N₁)
//! dⱼ = zⱼ − zⱼ₊₂
//! ```
//!
//! - [`InkerForm::Printed`]: ink where (1 − N) + d₀² + ¼ + d₁ > ½. Error in print: d₁ is not squared, though
//!   the comment says "square the differences"; `mad r1.a, r1.a, r1.a, c1.a` is missing. So the sign of d₁ matters, and
//!   a border is inked in one direction only.
//! - [`InkerForm::Corrected`]: the missing instruction put in, ink where (1 − N) + d₀² + d₁² + ½ > ½. In exact
//!   arithmetic any difference of depth satisfies that, and every slanted face is ink. On the hardware of 2002 a square
//!   below half a step of 8 bits was 0.
//! - [`InkerForm::Explicit`]: two separate thresholds. Ink where 1 − N > ½ or d₀² + d₁² > δ². The default
//!   δ = [`DEPTH_DELTA`] is the effect of rounding to 8 bits in 2002: √(1/512) = 0.044, 11 steps of 8 bits.
//!
//! On a flat face N = sat(4 sat(0.4 + z)²), below 1 where z < 0.1: near faces are ink below z = 0.03 as printed and
//! below 0.1 repaired, and nowhere with explicit thresholds, N being at least 0.64.
//!
//! Soft, the explicit form gives 2 (1 − N), clamped, which is the listing's own ramp scaled so that ½ is a full
//! line, or if larger the ramp of d₀² + d₁² around δ². On a flat face that is 0 where T ≤ 7/8, and up to 0.72 with the
//! listing's 0.9, near the eye: soft lines need a lower threshold ([`INKER_SOFT_COS_MAX`]), which [`Inker::validate`]
//! checks.

use crate::ImageSpaceError;
use crate::filter::depth::check_depth_softness;
use crate::filter::ink_ramp;
use crate::picture::Taps;
use bytemuck::{Pod, Zeroable};
use glam::DVec3;

/// √(1/512): the smallest difference of depth whose square is not 0 in 8 bits.
pub const DEPTH_DELTA: f32 = 0.044_194_174;

/// The largest normal threshold, at any depth, with which flat faces have no ink where lines are soft: 7/8, below which
/// N = 1 for equal unit normals, less the 0.01326 by which the square of a unit normal in biased bytes may fall short
/// of 1.
pub const INKER_SOFT_COS_MAX: f32 = 0.8617;

/// The form of listing 4.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum InkerForm {
    /// As printed.
    Printed,
    /// With the missing instruction added.
    Corrected,
    /// With a threshold for normals and one for depth.
    #[default]
    Explicit,
}

/// The constants of listing 4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inker {
    /// The form.
    pub form: InkerForm,
    /// The cosine above which normals are similar at depth 0.
    pub normal_cos: f32,
    /// By how much that cosine falls from depth 0 to depth 1: this keeps distant smooth surfaces free of ink.
    pub normal_fall: f32,
    /// δ of the explicit form.
    pub depth_delta: f32,
    /// The explicit form's width of the transition of depth, as a share of its threshold, at most
    /// [`DEPTH_SOFTNESS_MAX`](crate::filter::depth::DEPTH_SOFTNESS_MAX); 0 for hard lines. That of normals has one
    /// width.
    pub softness: f32,
    /// The neighbours that are compared: listing 3's text describes the diagonal ones.
    pub taps: Taps,
}

impl Inker {
    /// Whether the softness is within its range, and gives flat faces no ink.
    ///
    /// # Errors
    /// If the softness is negative or not finite; in the explicit form, if flat faces would have ink.
    pub fn validate(&self) -> Result<(), ImageSpaceError> {
        if !(self.softness >= 0.0 && self.softness.is_finite()) {
            return Err(ImageSpaceError::Softness { softness: self.softness });
        }
        if self.form != InkerForm::Explicit || self.softness == 0.0 {
            return Ok(());
        }
        check_depth_softness(self.softness)?;
        // At depth 0 and at depth 1.
        let cos = self.normal_cos.max(self.normal_cos - self.normal_fall);
        let most = INKER_SOFT_COS_MAX;
        if cos > most { Err(ImageSpaceError::InkerSoftness { cos, most }) } else { Ok(()) }
    }
}

impl Default for Inker {
    fn default() -> Self {
        Self {
            form: InkerForm::Explicit,
            normal_cos: 0.9,
            normal_fall: 0.25,
            depth_delta: DEPTH_DELTA,
            softness: 0.0,
            taps: Taps::Diagonal,
        }
    }
}

/// An [`Inker`] as `InkInker` of the WGSL, 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct InkerUniform {
    /// 0 printed, 1 repaired, 2 explicit.
    pub form: u32,
    /// As [`Inker::normal_cos`].
    pub normal_cos: f32,
    /// As [`Inker::normal_fall`].
    pub normal_fall: f32,
    /// As [`Inker::depth_delta`].
    pub depth_delta: f32,
    /// As [`Inker::softness`].
    pub softness: f32,
    /// Unused, 0.
    pub padding: [u32; 3],
}

impl From<&Inker> for InkerUniform {
    fn from(inker: &Inker) -> Self {
        Self {
            form: inker.form as u32,
            normal_cos: inker.normal_cos,
            normal_fall: inker.normal_fall,
            depth_delta: inker.depth_delta,
            softness: inker.softness,
            padding: [0; 3],
        }
    }
}

/// N: 1 where both pairs of normals are similar, falling to 0.
pub fn ink_inker_similarity(inker: &Inker, normals: [DVec3; 4], depth0: f64) -> f64 {
    let threshold = f64::from(inker.normal_cos) - f64::from(inker.normal_fall) * depth0;
    let pair = |a: DVec3, b: DVec3| (4.0 * (a.dot(b) - threshold)).clamp(0.0, 1.0);
    (4.0 * pair(normals[0], normals[2]) * pair(normals[1], normals[3])).clamp(0.0, 1.0)
}

/// Ink of a pixel from its four taps: normals as decoded, depths 0..=1.
pub fn ink_inker(inker: &Inker, normals: [DVec3; 4], depths: [f64; 4]) -> f64 {
    let unlike = 1.0 - ink_inker_similarity(inker, normals, depths[0]);
    let (d0, d1) = (depths[0] - depths[2], depths[1] - depths[3]);
    let hard = |ink: bool| f64::from(u8::from(ink));
    match inker.form {
        InkerForm::Printed => hard(unlike + (d0 * d0 + 0.25 + d1) > 0.5),
        InkerForm::Corrected => hard(unlike + (d0 * d0 + 0.25 + (d1 * d1 + 0.25)) > 0.5),
        InkerForm::Explicit => {
            let limit = f64::from(inker.depth_delta).powi(2);
            let excess = d0 * d0 + d1 * d1 - limit;
            if inker.softness > 0.0 {
                return (2.0 * unlike).min(1.0).max(ink_ramp(excess, f64::from(inker.softness) * limit));
            }
            hard(unlike > 0.5 || excess > 0.0)
        }
    }
}

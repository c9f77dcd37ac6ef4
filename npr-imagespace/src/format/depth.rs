//! Linear eye-space depth in six formats.
//!
//! The chapter (Card & Mitchell 2002) stores 8 bits and expects that close surfaces are not separated in large scenes;
//! it proposes more or wider channels. The fixed-point formats store u = (z − near) / (far − near), the float formats z
//! itself, so that infinity and NaN are preserved and [`crate::format::ink_is_surface`] recognises them.
//!
//! # The smallest difference resolved
//!
//! Two depths that differ by at least this have different codes at any distance ([`DepthFormat::gap`]); somewhere two
//! depths that differ by less than half of it have the same code:
//!
//! - n bits: (far − near) / (2ⁿ − 1), at any distance;
//! - half float: 2^(⌊log₂ z⌋ − 10), full float: 2^(⌊log₂ z⌋ − 23), which grow with the distance;
//! - four channels of 8 bits hold more than the f32 that is put into them: (far − near) · 2^−24 for u in ½..1 and
//!   half of that for each halving of u; never below the spacing of z in f32, twice, as z − near is rounded, too.

use crate::ImageSpaceError;
use crate::format::half::{ink_half_decode, ink_half_encode};

/// How depth is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DepthFormat {
    /// One channel of 8 bits, as printed.
    Unorm8,
    /// One channel of 16 bits.
    Unorm16,
    /// 16 bits over two channels of 8, the high byte first.
    Packed2x8,
    /// 32 bits over four channels of 8, the high byte first.
    Packed4x8,
    /// A half float.
    Half,
    /// A full float.
    Float,
}

/// The eye-space depths that fixed-point formats span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRange {
    /// The nearest depth, above 0.
    pub near: f32,
    /// The farthest depth, above `near`.
    pub far: f32,
}

impl DepthRange {
    /// Checks `0 < near < far < ∞`.
    pub fn new(near: f32, far: f32) -> Result<Self, ImageSpaceError> {
        if near > 0.0 && near < far && far.is_finite() {
            return Ok(Self { near, far });
        }
        Err(ImageSpaceError::DepthRange { near, far })
    }

    /// 0 at near, 1 at far, clamped; NaN becomes 1.
    pub fn fraction(&self, depth: f32) -> f32 {
        let fraction = (depth - self.near) / (self.far - self.near);
        if fraction.is_nan() { 1.0 } else { fraction.clamp(0.0, 1.0) }
    }

    fn at(&self, fraction: f64) -> f32 {
        let (near, far) = (f64::from(self.near), f64::from(self.far));
        (near + fraction * (far - near)) as f32
    }
}

/// 0..=1 as 8 bits, rounded to the nearest.
fn ink_depth_encode8(fraction: f32) -> u32 {
    (fraction * 255.0 + 0.5) as u32
}

/// 0..=1 as 16 bits, rounded to the nearest.
fn ink_depth_encode16(fraction: f32) -> u32 {
    (fraction * 65535.0 + 0.5) as u32
}

/// 0..=1 as 32 bits, without loss of an f32's precision. 1 would be 2^32 and becomes the largest code.
fn ink_depth_encode32(fraction: f32) -> u32 {
    // In Rust this conversion saturates; in WGSL it need not.
    (fraction * 4294967296.0) as u32
}

/// 16 bits over two channels, the high byte first.
pub fn ink_depth_split2(code: u32) -> [u8; 2] {
    [(code >> 8) as u8, code as u8]
}

/// 32 bits over four channels, the high byte first.
pub fn ink_depth_split4(code: u32) -> [u8; 4] {
    code.to_be_bytes()
}

impl DepthFormat {
    /// All formats.
    pub const ALL: [Self; 6] = [Self::Unorm8, Self::Unorm16, Self::Packed2x8, Self::Packed4x8, Self::Half, Self::Float];

    /// Bytes of a texel.
    pub fn bytes(self) -> usize {
        match self {
            Self::Unorm8 => 1,
            Self::Unorm16 | Self::Packed2x8 | Self::Half => 2,
            Self::Packed4x8 | Self::Float => 4,
        }
    }

    /// Eye-space depth as a code, in the lower [`DepthFormat::bytes`]. Fixed-point formats store NaN as `far`.
    pub fn encode(self, depth: f32, range: &DepthRange) -> u32 {
        match self {
            Self::Unorm8 => ink_depth_encode8(range.fraction(depth)),
            Self::Unorm16 | Self::Packed2x8 => ink_depth_encode16(range.fraction(depth)),
            Self::Packed4x8 => ink_depth_encode32(range.fraction(depth)),
            Self::Half => u32::from(ink_half_encode(depth)),
            Self::Float => depth.to_bits(),
        }
    }

    /// Eye-space depth of a code.
    pub fn decode(self, code: u32, range: &DepthRange) -> f32 {
        match self {
            Self::Unorm8 => range.at(f64::from(code) / 255.0),
            Self::Unorm16 | Self::Packed2x8 => range.at(f64::from(code) / 65535.0),
            Self::Packed4x8 => range.at(f64::from(code) / 4294967296.0),
            Self::Half => ink_half_decode(code as u16),
            Self::Float => f32::from_bits(code),
        }
    }

    /// The smallest difference of eye-space depths around `depth` that is always resolved, by the formulas of this
    /// module.
    pub fn gap(self, depth: f64, range: &DepthRange) -> f64 {
        let span = f64::from(range.far) - f64::from(range.near);
        let spacing = |value: f64, bits: i32| 2f64.powi(value.log2().floor() as i32 - bits);
        match self {
            Self::Unorm8 => span / 255.0,
            Self::Unorm16 | Self::Packed2x8 => span / 65535.0,
            Self::Packed4x8 => {
                let fraction = ((depth - f64::from(range.near)) / span).max(2f64.powi(-32));
                (span * spacing(fraction, 23)).max(span * 2f64.powi(-32)).max(2.0 * spacing(depth, 23))
            }
            Self::Half => spacing(depth, 10),
            Self::Float => spacing(depth, 23),
        }
    }
}

//! A ramp as a row of image texels, and its sampling.
//!
//! The coordinate along a row of n texels is t = n (x − from) / (to − from): texel i covers i..i+1 and its centre is at
//! i + 1/2. Addressing is clamped: beyond the ends of the row its first or last texel continues.
//!
//! - *Nearest*: texel floor(t).
//! - *Linear*: with s = t − 1/2 the texels floor(s) and floor(s) + 1, mixed by s − floor(s).
//!
//! Vulkan, Direct3D and Metal define sampling at the normalised coordinate t/n in the same way, so a sampler with
//! clamp-to-edge addressing gives the same result up to rounding: it may quantise weights to 1/256, it may round the
//! result to 8 bits, and a t within rounding of a texel's border may select the neighbour. (Mesa's software driver differs
//! by up to 1/255 in a row and 1.5/255 in a table between black and white.) [`crate::WGSL`] has no bindings: it computes
//! which texels to load (`toon_row_nearest`, `toon_row_taps`); the shader calls `textureLoad` and `mix` with f32 weights.
//!
//! Texels are display-referred: use the texture format `Rgba8Unorm`, not `Rgba8UnormSrgb`. Alpha is not read.

use glam::DVec3;

use crate::ToonError;
use crate::ramp::{Ramp, toon_ramp};

/// The interpolation between texel centres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum TexelFilter {
    /// The nearest texel.
    #[default]
    Nearest,
    /// Linear interpolation.
    Linear,
}

/// A row of texels over a range of the diffuse term.
#[derive(Clone, Debug, PartialEq)]
pub struct RampRow {
    /// RGBA texels from dark to light, at least one.
    pub texels: Vec<[u8; 4]>,
    /// The argument at the left edge of the first texel: 0 to clamp N·L as in *The Evolution of a Cartoon Renderer*, −1 for
    /// the full range of N·L.
    pub from: f32,
    /// The argument at the right edge of the last texel: 1 for N·L.
    pub to: f32,
    /// The interpolation between texel centres.
    pub filter: TexelFilter,
}

impl RampRow {
    /// Samples a ramp at the centres of `count` texels, clamped to 0..=1 and rounded to 8 bits. The steps of a hard ramp are
    /// moved to texel borders.
    pub fn from_ramp(ramp: &Ramp, count: u32, from: f32, to: f32, filter: TexelFilter) -> Result<Self, ToonError> {
        ramp.validate()?;
        let step = (f64::from(to) - f64::from(from)) / f64::from(count);
        let texel = |i: u32| to_texel(toon_ramp(ramp, f64::from(from) + (f64::from(i) + 0.5) * step, 0.0));
        let row = Self { texels: (0..count).map(texel).collect(), from, to, filter };
        row.validate()?;
        Ok(row)
    }

    /// Checks that there is a texel and that the ends are ascending with a finite difference.
    pub fn validate(&self) -> Result<(), ToonError> {
        if self.texels.is_empty() {
            return Err(ToonError::Texels { width: 0, height: 1, texels: 0 });
        }
        let (from, to) = (self.from, self.to);
        let length = to - from;
        if length > 0.0 && length.is_finite() { Ok(()) } else { Err(ToonError::RowEnds { from, to }) }
    }
}

/// Two texels of a row and the weight of the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToonTaps {
    /// Index of the left texel.
    pub left: u32,
    /// Index of the right texel; equal to `left` at the last texel.
    pub right: u32,
    /// The weight of the right texel, 0..1.
    pub share: f64,
}

/// The index of the texel nearest to `x` in a row of `count` texels that covers `start`..`end`. NaN gives 0.
pub fn toon_row_nearest(x: f64, start: f64, end: f64, count: u32) -> u32 {
    texel((x - start) / (end - start) * f64::from(count), count)
}

/// The texels that linear filtering blends at `x` in a row of `count` texels that covers `start`..`end`. NaN gives the
/// first texel.
pub fn toon_row_taps(x: f64, start: f64, end: f64, count: u32) -> ToonTaps {
    // Clamped to the first and last texel centre; `max` turns NaN into 0.
    let last = f64::from(count.max(1) - 1);
    let s = ((x - start) / (end - start) * f64::from(count) - 0.5).max(0.0).min(last);
    ToonTaps { left: texel(s, count), right: texel(s + 1.0, count), share: s - s.floor() }
}

/// The display-referred RGB of the row at `x`.
///
/// ```
/// use npr_toon::row::{RampRow, TexelFilter, toon_row};
/// let row = RampRow { texels: vec![[0; 4], [255; 4]], from: -1.0, to: 1.0, filter: TexelFilter::Linear };
/// row.validate()?;
/// assert_eq!(toon_row(&row, -0.5).x, 0.0); // the first texel's centre
/// assert_eq!(toon_row(&row, 0.0).x, 0.5);
/// # Ok::<(), npr_toon::ToonError>(())
/// ```
pub fn toon_row(row: &RampRow, x: f64) -> DVec3 {
    let (start, end, count) = (f64::from(row.from), f64::from(row.to), row.texels.len() as u32);
    let color = |i: u32| row.texels.get(i as usize).map_or(DVec3::ZERO, |&texel| from_texel(texel));
    match row.filter {
        TexelFilter::Nearest => color(toon_row_nearest(x, start, end, count)),
        TexelFilter::Linear => {
            let taps = toon_row_taps(x, start, end, count);
            color(taps.left).lerp(color(taps.right), taps.share)
        }
    }
}

/// The index of the texel that covers `t`, clamped to the row.
fn texel(t: f64, count: u32) -> u32 {
    // `as` saturates, and converts NaN to 0.
    (t.floor() as u32).min(count.max(1) - 1)
}

/// Display-referred RGB, clamped to 0..=1, as an opaque 8-bit texel.
pub(crate) fn to_texel(color: DVec3) -> [u8; 4] {
    let [r, g, b] = color.to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
    [r, g, b, 255]
}

/// The RGB of a texel, 0..=1.
pub(crate) fn from_texel(texel: [u8; 4]) -> DVec3 {
    DVec3::new(f64::from(texel[0]), f64::from(texel[1]), f64::from(texel[2])) / 255.0
}

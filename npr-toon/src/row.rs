//! A ramp as a row of an image, and how it is sampled.
//!
//! The coordinate along a row of n texels is t = n (x − from) / (to − from): texel i covers i..i+1, its centre is at
//! i + 1/2. Clamp addressing: what is left or right of the row is its first or last texel.
//!
//! - *Nearest*: texel floor(t).
//! - *Linear*: with s = t − 1/2 the texels floor(s) and floor(s) + 1, mixed by s − floor(s).
//!
//! That is what Vulkan, Direct3D and Metal do with a normalised coordinate t/n, so a sampler set to clamp-to-edge gives
//! the same, but for roundings of its own: it may count the share in steps of 1/256, it may round what it mixes to 8
//! bits, and a t within a rounding of a texel's border may fall on the other side. (Mesa's software driver is up to 1/255
//! off in a row and 1.5/255 in a table, between black and white.) [`crate::WGSL`] has no bindings: it says which texels
//! to load (`toon_row_nearest`, `toon_row_taps`), and `textureLoad` and `mix` do the rest, with the share in f32.
//!
//! Texels are display-referred; put them into a `Rgba8Unorm` texture, not `Rgba8UnormSrgb`. Alpha is not read.

use glam::DVec3;

use crate::ToonError;
use crate::ramp::{Ramp, toon_ramp};

/// How an image is read between its texels' centres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TexelFilter {
    /// Steps.
    #[default]
    Nearest,
    /// From texel to texel.
    Linear,
}

/// A row of texels over a range of light.
#[derive(Clone, Debug, PartialEq)]
pub struct RampRow {
    /// From dark to light; at least one.
    pub texels: Vec<[u8; 4]>,
    /// What the row is looked up with at the left side of its first texel: 0 where N·L is to be clamped, as in the
    /// cartoon renderer; −1 for all of N·L.
    pub from: f32,
    /// And at the right side of its last, 1 for N·L.
    pub to: f32,
    /// Between the texels' centres.
    pub filter: TexelFilter,
}

impl RampRow {
    /// A row of `count` texels from a ramp, so that none need be painted: the ramp's colour at each texel's centre,
    /// clamped to 0..=1 and rounded to 8 bits. A hard ramp's steps come to lie between texels.
    pub fn from_ramp(ramp: &Ramp, count: u32, from: f32, to: f32, filter: TexelFilter) -> Result<Self, ToonError> {
        ramp.validate()?;
        let step = (f64::from(to) - f64::from(from)) / f64::from(count);
        let texel = |i: u32| to_texel(toon_ramp(ramp, f64::from(from) + (f64::from(i) + 0.5) * step, 0.0));
        let row = Self { texels: (0..count).map(texel).collect(), from, to, filter };
        row.validate()?;
        Ok(row)
    }

    /// Refuses a row without texels, and ends that are not ascending or not a finite number apart.
    pub fn validate(&self) -> Result<(), ToonError> {
        if self.texels.is_empty() {
            return Err(ToonError::Texels { width: 0, height: 1, texels: 0 });
        }
        let (from, to) = (self.from, self.to);
        let length = to - from;
        if length > 0.0 && length.is_finite() { Ok(()) } else { Err(ToonError::RowEnds { from, to }) }
    }
}

/// Two texels of a row, and what share of the colour is the second's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowTaps {
    /// Index of the left one.
    pub left: u32,
    /// Index of the right one; at the row's ends the same.
    pub right: u32,
    /// 0..=1.
    pub share: f64,
}

/// Which of `count` texels is nearest to `x`, if the row reaches from `from` to `to`. Not a number is the first.
pub fn toon_row_nearest(x: f64, from: f64, to: f64, count: u32) -> u32 {
    texel((x - from) / (to - from) * f64::from(count), count)
}

/// Which of `count` texels linear filtering mixes at `x`, if the row reaches from `from` to `to`. Not a number is the
/// first.
pub fn toon_row_taps(x: f64, from: f64, to: f64, count: u32) -> RowTaps {
    // Beyond the first and last centre there is nothing to mix, and NaN becomes the first.
    let last = f64::from(count.max(1) - 1);
    let s = ((x - from) / (to - from) * f64::from(count) - 0.5).max(0.0).min(last);
    RowTaps { left: texel(s, count), right: texel(s + 1.0, count), share: s - s.floor() }
}

/// The row's colour at `x`, without its alpha.
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
    let (from, to, count) = (f64::from(row.from), f64::from(row.to), row.texels.len() as u32);
    let color = |i: u32| row.texels.get(i as usize).map_or(DVec3::ZERO, |&texel| from_texel(texel));
    match row.filter {
        TexelFilter::Nearest => color(toon_row_nearest(x, from, to, count)),
        TexelFilter::Linear => {
            let taps = toon_row_taps(x, from, to, count);
            color(taps.left).lerp(color(taps.right), taps.share)
        }
    }
}

/// The texel that covers `t`; the first and the last go on for ever.
fn texel(t: f64, count: u32) -> u32 {
    // `as` saturates, and takes NaN for 0.
    (t.floor() as u32).min(count.max(1) - 1)
}

/// Display-referred RGB as an opaque texel.
pub(crate) fn to_texel(color: DVec3) -> [u8; 4] {
    let [r, g, b] = color.to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
    [r, g, b, 255]
}

/// A texel's RGB.
pub(crate) fn from_texel(texel: [u8; 4]) -> DVec3 {
    DVec3::new(f64::from(texel[0]), f64::from(texel[1]), f64::from(texel[2])) / 255.0
}

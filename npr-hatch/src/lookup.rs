//! Which texels of a map a pixel shows, and how they are filtered.
//!
//! # Level
//!
//! Strokes are as wide in texels at every level, so a stroke is as wide on the screen at every distance if the level is
//! the one whose texels are as large as pixels: log2 of the texels that a pixel spans, and between two levels a mean of
//! both. All strokes of the coarser one are in the finer one, so nearing a surface only adds strokes.
//!
//! Seen at a slant, a pixel spans more texels along one axis of its footprint than across it. By the longer one, as
//! textures are filtered, a wall that runs away is hatched by ever fewer, ever wider strokes; by the shorter one, strokes
//! alias. [`hatch_footprint`] takes the mean of both, the side of the square that has the footprint's area, so that there
//! is as much *ink* per area of the screen as on a surface seen straight on, and as many strokes; along the longer
//! axis four samples are spread where one would alias. From [`HATCH_MAX_ANISOTROPY`] on coarser levels are taken.
//!
//! Every sample of every level has the mean tone that was asked for, so none of this changes the tone. Where a map is but
//! a few pixels there is no room for strokes, and what is left is its tone ([`hatch_flat`]).
//!
//! # Thresholds are compared before they are filtered
//!
//! As in shadow maps (W. T. Reeves, D. H. Salesin, R. L. Cook: *Rendering Antialiased Shadows with Depth Maps*, SIGGRAPH
//! 1987): means of thresholds are no thresholds. They lie nearer to the middle, so that filtering first makes light
//! tones lighter and dark ones darker, which `tests/lookup.rs` measures. Compared first, a texel's ink is 0 or 1, and a
//! mean of such has the tone that was asked for exactly.

use crate::{Tam, Thresholds, hatch_threshold};
use glam::{DVec2, DVec3, UVec2};

/// How many times longer than wide a footprint may be before coarser levels are taken.
pub const HATCH_MAX_ANISOTROPY: f64 = 16.0;

/// Where along [`HatchFootprint::spread`] the samples of a long footprint lie.
pub const HATCH_SPREAD: [f64; 4] = [-0.375, -0.125, 0.125, 0.375];

/// What a pixel covers of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HatchFootprint {
    /// 0 is the finest, and from there on any number up to the coarsest.
    pub level: f64,
    /// Texture coordinates: along this, about the pixel's place, samples are spread; zero where one is enough.
    pub spread: DVec2,
}

/// The footprint of a pixel: of how texture coordinates change along x and along y, per px; `texels` a unit of them at
/// level 0 (the map's side; n times that if texels are to be as large as n pixels); and the coarsest level.
///
/// ```
/// use glam::DVec2;
/// use npr_hatch::lookup::hatch_footprint;
/// // A map of 256 texels that 64 pixels show.
/// let footprint = hatch_footprint(DVec2::X / 64.0, DVec2::Y / 64.0, 256.0, 8.0);
/// assert_eq!((footprint.level, footprint.spread), (2.0, DVec2::ZERO));
/// ```
pub fn hatch_footprint(uv_dx: DVec2, uv_dy: DVec2, texels: f64, last_level: f64) -> HatchFootprint {
    let (along_x, along_y) = (uv_dx * texels, uv_dy * texels);
    // Half the trace, half the difference and the other element of J Jᵀ, whose eigenvalues are the axes' squares.
    let mean = 0.5 * (along_x.length_squared() + along_y.length_squared());
    let half = 0.5 * (along_x.x * along_x.x + along_y.x * along_y.x - along_x.y * along_x.y - along_y.y * along_y.y);
    let other = along_x.x * along_x.y + along_y.x * along_y.y;
    let apart = half.hypot(other);
    // Finite, so that whatever the derivatives are, level and spread are numbers.
    let longer_squared = (mean + apart).min(f64::MAX);
    let area = (along_x.x * along_y.y - along_x.y * along_y.x).abs();
    let ratio = (longer_squared / area.max(1e-30)).clamp(1.0, HATCH_MAX_ANISOTROPY);
    let level = (0.5 * (longer_squared / ratio).max(1e-30).log2()).clamp(0.0, last_level);
    // In texels of that level the longer axis is the ratio's root, or less where there is no finer one; up to the root
    // of 2 one sample is as good.
    let longer = ratio.sqrt().min(longer_squared.sqrt() / level.exp2());
    let length = (longer - std::f64::consts::SQRT_2).max(0.0) * level.exp2() / texels;
    let axis = if half >= 0.0 { DVec2::new(half + apart, other) } else { DVec2::new(other, apart - half) };
    HatchFootprint { level, spread: if length > 0.0 { axis.normalize_or_zero() * length } else { DVec2::ZERO } }
}

/// How much of a hatching is drawn as its flat tone, 0..=1, at a level: all of it where the map's side has 8 texels and
/// fewer, nothing where it has 16 and more.
///
/// A stroke is a few texels wide and many long, so in so small a map there is nothing to draw, and what is left of a tone
/// is noise: 4 × 4 thresholds know 16 tones. `last_level`: that of a single texel.
///
/// ```
/// use npr_hatch::lookup::hatch_flat;
/// assert_eq!([3.0, 4.0, 4.25, 5.0, 8.0].map(|level| hatch_flat(level, 8.0)), [0.0, 0.0, 0.25, 1.0, 1.0]);
/// ```
pub fn hatch_flat(level: f64, last_level: f64) -> f64 {
    (level - (last_level - 4.0)).clamp(0.0, 1.0)
}

/// How many samples a footprint asks for: one, or [`HATCH_SPREAD`].
pub fn hatch_samples(footprint: HatchFootprint) -> i32 {
    if footprint.spread == DVec2::ZERO { 1 } else { HATCH_SPREAD.len() as i32 }
}

/// Four texels around a place, and how much the second of each axis counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HatchTaps {
    /// Column and row of the first.
    pub low: UVec2,
    /// Of the last.
    pub high: UVec2,
    /// 0..1: the share of `high`.
    pub share: DVec2,
}

/// The texels around a place of a level of so many texels, which is repeated in both directions.
pub fn hatch_taps(uv: DVec2, side: u32) -> HatchTaps {
    let place = uv * f64::from(side) - 0.5;
    let corner = place.floor();
    // `side` is a power of two: negative columns wrap as they must.
    let wrapped = |number: f64| (number as i64 & i64::from(side - 1)) as u32;
    let low = UVec2::new(wrapped(corner.x), wrapped(corner.y));
    HatchTaps { low, high: (low + 1) & (side - 1), share: place - corner }
}

/// One level's filtered value: of what `texel` has at columns and rows.
fn bilinear(uv: DVec2, side: u32, texel: impl Fn(u32, u32) -> DVec3) -> DVec3 {
    let HatchTaps { low, high, share } = hatch_taps(uv, side);
    let row = |y| texel(low.x, y).lerp(texel(high.x, y), share.x);
    row(low.y).lerp(row(high.y), share.y)
}

/// Over levels, and over the samples of a long footprint.
fn filtered(uv: DVec2, footprint: HatchFootprint, level: impl Fn(usize, DVec2) -> DVec3) -> DVec3 {
    let (finer, share) = (footprint.level.floor(), footprint.level.fract());
    let at = |uv: DVec2| {
        let fine = level(finer as usize, uv);
        if share > 0.0 { fine.lerp(level(finer as usize + 1, uv), share) } else { fine }
    };
    if hatch_samples(footprint) == 1 {
        return at(uv);
    }
    HATCH_SPREAD.iter().map(|&along| at(uv + footprint.spread * along)).sum::<DVec3>() / HATCH_SPREAD.len() as f64
}

/// What a map of six tones has at a place: the three lighter tones and the three darker ones, 0 ink and 1 paper, for
/// [`crate::hatch_blend`].
///
/// # Panics
/// If it has another number of tones.
pub fn hatch_texels(tam: &Tam, uv: DVec2, footprint: HatchFootprint) -> (DVec3, DVec3) {
    assert_eq!(tam.tones.len(), crate::HATCH_TONES, "listing 5 reads six tones");
    let three = |first: usize| {
        filtered(uv, footprint, |level, uv| {
            let side = tam.level_side(level);
            bilinear(uv, side, |x, y| {
                let value = |tone| f64::from(tam.image(tone, level)[(y * side + x) as usize]);
                DVec3::new(value(first), value(first + 1), value(first + 2)) / 255.0
            })
        })
    };
    (three(0), three(3))
}

/// How much ink a place has where a tone is wanted, 0..=1: thresholds, compared and then filtered. `width` is the span of
/// tones over which a texel turns to ink.
pub fn hatch_ink(map: &Thresholds, uv: DVec2, footprint: HatchFootprint, tone: f64, width: f64) -> f64 {
    let at = hatch_softened(tone, width);
    let ink = filtered(uv, footprint, |level, uv| {
        let side = map.side >> level;
        bilinear(uv, side, |x, y| {
            let texel = f64::from(map.levels[level][(y * side + x) as usize]) / 65535.0;
            DVec3::splat(hatch_threshold(texel, at, width))
        })
    });
    ink.x
}

/// What thresholds are compared with for a tone, if texels turn to ink over a width, 0..=1: the tone itself, but near
/// white and black, where a part of the width lies beyond all thresholds, what keeps the mean.
///
/// Thresholds lie evenly between 0 and 1. Compared with τ < width / 2 they leave (τ + width / 2)² / (2 width) of paper on
/// the mean, so that is solved for τ; and the same at white. Black and white themselves are beyond the ends, so that no
/// rounding leaves a speck.
///
/// ```
/// use npr_hatch::lookup::hatch_softened;
/// assert_eq!([0.0, 0.3, 1.0].map(|tone| hatch_softened(tone, 0.25)), [-0.25, 0.3, 1.25]);
/// ```
pub fn hatch_softened(tone: f64, width: f64) -> f64 {
    let end = 0.5 * width;
    if tone <= 0.0 {
        -width
    } else if tone >= 1.0 {
        1.0 + width
    } else if tone < end {
        (2.0 * width * tone).sqrt() - end
    } else if tone > 1.0 - end {
        1.0 + end - (2.0 * width * (1.0 - tone)).sqrt()
    } else {
        tone
    }
}

//! Lookups in a map: the mip level for a pixel, and filtering.
//!
//! # Level
//!
//! Strokes have the same width in texels at every level, so their width on the screen is independent of distance if texels
//! are as large as pixels: the level is log2 of the number of texels per pixel, and fractional levels are blended. All
//! strokes of a level are contained in the next finer level, so approaching a surface only adds strokes.
//!
//! At oblique angles the footprint of a pixel is elongated. Choosing the level by its longer axis, as texture filtering
//! does, would hatch receding surfaces with few and wide strokes; by its shorter axis, strokes would alias.
//! [`hatch_footprint`] uses the geometric mean of both axes, the side of a square with the area of the footprint, so that
//! the amount of *ink* and the number of strokes per screen area are those of a surface that faces the viewer. Four samples
//! are spread along the longer axis where one would alias. Beyond [`HATCH_MAX_ANISOTROPY`] coarser levels are used.
//!
//! Every level has the requested mean tone, so none of this changes the tone. Where a map covers only a few pixels there
//! is no room for strokes, and a flat tone replaces them ([`hatch_flat_weight`]).
//!
//! # Thresholds are compared before they are filtered
//!
//! As in percentage-closer filtering of shadow maps (W. T. Reeves, D. H. Salesin, R. L. Cook: *Rendering Antialiased
//! Shadows with Depth Maps*, SIGGRAPH 1987). Averages of thresholds are closer to the middle, so filtering first makes
//! light tones lighter and dark tones darker, as `tests/lookup.rs` measures. If texels are compared first, their ink is 0
//! or 1 and its average has exactly the requested tone.

use glam::{DVec2, DVec3};

pub use crate::footprint::{
    HATCH_MAX_ANISOTROPY, HATCH_SPREAD, HatchFootprint, HatchTaps, hatch_flat_weight, hatch_footprint, hatch_samples,
    hatch_taps,
};
pub use crate::threshold::hatch_soft_tone;
use crate::{Tam, Thresholds, hatch_threshold};

/// Bilinear interpolation in one level. `texel` returns the value at a column and a row.
fn bilinear(uv: DVec2, side: u32, texel: impl Fn(u32, u32) -> DVec3) -> DVec3 {
    let HatchTaps { low, high, share } = hatch_taps(uv, side);
    let row = |y| texel(low.x, y).lerp(texel(high.x, y), share.x);
    row(low.y).lerp(row(high.y), share.y)
}

/// The mean over the samples of a footprint, each blended between two levels. `level` returns the value of a level at a
/// texture coordinate.
fn filtered(uv: DVec2, footprint: HatchFootprint, level: impl Fn(usize, DVec2) -> DVec3) -> DVec3 {
    let (finer, share) = (footprint.level.floor(), footprint.level.fract());
    let sample = |uv: DVec2| {
        let fine = level(finer as usize, uv);
        if share > 0.0 { fine.lerp(level(finer as usize + 1, uv), share) } else { fine }
    };
    if hatch_samples(footprint) == 1 {
        return sample(uv);
    }
    HATCH_SPREAD.iter().map(|&along| sample(uv + footprint.spread * along)).sum::<DVec3>() / HATCH_SPREAD.len() as f64
}

/// The three lighter and the three darker tones of a map of six tones at `uv`, 0 ink and 1 paper, for
/// [`crate::hatch_blend`].
///
/// # Panics
/// If the map does not have six tones.
pub fn hatch_texels(tam: &Tam, uv: DVec2, footprint: HatchFootprint) -> (DVec3, DVec3) {
    assert_eq!(tam.tones.len(), crate::HATCH_TONES, "the map must have six tones");
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

/// The ink at `uv` for a tone, 0..=1: the thresholds are compared and then filtered. `width` is the range of tones over
/// which a texel turns to ink.
pub fn hatch_ink(map: &Thresholds, uv: DVec2, footprint: HatchFootprint, tone: f64, width: f64) -> f64 {
    let softened = hatch_soft_tone(tone, width);
    let ink = filtered(uv, footprint, |level, uv| {
        let side = map.side >> level;
        bilinear(uv, side, |x, y| {
            let texel = f64::from(map.levels[level][(y * side + x) as usize]) / 65535.0;
            DVec3::splat(hatch_threshold(texel, softened, width))
        })
    });
    ink.x
}

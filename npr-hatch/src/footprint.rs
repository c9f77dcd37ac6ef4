//! The footprint of a pixel in a map: level, spread and texels. The reference for `footprint.wgsl`.

use glam::{DVec2, UVec2};

/// The maximum ratio of the axes of a footprint. For longer footprints coarser levels are used.
pub const HATCH_MAX_ANISOTROPY: f64 = 16.0;

/// The positions of the samples of a long footprint along [`HatchFootprint::spread`].
pub const HATCH_SPREAD: [f64; 4] = [-0.375, -0.125, 0.125, 0.375];

/// The region of a map that a pixel covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HatchFootprint {
    /// The mip level, fractional: 0 is the finest, the maximum the coarsest.
    pub level: f64,
    /// The vector in texture coordinates along which samples are spread around the pixel's centre; zero if one sample
    /// suffices.
    pub spread: DVec2,
}

/// The footprint of a pixel.
///
/// - `uv_dx`, `uv_dy`: the derivatives of the texture coordinates along x and y, per pixel.
/// - `texels`: texels per unit of the texture coordinates at level 0. This is the side of the map, or n times the side for
///   texels of n pixels.
/// - `last_level`: the coarsest level.
///
/// ```
/// use glam::DVec2;
/// use npr_hatch::lookup::hatch_footprint;
/// // A map of 256 texels across 64 pixels.
/// let footprint = hatch_footprint(DVec2::X / 64.0, DVec2::Y / 64.0, 256.0, 8.0);
/// assert_eq!((footprint.level, footprint.spread), (2.0, DVec2::ZERO));
/// ```
pub fn hatch_footprint(uv_dx: DVec2, uv_dy: DVec2, texels: f64, last_level: f64) -> HatchFootprint {
    let (along_x, along_y) = (uv_dx * texels, uv_dy * texels);
    // Half the trace, half the difference of the diagonal and the off-diagonal element of J Jᵀ, whose eigenvalues are the
    // squared axes of the footprint.
    let mean = 0.5 * (along_x.length_squared() + along_y.length_squared());
    let half = 0.5 * (along_x.x * along_x.x + along_y.x * along_y.x - along_x.y * along_x.y - along_y.y * along_y.y);
    let other = along_x.x * along_x.y + along_y.x * along_y.y;
    let root = half.hypot(other);
    // Limited to finite values, so that level and spread are never NaN.
    let longer_squared = (mean + root).min(f64::MAX);
    let area = (along_x.x * along_y.y - along_x.y * along_y.x).abs();
    let ratio = (longer_squared / area.max(1e-30)).clamp(1.0, HATCH_MAX_ANISOTROPY);
    let level = (0.5 * (longer_squared / ratio).max(1e-30).log2()).clamp(0.0, last_level);
    // The longer axis in texels of that level is the square root of the ratio, or less at the finest level. Up to √2 texels
    // one sample suffices.
    let longer = ratio.sqrt().min(longer_squared.sqrt() / level.exp2());
    let length = (longer - std::f64::consts::SQRT_2).max(0.0) * level.exp2() / texels;
    let axis = if half >= 0.0 { DVec2::new(half + root, other) } else { DVec2::new(other, root - half) };
    HatchFootprint { level, spread: if length > 0.0 { axis.normalize_or_zero() * length } else { DVec2::ZERO } }
}

/// The weight, 0..=1, of a flat tone that replaces the hatching at a level: 1 where the side of the level has 8 texels or
/// fewer, 0 where it has 16 or more.
///
/// Strokes are a few texels wide and many texels long, so that levels with few texels have no room for strokes and too few
/// tones: a level of 4 × 4 thresholds has 16 tones. `last_level` is the level of a single texel.
///
/// ```
/// use npr_hatch::lookup::hatch_flat_weight;
/// assert_eq!([3.0, 4.0, 4.25, 5.0, 8.0].map(|level| hatch_flat_weight(level, 8.0)), [0.0, 0.0, 0.25, 1.0, 1.0]);
/// ```
pub fn hatch_flat_weight(level: f64, last_level: f64) -> f64 {
    (level - (last_level - 4.0)).clamp(0.0, 1.0)
}

/// The number of samples of a footprint: 1, or the length of [`HATCH_SPREAD`].
pub fn hatch_samples(footprint: HatchFootprint) -> i32 {
    if footprint.spread == DVec2::ZERO { 1 } else { HATCH_SPREAD.len() as i32 }
}

/// The four texels of bilinear interpolation and their weights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HatchTaps {
    /// Column and row of the first texel.
    pub low: UVec2,
    /// Column and row of the last texel.
    pub high: UVec2,
    /// The weight of `high` along each axis, 0..1.
    pub share: DVec2,
}

/// The texels for bilinear interpolation at `uv` in a level of `side` × `side` texels that repeats in both directions.
/// `side` is a power of two.
pub fn hatch_taps(uv: DVec2, side: u32) -> HatchTaps {
    let position = uv * f64::from(side) - 0.5;
    let corner = position.floor();
    // The mask of a power of two also wraps negative columns and rows.
    let wrapped = |number: f64| (number as i64 & i64::from(side - 1)) as u32;
    let low = UVec2::new(wrapped(corner.x), wrapped(corner.y));
    HatchTaps { low, high: (low + 1) & (side - 1), share: position - corner }
}

//! The formulas, in f64: the reference that the WGSL is measured against.

use glam::{DVec2, DVec3};

use crate::Bands;

/// Below this change across a pixel a border is hard: 2^-23, the spacing of f32 just above 1.
pub const MIN_WIDTH: f64 = f32::EPSILON as f64;

/// The least length of the sum of two unit vectors that has a direction. In f32 the sum of opposite ones is a few
/// roundings long, not zero, and its direction would be that of the roundings: a highlight where there should be none.
pub const MIN_SUM: f64 = 1e-6;

/// 0..=1; not a number becomes 0.
pub(crate) fn saturate(x: f64) -> f64 {
    if x > 0.0 { x.min(1.0) } else { 0.0 }
}

/// N·L at a pixel, -1..=1: the interpolated normal and light vector are brought to unit length first.
///
/// `to_light` points from the surface to the light. A zero vector gives 0.
pub fn toon_n_dot_l(normal: DVec3, to_light: DVec3) -> f64 {
    normal.normalize_or_zero().dot(to_light.normalize_or_zero())
}

/// N·L of vectors as the rasteriser interpolates them (Card & Mitchell, listing 3): of unit length at the
/// vertices, shorter between, so that bright bands shrink on coarse meshes.
pub fn toon_n_dot_l_interpolated(normal: DVec3, to_light: DVec3) -> f64 {
    normal.dot(to_light)
}

/// The unit vector halfway between the directions to the light and to the eye; 0 where these are opposite, to within
/// [`MIN_SUM`].
pub fn toon_half(to_light: DVec3, to_eye: DVec3) -> DVec3 {
    let sum = to_light.normalize_or_zero() + to_eye.normalize_or_zero();
    if sum.length_squared() > MIN_SUM * MIN_SUM { sum.normalize() } else { DVec3::ZERO }
}

/// N·H at a pixel, -1..=1: all vectors are brought to unit length first. A zero vector gives 0.
pub fn toon_n_dot_h(normal: DVec3, to_light: DVec3, to_eye: DVec3) -> f64 {
    normal.normalize_or_zero().dot(toon_half(to_light, to_eye))
}

/// N·H of vectors as the rasteriser interpolates them: `half` is [`toon_half`] at the vertices (Card & Mitchell,
/// listing 2, with the lost `mul` put back).
pub fn toon_n_dot_h_interpolated(normal: DVec3, half: DVec3) -> f64 {
    normal.dot(half)
}

/// N·H of unit vectors from their dot products, without making H, since |L + E|² is 2 + 2 L·E. 0 where L is opposite E.
pub fn toon_n_dot_h_of(n_dot_l: f64, n_dot_e: f64, l_dot_e: f64) -> f64 {
    let squared = 2.0 + 2.0 * l_dot_e;
    if squared > 0.0 { (n_dot_l + n_dot_e) / squared.sqrt() } else { 0.0 }
}

/// How much a quantity changes across one pixel, from its derivatives along x and y (per pixel).
pub fn toon_width(along_x: f64, along_y: f64) -> f64 {
    DVec2::new(along_x, along_y).length()
}

/// The share of a pixel, 0..=1, where `x` is at least `threshold`, if `x` is its value at the centre and it changes by
/// `width` across the pixel. Up to [`MIN_WIDTH`] this is the comparison `x >= threshold`. Not a number reaches none.
pub fn toon_coverage(x: f64, threshold: f64, width: f64) -> f64 {
    if width > MIN_WIDTH {
        saturate((x - threshold) / width + 0.5)
    } else if x >= threshold {
        1.0
    } else {
        0.0
    }
}

/// The tone of the band that `n_dot_l` falls into.
pub fn toon_band_hard(bands: &Bands, n_dot_l: f64) -> DVec3 {
    let below = bands.thresholds.iter().take_while(|&&t| n_dot_l >= f64::from(t)).count();
    bands.tones.get(below).map_or(DVec3::ZERO, |tone| tone.as_dvec3())
}

/// The mean tone of a pixel across which N·L changes linearly by `width`: each band's tone by the share that it covers
/// (see the crate's page on borders). Width 0 is [`toon_band_hard`].
pub fn toon_band_smooth(bands: &Bands, n_dot_l: f64, width: f64) -> DVec3 {
    let uppers = bands.thresholds.iter().map(|&t| toon_coverage(n_dot_l, f64::from(t), width));
    let mut tone = DVec3::ZERO;
    // The share of the pixel at or above the band's lower border; all of it for the darkest.
    let mut share = 1.0;
    for (band, above) in bands.tones.iter().zip(uppers.chain([0.0])) {
        tone += (share - above) * band.as_dvec3();
        share = above;
    }
    tone
}

/// How opaque the highlight is at a pixel, 0..=1: its strength times the share of the pixel where N·H reaches its
/// threshold and, for `lit_only`, times the share where N·L is at least 0.
pub fn toon_highlight(bands: &Bands, n_dot_l: f64, nl_width: f64, n_dot_h: f64, nh_width: f64) -> f64 {
    let Some(highlight) = bands.highlight else { return 0.0 };
    let lit = if highlight.lit_only { toon_coverage(n_dot_l, 0.0, nl_width) } else { 1.0 };
    f64::from(highlight.strength) * lit * toon_coverage(n_dot_h, f64::from(highlight.threshold), nh_width)
}

/// The colour of a pixel, display-referred: the surface's own times its band's tone, under the highlight.
///
/// `nl_width` and `nh_width` are the changes of N·L and N·H across the pixel ([`toon_width`]); they count for
/// nothing unless [`Bands::antialias`] is set.
pub fn toon_shade(bands: &Bands, base_color: DVec3, n_dot_l: f64, nl_width: f64, n_dot_h: f64, nh_width: f64) -> DVec3 {
    let (nl_width, nh_width) = if bands.antialias { (nl_width, nh_width) } else { (0.0, 0.0) };
    let color = base_color * toon_band_smooth(bands, n_dot_l, nl_width);
    let Some(highlight) = bands.highlight else { return color };
    let opacity = toon_highlight(bands, n_dot_l, nl_width, n_dot_h, nh_width);
    color * (1.0 - opacity) + highlight.color.as_dvec3() * opacity
}

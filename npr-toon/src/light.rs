//! The shading formulas in f64, the reference for `light.wgsl`.

use glam::{DVec2, DVec3};

use crate::Bands;

/// The width up to which a border is treated as hard: 2^-23, the spacing of f32 just above 1.
pub const MIN_WIDTH: f64 = f32::EPSILON as f64;

/// The minimum length of the sum of two unit vectors that is normalised to a half vector. In f32 the sum of opposite unit
/// vectors is not exactly zero; normalising the rounding error would produce a spurious highlight.
pub const MIN_SUM: f64 = 1e-6;

/// Clamps to 0..=1. NaN gives 0.
pub(crate) fn saturate(x: f64) -> f64 {
    if x > 0.0 { x.min(1.0) } else { 0.0 }
}

/// N·L, -1..=1, of vectors that are normalised first.
///
/// `to_light` points from the surface to the light. A zero vector gives 0.
pub fn toon_n_dot_l(normal: DVec3, to_light: DVec3) -> f64 {
    normal.normalize_or_zero().dot(to_light.normalize_or_zero())
}

/// N·L of interpolated vectors without normalisation (Card & Mitchell 2002, listing 3). Between vertices the vectors are
/// shorter than 1, so bright bands shrink on coarse meshes.
pub fn toon_n_dot_l_interpolated(normal: DVec3, to_light: DVec3) -> f64 {
    normal.dot(to_light)
}

/// The half vector: the unit vector halfway between the directions to the light and to the eye. Zero where these are
/// opposite to within [`MIN_SUM`].
pub fn toon_half(to_light: DVec3, to_eye: DVec3) -> DVec3 {
    let sum = to_light.normalize_or_zero() + to_eye.normalize_or_zero();
    if sum.length_squared() > MIN_SUM * MIN_SUM { sum.normalize() } else { DVec3::ZERO }
}

/// N·H, -1..=1, of vectors that are normalised first. A zero vector gives 0.
pub fn toon_n_dot_h(normal: DVec3, to_light: DVec3, to_eye: DVec3) -> f64 {
    normal.normalize_or_zero().dot(toon_half(to_light, to_eye))
}

/// N·H of interpolated vectors without normalisation. `half_vector` is [`toon_half`] at the vertices (Card & Mitchell 2002,
/// listing 2, with its missing `mul` restored).
pub fn toon_n_dot_h_interpolated(normal: DVec3, half_vector: DVec3) -> f64 {
    normal.dot(half_vector)
}

/// N·H of unit vectors from their dot products without computing H, since |L + E|² = 2 + 2 L·E. 0 where L is opposite E.
pub fn toon_n_dot_h_from_dots(n_dot_l: f64, n_dot_e: f64, l_dot_e: f64) -> f64 {
    let squared = 2.0 + 2.0 * l_dot_e;
    if squared > 0.0 { (n_dot_l + n_dot_e) / squared.sqrt() } else { 0.0 }
}

/// The change of a quantity across one pixel: the length of its gradient, from its derivatives along x and y per pixel.
pub fn toon_width(along_x: f64, along_y: f64) -> f64 {
    DVec2::new(along_x, along_y).length()
}

/// The fraction of a pixel, 0..=1, in which a quantity is at least `threshold`. `x` is its value at the pixel's centre,
/// `width` its linear change across the pixel. For widths up to [`MIN_WIDTH`] this is the comparison `x >= threshold`. NaN
/// gives 0.
pub fn toon_coverage(x: f64, threshold: f64, width: f64) -> f64 {
    if width > MIN_WIDTH {
        saturate((x - threshold) / width + 0.5)
    } else if x >= threshold {
        1.0
    } else {
        0.0
    }
}

/// The tone of the band that contains `n_dot_l`, without antialiasing.
pub fn toon_band_hard(bands: &Bands, n_dot_l: f64) -> DVec3 {
    let below = bands.thresholds.iter().take_while(|&&t| n_dot_l >= f64::from(t)).count();
    bands.tones.get(below).map_or(DVec3::ZERO, |tone| tone.as_dvec3())
}

/// The mean tone of a pixel across which N·L changes linearly by `width`: the tones weighted by the fraction of the pixel
/// that each band covers (see the crate's section on borders). Width 0 gives [`toon_band_hard`].
pub fn toon_band(bands: &Bands, n_dot_l: f64, width: f64) -> DVec3 {
    let uppers = bands.thresholds.iter().map(|&t| toon_coverage(n_dot_l, f64::from(t), width));
    let mut tone = DVec3::ZERO;
    // The fraction of the pixel at or above the band's lower threshold; 1 for the darkest band.
    let mut share = 1.0;
    for (band, above) in bands.tones.iter().zip(uppers.chain([0.0])) {
        tone += (share - above) * band.as_dvec3();
        share = above;
    }
    tone
}

/// The opacity of the highlight in a pixel, 0..=1: its strength times the fraction of the pixel where N·H is at least its
/// threshold and, for `lit_only`, times the fraction where N·L is at least 0.
pub fn toon_highlight(bands: &Bands, n_dot_l: f64, nl_width: f64, n_dot_h: f64, nh_width: f64) -> f64 {
    let Some(highlight) = bands.highlight else { return 0.0 };
    let lit = if highlight.lit_only { toon_coverage(n_dot_l, 0.0, nl_width) } else { 1.0 };
    f64::from(highlight.strength) * lit * toon_coverage(n_dot_h, f64::from(highlight.threshold), nh_width)
}

/// The display-referred colour of a pixel: the surface's colour times the tone of its band, or the tone alone
/// ([`Bands::absolute`]), covered by the highlight.
///
/// `nl_width` and `nh_width` are the changes of N·L and N·H across the pixel ([`toon_width`]). They are ignored unless
/// [`Bands::antialias`] is set.
pub fn toon_shade(bands: &Bands, base_color: DVec3, n_dot_l: f64, nl_width: f64, n_dot_h: f64, nh_width: f64) -> DVec3 {
    let (nl_width, nh_width) = if bands.antialias { (nl_width, nh_width) } else { (0.0, 0.0) };
    let factor = if bands.absolute { DVec3::ONE } else { base_color };
    let color = factor * toon_band(bands, n_dot_l, nl_width);
    let Some(highlight) = bands.highlight else { return color };
    let opacity = toon_highlight(bands, n_dot_l, nl_width, n_dot_h, nh_width);
    color * (1.0 - opacity) + highlight.color.as_dvec3() * opacity
}

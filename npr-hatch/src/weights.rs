//! Weights of six tones by light, and their blend (Card & Mitchell 2002, listings 4 and 5).
//!
//! The light factor is brightness · N·L ([`hatch_level`]). The weight of each tone is a triangle function of width 2: the
//! lightest tone has its maximum at 6, the darkest at 1. From 0 to 6 the weights sum to 1; below 1 the darkest has the full
//! weight; above 6 the sum decreases to 0 at 7, and the remainder is paper.
//!
//! # The transfer curve
//!
//! The blend of six images with the mean tones t1 (lightest) to t6 has the mean tone [`hatch_transfer`]: the piecewise
//! linear function through (1, t6), (2, t5) to (6, t1) and (7, 1), constant beyond both ends. With the tones of
//! [`crate::even_tones`], t = 1 - i/7, it is **tone = clamp(factor, 1, 7) / 7**. A brightness of 7 gives a tone equal to
//! N·L with a minimum of 1/7; a brightness of 6, as suggested by the comment "times six" of listing 4, gives a maximum of
//! 6/7. For other tones [`hatch_level_of_tone`] computes the light factor that gives a requested tone.
//!
//! # Per vertex or per pixel
//!
//! Listing 4 computes the weights at vertices, and they are interpolated over the triangle. The weights have kinks at every
//! integer light factor, so that interpolation across several integers loses intermediate tones. Figure 10d of Card &
//! Mitchell computes them per pixel: interpolate N and L, and call the same functions in the fragment shader.

use glam::DVec3;

/// The number of tones in two RGB textures.
pub const HATCH_TONES: usize = 6;

/// The weights of six tones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HatchWeights {
    /// The weights of the three lighter tones in the first texture, the lightest first.
    pub light: DVec3,
    /// The weights of the three darker tones in the second texture, the darkest last.
    pub dark: DVec3,
}

/// The light factor of listing 4: its constant c8 times N·L. The clamp at zero that its comment mentions is in no
/// instruction and is not needed, since the weights are constant below 1.
pub fn hatch_level(brightness: f64, n_dot_l: f64) -> f64 {
    brightness * n_dot_l
}

/// The weights of the six tones at a light factor: the closed form of listing 4.
///
/// ```
/// use glam::DVec3;
/// use npr_hatch::hatch_weights;
/// let weights = hatch_weights(5.25);
/// assert_eq!((weights.light, weights.dark), (DVec3::new(0.25, 0.75, 0.0), DVec3::ZERO));
/// ```
pub fn hatch_weights(level: f64) -> HatchWeights {
    let triangle = |peak: DVec3| (DVec3::ONE - (DVec3::splat(level) - peak).abs()).max(DVec3::ZERO);
    let light = triangle(DVec3::new(6.0, 5.0, 4.0));
    let mut dark = triangle(DVec3::new(3.0, 2.0, 1.0));
    if level <= 1.0 {
        dark.z = 1.0;
    }
    HatchWeights { light, dark }
}

/// The blend of two packed texels by listing 5, 0 ink and 1 paper. `light` holds the three lighter tones, `dark` the three
/// darker tones ([`crate::Tam::pack_tones`]).
pub fn hatch_blend(light: DVec3, dark: DVec3, weights: HatchWeights) -> f64 {
    let ink = |texel: DVec3, weights: DVec3| (DVec3::ONE - texel).dot(weights).clamp(0.0, 1.0);
    1.0 - (ink(light, weights.light) + ink(dark, weights.dark)).clamp(0.0, 1.0)
}

/// The transfer curve: the mean tone at a light factor for images with these mean tones.
pub fn hatch_transfer(light: DVec3, dark: DVec3, level: f64) -> f64 {
    hatch_blend(light, dark, hatch_weights(level))
}

/// The inverse of [`hatch_transfer`]: the light factor, 1..=7, that gives a mean tone. The tones must descend from `light.x`
/// to `dark.z`. Tones below the darkest give 1.
///
/// ```
/// use glam::DVec3;
/// use npr_hatch::{hatch_level_of_tone, hatch_transfer};
/// let (light, dark) = (DVec3::new(0.9, 0.8, 0.5), DVec3::new(0.4, 0.25, 0.1));
/// let level = hatch_level_of_tone(light, dark, 0.3);
/// assert!((hatch_transfer(light, dark, level) - 0.3).abs() < 1e-12);
/// ```
pub fn hatch_level_of_tone(light: DVec3, dark: DVec3, tone: f64) -> f64 {
    let knots = [dark.z, dark.y, dark.x, light.z, light.y, light.x, 1.0];
    // The segments of the piecewise linear function contribute 0..=1 each.
    knots.windows(2).fold(1.0, |level, part| level + ((tone - part[0]) / (part[1] - part[0])).clamp(0.0, 1.0))
}

/// The tone in shadow: `lit` is 1 in full light and 0 in full shadow, where the tone is limited to `darkest` for any N·L
/// (Card & Mitchell 2002, figure 10c).
pub fn hatch_tone_in_shadow(tone: f64, darkest: f64, lit: f64) -> f64 {
    tone * lit + tone.min(darkest) * (1.0 - lit)
}

/// The colour of a tone: `paper` at 1, `ink` at 0, linear in between. Colours are display-referred. On a textured surface
/// `paper` is the surface's colour (Card & Mitchell 2002, figure 10d).
pub fn hatch_color(tone: f64, paper: DVec3, ink: DVec3) -> DVec3 {
    ink + (paper - ink) * tone
}

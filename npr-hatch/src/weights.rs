//! Weights of six tones by light, and their blend: listings 4 and 5.
//!
//! The light factor is brightness · N·L ([`hatch_level`]). Each tone has a triangle of width 2 around its place: the
//! lightest has all the weight at 6, the darkest at 1. From 0 to 6 the weights sum to 1; below 1 the darkest has all of
//! it; above 6 the sum falls, to 0 at 7, and what is missing is paper.
//!
//! # The transfer curve
//!
//! Blended, six images of mean tones t1 (lightest) to t6 have the mean tone that [`hatch_transfer`] gives: a broken line
//! through (1, t6), (2, t5) to (6, t1) and (7, 1), level beyond both ends. With the even tones of
//! [`crate::even_tones`], t = 1 - i/7, all its parts are one: **tone = clamp(factor, 1, 7) / 7**. A brightness of 7 gives
//! a tone equal to N·L, down to 1/7, the darkest there is; a brightness of 6, which listing 4's comment "times six"
//! suggests, leaves no place fully white (6/7 where the light is frontal). For other tones [`hatch_linear`] finds the
//! light factor that gives the tone one wants.
//!
//! # Per vertex or per pixel
//!
//! Listing 4 finds the weights at vertices, and they are interpolated over the triangle. The weights are bent at every
//! whole light factor: where a triangle spans more than one, weights of tones in between are lost. The texts' figure
//! 10d finds them per pixel: interpolate N and L, and call the same functions there.

use glam::DVec3;

/// How many tones two RGB textures hold.
pub const HATCH_TONES: usize = 6;

/// The weights of six tones, as listing 4 hands them on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HatchWeights {
    /// Of the three lighter tones, the lightest first: for the first texture.
    pub light: DVec3,
    /// Of the three darker ones, the darkest last: for the second texture.
    pub dark: DVec3,
}

/// The light factor of listing 4: its c8 times N·L. (The comment beside it says "times six clamp at zero": the six is
/// c8's, and the clamp is in no instruction. Below 1 all factors have the same weights, so none is needed.)
pub fn hatch_level(brightness: f64, n_dot_l: f64) -> f64 {
    brightness * n_dot_l
}

/// The weights of the six tones at a light factor, as listing 4 computes them, in closed form.
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

/// Listing 5: what two packed texels become, 0 ink and 1 paper. `light` has the three lighter tones, `dark` the three
/// darker ones ([`crate::Tam::pack_tones`]).
pub fn hatch_blend(light: DVec3, dark: DVec3, weights: HatchWeights) -> f64 {
    let ink = |texel: DVec3, weights: DVec3| (DVec3::ONE - texel).dot(weights).clamp(0.0, 1.0);
    1.0 - (ink(light, weights.light) + ink(dark, weights.dark)).clamp(0.0, 1.0)
}

/// The mean tone that a light factor gives, of images with these mean tones: the transfer curve.
pub fn hatch_transfer(light: DVec3, dark: DVec3, level: f64) -> f64 {
    hatch_blend(light, dark, hatch_weights(level))
}

/// The light factor, 1..=7, that gives a mean tone: [`hatch_transfer`] inverted. Tones must fall from `light.x` to
/// `dark.z`; one that is darker than the darkest gives that.
///
/// ```
/// use glam::DVec3;
/// use npr_hatch::{hatch_linear, hatch_transfer};
/// let (light, dark) = (DVec3::new(0.9, 0.8, 0.5), DVec3::new(0.4, 0.25, 0.1));
/// let level = hatch_linear(light, dark, 0.3);
/// assert!((hatch_transfer(light, dark, level) - 0.3).abs() < 1e-12);
/// ```
pub fn hatch_linear(light: DVec3, dark: DVec3, tone: f64) -> f64 {
    let knots = [dark.z, dark.y, dark.x, light.z, light.y, light.x, 1.0];
    // The broken line's parts, each from 0 at its beginning to 1 at its end.
    knots.windows(2).fold(1.0, |level, part| level + ((tone - part[0]) / (part[1] - part[0])).clamp(0.0, 1.0))
}

/// The tone that is asked for in a shadow: `lit` is 1 where the light arrives, and 0 in full shadow, which has the darkest
/// tone (figure 10c), whatever its N·L. What is darker already stays so.
pub fn hatch_shadowed(tone: f64, darkest: f64, lit: f64) -> f64 {
    tone * lit + tone.min(darkest) * (1.0 - lit)
}

/// A blended tone as a colour: paper where it is 1, ink where it is 0. Over a textured surface (figure 10d) `paper`
/// is the surface's colour, and with black ink the tone multiplies it. Colours are display-referred.
pub fn hatch_color(tone: f64, paper: DVec3, ink: DVec3) -> DVec3 {
    ink + (paper - ink) * tone
}

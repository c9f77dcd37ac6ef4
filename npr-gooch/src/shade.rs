//! The formulas, in f64: the reference that the WGSL is measured against.

use glam::DVec3;

use crate::Gooch;

/// N·L, -1..=1: both vectors are brought to unit length first. A zero vector gives 0.
///
/// `to_light` points from the surface to the light. (Listing 7 multiplies interpolated vectors as they are, which are
/// shorter between the vertices: both ends of the ramp are then missed.)
pub fn gooch_n_dot_l(normal: DVec3, to_light: DVec3) -> f64 {
    normal.normalize_or_zero().dot(to_light.normalize_or_zero())
}

/// How warm, 0..=1: (1 + N·L) / 2, clamped. Not a number is cool.
pub fn gooch_weight(n_dot_l: f64) -> f64 {
    saturate((1.0 + n_dot_l) / 2.0)
}

/// The colour of what faces away from the light, k_blue and its share of `k_d`, clamped to 0..=1.
pub fn gooch_cool(model: &Gooch, k_d: DVec3) -> DVec3 {
    (model.blue.as_dvec3() + f64::from(model.shares()[0]) * k_d).clamp(DVec3::ZERO, DVec3::ONE)
}

/// The colour of what faces the light, k_yellow and its share of `k_d`, clamped to 0..=1.
pub fn gooch_warm(model: &Gooch, k_d: DVec3) -> DVec3 {
    (model.yellow.as_dvec3() + f64::from(model.shares()[1]) * k_d).clamp(DVec3::ZERO, DVec3::ONE)
}

/// The colour without a highlight: w k_warm + (1 − w) k_cool with w = (1 + N·L) / 2. `k_d` is the object's own colour
/// at the point, display-referred, from its material or its texture.
pub fn gooch_tone(model: &Gooch, k_d: DVec3, n_dot_l: f64) -> DVec3 {
    let weight = gooch_weight(n_dot_l);
    gooch_warm(model, k_d) * weight + gooch_cool(model, k_d) * (1.0 - weight)
}

/// R·E: the cosine between the light's mirrored direction R = 2 (N·L) N − L and the direction to the eye, of vectors
/// of any length. Of use where N·L is above 0 only.
pub fn gooch_r_dot_e(normal: DVec3, to_light: DVec3, to_eye: DVec3) -> f64 {
    gooch_r_dot_e_of(normal.normalize_or_zero(), to_light.normalize_or_zero(), to_eye.normalize_or_zero())
}

/// The same of unit vectors.
pub fn gooch_r_dot_e_of(n: DVec3, l: DVec3, e: DVec3) -> f64 {
    2.0 * n.dot(l) * n.dot(e) - l.dot(e)
}

/// How opaque the highlight is, 0..=1: its strength times Phong's (R·E)^exponent, 0 where N·L or R·E is not above 0.
pub fn gooch_highlight(model: &Gooch, n_dot_l: f64, r_dot_e: f64) -> f64 {
    let Some(highlight) = model.highlight else { return 0.0 };
    if n_dot_l > 0.0 && r_dot_e > 0.0 {
        f64::from(highlight.strength) * r_dot_e.min(1.0).powf(f64::from(highlight.exponent))
    } else {
        0.0
    }
}

/// The highlight's colour over a tone: tone + opacity · (highlight − tone).
pub fn gooch_over(model: &Gooch, tone: DVec3, opacity: f64) -> DVec3 {
    model.highlight.map_or(tone, |highlight| tone * (1.0 - opacity) + highlight.color.as_dvec3() * opacity)
}

/// The colour of a point, display-referred: [`gooch_tone`] under the highlight. Vectors may have any length and be in
/// any one space; they point away from the surface.
pub fn gooch_shade(model: &Gooch, k_d: DVec3, normal: DVec3, to_light: DVec3, to_eye: DVec3) -> DVec3 {
    let n_dot_l = gooch_n_dot_l(normal, to_light);
    let opacity = gooch_highlight(model, n_dot_l, gooch_r_dot_e(normal, to_light, to_eye));
    gooch_over(model, gooch_tone(model, k_d, n_dot_l), opacity)
}

/// One direction for several lights: the unit vector along the sum of `to_lights`, which point from the surface to the
/// lights and are as long as the lights are bright. Zero where they cancel out or there is none.
///
/// Take it at one point of an object, its centre, say. The brightness of all is not kept: the ramp needs all of −1..=1.
///
/// ```
/// use glam::DVec3;
/// let both = npr_gooch::gooch_aggregate(&[DVec3::X * 3.0, DVec3::Y * 4.0]);
/// assert!(both.abs_diff_eq(DVec3::new(0.6, 0.8, 0.0), 1e-15));
/// ```
pub fn gooch_aggregate(to_lights: &[DVec3]) -> DVec3 {
    to_lights.iter().sum::<DVec3>().normalize_or_zero()
}

/// 0..=1; not a number becomes 0.
fn saturate(x: f64) -> f64 {
    if x > 0.0 { x.min(1.0) } else { 0.0 }
}

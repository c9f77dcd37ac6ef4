//! The shading formulas in f64, the reference for `shade.wgsl`.

use glam::DVec3;

use crate::Gooch;

/// N·L, -1..=1, of vectors that are normalised first. A zero vector gives 0.
///
/// `to_light` points from the surface to the light. Card & Mitchell's listing 7 does not normalise interpolated vectors,
/// which are shorter than 1 between vertices, so that the ends of the tone range are not reached.
pub fn gooch_n_dot_l(normal: DVec3, to_light: DVec3) -> f64 {
    normal.normalize_or_zero().dot(to_light.normalize_or_zero())
}

/// The weight of the warm tone: (1 + N·L) / 2, clamped to 0..=1. NaN gives 0.
pub fn gooch_weight(n_dot_l: f64) -> f64 {
    saturate((1.0 + n_dot_l) / 2.0)
}

/// The cool colour, at N·L = -1: k_blue plus its share of `k_d`, clamped to 0..=1.
pub fn gooch_cool(model: &Gooch, k_d: DVec3) -> DVec3 {
    (model.blue.as_dvec3() + f64::from(model.shares()[0]) * k_d).clamp(DVec3::ZERO, DVec3::ONE)
}

/// The warm colour, at N·L = 1: k_yellow plus its share of `k_d`, clamped to 0..=1.
pub fn gooch_warm(model: &Gooch, k_d: DVec3) -> DVec3 {
    (model.yellow.as_dvec3() + f64::from(model.shares()[1]) * k_d).clamp(DVec3::ZERO, DVec3::ONE)
}

/// The colour without highlight: w k_warm + (1 − w) k_cool with w = (1 + N·L) / 2. `k_d` is the object's colour at the
/// point: display-referred RGB from its material or its texture.
pub fn gooch_tone(model: &Gooch, k_d: DVec3, n_dot_l: f64) -> DVec3 {
    let weight = gooch_weight(n_dot_l);
    gooch_warm(model, k_d) * weight + gooch_cool(model, k_d) * (1.0 - weight)
}

/// R·E: the cosine between the reflected light direction R = 2 (N·L) N − L and the direction to the eye. The vectors are
/// normalised first. It is meaningful only where N·L is above 0.
pub fn gooch_r_dot_e(normal: DVec3, to_light: DVec3, to_eye: DVec3) -> f64 {
    gooch_r_dot_e_unit(normal.normalize_or_zero(), to_light.normalize_or_zero(), to_eye.normalize_or_zero())
}

/// [`gooch_r_dot_e`] of the unit vectors N, L and E.
pub fn gooch_r_dot_e_unit(n: DVec3, l: DVec3, e: DVec3) -> f64 {
    2.0 * n.dot(l) * n.dot(e) - l.dot(e)
}

/// The opacity of the highlight, 0..=1: its strength times Phong's (R·E)^exponent; 0 where N·L or R·E is not above 0.
pub fn gooch_highlight(model: &Gooch, n_dot_l: f64, r_dot_e: f64) -> f64 {
    let Some(highlight) = model.highlight else { return 0.0 };
    if n_dot_l > 0.0 && r_dot_e > 0.0 {
        f64::from(highlight.strength) * r_dot_e.min(1.0).powf(f64::from(highlight.exponent))
    } else {
        0.0
    }
}

/// The highlight blended over a tone: tone + opacity · (highlight − tone).
pub fn gooch_over(model: &Gooch, tone: DVec3, opacity: f64) -> DVec3 {
    model.highlight.map_or(tone, |highlight| tone * (1.0 - opacity) + highlight.color.as_dvec3() * opacity)
}

/// The display-referred colour of a point: [`gooch_tone`] covered by the highlight. The vectors point away from the surface,
/// may have any length and must be in the same space.
pub fn gooch_shade(model: &Gooch, k_d: DVec3, normal: DVec3, to_light: DVec3, to_eye: DVec3) -> DVec3 {
    let n_dot_l = gooch_n_dot_l(normal, to_light);
    let opacity = gooch_highlight(model, n_dot_l, gooch_r_dot_e(normal, to_light, to_eye));
    gooch_over(model, gooch_tone(model, k_d, n_dot_l), opacity)
}

/// The aggregate direction of several lights: the unit vector along the sum of `to_lights`, which point from the surface to
/// the lights and have the brightness of the light as their length. Zero if they cancel or there are none.
///
/// It is intended to be evaluated at one point per object, such as its centre. The total brightness is not returned, since
/// the tone range needs the full range −1..=1 of N·L.
///
/// ```
/// use glam::DVec3;
/// let both = npr_gooch::gooch_aggregate(&[DVec3::X * 3.0, DVec3::Y * 4.0]);
/// assert!(both.abs_diff_eq(DVec3::new(0.6, 0.8, 0.0), 1e-15));
/// ```
pub fn gooch_aggregate(to_lights: &[DVec3]) -> DVec3 {
    to_lights.iter().sum::<DVec3>().normalize_or_zero()
}

/// Clamps to 0..=1. NaN gives 0.
fn saturate(x: f64) -> f64 {
    if x > 0.0 { x.min(1.0) } else { 0.0 }
}

//! The equation and the listing by hand, properties of any model, and validation.

use approx::assert_abs_diff_eq;
use glam::{DVec3, Vec3};
use npr_gooch::*;
use proptest::prelude::*;

/// Within the rounding of the parameters, which are f32.
fn assert_near(color: DVec3, expected: [f64; 3]) {
    assert!(color.abs_diff_eq(DVec3::from_array(expected), 1e-7), "{color}, not {expected:?}");
}

#[test]
fn the_equation_by_hand() {
    // k_cool = (0, 0, 0.55) + 0.25 k_d, k_warm = (0.3, 0.3, 0) + 0.5 k_d.
    let (model, k_d) = (Gooch::default(), DVec3::new(0.8, 0.4, 0.2));
    assert_near(gooch_cool(&model, k_d), [0.2, 0.1, 0.6]);
    assert_near(gooch_warm(&model, k_d), [0.7, 0.5, 0.1]);
    assert_near(gooch_tone(&model, k_d, 1.0), [0.7, 0.5, 0.1]);
    assert_near(gooch_tone(&model, k_d, 0.0), [0.45, 0.3, 0.35]);
    assert_near(gooch_tone(&model, k_d, -0.5), [0.325, 0.2, 0.475]);
    assert_near(gooch_tone(&model, k_d, -1.0), [0.2, 0.1, 0.6]);
}

#[test]
fn listing_7_by_hand() {
    // The lit side is c2 + c0 c4 = (0.5, 0.5, 0) + 0.4 (0, 0, 0.4), the other c3 + c1 c4 = (0, 0, 0.4) + 0.5 (0, 0,
    // 0.4).
    let (printed, k_d) = (Gooch::swapped_shares(), EXAMPLE_K_D.as_dvec3());
    assert_near(gooch_tone(&printed, k_d, 1.0), [0.5, 0.5, 0.16]);
    assert_near(gooch_tone(&printed, k_d, -1.0), [0.0, 0.0, 0.6]);
    assert_near(gooch_tone(&printed, k_d, 0.5), [0.375, 0.375, 0.27]);
    // The equation assigns the shares the other way round.
    let equation = Gooch { tones: Tones::Equation, ..printed };
    assert_near(gooch_tone(&equation, k_d, 1.0), [0.5, 0.5, 0.2]);
    assert_near(gooch_tone(&equation, k_d, -1.0), [0.0, 0.0, 0.56]);
    // With equal shares it makes no difference.
    let (printed, equation) = (Gooch { beta: 0.4, ..printed }, Gooch { beta: 0.4, ..equation });
    assert_eq!(gooch_tone(&printed, k_d, 0.3), gooch_tone(&equation, k_d, 0.3));
}

#[test]
fn the_lit_side_is_warm() {
    // With the equation as printed in Gooch et al. 1998 it would be blue.
    for model in [Gooch::default(), Gooch::swapped_shares()] {
        let gray = DVec3::splat(0.5);
        let (lit, unlit) = (gooch_tone(&model, gray, 1.0), gooch_tone(&model, gray, -1.0));
        assert!(lit.x > lit.z && unlit.z > unlit.x);
    }
}

#[test]
fn tones_are_clamped_before_they_are_mixed() {
    let model = Gooch { highlight: None, ..Gooch::from_numbers(0.9, 0.9, 0.5, 0.5) };
    // k_cool (0.5, 0.5, 1.4) becomes (0.5, 0.5, 1), k_warm (1.4, 1.4, 0.5) becomes (1, 1, 0.5).
    assert_near(gooch_tone(&model, DVec3::ONE, 0.0), [0.75, 0.75, 0.75]);
    assert_near(gooch_tone(&model, DVec3::ONE, 0.5), [0.875, 0.875, 0.625]);
}

#[test]
fn weight() {
    for (n_dot_l, weight) in [(-1.0, 0.0), (-0.5, 0.25), (0.0, 0.5), (1.0, 1.0), (-1.5, 0.0), (1.5, 1.0)] {
        assert_eq!(gooch_weight(n_dot_l), weight);
    }
    assert_eq!(gooch_weight(f64::NAN), 0.0);
}

#[test]
fn highlight_is_phongs() {
    // The light at 45 degrees on one side, the eye at 45 degrees on the other: the eye is in the reflected direction.
    let (n, l) = (DVec3::Z * 2.0, DVec3::new(-3.0, 0.0, 3.0));
    assert_abs_diff_eq!(gooch_r_dot_e(n, l, DVec3::new(1.0, 0.0, 1.0)), 1.0, epsilon = 1e-15);
    // The eye along the normal, 45 degrees from the reflected direction.
    assert_abs_diff_eq!(gooch_r_dot_e(n, l, DVec3::Z), 0.5_f64.sqrt(), epsilon = 1e-15);
    assert_abs_diff_eq!(gooch_r_dot_e(n, l, l), 0.0, epsilon = 1e-15);

    let highlight = Highlight { color: Vec3::ONE, strength: 0.5, exponent: 4.0 };
    let model = Gooch { highlight: Some(highlight), ..Gooch::default() };
    assert_abs_diff_eq!(gooch_highlight(&model, 0.7, 0.5_f64.sqrt()), 0.5 * 0.25, epsilon = 1e-15);
    // There is no highlight on the unlit side, nor at 90 degrees and more from the reflected direction.
    for (n_dot_l, r_dot_e) in [(0.0, 1.0), (-0.5, 1.0), (0.5, 0.0), (0.5, -1.0), (f64::NAN, 1.0), (0.5, f64::NAN)] {
        assert_eq!(gooch_highlight(&model, n_dot_l, r_dot_e), 0.0);
    }
    let tone = DVec3::new(0.2, 0.4, 0.6);
    assert_near(gooch_over(&model, tone, 0.5), [0.6, 0.7, 0.8]);
    assert_eq!(gooch_over(&Gooch::swapped_shares(), tone, 0.5), tone);
}

#[test]
fn all_together() {
    // The light and the eye along the normal: the centre of the highlight.
    let (model, k_d) = (Gooch::default(), DVec3::X);
    assert_eq!(gooch_shade(&model, k_d, DVec3::Z, DVec3::Z * 5.0, DVec3::Z), DVec3::ONE);
    let plain = Gooch { highlight: None, ..model };
    assert_near(gooch_shade(&plain, k_d, DVec3::Z, DVec3::Z, DVec3::Z), [0.8, 0.3, 0.0]);
    assert_near(gooch_shade(&model, k_d, DVec3::Z, DVec3::NEG_Z, DVec3::Z), [0.25, 0.0, 0.55]);
}

#[test]
fn no_direction_is_halfway_and_not_nan() {
    let (model, k_d) = (Gooch::default(), DVec3::X);
    let between = gooch_tone(&model, k_d, 0.0);
    for none in [DVec3::ZERO, DVec3::NAN, DVec3::splat(1e-200)] {
        assert_eq!(gooch_shade(&model, k_d, none, DVec3::Z, DVec3::Z), between);
        // At the position of the light.
        assert_eq!(gooch_shade(&model, k_d, DVec3::Z, none, DVec3::Z), between);
    }
    assert!(gooch_shade(&model, k_d, DVec3::Z, DVec3::Z, DVec3::ZERO).is_finite());
    assert_eq!(gooch_aggregate(&[]), DVec3::ZERO);
    assert_eq!(gooch_aggregate(&[DVec3::X, DVec3::NEG_X]), DVec3::ZERO);
}

#[test]
fn invalid_models_are_rejected() {
    for model in [Gooch::default(), Gooch::swapped_shares()] {
        assert_eq!(model.validate(), Ok(()));
    }
    let broken = |change: &dyn Fn(&mut Gooch)| {
        let mut model = Gooch::default();
        change(&mut model);
        assert_eq!(GoochUniform::new(&model).unwrap_err().to_string(), model.validate().unwrap_err().to_string());
        model.validate().unwrap_err()
    };
    assert!(matches!(broken(&|m| m.blue.z = f32::NAN), GoochError::Blue { .. }));
    assert_eq!(broken(&|m| m.yellow = Vec3::NEG_X), GoochError::Yellow { value: Vec3::NEG_X });
    assert_eq!(broken(&|m| m.alpha = -0.5), GoochError::Alpha { value: -0.5 });
    assert!(matches!(broken(&|m| m.beta = f32::INFINITY), GoochError::Beta { .. }));
    let highlight = |change: &dyn Fn(&mut Highlight)| broken(&|m| change(m.highlight.as_mut().unwrap()));
    assert!(matches!(highlight(&|h| h.color.x = -1.0), GoochError::HighlightColor { .. }));
    assert_eq!(highlight(&|h| h.strength = 1.5), GoochError::HighlightStrength { value: 1.5 });
    assert_eq!(highlight(&|h| h.exponent = 0.0), GoochError::HighlightExponent { value: 0.0 });
    assert!(matches!(highlight(&|h| h.exponent = f32::NAN), GoochError::HighlightExponent { .. }));
    assert_eq!(GoochError::Alpha { value: -0.5 }.to_string(), "alpha is -0.5: it must be finite and not negative");
}

fn color() -> impl Strategy<Value = DVec3> {
    let part = 0.0..=1.0_f64;
    (part.clone(), part.clone(), part).prop_map(|(r, g, b)| DVec3::new(r, g, b))
}

fn vector() -> impl Strategy<Value = DVec3> {
    let part = -1.0..1.0_f64;
    (part.clone(), part.clone(), part).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// The purpose of the model: black lines and white highlights are visible on every tone of every object.
    #[test]
    fn default_tones_stay_in_the_middle(k_d in color(), n_dot_l in -1.0..=1.0_f64) {
        let tone = gooch_tone(&Gooch::default(), k_d, n_dot_l);
        prop_assert!(tone.max_element() <= 0.8 + 1e-7);
        // The darkest tone is that of a black object where 0.3 w = 0.55 (1 - w).
        prop_assert!(tone.max_element() >= 0.165 / 0.85 - 1e-7);
    }

    #[test]
    fn colours_are_displayable(
        (b, y, alpha, beta) in (0.0_f32..2.0, 0.0_f32..2.0, 0.0_f32..2.0, 0.0_f32..2.0), printed in any::<bool>(),
        k_d in color(), (normal, to_light, to_eye) in (vector(), vector(), vector()),
    ) {
        let tones = if printed { Tones::SwappedShares } else { Tones::Equation };
        let model = Gooch { tones, ..Gooch::from_numbers(b, y, alpha, beta) };
        let color = gooch_shade(&model, k_d, normal, to_light, to_eye);
        prop_assert!(color.min_element() >= 0.0 && color.max_element() <= 1.0 + 1e-12, "{}", color);
    }

    /// The tone becomes warmer linearly with N·L.
    #[test]
    fn tones_are_linear(k_d in color(), a in -1.0..=1.0_f64, b in -1.0..=1.0_f64) {
        let tone = |n_dot_l| gooch_tone(&Gooch::default(), k_d, n_dot_l);
        prop_assert!((tone((a + b) / 2.0) - (tone(a) + tone(b)) / 2.0).length() < 1e-12);
        let warmth = |color: DVec3| color.x + color.y - color.z;
        prop_assert!(a >= b || warmth(tone(a)) < warmth(tone(b)));
    }

    #[test]
    fn the_aggregate_points_where_all_light_comes_from(
        lights in prop::collection::vec(vector(), 1..5), normal in vector(),
    ) {
        let normal = normal.normalize_or_zero();
        let each: f64 = lights.iter().map(|light| normal.dot(*light)).sum();
        let sum: DVec3 = lights.iter().sum();
        prop_assert!((each - sum.length() * gooch_n_dot_l(normal, gooch_aggregate(&lights))).abs() < 1e-12);
    }
}

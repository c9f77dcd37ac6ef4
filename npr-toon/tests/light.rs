//! Hand-computed values, limits, and the coverage of antialiased borders.

use approx::assert_abs_diff_eq;
use glam::{DVec3, Vec3};
use npr_toon::*;

fn gray(value: f32) -> DVec3 {
    DVec3::splat(f64::from(value))
}

#[test]
fn listing_3_at_its_thresholds() {
    let bands = Bands::three_diffuse_bands();
    let (dark, average, bright) = (gray(0.2), gray(0.6), Vec3::new(0.9, 0.9, 1.0).as_dvec3());
    let (low, high) = (f64::from(0.1_f32), f64::from(0.8_f32));
    let expected = [
        (-1.0, dark),
        (low.next_down(), dark),
        (low, average),
        (low.next_up(), average),
        (high.next_down(), average),
        (high, bright),
        (1.0, bright),
    ];
    for (n_dot_l, tone) in expected {
        assert_eq!(toon_band_hard(&bands, n_dot_l), tone, "{n_dot_l}");
        assert_eq!(toon_band(&bands, n_dot_l, 0.0), tone, "{n_dot_l}");
        assert_eq!(toon_shade(&bands, DVec3::ONE, n_dot_l, 0.3, 1.0, 0.3), tone, "not antialiased: {n_dot_l}");
    }
    // The centre is 1/10 pixel above the border: 6/10 of the pixel are in the average band.
    assert!(toon_band(&bands, low + 0.002, 0.02).abs_diff_eq(0.4 * dark + 0.6 * average, 1e-12));
}

#[test]
fn hard_shading_has_its_border_at_zero() {
    let bands = Bands::hard_shading();
    assert_eq!(toon_band_hard(&bands, -f64::MIN_POSITIVE), DVec3::splat(0.5));
    assert_eq!(toon_band_hard(&bands, 0.0), DVec3::ONE);
    assert_eq!(toon_band(&bands, 0.0, 0.01), DVec3::splat(0.75));
}

#[test]
fn highlight_replaces_the_band() {
    let mut bands = Bands::diffuse_and_specular();
    let threshold = f64::from(0.8_f32);
    let (base, specular) = (DVec3::new(1.0, 0.5, 0.25), Vec3::new(0.9, 0.9, 1.0).as_dvec3());
    assert_eq!(toon_shade(&bands, base, 0.5, 0.0, threshold.next_down(), 0.0), base * gray(0.6));
    assert_eq!(toon_shade(&bands, base, 0.5, 0.0, threshold, 0.0), specular);
    // As in the source, also on the unlit side.
    assert_eq!(toon_shade(&bands, base, -0.5, 0.0, 0.9, 0.0), specular);

    let highlight = bands.highlight.as_mut().unwrap();
    (highlight.strength, highlight.lit_only) = (0.5, true);
    assert_eq!(toon_shade(&bands, base, -0.5, 0.0, 0.9, 0.0), base * gray(0.2));
    assert_eq!(toon_shade(&bands, base, 0.5, 0.0, 0.9, 0.0), (base * gray(0.6) + specular) / 2.0);
    bands.antialias = true;
    assert_eq!(toon_highlight(&bands, 0.5, 0.0, threshold, 0.1), 0.25);
    assert_eq!(toon_highlight(&bands, 0.0, 0.1, 1.0, 0.1), 0.25);
}

#[test]
fn absolute_tones_are_the_colours_of_listing_3() {
    let bands = Bands { absolute: true, ..Bands::three_diffuse_bands() };
    let base = DVec3::new(1.0, 0.5, 0.25);
    let colors = [gray(0.2), gray(0.6), Vec3::new(0.9, 0.9, 1.0).as_dvec3()];
    for (n_dot_l, color) in [-0.5, 0.5, 0.9].into_iter().zip(colors) {
        assert_eq!(toon_shade(&bands, base, n_dot_l, 0.0, 0.0, 0.0), color);
    }
    // A highlight covers them as it covers others.
    let bands = Bands { absolute: true, ..Bands::diffuse_and_specular() };
    let colors = [(0.0, 0.0, colors[0]), (0.5, 0.0, colors[1]), (0.5, 0.9, colors[2])];
    for (n_dot_l, n_dot_h, color) in colors {
        assert_eq!(toon_shade(&bands, base, n_dot_l, 0.0, n_dot_h, 0.0), color);
    }
}

#[test]
fn vectors() {
    let (n, l, e) = (DVec3::new(0.0, 0.0, 2.0), DVec3::new(0.0, 3.0, 4.0), DVec3::new(0.0, -3.0, 4.0));
    assert_abs_diff_eq!(toon_n_dot_l(n, l), 0.8, epsilon = 1e-15);
    assert_eq!(toon_n_dot_l_interpolated(n, l), 8.0);
    assert_eq!(toon_half(l, e), DVec3::Z);
    assert_eq!(toon_n_dot_h(n, l, e), 1.0);
    assert_eq!(toon_n_dot_h_interpolated(n, DVec3::Z), 2.0);
    assert_eq!(toon_width(3.0, -4.0), 5.0);
    // Zero vectors do not give NaN.
    assert_eq!(toon_n_dot_l(DVec3::ZERO, l), 0.0);
    assert_eq!(toon_n_dot_h(n, l, -l), 0.0);
    // Opposite up to f32 rounding: the rounding error is not normalised.
    let rounded = DVec3::new(0.0, 0.0, f64::from(1.0_f32.next_down()));
    assert_eq!(toon_half(DVec3::Z, DVec3::NEG_Z + DVec3::X * 5e-7), DVec3::ZERO);
    assert_eq!(toon_half(-rounded * 2.773408, DVec3::Z + DVec3::Y * 6e-8), DVec3::ZERO);
    assert!(toon_half(DVec3::Z, DVec3::NEG_Z + DVec3::X * 1e-5).x > 0.99);
    assert_eq!(toon_n_dot_h_from_dots(-0.2064291, 0.20689194, -1.0), 0.0);
}

#[test]
fn n_dot_h_of_dot_products_is_that_of_the_vectors() {
    // L and E are (±3/5, 0, 4/5): L·E is 7/25, and |L + E| is 8/5.
    for (n_dot_l, n_dot_e, l_dot_e, expected) in [
        (1.0, 1.0, 1.0, 1.0),
        (0.5, 0.5, 1.0, 0.5),
        (-1.0, -1.0, 1.0, -1.0),
        // N halfway between, N = L, N = E, N = X, N = Y.
        (0.8, 0.8, 0.28, 1.0),
        (1.0, 0.28, 0.28, 0.8),
        (0.28, 1.0, 0.28, 0.8),
        (0.6, -0.6, 0.28, 0.0),
        (0.0, 0.0, 0.28, 0.0),
        // At right angles, and 2 atan(4/3) apart.
        (1.0, 0.0, 0.0, std::f64::consts::FRAC_1_SQRT_2),
        (0.6, 0.6, -0.28, 1.0),
        // Opposite, and beyond by a rounding error.
        (1.0, -1.0, -1.0, 0.0),
        (1.0, -0.5, -1.0 - 1e-15, 0.0),
    ] {
        assert_abs_diff_eq!(toon_n_dot_h_from_dots(n_dot_l, n_dot_e, l_dot_e), expected, epsilon = 1e-15);
    }
    // Equal to N·H of the vectors, unless L and E are nearly opposite.
    let unit = |i: i32| {
        let (sin, cos) = (2.4 * f64::from(i)).sin_cos();
        DVec3::new(cos, sin, f64::from(i % 7) / 3.0 - 1.0).normalize()
    };
    for i in 0..1000 {
        let (n, l, e) = (unit(i), unit(3 * i + 1), unit(5 * i + 2));
        if l.dot(e) > -0.99 {
            let of_dots = toon_n_dot_h_from_dots(n.dot(l), n.dot(e), l.dot(e));
            assert_abs_diff_eq!(of_dots, toon_n_dot_h(n, l, e), epsilon = 1e-12);
        }
    }
}

/// The mean of the hard bands over a pixel, by 256 samples of an N·L that is linear across it.
fn sampled(bands: &Bands, n_dot_l: f64, width: f64) -> DVec3 {
    let at = |i: i32| n_dot_l + width * ((f64::from(i) + 0.5) / 256.0 - 0.5);
    (0..256).map(|i| toon_band_hard(bands, at(i))).sum::<DVec3>() / 256.0
}

#[test]
fn smooth_is_the_mean_over_the_pixel() {
    let one = Bands { thresholds: vec![0.25], tones: vec![Vec3::ZERO, Vec3::ONE], ..Bands::three_diffuse_bands() };
    // Two borders in one pixel at the larger widths.
    let close = Bands {
        thresholds: vec![0.2, 0.25, 0.3],
        tones: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE],
        ..Bands::three_diffuse_bands()
    };
    for bands in [one, close] {
        for step in -100..=100 {
            for width in [0.001, 0.02, 0.1, 0.5] {
                let n_dot_l = 0.25 + f64::from(step) * 0.004;
                let error = toon_band(&bands, n_dot_l, width) - sampled(&bands, n_dot_l, width);
                assert!(error.abs().max_element() < 1.0 / 255.0, "{n_dot_l} {width}: {error}");
            }
        }
    }
}

#[test]
fn a_border_of_the_minimum_width_is_hard() {
    assert_eq!((toon_coverage(0.5, 0.5, MIN_WIDTH), toon_coverage(0.5, 0.5, MIN_WIDTH.next_up())), (1.0, 0.5));
    assert_eq!(toon_coverage(0.5_f64.next_down(), 0.5, MIN_WIDTH), 0.0);
}

#[test]
fn one_band_is_flat() {
    let bands = Bands { thresholds: vec![], tones: vec![Vec3::splat(0.5)], ..Bands::three_diffuse_bands() };
    assert_eq!(bands.validate(), Ok(()));
    assert_eq!(toon_band(&bands, -1.0, 0.5), DVec3::splat(0.5));
}

#[test]
fn presets_are_valid_and_each_rule_is_checked() {
    for bands in [Bands::hard_shading(), Bands::three_diffuse_bands(), Bands::diffuse_and_specular(), Bands::default()]
    {
        assert_eq!(bands.validate(), Ok(()));
    }
    let broken = |change: &dyn Fn(&mut Bands)| {
        let mut bands = Bands::default();
        change(&mut bands);
        bands.validate().unwrap_err()
    };
    assert_eq!(broken(&|b| b.tones.clear()), ToonError::NoTones);
    assert_eq!(broken(&|b| b.thresholds.clear()), ToonError::Counts { tones: 3, thresholds: 0 });
    assert_eq!(
        broken(&|b| b.thresholds = vec![0.5, 0.5]),
        ToonError::ThresholdOrder { index: 1, value: 0.5, before: 0.5 }
    );
    assert!(matches!(broken(&|b| b.thresholds[1] = f32::NAN), ToonError::ThresholdNotFinite { index: 1, .. }));
    assert!(matches!(broken(&|b| b.tones[2].y = -0.1), ToonError::Tone { index: 2, .. }));
    let highlight = |change: &dyn Fn(&mut Highlight)| broken(&|b| change(b.highlight.as_mut().unwrap()));
    assert!(matches!(highlight(&|h| h.threshold = f32::INFINITY), ToonError::HighlightThreshold { .. }));
    assert!(matches!(highlight(&|h| h.color.x = f32::NAN), ToonError::HighlightColor { .. }));
    assert_eq!(highlight(&|h| h.strength = 1.5), ToonError::HighlightStrength { value: 1.5 });
}

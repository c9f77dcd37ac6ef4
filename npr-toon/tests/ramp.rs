//! 1D and 2D ramps: hand-computed values, properties of any ramp, and validation.

use approx::assert_abs_diff_eq;
use glam::{DVec2, DVec3, UVec2, Vec3};
use npr_toon::ramp::*;
use npr_toon::row::*;
use npr_toon::table::*;
use npr_toon::*;
use proptest::prelude::*;

fn stops(of: &[(f32, f32)]) -> Vec<RampStop> {
    of.iter().map(|&(at, gray)| RampStop { at, color: Vec3::splat(gray) }).collect()
}

fn ramp(blend: RampBlend, of: &[(f32, f32)]) -> Ramp {
    Ramp { stops: stops(of), blend }
}

#[test]
fn hard_ramp_holds_each_colour_up_to_the_next_stop() {
    let ramp = ramp(RampBlend::Hard, &[(0.0, 0.25), (0.25, 0.5), (0.75, 1.0)]);
    let expected = [(-9.0, 0.25), (0.0, 0.25), (0.249, 0.25), (0.25, 0.5), (0.749, 0.5), (0.75, 1.0), (9.0, 1.0)];
    for (x, gray) in expected {
        assert_eq!(toon_ramp(&ramp, x, 0.0), DVec3::splat(gray), "{x}");
    }
    // A quarter of the pixel lies above the step.
    assert_eq!(toon_ramp(&ramp, 0.125, 0.5), DVec3::splat(0.25 * 0.75 + 0.5 * 0.25));
}

#[test]
fn smooth_ramp_is_linear_between_stops() {
    let ramp = ramp(RampBlend::Smooth, &[(-0.5, 0.0), (0.5, 0.5), (0.75, 1.0)]);
    let expected = [(-9.0, 0.0), (-0.5, 0.0), (0.0, 0.25), (0.5, 0.5), (0.625, 0.75), (0.75, 1.0), (9.0, 1.0)];
    for (x, gray) in expected {
        assert_eq!(toon_ramp(&ramp, x, 0.3), DVec3::splat(gray), "{x}");
    }
}

#[test]
fn bands_are_a_hard_ramp() {
    for bands in [Bands::hard_shading(), Bands::three_diffuse_bands(), Bands::default()] {
        let ramp = Ramp::from_bands(&bands).unwrap();
        for step in -120..=120 {
            for width in [0.0, 0.01, 0.3] {
                let x = f64::from(step) / 100.0;
                assert_eq!(toon_ramp(&ramp, x, width), toon_band(&bands, x, width));
            }
        }
    }
}

#[test]
fn the_first_stop_of_bands_is_at_minus_1_or_1_below_a_negative_threshold() {
    let grays = [0.125, 0.25, 0.5];
    for (thresholds, at) in [
        (vec![], vec![-1.0]),
        (vec![0.25], vec![-1.0, 0.25]),
        (vec![0.0], vec![-1.0, 0.0]),
        (vec![-0.25], vec![-1.25, -0.25]),
        (vec![-1.0, 0.5], vec![-2.0, -1.0, 0.5]),
        (vec![-3.0, -2.5], vec![-4.0, -3.0, -2.5]),
        (vec![2.0, 3.0], vec![-1.0, 2.0, 3.0]),
    ] {
        let tones = grays[..at.len()].iter().map(|&gray| Vec3::splat(gray)).collect();
        let bands = Bands { thresholds, tones, highlight: None, antialias: false, absolute: false };
        let expected: Vec<_> = at.into_iter().zip(grays).collect();
        assert_eq!(Ramp::from_bands(&bands).unwrap(), ramp(RampBlend::Hard, &expected));
    }
}

#[test]
fn one_stop_is_flat_and_not_a_number_is_dark() {
    for blend in [RampBlend::Hard, RampBlend::Smooth] {
        assert_eq!(toon_ramp(&ramp(blend, &[(0.5, 0.5)]), -3.0, 0.1), DVec3::splat(0.5));
        for width in [0.0, 0.1] {
            assert_eq!(toon_ramp(&ramp(blend, &[(0.0, 0.25), (1.0, 1.0)]), f64::NAN, width), DVec3::splat(0.25));
        }
    }
    assert_eq!(toon_row_nearest(f64::NAN, 0.0, 1.0, 4), 0);
    assert_eq!(toon_row_taps(f64::NAN, 0.0, 1.0, 4), ToonTaps { left: 0, right: 1, share: 0.0 });
}

#[test]
fn row_is_sampled_as_a_sampler_does() {
    // Four texels over 0..1: borders at 1/4, 1/2, 3/4, centres at 1/8, 3/8, 5/8, 7/8.
    for (x, texel) in [(-5.0, 0), (0.0, 0), (0.2499, 0), (0.25, 1), (0.5, 2), (0.75, 3), (1.0, 3), (5.0, 3)] {
        assert_eq!(toon_row_nearest(x, 0.0, 1.0, 4), texel, "{x}");
    }
    let taps = |left, right, share| ToonTaps { left, right, share };
    for (x, expected) in [
        (-5.0, taps(0, 1, 0.0)),
        (0.125, taps(0, 1, 0.0)),
        (0.1875, taps(0, 1, 0.25)),
        (0.25, taps(0, 1, 0.5)),
        (0.375, taps(1, 2, 0.0)),
        (0.875, taps(3, 3, 0.0)),
        (5.0, taps(3, 3, 0.0)),
    ] {
        assert_eq!(toon_row_taps(x, 0.0, 1.0, 4), expected, "{x}");
    }
    // The same over -1..1, at N.L = 2x - 1.
    assert_eq!(toon_row_taps(-0.625, -1.0, 1.0, 4), taps(0, 1, 0.25));
    // A single texel covers everything.
    assert_eq!(toon_row_taps(0.9, 0.0, 1.0, 1), taps(0, 0, 0.0));
}

#[test]
fn row_colours() {
    let row = |filter| RampRow { texels: vec![[0, 51, 255, 7], [255, 102, 0, 9]], from: 0.0, to: 1.0, filter };
    assert_eq!(toon_row(&row(TexelFilter::Nearest), 0.49), DVec3::new(0.0, 0.2, 1.0));
    let mixed = toon_row(&row(TexelFilter::Linear), 0.375);
    assert!(mixed.abs_diff_eq(DVec3::new(0.25, 0.25, 0.75), 1e-12), "{mixed}");
}

#[test]
fn row_made_from_bands() {
    // Ten texels over 0..1 with steps at 0.1 and 0.8: one dark, seven average, two bright. (0.9 in f32 is slightly less
    // than 0.9, so it rounds to 229.)
    let ramp = Ramp::from_bands(&Bands::three_diffuse_bands()).unwrap();
    let row = RampRow::from_ramp(&ramp, 10, 0.0, 1.0, TexelFilter::Nearest).unwrap();
    let (dark, average, bright) = ([51, 51, 51, 255], [153, 153, 153, 255], [229, 229, 255, 255]);
    assert_eq!(row.texels, [dark, average, average, average, average, average, average, average, bright, bright]);
    for step in 0..100 {
        let x = (f64::from(step) + 0.5) / 100.0;
        assert!(toon_row(&row, x).abs_diff_eq(toon_ramp(&ramp, x, 0.0), 0.5 / 255.0 + 1e-6), "{x}");
    }
}

fn two() -> Ramp2d {
    Ramp2d {
        a: ramp(RampBlend::Hard, &[(0.0, 0.25), (0.5, 0.75)]),
        b: ramp(RampBlend::Hard, &[(0.0, 0.25), (0.25, 0.5)]),
        corner: Some(Corner { threshold: 0.9, color: Vec3::ONE }),
    }
}

#[test]
fn the_result_is_the_lighter_of_two_ramps() {
    let (ramps, sharp) = (two(), DVec2::ZERO);
    let expected = [
        ((0.0, 0.0), 0.25),
        ((-3.0, -3.0), 0.25),
        ((0.0, 0.3), 0.5),
        ((0.6, 0.0), 0.75),
        ((0.6, 0.3), 0.75),
        ((0.4, 0.3), 0.5),
        // The corner: one light at 0.9, or (0.7, 0.6) with length 0.92, but not (0.6, 0.6) with length 0.85.
        ((0.9, -1.0), 1.0),
        ((0.0, 7.0), 1.0),
        ((0.7, 0.6), 1.0),
        ((0.6, 0.6), 0.75),
        ((f64::NAN, 0.3), 0.5),
    ];
    for ((u, v), gray) in expected {
        assert_eq!(toon_ramp_2d(&ramps, DVec2::new(u, v), sharp), DVec3::splat(gray), "{u} {v}");
    }
    // The pixel's centre is 1/10 pixel above the threshold: 6/10 of the pixel are in the corner.
    let soft = toon_ramp_2d(&ramps, DVec2::new(f64::from(0.9_f32) + 0.001, 0.0), DVec2::splat(0.01));
    assert!(soft.abs_diff_eq(DVec3::splat(0.6 + 0.4 * 0.75), 1e-9), "{soft}");
    // Above 1 a single light does not reach the corner.
    let both = Ramp2d { corner: Some(Corner { threshold: 1.2, color: Vec3::ONE }), ..two() };
    assert_eq!(toon_ramp_2d(&both, DVec2::new(9.0, 0.2), sharp), DVec3::splat(0.75));
    assert_eq!(toon_ramp_2d(&both, DVec2::new(9.0, 0.7), sharp), DVec3::ONE);
}

#[test]
fn a_clamped_light_does_not_blur_the_corner() {
    // u is above 1 and has a large width; the border is where v crosses 0.75, as sqrt(1 + 0.75²) is 1.25.
    let corner = |v: f64, widths| toon_corner(DVec2::new(1.2, v), widths, 1.25);
    assert_eq!(corner(0.75, DVec2::new(0.1, 0.0)), 1.0);
    // The length changes by 0.75 / 1.25 of the change of v.
    let widths = DVec2::new(0.1, 0.01);
    assert_abs_diff_eq!(corner(0.7525, widths), 0.75, epsilon = 1e-3);
    assert_eq!((corner(0.744, widths), corner(0.756, widths)), (0.0, 1.0));
}

#[test]
fn the_image_is_the_2d_ramp_outside_of_0_to_1() {
    let smooth = ramp(RampBlend::Smooth, &[(0.0, 0.2), (1.0, 0.8)]);
    let ramps = Ramp2d { b: smooth, corner: None, ..two() };
    ramps.validate().unwrap();
    let table = RampTable::from_ramps(&ramps, UVec2::new(64, 64), TexelFilter::Nearest).unwrap();
    for (u, v) in [(-0.7, -0.7), (-0.1, 1.7), (1.4, -0.2), (2.0, 2.0)] {
        let uv = DVec2::new(u, v);
        let apart = toon_ramp_2d(&ramps, uv, DVec2::ZERO) - toon_table(&table, uv);
        // Half a step of 8 bits, plus the change of the gradient over half a texel.
        assert!(apart.abs().max_element() < 0.5 / 255.0 + 0.5 * 0.6 / 64.0 + 1e-6, "{uv}: {apart}");
    }
}

#[test]
fn table_is_dark_at_its_upper_left() {
    let table = RampTable::from_ramps(&two(), UVec2::new(4, 2), TexelFilter::Nearest).unwrap();
    // Columns at u = 1/8, 3/8, 5/8, 7/8; rows at v = 1/4, 3/4. (7/8, 1/4), (5/8, 3/4) and (7/8, 3/4) are in the corner
    // since their lengths are 0.91, 0.98 and 1.15; that of (3/8, 3/4) is 0.84.
    let gray = |value: u8| [value, value, value, 255];
    let expected = [128, 128, 191, 255, 128, 128, 255, 255].map(gray);
    assert_eq!(table.texels, expected);
    assert_eq!(toon_table(&table, DVec2::new(-1.0, 2.0)), DVec3::splat(128.0 / 255.0));
    let linear = RampTable { filter: TexelFilter::Linear, ..table };
    // In the middle of the texels 191, 255 above and 255, 255 below.
    assert_abs_diff_eq!(
        toon_table(&linear, DVec2::new(0.75, 0.5)).x,
        (191.0 + 3.0 * 255.0) / 4.0 / 255.0,
        epsilon = 1e-12
    );
}

#[test]
fn table_mixes_across_then_down() {
    let gray = DVec3::splat;
    assert_eq!(toon_table_mix(gray(0.0), gray(1.0), gray(2.0), gray(3.0), 0.25, 0.5), gray(1.25));
}

#[test]
fn invalid_ramps_are_rejected() {
    let hard = |of: &[(f32, f32)]| ramp(RampBlend::Hard, of);
    assert_eq!(hard(&[]).validate(), Err(ToonError::NoStops));
    assert_eq!(
        hard(&[(0.5, 0.0), (0.5, 1.0)]).validate(),
        Err(ToonError::StopOrder { index: 1, value: 0.5, before: 0.5 })
    );
    assert_eq!(
        hard(&[(0.0, 0.0), (0.75, 0.5), (0.5, 1.0)]).validate(),
        Err(ToonError::StopOrder { index: 2, value: 0.5, before: 0.75 })
    );
    assert!(matches!(hard(&[(f32::NAN, 0.0)]).validate(), Err(ToonError::StopNotFinite { index: 0, .. })));
    assert!(matches!(hard(&[(0.0, 0.0), (1.0, -0.1)]).validate(), Err(ToonError::StopColor { index: 1, .. })));
    assert_eq!(
        RampUniform::new(&hard(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0].map(|x| (x, 0.5)))),
        Err(ToonError::TooManyStops { stops: 9, max: 8 })
    );
    let broken = Bands { thresholds: vec![0.5, 0.1], ..Bands::three_diffuse_bands() };
    assert_eq!(Ramp::from_bands(&broken), Err(ToonError::ThresholdOrder { index: 1, value: 0.1, before: 0.5 }));
    // 1 below the threshold rounds to the threshold in f32.
    let far = Bands { thresholds: vec![-1e9], ..Bands::hard_shading() };
    assert!(matches!(Ramp::from_bands(&far), Err(ToonError::StopOrder { index: 1, .. })));

    let fine = hard(&[(0.0, 0.5)]);
    let row = |count, from, to| RampRow::from_ramp(&fine, count, from, to, TexelFilter::Linear).map(|_| ());
    assert_eq!(row(1, 0.0, 1.0), Ok(()));
    assert_eq!(row(0, 0.0, 1.0), Err(ToonError::Texels { width: 0, height: 1, texels: 0 }));
    assert_eq!(row(2, 1.0, 1.0), Err(ToonError::RowEnds { from: 1.0, to: 1.0 }));
    assert!(matches!(row(2, f32::NAN, 1.0), Err(ToonError::RowEnds { .. })));
    // The difference overflows f32.
    assert!(matches!(row(2, -3e38, 3e38), Err(ToonError::RowEnds { .. })));

    let table = |x, y| RampTable::from_ramps(&two(), UVec2::new(x, y), TexelFilter::Nearest).map(|_| ());
    assert_eq!(table(0, 4), Err(ToonError::Texels { width: 0, height: 4, texels: 0 }));
    let short = RampTable { size: UVec2::new(2, 2), texels: vec![[0; 4]; 3], filter: TexelFilter::Nearest };
    assert_eq!(short.validate(), Err(ToonError::Texels { width: 2, height: 2, texels: 3 }));

    // A border at 0, below which clamped coordinates cannot be.
    assert_eq!(Ramp2d::from_bands(&Bands::hard_shading()), Err(ToonError::StopOutside { index: 1, value: 0.0 }));
    assert!(Ramp2d::from_bands(&Bands::three_diffuse_bands()).is_ok());
    // Coordinates are clamped at 0, so a gradient cannot begin below.
    let smooth = |of: &[(f32, f32)]| Ramp2d { b: ramp(RampBlend::Smooth, of), ..two() }.validate();
    assert_eq!(smooth(&[(-0.5, 0.0), (1.0, 1.0)]), Err(ToonError::StopOutside { index: 0, value: -0.5 }));
    assert_eq!((smooth(&[(0.0, 0.0), (1.0, 1.0)]), smooth(&[(-0.5, 0.0)])), (Ok(()), Ok(())));
    let corner = |threshold, x| Ramp2d { corner: Some(Corner { threshold, color: Vec3::new(x, 0.0, 0.0) }), ..two() };
    assert_eq!(corner(0.0, 1.0).validate(), Err(ToonError::CornerThreshold { value: 0.0 }));
    assert!(matches!(corner(f32::NAN, 1.0).validate(), Err(ToonError::CornerThreshold { .. })));
    assert!(matches!(corner(1.0, f32::NAN).validate(), Err(ToonError::CornerColor { .. })));
    assert_eq!(
        ToonError::StopOrder { index: 1, value: 0.5, before: 0.75 }.to_string(),
        "stop 1 is at 0.5, not above the preceding 0.75"
    );
}

/// A valid ramp of grays in 0..=1, optionally in ascending order.
fn any_ramp(ascending: bool) -> impl Strategy<Value = Ramp> {
    let stop = (0.01_f32..0.5, 0.0_f32..=1.0);
    (prop::collection::vec(stop, 1..=MAX_STOPS), any::<bool>(), -1.0_f32..0.0).prop_map(
        move |(steps, smooth, first)| {
            let mut grays: Vec<f32> = steps.iter().map(|step| step.1).collect();
            if ascending {
                grays.sort_by(f32::total_cmp);
            }
            let mut at = first;
            let positions = steps.iter().map(|step| {
                let here = at;
                at += step.0;
                here
            });
            let of: Vec<_> = positions.zip(grays).collect();
            ramp(if smooth { RampBlend::Smooth } else { RampBlend::Hard }, &of)
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_colour_is_beyond_the_stops(ramp in any_ramp(false), x in -3.0..5.0_f64, width in 0.0..1.0_f64) {
        prop_assert_eq!(ramp.validate(), Ok(()));
        let grays = ramp.stops.iter().map(|stop| f64::from(stop.color.x));
        let (low, high) = grays.fold((1.0_f64, 0.0_f64), |(low, high), gray| (low.min(gray), high.max(gray)));
        let gray = toon_ramp(&ramp, x, width).x;
        prop_assert!(gray >= low - 1e-12 && gray <= high + 1e-12, "{} not in {}..={}", gray, low, high);
    }

    #[test]
    fn more_light_is_lighter(ramp in any_ramp(true), x in -3.0..5.0_f64, more in 0.0..1.0_f64, width in 0.0..1.0_f64) {
        prop_assert!(toon_ramp(&ramp, x + more, width).x >= toon_ramp(&ramp, x, width).x - 1e-12);
        let other = Ramp2d { a: ramp.clone(), b: ramp.clone(), corner: None };
        let (uv, widths) = (DVec2::new(x, 0.3), DVec2::splat(width));
        let brighter = toon_ramp_2d(&other, uv + DVec2::new(0.0, more), widths).x;
        prop_assert!(brighter >= toon_ramp_2d(&other, uv, widths).x - 1e-12);
        // The second light never darkens the result of the first.
        prop_assert!(brighter >= toon_ramp(&ramp, x, width).x);
    }

    #[test]
    fn smooth_and_antialiased_ramps_have_no_jumps(ramp in any_ramp(false), x in -2.0..5.0_f64) {
        // No stops are closer than 0.01 and no tones further apart than 1.
        let width = if ramp.blend == RampBlend::Smooth { 0.0 } else { 0.01 };
        let change = toon_ramp(&ramp, x + 1e-6, width) - toon_ramp(&ramp, x, width);
        prop_assert!(change.x.abs() <= 2.1e-4, "{}", change.x);
    }

    #[test]
    fn an_antialiased_ramp_keeps_the_mean(ramp in any_ramp(false), width in 0.01..0.3_f64) {
        prop_assume!(ramp.blend == RampBlend::Hard);
        let at = |i: u32, width| toon_ramp(&ramp, -2.0 + f64::from(i) / 1000.0, width).x;
        let mean = |width| (0..8000).map(|i| at(i, width)).sum::<f64>() / 8000.0;
        prop_assert!((mean(width) - mean(0.0)).abs() < 1.0 / 1000.0);
    }

    #[test]
    fn taps_are_inside_and_next_to_each_other(x in -3.0..3.0_f64, count in 1..9_u32) {
        let taps = toon_row_taps(x, -1.0, 1.0, count);
        prop_assert!(taps.left <= taps.right && taps.right - taps.left <= 1 && taps.right < count);
        prop_assert!((0.0..1.0).contains(&taps.share));
        // The nearest texel is the one with the larger share.
        let nearest = if taps.share < 0.5 { taps.left } else { taps.right };
        prop_assert!(nearest == toon_row_nearest(x, -1.0, 1.0, count) || (taps.share - 0.5).abs() < 1e-9);
    }

    #[test]
    fn a_fine_image_is_the_ramp(ramp in any_ramp(false), x in -0.99..0.99_f64) {
        prop_assume!(ramp.blend == RampBlend::Smooth);
        let row = RampRow::from_ramp(&ramp, 4096, -1.0, 1.0, TexelFilter::Linear).unwrap();
        // Half a step of 8 bits, plus the interpolation error where a stop lies between two texel centres.
        prop_assert!((toon_row(&row, x) - toon_ramp(&ramp, x, 0.0)).x.abs() < 0.5 / 255.0 + 0.025);
    }
}

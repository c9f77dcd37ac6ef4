//! The weights compared with the instructions of listing 4, their sums, the blend and the transfer curve.

use approx::assert_abs_diff_eq;
use glam::DVec3;
use npr_hatch::*;
use proptest::prelude::*;

type Register = [f64; 4];

fn each(a: Register, b: Register, f: impl Fn(f64, f64) -> f64) -> Register {
    std::array::from_fn(|i| f(a[i], b[i]))
}

fn sub(a: Register, b: Register) -> Register {
    each(a, b, |a, b| a - b)
}

fn add(a: Register, b: Register) -> Register {
    each(a, b, |a, b| a + b)
}

fn mul(a: Register, b: Register) -> Register {
    each(a, b, |a, b| a * b)
}

fn max(a: Register, b: Register) -> Register {
    each(a, b, f64::max)
}

fn min(a: Register, b: Register) -> Register {
    each(a, b, f64::min)
}

fn sge(a: Register, b: Register) -> Register {
    each(a, b, |a, b| if a >= b { 1.0 } else { 0.0 })
}

fn slt(a: Register, b: Register) -> Register {
    each(a, b, |a, b| if a < b { 1.0 } else { 0.0 })
}

/// The common part of listing 4 for both sets of weights, from `max` to the last `mul`.
fn fold(mut r: Register, c: impl Fn(f64) -> Register) -> Register {
    r = max(r, c(0.0));
    let mut r7 = sge(c(2.0), r);
    r = mul(r, r7);
    r7 = sge(r, c(1.0));
    r7 = mul(r7, c(2.0));
    r = sub(r7, r);
    r7 = slt(r, c(0.0));
    let r8 = sge(r, c(0.0));
    r7 = add(r7.map(|x| -x), r8);
    mul(r, r7)
}

/// Listing 4 from the light factor on, instruction by instruction.
fn listing_4(light_factor: f64) -> HatchWeights {
    let c = |value: f64| [value; 4];
    let r3 = c(light_factor);
    let mut r5 = [5.0, 4.0, 3.0, 0.0];
    let mut r6 = [2.0, 1.0, 0.0, 0.0];
    r5 = sub(r3, r5);
    r6 = sub(r3, r6);
    r5 = fold(r5, c);
    r6 = fold(r6, c);
    let r8 = sge(c(1.0), r3);
    let mut r7 = c(0.0);
    r7[2] = r8[2];
    r6 = add(r6, r7);
    r6 = min(r6, c(1.0));
    HatchWeights { light: DVec3::new(r5[0], r5[1], r5[2]), dark: DVec3::new(r6[0], r6[1], r6[2]) }
}

/// Light factors from -10 to 10 in exactly representable steps, with all integers and their neighbours.
fn factors() -> impl Iterator<Item = f64> {
    let whole = (-10..=10).map(f64::from);
    (-2560..=2560).map(|i| f64::from(i) / 256.0).chain(whole.flat_map(|x| [x.next_down(), x.next_up()]))
}

#[test]
fn weights_are_the_listings() {
    for factor in factors() {
        let (ours, theirs) = (hatch_weights(factor), listing_4(factor));
        assert!(ours.light.abs_diff_eq(theirs.light, 1e-15), "{factor}: {ours:?}, {theirs:?}");
        assert!(ours.dark.abs_diff_eq(theirs.dark, 1e-15), "{factor}: {ours:?}, {theirs:?}");
    }
}

#[test]
fn weights_sum_to_one_up_to_six() {
    for factor in factors() {
        let weights = hatch_weights(factor);
        let sum = weights.light.element_sum() + weights.dark.element_sum();
        assert_abs_diff_eq!(sum, (7.0 - factor).clamp(0.0, 1.0), epsilon = 1e-14);
        assert!(weights.light.min_element() >= 0.0 && weights.dark.min_element() >= 0.0);
    }
}

#[test]
fn weights_at_the_ends() {
    let at = |factor| {
        let HatchWeights { light, dark } = hatch_weights(factor);
        [light.x, light.y, light.z, dark.x, dark.y, dark.z]
    };
    let darkest = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    for factor in [f64::NEG_INFINITY, -6.0, 0.0, 0.5, 1.0] {
        assert_eq!(at(factor), darkest, "{factor}");
    }
    assert_eq!(at(1.5), [0.0, 0.0, 0.0, 0.0, 0.5, 0.5]);
    assert_eq!(at(3.5), [0.0, 0.0, 0.5, 0.5, 0.0, 0.0]);
    assert_eq!(at(6.0), [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(at(6.75), [0.25, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(at(7.0), [0.0; 6]);
    assert_eq!(at(f64::INFINITY), [0.0; 6]);
    assert_eq!(hatch_level(6.0, -0.5), -3.0);
}

#[test]
fn blends_as_listing_5_does() {
    let (light, dark) = (DVec3::new(0.9, 0.8, 0.7), DVec3::new(0.6, 0.4, 0.2));
    assert_abs_diff_eq!(hatch_blend(light, dark, hatch_weights(5.0)), 0.8, epsilon = 1e-15);
    assert_abs_diff_eq!(hatch_blend(light, dark, hatch_weights(3.5)), 0.65, epsilon = 1e-15);
    assert_abs_diff_eq!(hatch_blend(light, dark, hatch_weights(-1.0)), 0.2, epsilon = 1e-15);
    assert_eq!(hatch_blend(light, dark, hatch_weights(7.0)), 1.0);
    // Each dot product saturates, and so does their sum.
    let full = HatchWeights { light: DVec3::ONE, dark: DVec3::ONE };
    assert_eq!(hatch_blend(DVec3::ZERO, DVec3::ZERO, full), 0.0);
}

#[test]
fn even_tones_are_linear() {
    let tones: Vec<f64> = even_tones(6).into_iter().map(f64::from).collect();
    let (light, dark) = (DVec3::from_slice(&tones), DVec3::from_slice(&tones[3..]));
    for factor in factors() {
        let tone = hatch_transfer(light, dark, factor);
        assert_abs_diff_eq!(tone, factor.clamp(1.0, 7.0) / 7.0, epsilon = 1e-7);
    }
    assert_abs_diff_eq!(hatch_level_of_tone(light, dark, 0.6), 4.2, epsilon = 1e-5);
}

#[test]
fn linear_inverts_the_transfer() {
    let (light, dark) = (DVec3::new(0.93, 0.9, 0.5), DVec3::new(0.45, 0.2, 0.05));
    for i in 0..=1000 {
        let tone = f64::from(i) / 1000.0;
        let factor = hatch_level_of_tone(light, dark, tone);
        assert!((1.0..=7.0).contains(&factor));
        assert_abs_diff_eq!(hatch_transfer(light, dark, factor), tone.max(0.05), epsilon = 1e-12);
    }
    assert_eq!((hatch_level_of_tone(light, dark, -1.0), hatch_level_of_tone(light, dark, 2.0)), (1.0, 7.0));
}

/// A patch of a surface hatched with the map has the tone of its lighting.
#[test]
fn a_hatched_patch_has_its_tone() {
    let tam = draw(&TamParameters { side: 128, ..TamParameters::default() }, None).unwrap().tam;
    let [light, dark] = tam.pack_tones(0).unwrap();
    for i in 0..=20 {
        let n_dot_l = f64::from(i) / 20.0;
        let weights = hatch_weights(hatch_level(7.0, n_dot_l));
        let unit = |texel: &[u8; 3]| DVec3::from_array(texel.map(f64::from)) / 255.0;
        let sum: f64 = light.iter().zip(&dark).map(|(l, d)| hatch_blend(unit(l), unit(d), weights)).sum();
        assert_abs_diff_eq!(sum / light.len() as f64, n_dot_l.max(1.0 / 7.0), epsilon = 1e-4);
    }
}

#[test]
fn thresholds_and_colors() {
    assert_eq!([0.3, 0.5, 0.7].map(|tone| hatch_threshold(0.5, tone, 0.0)), [1.0, 0.0, 0.0]);
    assert_abs_diff_eq!(hatch_threshold(0.5, 0.475, 0.1), 0.75, epsilon = 1e-12);
    assert_eq!([0.44, 0.5, 0.56].map(|tone| hatch_threshold(0.5, tone, 0.1)), [1.0, 0.5, 0.0]);
    let (paper, ink) = (DVec3::new(0.9, 0.7, 0.5), DVec3::new(0.1, 0.1, 0.3));
    assert_eq!((hatch_color(0.0, paper, ink), hatch_color(1.0, paper, DVec3::ZERO)), (ink, paper));
}

#[test]
fn shadows_have_the_darkest_tone() {
    let darkest = 1.0 / 7.0;
    for step in 0..=20 {
        let tone = f64::from(step) / 20.0;
        assert_eq!(hatch_tone_in_shadow(tone, darkest, 1.0), tone);
        assert_eq!(hatch_tone_in_shadow(tone, darkest, 0.0), tone.min(darkest));
        let soft = hatch_tone_in_shadow(tone, darkest, 0.5);
        assert!((soft - 0.5 * (tone + tone.min(darkest))).abs() < 1e-15);
    }
}

/// Six descending tones between white and black.
fn tones() -> impl Strategy<Value = (DVec3, DVec3)> {
    prop::array::uniform6(0.001..1.0f64).prop_map(|mut tones| {
        tones.sort_by(|a, b| b.total_cmp(a));
        (DVec3::from_slice(&tones), DVec3::from_slice(&tones[3..]))
    })
}

proptest! {
    /// At any light factor all weights are within 0..=1, at most two adjacent ones are not zero, and up to 6 they sum
    /// to 1.
    #[test]
    fn weights_of_any_factor_are_shares(factor in prop_oneof![-2.0..9.0f64, any::<f64>()]) {
        prop_assume!(!factor.is_nan());
        let HatchWeights { light, dark } = hatch_weights(factor);
        let weights = [light.x, light.y, light.z, dark.x, dark.y, dark.z];
        prop_assert!(weights.iter().all(|weight| (0.0..=1.0).contains(weight)), "{weights:?}");
        prop_assert!((weights.iter().sum::<f64>() - (7.0 - factor).clamp(0.0, 1.0)).abs() < 1e-12, "{weights:?}");
        let there: Vec<usize> = (0..6).filter(|&tone| weights[tone] > 0.0).collect();
        prop_assert!(there.len() <= 2 && there.windows(2).all(|pair| pair[1] == pair[0] + 1), "{weights:?}");
    }

    /// A blend is between the darkest of its texels and paper, and does not get darker as the light gets brighter.
    #[test]
    fn blends_of_any_tones_stay_between_them(
        (light, dark) in tones(),
        factor in prop_oneof![-2.0..9.0f64, -1e300..1e300f64],
        more in 0.0..3.0f64,
    ) {
        let tone = hatch_blend(light, dark, hatch_weights(factor));
        prop_assert!((dark.z - 1e-12..=1.0).contains(&tone), "{tone}");
        let brighter = hatch_blend(light, dark, hatch_weights(factor + more));
        prop_assert!(brighter >= tone - 1e-12, "{tone}, then {brighter}");
        for lit in [0.0, 0.3, 1.0] {
            let shadowed = hatch_tone_in_shadow(tone, dark.z, lit);
            prop_assert!((dark.z - 1e-12..=tone + 1e-12).contains(&shadowed), "{shadowed} of {tone}");
        }
        let color = hatch_color(tone, DVec3::new(0.9, 0.5, 0.2), DVec3::new(0.1, 0.0, 0.2));
        prop_assert!(color.is_finite() && color.min_element() >= 0.0 && color.max_element() <= 1.0, "{color}");
    }

    /// The inverse of the transfer curve exists for any tones and gives the requested tone or the nearest possible
    /// one.
    #[test]
    fn any_tone_is_reached((light, dark) in tones(), tone in 0.0..1.0f64) {
        let factor = hatch_level_of_tone(light, dark, tone);
        prop_assert!((1.0..=7.0).contains(&factor), "{factor}");
        let tones = [1.0, light.x, light.y, light.z, dark.x, dark.y, dark.z];
        // Two equal tones have no factor between them.
        prop_assume!(tones.windows(2).all(|pair| pair[0] - pair[1] > 1e-6));
        let found = hatch_transfer(light, dark, factor);
        prop_assert!((found - tone.max(dark.z)).abs() < 1e-9, "{found} in place of {tone}");
    }

    /// For any texels of six tones and weights of any sum, a blend is within 0..=1.
    #[test]
    fn a_blend_is_a_tone(texels in prop::array::uniform6(0.0..=1.0f64), weights in prop::array::uniform6(0.0..=4.0f64)) {
        let three = |of: &[f64]| DVec3::from_slice(of);
        let weights = HatchWeights { light: three(&weights), dark: three(&weights[3..]) };
        let tone = hatch_blend(three(&texels), three(&texels[3..]), weights);
        prop_assert!((0.0..=1.0).contains(&tone), "{tone}");
    }
}

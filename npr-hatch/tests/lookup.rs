//! Lookups preserve the tone at any level, for any footprint, and where hatchings overlap.
#![allow(clippy::print_stdout)]

use glam::{DVec2, DVec3, UVec2};
use npr_hatch::lookup::{
    HATCH_MAX_ANISOTROPY, HATCH_SPREAD, HatchFootprint, HatchTaps, hatch_footprint, hatch_ink, hatch_soft_tone,
    hatch_taps, hatch_texels,
};
use npr_hatch::mapping::{hatch_offset, hatch_rotate, hatch_share_tone};
use npr_hatch::{
    Drawing, TamParameters, Thresholds, draw, hatch_blend, hatch_level_of_tone, hatch_threshold, hatch_weights,
};
use oorandom::Rand64;
use std::f64::consts::{PI, SQRT_2};
use std::sync::LazyLock;

const SIDE: u32 = 128;

static MAP: LazyLock<(Drawing, Thresholds)> = LazyLock::new(|| map(SIDE));

fn map(side: u32) -> (Drawing, Thresholds) {
    let parameters = TamParameters { side, ..TamParameters::default() };
    let drawing = draw(&parameters, None).unwrap();
    let thresholds = Thresholds::new(&drawing, &parameters, None);
    (drawing, thresholds)
}

/// Jittered positions in a tile, one in each cell of a grid.
fn places(random: &mut Rand64, across: u32) -> Vec<DVec2> {
    let mut place = |i: u32| (f64::from(i) + random.rand_float()) / f64::from(across);
    (0..across * across).map(|i| DVec2::new(place(i % across), place(i / across))).collect()
}

fn mean(places: &[DVec2], value: impl Fn(DVec2) -> f64) -> f64 {
    places.iter().map(|&uv| value(uv)).sum::<f64>() / places.len() as f64
}

/// One position in each texel, at the same offset. For linear filtering their mean is the mean over all positions.
fn places_in_texels(in_texel: DVec2) -> Vec<DVec2> {
    let place = |i: u32| DVec2::new(f64::from(i % SIDE), f64::from(i / SIDE));
    (0..SIDE * SIDE).map(|i| (place(i) + in_texel) / f64::from(SIDE)).collect()
}

const fn at(level: f64) -> HatchFootprint {
    HatchFootprint { level, spread: DVec2::ZERO }
}

/// Typical levels and footprints.
fn footprints() -> [HatchFootprint; 5] {
    let spread = |level, x, y| HatchFootprint { level, spread: DVec2::new(x, y) };
    [at(0.0), at(0.4), at(1.7), spread(2.0, 0.02, 0.013), spread(2.6, -0.01, 0.04)]
}

#[test]
fn the_mean_of_a_filtered_picture_is_the_tone() {
    let (drawing, thresholds) = &*MAP;
    let places = places_in_texels(DVec2::new(0.23, 0.81));
    let six = |level| {
        let tone = |i: usize| drawing.tam.mean(i, level);
        (DVec3::new(tone(0), tone(1), tone(2)), DVec3::new(tone(3), tone(4), tone(5)))
    };
    let (mut worst_six, mut worst_ink) = (0.0_f64, 0.0_f64);
    for footprint in footprints() {
        let texels: Vec<_> = places.iter().map(|&uv| hatch_texels(&drawing.tam, uv, footprint)).collect();
        for step in 0..=20 {
            let tone = f64::from(step) / 20.0;
            let found = mean(&places, |uv| 1.0 - hatch_ink(thresholds, uv, footprint, tone, 1.0 / 64.0));
            worst_ink = worst_ink.max((found - tone).abs());
            let reachable = tone.max(1.0 / 7.0);
            let (light, dark) = six(0);
            let weights = hatch_weights(hatch_level_of_tone(light, dark, reachable));
            let found = texels.iter().map(|&(light, dark)| hatch_blend(light, dark, weights)).sum::<f64>();
            worst_six = worst_six.max((found / texels.len() as f64 - reachable).abs());
        }
    }
    println!("thresholds {worst_ink:.5}, six tones {worst_six:.5}");
    assert!(worst_ink < 0.005 && worst_six < 0.005, "{worst_ink}, {worst_six}");
}

#[test]
fn thresholds_that_are_filtered_first_miss_the_tone() {
    let (_, thresholds) = &*MAP;
    let mut random = Rand64::new(1);
    let places = places(&mut random, 200);
    // Thresholds of level 0 filtered before the comparison, as a texture unit would.
    let filtered = |uv: DVec2| {
        let taps = hatch_taps(uv, SIDE);
        let texel = |x: u32, y: u32| f64::from(thresholds.levels[0][(y * SIDE + x) as usize]) / 65535.0;
        let row = |y| texel(taps.low.x, y) * (1.0 - taps.share.x) + texel(taps.high.x, y) * taps.share.x;
        row(taps.low.y) * (1.0 - taps.share.y) + row(taps.high.y) * taps.share.y
    };
    let worst = (1..20).map(|step| {
        let tone = f64::from(step) / 20.0;
        (mean(&places, |uv| 1.0 - hatch_threshold(filtered(uv), tone, 0.05)) - tone).abs()
    });
    let worst = worst.fold(0.0, f64::max);
    println!("{worst:.4}");
    assert!(worst > 0.02, "{worst}: then comparing first gains nothing");
}

/// The strokes of different hatchings are independent only approximately, the better the more strokes a map has: with
/// 128 texels the error is nearly twice as large.
#[test]
fn hatchings_that_meet_have_the_tone_together() {
    let (_, thresholds) = &map(256);
    let mut random = Rand64::new(1);
    let places = places(&mut random, 200);
    let places: Vec<DVec2> = places.iter().map(|p| *p * 3.0).collect();
    let footprint = at(0.7);
    for share in [0.1, 0.3, 0.5] {
        let mut worst = [0.0_f64; 3];
        for step in 1..10 {
            let tone = f64::from(step) / 10.0;
            let paper = |uv: DVec2, share| {
                1.0 - hatch_ink(thresholds, uv, footprint, hatch_share_tone(tone, share), 1.0 / 64.0)
            };
            let turned = |uv: DVec2, turn: i32| hatch_rotate(uv, turn) + hatch_offset(turn);
            let both = [
                // Two planes that share an axis.
                mean(&places, |uv| paper(uv, share) * paper(uv + hatch_offset(1), 1.0 - share)),
                mean(&places, |uv| paper(turned(uv, 3), share) * paper(turned(uv, 4), 1.0 - share)),
                mean(&places, |uv| paper(uv, share) * paper(uv * 2.0, 1.0 - share)),
            ];
            for (worst, found) in worst.iter_mut().zip(both) {
                *worst = if (found - tone).abs() > worst.abs() { found - tone } else { *worst };
            }
        }
        println!("share {share}: planes {:.4}, turns {:.4}, scales {:.4}", worst[0], worst[1], worst[2]);
        assert!(worst.iter().all(|worst| worst.abs() < 0.015), "share {share}: {worst:?}");
    }
}

/// The derivatives of texture coordinates for a footprint with these axes in texels of level 0, the first at an
/// angle, on a screen rotated by another angle.
fn derivatives(axes: [f64; 2], angle: f64, screen: f64, texels: f64) -> (DVec2, DVec2) {
    let (long, short) = (DVec2::from_angle(angle) * axes[0], DVec2::from_angle(angle).perp() * axes[1]);
    let (sin, cos) = screen.sin_cos();
    ((long * cos + short * sin) / texels, (short * cos - long * sin) / texels)
}

/// The tensor s sᵀ / |s|, which does not depend on the sign.
fn line(s: DVec2) -> DVec3 {
    DVec3::new(s.x * s.x, s.x * s.y, s.y * s.y) / s.length().max(1e-300)
}

#[test]
fn a_square_footprint_has_the_level_of_its_side() {
    for (texels, last) in [(256.0, 8.0), (100.0, 9.0)] {
        for number in 0..=80 {
            let level = f64::from(number) / 10.0;
            for screen in [0.0, 0.3, 1.9] {
                let (dx, dy) = derivatives([level.exp2(); 2], 0.7, screen, texels);
                let found = hatch_footprint(dx, dy, texels, last);
                assert!((found.level - level).abs() < 1e-9 && found.spread == DVec2::ZERO, "{level}: {found:?}");
            }
        }
    }
    // The finest level for magnification, and the coarsest beyond the last.
    assert_eq!(hatch_footprint(DVec2::X * 0.001, DVec2::Y * 0.001, 256.0, 8.0), at(0.0));
    assert_eq!(hatch_footprint(DVec2::X * 100.0, DVec2::Y * 100.0, 256.0, 8.0), at(8.0));
}

#[test]
fn a_long_footprint_has_the_level_of_its_area_and_is_spread() {
    let texels = 256.0;
    for ratio in [1.0, 1.5, 1.999, 2.001, 3.0, 8.0, 15.9, 16.1, 40.0, 1e4] {
        for short in [1.5, 4.0] {
            let long: f64 = short * ratio;
            for angle in [0.0, 0.4, PI / 2.0, 2.0, 3.0] {
                for screen in [0.0, 1.0, 2.5] {
                    let (dx, dy) = derivatives([long, short], angle, screen, texels);
                    let found = hatch_footprint(dx, dy, texels, 20.0);
                    let expected =
                        if ratio <= HATCH_MAX_ANISOTROPY { 0.5 * (long * short).log2() } else { long.log2() - 2.0 };
                    assert!((found.level - expected).abs() < 1e-9, "{ratio}: {found:?}, not {expected}");
                    if ratio <= 2.0 {
                        assert_eq!(found.spread, DVec2::ZERO, "{ratio}");
                        continue;
                    }
                    // In texels of that level, along the longer axis.
                    let length = ratio.min(HATCH_MAX_ANISOTROPY).sqrt() - SQRT_2;
                    let expected = line(DVec2::from_angle(angle) * length);
                    let found = line(found.spread) * texels / found.level.exp2();
                    assert!((found - expected).abs().max_element() < 1e-6, "{ratio}, {angle}: {found}, not {expected}");
                }
            }
        }
    }
}

/// Rotating texture coordinates rotates the spread; rotating the screen has no effect.
#[test]
fn footprints_turn_with_their_coordinates() {
    let mut random = Rand64::new(2);
    let mut number = || random.rand_float() * 2.0 - 1.0;
    for _ in 0..1000 {
        let (dx, dy) = (DVec2::new(number(), number()), DVec2::new(number(), number()));
        let straight = hatch_footprint(dx, dy, 64.0, 6.0);
        let turn = DVec2::from_angle(4.0 * number());
        let turned = hatch_footprint(turn.rotate(dx), turn.rotate(dy), 64.0, 6.0);
        assert!((turned.level - straight.level).abs() < 1e-9);
        let expected = line(turn.rotate(straight.spread));
        assert!((line(turned.spread) - expected).abs().max_element() < 1e-6, "{turned:?}, not {expected}");
        let screen = hatch_footprint(dx * turn.x + dy * turn.y, dy * turn.x - dx * turn.y, 64.0, 6.0);
        assert!((screen.level - straight.level).abs() < 1e-9);
        assert!((line(screen.spread) - line(straight.spread)).abs().max_element() < 1e-6);
    }
}

/// Samples stay within the pixel: where texels are larger than the pixel, there is no spread.
#[test]
fn a_footprint_within_a_texel_is_not_spread() {
    for long in [0.001, 0.1, 1.0, SQRT_2] {
        for ratio in [3.0, 10.0, 100.0] {
            let (dx, dy) = derivatives([long, long / ratio], 0.3, 0.0, 256.0);
            assert_eq!(hatch_footprint(dx, dy, 256.0, 8.0), at(0.0), "{long}, {ratio}");
        }
    }
    // The distance between the outermost samples never exceeds the longer axis.
    let mut random = Rand64::new(3);
    for _ in 0..10_000 {
        let long = 10.0_f64.powf(6.0 * random.rand_float() - 2.0);
        let ratio = 10.0_f64.powf(3.0 * random.rand_float());
        let (dx, dy) = derivatives([long, long / ratio], 4.0 * random.rand_float(), random.rand_float(), 256.0);
        let found = hatch_footprint(dx, dy, 256.0, 8.0);
        assert!(found.spread.length() * 256.0 <= long, "{long}, {ratio}: {found:?}");
    }
}

#[test]
fn footprints_of_anything_are_footprints() {
    let x = DVec2::new(0.1, 0.03);
    for (dx, dy) in [(x, DVec2::ZERO), (DVec2::ZERO, x), (x * 0.6, x * -0.8)] {
        // A degenerate footprint: only its length matters.
        let found = hatch_footprint(dx, dy, 256.0, 8.0);
        assert!((found.level - ((x.length() * 256.0).log2() - 2.0)).abs() < 1e-9, "{found:?}");
        let expected = line(x.normalize() * (4.0 - SQRT_2) * found.level.exp2() / 256.0);
        assert!((line(found.spread) - expected).abs().max_element() < 1e-9, "{found:?}");
    }
    assert_eq!(hatch_footprint(DVec2::ZERO, DVec2::ZERO, 256.0, 8.0), at(0.0));
    let odd = [0.0, 1.0, -0.1, 1e-200, -1e200, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
    for number in 0..odd.len().pow(4) {
        let [a, b, c, d] = [1, 8, 64, 512].map(|part| odd[number / part % 8]);
        let found = hatch_footprint(DVec2::new(a, b), DVec2::new(c, d), 256.0, 8.0);
        assert!((0.0..=8.0).contains(&found.level), "{a} {b} {c} {d}: {found:?}");
        assert!(found.spread.is_finite(), "{a} {b} {c} {d}: {found:?}");
    }
}

#[test]
fn taps_wrap() {
    let taps = |u: f64, v: f64, side| hatch_taps(DVec2::new(u, v), side);
    let expected = |low: [u32; 2], high: [u32; 2], x, y| HatchTaps {
        low: UVec2::from(low),
        high: UVec2::from(high),
        share: DVec2::new(x, y),
    };
    // At a texel's centre only that texel has weight.
    assert_eq!(taps(0.125, 0.875, 4), expected([0, 3], [1, 0], 0.0, 0.0));
    assert_eq!(taps(-0.125, -4.875, 4), expected([3, 0], [0, 1], 0.0, 0.0));
    // At a texel's corner four texels have equal weight.
    assert_eq!(taps(0.0, 1.0, 4), expected([3, 3], [0, 0], 0.5, 0.5));
    assert_eq!(taps(0.5, -0.5, 4), expected([1, 1], [2, 2], 0.5, 0.5));
    assert_eq!(taps(0.1875, -2.6875, 4), expected([0, 0], [1, 1], 0.25, 0.75));
    // A level of one texel, and coordinates that are not finite.
    assert_eq!(taps(7.3, -0.5, 1).low, UVec2::ZERO);
    assert_eq!(taps(7.3, -0.5, 1).high, UVec2::ZERO);
    let nowhere = taps(f64::NAN, f64::INFINITY, 4);
    assert!(nowhere.low.max_element() < 4 && nowhere.high.max_element() < 4);
    let mut random = Rand64::new(4);
    for _ in 0..1000 {
        // In 1/64 texel, so that sums are exact.
        let place = DVec2::new(random.rand_range(0..1024) as f64, random.rand_range(0..1024) as f64) / 1024.0;
        let here = hatch_taps(place, 16);
        assert!(here.share.min_element() >= 0.0 && here.share.max_element() < 1.0);
        assert_eq!(hatch_taps(place + DVec2::new(5.0, -7.0), 16), here);
    }
}

/// By hand: levels of 2 × 2 and of one texel, with thresholds on both sides of a tone of 0.5.
#[test]
fn ink_is_filtered_over_texels_levels_and_samples() {
    let map = Thresholds { side: 2, levels: vec![vec![65535, 0, 0, 65535], vec![65535]] };
    let ink = |u, v, footprint| hatch_ink(&map, DVec2::new(u, v), footprint, 0.5, 0.0);
    assert_eq!([(0.25, 0.25), (0.75, 0.25)].map(|(u, v)| ink(u, v, at(0.0))), [1.0, 0.0]);
    assert_eq!([(0.25, 0.75), (-0.25, 7.75)].map(|(u, v)| ink(u, v, at(0.0))), [0.0, 1.0]);
    assert_eq!([(0.5, 0.25), (0.5, 0.5), (0.375, 0.25)].map(|(u, v)| ink(u, v, at(0.0))), [0.5, 0.5, 0.75]);
    assert_eq!([0.0, 0.25, 1.0].map(|level| ink(0.75, 0.25, at(level))), [0.0, 0.25, 1.0]);
    // Samples at 3/8 and 1/8 of the texture on both sides: 0.75 and 0.25 texels.
    let spread = HatchFootprint { level: 0.0, spread: DVec2::X };
    assert_eq!(HATCH_SPREAD.map(|along| ink(0.25 + along, 0.25, at(0.0))), [0.25, 0.75, 0.75, 0.25]);
    assert_eq!(ink(0.25, 0.25, spread), 0.5);
}

#[test]
fn texels_are_filtered_over_texels_levels_and_samples() {
    let (drawing, _) = &*MAP;
    let tam = &drawing.tam;
    let texel = |level: usize, x: u32, y: u32| {
        let side = tam.level_side(level);
        let value = |tone| f64::from(tam.image(tone, level)[(y % side * side + x % side) as usize]) / 255.0;
        [DVec3::new(value(0), value(1), value(2)), DVec3::new(value(3), value(4), value(5))]
    };
    let found = |uv, footprint| <[DVec3; 2]>::from(hatch_texels(tam, uv, footprint));
    let near = |a: [DVec3; 2], b: [DVec3; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs().max_element() < 1e-12);
    let mut random = Rand64::new(5);
    for _ in 0..1000 {
        let level = random.rand_range(0..7) as usize;
        let side = tam.level_side(level);
        let (x, y) = (random.rand_range(0..256) as u32 % side, random.rand_range(0..256) as u32 % side);
        let centre = (DVec2::new(f64::from(x), f64::from(y)) + 0.5) / f64::from(side);
        let fine = at(level as f64);
        assert!(near(found(centre, fine), texel(level, x, y)));
        assert!(near(found(centre - 2.0, fine), texel(level, x, y)));
        let share = random.rand_float();
        let across = centre + DVec2::X * share / f64::from(side);
        let [[a, b], [c, d]] = [texel(level, x, y), texel(level, x + 1, y)];
        assert!(near(found(across, fine), [a.lerp(c, share), b.lerp(d, share)]));
        let [[a, b], [c, d]] = [found(centre, fine), found(centre, at(level as f64 + 1.0))];
        assert!(near(found(centre, at(level as f64 + share)), [a.lerp(c, share), b.lerp(d, share)]));
        let spread = DVec2::new(random.rand_float() - 0.5, random.rand_float() - 0.5);
        let samples = HATCH_SPREAD.map(|along| found(centre + spread * along, fine));
        let mean = [0, 1].map(|half| samples.iter().map(|sample| sample[half]).sum::<DVec3>() / 4.0);
        assert!(near(found(centre, HatchFootprint { level: fine.level, spread }), mean));
    }
}

/// With evenly distributed thresholds, as in a large map.
#[test]
fn a_soft_edge_keeps_the_mean_up_to_white_and_black() {
    let thresholds = 65536;
    for width in [1.0 / 64.0, 0.1, 0.5, 1.0] {
        for tone in [0.0, 1e-4, 0.003, 0.02, 0.2, 0.5, 0.77, 0.99, 0.9999, 1.0] {
            let at = hatch_soft_tone(tone, width);
            let ink = |i: i32| hatch_threshold((f64::from(i) + 0.5) / f64::from(thresholds), at, width);
            let paper = 1.0 - (0..thresholds).map(ink).sum::<f64>() / f64::from(thresholds);
            assert!((paper - tone).abs() < 1e-8, "{width}, {tone}: {paper}");
        }
    }
    assert_eq!((hatch_soft_tone(0.4, 0.0), hatch_soft_tone(1.2, 0.0), hatch_soft_tone(-0.1, 0.2)), (0.4, 1.0, -0.2));
}

/// For all thresholds including the extremes 0 and 65535, to which those of a large map round.
#[test]
fn white_is_clean_and_black_is_solid() {
    let ends = Thresholds { side: 2, levels: vec![vec![0, 1, 65534, 65535], vec![32768]] };
    let mut random = Rand64::new(6);
    let places = places(&mut random, 40);
    for map in [&ends, &MAP.1] {
        for mut footprint in footprints() {
            footprint.level = footprint.level.min(f64::from(map.side.trailing_zeros()));
            for width in [0.0, 1.0 / 64.0, 0.3] {
                for uv in &places {
                    let ink = |tone| hatch_ink(map, *uv * 2.0, footprint, tone, width);
                    assert_eq!((ink(1.0), ink(1.5)), (0.0, 0.0), "white at {uv}, {footprint:?}");
                    assert_eq!((ink(0.0), ink(-0.5)), (1.0, 1.0), "black at {uv}, {footprint:?}");
                }
            }
        }
    }
}

//! Lookups keep the tone: at any level, along any footprint, and where hatchings meet.
#![allow(clippy::print_stdout)]

use glam::{DVec2, DVec3};
use npr_hatch::lookup::{HatchFootprint, hatch_footprint, hatch_ink, hatch_taps, hatch_texels};
use npr_hatch::mapping::{
    HATCH_TURNS, hatch_doubled, hatch_moved, hatch_octave, hatch_plane, hatch_plane_weights, hatch_share, hatch_turn,
    hatch_turned,
};
use npr_hatch::{Drawing, TamParameters, Thresholds, draw, hatch_blend, hatch_linear, hatch_threshold, hatch_weights};
use oorandom::Rand64;
use std::f64::consts::PI;

fn map(side: u32) -> (Drawing, Thresholds) {
    let parameters = TamParameters { side, ..TamParameters::default() };
    let drawing = draw(&parameters, None).unwrap();
    let thresholds = Thresholds::new(&drawing, &parameters, None);
    (drawing, thresholds)
}

/// Places in a tile, one in each cell of a grid, and each somewhere else in its cell.
fn places(random: &mut Rand64, across: u32) -> Vec<DVec2> {
    let mut place = |i: u32| (f64::from(i) + random.rand_float()) / f64::from(across);
    (0..across * across).map(|i| DVec2::new(place(i % across), place(i / across))).collect()
}

fn mean(places: &[DVec2], value: impl Fn(DVec2) -> f64) -> f64 {
    places.iter().map(|&uv| value(uv)).sum::<f64>() / places.len() as f64
}

/// Levels and footprints that pictures have.
fn footprints() -> [HatchFootprint; 5] {
    let at = |level, spread| HatchFootprint { level, spread };
    [
        at(0.0, DVec2::ZERO),
        at(0.4, DVec2::ZERO),
        at(1.7, DVec2::ZERO),
        at(2.0, DVec2::new(0.02, 0.013)),
        at(2.6, DVec2::new(-0.01, 0.04)),
    ]
}

#[test]
fn the_mean_of_a_filtered_picture_is_the_tone() {
    let (drawing, thresholds) = map(256);
    let mut random = Rand64::new(1);
    let places = places(&mut random, 300);
    let six = |level| {
        let tone = |i: usize| drawing.tam.mean(i, level);
        (DVec3::new(tone(0), tone(1), tone(2)), DVec3::new(tone(3), tone(4), tone(5)))
    };
    let (mut worst_six, mut worst_ink) = (0.0_f64, 0.0_f64);
    for footprint in footprints() {
        for step in 0..=20 {
            let tone = f64::from(step) / 20.0;
            let found = mean(&places, |uv| 1.0 - hatch_ink(&thresholds, uv, footprint, tone, 1.0 / 64.0));
            worst_ink = worst_ink.max((found - tone).abs());
            let reachable = tone.max(1.0 / 7.0);
            let (light, dark) = six(0);
            let weights = hatch_weights(hatch_linear(light, dark, reachable));
            let found = mean(&places, |uv| {
                let (light, dark) = hatch_texels(&drawing.tam, uv, footprint);
                hatch_blend(light, dark, weights)
            });
            worst_six = worst_six.max((found - reachable).abs());
        }
    }
    println!("thresholds {worst_ink:.5}, six tones {worst_six:.5}");
    assert!(worst_ink < 0.005 && worst_six < 0.005, "{worst_ink}, {worst_six}");
}

#[test]
fn thresholds_that_are_filtered_first_miss_the_tone() {
    let (_, thresholds) = map(256);
    let mut random = Rand64::new(1);
    let places = places(&mut random, 300);
    // Of level 0, as a texture unit would.
    let filtered = |uv: DVec2| {
        let taps = hatch_taps(uv, 256);
        let texel = |x: u32, y: u32| f64::from(thresholds.levels[0][(y * 256 + x) as usize]) / 65535.0;
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

#[test]
fn hatchings_that_meet_have_the_tone_together() {
    let (_, thresholds) = map(256);
    let mut random = Rand64::new(1);
    let places = places(&mut random, 600);
    let places: Vec<DVec2> = places.iter().map(|p| *p * 3.0).collect();
    let footprint = HatchFootprint { level: 0.7, spread: DVec2::ZERO };
    for share in [0.1, 0.3, 0.5] {
        let mut worst = [0.0_f64; 3];
        for step in 1..20 {
            let tone = f64::from(step) / 20.0;
            let paper =
                |uv: DVec2, share| 1.0 - hatch_ink(&thresholds, uv, footprint, hatch_share(tone, share), 1.0 / 64.0);
            let turned = |uv: DVec2, turn: i32| hatch_turned(uv, turn) + hatch_moved(turn);
            let both = [
                // Two planes that share an axis.
                mean(&places, |uv| paper(uv, share) * paper(uv + hatch_moved(1), 1.0 - share)),
                mean(&places, |uv| paper(turned(uv, 3), share) * paper(turned(uv, 4), 1.0 - share)),
                mean(&places, |uv| paper(uv, share) * paper(uv * 2.0, 1.0 - share)),
            ];
            for (worst, found) in worst.iter_mut().zip(both) {
                *worst = if (found - tone).abs() > worst.abs() { found - tone } else { *worst };
            }
        }
        println!("share {share}: planes {:.4}, turns {:.4}, scales {:.4}", worst[0], worst[1], worst[2]);
    }
}

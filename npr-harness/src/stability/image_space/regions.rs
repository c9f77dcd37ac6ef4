//! Regions whose codes are equal.

use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::image_lines::gbuffer::texel::gbuffer_region_sum;
use crate::picture::Image;
use crate::stability::ink::{Random, beside, curve, limit_at, picture_of};
use crate::stability::{Axis, Finding, Sweep};
use glam::UVec2;
use npr_imagespace::filter::region::ink_region;
use npr_imagespace::format::texel::{TexelLayout, ink_fold_region};
use npr_imagespace::picture::{Taps, filter_picture};
use npr_imagespace::region::ink_region_pair;
use std::collections::HashSet;

pub(super) const REGION_CODES: Sweep = Sweep {
    name: "region-codes",
    technique: "image lines",
    what: "Two neighbouring regions whose numbers have the same code have no border. Consecutive numbers keep apart until \
           the codes are used up; sums of colours and hashes are equal by chance long before.",
    needs_adapter: false,
    run: region_codes,
};

/// How many regions from a number on have different codes: one more than these do not.
fn first_collision(start: u32, code: &dyn Fn(u32) -> u32) -> u32 {
    let mut seen = HashSet::new();
    (0..).find(|&count| !seen.insert(code(start + count))).unwrap_or(u32::MAX)
}

/// The mean of [`first_collision`] over many starts.
fn mean_collision(code: &dyn Fn(u32) -> u32) -> f64 {
    const STARTS: u32 = 64;
    (0..STARTS).map(|start| f64::from(first_collision(1 + 100_003 * start, code))).sum::<f64>() / f64::from(STARTS)
}

fn region_codes(_: &Executor) -> Result<Finding, HarnessError> {
    let folded = |most: u32| move |region: u32| ink_fold_region(region, most);
    // A patch, and a colour of its texture.
    let hashed = |region: u32| ink_region_pair(1 + region % 37, 1 + (Random(u64::from(region)).bits() >> 40) as u32);
    let (small, large) = (TexelLayout::Bits32, TexelLayout::Bits64);
    let (eight, six) = (folded(small.region_max()), folded(small.shadowed_region_max()));
    let twenty_four = folded(large.region_max());
    let codes: [(&str, &dyn Fn(u32) -> u32); 5] = [
        ("sums of colours, as printed", &gbuffer_region_sum),
        ("8 bits, two for shadow", &six),
        ("8 bits", &eight),
        ("24-bit hash of a pair", &hashed),
        ("24 bits", &twenty_four),
    ];
    let mut curves = Vec::new();
    for (name, code) in codes {
        let mut random = Random(15);
        let points = (1..=24).map(|bits| {
            const BORDERS: u32 = 4000;
            let regions = 1u64 << bits;
            let lost = (0..BORDERS).filter(|_| {
                let a = random.bits() % regions;
                let b = (a + 1 + random.bits() % (regions - 1)) % regions;
                code(1 + a as u32) == code(1 + b as u32)
            });
            (regions as f64, 100.0 * lost.count() as f64 / f64::from(BORDERS))
        });
        let points = points.collect();
        let what = "regions of which no two have the same code";
        // The mean number of draws before one repeats (the birthday problem).
        let birthday = |codes: f64| (std::f64::consts::FRAC_PI_2 * codes).sqrt();
        let pigeonhole = "the number of codes";
        let limit = match name {
            "sums of colours, as printed" => {
                // Three channels of 64 levels: their sum is nearly normal, and two are equal with 1 / (2 √π σ).
                let deviation = (3.0 * (64.0f64 * 64.0 - 1.0) / 12.0).sqrt();
                let codes = 2.0 * std::f64::consts::PI.sqrt() * deviation;
                limit_at(what, mean_collision(code), Bound::AtLeast(13.0)).predicted(
                    birthday(codes),
                    "√(π/2 · 2 √π σ): birthdays among sums of three channels of 64 levels, deviation σ",
                )
            }
            "24-bit hash of a pair" => limit_at(what, mean_collision(code), Bound::AtLeast(5200.0))
                .predicted(birthday(16_777_215.0), "√(π/2 · 2²⁴): birthdays among 24-bit codes"),
            "24 bits" => {
                // The first number that has the code of the first.
                let all = (2u32..).find(|&region| code(region) == code(1)).unwrap_or(u32::MAX) - 1;
                limit_at(what, f64::from(all), Bound::AtLeast(16_777_215.0)).predicted(16_777_215.0, pigeonhole)
            }
            _ => {
                let codes = if name == "8 bits" { 255.0 } else { 63.0 };
                limit_at(what, f64::from(first_collision(1, code)), Bound::AtLeast(codes)).predicted(codes, pigeonhole)
            }
        };
        curves.push(curve(name, points, limit));
    }
    Ok(Finding {
        parameter: Axis::logarithmic("number of regions", ""),
        error: Axis::linear("borders lost between two regions at random", "%"),
        curves,
        pictures: vec![(
            "Tiles whose numbers grow by 255 from column to column: borders of 24-bit numbers, and of 8-bit ones, which are \
             the same in each column."
                .into(),
            beside(&[tiles(&twenty_four, 255), tiles(&eight, 255)]),
        ), (
            "140 tiles: borders of numbers, and of sums of colours as printed, three of which are lost."
                .into(),
            beside(&[tiles(&twenty_four, 1), tiles(&gbuffer_region_sum, 1)]),
        )],
    })
}

/// The borders of a sheet of tiles, each a region.
fn tiles(code: &dyn Fn(u32) -> u32, per_column: u32) -> Image {
    const SIZE: UVec2 = UVec2::new(156, 110);
    const TILE_PX: u32 = 11;
    let number = |pixel: u32| {
        let (column, row) = (pixel % SIZE.x / TILE_PX, pixel / SIZE.x / TILE_PX);
        1 + per_column * column + if per_column == 1 { 14 * row } else { row % 5 }
    };
    let codes: Vec<u32> = (0..SIZE.x * SIZE.y).map(|pixel| code(number(pixel))).collect();
    let ink = filter_picture(&codes, SIZE, Taps::Cross, |centre, taps| ink_region(centre, taps, false, 1.0) as f32);
    picture_of(&ink.expect("one for each pixel"), SIZE.x)
}

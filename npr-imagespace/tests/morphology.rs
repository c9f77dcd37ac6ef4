//! Discs against brute force, steps against their definitions, floods against discs.
#![allow(clippy::print_stdout)]

use glam::{IVec2, UVec2};
use npr_imagespace::ImageSpaceError;
use npr_imagespace::morphology::disc::{Disc, DiscBuffers, LINE, dilate_disc, erode_disc};
use npr_imagespace::morphology::flood::{
    FloodPass, FloodPlan, flood, ink_flood_seed, ink_flood_take, ink_flood_vector,
};
use npr_imagespace::morphology::*;
use proptest::prelude::*;

/// The definition of the disc, pixel by pixel.
fn brute_disc(ink: &[u8], size: UVec2, disc: &Disc) -> Vec<u8> {
    let (width, height) = (size.x as i64, size.y as i64);
    let radius = f64::from(disc.radius_px);
    let lines: Vec<(i64, i64)> =
        (0..width * height).filter(|&i| ink[i as usize] >= LINE).map(|i| (i % width, i / width)).collect();
    (0..width * height)
        .map(|i| {
            let (x, y) = (i % width, i / width);
            let square = lines.iter().map(|&(u, v)| (x - u).pow(2) + (y - v).pow(2)).min();
            let Some(distance) = square.map(|square| (square as f64).sqrt()) else { return 0 };
            if disc.antialias {
                ((radius + 1.0 - distance).clamp(0.0, 1.0) * 255.0 + 0.5) as u8
            } else if square.unwrap() as f64 <= radius * radius {
                255
            } else {
                0
            }
        })
        .collect()
}

fn dilated(ink: &[u8], size: UVec2, disc: &Disc) -> Vec<u8> {
    let mut out = vec![7; 3];
    dilate_disc(ink, size, disc, &mut DiscBuffers::default(), &mut out).unwrap();
    out
}

fn picture() -> impl Strategy<Value = (UVec2, Vec<u8>)> {
    (1u32..40, 1u32..40, 0u32..60).prop_flat_map(|(width, height, rarity)| {
        let pixel = (0..=rarity, any::<u8>()).prop_map(|(chance, ink)| if chance == 0 { ink | 128 } else { ink & 127 });
        (Just(UVec2::new(width, height)), prop::collection::vec(pixel, (width * height) as usize))
    })
}

/// Each row with its own share of line pixels, from none to half.
fn wide_picture() -> impl Strategy<Value = (UVec2, Vec<u8>)> {
    (100u32..400, prop::collection::vec(prop::sample::select(vec![2u32, 12, 60, 300, 100_000]), 1..9)).prop_flat_map(
        |(width, rarities)| {
            let height = rarities.len() as u32;
            let draws = prop::collection::vec(any::<u32>(), (width * height) as usize);
            draws.prop_map(move |draws| {
                let ink = |(i, draw): (usize, u32)| u8::from(draw % rarities[i / width as usize] == 0) * 255;
                (UVec2::new(width, height), draws.into_iter().enumerate().map(ink).collect())
            })
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_disc_is_exact((size, ink) in picture(), radius_px in 0f32..30.0, whole: bool, antialias: bool) {
        let radius_px = if whole { radius_px.floor() } else { radius_px };
        let disc = Disc { radius_px, antialias };
        prop_assert_eq!(dilated(&ink, size, &disc), brute_disc(&ink, size, &disc), "{:?}", disc);
    }

    /// Rows long enough for gaps wider than the disc, beside rows full of borders.
    #[test]
    fn a_disc_is_exact_in_wide_pictures(
        (size, ink) in wide_picture(), radius_px in 0f32..30.0, antialias: bool,
    ) {
        let disc = Disc { radius_px, antialias };
        prop_assert_eq!(dilated(&ink, size, &disc), brute_disc(&ink, size, &disc), "{:?}", disc);
    }

    #[test]
    fn small_discs_are_exact((size, ink) in picture(), radius_px in 0f32..6.0) {
        let disc = Disc { radius_px, antialias: false };
        prop_assert_eq!(dilated(&ink, size, &disc), brute_disc(&ink, size, &disc), "{:?}", disc);
    }

    #[test]
    fn erosion_is_the_dilation_of_the_paper((size, ink) in picture(), radius_px in 0f32..9.0, antialias: bool) {
        let disc = Disc { radius_px, antialias };
        let mut eroded = Vec::new();
        erode_disc(&ink, size, &disc, &mut DiscBuffers::default(), &mut eroded).unwrap();
        let paper: Vec<u8> = ink.iter().map(|ink| !ink).collect();
        let expected: Vec<u8> = brute_disc(&paper, size, &disc).iter().map(|ink| !ink).collect();
        prop_assert_eq!(eroded, expected);
    }

    #[test]
    fn opening_and_closing_are_idempotent_and_bound(
        (size, ink) in picture(), steps in 0u32..4, square: bool,
    ) {
        let kernel = if square { Kernel::Square } else { Kernel::Cross };
        for operation in [Operation::Open, Operation::Close] {
            let once = ping_pong(&ink, size, kernel, operation, steps).unwrap();
            prop_assert_eq!(&ping_pong(&once, size, kernel, operation, steps).unwrap(), &once);
            let bound = once.iter().zip(&ink).all(|(a, b)| if operation == Operation::Open { a <= b } else { a >= b });
            prop_assert!(bound, "{:?}", operation);
        }
    }

    #[test]
    fn a_step_is_the_extreme_of_its_kernel((size, ink) in picture(), eroding: bool) {
        for (kernel, offsets) in kernels() {
            let at = |x: i32, y: i32| {
                let inside = x >= 0 && y >= 0 && x < size.x as i32 && y < size.y as i32;
                inside.then(|| ink[(y * size.x as i32 + x) as usize])
            };
            let mut out = Vec::new();
            if eroding { erode(&ink, size, kernel, &mut out) } else { dilate(&ink, size, kernel, &mut out) }.unwrap();
            for y in 0..size.y as i32 {
                for x in 0..size.x as i32 {
                    let taps = offsets.iter().filter_map(|o| at(x + o.x, y + o.y));
                    let expected = if eroding { taps.min().unwrap_or(255) } else { taps.max().unwrap_or(0) };
                    prop_assert_eq!(out[(y * size.x as i32 + x) as usize], expected, "{:?} {} {}", kernel, x, y);
                }
            }
        }
    }

    /// A flood never finds what is not there, and a row's nearest is exact.
    #[test]
    fn a_flood_covers_no_more_than_the_disc((size, ink) in picture(), radius_px in 0f32..20.0, antialias: bool) {
        let disc = Disc { radius_px, antialias };
        let exact = dilated(&ink, size, &disc);
        let separable = [FloodPlan::separable(&disc, 1), FloodPlan::separable(&disc, 3), FloodPlan::fitted(&disc, 3)];
        for plan in separable.into_iter().chain([FloodPlan::square(&disc)]) {
            let flooded = flood(&ink, size, &disc, &plan).unwrap();
            for (i, (&f, &e)) in flooded.iter().zip(&exact).enumerate() {
                prop_assert!(f <= e.saturating_add(u8::from(antialias)), "{}: {} over {}", i, f, e);
            }
            if size.y == 1 {
                prop_assert!(flooded.iter().zip(&exact).all(|(&f, &e)| f.abs_diff(e) <= u8::from(antialias)));
            }
        }
    }
}

fn kernels() -> [(Kernel, Vec<IVec2>); 3] {
    let all: Vec<IVec2> = (-1..=1).flat_map(|y| (-1..=1).map(move |x| IVec2::new(x, y))).collect();
    let of = |keep: fn(&IVec2) -> bool| all.iter().copied().filter(keep).collect();
    [
        (Kernel::Diagonal, of(|o| o.x != 0 && o.y != 0)),
        (Kernel::Cross, of(|o| o.x == 0 || o.y == 0)),
        (Kernel::Square, of(|_| true)),
    ]
}

#[test]
fn wide_discs_that_bytes_cannot_hold_are_exact() {
    // Reaches beyond 255 px and beyond 32767 px squared, in pictures that are long in either direction.
    for size in [UVec2::new(700, 9), UVec2::new(9, 700), UVec2::new(90, 80), UVec2::new(170, 170)] {
        let mut ink = vec![0; (size.x * size.y) as usize];
        for at in [4 * size.x as usize + 3, ink.len() - 8] {
            ink[at] = 255;
        }
        for radius_px in
            [62.5, 124.0, 126.3, 128.75, 139.0, 178.0, 180.5, 252.9, 253.4, 254.0, 255.0, 256.5, 300.25, 32766.0]
        {
            for antialias in [false, true] {
                let disc = Disc { radius_px, antialias };
                assert_eq!(dilated(&ink, size, &disc), brute_disc(&ink, size, &disc), "{size} {disc:?}");
            }
        }
    }
}

#[test]
fn empty_and_full_pictures_stay() {
    let size = UVec2::new(33, 5);
    for radius_px in [0.0, 1.0, 7.5, 100.0] {
        for antialias in [false, true] {
            let disc = Disc { radius_px, antialias };
            assert_eq!(dilated(&[0; 165], size, &disc), [0; 165]);
            assert_eq!(dilated(&[255; 165], size, &disc), [255; 165]);
            let mut out = Vec::new();
            erode_disc(&[255; 165], size, &disc, &mut DiscBuffers::default(), &mut out).unwrap();
            assert_eq!(out, [255; 165], "the frame is eaten");
        }
    }
    assert_eq!(dilated(&[], UVec2::new(0, 4), &Disc { radius_px: 3.0, antialias: true }), []);
}

#[test]
fn buffers_carry_nothing_from_one_picture_to_the_next() {
    let (mut buffers, mut out) = (DiscBuffers::default(), Vec::new());
    let inks: [(UVec2, Vec<u8>); 3] = [
        (UVec2::new(50, 40), vec![255; 2000]),
        (UVec2::new(31, 7), (0..217).map(|i| if i == 100 { 255 } else { 0 }).collect()),
        (UVec2::new(60, 60), (0..3600).map(|i| if i % 311 == 0 { 255 } else { 0 }).collect()),
    ];
    for radius_px in [1.0, 4.0, 2.5, 300.0] {
        for antialias in [false, true] {
            for (size, ink) in &inks {
                let disc = Disc { radius_px, antialias };
                dilate_disc(ink, *size, &disc, &mut buffers, &mut out).unwrap();
                assert_eq!(out, brute_disc(ink, *size, &disc), "{size} {disc:?}");
            }
        }
    }
}

/// A line of one pixel becomes 2 r + 1 wide, whatever its fraction.
#[test]
fn a_line_gets_the_width_asked_for() {
    let size = UVec2::new(9, 61);
    let mut ink = vec![0; 9 * 61];
    ink[30 * 9..31 * 9].fill(255);
    for radius_px in [0.0f32, 0.25, 1.0, 1.5, 4.2, 20.75] {
        let out = dilated(&ink, size, &Disc { radius_px, antialias: true });
        let width: f64 = (0..61).map(|y| f64::from(out[y * 9 + 4]) / 255.0).sum();
        assert!((width - f64::from(2.0 * radius_px + 1.0)).abs() < 0.005, "{radius_px}: {width}");
    }
}

#[test]
fn bad_input_is_refused() {
    let (mut buffers, mut out) = (DiscBuffers::default(), Vec::new());
    let mut disc = |radius_px, ink: &[u8]| {
        dilate_disc(ink, UVec2::new(2, 2), &Disc { radius_px, antialias: false }, &mut buffers, &mut out)
    };
    assert_eq!(disc(1.0, &[0; 3]), Err(ImageSpaceError::Length { len: 3, size_px: UVec2::new(2, 2) }));
    assert!(matches!(disc(-0.5, &[0; 4]), Err(ImageSpaceError::Radius { .. })));
    assert!(matches!(disc(f32::NAN, &[0; 4]), Err(ImageSpaceError::Radius { .. })));
    assert!(matches!(disc(40000.0, &[0; 4]), Err(ImageSpaceError::Radius { .. })));
    assert!(dilate(&[0; 3], UVec2::new(2, 2), Kernel::Cross, &mut Vec::new()).is_err());
    let plan = FloodPlan { passes: Vec::new() };
    assert!(flood(&[0; 4], UVec2::new(2, 2), &Disc { radius_px: -1.0, antialias: true }, &plan).is_err());
}

/// What listing 5 does to a single pixel, and the slides' shader to one, two and three of five.
#[test]
fn printed_steps() {
    let size = UVec2::new(5, 5);
    let mut ink = vec![0; 25];
    ink[12] = 255;
    let mut out = Vec::new();
    dilate(&ink, size, Kernel::Diagonal, &mut out).unwrap();
    let inked: Vec<usize> = (0..25).filter(|&i| out[i] == 255).collect();
    assert_eq!(inked, [6, 8, 16, 18], "four, with a hole between them");
    // The slides' polarity: saturate(0.4 of the sum of the whites - 1).
    for lines in 0..=5 {
        let white = (0.4 * f64::from(5 - lines) - 1.0).clamp(0.0, 1.0);
        let taps = [1, 2, 3, 4].map(|i| f64::from(u8::from(i < lines)));
        let ink = ink_dilate_soft_cross(f64::from(u8::from(lines > 0)), taps);
        assert!((1.0 - ink - white).abs() < 1e-12, "{lines}");
    }
    assert_eq!(ink_dilate_soft_diagonal([1.0, 0.0, 0.0, 0.0], 0.25), 0.25);
    assert_eq!(ink_dilate_soft_diagonal([1.0, 1.0, 1.0, 0.0], 0.5), 1.0);
    assert_eq!(ink_dilate_soft_diagonal([0.0, 0.0, 1.0, 1.0], 0.5), 1.0);
    assert_eq!(ink_dilate_soft_diagonal_printed([0.0, 0.0, 1.0, 1.0], 0.5), 0.0, "two of the four are not read");
    assert_eq!(ink_dilate4([0.0, 0.5, 0.25, 0.0]), 0.5);
    assert_eq!(ink_erode4([1.0, 0.5, 0.25, 1.0]), 0.25);
}

#[test]
fn plans_reach_as_far_as_the_disc() {
    for radius_px in [0.0, 0.5, 1.0, 3.9, 4.0, 16.0, 64.0, 100.0] {
        for antialias in [false, true] {
            let disc = Disc { radius_px, antialias };
            for fan in [1, 2, 3] {
                let needed = if antialias { (radius_px + 1.0).ceil() as u32 - 1 } else { radius_px as u32 };
                for plan in [FloodPlan::separable(&disc, fan), FloodPlan::fitted(&disc, fan)] {
                    let along =
                        |x: bool| plan.passes.iter().filter(|p| p.along_x == x).map(|p| p.fan * p.step).sum::<u32>();
                    assert!(along(true) >= needed && along(false) >= needed, "{disc:?} {fan}");
                    assert_eq!(along(true), plan.row_reach_px());
                    // Without a gap: no step is longer than what those after it cover, and one.
                    for (i, pass) in plan.passes.iter().enumerate() {
                        let rest = plan.passes[i + 1..].iter().filter(|p| p.along_x == pass.along_x);
                        assert_eq!(pass.step, rest.map(|p| p.fan * p.step).sum::<u32>() + 1, "{disc:?} {fan}");
                    }
                }
            }
        }
    }
    let passes = |radius_px, fan| FloodPlan::separable(&Disc { radius_px, antialias: true }, fan).passes.len();
    assert_eq!([passes(4.0, 1), passes(64.0, 1), passes(4.0, 3), passes(64.0, 3)], [6, 14, 4, 8]);
    let fitted = |radius_px| FloodPlan::fitted(&Disc { radius_px, antialias: true }, 3).passes;
    let steps = |passes: Vec<FloodPass>| passes.iter().map(|pass| (pass.step, pass.fan)).collect::<Vec<_>>();
    assert_eq!(steps(fitted(4.0)), [(1, 4), (1, 4)]);
    assert_eq!(steps(fitted(64.0)), [(16, 4), (4, 3), (1, 3), (16, 4), (4, 3), (1, 3)]);
}

#[test]
fn a_step_that_a_texel_cannot_hold_is_not_taken() {
    let seed = ink_flood_seed(true);
    let far = ink_flood_take(0, seed, IVec2::new(-32767, 32767));
    assert_eq!(ink_flood_vector(far), IVec2::new(-32767, 32767));
    assert_eq!(ink_flood_take(0, far, IVec2::new(-1, 0)), 0);
    assert_eq!(ink_flood_take(far, seed, IVec2::new(3, -2)), ink_flood_take(0, seed, IVec2::new(3, -2)));
}

/// Rings, strokes and specks: what is dilated in earnest.
fn drawing(size: UVec2) -> Vec<u8> {
    let mut ink = vec![0; (size.x * size.y) as usize];
    let mut plot = |x: f64, y: f64| {
        if x >= 0.0 && y >= 0.0 && x < f64::from(size.x) && y < f64::from(size.y) {
            ink[y as usize * size.x as usize + x as usize] = 255;
        }
    };
    for i in 0..20_000 {
        let t = f64::from(i) / 20_000.0;
        let (sin, cos) = (std::f64::consts::TAU * t).sin_cos();
        let (w, h) = (f64::from(size.x), f64::from(size.y));
        plot(0.5 * w + 0.31 * w * cos, 0.5 * h + 0.37 * h * sin);
        plot(0.3 * w + 0.05 * w * cos, 0.4 * h + 0.2 * h * sin);
        plot(w * t, h * (0.9 - 0.7 * t));
        plot(w * (0.2 + 0.5 * t), h * (0.8 + 0.1 * (9.0 * t).sin()));
        if i % 800 == 0 {
            plot(w * (7.31 * t).fract(), h * (13.7 * t).fract());
        }
    }
    ink
}

/// The share of the disc's pixels that a flood's differ in.
#[test]
fn floods_miss_less_than_half_a_percent() {
    let size = UVec2::new(480, 270);
    let ink = drawing(size);
    for radius_px in [1.0, 4.0, 16.0, 64.0] {
        for antialias in [false, true] {
            let disc = Disc { radius_px, antialias };
            let exact = dilated(&ink, size, &disc);
            let covered = exact.iter().filter(|&&ink| ink > 0).count() as f64;
            let plans = [
                ("separable, fan 1", FloodPlan::separable(&disc, 1)),
                ("separable, fan 3", FloodPlan::separable(&disc, 3)),
                ("fitted, fan 3", FloodPlan::fitted(&disc, 3)),
                ("square", FloodPlan::square(&disc)),
            ];
            for (name, plan) in plans {
                let flooded = flood(&ink, size, &disc, &plan).unwrap();
                let wrong = flooded.iter().zip(&exact).filter(|(f, e)| f.abs_diff(**e) > 1).count() as f64;
                let passes = plan.passes.len();
                println!(
                    "r {radius_px} aa {antialias} {name}: {passes} passes, {:.3} % wrong",
                    100.0 * wrong / covered
                );
                assert!(wrong <= 0.005 * covered, "{disc:?} {name}: {wrong} of {covered}");
            }
        }
    }
}

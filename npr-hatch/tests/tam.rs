//! Properties of drawn maps: mean tones, nesting in tones and levels, periodicity, evenness, and determinism.

use npr_hatch::*;

fn small() -> TamParameters {
    TamParameters { side: 128, ..TamParameters::default() }
}

/// The default map, one without crosswise strokes, and others with very different parameters.
fn variants() -> Vec<TamParameters> {
    let default = TamParameters::default();
    vec![
        default.clone(),
        TamParameters { seed: 77, cross_from: Some(2), cross_deg: 60.0, angle_deg: 30.0, ..default.clone() },
        TamParameters { seed: 3, cross_from: None, tones: even_tones(4), ..default.clone() },
        TamParameters { seed: 4, width_px: 3.0, length: [0.1, 1.0], bow: 0.1, cross_from: Some(0), ..default.clone() },
        TamParameters {
            seed: 5,
            width_px: 1.0,
            cross_from: Some(1),
            jitter_deg: 30.0,
            tones: vec![0.95, 0.5, 0.08],
            ..small()
        },
        TamParameters { seed: 6, placement: Placement::BestOf { candidates: 8 }, ..small() },
    ]
}

#[test]
fn means_are_what_was_asked_for() {
    for parameters in variants() {
        let tam = draw(&parameters, None).unwrap().tam;
        for (tone, &asked) in tam.tones.iter().enumerate() {
            for level in 0..tam.levels() {
                let side = f64::from(tam.level_side(level));
                let error = (tam.mean(tone, level) - f64::from(asked)).abs();
                // Half a percent; in small levels the ink of one stroke, which is at least two texels long.
                let stroke_px = (f64::from(parameters.length[1]) * side).max(2.0) * f64::from(parameters.width_px);
                let limit = if side >= 64.0 { 0.005 } else { (stroke_px / (side * side)).min(1.0) };
                assert!(error <= limit, "{parameters:?}: tone {tone} at {side}: off by {error}");
            }
        }
    }
}

#[test]
fn means_of_the_default_map_are_much_closer() {
    let tam = draw(&TamParameters::default(), None).unwrap().tam;
    for tone in 0..6 {
        for level in 0..tam.levels() {
            let error = (tam.mean(tone, level) - f64::from(tam.tones[tone])).abs();
            let limit = if tam.level_side(level) >= 64 { 1e-4 } else { 2.5e-3 };
            assert!(error <= limit, "tone {tone} at {}: off by {error}", tam.level_side(level));
        }
    }
}

#[test]
fn small_levels_are_close_for_any_seed() {
    for seed in 0..40 {
        for width_px in [1.0, 1.5, 2.5] {
            let parameters = TamParameters { seed, width_px, side: 64, ..TamParameters::default() };
            let tam = draw(&parameters, None).unwrap().tam;
            for (tone, level) in (0..6).flat_map(|tone| (0..tam.levels()).map(move |level| (tone, level))) {
                let (side, error) = (tam.level_side(level), tam.mean(tone, level) - f64::from(tam.tones[tone]));
                let limit = if side >= 64 {
                    0.001
                } else if width_px > 1.0 {
                    0.02
                } else {
                    0.1
                };
                assert!(error.abs() < limit, "seed {seed}, width {width_px}, tone {tone} at {side}: off by {error}");
            }
        }
    }
}

#[test]
fn tones_are_nested_texel_by_texel() {
    for parameters in variants() {
        let tam = draw(&parameters, None).unwrap().tam;
        for tone in 1..tam.tones.len() {
            for level in 0..tam.levels() {
                let pairs = tam.image(tone - 1, level).iter().zip(tam.image(tone, level));
                assert!(pairs.clone().all(|(light, dark)| dark <= light), "tone {tone}, level {level}");
                assert!(pairs.clone().any(|(light, dark)| dark < light), "tone {tone}, level {level}");
            }
        }
    }
}

#[test]
fn strokes_are_nested_in_tones_and_in_mips() {
    // Small levels, in which a single stroke changes the tone considerably, are the difficult ones.
    let seeds = (0..100).flat_map(|seed| [1.0, 2.5, 8.0].map(|width_px| (seed, width_px)));
    let small = seeds.map(|(seed, width_px)| TamParameters { seed, width_px, side: 32, ..TamParameters::default() });
    for parameters in variants().into_iter().chain(small) {
        let drawing = draw(&parameters, None).unwrap();
        let (tones, levels) = (drawing.tam.tones.len(), drawing.tam.levels());
        let extent = |tone: usize, level: usize| drawing.extents[tone * levels + level];
        for (tone, level) in (0..tones).flat_map(|tone| (0..levels).map(move |level| (tone, level))) {
            let set: Vec<Mark> =
                drawing.marks[level].iter().copied().filter(|&mark| extent(tone, level).contains(mark)).collect();
            assert_eq!(set.len(), extent(tone, level).strokes());
            assert!(!set.is_empty());
            for mark in set {
                assert!(tone + 1 == tones || extent(tone + 1, level).contains(mark), "{mark:?} of {tone}, {level}");
                assert!(level == 0 || extent(tone, level - 1).contains(mark), "{mark:?} of {tone}, {level}");
            }
        }
    }
}

#[test]
fn crosswise_strokes_begin_with_their_tone() {
    let drawing = draw(&TamParameters::default(), None).unwrap();
    let levels = drawing.tam.levels();
    for (i, extent) in drawing.extents.iter().enumerate() {
        let (tone, side) = (i / levels, drawing.tam.level_side(i % levels));
        let crosswise = extent.whole[1] + u32::from(extent.part[1]);
        assert!(tone >= 3 || crosswise == 0, "tone {tone} at {side}");
        assert!(tone < 3 || side < 16 || crosswise > 0, "tone {tone} at {side}");
    }
    let none = draw(&TamParameters { cross_from: None, ..small() }, None).unwrap();
    assert!(none.layers[1].is_empty());
}

/// The mean difference between neighbouring rows or columns by the index of the first; the last is a neighbour of the
/// first.
fn differences(image: &[u8], side: usize, is_rows: bool) -> Vec<f64> {
    let at = |i: usize, j: usize| f64::from(if is_rows { image[i * side + j] } else { image[j * side + i] });
    let between = |i: usize| (0..side).map(|j| (at(i, j) - at((i + 1) % side, j)).abs()).sum::<f64>() / side as f64;
    (0..side).map(between).collect()
}

#[test]
fn opposite_borders_match() {
    // A single seam may have a large difference by chance, like any row; the mean over many maps may not.
    for is_rows in [false, true] {
        let (mut seam, mut inside, mut above) = (0.0, 0.0, 0);
        let seeds = 24;
        for seed in 0..seeds {
            let tam = draw(&TamParameters { seed, side: 64, ..TamParameters::default() }, None).unwrap().tam;
            let all = differences(tam.image(3, 0), 64, is_rows);
            let most = all[..63].iter().fold(0.0_f64, |a, &b| a.max(b));
            seam += all[63] / f64::from(seeds as u32);
            inside += all[..63].iter().sum::<f64>() / (63.0 * f64::from(seeds as u32));
            above += u32::from(all[63] > most);
        }
        assert!((seam / inside - 1.0).abs() < 0.12, "rows {is_rows}: {seam} at the seam, {inside} inside");
        assert!(above <= 2, "rows {is_rows}: the seam is the steepest of {above} maps in {seeds}");
    }
}

/// An image shifted by half of its side along both axes.
fn rolled(image: &[u8], side: usize) -> Vec<u8> {
    let half = side / 2;
    (0..side * side).map(|i| image[(i / side + half) % side * side + (i % side + half) % side]).collect()
}

#[test]
fn the_torus_has_no_place_of_its_own() {
    let drawing = draw(&small(), None).unwrap();
    let mut moved = drawing.clone();
    for stroke in moved.layers.iter_mut().flatten() {
        stroke.centre = stroke.centre.map(|at| at.wrapping_add(1 << 31));
    }
    let tam = moved.images(&small(), None);
    assert_eq!(drawing.images(&small(), None), drawing.tam);
    for tone in 0..6 {
        for level in 0..tam.levels() - 1 {
            let side = tam.level_side(level) as usize;
            assert!(tam.image(tone, level) == rolled(drawing.tam.image(tone, level), side), "tone {tone} at {side}");
        }
    }
}

#[test]
fn the_seed_decides() {
    for placement in [Placement::Sequence, Placement::BestOf { candidates: 4 }] {
        let parameters = TamParameters { placement, ..small() };
        let first = store::to_bytes(&draw(&parameters, None).unwrap().tam, None).unwrap();
        let again = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..3).map(|_| scope.spawn(|| draw(&parameters, None).unwrap().tam)).collect();
            threads
                .into_iter()
                .map(|thread| store::to_bytes(&thread.join().unwrap(), None).unwrap())
                .collect::<Vec<_>>()
        });
        assert!(again.iter().all(|other| *other == first));
        let other = draw(&TamParameters { seed: 2, ..parameters }, None).unwrap().tam;
        assert!(store::to_bytes(&other, None).unwrap() != first);
    }
}

/// The last eight bytes of the file are its checksum, which is equal on every machine.
#[test]
fn the_default_map_is_this_one() {
    let checksum = |parameters: &TamParameters| {
        let bytes = store::to_bytes(&draw(parameters, None).unwrap().tam, None).unwrap();
        u64::from_le_bytes(bytes[bytes.len() - 8..].try_into().unwrap())
    };
    assert_eq!(checksum(&TamParameters::default()), DEFAULT_CHECKSUM);
    let parameters = TamParameters { placement: Placement::BestOf { candidates: 8 }, ..small() };
    assert_eq!(checksum(&parameters), BEST_OF_CHECKSUM);
}

const DEFAULT_CHECKSUM: u64 = 17328142516393012740;
const BEST_OF_CHECKSUM: u64 = 7705733553257044573;

/// The mean distance to the nearest neighbour of the centres of the first strokes along x, in units of 1 / √n.
/// Distances along x are divided by 8, since strokes are long.
fn nearest(strokes: &[Stroke]) -> f64 {
    let share = |at: u32| f64::from(at) / 4_294_967_296.0;
    let apart = |a: u32, b: u32| {
        let d = share(a.wrapping_sub(b));
        d.min(1.0 - d)
    };
    let distance = |a: &Stroke, b: &Stroke| {
        (apart(a.centre[0], b.centre[0]) / 8.0).hypot(apart(a.centre[1], b.centre[1])) * 8.0_f64.sqrt()
    };
    let least = |(i, a): (usize, &Stroke)| {
        let others = strokes.iter().enumerate().filter(|&(j, _)| j != i);
        others.map(|(_, b)| distance(a, b)).fold(f64::INFINITY, f64::min)
    };
    let count = strokes.len() as f64;
    strokes.iter().enumerate().map(least).sum::<f64>() / count * count.sqrt()
}

/// The root mean square deviation of the tones of 16 × 16 blocks from the tone of the image.
fn unevenness(tam: &Tam, tone: usize) -> f64 {
    let (side, image) = (tam.side as usize, tam.image(tone, 0));
    let size = side / 16;
    let mut sums = [0.0; 256];
    for (i, &texel) in image.iter().enumerate() {
        sums[i / side / size * 16 + i % side / size] += f64::from(texel) / (255 * size * size) as f64;
    }
    let mean = tam.mean(tone, 0);
    (sums.iter().map(|sum| (sum - mean).powi(2)).sum::<f64>() / 256.0).sqrt()
}

/// For a placement, the means over some seeds of the nearest-neighbour distance and of the unevenness of each tone.
fn evenness(placement: Placement) -> [(f64, f64); 6] {
    let mut all = [(0.0, 0.0); 6];
    let seeds = 4;
    for seed in 0..seeds {
        let parameters = TamParameters { seed, side: 128, cross_from: None, placement, ..TamParameters::default() };
        let drawing = draw(&parameters, None).unwrap();
        for (tone, (distance, uneven)) in all.iter_mut().enumerate() {
            let count = drawing.extents[tone * drawing.tam.levels()].strokes();
            *distance += nearest(&drawing.layers[0][..count]) / seeds as f64;
            *uneven += unevenness(&drawing.tam, tone) / seeds as f64;
        }
    }
    all
}

#[test]
fn strokes_are_even() {
    // A single candidate is a random placement.
    let random = evenness(Placement::BestOf { candidates: 1 });
    let best = evenness(Placement::BestOf { candidates: 16 });
    let sequence = evenness(Placement::Sequence);
    for tone in 0..6 {
        // Random points have 1/2 (Clark & Evans 1954), a square lattice 1.
        assert!((random[tone].0 - 0.5).abs() < 0.05, "{random:?}");
        assert!(sequence[tone].0 > 1.15 * random[tone].0, "tone {tone}: {sequence:?}");
        assert!(best[tone].0 > 1.1 * random[tone].0, "tone {tone}: {best:?}");
        assert!(sequence[tone].1 < 0.8 * random[tone].1, "tone {tone}: {sequence:?}");
        assert!(best[tone].1 < 0.8 * random[tone].1, "tone {tone}: {best:?}");
    }
    // The sequence is as even as the selection among candidates.
    let mean = |all: [(f64, f64); 6]| all.iter().map(|&(_, uneven)| uneven).sum::<f64>() / 6.0;
    assert!(mean(sequence) < 1.05 * mean(best), "{sequence:?}, {best:?}");
}

/// The mean length of runs of ink across strokes in texels, with gray counted in proportion: the width.
fn mean_width(tam: &Tam, level: usize) -> f64 {
    let (side, image) = (tam.level_side(level) as usize, tam.image(0, level));
    let ink = |x: usize, y: usize| f64::from(255 - image[y % side * side + x]) / 255.0;
    let (mut sum, mut runs) = (0.0, 0.0);
    for i in 0..side * side {
        let (x, y) = (i % side, i / side);
        sum += ink(x, y);
        runs += f64::from(u8::from(ink(x, y) > 0.0 && ink(x, y + side - 1) == 0.0));
    }
    sum / runs
}

#[test]
fn strokes_are_as_wide_in_all_mips() {
    let tam = draw(
        &TamParameters { tones: vec![0.95], cross_from: None, pressure: [1.0; 2], ..TamParameters::default() },
        None,
    )
    .unwrap()
    .tam;
    for level in 0..3 {
        let width = mean_width(&tam, level);
        // The ends are thinner than the 1.5 texels in the middle.
        assert!(width > 1.15 && width < 1.5, "level {level}: {width}");
    }
}

#[test]
fn strokes_that_are_too_faint_are_an_error() {
    let parameters = TamParameters { pressure: [0.3, 0.5], ..small() };
    assert!(matches!(draw(&parameters, None), Err(HatchError::Unreachable { tone: 3, side: 1, .. })));
}

#[test]
fn the_ends_of_the_ranges_draw() {
    let default = || TamParameters { side: 32, ..TamParameters::default() };
    let ends = [
        TamParameters { side: 8, width_px: 2.0, ..default() },
        TamParameters { width_px: 8.0, length: [1.0; 2], bow: 0.2, jitter_deg: 45.0, ..default() },
        TamParameters { length: [0.02; 2], taper: 0.0, ..default() },
        TamParameters { taper: 1.0, angle_deg: -360.0, cross_deg: 0.0, cross_from: Some(5), ..default() },
        TamParameters { angle_deg: 45.0, cross_deg: 180.0, seed: u64::MAX, ..default() },
        TamParameters { tones: even_tones(64), ..default() },
        TamParameters { tones: vec![0.99, 0.98], cross_from: None, ..default() },
    ];
    for parameters in ends {
        let tam = draw(&parameters, None).unwrap().tam;
        tam.validate().unwrap();
        let off = (0..tam.tones.len()).map(|tone| (tam.mean(tone, 0) - f64::from(tam.tones[tone])).abs());
        assert!(off.fold(0.0, f64::max) < 0.01, "{parameters:?}");
    }
}

#[test]
fn bad_parameters_are_errors() {
    let default = TamParameters::default;
    let error = |parameters: TamParameters| {
        let text = parameters.validate().unwrap_err().to_string();
        assert_eq!(draw(&parameters, None).unwrap_err().to_string(), text);
        text
    };
    for side in [0, 4, 100, 8192] {
        assert!(error(TamParameters { side, ..default() }).contains(&format!("the side is {side} texels")));
    }
    assert_eq!(error(TamParameters { tones: vec![], ..default() }), "0 tones: there must be 1 to 64");
    for tones in [vec![1.0], vec![0.5, 0.5], vec![0.5, 0.7], vec![0.5, 0.0], vec![f32::NAN]] {
        assert!(error(TamParameters { tones, ..default() }).starts_with("tone "));
    }
    for value in [-1.0, 65.0, f32::NAN, f32::INFINITY] {
        let bad = [
            TamParameters { width_px: value, ..default() },
            TamParameters { length: [value, 0.5], ..default() },
            TamParameters { length: [0.5, value], ..default() },
            TamParameters { jitter_deg: value, ..default() },
            TamParameters { bow: value, ..default() },
            TamParameters { taper: value, ..default() },
            TamParameters { pressure: [value, 1.0], ..default() },
            TamParameters { angle_deg: value * 1000.0, ..default() },
            TamParameters { cross_deg: value * 1000.0, ..default() },
        ];
        for parameters in bad {
            assert!(error(parameters).contains("must be within"));
        }
    }
    assert_eq!(
        error(TamParameters { length: [0.5, 0.4], ..default() }),
        "length is the range from 0.5 to 0.4: the end must not be below the start"
    );
    assert!(error(TamParameters { cross_from: Some(6), ..default() }).contains("with tone 6 of 6"));
    for candidates in [0, 5000] {
        let placement = Placement::BestOf { candidates };
        assert!(error(TamParameters { placement, ..default() }).contains(&format!("{candidates} candidates")));
    }
}

#[test]
fn tones_are_packed_as_listing_5_reads_them() {
    let tam = draw(&small(), None).unwrap().tam;
    let [light, dark] = tam.pack_tones(1).unwrap();
    for (i, (light, dark)) in light.iter().zip(&dark).enumerate() {
        let texels = [0, 1, 2, 3, 4, 5].map(|tone| tam.image(tone, 1)[i]);
        assert_eq!([light[0], light[1], light[2], dark[0], dark[1], dark[2]], texels);
    }
    let five = draw(&TamParameters { tones: even_tones(5), ..small() }, None).unwrap().tam;
    assert!(matches!(five.pack_tones(0), Err(HatchError::PackTones { tones: 5 })));
}

#[test]
fn thresholds_have_every_tone() {
    let parameters = small();
    let drawing = draw(&parameters, None).unwrap();
    let thresholds = Thresholds::new(&drawing, &parameters, None);
    for (level, texels) in thresholds.levels.iter().enumerate() {
        let side = f64::from(drawing.tam.level_side(level));
        for step in 0..=200 {
            let tone = f64::from(step) / 200.0;
            let ink: f64 = texels.iter().map(|&t| hatch_threshold(f64::from(t) / 65535.0, tone, 0.0)).sum();
            let error = 1.0 - ink / (side * side) - tone;
            assert!(error.abs() <= 0.5 / (side * side) + 1e-4, "{error} at {side}, tone {tone}");
        }
    }
    // At a tone of the map the ink is that of its strokes.
    for tone in 0..6 {
        let asked = f64::from(drawing.tam.tones[tone]);
        let pairs = thresholds.levels[0].iter().zip(drawing.tam.image(tone, 0));
        let differ =
            pairs.filter(|&(&t, &texel)| (hatch_threshold(f64::from(t) / 65535.0, asked, 0.0) > 0.5) != (texel < 128));
        let share = differ.count() as f64 / (128.0 * 128.0);
        assert!(share < 0.13, "tone {tone}: {share}");
    }
    assert_eq!(thresholds.to_u8(7), [127]);
}

/// A black and a faint stroke on 8 × 8 texels, which determine the order completely.
#[test]
fn what_no_stroke_inks_follows_the_inked_darkest_neighbourhood_first_around_the_borders() {
    // Along x, 4 texels long and 1 texel wide, without taper: they cover whole texels.
    let stroke = |x: u32, row: u32, pressure| Stroke {
        centre: [x << 29, (2 * row + 1) << 28],
        direction: [1.0, 0.0],
        length: 0.5,
        bow: 0.0,
        pressure,
    };
    // 255 in columns 0..4 of row 0; 64 in columns 6, 7, 0 and 1 of row 5, which is less than half and therefore not
    // ink.
    let layers = [vec![stroke(2, 0, 1.0), stroke(0, 5, 0.25)], vec![]];
    // The black stroke is drawn last, after so many repetitions of the faint one that its rank exceeds any darkness.
    let mut marks = vec![vec![Mark { layer: 0, index: 1 }; 3000], vec![], vec![], vec![]];
    marks[0].push(Mark { layer: 0, index: 0 });
    let parameters = TamParameters { side: 8, width_px: 1.0, taper: 0.0, ..TamParameters::default() };
    let tam = Tam { tones: vec![0.5], side: 8, images: vec![vec![255; 64], vec![255; 16], vec![255; 4], vec![255]] };
    let drawing = Drawing { tam, layers, marks, extents: vec![Extent { whole: [2, 0], part: [0; 2] }; 4] };
    let thresholds = Thresholds::new(&drawing, &parameters, None);
    thresholds.validate().unwrap();

    // The ink of the 3 × 3 texels around each texel plus twice its own ink, with wrapping at the borders. Equal sums
    // are ordered by row and column.
    #[rustfmt::skip]
    let darkness = [
        9999, 9998, 9997, 9996,  255,    0,    0,  255,
         510,  765,  765,  510,  255,    0,    0,  255,
           0,    0,    0,    0,    0,    0,    0,    0,
           0,    0,    0,    0,    0,    0,    0,    0,
         192,  128,   64,    0,    0,   64,  128,  192,
         320,  256,   64,    0,    0,   64,  256,  320,
         192,  128,   64,    0,    0,   64,  128,  192,
         510,  765,  765,  510,  255,    0,    0,  255,
    ];
    let mut expected: Vec<usize> = (0..64).collect();
    expected.sort_by_key(|&texel| -darkness[texel]);
    let mut order: Vec<usize> = (0..64).collect();
    order.sort_by_key(|&texel| std::cmp::Reverse(thresholds.levels[0][texel]));
    assert_eq!(order, expected);
    // Without ink all texels are equal.
    assert!(thresholds.levels[1..].iter().all(|level| level.is_sorted_by(|a, b| a > b)));
}

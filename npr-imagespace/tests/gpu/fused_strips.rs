//! The compute form of the hard fused filter against the reference, pixel by pixel.

use crate::device::{Gpu, gpu, view};
use glam::{UVec2, Vec3};
use npr_imagespace::composite::{AlphaTest, Composite, composite_picture};
use npr_imagespace::filter::fused::{DepthTest, FilterUniform, FusedFilter, ShadowTest, ink_fused};
use npr_imagespace::format::texel::{DepthCode, TexelLayout, ink_narrow_tap, ink_wide_tap};
use npr_imagespace::pass::Onto;
use npr_imagespace::pass::fused::texel_format;
use npr_imagespace::pass::fused_strips::{FusedStrips, STRIPS_FORMAT, serves};
use npr_imagespace::picture::{Taps, filter_picture};

/// The same numbers on every machine, below 2^32.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as u32
    }

    fn below(&mut self, end: u32) -> u32 {
        ((u64::from(self.next()) * u64::from(end)) >> 32) as u32
    }
}

/// What a picture of texels is made of.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Background,
    /// Any words, so that background holds what it should not, and normals are such as no encoder gives.
    Words,
    /// One surface with the odd texel that differs in one thing, by a little.
    Specks,
}

fn texels(kind: Kind, layout: TexelLayout, size: UVec2, numbers: &mut Numbers) -> Vec<[u32; 2]> {
    let narrow = layout == TexelLayout::Narrow;
    let pack = |depth: u32, region: u32, u: u32, v: u32| {
        if narrow { [depth | region << 14 | u << 22 | v << 27, 0] } else { [depth | region << 24, u | v << 8] }
    };
    let tilt = numbers.below(4);
    (0..size.x * size.y)
        .map(|i| match kind {
            Kind::Background => [0; 2],
            Kind::Words => {
                let words = [numbers.next(), if narrow { 0 } else { numbers.next() }];
                let mask = if narrow { !(255 << 14) } else { 0x00ff_ffff };
                match numbers.below(3) {
                    0 if narrow => [words[0] & mask, 0],
                    0 => [words[0] & mask, words[1] & 0xffff],
                    1 => words,
                    // A single region: only normals and depth differ.
                    _ if narrow => [words[0] & mask | 5 << 14, 0],
                    _ => [words[0] & mask | 5 << 24, words[1] & 0xffff],
                }
            }
            Kind::Specks => {
                let (x, y) = (i % size.x, i / size.x);
                let (most, slack) = (layout.normal_most() as u32, layout.depth_slack());
                let plane = 4000 + tilt * x + 2 * y;
                match numbers.below(20) {
                    0 => pack(plane, 3, most, most),
                    1 | 2 => pack(plane + slack / 2 + numbers.below(slack), 2, most, most),
                    3 => pack(plane + 2 * slack, 2, most, most),
                    // Some 37 degrees away: at the default threshold.
                    4 => pack(plane, 2, most + numbers.below(most), most + numbers.below(most / 2)),
                    5 => pack(plane, 2, 0, 0),
                    6 => pack(0, 0, 0, 0),
                    _ => pack(plane, 2, most, most),
                }
            }
        })
        .collect()
}

fn ink(words: &[[u32; 2]], size: UVec2, filter: &FusedFilter, layout: TexelLayout, code: &DepthCode) -> Vec<u8> {
    let uniform = FilterUniform::new(filter, layout, code).unwrap();
    let tap = |words: [u32; 2]| match layout {
        TexelLayout::Narrow => ink_narrow_tap(words[0]),
        TexelLayout::Wide => ink_wide_tap(words),
    };
    filter_picture(words, size, filter.taps, |c, taps| ink_fused(&uniform, &tap(c), &taps.map(tap)) as f32).unwrap()
}

/// Draws both and compares; returns how many pixels are ink.
#[expect(clippy::too_many_arguments, reason = "a test's case")]
fn assert_same(
    gpu: &Gpu,
    strips: &FusedStrips,
    words: &[[u32; 2]],
    size: UVec2,
    filter: &FusedFilter,
    layout: TexelLayout,
    composite: &Composite,
    area: Option<[u32; 4]>,
) -> usize {
    let code = DepthCode::perspective(0.5, 60.0, layout).unwrap();
    let count = if layout == TexelLayout::Narrow { 1 } else { 2 };
    let flat: Vec<u32> = words.iter().flat_map(|words| words[..count].to_vec()).collect();
    let texels = view(&gpu.upload(texel_format(layout), size.into(), bytemuck::cast_slice(&flat)));
    let mut numbers = Numbers(9);
    let mut expected: Vec<[u8; 4]> =
        words.iter().map(|_| [numbers.next() as u8, numbers.next() as u8, numbers.next() as u8, 255]).collect();
    let picture = gpu.storable(STRIPS_FORMAT, size.into());
    gpu.write(&picture, bytemuck::cast_slice(&expected));
    let mut ink = ink(words, size, filter, layout, &code);
    let [x, y, width, height] = area.unwrap_or([0, 0, size.x, size.y]);
    for (i, ink) in (0u32..).zip(&mut ink) {
        let inside = (i % size.x).wrapping_sub(x) < width && (i / size.x).wrapping_sub(y) < height;
        *ink = if inside { *ink } else { 0 };
    }
    composite_picture(&mut expected, &ink, composite).unwrap();
    let onto = Onto { view: &view(&picture), composite, area };
    gpu.run(|encoder| strips.record(&gpu.device, encoder, filter, &code, &texels, &onto).unwrap());
    let actual = gpu.read(&picture);
    let differs = expected.iter().zip(actual.chunks_exact(4)).position(|(expected, pixel)| expected != pixel);
    let at = differs.map(|i| (i % size.x as usize, i / size.x as usize));
    assert_eq!(at, None, "{size} {filter:?} {layout:?} {area:?}");
    ink.iter().filter(|&&ink| ink > 0).count()
}

const LAYOUTS: [TexelLayout; 2] = [TexelLayout::Narrow, TexelLayout::Wide];

#[test]
fn whatever_is_asked_for_the_ink_is_the_references() {
    let Some(gpu) = gpu().filter(|gpu| gpu.compute) else { return println!("skipped: no compute shaders") };
    let (mut numbers, mut turn) = (Numbers(1), 0);
    for layout in LAYOUTS {
        for taps in [Taps::Diagonal, Taps::Cross] {
            for normal_cos in [None, Some(0.8)] {
                for plain in [None, Some(false), Some(true)] {
                    for regions in [false, true] {
                        let depth = plain.map(|plain| DepthTest { step: 0.001, plain });
                        turn += 1;
                        let shadows = [ShadowTest::Absent, ShadowTest::Ignored, ShadowTest::Lines][turn % 3];
                        let filter = FusedFilter { normal_cos, depth, regions, shadows, taps, softness: 0.0 };
                        let strips = FusedStrips::new(&gpu.device, &filter, layout);
                        // Among any depths a threshold near the depths themselves, so that it matters whose it is.
                        let depth = plain.map(|plain| DepthTest { step: 0.7, plain });
                        let coarse = FusedFilter { depth, ..filter };
                        let cases =
                            [(Kind::Words, UVec2::new(53, 29), coarse), (Kind::Specks, UVec2::new(75, 70), filter)];
                        for (kind, size, filter) in cases {
                            let words = texels(kind, layout, size, &mut numbers);
                            let black = Composite::default();
                            let inked = assert_same(gpu, &strips, &words, size, &filter, layout, &black, None);
                            assert!(inked > 0 && inked < words.len(), "{kind:?} {filter:?}: {inked}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn pictures_of_any_size() {
    let Some(gpu) = gpu().filter(|gpu| gpu.compute) else { return println!("skipped: no compute shaders") };
    let mut numbers = Numbers(2);
    for layout in LAYOUTS {
        for taps in [Taps::Diagonal, Taps::Cross] {
            // A cosine of 0 and no growth: only the slack.
            for (normal_cos, step) in [(0.8, 0.02), (0.0, 0.0), (1.0, 0.0)] {
                let depth = Some(DepthTest { step, plain: false });
                let filter = FusedFilter { normal_cos: Some(normal_cos), depth, taps, ..Default::default() };
                let strips = FusedStrips::new(&gpu.device, &filter, layout);
                let sizes = [(1, 1), (1, 2), (2, 1), (1, 40), (41, 1), (2, 2), (2, 9), (9, 2), (3, 3), (5, 7), (6, 34)];
                let wide =
                    [(9, 8), (10, 6), (11, 4), (19, 38), (33, 35), (34, 33), (65, 3), (66, 67), (131, 5), (4, 131)];
                for size in sizes.into_iter().chain(wide).map(|(x, y)| UVec2::new(x, y)) {
                    for kind in [Kind::Background, Kind::Words, Kind::Specks] {
                        let words = texels(kind, layout, size, &mut numbers);
                        let black = Composite::default();
                        let inked = assert_same(gpu, &strips, &words, size, &filter, layout, &black, None);
                        assert!(inked == 0 || !matches!(kind, Kind::Background));
                    }
                }
            }
        }
    }
}

#[test]
fn areas_and_composites() {
    let Some(gpu) = gpu().filter(|gpu| gpu.compute) else { return println!("skipped: no compute shaders") };
    let mut numbers = Numbers(3);
    let red = Composite::Over { color: Vec3::new(0.8, 0.1, 0.0), opacity: 1.0 };
    let composites = [red, Composite::Multiply, Composite::AlphaTested(AlphaTest::CORRECTED)];
    for layout in LAYOUTS {
        let filter = FusedFilter::default();
        let strips = FusedStrips::new(&gpu.device, &filter, layout);
        for size in [UVec2::new(50, 43), UVec2::new(3, 60)] {
            let words = texels(Kind::Specks, layout, size, &mut numbers);
            for round in 0..24 {
                let left = numbers.below(size.x);
                let top = numbers.below(size.y);
                let area = [left, top, numbers.below(size.x - left + 1), numbers.below(size.y - top + 1)];
                let composite = &composites[round % 3];
                assert_same(gpu, &strips, &words, size, &filter, layout, composite, Some(area));
            }
            assert_same(gpu, &strips, &words, size, &filter, layout, &red, Some([0, 0, size.x, size.y]));
        }
    }
}

#[test]
fn serves_what_is_opaque() {
    let hard = FusedFilter::default();
    let black = Composite::default();
    assert!(serves(&hard, &black) && serves(&hard, &Composite::Multiply));
    assert!(!serves(&FusedFilter { softness: 0.1, ..hard }, &black));
    assert!(!serves(&hard, &Composite::Over { color: Vec3::ZERO, opacity: 0.99 }));
    assert!(serves(&hard, &Composite::AlphaTested(AlphaTest::CORRECTED)));
    assert!(!serves(&hard, &Composite::AlphaTested(AlphaTest::PRINTED)));
}

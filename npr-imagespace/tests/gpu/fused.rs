//! The fused filter.

use crate::device::{gpu, view};
use crate::inputs::{LONG, Random, SIZES, direction, px, scene};
use crate::targets::{COMPOSITES, PICTURE, assert_areas, assert_composited, composited, difference, drawn};
use npr_imagespace::composite::Composite;
use npr_imagespace::filter::fused::{DepthTest, FilterUniform, FusedFilter, ShadowTest, ink_fused};
use npr_imagespace::format::texel::*;
use npr_imagespace::pass::InkTarget;
use npr_imagespace::pass::fused::{FusedPass, texel_format};
use npr_imagespace::picture::{Taps, filter_picture};

/// Two words of each pixel; one is not looked at in a narrow one.
type Texels = Vec<[u32; 2]>;

fn code(layout: TexelLayout) -> DepthCode {
    DepthCode::perspective(0.5, 60.0, layout).unwrap()
}

fn pack(normal: glam::Vec3, region: u32, depth: f32, layout: TexelLayout) -> [u32; 2] {
    match layout {
        TexelLayout::Bits32 => [ink_texel32_pack(normal, region, depth, &code(layout)), 0],
        TexelLayout::Bits64 => ink_texel64_pack(normal, region, depth, &code(layout)),
    }
}

/// Pictures of a size: noise of bits, surfaces at random, a scene, the scene with its codes a little off, none.
fn pictures(size: [u32; 2], layout: TexelLayout, random: &mut Random) -> Vec<Texels> {
    let len = (size[0] * size[1]) as usize;
    let noise = (0..len).map(|_| [random.bits(), random.bits()]).collect();
    let surfaces = (0..len).map(|_| {
        let depth = random.one_of(&[5.0, 5.04, 5.05, 5.06, 5.1, 0.2, 500.0, f32::NAN, f32::INFINITY, -1.0, 0.0]);
        let normal = if random.below(9) == 0 { glam::Vec3::ZERO } else { direction(random) };
        pack(normal, random.below(3), depth, layout)
    });
    let surfaces: Texels = surfaces.collect();
    let seen: Texels = scene(size)
        .into_iter()
        .map(|surface| surface.map_or(BACKGROUND, |seen| pack(seen.normal, seen.region, seen.depth, layout)))
        .collect();
    let off = seen.iter().map(|&[x, y]| [x ^ random.below(16), y ^ random.below(4)]).collect();
    vec![noise, surfaces, seen, off, vec![BACKGROUND; len]]
}

/// `strictest`: a normal threshold that the softness leaves room for.
fn filters(strictest: f32) -> Vec<FusedFilter> {
    let usual = FusedFilter::default();
    let none = FusedFilter { normal_cos: None, depth: None, regions: false, ..usual };
    let plain = Some(DepthTest { step: 0.02, plain: true });
    vec![
        usual,
        none,
        FusedFilter { normal_cos: Some(0.85), ..none },
        FusedFilter { depth: usual.depth, ..none },
        FusedFilter { depth: plain, ..none },
        FusedFilter { regions: true, ..none },
        FusedFilter { normal_cos: Some(strictest), depth: plain, ..usual },
        FusedFilter { shadows: ShadowTest::Lines, ..usual },
        FusedFilter { shadows: ShadowTest::Lines, ..none },
        FusedFilter { shadows: ShadowTest::Ignored, ..usual },
        FusedFilter { shadows: ShadowTest::OnlyShadows, ..usual },
        FusedFilter { shadows: ShadowTest::OnlyShadows, ..none },
    ]
}

fn by_cpu(texels: &Texels, size: [u32; 2], filter: &FusedFilter, layout: TexelLayout) -> Vec<u8> {
    let uniform = FilterUniform::new(filter, layout, &code(layout)).unwrap();
    let tap = |texel: [u32; 2]| match layout {
        TexelLayout::Bits32 => ink_texel32_tap(texel[0]),
        TexelLayout::Bits64 => ink_texel64_tap(texel),
    };
    let ink = |centre, taps: [[u32; 2]; 4]| ink_fused(&uniform, &tap(centre), &taps.map(tap)) as f32;
    filter_picture(texels, px(size), filter.taps, ink).unwrap()
}

fn bytes(texels: &Texels, layout: TexelLayout) -> Vec<u8> {
    match layout {
        TexelLayout::Bits32 => texels.iter().flat_map(|texel| texel[0].to_ne_bytes()).collect(),
        TexelLayout::Bits64 => bytemuck::pod_collect_to_vec(texels),
    }
}

#[test]
fn ink_and_pictures_are_those_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(11);
    let (mut inked, mut pixels, mut borderline) = (0, 0, 0);
    for layout in [TexelLayout::Bits32, TexelLayout::Bits64] {
        for taps in [Taps::Diagonal, Taps::Cross, LONG] {
            for (softness, strictest) in [(0.0, 1.0), (0.1, 0.94)] {
                let kind = FusedFilter { taps, softness, ..Default::default() };
                let on_ink = FusedPass::new(&gpu.device, &kind, layout, InkTarget::Ink).unwrap();
                let on_picture = FusedPass::new(&gpu.device, &kind, layout, PICTURE).unwrap();
                for size in SIZES {
                    for texels in pictures(size, layout, &mut random) {
                        let from = view(&gpu.upload(texel_format(layout), size, &bytes(&texels, layout)));
                        for filter in filters(strictest) {
                            if size != SIZES[8] && random.below(4) > 0 {
                                continue;
                            }
                            let filter = FusedFilter { taps, softness, ..filter };
                            let expected = by_cpu(&texels, size, &filter, layout);
                            let draw = |pass: &FusedPass, target, composite: &Composite| {
                                drawn(gpu, size, target, composite, None, |encoder, target| {
                                    let code = code(layout);
                                    pass.record(&gpu.device, encoder, &filter, &code, &from, target).unwrap();
                                })
                            };
                            let got = draw(&on_ink, InkTarget::Ink, &Composite::default());
                            if softness == 0.0 {
                                assert_eq!(got, expected, "{filter:?} {layout:?} {size:?}");
                            } else {
                                assert!(difference(&got, &expected) <= 1, "{filter:?} {layout:?} {size:?}");
                            }
                            inked += expected.iter().filter(|&&ink| ink > 0).count();
                            pixels += expected.len();
                            // What it gives is the same whatever is done with it: each form now and then.
                            let composite = &random.one_of(&COMPOSITES);
                            let got = draw(&on_picture, PICTURE, composite);
                            let over = composited(size, &expected, composite);
                            borderline += assert_composited(&got, &over, &expected, composite, softness > 0.0);
                        }
                    }
                }
            }
        }
    }
    println!("{inked} of {pixels} pixels are ink; {borderline} at an alpha test's reference decided the other way");
    assert!(inked * 10 > pixels && inked * 10 < pixels * 9);
    assert!(borderline * 10_000 < pixels);
}

#[test]
fn lines_are_drawn_within_their_area() {
    let Some(gpu) = gpu() else { return };
    let (size, layout, filter) = ([61, 37], TexelLayout::Bits64, FusedFilter::default());
    let texels = &pictures(size, layout, &mut Random(12))[2];
    let from = view(&gpu.upload(texel_format(layout), size, &bytes(texels, layout)));
    for target in [InkTarget::Ink, PICTURE] {
        let pass = FusedPass::new(&gpu.device, &filter, layout, target).unwrap();
        assert_areas(gpu, size, target, |encoder, target| {
            pass.record(&gpu.device, encoder, &filter, &code(layout), &from, target).unwrap();
        });
    }
}

//! The filters and the inker of 2002.

use crate::device::{gpu, view};
use crate::inputs::{LONG, Random, SIZES, direction, px, scene};
use crate::targets::{COMPOSITES, PICTURE, assert_areas, assert_composited, composited, drawn};
use npr_imagespace::ImageSpaceError;
use npr_imagespace::composite::{AlphaTest, Composite};
use npr_imagespace::filter::depth::DepthPlain;
use npr_imagespace::filter::inker::{Inker, InkerForm};
use npr_imagespace::filter::printed::*;
use npr_imagespace::format::printed::{CLEAR, CLEAR_PRINTED, ink_printed_encode};
use npr_imagespace::pass::InkTarget;
use npr_imagespace::pass::printed::PrintedPass;
use npr_imagespace::picture::{Taps, filter_picture};

type Texels = Vec<[u8; 4]>;

/// Pictures of a size: noise, surfaces at random, a scene over either clear colour, none.
fn pictures(size: [u32; 2], random: &mut Random) -> Vec<Texels> {
    let len = (size[0] * size[1]) as usize;
    let noise = (0..len).map(|_| random.bits().to_le_bytes()).collect();
    let surfaces = (0..len).map(|_| match random.below(4) {
        0 => CLEAR,
        1 => CLEAR_PRINTED,
        _ => {
            let (normal, depth) = (direction(random), random.one_of(&[0.0, 0.4, 0.41, 0.42, 0.45, 1.0]));
            ink_printed_encode(normal, depth)
        }
    });
    let surfaces = surfaces.collect();
    let over = |clear: [u8; 4]| {
        let texel = |seen: Option<crate::inputs::Surface>| {
            seen.map_or(clear, |seen| ink_printed_encode(seen.normal, (seen.depth - 1.0) / 20.0))
        };
        scene(size).into_iter().map(texel).collect()
    };
    vec![noise, surfaces, over(CLEAR), over(CLEAR_PRINTED), vec![CLEAR; len]]
}

fn edges() -> Vec<PrintedEdges> {
    let mut all = vec![PrintedEdges::default(), PrintedEdges { normal: None, depth: None, ..Default::default() }];
    for printed_background in [false, true] {
        for cos in [0.85, 0.8, 1.0] {
            let normal = Some(PrintedNormal { cos, printed_background });
            all.push(PrintedEdges { normal, depth: None, ..Default::default() });
        }
    }
    for form in [DepthPlain::Sum, DepthPlain::SumPrinted, DepthPlain::Any] {
        for threshold in [0.02, 0.01] {
            let depth = Some(PrintedDepth { form, threshold });
            all.push(PrintedEdges { normal: None, depth, ..Default::default() });
            all.push(PrintedEdges { depth, ..Default::default() });
        }
    }
    for co_issued in [AlphaTest::PRINTED, AlphaTest::CORRECTED, AlphaTest { less: false, reference: 5 }].map(Some) {
        all.push(PrintedEdges { co_issued, ..Default::default() });
        let depth = Some(PrintedDepth { form: DepthPlain::SumPrinted, threshold: 0.02 });
        all.push(PrintedEdges { co_issued, normal: None, depth, ..Default::default() });
    }
    all
}

#[test]
fn edges_are_those_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(31);
    let (mut inked, mut pixels) = (0, 0);
    for edges in edges() {
        for taps in [Taps::Diagonal, Taps::Cross, LONG] {
            let edges = PrintedEdges { taps, ..edges };
            let filter = PrintedFilter::Edges(edges);
            let uniform = PrintedUniform::new(&edges).unwrap();
            let on_ink = PrintedPass::new(&gpu.device, &filter, InkTarget::Ink).unwrap();
            let on_picture = PrintedPass::new(&gpu.device, &filter, PICTURE).unwrap();
            for size in SIZES {
                for texels in pictures(size, &mut random) {
                    if size != SIZES[8] && random.below(4) > 0 {
                        continue;
                    }
                    let from = view(&gpu.upload(wgpu::TextureFormat::Rgba8Unorm, size, texels.as_flattened()));
                    let draw = |pass: &PrintedPass, target, composite: &Composite| {
                        drawn(gpu, size, target, composite, None, |encoder, target| {
                            pass.record(&gpu.device, encoder, &filter, &from, target).unwrap();
                        })
                    };
                    let expected = filter_picture(&texels, px(size), taps, |centre, taps| {
                        f32::from(u8::from(ink_printed_edges(&edges, &uniform, centre, taps)))
                    })
                    .unwrap();
                    let got = draw(&on_ink, InkTarget::Ink, &Composite::default());
                    assert_eq!(got, expected, "{edges:?} {size:?}");
                    inked += expected.iter().filter(|&&ink| ink > 0).count();
                    pixels += expected.len();
                    let composite = &random.one_of(&COMPOSITES);
                    let over = draw(&on_picture, PICTURE, composite);
                    assert_composited(&over, &composited(size, &expected, composite), &expected, composite, false);
                }
            }
        }
    }
    println!("{inked} of {pixels} pixels are ink");
    assert!(inked * 10 > pixels && inked * 10 < pixels * 9);
}

#[test]
fn the_inker_is_that_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(32);
    let (mut inked, mut pixels, mut borderline) = (0, 0, 0);
    for form in [InkerForm::Printed, InkerForm::Corrected, InkerForm::Explicit] {
        // Soft, the explicit form needs a lower threshold.
        for (softness, normal_cos, taps) in [(0.0, 0.9, Taps::Diagonal), (0.5, 0.86, Taps::Diagonal), (0.0, 0.9, LONG)]
        {
            let inker = Inker { form, softness, normal_cos, taps, ..Default::default() };
            let off = u8::from(softness > 0.0);
            // With thresholds off by what rounding amounts to, towards less ink and towards more.
            let shaken = [1.0f32, -1.0].map(|sign| Inker {
                normal_cos: inker.normal_cos - sign * 1e-6,
                depth_delta: inker.depth_delta * (1.0 + sign * 1e-6),
                ..inker
            });
            let filter = PrintedFilter::Inker(inker);
            let pass = PrintedPass::new(&gpu.device, &filter, InkTarget::Ink).unwrap();
            for size in SIZES {
                for texels in pictures(size, &mut random) {
                    let from = view(&gpu.upload(wgpu::TextureFormat::Rgba8Unorm, size, texels.as_flattened()));
                    let got = drawn(gpu, size, InkTarget::Ink, &Composite::default(), None, |encoder, target| {
                        pass.record(&gpu.device, encoder, &filter, &from, target).unwrap();
                    });
                    let [less, more] = shaken.map(|inker| {
                        let ink = |_, taps: [[u8; 4]; 4]| ink_printed_inker(&inker, taps) as f32;
                        filter_picture(&texels, px(size), inker.taps, ink).unwrap()
                    });
                    for (i, &got) in got.iter().enumerate() {
                        let (less, more) = (less[i], more[i]);
                        let is_right = got >= less.saturating_sub(off) && got <= more.saturating_add(off);
                        assert!(is_right, "{got} for {less}..{more} at {i} of {size:?}, {inker:?}");
                        borderline += usize::from(more.saturating_sub(less) > 2);
                        inked += usize::from(got > 0);
                        pixels += 1;
                    }
                }
            }
        }
    }
    println!("{inked} of {pixels} pixels are ink, {borderline} lie at a threshold");
    assert!(inked * 10 > pixels && inked * 10 < pixels * 9 && borderline * 1000 <= pixels);
}

#[test]
fn lines_are_drawn_within_their_area() {
    let Some(gpu) = gpu() else { return };
    let size = [61, 37];
    let texels = &pictures(size, &mut Random(33))[2];
    let from = view(&gpu.upload(wgpu::TextureFormat::Rgba8Unorm, size, texels.as_flattened()));
    for filter in [PrintedFilter::default(), PrintedFilter::Inker(Inker::default())] {
        for target in [InkTarget::Ink, PICTURE] {
            let pass = PrintedPass::new(&gpu.device, &filter, target).unwrap();
            assert_areas(gpu, size, target, |encoder, target| {
                pass.record(&gpu.device, encoder, &filter, &from, target).unwrap();
            });
        }
    }
}

#[test]
fn thresholds_out_of_range_are_refused() {
    let usual = PrintedEdges::default();
    for cos in [-0.1, 1.1, f32::NAN] {
        let normal = Some(PrintedNormal { cos, printed_background: false });
        let error = PrintedUniform::new(&PrintedEdges { normal, ..usual }).unwrap_err();
        assert!(matches!(error, ImageSpaceError::NormalThreshold { .. }));
    }
    for threshold in [-0.1, f32::NAN, f32::INFINITY] {
        let depth = Some(PrintedDepth { form: DepthPlain::Any, threshold });
        let error = PrintedUniform::new(&PrintedEdges { depth, ..usual }).unwrap_err();
        assert!(matches!(error, ImageSpaceError::DepthStep { .. }));
    }
    let Some(gpu) = gpu() else { return };
    let from = view(&gpu.texture(wgpu::TextureFormat::Rgba8Unorm, [2, 2]));
    let refused = |softness| {
        let filter = PrintedFilter::Inker(Inker { softness, ..Default::default() });
        let pass = PrintedPass::new(&gpu.device, &filter, InkTarget::Ink).unwrap();
        let mut refused = None;
        drawn(gpu, [2, 2], InkTarget::Ink, &Composite::default(), None, |encoder, target| {
            refused = pass.record(&gpu.device, encoder, &filter, &from, target).err();
        });
        refused
    };
    assert!(matches!(refused(f32::NAN), Some(ImageSpaceError::Softness { .. })));
    assert!(matches!(refused(0.5), Some(ImageSpaceError::InkerSoftness { .. })));
    assert_eq!(refused(0.0), None);
}

//! Discs.

use crate::device::{gpu, view};
use crate::inputs::{Random, SIZES, inks, px};
use crate::targets::{PICTURE, assert_areas, composited, difference, drawn};
use npr_imagespace::ImageSpaceError;
use npr_imagespace::composite::Composite;
use npr_imagespace::morphology::Operation;
use npr_imagespace::morphology::disc::{Disc, DiscBuffers, dilate_disc};
use npr_imagespace::morphology::flood::{disc_plan, flood};
use npr_imagespace::pass::disc::{DiscPass, DiscScratch};
use npr_imagespace::pass::{INK_FORMAT, InkTarget};

const OPERATIONS: [Operation; 4] = [Operation::Dilate, Operation::Erode, Operation::Open, Operation::Close];

/// The floods of an operation, one after the other.
fn flooded(ink: &[u8], size: [u32; 2], operation: Operation, disc: &Disc) -> Vec<u8> {
    let dilated = |ink: &[u8]| flood(ink, px(size), disc, &disc_plan(disc)).unwrap();
    let inverse = |ink: &[u8]| ink.iter().map(|ink| !ink).collect::<Vec<u8>>();
    let eroded = |ink: &[u8]| inverse(&dilated(&inverse(ink)));
    match operation {
        Operation::Dilate => dilated(ink),
        Operation::Erode => eroded(ink),
        Operation::Open => dilated(&eroded(ink)),
        Operation::Close => eroded(&dilated(ink)),
    }
}

#[test]
fn discs_are_the_floods_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let pass = DiscPass::new(&gpu.device, InkTarget::Ink).unwrap();
    let mut random = Random(5);
    let (mut soft, mut off) = (0, 0);
    for size in SIZES {
        // Reused, with what another radius has left in it.
        let scratch = DiscScratch::new(&gpu.device, size);
        for ink in inks(size, &mut random) {
            let from = view(&gpu.upload(INK_FORMAT, size, &ink));
            for radius_px in [0.0, 0.7, 1.0, 1.5, 3.0, 4.0, 6.3, 17.0, 33.0, 64.0, 300.0] {
                for antialias in [false, true] {
                    let disc = Disc { radius_px, antialias };
                    for operation in OPERATIONS {
                        if random.below(4) > 0 {
                            continue;
                        }
                        let got = drawn(gpu, size, InkTarget::Ink, &Composite::default(), None, |encoder, target| {
                            pass.record(&gpu.device, encoder, operation, &disc, &from, &scratch, target).unwrap();
                        });
                        let expected = flooded(&ink, size, operation, &disc);
                        if antialias {
                            assert!(difference(&got, &expected) <= 1, "{operation:?} {disc:?} {size:?}");
                            soft += 1;
                            off += u32::from(got != expected);
                        } else {
                            assert_eq!(got, expected, "{operation:?} {disc:?} {size:?}");
                        }
                    }
                }
            }
        }
    }
    println!("{off} of {soft} soft pictures are off by 1/255 somewhere");
}

/// Both find the same wrong pixels, since they compare texels in the same order.
#[test]
fn floods_go_wrong_where_those_of_the_cpu_do() {
    let Some(gpu) = gpu() else { return };
    let size = [512, 512];
    let pass = DiscPass::new(&gpu.device, InkTarget::Ink).unwrap();
    let scratch = DiscScratch::new(&gpu.device, size);
    let mut random = Random(10);
    let (mut pixels, mut misses) = (0, 0);
    // Specks at distances of about the width of the disc, for which most errors occur.
    for (one_in, radius_px) in [(100, 9.0), (250, 9.0), (250, 16.0)] {
        let ink: Vec<u8> = (0..size[0] * size[1]).map(|_| if random.below(one_in) == 0 { 255 } else { 0 }).collect();
        let from = view(&gpu.upload(INK_FORMAT, size, &ink));
        let disc = Disc { radius_px, antialias: true };
        let got = drawn(gpu, size, InkTarget::Ink, &Composite::default(), None, |encoder, target| {
            pass.record(&gpu.device, encoder, Operation::Dilate, &disc, &from, &scratch, target).unwrap();
        });
        assert!(difference(&got, &flooded(&ink, size, Operation::Dilate, &disc)) <= 1, "{disc:?}");
        let mut exact = Vec::new();
        dilate_disc(&ink, px(size), &disc, &mut DiscBuffers::default(), &mut exact).unwrap();
        misses += got.iter().zip(&exact).filter(|(a, b)| a.abs_diff(**b) > 1).count();
        pixels += got.len();
    }
    println!("{misses} of {pixels} pixels differ from the exact disc");
    assert!(misses > 20 && misses * 1000 < pixels);
}

#[test]
fn the_widest_disc_covers_all_and_the_next_is_refused() {
    let Some(gpu) = gpu() else { return };
    let size = [70, 1];
    let pass = DiscPass::new(&gpu.device, InkTarget::Ink).unwrap();
    let scratch = DiscScratch::new(&gpu.device, size);
    let mut ink = vec![0; 70];
    ink[69] = 255;
    let from = view(&gpu.upload(INK_FORMAT, size, &ink));
    let run = |radius_px| {
        let disc = Disc { radius_px, antialias: false };
        let mut result = Ok(());
        let got = drawn(gpu, size, InkTarget::Ink, &Composite::default(), None, |encoder, target| {
            result = pass.record(&gpu.device, encoder, Operation::Dilate, &disc, &from, &scratch, target);
        });
        result.map(|()| got)
    };
    assert_eq!(run(32766.0).unwrap(), vec![255; 70]);
    for radius_px in [-1.0, 32767.0, f32::NAN] {
        assert!(matches!(run(radius_px), Err(ImageSpaceError::Radius { .. })));
    }
}

#[test]
fn a_disc_goes_at_once_over_a_picture_and_within_its_area() {
    let Some(gpu) = gpu() else { return };
    let size = [150, 61];
    let ink = &inks(size, &mut Random(6))[6];
    assert!(ink.contains(&255));
    let from = view(&gpu.upload(INK_FORMAT, size, ink));
    let scratch = DiscScratch::new(&gpu.device, size);
    for target in [InkTarget::Ink, PICTURE] {
        let pass = DiscPass::new(&gpu.device, target).unwrap();
        for (operation, disc) in [
            (Operation::Dilate, Disc { radius_px: 2.5, antialias: true }),
            (Operation::Dilate, Disc { radius_px: 40.0, antialias: false }),
            (Operation::Erode, Disc { radius_px: 7.0, antialias: false }),
            (Operation::Close, Disc { radius_px: 5.0, antialias: true }),
        ] {
            let record = |encoder: &mut wgpu::CommandEncoder, target: &npr_imagespace::pass::PassTarget<'_>| {
                pass.record(&gpu.device, encoder, operation, &disc, &from, &scratch, target).unwrap();
            };
            if operation != Operation::Erode {
                assert_areas(gpu, size, target, record);
            }
            if target == PICTURE {
                let over = Composite::default();
                let got = drawn(gpu, size, target, &over, None, record);
                assert!(difference(&got, &composited(size, &flooded(ink, size, operation, &disc), &over)) <= 1);
            }
        }
    }
}

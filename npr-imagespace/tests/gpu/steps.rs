//! Steps of dilation and erosion.

use crate::device::{gpu, view};
use crate::inputs::{Random, SIZES, inks, px};
use crate::targets::{PICTURE, assert_areas, composited, difference, drawn};
use npr_imagespace::ImageSpaceError;
use npr_imagespace::composite::Composite;
use npr_imagespace::morphology::*;
use npr_imagespace::pass::step::{PingPong, Step, StepPass};
use npr_imagespace::pass::{INK_FORMAT, InkTarget};
use npr_imagespace::picture::{Taps, ink_store};

const KERNELS: [Kernel; 3] = [Kernel::Diagonal, Kernel::Cross, Kernel::Square];

/// A soft step: its five taps are 0 outside the picture.
fn soft(ink: &[u8], [width, height]: [u32; 2], taps: Taps, step: impl Fn(f64, [f64; 4]) -> f64) -> Vec<u8> {
    let at = |x: i32, y: i32| {
        let inside = x >= 0 && y >= 0 && x < width as i32 && y < height as i32;
        if inside { f64::from(ink[y as usize * width as usize + x as usize]) / 255.0 } else { 0.0 }
    };
    let pixels = (0..height as i32).flat_map(|y| (0..width as i32).map(move |x| (x, y)));
    pixels
        .map(|(x, y)| ink_store(step(at(x, y), taps.offsets().map(|offset| at(x + offset.x, y + offset.y))) as f32))
        .collect()
}

#[test]
fn hard_steps_are_those_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(1);
    for kernel in KERNELS {
        for (step, eroding) in [(Step::Dilate(kernel), false), (Step::Erode(kernel), true)] {
            let pass = StepPass::new(&gpu.device, step, InkTarget::Ink).unwrap();
            for size in SIZES {
                for ink in inks(size, &mut random) {
                    let mut expected = Vec::new();
                    let by_cpu = if eroding { erode } else { dilate };
                    by_cpu(&ink, px(size), kernel, &mut expected).unwrap();
                    let from = view(&gpu.upload(INK_FORMAT, size, &ink));
                    let got = drawn(gpu, size, InkTarget::Ink, &Composite::default(), None, |encoder, target| {
                        pass.record(&gpu.device, encoder, &from, target).unwrap();
                    });
                    assert_eq!(got, expected, "{step:?} {size:?}");
                }
            }
        }
    }
}

#[test]
fn soft_steps_are_those_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(2);
    let thresholds = [0.25f32, 0.4, 1.0];
    let steps = [Step::SoftCross]
        .into_iter()
        .chain(thresholds.map(|threshold| Step::SoftDiagonal { threshold }))
        .chain(thresholds.map(|threshold| Step::SoftDiagonalPrinted { threshold }));
    for step in steps {
        let pass = StepPass::new(&gpu.device, step, InkTarget::Ink).unwrap();
        for size in SIZES {
            for ink in inks(size, &mut random) {
                let expected = match step {
                    Step::SoftCross => soft(&ink, size, Taps::Cross, ink_dilate_soft_cross),
                    Step::SoftDiagonal { threshold } => {
                        soft(&ink, size, Taps::Diagonal, |_, taps| ink_dilate_soft_diagonal(taps, threshold.into()))
                    }
                    Step::SoftDiagonalPrinted { threshold } => soft(&ink, size, Taps::Diagonal, |_, taps| {
                        ink_dilate_soft_diagonal_printed(taps, threshold.into())
                    }),
                    Step::Dilate(_) | Step::Erode(_) => unreachable!("soft ones"),
                };
                let from = view(&gpu.upload(INK_FORMAT, size, &ink));
                let got = drawn(gpu, size, InkTarget::Ink, &Composite::default(), None, |encoder, target| {
                    pass.record(&gpu.device, encoder, &from, target).unwrap();
                });
                assert!(difference(&got, &expected) <= 1, "{step:?} {size:?}");
            }
        }
    }
}

#[test]
fn steps_to_and_fro_are_those_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(3);
    for kernel in KERNELS {
        let pass = PingPong::new(&gpu.device, kernel);
        for operation in [Operation::Dilate, Operation::Erode, Operation::Open, Operation::Close] {
            for steps in [0, 1, 2, 5] {
                for size in [[1, 1], [3, 5], [61, 37]] {
                    for ink in inks(size, &mut random) {
                        let both = [gpu.upload(INK_FORMAT, size, &ink), gpu.texture(INK_FORMAT, size)];
                        let views = both.each_ref().map(view);
                        let mut holds = 2;
                        gpu.run(|encoder| {
                            let views = [&views[0], &views[1]];
                            holds = pass.record(&gpu.device, encoder, operation, steps, views).unwrap();
                        });
                        let expected = ping_pong(&ink, px(size), kernel, operation, steps).unwrap();
                        assert_eq!(gpu.read(&both[holds]), expected, "{kernel:?} {operation:?} {steps} {size:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_step_goes_at_once_over_a_picture_and_within_its_area() {
    let Some(gpu) = gpu() else { return };
    let size = [61, 37];
    let ink = &inks(size, &mut Random(9))[5];
    let from = view(&gpu.upload(INK_FORMAT, size, ink));
    for target in [InkTarget::Ink, PICTURE] {
        let pass = StepPass::new(&gpu.device, Step::Dilate(Kernel::Square), target).unwrap();
        assert_areas(gpu, size, target, |encoder, target| {
            pass.record(&gpu.device, encoder, &from, target).unwrap();
        });
        if target == PICTURE {
            let mut thick = Vec::new();
            dilate(ink, px(size), Kernel::Square, &mut thick).unwrap();
            let got = drawn(gpu, size, target, &Composite::Multiply, None, |encoder, target| {
                pass.record(&gpu.device, encoder, &from, target).unwrap();
            });
            assert!(difference(&got, &composited(size, &thick, &Composite::Multiply)) <= 1);
        }
    }
}

#[test]
fn thresholds_that_are_none_are_refused() {
    let Some(gpu) = gpu() else { return };
    for threshold in [-0.1, f32::NAN, f32::INFINITY] {
        let step = Step::SoftDiagonal { threshold };
        let refused = StepPass::new(&gpu.device, step, InkTarget::Ink).unwrap_err();
        assert!(matches!(refused, ImageSpaceError::StepThreshold { .. }));
    }
}

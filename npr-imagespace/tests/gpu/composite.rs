//! Ink over pictures.

use crate::device::{gpu, view};
use crate::inputs::{Random, inks, px};
use crate::targets::{COMPOSITES, PICTURE, assert_areas, assert_composited, before, difference, drawn};
use npr_imagespace::composite::Composite;
use npr_imagespace::pass::composite::CompositePass;
use npr_imagespace::pass::{INK_FORMAT, InkTarget};
use npr_imagespace::resample::{composite_resampled, resample};

/// Of the picture and of its ink: the same, half, double, odd ones, hardly any, and none that is a ratio.
const SIZES: [([u32; 2], [u32; 2]); 11] = [
    ([32, 18], [32, 18]),
    ([32, 18], [16, 9]),
    ([32, 18], [64, 36]),
    ([33, 17], [16, 8]),
    ([33, 17], [17, 9]),
    ([33, 17], [66, 34]),
    ([40, 30], [27, 41]),
    ([1, 1], [2, 2]),
    ([9, 1], [1, 1]),
    ([1, 9], [5, 5]),
    ([12, 7], [200, 300]),
];

#[test]
fn ink_of_any_size_is_laid_as_the_cpu_lays_it() {
    let Some(gpu) = gpu() else { return };
    let (on_ink, on_picture) =
        (CompositePass::new(&gpu.device, InkTarget::Ink).unwrap(), CompositePass::new(&gpu.device, PICTURE).unwrap());
    let mut random = Random(7);
    let mut borderline = 0;
    for (size, ink_size) in SIZES {
        for ink in inks(ink_size, &mut random) {
            let from = view(&gpu.upload(INK_FORMAT, ink_size, &ink));
            let expected = resample(&ink, px(ink_size), px(size)).unwrap();
            let got = drawn(gpu, size, InkTarget::Ink, &Composite::default(), None, |encoder, target| {
                on_ink.record(&gpu.device, encoder, &from, target).unwrap();
            });
            assert!(difference(&got, &expected) <= 1, "{size:?} {ink_size:?}");
            if size == ink_size {
                assert_eq!(got, ink);
            }
            for composite in COMPOSITES {
                let got = drawn(gpu, size, PICTURE, &composite, None, |encoder, target| {
                    on_picture.record(&gpu.device, encoder, &from, target).unwrap();
                });
                let mut pixels: Vec<[u8; 4]> = bytemuck::pod_collect_to_vec(&before(size, PICTURE));
                composite_resampled(&mut pixels, px(size), &ink, px(ink_size), &composite).unwrap();
                borderline += assert_composited(&got, &pixels.concat(), &expected, &composite, size != ink_size);
            }
        }
    }
    println!("{borderline} pixels at an alpha test's reference decided the other way");
    assert!(borderline < 20);
}

#[test]
fn ink_is_laid_within_its_area() {
    let Some(gpu) = gpu() else { return };
    for (size, ink_size) in [([61, 37], [61, 37]), ([61, 37], [30, 18])] {
        let from = view(&gpu.upload(INK_FORMAT, ink_size, &inks(ink_size, &mut Random(8))[4]));
        for target in [InkTarget::Ink, PICTURE] {
            let pass = CompositePass::new(&gpu.device, target).unwrap();
            assert_areas(gpu, size, target, |encoder, target| {
                pass.record(&gpu.device, encoder, &from, target).unwrap();
            });
        }
    }
}

#[test]
fn other_formats_of_pictures_take_lines_too() {
    let Some(gpu) = gpu() else { return };
    let size = [5, 4];
    let ink: Vec<u8> = (0..20).map(|i| i * 13).collect();
    let from = view(&gpu.upload(INK_FORMAT, size, &ink));
    let red = Composite::Over { color: glam::Vec3::X, opacity: 1.0 };
    let bgra = wgpu::TextureFormat::Bgra8Unorm;
    let pass = CompositePass::new(&gpu.device, InkTarget::Picture(bgra)).unwrap();
    let texture = gpu.upload(bgra, size, &[0, 0, 0, 9].repeat(20));
    let target = view(&texture);
    gpu.run(|encoder| {
        let target = npr_imagespace::pass::PassTarget { view: &target, composite: &red, area: None };
        pass.record(&gpu.device, encoder, &from, &target).unwrap();
    });
    let expected: Vec<u8> = ink.iter().flat_map(|&ink| [0, 0, ink, 9]).collect();
    assert_eq!(gpu.read(&texture), expected);
    let half = wgpu::TextureFormat::Rgba16Float;
    let pass = CompositePass::new(&gpu.device, InkTarget::Picture(half)).unwrap();
    let texture = gpu.upload(half, size, bytemuck::cast_slice(&[0u16, 0, 0, 0x3c00].repeat(20)));
    let target = view(&texture);
    gpu.run(|encoder| {
        let target = npr_imagespace::pass::PassTarget { view: &target, composite: &red, area: None };
        pass.record(&gpu.device, encoder, &from, &target).unwrap();
    });
    let halves: Vec<u16> = bytemuck::pod_collect_to_vec(&gpu.read(&texture));
    for (got, &ink) in halves.chunks(4).zip(&ink) {
        let red = npr_imagespace::format::half::ink_half_decode(got[0]);
        // Halves below 1 are 1/2048 apart.
        assert!((red - f32::from(ink) / 255.0).abs() < 1.0 / 2048.0, "{red} {ink}");
        assert_eq!(got[1..], [0, 0, 0x3c00]);
    }
}

//! Runs a pass over its target, the whole and areas of it.

use crate::device::{Gpu, view};
use crate::inputs::Random;
use glam::Vec3;
use npr_imagespace::composite::{AlphaTest, Composite, composite_picture};
use npr_imagespace::pass::{INK_FORMAT, InkTarget, PassTarget};

/// A picture that is written in display space.
pub const PICTURE: InkTarget = InkTarget::Picture(wgpu::TextureFormat::Rgba8Unorm);

/// Each form.
pub const COMPOSITES: [Composite; 5] = [
    Composite::Multiply,
    Composite::AlphaTested(AlphaTest::CORRECTED),
    Composite::AlphaTested(AlphaTest::PRINTED),
    Composite::Over { color: Vec3::ZERO, opacity: 1.0 },
    Composite::Over { color: Vec3::new(0.9, 0.2, 0.5), opacity: 0.7 },
];

/// Pixels that nothing is drawn on yet: ink left over from another frame, or a picture.
pub fn before(size: [u32; 2], target: InkTarget) -> Vec<u8> {
    let (mut random, len) = (Random(4), (size[0] * size[1]) as usize);
    match target {
        InkTarget::Ink => vec![77; len],
        InkTarget::Picture(_) => (0..4 * len).map(|_| random.bits() as u8).collect(),
    }
}

/// What a pass leaves in its target: bytes of ink, or of RGBA.
pub fn drawn(
    gpu: &Gpu,
    size: [u32; 2],
    target: InkTarget,
    composite: &Composite,
    area: Option<[u32; 4]>,
    record: impl FnOnce(&mut wgpu::CommandEncoder, &PassTarget<'_>),
) -> Vec<u8> {
    let format = match target {
        InkTarget::Ink => INK_FORMAT,
        InkTarget::Picture(format) => format,
    };
    let texture = gpu.upload(format, size, &before(size, target));
    gpu.run(|encoder| record(encoder, &PassTarget { view: &view(&texture), composite, area }));
    gpu.read(&texture)
}

/// Ink over the picture that [`before`] makes.
pub fn composited(size: [u32; 2], ink: &[u8], composite: &Composite) -> Vec<u8> {
    let mut pixels: Vec<[u8; 4]> = bytemuck::pod_collect_to_vec(&before(size, PICTURE));
    composite_picture(&mut pixels, ink, composite).unwrap();
    pixels.concat()
}

/// The pixels of a picture are within 1/255 of those with `ink` composited over it by the CPU. Returns the
/// number of pixels that may differ: those at the reference of an alpha test, which rounding decides where ink is
/// `soft`.
pub fn assert_composited(got: &[u8], expected: &[u8], ink: &[u8], composite: &Composite, soft: bool) -> usize {
    let mut borderline = 0;
    for ((got, expected), &ink) in got.chunks(4).zip(expected.chunks(4)).zip(ink) {
        let may_differ = match composite {
            Composite::AlphaTested(test) => soft && (255 - ink).abs_diff(test.reference) <= 1,
            _ => false,
        };
        if difference(got, expected) > 1 {
            assert!(may_differ, "{got:?} for {expected:?} under {ink}, {composite:?}");
            borderline += 1;
        }
    }
    borderline
}

/// The largest difference of two pictures.
pub fn difference(a: &[u8], b: &[u8]) -> u8 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

/// Within an area there is what a pass over all would leave there, and outside there is paper, or the picture as it
/// was.
pub fn assert_areas(
    gpu: &Gpu,
    size: [u32; 2],
    target: InkTarget,
    record: impl Fn(&mut wgpu::CommandEncoder, &PassTarget<'_>),
) {
    let [width, height] = size;
    let composite = Composite::default();
    let whole = drawn(gpu, size, target, &composite, None, &record);
    let untouched = match target {
        InkTarget::Ink => vec![0; whole.len()],
        InkTarget::Picture(_) => before(size, target),
    };
    assert_ne!(whole, untouched, "nothing is drawn that an area could cut");
    let bytes = whole.len() / (width * height) as usize;
    let areas = [
        [0, 0, 1, 1],
        [width / 3, height / 4, width / 2, height / 2],
        [width - 1, height - 1, 1, 1],
        [width / 2 + 1, 0, width - width / 2 - 1, height],
        [5, 3, 0, 4],
        [0, 0, width, height],
    ];
    for area in areas {
        let part = drawn(gpu, size, target, &composite, Some(area), &record);
        for (i, got) in part.chunks(bytes).enumerate() {
            let (x, y) = (i as u32 % width, i as u32 / width);
            let is_within = x >= area[0] && x < area[0] + area[2] && y >= area[1] && y < area[1] + area[3];
            let expected = if is_within { &whole } else { &untouched };
            assert_eq!(got, &expected[i * bytes..][..bytes], "{area:?} of {size:?} at {x}, {y}");
        }
    }
}

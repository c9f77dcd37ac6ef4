//! How separate textures are read, and which tap of which test is ink: hand-computed values.

use approx::assert_abs_diff_eq;
use glam::{DVec3, UVec2, Vec3};
use npr_imagespace::ImageSpaceError;
use npr_imagespace::filter::separate::*;
use npr_imagespace::picture::Taps;

const NONE: SeparateFilter =
    SeparateFilter { normal: None, depth: None, regions: false, taps: Taps::Diagonal, softness: 0.0 };
const SURFACE: SeparateTexel = SeparateTexel { normal: Vec3::Z, depth: 1.0, region: 1 };

fn reads(source: DepthSource, parallel: bool) -> SeparateUniform {
    let depth = SeparateDepth { source, parallel, ..Default::default() };
    SeparateUniform::new(&SeparateFilter { depth: Some(depth), ..NONE }).unwrap()
}

/// The table of the module's documentation, with n = 1 and f = 4, and with n = 2 and an infinite f.
#[test]
fn scale_and_bias_of_each_projection_are_those_of_the_table() {
    let buffer = |scale, bias, clear| DepthSource::Buffer { scale, bias, clear };
    assert_eq!(DepthSource::perspective(1.0, 4.0), Ok(buffer(-0.75, 1.0, 1.0)));
    assert_eq!(DepthSource::perspective(2.0, f32::INFINITY), Ok(buffer(-0.5, 0.5, 1.0)));
    assert_eq!(DepthSource::reversed(1.0, 4.0), Ok(buffer(0.75, 0.25, 0.0)));
    assert_eq!(DepthSource::reversed(2.0, f32::INFINITY), Ok(buffer(0.5, 0.0, 0.0)));
    assert_eq!(DepthSource::parallel(1.0, 4.0), Ok(buffer(3.0, 1.0, 1.0)));
    assert_eq!(DepthSource::parallel_reversed(1.0, 4.0), Ok(buffer(-3.0, 4.0, 0.0)));
    let finite = [DepthSource::parallel, DepthSource::parallel_reversed];
    let any = [DepthSource::perspective, DepthSource::reversed];
    for (near, far) in [(0.0, 4.0), (-1.0, 4.0), (4.0, 4.0), (4.0, 1.0), (f32::INFINITY, f32::INFINITY)] {
        for source in finite.iter().chain(&any) {
            assert_eq!(source(near, far), Err(ImageSpaceError::DepthRange { near, far }));
        }
    }
    assert!(finite.iter().all(|source| source(1.0, f32::INFINITY).is_err()));
}

#[test]
fn a_depth_buffer_s_number_becomes_the_depth_it_was_made_of() {
    let (near, far, infinite) = (1.0, 4.0, f32::INFINITY);
    // Half way between 1/1 and 1/4 is 5/8; between 1/2 and 0 it is 1/4.
    for (source, parallel, numbers) in [
        (DepthSource::perspective(near, far), false, [(0.0, 1.0), (0.5, 1.6), (1.0, 0.0)]),
        (DepthSource::reversed(near, far), false, [(1.0, 1.0), (0.5, 1.6), (0.0, 0.0)]),
        (DepthSource::perspective(2.0, infinite), false, [(0.0, 2.0), (0.5, 4.0), (1.0, 0.0)]),
        (DepthSource::reversed(2.0, infinite), false, [(1.0, 2.0), (0.5, 4.0), (0.0, 0.0)]),
        (DepthSource::parallel(near, far), true, [(0.0, 1.0), (0.5, 2.5), (1.0, 0.0)]),
        (DepthSource::parallel_reversed(near, far), true, [(1.0, 1.0), (0.5, 2.5), (0.0, 0.0)]),
    ] {
        let uniform = reads(source.unwrap(), parallel);
        for (number, depth) in numbers {
            assert_abs_diff_eq!(ink_separate_depth(number, &uniform), depth, epsilon = 1e-6);
        }
    }
    // Beside the far end: 1/4, or 4, and not what the buffer is cleared to.
    for (source, parallel, number) in [
        (DepthSource::perspective(near, far), false, 1.0f32.next_down()),
        (DepthSource::reversed(near, far), false, 1e-30),
        (DepthSource::parallel(near, far), true, 1.0f32.next_down()),
        (DepthSource::parallel_reversed(near, far), true, 1e-30),
    ] {
        assert_abs_diff_eq!(ink_separate_depth(number, &reads(source.unwrap(), parallel)), 4.0, epsilon = 1e-5);
    }
    // Behind the eye, and at it.
    let reversed = reads(DepthSource::reversed(2.0, infinite).unwrap(), false);
    assert_eq!([ink_separate_depth(-0.5, &reversed), ink_separate_depth(f32::INFINITY, &reversed)], [0.0; 2]);
}

#[test]
fn linear_depths_are_kept_if_a_surface_can_have_them() {
    let linear = reads(DepthSource::Linear, false);
    for depth in [f32::MIN_POSITIVE, 1e-3, 7.0, f32::MAX] {
        assert_eq!(ink_separate_depth(depth, &linear), depth);
    }
    let below = f32::MIN_POSITIVE.next_down();
    for depth in [0.0, -0.0, below, -below, -f32::MIN_POSITIVE, -7.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
        assert_eq!(ink_separate_depth(depth, &linear).to_bits(), 0, "{depth}");
    }
}

#[test]
fn normals_of_any_length_and_sign_are_made_unit_and_what_is_none_is_zero() {
    for length in [f32::MIN_POSITIVE, 1e-20, 1.0, 3.0, f32::MAX] {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z] {
            assert_eq!(ink_separate_normal(axis * length, false), axis.as_dvec3(), "{length}");
        }
    }
    for (texel, normal) in [
        (Vec3::new(-6.0, 0.0, 8.0), DVec3::new(-0.6, 0.0, 0.8)),
        (Vec3::new(0.0, -3e30, -4e30), DVec3::new(0.0, -0.6, -0.8)),
    ] {
        assert!(ink_separate_normal(texel, false).abs_diff_eq(normal, 1e-7), "{texel}");
    }
    let below = f32::MIN_POSITIVE.next_down();
    for none in [0.0, -0.0, below, -below, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, -f32::NAN] {
        assert_eq!(ink_separate_normal(Vec3::new(0.0, none, 0.0), false), DVec3::ZERO, "{none}");
    }
    // Stored as (n + 1) / 2: 1/2 is 0.
    for (texel, normal) in [
        (Vec3::new(1.0, 0.5, 0.5), DVec3::X),
        (Vec3::new(0.0, 0.5, 0.5), DVec3::NEG_X),
        (Vec3::new(0.5, 0.0, 0.5), DVec3::NEG_Y),
        (Vec3::new(0.5, 0.5, 0.75), DVec3::Z),
        (Vec3::ZERO, DVec3::ZERO),
        (Vec3::splat(0.5), DVec3::ZERO),
    ] {
        assert_eq!(ink_separate_normal(texel, true), normal, "{texel}");
    }
    // As signed numbers these are other vectors.
    assert_eq!(ink_separate_normal(Vec3::new(0.0, 0.5, 0.0), false), DVec3::Y);
}

/// One tap of four that differs is a line, if lines are hard, and half of one if they are soft.
#[test]
fn one_tap_across_a_border_is_all_of_a_hard_line_and_half_of_a_soft_one() {
    let folded = SeparateTexel { normal: Vec3::NEG_Z, ..SURFACE };
    let other = SeparateTexel { region: 2, ..SURFACE };
    let behind = SeparateTexel { depth: 9.0, ..SURFACE };
    let no_surface = SeparateTexel { depth: f32::INFINITY, ..SURFACE };
    let depth = |test| Some(SeparateDepth { test, ..Default::default() });
    let step = SeparateDepthTest::Step { step: 0.01 };
    let bend = SeparateDepthTest::Bend { step: 0.01 };
    let normals = SeparateFilter { normal: Some(SeparateNormal::default()), ..NONE };
    for (filter, inked, paper) in [
        (normals, vec![folded], vec![other, behind, no_surface]),
        (SeparateFilter { regions: true, ..NONE }, vec![other], vec![folded, behind, no_surface]),
        (SeparateFilter { depth: depth(step), ..NONE }, vec![behind, no_surface], vec![folded, other]),
        (SeparateFilter { depth: depth(bend), ..NONE }, vec![behind, no_surface], vec![folded, other]),
        (SeparateFilter::default(), vec![folded, other, behind, no_surface], vec![]),
        (NONE, vec![], vec![folded, other, behind, no_surface]),
    ] {
        for (softness, line) in [(0.0, 1.0), (0.25, 0.5)] {
            let filter = SeparateFilter { softness, ..filter };
            let uniform = SeparateUniform::new(&filter).unwrap();
            for place in 0..4 {
                let ink = |texel: &SeparateTexel| {
                    let mut taps = [SURFACE; 4];
                    taps[place] = *texel;
                    ink_separate(&filter, &uniform, &SURFACE, &taps)
                };
                assert!(inked.iter().all(|texel| ink(texel) == line), "{filter:?} {place}");
                assert!(paper.iter().all(|texel| ink(texel) == 0.0), "{filter:?} {place}");
                assert_eq!(ink(&SURFACE), 0.0, "{filter:?} {place}");
            }
        }
    }
}

/// The plain test on what the texture holds: its ramp is as wide as softness times its threshold.
#[test]
fn a_soft_plain_test_ramps_around_its_threshold() {
    use npr_imagespace::filter::depth::DepthPlain;
    let test = SeparateDepthTest::Plain { form: DepthPlain::Any, threshold: 0.25 };
    let depth = Some(SeparateDepth { test, ..Default::default() });
    for (softness, away, expected) in [
        (0.0, 0.125, 0.0),
        (0.0, 0.25, 1.0),
        (2.0, 0.0, 0.0),
        (2.0, 0.125, 0.25),
        (2.0, 0.25, 0.5),
        (2.0, 0.375, 0.75),
        (2.0, 0.5, 1.0),
    ] {
        let filter = SeparateFilter { depth, softness, ..NONE };
        let uniform = SeparateUniform::new(&filter).unwrap();
        let mut taps = [SURFACE; 4];
        taps[2].depth += away;
        assert_eq!(ink_separate(&filter, &uniform, &SURFACE, &taps), expected, "{softness} {away}");
    }
}

#[test]
fn a_picture_is_filtered_pixel_by_pixel() {
    let other = SeparateTexel { region: 2, ..SURFACE };
    let row = [SURFACE, SURFACE, other, other, other];
    let filter = SeparateFilter { regions: true, ..NONE };
    assert_eq!(filter_separate(&filter, &row, UVec2::new(5, 1)), Ok(vec![0, 255, 255, 0, 0]));
    let error = filter_separate(&filter, &row, UVec2::new(2, 2));
    assert_eq!(error, Err(ImageSpaceError::Length { len: 5, size_px: UVec2::new(2, 2) }));
}

//! Filters on hand-computed taps, against their definitions, on borders of the picture and on NaN.

use glam::{DVec3, IVec2, IVec3, UVec2, Vec3};
use npr_imagespace::ImageSpaceError;
use npr_imagespace::composite::AlphaTest;
use npr_imagespace::filter::depth::*;
use npr_imagespace::filter::fused::*;
use npr_imagespace::filter::ink_ramp;
use npr_imagespace::filter::inker::*;
use npr_imagespace::filter::normal::*;
use npr_imagespace::filter::printed::{PrintedEdges, PrintedUniform, ink_printed_edges, ink_printed_inker};
use npr_imagespace::filter::region::*;
use npr_imagespace::format::printed::{CLEAR, CLEAR_PRINTED, ink_printed_encode};
use npr_imagespace::format::texel::*;
use npr_imagespace::picture::*;
use proptest::prelude::*;

fn tilted(angle_deg: f64) -> DVec3 {
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    DVec3::new(sin, 0.0, cos)
}

#[test]
fn taps_lie_in_the_picture_and_opposite_ones_stay_opposite() {
    for size in [UVec2::new(1, 1), UVec2::new(1, 7), UVec2::new(2, 3), UVec2::new(5, 4)] {
        let long = Taps::Steps([IVec2::new(3, 1), IVec2::new(0, -2)]);
        for taps in [Taps::Diagonal, Taps::Cross, long] {
            for y in 0..size.y {
                for x in 0..size.x {
                    let reach = ink_reach(UVec2::new(x, y), size, taps.longest_px());
                    let offsets = taps.offsets().map(|offset| offset * reach);
                    assert_eq!((offsets[0], offsets[1]), (-offsets[2], -offsets[3]));
                    for offset in offsets {
                        let at = IVec2::new(x as i32, y as i32) + offset;
                        assert!(at.cmpge(IVec2::ZERO).all() && at.cmplt(size.as_ivec2()).all(), "{size} {x} {y}");
                    }
                }
            }
        }
    }
    assert_eq!(ink_reach(UVec2::new(0, 1), UVec2::new(1, 3), UVec2::ONE), IVec2::Y);
    assert_eq!(ink_reach(UVec2::new(2, 0), UVec2::new(4, 3), UVec2::ONE), IVec2::X);
}

#[test]
fn taps_lie_where_their_arrangement_says() {
    let at = |taps: Taps| taps.offsets().map(|offset| offset.to_array());
    assert_eq!(at(Taps::Diagonal), [[1, 1], [-1, 1], [-1, -1], [1, -1]]);
    assert_eq!(at(Taps::Cross), [[1, 0], [0, 1], [-1, 0], [0, -1]]);
    let steps = Taps::Steps([IVec2::new(3, -1), IVec2::new(0, 2)]);
    assert_eq!(at(steps), [[3, -1], [0, 2], [-3, 1], [0, -2]]);
    assert_eq!((steps.longest_px(), steps.weight()), (UVec2::new(3, 2), 1.0));
    assert_eq!(Taps::Steps([IVec2::new(2, 2), IVec2::new(-2, 2)]).weight(), Taps::Diagonal.weight());
    // A border between columns 15 and 16 inks as many pixels to each side as the steps are long.
    let regions: Vec<u32> = (0..32 * 32).map(|i| 1 + u32::from(i % 32 >= 16)).collect();
    for step in [1, 2, 5] {
        let taps = Taps::Steps([IVec2::new(step, step), IVec2::new(-step, step)]);
        let edge = |centre: u32, taps: [u32; 4]| ink_region(centre, taps, false, 0.5) as f32;
        let ink = filter_picture(&regions, UVec2::splat(32), taps, edge).unwrap();
        let inked: Vec<_> = (0..32).filter(|x| ink[16 * 32 + x] > 0).collect();
        assert_eq!(inked, (16 - step as usize..16 + step as usize).collect::<Vec<_>>());
    }
    for wrong in [IVec2::ZERO, IVec2::new(65, 0), IVec2::new(1, -65)] {
        let error = Err(ImageSpaceError::TapStep { step_px: wrong });
        assert_eq!(Taps::Steps([IVec2::ONE, wrong]).validate(), error);
        let ink = filter_picture(&[1u32], UVec2::ONE, Taps::Steps([wrong, IVec2::ONE]), |_, _| 0.0);
        assert_eq!(ink.map(|_| ()), error);
    }
}

#[test]
fn odd_pictures_are_filtered_to_their_borders() {
    let edge = |centre: u32, taps: [u32; 4]| ink_region(centre, taps, false, 0.5) as f32;
    let filtered = |regions: &[u32], width, height| {
        filter_picture(regions, UVec2::new(width, height), Taps::Diagonal, edge).unwrap()
    };
    assert_eq!(filtered(&[3], 1, 1), [0]);
    assert_eq!(filtered(&[], 0, 5), []);
    // A row and a column: the border between the second and the third.
    assert_eq!(filtered(&[1, 1, 2, 2, 2], 5, 1), [0, 255, 255, 0, 0]);
    assert_eq!(filtered(&[1, 1, 2, 2, 2], 1, 5), [0, 255, 255, 0, 0]);
    // A border beside the outermost column lies on the inner one, and in the corners there is nothing.
    assert_eq!(filtered(&[1, 2, 2, 1, 2, 2, 1, 2, 2], 3, 3), [0, 255, 0, 0, 255, 0, 0, 255, 0]);
    assert_eq!(
        filter_picture(&[1u32; 5], UVec2::new(2, 2), Taps::Cross, edge),
        Err(ImageSpaceError::Length { len: 5, size_px: UVec2::new(2, 2) })
    );
    assert_eq!([ink_store(f32::NAN), ink_store(-1.0), ink_store(0.5), ink_store(7.0)], [0, 0, 128, 255]);
}

#[test]
fn normals_at_the_two_thresholds() {
    let flat = [DVec3::Z; 4];
    for (cos, angle_deg) in [(NORMAL_COS_CARD_MITCHELL, 31.7), (NORMAL_COS_OUTLINING_SKETCH, 36.8)] {
        let cos = f64::from(cos);
        let with = |tap: DVec3, i: usize| {
            let mut taps = flat;
            taps[i] = tap;
            ink_normal(DVec3::Z, taps, cos, 0.0, 0.5)
        };
        for i in 0..4 {
            assert_eq!(with(tilted(angle_deg), i), 0.0);
            assert_eq!(with(tilted(angle_deg + 0.2), i), 1.0);
            assert_eq!(with(DVec3::ZERO, i), 1.0, "no normal differs from every normal");
        }
    }
    assert_eq!(ink_normal(DVec3::ZERO, [DVec3::ZERO; 4], 0.8, 0.0, 0.5), 0.0, "and not from itself");
    assert_eq!(ink_normal_printed(DVec3::ZERO, [DVec3::ZERO; 4], 0.8), 1.0, "which the printed form says it does");
    // Exactly at the threshold: white in print.
    assert_eq!(ink_normal_printed(DVec3::Z, [DVec3::new(0.6, 0.0, 0.8); 4], 0.8), 0.0);
}

#[test]
fn soft_normals_rise_from_paper_to_a_line() {
    let soft = |cos_tap: f64, across: usize| {
        let tap = DVec3::new((1.0 - cos_tap * cos_tap).sqrt(), 0.0, cos_tap);
        let taps = std::array::from_fn(|i| if i < across { tap } else { DVec3::Z });
        ink_normal(DVec3::Z, taps, 0.8, 0.1, 0.5)
    };
    assert_eq!([soft(0.86, 2), soft(0.74, 2), soft(0.74, 1), soft(0.74, 4)], [0.0, 1.0, 0.5, 1.0]);
    assert!((soft(0.8, 2) - 0.5).abs() < 1e-9 && (soft(0.825, 2) - 0.25).abs() < 1e-9);
    assert_eq!([ink_ramp(1e-9, 0.0), ink_ramp(0.0, 0.0), ink_ramp(0.0, 2.0)], [1.0, 0.0, 0.5]);
}

#[test]
fn bytes_are_compared_as_integers() {
    let threshold = normal_bytes_threshold(NORMAL_COS_CARD_MITCHELL);
    assert_eq!(threshold, 55272);
    let encode = |normal: DVec3| {
        let [x, y, z, _] = ink_printed_encode(normal.as_vec3(), 1.0);
        [x, y, z]
    };
    let with = |tap: [u8; 3]| ink_normal_bytes_edge(encode(DVec3::Z), [tap; 4], threshold);
    assert!(!with(encode(tilted(31.0))) && with(encode(tilted(33.0))));
    assert_eq!(ink_normal_bytes_dot([128, 128, 255], [128, 0, 255]), 1 - 255 + 65025);
    let clear = |texel: [u8; 4]| [texel[0], texel[1], texel[2]];
    assert!(with(clear(CLEAR)));
    assert!(!ink_normal_bytes_edge(clear(CLEAR), [clear(CLEAR); 4], threshold));
    // What faces the eye of a right-handed view has no normal edge against the printed clear colour.
    assert!(!with(clear(CLEAR_PRINTED)));
    let printed = |a: [u8; 3], b: [u8; 3]| ink_normal_bytes_edge_printed(a, [b; 4], threshold);
    assert!(!printed(encode(DVec3::Z), clear(CLEAR_PRINTED)));
    assert!(!printed(encode(DVec3::splat(-0.577)), clear(CLEAR)), "and no clear colour mends the printed filter");
}

#[test]
fn listing_10_counts_two_of_four() {
    // One neighbour 5 steps of 8 bits away is below 0.02, six are above.
    let threshold = depth_code_threshold(DEPTH_SUM_CARD_MITCHELL, 255);
    assert_eq!(threshold, 6);
    for i in 0..4 {
        let taps = |away: u32| std::array::from_fn(|j| if i == j { 100 + away } else { 100 });
        let edge = |form, away| ink_depth_plain_codes(100, taps(away), form, threshold);
        assert!(edge(DepthPlain::Sum, 6) && !edge(DepthPlain::Sum, 5), "tap {i}");
        assert_eq!(edge(DepthPlain::SumPrinted, 200 - 100), i == 0 || i == 3, "tap {i}");
        assert!(ink_depth_plain_codes(
            100,
            taps(3),
            DepthPlain::Any,
            depth_code_threshold(DEPTH_ANY_OUTLINING_SKETCH, 255)
        ));
        assert!(!ink_depth_plain_codes(
            100,
            taps(2),
            DepthPlain::Any,
            depth_code_threshold(DEPTH_ANY_OUTLINING_SKETCH, 255)
        ));
    }
    // Two steps each are eight together, and none alone is three.
    assert!(ink_depth_plain_codes(100, [98, 102, 98, 102], DepthPlain::Sum, threshold));
    assert!(!ink_depth_plain_codes(100, [98, 102, 98, 102], DepthPlain::SumPrinted, threshold));
    assert_eq!(ink_depth_plain(0.5, [0.5, 0.5, 0.5, 0.52], DepthPlain::Any, 0.01, 0.0), 1.0);
    assert_eq!(ink_depth_plain(0.5, [0.5, 0.51, 0.51, 0.5], DepthPlain::SumPrinted, 0.01, 0.0), 0.0);
    assert!((ink_depth_plain(0.5, [0.505, 0.505, 0.505, 0.5], DepthPlain::Sum, 0.02, 0.02) - 0.25).abs() < 1e-9);
    assert_eq!(ink_depth_plain(f64::NAN, [0.5; 4], DepthPlain::Sum, 0.02, 0.0), 0.0);
    assert_eq!(ink_depth_plain(0.5, [f64::NAN; 4], DepthPlain::Any, 0.02, 0.0), 0.0);
}

#[test]
fn second_differences_are_found_and_slopes_and_invalid_depths_are_not() {
    let bend = |centre, taps| ink_depth_bend(centre, taps, 0.01, false, 0.0, 0.5);
    // 1/z falls by 30% from pixel to pixel: a plane, and no line.
    let z = |inverse: f32| 1.0 / inverse;
    assert_eq!(bend(z(1.0), [z(0.7), z(1.3), z(1.3), z(0.7)]), 0.0);
    assert_eq!(bend(z(1.0), [z(0.7), z(1.3), z(1.32), z(0.7)]), 1.0);
    assert!(ink_depth_step(z(1.0), [z(0.7), z(1.3), z(1.3), z(0.7)], 0.01), "the plain test");
    // A step by 2% and one by ½%, on either side of it.
    assert_eq!([bend(10.0, [10.0, 10.0, 10.2, 10.2]), bend(10.2, [10.2, 10.2, 10.0, 10.0])], [1.0, 1.0]);
    assert_eq!(bend(10.0, [10.0, 10.0, 10.05, 10.05]), 0.0);
    // Background differs from surfaces and not from itself, whichever invalid depth it has.
    for none in [f32::INFINITY, f32::NAN, 0.0, -1.0, f32::NEG_INFINITY] {
        assert_eq!(bend(none, [f32::INFINITY, f32::NAN, 0.0, -2.0]), 0.0);
        assert_eq!(bend(none, [f32::INFINITY, 5.0, none, none]), 1.0);
        assert_eq!(bend(5.0, [5.0, 5.0, 5.0, none]), 1.0);
        assert!(ink_depth_step(5.0, [5.0, 5.0, 5.0, none], 0.01) && !ink_depth_step(none, [none; 4], 0.01));
        assert_eq!(ink_depth_bend(5.0, [5.0, 5.0, 5.0, none], 0.01, false, 0.5, 0.5), 0.5);
    }
    // Parallel: z itself, in units.
    let parallel = |taps| ink_depth_bend(10.0, taps, 0.5, true, 0.0, 0.5);
    assert_eq!(parallel([4.0, 10.0, 16.0, 10.0]), 0.0);
    assert_eq!(parallel([4.0, 10.0, 16.6, 10.0]), 1.0);
}

#[test]
fn a_soft_step_of_depth_ramps_around_a_share_of_the_nearer_side() {
    // All in 1/z, of which the larger is the nearer side: the threshold is 1/4 of it, and the ramp twice as wide.
    let ink = |centre: f32, taps: [f32; 4], weight| {
        ink_depth_step_soft(1.0 / centre, taps.map(|tap| 1.0 / tap), 0.25, 2.0, weight)
    };
    for (tap, expected) in [(1.0, 0.0), (0.875, 0.25), (0.75, 0.5), (0.625, 0.75), (0.5, 1.0), (0.25, 1.0)] {
        for place in 0..4 {
            let mut taps = [1.0; 4];
            taps[place] = tap;
            // From the nearer side, and from one of three on the other.
            assert!((ink(1.0, taps, 1.0) - expected).abs() < 1e-6, "{tap} {place}");
            assert!((ink(1.0, taps, 0.5) - 0.5 * expected).abs() < 1e-6, "{tap} {place}");
            let mut taps = [tap; 4];
            taps[place] = 1.0;
            assert!((ink(tap, taps, 0.5) - 0.5 * expected).abs() < 1e-6, "{tap} {place}");
        }
    }
    // Half as near, half the threshold.
    assert!((ink(0.5, [0.5, 0.375, 0.5, 0.5], 1.0) - 0.5).abs() < 1e-6);
    // Taps add up, to 1 at most.
    assert!((ink(1.0, [0.875, 0.75, 1.0, 1.0], 0.5) - 0.375).abs() < 1e-6);
    assert!((ink(1.0, [0.75; 4], 0.5) - 1.0).abs() < 1e-6);
    assert_eq!(ink(1.0, [0.5; 4], 0.5), 1.0);
    // Each tap across the border of the background counts in full, from either side.
    for none in [f32::INFINITY, f32::NAN, 0.0, -1.0] {
        let step = |centre, taps| ink_depth_step_soft(centre, taps, 0.25, 2.0, 0.25);
        assert_eq!(step(1.0, [1.0, none, 1.0, 1.0]), 0.25);
        assert_eq!(step(none, [1.0, none, 1.0, 1.0]), 0.75);
        assert_eq!(step(none, [none; 4]), 0.0);
    }
}

#[test]
fn a_hard_step_of_depth_is_more_than_a_share_of_the_nearer_side() {
    // In 1/z the farther of each pair is exactly half of the nearer, and half is what may be.
    for (near, far) in [(1.0f32, 2.0f32), (2.0, 4.0), (16.0, 32.0)] {
        for place in 0..4 {
            let step = |centre: f32, tap: f32| {
                let mut taps = [centre; 4];
                taps[place] = tap;
                ink_depth_step(centre, taps, 0.5)
            };
            assert_eq!([step(near, far), step(far, near)], [false; 2], "{near} {place}");
            assert_eq!([step(near, far.next_up()), step(far.next_up(), near)], [true; 2], "{near} {place}");
        }
    }
}

#[test]
fn a_soft_inker_ramps_around_the_square_of_its_step_and_twice_what_normals_differ_by() {
    // δ = 1/5, 51 steps of 8 bits: the limit is 1/25, and half of that the width of the ramp.
    let soft = Inker { depth_delta: 0.2, softness: 0.5, ..Default::default() };
    let flat = [DVec3::Z; 4];
    let of_bytes = |d0: f64, d1: f64| (d0 * d0 + d1 * d1) / 65025.0;
    for (d0, d1, expected) in [
        (0.0, 0.0, 0.0),
        (51.0, 0.0, 0.5),
        (0.0, -51.0, 0.5),
        (-45.0, 24.0, 0.5),
        (52.0, 0.0, (of_bytes(52.0, 0.0) - 0.04) / 0.02 + 0.5),
        (30.0, 40.0, (of_bytes(50.0, 0.0) - 0.04) / 0.02 + 0.5),
        (60.0, 0.0, 1.0),
    ] {
        let depths = [128.0 + d0, 128.0 + d1, 128.0, 128.0].map(|code: f64| code / 255.0);
        assert!((ink_inker(&soft, flat, depths) - expected).abs() < 1e-6, "{d0} {d1}");
    }
    // A flat face near by: N is 4 (0.4 + z)², so 0.64, 0.81 and 1.
    for (depth, expected) in [(0.0, 0.72), (0.05, 0.38), (0.1001, 0.0)] {
        assert!((ink_inker(&soft, flat, [depth; 4]) - expected).abs() < 1e-5, "{depth}");
    }
    assert_eq!(ink_inker(&soft, [DVec3::Z, DVec3::Z, DVec3::X, DVec3::Z], [0.5; 4]), 1.0);
}

#[test]
fn the_inker_on_bytes_is_the_inker_on_decoded_values() {
    // 128 stands for 1/255, as close to 0 as bytes are.
    let texel = |depth: u8| [128, 128, 255, depth];
    let ink = |form, taps| ink_printed_inker(&Inker { form, ..Default::default() }, taps);
    // √(1/512) is 11.27 steps of 8 bits.
    for place in 0..4 {
        for (step, expected) in [(11, 0.0), (12, 1.0), (-11, 0.0), (-12, 1.0)] {
            let mut taps = [texel(128); 4];
            taps[place] = texel((128 + step) as u8);
            assert_eq!(ink(InkerForm::Explicit, taps), expected, "{place} {step}");
        }
        // A perpendicular normal, and an opposite one.
        for normal in [[255, 128, 128], [128, 0, 128], [128, 128, 0]] {
            let mut taps = [texel(128); 4];
            taps[place] = [normal[0], normal[1], normal[2], 128];
            assert_eq!(ink(InkerForm::Explicit, taps), 1.0, "{place} {normal:?}");
        }
    }
    // As printed 1/4 + d₁ > 1/2 is ink: 64 steps, in one direction.
    let of_second_pair = |near: u8, far: u8| ink(InkerForm::Printed, [texel(128), texel(far), texel(128), texel(near)]);
    assert_eq!([of_second_pair(100, 163), of_second_pair(100, 164), of_second_pair(164, 100)], [0.0, 1.0, 0.0]);
    assert_eq!(ink(InkerForm::Corrected, [texel(128); 4]), 0.0);
    assert_eq!(ink(InkerForm::Corrected, [texel(128), texel(129), texel(128), texel(128)]), 1.0);
}

#[test]
fn signed_sums_do_not_distinguish_red_from_green() {
    let printed = |a, b| ink_region_printed(a, [b; 4], f64::from(REGION_SUM_OUTLINING_SKETCH));
    assert_eq!(printed(DVec3::X, DVec3::Y), 0.0);
    assert_eq!(printed(DVec3::X, DVec3::ZERO), 1.0);
    assert_eq!(ink_region(7, [7, 7, 9, 7], false, 0.5), 1.0);
    assert_eq!([ink_region(7, [7, 7, 9, 7], true, 0.5), ink_region(7, [7, 8, 9, 7], true, 0.5)], [0.5, 1.0]);
    assert_eq!(ink_region(7, [7; 4], true, 0.5), 0.0);
}

#[test]
fn the_inker_and_its_two_errors() {
    let with = |form| Inker { form, ..Default::default() };
    let flat = [DVec3::Z; 4];
    let ink = |form, depths| ink_inker(&with(form), flat, depths);
    // d1 is signed: the same step is ink one way and not the other.
    let far = 0.5;
    assert_eq!(ink(InkerForm::Printed, [far, far + 0.3, far, far]), 1.0);
    assert_eq!(ink(InkerForm::Printed, [far, far, far, far + 0.3]), 0.0);
    // Repaired: the least difference is ink.
    assert_eq!(ink(InkerForm::Corrected, [far; 4]), 0.0);
    assert_eq!(ink(InkerForm::Corrected, [far, far, far + 1e-4, far]), 1.0);
    // Flat and near: ink below 0.03 as printed and below 0.1 repaired, and nowhere with explicit thresholds.
    let n = |z: f64| ink_inker_similarity(&Inker::default(), flat, z);
    assert!((n(0.0) - 0.64).abs() < 1e-6 && (n(0.05) - 0.81).abs() < 1e-6 && n(0.1001) == 1.0);
    for (z, printed, repaired) in [(0.02, 1.0, 1.0), (0.04, 0.0, 1.0), (0.09, 0.0, 1.0), (0.11, 0.0, 0.0)] {
        assert_eq!(ink(InkerForm::Printed, [z; 4]), printed, "{z}");
        assert_eq!(ink(InkerForm::Corrected, [z; 4]), repaired, "{z}");
        assert_eq!(ink(InkerForm::Explicit, [z; 4]), 0.0, "{z}");
    }
    // Explicit: steps from √(1/512) on, in both directions and either pair.
    for (step, expected) in [(0.044, 0.0), (0.0443, 1.0), (-0.0443, 1.0)] {
        assert_eq!(ink(InkerForm::Explicit, [far, far, far + step, far]), expected);
        assert_eq!(ink(InkerForm::Explicit, [far, far + step, far, far]), expected);
    }
    // The normal threshold falls with depth, and a fold that is ink near by is none far away.
    let folded = [DVec3::Z, DVec3::Z, tilted(45.0), DVec3::Z];
    let at = |z: f64| ink_inker(&Inker::default(), folded, [z; 4]);
    assert_eq!([at(0.2), at(1.0)], [1.0, 0.0]);
    let soft = Inker { softness: 0.5, ..Default::default() };
    assert_eq!(ink_inker(&soft, flat, [far; 4]), 0.0);
    let half = ink_inker(&soft, flat, [far, far, far + f64::from(DEPTH_DELTA), far]);
    assert!((half - 0.5).abs() < 1e-6, "{half}");
}

fn uniform(filter: &FusedFilter, layout: TexelLayout) -> FilterUniform {
    FilterUniform::new(filter, layout, &DepthCode::perspective(1.0, 50.0, layout).unwrap()).unwrap()
}

fn tap(normal: Vec3, region: u32, depth: f32, layout: TexelLayout) -> Tap {
    let code = DepthCode::perspective(1.0, 50.0, layout).unwrap();
    coded_tap(normal, region, depth, layout, &code)
}

fn coded_tap(normal: Vec3, region: u32, depth: f32, layout: TexelLayout, code: &DepthCode) -> Tap {
    match layout {
        TexelLayout::Bits32 => ink_texel32_tap(ink_texel32_pack(normal, region, depth, code)),
        TexelLayout::Bits64 => ink_texel64_tap(ink_texel64_pack(normal, region, depth, code)),
    }
}

#[test]
fn each_part_of_the_fused_filter_alone_and_none() {
    let none = FusedFilter { normal_cos: None, depth: None, regions: false, ..Default::default() };
    let normals = FusedFilter { normal_cos: Some(NORMAL_COS_OUTLINING_SKETCH), ..none };
    let depth = FusedFilter { depth: Some(DepthTest::default()), ..none };
    let plain = FusedFilter { depth: Some(DepthTest { plain: true, ..Default::default() }), ..none };
    let regions = FusedFilter { regions: true, ..none };
    for layout in [TexelLayout::Bits32, TexelLayout::Bits64] {
        let surface = |normal, region, depth| tap(normal, region, depth, layout);
        let centre = surface(Vec3::Z, 3, 10.0);
        let folded = surface(Vec3::new(0.8, 0.0, 0.6), 3, 10.0);
        let behind = surface(Vec3::Z, 3, 10.5);
        let other = surface(Vec3::Z, 4, 10.0);
        let background = surface(Vec3::Z, 0, 10.0);
        for (filter, expected) in [
            (none, [false, false, false, true]),
            (normals, [true, false, false, true]),
            (depth, [false, true, false, true]),
            (plain, [false, true, false, true]),
            (regions, [false, false, true, true]),
            (FusedFilter::default(), [true; 4]),
        ] {
            let uniform = uniform(&filter, layout);
            for (i, differing) in [folded, behind, other, background].into_iter().enumerate() {
                for place in 0..4 {
                    let mut taps = [centre; 4];
                    taps[place] = differing;
                    assert_eq!(ink_fused_hard(&uniform, &centre, &taps), expected[i], "{filter:?} {layout:?} {i}");
                    let soft = FilterUniform { softness: 0.1, ..uniform };
                    let ink = ink_fused(&soft, &centre, &taps);
                    assert_eq!(ink, if expected[i] { 0.5 } else { 0.0 }, "{filter:?} {layout:?} {i}");
                }
            }
            for same in [centre, background] {
                assert!(!ink_fused_hard(&uniform, &same, &[same; 4]));
                assert_eq!(ink_fused_soft(&FilterUniform { softness: 0.1, ..uniform }, &same, &[same; 4]), 0.0);
            }
        }
    }
}

#[test]
fn thresholds_out_of_range_are_refused() {
    let code = DepthCode::perspective(1.0, 50.0, TexelLayout::Bits64).unwrap();
    let refused = |filter| FilterUniform::new(&filter, TexelLayout::Bits64, &code).unwrap_err();
    let usual = FusedFilter::default();
    for cos in [-0.1, 1.1, f32::NAN] {
        let error = refused(FusedFilter { normal_cos: Some(cos), ..usual });
        assert!(matches!(error, ImageSpaceError::NormalThreshold { .. }));
    }
    for step in [-1.0, f32::INFINITY, f32::NAN] {
        let error = refused(FusedFilter { depth: Some(DepthTest { step, plain: false }), ..usual });
        assert!(matches!(error, ImageSpaceError::DepthStep { .. }));
    }
    assert!(matches!(refused(FusedFilter { softness: -1.0, ..usual }), ImageSpaceError::Softness { .. }));
    // No overflow at the ends.
    for step in [0.0, 1.0, 1e30] {
        for layout in [TexelLayout::Bits32, TexelLayout::Bits64] {
            let filter = FusedFilter { normal_cos: Some(1.0), depth: Some(DepthTest { step, plain: true }), ..usual };
            let uniform = uniform(&filter, layout);
            let (near, far) = (tap(Vec3::Z, 1, 1.0, layout), tap(Vec3::NEG_Z, 1, 50.0, layout));
            ink_fused_hard(&uniform, &near, &[far; 4]);
            ink_fused_soft(&uniform, &near, &[far; 4]);
            assert!(ink_tap_depth_threshold(&uniform, layout.depth_max() as i32) >= layout.depth_slack() as i32);
        }
    }
}

/// The softness with which a flat face is white, and the next number, which is refused; and that the refused ones are
/// refused for a reason.
#[test]
fn the_largest_softness_leaves_a_flat_face_white_and_the_next_one_is_refused() {
    for layout in [TexelLayout::Bits32, TexelLayout::Bits64] {
        let code = DepthCode::perspective(1.0, 50.0, layout).unwrap();
        let flat = tap(Vec3::new(0.3, 0.5, 0.8), 1, 20.0, layout);
        let ink = |uniform: &FilterUniform| ink_store(ink_fused(uniform, &flat, &[flat; 4]) as f32);
        for cos in [0.0, 0.1, 0.3, 0.5, 0.8, 0.85, 0.95, 0.999] {
            for taps in [Taps::Diagonal, Taps::Cross] {
                let with = |softness| {
                    let filter = FusedFilter { normal_cos: Some(cos), taps, softness, ..Default::default() };
                    FilterUniform::new(&filter, layout, &code)
                };
                let most = normal_softness_max(cos);
                assert!((most - 2.0 * (1.0 - cos)).abs() < 1e-6, "{cos}");
                let allowed = with(most).unwrap();
                assert_eq!(ink(&allowed), 0, "{cos} {layout:?}");
                let softness = most.next_up();
                assert_eq!(with(softness), Err(ImageSpaceError::NormalSoftness { softness, cos, most }));
                // A tenth more is grey.
                assert!(ink(&FilterUniform { softness: 1.1 * most, ..allowed }) > 20, "{cos} {layout:?}");
            }
        }
        // Without a test of normals, the bound is that of depth; without either, there is none.
        let without = |depth, softness| {
            let filter = FusedFilter { normal_cos: None, depth, softness, ..Default::default() };
            FilterUniform::new(&filter, layout, &code)
        };
        for plain in [false, true] {
            let depth = Some(DepthTest { step: 0.05, plain });
            let allowed = without(depth, DEPTH_SOFTNESS_MAX).unwrap();
            assert_eq!(ink(&allowed), 0);
            let softness = DEPTH_SOFTNESS_MAX.next_up();
            let most = DEPTH_SOFTNESS_MAX;
            assert_eq!(without(depth, softness), Err(ImageSpaceError::DepthSoftness { softness, most }));
        }
        without(None, 9.0).unwrap();
    }
    // The printed and the slides' thresholds, with the softness that ends at a cosine of 1, are refused as the f32 that
    // they are.
    let slides = FusedFilter { softness: 0.4, ..Default::default() };
    let code = DepthCode::perspective(1.0, 50.0, TexelLayout::Bits64).unwrap();
    let error = FilterUniform::new(&slides, TexelLayout::Bits64, &code).unwrap_err();
    let said = "a softness of 0.4 around a normal threshold of 0.8: flat faces would have ink; at most 0.39999998 is \
                possible";
    assert_eq!(error.to_string(), said);
}

/// The codes of a plane bend by what they are rounded by; a soft test of depth gives that no ink at any distance.
#[test]
fn a_soft_test_of_depth_gives_a_slanted_plane_no_ink() {
    for layout in [TexelLayout::Bits32, TexelLayout::Bits64] {
        let code = DepthCode::perspective(1.0, 500.0, layout).unwrap();
        for softness in [0.1, 0.5, 1.0, DEPTH_SOFTNESS_MAX] {
            let filter = FusedFilter { normal_cos: None, softness, ..Default::default() };
            let uniform = FilterUniform::new(&filter, layout, &code).unwrap();
            let mut bent = 0;
            // From 1.1 to 400 units, along a plane.
            for pixel in 0..20_000u32 {
                let inverse = |x: f64| 1.0 / 400.0 + (1.0 / 1.1 - 1.0 / 400.0) * (x / 20_000.0);
                let seen = |x: f64| coded_tap(Vec3::Z, 1, (1.0 / inverse(x)) as f32, layout, &code);
                let [before, centre, after] = [-1.0, 0.0, 1.0].map(|x| seen(f64::from(pixel) + x));
                bent += u32::from(before.depth - 2 * centre.depth + after.depth != 0);
                assert_eq!(ink_fused(&uniform, &centre, &[before, before, after, after]), 0.0, "{layout:?} {pixel}");
            }
            assert!(bent > 100, "{layout:?}: rounding bends nothing, and the test shows nothing");
        }
    }
}

#[test]
fn a_soft_inker_needs_a_threshold_with_which_flat_faces_are_white() {
    let soft = |cos: f32, fall: f32, softness: f32| Inker {
        normal_cos: cos,
        normal_fall: fall,
        softness,
        ..Default::default()
    };
    assert_eq!(soft(0.9, 0.25, 0.0).validate(), Ok(()));
    let most = INKER_SOFT_COS_MAX;
    assert_eq!(soft(0.9, 0.25, 0.5).validate(), Err(ImageSpaceError::InkerSoftness { cos: 0.9, most }));
    // A fall below 0 raises the threshold with depth.
    assert_eq!(soft(0.5, -0.375, 0.5).validate(), Err(ImageSpaceError::InkerSoftness { cos: 0.875, most }));
    let softness = DEPTH_SOFTNESS_MAX.next_up();
    assert!(matches!(soft(0.8, 0.25, softness).validate(), Err(ImageSpaceError::DepthSoftness { .. })));
    assert!(matches!(soft(0.8, 0.25, f32::NAN).validate(), Err(ImageSpaceError::Softness { .. })));
    // The printed forms are hard, whatever the softness.
    for form in [InkerForm::Printed, InkerForm::Corrected] {
        assert_eq!(Inker { form, ..soft(0.9, 0.25, 5.0) }.validate(), Ok(()));
    }
    // Flat faces of every direction and depth in bytes are white with the largest threshold, and with one a hundredth
    // larger not all are.
    let darkest = |inker: &Inker| {
        let mut darkest = 0;
        for i in 0..200_000u32 {
            // Fibonacci's sphere.
            let z = 1.0 - (f64::from(i) + 0.5) / 100_000.0;
            let (sin, cos) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
            let across = (1.0 - z * z).sqrt();
            let texel = ink_printed_encode(DVec3::new(across * cos, across * sin, z).as_vec3(), 0.0);
            darkest = darkest.max(ink_store(ink_printed_inker(inker, [texel; 4]) as f32));
        }
        darkest
    };
    let largest = soft(most, 0.25, DEPTH_SOFTNESS_MAX);
    assert_eq!((largest.validate(), darkest(&largest)), (Ok(()), 0));
    assert!(soft(most.next_up(), 0.25, 0.5).validate().is_err());
    assert!(darkest(&soft(most + 0.01, 0.25, 0.5)) > 10);
}

fn any_tap(most: i32, depth_max: i32) -> impl Strategy<Value = Tap> {
    (-most..=most, -most..=most, 0u32..3, 0..=depth_max, 0..8).prop_map(move |(x, y, region, depth, none)| {
        let oct = npr_imagespace::format::normal::ink_oct_vector(IVec2::new(x, y), most);
        Tap { normal: if none == 0 { IVec3::ZERO } else { oct }, region, depth }
    })
}

/// The threshold is a share of the nearer side's distance wherever the range ends.
#[test]
fn depth_thresholds_follow_the_distance_in_finite_and_infinite_ranges() {
    for far in [60.0, 200.0, f32::INFINITY] {
        for layout in [TexelLayout::Bits32, TexelLayout::Bits64] {
            let code = DepthCode::perspective(1.0, far, layout).unwrap();
            let test = FusedFilter { normal_cos: None, ..Default::default() };
            let uniform = FilterUniform::new(&test, layout, &code).unwrap();
            for depth in [1.5, 4.0, 12.0, 45.0] {
                // 14 bits of an infinite range do not distinguish 1 % at 45.
                if layout == TexelLayout::Bits32 && depth > 40.0 {
                    continue;
                }
                let tap = |depth: f32| Tap { normal: IVec3::Z, region: 1, depth: ink_depth_code(depth, &code) as i32 };
                let bends = |share: f32| {
                    let (near, behind) = (tap(depth), tap(depth * (1.0 + share)));
                    ink_tap_bends(&uniform, &near, &near, &behind) && ink_tap_bends(&uniform, &near, &behind, &behind)
                };
                assert!(bends(0.016) && !bends(0.005), "{layout:?} to {far} at {depth}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// The integers decide what the cosine does, but for a margin that the rounding of t² explains.
    #[test]
    fn integer_normals_agree_with_the_cosine(
        a in any_tap(127, 9), b in any_tap(127, 9), c in any_tap(15, 9), d in any_tap(15, 9), cos in 0f32..=1.0,
    ) {
        for (layout, a, b) in [(TexelLayout::Bits64, a.normal, b.normal), (TexelLayout::Bits32, c.normal, d.normal)] {
            let uniform = uniform(&FusedFilter { normal_cos: Some(cos), ..Default::default() }, layout);
            if a == IVec3::ZERO || b == IVec3::ZERO {
                prop_assert_eq!(ink_tap_normal_differs(&uniform, a, b), a != b);
                continue;
            }
            let exact = a.as_dvec3().normalize().dot(b.as_dvec3().normalize());
            let (decided, limit) = (ink_tap_normal_differs(&uniform, a, b), f64::from(cos));
            // Three roundings of f32, and that of the cosine's square.
            if exact < 0.0 || (exact * exact - limit * limit).abs() > 4e-7 {
                prop_assert_eq!(decided, exact < limit, "{} {}", exact, limit);
            }
            prop_assert_eq!(decided, ink_tap_normal_differs(&uniform, b, a));
        }
    }

    /// The definition of the module's documentation, in wider integers.
    #[test]
    fn the_fused_filter_is_its_formula(
        centre in any_tap(127, 0x00ff_ffff), taps in prop::array::uniform4(any_tap(127, 0x00ff_ffff)),
        near in prop::array::uniform4(-200_000i32..200_000), close: bool, tests in 0u32..16, step in 0f32..0.1,
    ) {
        let mut taps = taps;
        if close {
            taps.iter_mut().zip(near).for_each(|(tap, near)| {
                tap.depth = (centre.depth + near).clamp(0, 0x00ff_ffff);
                (tap.region, tap.normal) = (centre.region, centre.normal);
            });
        }
        let filter = FusedFilter { depth: Some(DepthTest { step, plain: false }), ..Default::default() };
        let uniform = FilterUniform { tests, ..uniform(&filter, TexelLayout::Bits64) };
        let threshold = |nearest: i32| {
            let growth = (i64::from(nearest) / 256) * i64::from(uniform.depth_step) / 256;
            i64::from(uniform.depth_slack).max(i64::from(uniform.depth_base) + growth)
        };
        let mut ink = false;
        for tap in &taps {
            ink |= (tap.region == 0) != (centre.region == 0);
            if tap.region == 0 || centre.region == 0 {
                continue;
            }
            ink |= tests & TEST_REGION != 0 && tap.region != centre.region;
            ink |= tests & TEST_STEP != 0
                && i64::from((tap.depth - centre.depth).abs()) > threshold(tap.depth.max(centre.depth));
            ink |= tests & TEST_NORMAL != 0 && ink_tap_normal_differs(&uniform, tap.normal, centre.normal);
        }
        for (a, b) in [(taps[0], taps[2]), (taps[1], taps[3])] {
            let surfaces = a.region != 0 && b.region != 0 && centre.region != 0;
            let bend = i64::from(a.depth) - 2 * i64::from(centre.depth) + i64::from(b.depth);
            let nearest = a.depth.max(b.depth).max(centre.depth);
            ink |= tests & TEST_BEND != 0 && surfaces && bend.abs() > threshold(nearest);
        }
        // Differences that no enabled test looks for are no lines.
        prop_assert_eq!(ink_fused_hard(&uniform, &centre, &taps), ink);
        let soft = ink_fused_soft(&FilterUniform { softness: 1e-6, ..uniform }, &centre, &taps);
        prop_assert!((0.0..=1.0).contains(&soft));
        // Exactly at a threshold there is half of what there is above it.
        if soft % 0.5 == 0.0 {
            prop_assert_eq!(soft > 0.0, ink, "{}", soft);
        }
    }

    /// Three points of a plane never exceed the slack, whatever its slope.
    #[test]
    fn rounding_on_a_plane_stays_within_the_slack(
        middle in 0.03f64..0.97, slope in -0.03f64..0.03, far in 2f32..1e5, infinite: bool,
    ) {
        let far = if infinite { f32::INFINITY } else { far };
        for layout in [TexelLayout::Bits32, TexelLayout::Bits64] {
            let code = DepthCode::perspective(1.0, far, layout).unwrap();
            let [a, b, c] = [-1.0, 0.0, 1.0].map(|x| {
                let inverse = 1.0 / f64::from(far) + (1.0 - 1.0 / f64::from(far)) * (middle + slope * x);
                ink_depth_code((1.0 / inverse) as f32, &code) as i32
            });
            prop_assert!((a - 2 * b + c).abs() <= layout.depth_slack() as i32, "{:?} {} {} {}", layout, a, b, c);
        }
    }
}

/// Errata, alpha test: with GREATER and 0 the sequential reading keeps only white pixels; the co-issued one keeps listing
/// 10's lines, and of listing 9's those that only the last tap finds.
#[test]
fn the_co_issued_alpha_lacks_the_last_instruction() {
    let z = ink_printed_encode(Vec3::Z, 0.5);
    let x = ink_printed_encode(Vec3::X, 0.5);
    let far = ink_printed_encode(Vec3::Z, 0.6);
    let ink = |normal: bool, depth: bool, test: AlphaTest, taps: [[u8; 4]; 4]| {
        let whole = PrintedEdges::default();
        let edges = PrintedEdges {
            normal: whole.normal.filter(|_| normal),
            depth: whole.depth.filter(|_| depth),
            co_issued: Some(test),
            ..whole
        };
        ink_printed_edges(&edges, &PrintedUniform::new(&edges).unwrap(), z, taps)
    };
    // Listing 9: the last tap alone differs, another one does, none does.
    assert!(ink(true, false, AlphaTest::PRINTED, [z, z, z, x]));
    assert!(!ink(true, false, AlphaTest::PRINTED, [z, x, z, z]));
    assert!(!ink(true, false, AlphaTest::PRINTED, [z; 4]));
    // With LESS it is the reverse: lines of the last tap alone are lost.
    assert!(!ink(true, false, AlphaTest::CORRECTED, [z, z, z, x]));
    assert!(ink(true, false, AlphaTest::CORRECTED, [z, x, z, z]));
    // Listing 10: alpha is the sum, 25 of 255, less 5.1, so that GREATER and 0 keeps the line.
    assert!(ink(false, true, AlphaTest::PRINTED, [z, far, z, z]));
    assert!(!ink(false, true, AlphaTest::PRINTED, [z; 4]));
    assert!(!ink(false, true, AlphaTest { less: false, reference: 20 }, [z, far, z, z]));
    assert!(ink(false, true, AlphaTest { less: false, reference: 19 }, [z, far, z, z]));
}

/// A difference of exactly the threshold is no line, a code more is one.
#[test]
fn a_jump_of_exactly_the_threshold_is_no_line() {
    for plain in [false, true] {
        let depth = Some(DepthTest { step: 0.05, plain });
        let filter = FusedFilter { normal_cos: None, depth, regions: false, ..Default::default() };
        for layout in [TexelLayout::Bits32, TexelLayout::Bits64] {
            let uniform = uniform(&filter, layout);
            let near = tap(Vec3::Z, 3, 2.0, layout);
            let threshold = ink_tap_depth_threshold(&uniform, near.depth);
            assert!(threshold > 0 && threshold < near.depth);
            for (more, expected) in [(0, false), (1, true)] {
                let far = Tap { depth: near.depth - threshold - more, ..near };
                let found = if plain {
                    ink_tap_across(&uniform, &near, &far)
                } else {
                    ink_tap_bends(&uniform, &near, &near, &far)
                };
                assert_eq!(found, expected, "{plain} {layout:?} {more}");
            }
        }
    }
}

/// Normals that point away from each other are compared only where normals are; no normal differs from any.
#[test]
fn opposite_normals_and_none() {
    for layout in [TexelLayout::Bits32, TexelLayout::Bits64] {
        let [front, back, none] = [Vec3::Z, Vec3::NEG_Z, Vec3::ZERO].map(|normal| tap(normal, 3, 10.0, layout));
        let none_asked = FusedFilter { normal_cos: None, depth: None, regions: false, ..Default::default() };
        assert!(!ink_tap_across(&uniform(&none_asked, layout), &front, &back));
        let asked = uniform(&FusedFilter { normal_cos: Some(0.8), softness: 0.1, ..none_asked }, layout);
        assert!(ink_tap_across(&asked, &front, &back));
        for (a, b, ink) in
            [(front, back, 1.0), (front, none, 1.0), (none, front, 1.0), (none, none, 0.0), (front, front, 0.0)]
        {
            assert_eq!(ink_tap_normal_soft(&asked, a.normal, b.normal), ink);
        }
    }
}

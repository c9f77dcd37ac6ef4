//! The precision of each format, and round trips of codes.
#![allow(clippy::print_stdout)]

use glam::{DVec3, IVec2, Vec3};
use npr_imagespace::ImageSpaceError;
use npr_imagespace::format::depth::*;
use npr_imagespace::format::half::{ink_half_decode, ink_half_encode};
use npr_imagespace::format::ink_is_surface;
use npr_imagespace::format::normal::*;
use npr_imagespace::format::printed::*;
use npr_imagespace::format::texel::*;
use proptest::prelude::*;

/// Directions evenly spread over the sphere, and the axes and diagonals, where folds and ties are.
fn directions() -> Vec<DVec3> {
    let golden_angle = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let count = 100_000;
    let spread = (0..count).map(|i| {
        let z = 1.0 - (2 * i + 1) as f64 / count as f64;
        let (sin, cos) = (golden_angle * i as f64).sin_cos();
        DVec3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z)
    });
    let signs = [-1.0, 0.0, 1.0];
    let lattice = signs.iter().flat_map(|&x| signs.iter().flat_map(move |&y| signs.map(|z| DVec3::new(x, y, z))));
    spread.chain(lattice.filter(|v| *v != DVec3::ZERO).map(DVec3::normalize)).collect()
}

#[test]
fn normals_are_wrong_by_no_more_than_their_bound() {
    // In degrees; what was measured, rounded up.
    let bounds = [
        (NormalFormat::Biased8, 0.40),
        (NormalFormat::Oct5, 8.0),
        (NormalFormat::Oct8, 0.95),
        (NormalFormat::Oct16, 0.0038),
        (NormalFormat::Half, 0.0225),
    ];
    for (format, bound_deg) in bounds {
        let (mut worst_deg, mut sum_deg) = (0f64, 0.0);
        let directions = directions();
        for &direction in &directions {
            let code = format.encode(direction.as_vec3());
            assert!(format.bits() == 64 || code >> format.bits() == 0);
            let decoded = format.decode(code).as_dvec3();
            // Not by the cosine, which has no digits left at small angles.
            let angle = decoded.cross(direction).length().atan2(decoded.dot(direction)).to_degrees();
            worst_deg = worst_deg.max(angle);
            sum_deg += angle;
        }
        println!("{format:?}: worst {worst_deg:.4}°, mean {:.4}°", sum_deg / directions.len() as f64);
        assert!(worst_deg <= bound_deg && worst_deg > 0.8 * bound_deg, "{format:?}: {worst_deg}");
    }
}

#[test]
fn octahedral_codes_survive_and_none_is_none() {
    for (bits, format) in [(5, NormalFormat::Oct5), (8, NormalFormat::Oct8)] {
        let most = oct_max(bits);
        for y in -most..=most {
            for x in -most..=most {
                let code = IVec2::new(x, y);
                let vector = ink_oct_vector(code, most);
                assert_eq!(vector.abs().element_sum(), most);
                // The folded square's border is there twice, so that the code may be another one.
                let stored = ink_oct_encode(vector.as_vec3(), most);
                assert!(stored.min_element() >= 1 && stored.max_element() < 1 << bits);
                assert_eq!(ink_oct_load(stored, most), vector, "{code}");
                assert_eq!(ink_oct_load((code + most + 1).as_uvec2(), most), vector);
            }
        }
        for none in [Vec3::ZERO, Vec3::NAN, Vec3::new(f32::INFINITY, 0.0, 0.0)] {
            assert_eq!(format.encode(none), 0);
            assert_eq!(format.decode(0), Vec3::ZERO);
        }
    }
}

#[test]
fn the_axes_are_exact_in_octahedral_codes_and_not_in_bytes() {
    for axis in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z] {
        for format in [NormalFormat::Oct5, NormalFormat::Oct8, NormalFormat::Oct16, NormalFormat::Half] {
            assert_eq!(format.decode(format.encode(axis)), axis, "{format:?}");
        }
        assert_ne!(NormalFormat::Biased8.decode(NormalFormat::Biased8.encode(axis)), axis);
    }
}

#[test]
fn halves_round_trip_and_round_to_even() {
    for half in 0..=u16::MAX {
        let value = ink_half_decode(half);
        if value.is_nan() {
            assert!(ink_half_decode(ink_half_encode(value)).is_nan());
            continue;
        }
        assert_eq!(ink_half_encode(value), half, "{value}");
        // Between this one and the next towards zero: the even one of the two, and either side of the middle.
        if half & 0x7fff != 0 && half & 0x7fff < 0x7c00 {
            let middle = (f64::from(value) + f64::from(ink_half_decode(half - 1))) / 2.0;
            let even = if half & 1 == 0 { half } else { half - 1 };
            assert_eq!(ink_half_encode(middle as f32), even, "{middle}");
            let (above, below) = ((middle as f32).abs().next_up(), (middle as f32).abs().next_down());
            assert_eq!(ink_half_encode(above) & 0x7fff, half & 0x7fff);
            assert_eq!(ink_half_encode(below) & 0x7fff, (half - 1) & 0x7fff);
        }
    }
    assert_eq!(ink_half_encode(1.0), 0x3c00);
    assert_eq!(ink_half_encode(-2.0), 0xc000);
    assert_eq!(ink_half_encode(65504.0), 0x7bff);
    assert_eq!(ink_half_encode(65519.996), 0x7bff);
    assert_eq!(ink_half_encode(65520.0), 0x7c00);
    assert_eq!(ink_half_decode(0x0001), 2f32.powi(-24));
}

/// Over many pairs around a depth: the largest gap whose ends share a code.
fn largest_fused_gap(format: DepthFormat, depth: f64, range: &DepthRange) -> f64 {
    let gap = format.gap(depth, range);
    let mut largest = 0f64;
    for i in 0..400 {
        let a = depth + gap * (f64::from(i) / 400.0 * 3.0 - 1.5);
        // Out from a, by what f32 has.
        for j in 1..=60 {
            let (from, to) = (a as f32, (a + gap * f64::from(j) / 40.0) as f32);
            if format.encode(from, range) == format.encode(to, range) {
                largest = largest.max(f64::from(to) - f64::from(from));
            }
        }
    }
    largest
}

#[test]
fn depths_a_gap_apart_are_told_apart_and_half_a_gap_are_not() {
    let range = DepthRange::new(0.5, 400.0).unwrap();
    println!("smallest difference resolved, near {} far {}", range.near, range.far);
    for format in DepthFormat::ALL {
        for depth in [1.0, 3.3, 10.0, 47.0, 100.0, 300.0] {
            // Within 8 bits' rounding of near everything is clamped.
            if format == DepthFormat::Unorm8 && depth == 1.0 {
                continue;
            }
            let (gap, fused) = (format.gap(depth, &range), largest_fused_gap(format, depth, &range));
            println!("  {format:?} at {depth}: formula {gap:.3e}, largest gap that fuses {fused:.3e}");
            assert!(fused < gap * (1.0 + 1e-6), "{format:?} at {depth}: {fused} of {gap} fuses");
            // Floats that are spaced as the input is have nothing between.
            if !matches!(format, DepthFormat::Float | DepthFormat::Packed4x8) {
                assert!(fused > 0.5 * gap, "{format:?} at {depth}: {fused} is all of {gap}");
            }
        }
    }
    // What the chapter fears: in 8 bits these two fuse, in 16 they do not.
    let (a, b) = (198.8f32, 199.8f32);
    assert_eq!(DepthFormat::Unorm8.encode(a, &range), DepthFormat::Unorm8.encode(b, &range));
    for format in DepthFormat::ALL.into_iter().skip(1) {
        assert_ne!(format.encode(a, &range), format.encode(b, &range), "{format:?}");
    }
}

#[test]
fn a_gap_is_what_the_bits_of_its_format_leave() {
    // 255 units over 255 steps, and over 257 times as many.
    let range = DepthRange::new(1.0, 256.0).unwrap();
    for depth in [1.0, 2.0, 100.0, 256.0] {
        assert_eq!(DepthFormat::Unorm8.gap(depth, &range), 1.0);
        for format in [DepthFormat::Unorm16, DepthFormat::Packed2x8] {
            assert!((format.gap(depth, &range) * 257.0 - 1.0).abs() < 1e-12, "{format:?} at {depth}");
        }
    }
    // Floats: 10 and 23 bits below the leading one.
    for (depth, exponent) in [(0.3, -2), (1.0, 0), (1.99, 0), (2.0, 1), (3.3, 1), (100.0, 6), (255.9, 7), (256.0, 8)] {
        assert_eq!(DepthFormat::Half.gap(depth, &range), 2f64.powi(exponent - 10), "{depth}");
        assert_eq!(DepthFormat::Float.gap(depth, &range), 2f64.powi(exponent - 23), "{depth}");
        // More bits than an f32 has, and near is taken off in f32: twice its spacing.
        assert_eq!(DepthFormat::Packed4x8.gap(depth, &range), 2f64.powi(exponent - 22), "{depth}");
    }
    // Near the eye in a deep range 32 bits are coarser than that: 2^13 over 2^32 steps.
    let deep = DepthRange::new(2f32.powi(-10), 8192.0).unwrap();
    for depth in [2f64.powi(-10), 2f64.powi(-9)] {
        let gap = DepthFormat::Packed4x8.gap(depth, &deep);
        assert!((gap * 2f64.powi(19) - 1.0).abs() < 1e-6, "{gap} at {depth}");
    }
    assert_eq!(DepthFormat::Packed4x8.gap(8000.0, &deep), 2f64.powi(12 - 22));
}

#[test]
fn depths_come_back_within_half_a_gap() {
    let range = DepthRange::new(0.25, 90.0).unwrap();
    for format in DepthFormat::ALL {
        for i in 0..=1000 {
            let depth = 0.25 + 89.75 * (i as f32 / 1000.0).powi(3);
            let again = format.decode(format.encode(depth, &range), &range);
            let error = f64::from((again - depth).abs());
            let rounding = 2.0 * f64::from(depth.next_up() - depth);
            assert!(error <= 0.5 * format.gap(f64::from(depth), &range) + rounding, "{format:?} {depth} {again}");
        }
        let most = format.encode(f32::INFINITY, &range);
        assert!(format.decode(most, &range) >= 89.9, "{format:?}: infinity is not near");
    }
    assert_eq!(DepthFormat::Packed4x8.encode(range.far, &range), u32::MAX);
    assert_eq!(ink_depth_split2(0x1234), [0x12, 0x34]);
    assert_eq!(ink_depth_split4(0x1234_5678), [0x12, 0x34, 0x56, 0x78]);
    for (near, far) in [(0.0, 1.0), (1.0, 1.0), (2.0, 1.0), (f32::NAN, 1.0), (1.0, f32::INFINITY)] {
        assert!(matches!(DepthRange::new(near, far), Err(ImageSpaceError::DepthRange { .. })));
    }
}

#[test]
fn the_printed_target_and_its_clear_values() {
    // A biased normal has no code for 0: 127.5 rounds to 128, +1/255.
    assert_eq!(ink_printed_encode(Vec3::Z, 1.0), CLEAR_PRINTED);
    assert_eq!(ink_printed_encode(Vec3::new(-1.0, 0.6, -0.79), 0.2), [0, 204, 27, 51]);
    let (normal, depth) = ink_printed_decode([0, 204, 27, 51]);
    assert!(normal.abs_diff_eq(Vec3::new(-1.0, 0.6, -0.788), 1e-3) && (depth - 0.2).abs() < 1e-6);
    // No normal encodes to the clear value, not even at depth 0.
    for direction in directions() {
        assert_ne!(ink_printed_encode(direction.as_vec3(), 0.0)[..3], CLEAR[..3]);
    }
    for (normal, depth) in [(Vec3::Z, f32::NAN), (Vec3::Z, f32::INFINITY), (Vec3::NAN, 0.5), (Vec3::ZERO, 0.5)] {
        assert_eq!(ink_printed_encode(normal, depth), CLEAR);
    }
}

#[test]
fn only_positive_finite_depths_are_surfaces() {
    for depth in [f32::MIN_POSITIVE, f32::from_bits(1), 1.0, f32::MAX] {
        assert!(ink_is_surface(depth), "{depth}");
    }
    for depth in [0.0, -0.0, -1.0, -f32::MIN_POSITIVE, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, -f32::NAN] {
        assert!(!ink_is_surface(depth), "{depth}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn texels_hold_what_was_packed(
        x in -1f32..1.0, y in -1f32..1.0, z in -1f32..1.0, region in 0u32.., depth in 0.1f32..1e4,
    ) {
        let normal = Vec3::new(x, y, z);
        for layout in [TexelLayout::Bits32, TexelLayout::Bits64] {
            let code = DepthCode::perspective(0.5, 2000.0, layout).unwrap();
            let tap = match layout {
                TexelLayout::Bits32 => ink_texel32_tap(ink_texel32_pack(normal, region, depth, &code)),
                TexelLayout::Bits64 => ink_texel64_tap(ink_texel64_pack(normal, region, depth, &code)),
            };
            if region == 0 {
                prop_assert_eq!(tap.region, 0);
                continue;
            }
            prop_assert_eq!(tap.region, ink_fold_region(region, layout.region_max()));
            prop_assert_eq!(tap.depth as u32, ink_depth_code(depth, &code));
            let most = layout.normal_max();
            let stored = ink_oct_encode(normal, most);
            let code = stored.as_ivec2() - most - 1;
            let expected = if stored.x == 0 { glam::IVec3::ZERO } else { ink_oct_vector(code, most) };
            prop_assert_eq!(tap.normal, expected);
        }
    }
}

#[test]
fn texels_of_no_surface_are_background() {
    let code = DepthCode::perspective(0.5, f32::INFINITY, TexelLayout::Bits64).unwrap();
    for depth in [f32::NAN, f32::INFINITY, 0.0, -3.0] {
        assert_eq!(ink_texel64_pack(Vec3::Z, 5, depth, &code), BACKGROUND);
        assert_eq!(ink_texel32_pack(Vec3::Z, 5, depth, &code), BACKGROUND[0]);
    }
    assert_eq!(ink_texel64_pack(Vec3::Z, 0, 1.0, &code), BACKGROUND);
    // A surface never is, whatever it lacks.
    assert_ne!(ink_texel32_pack(Vec3::ZERO, 1, 1e30, &code), 0);
    assert_ne!(ink_texel64_pack(Vec3::ZERO, 1, 1e30, &code), BACKGROUND);
}

#[test]
fn depth_codes_span_their_range_and_fold_keeps_neighbours_apart() {
    for layout in [TexelLayout::Bits32, TexelLayout::Bits64] {
        let most = layout.depth_max();
        let perspective = DepthCode::perspective(0.5, 100.0, layout).unwrap();
        let infinite = DepthCode::perspective(0.5, f32::INFINITY, layout).unwrap();
        let parallel = DepthCode::parallel(0.5, 100.0, layout).unwrap();
        for code in [perspective, parallel] {
            // 24 bits are all of an f32, and its rounding shows.
            let slack = layout.depth_slack() - 2;
            assert!(most - ink_depth_code(0.5, &code) <= slack && ink_depth_code(100.0, &code) <= slack);
            assert_eq!((ink_depth_code(0.1, &code), ink_depth_code(1e9, &code)), (most, 0), "clamped");
            for depth in [0.7f32, 2.0, 30.0, 90.0] {
                let again = code.depth(ink_depth_code(depth, &code));
                let inverse_step = 0.51 * if code.parallel != 0 { 1.0 } else { f64::from(depth).powi(2) };
                let allowed = inverse_step / f64::from(code.scale.abs()) + 4e-7 * f64::from(depth).powi(2);
                assert!((again - f64::from(depth)).abs() <= allowed, "{layout:?} {depth} {again}");
            }
        }
        assert_eq!(ink_depth_code(1e30, &infinite), 0);
        let region_max = layout.region_max();
        for region in [1, 2, region_max - 1, region_max, region_max + 1, u32::MAX] {
            let folded = ink_fold_region(region, region_max);
            assert!((1..=region_max).contains(&folded));
            assert_ne!(folded, ink_fold_region(region - 1, region_max));
        }
        for (near, far) in [(0.0, 1.0), (3.0, 2.0), (f32::INFINITY, f32::INFINITY)] {
            assert!(DepthCode::perspective(near, far, layout).is_err());
            assert!(DepthCode::parallel(near, far, layout).is_err());
        }
        assert!(DepthCode::parallel(1.0, f32::INFINITY, layout).is_err());
    }
}

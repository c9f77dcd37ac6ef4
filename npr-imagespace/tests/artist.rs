//! Artists' lines and regions.
#![allow(clippy::print_stdout)]

use glam::{DVec3, Vec3, Vec4};
use npr_imagespace::ImageSpaceError;
use npr_imagespace::artist::*;
use npr_imagespace::filter::normal::{NORMAL_COS_CARD_MITCHELL, NORMAL_COS_OUTLINING_SKETCH};
use npr_imagespace::region::*;

/// Directions within a cone around −z, in which a view's points lie.
fn view_directions() -> impl Iterator<Item = Vec3> {
    (0..40).flat_map(|ring| {
        (0..24).map(move |spoke| {
            let (off, around) = (ring as f32 * 0.038, spoke as f32 * 0.2618);
            Vec3::new(off.sin() * around.cos(), off.sin() * around.sin(), -off.cos())
        })
    })
}

#[test]
fn the_four_directions_are_60_and_90_degrees_apart_and_45_from_the_screen() {
    let four = [0, 1, 2, 3].map(|index| ink_artist_vector(index).as_dvec3());
    for (i, a) in four.iter().enumerate() {
        assert!((a.length() - 1.0).abs() < 1e-6 && (a.z - 0.5f64.sqrt()).abs() < 1e-6);
        for (j, b) in four.iter().enumerate().skip(i + 1) {
            let opposite = i + j == 3;
            assert!((a.dot(*b) - if opposite { 0.0 } else { 0.5 }).abs() < 1e-6, "{i} {j}");
        }
    }
    for index in 0..4 {
        assert_eq!(ink_artist_index(artist_color(index)), index);
    }
    let texel = |red, alpha| ink_artist_texel(Vec4::new(red, 0.3, 0.7, alpha));
    assert_eq!([texel(0.0, 0.0), texel(0.0, 1.0), texel(1.0, 0.0), texel(1.0, 1.0)], [0, 1, 2, 3]);
}

#[test]
fn no_visible_normal_is_within_45_degrees_wherever_a_point_is_seen() {
    for to in view_directions().map(|to| to * 7.0) {
        let four = [0, 1, 2, 3].map(|index| ink_artist_direction(index, to));
        for (index, direction) in four.into_iter().enumerate() {
            assert!((direction.length() - 1.0).abs() < 1e-5);
            // Away from the eye by 45°: whatever is 90° and more off is 45° and more off this.
            assert!((direction.dot(to.normalize()) - 0.5f32.sqrt()).abs() < 1e-5, "{to}");
            for other in &four[..index] {
                assert!(direction.dot(*other) < 0.5 + 1e-5);
            }
        }
    }
    // On the axis it is the vector itself, and so at the eye and behind it.
    for to in [Vec3::NEG_Z, Vec3::ZERO, Vec3::Z] {
        assert_eq!(ink_artist_direction(1, to), Vec3::new(0.5, -0.5, -std::f32::consts::FRAC_1_SQRT_2));
    }
}

#[test]
fn directions_of_neighbouring_points_are_similar() {
    // A pixel of a wide view is some 0.1° of it.
    for to in view_directions() {
        for step in [Vec3::X, Vec3::Y] {
            let (a, b) = (ink_artist_direction(2, to), ink_artist_direction(2, to + 0.002 * step));
            assert!(a.dot(b) > 0.9999, "{to}");
        }
    }
}

/// A sphere whose patches are painted, seen from farther and farther away: from where on no painted direction is
/// within the threshold of a visible normal, rotated once for the object and rotated for each point.
#[test]
fn directions_rotated_once_for_an_object_fail_near_it_as_the_formula_says() {
    let confused = |distance: f64, cos: f64, per_point: bool| {
        let centre = DVec3::NEG_Z * distance;
        for i in 0..=90 {
            for j in 0..72 {
                let (off, around) = ((f64::from(i)).to_radians(), (f64::from(j) * 5.0).to_radians());
                let point_normal = DVec3::new(off.sin() * around.cos(), off.sin() * around.sin(), off.cos());
                let point = centre + point_normal;
                // The rim and what lies before it is seen; normals of anything at that point are up to 90° off the
                // view.
                if point_normal.dot(point) > 0.0 {
                    continue;
                }
                let along = if per_point { point } else { centre };
                for index in 0..4 {
                    let direction = ink_artist_direction(index, along.as_vec3()).as_dvec3();
                    // The visible normal nearest to it: itself pressed into the half space that faces the eye.
                    let view = point.normalize();
                    let nearest = (direction - view * direction.dot(view).max(0.0)).normalize();
                    if nearest.dot(direction) >= cos {
                        return true;
                    }
                }
            }
        }
        false
    };
    for cos in [NORMAL_COS_CARD_MITCHELL, NORMAL_COS_OUTLINING_SKETCH].map(f64::from) {
        let limit = artist_object_distance(cos);
        let found = (110..1200).map(|d| f64::from(d) / 100.0).find(|&d| !confused(d, cos, false)).unwrap();
        println!("threshold {cos:.2}: fails nearer than {found:.2} radii, formula {limit:.2}");
        assert!(found <= limit + 0.01 && found > 0.85 * limit, "{found} {limit}");
        for distance in [1.1, 2.0, 5.0, 100.0] {
            assert!(!confused(distance, cos, true), "rotated for each point, at {distance}");
        }
    }
    assert!((artist_object_distance(0.8) - 7.07).abs() < 0.01 && (artist_object_distance(0.85) - 4.38).abs() < 0.01);
    assert_eq!(artist_object_distance(0.7), f64::INFINITY);
}

#[test]
fn alpha_at_the_reference_is_kept() {
    assert!(ink_alpha_kept(0.5, 0.5) && !ink_alpha_kept(0.499, 0.5) && !ink_alpha_kept(f32::NAN, 0.5));
}

#[test]
fn patches_do_not_depend_on_the_order_of_their_pairs() {
    let pairs = [[0, 1], [4, 2], [2, 5], [6, 6]];
    let expected = [1, 1, 2, 3, 2, 2, 4];
    assert_eq!(region_of_patches(7, &pairs).unwrap(), expected);
    let reversed: Vec<[u32; 2]> = pairs.iter().rev().map(|&[a, b]| [b, a]).collect();
    assert_eq!(region_of_patches(7, &reversed).unwrap(), expected);
    assert_eq!(region_of_patches(3, &[]).unwrap(), [1, 2, 3]);
    assert_eq!(region_of_patches(0, &[]).unwrap(), []);
    assert_eq!(region_of_patches(2, &[[1, 2]]), Err(ImageSpaceError::Face { face: 2, faces: 2 }));
    // A long chain, from either end, ends in time.
    let chain: Vec<[u32; 2]> = (0..200_000).map(|i| [i, i + 1]).collect();
    assert!(region_of_patches(200_001, &chain).unwrap().iter().all(|&region| region == 1));
    let backwards: Vec<[u32; 2]> = chain.into_iter().rev().collect();
    assert!(region_of_patches(200_001, &backwards).unwrap().iter().all(|&region| region == 1));
}

#[test]
fn regions_are_never_background_and_pairs_stay_different() {
    assert_eq!([region_of_index(0), region_of_index(41), region_of_index(u32::MAX)], [1, 42, 1]);
    assert_eq!(region_of_pairs([[1, 1], [1, 2], [2, 1], [1, 1], [0, 3], [3, 0]]), [1, 2, 3, 1, 0, 0]);
    assert_ne!(ink_region_of_color([0, 0, 0]), 0);
    assert_eq!(ink_region_of_color([1, 2, 3]), 0x0003_0202);
}

#[test]
fn hashed_pairs_of_regions_are_different_and_fit_a_texel() {
    let (mut known, mut duplicates) = (std::collections::HashSet::new(), 0);
    // Patches with colours, with the same low bits.
    for patch in 1..=40u32 {
        for color in (1..=0x00ff_ffffu32).step_by(65_793) {
            let pair = ink_region_pair(patch, color);
            assert!((1..=0x00ff_ffff).contains(&pair), "{pair}");
            duplicates += u32::from(!known.insert(pair));
        }
    }
    // Of this many numbers among 2^24 three duplicates are expected.
    assert!(known.len() > 10_000 && duplicates < 12, "{duplicates} of {}", known.len());
    assert_eq!((ink_region_pair(0, 5), ink_region_pair(5, 0)), (0, 0));
}

use super::*;
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Twice the area vector.
fn newell(corners: &[Vec3]) -> DVec3 {
    let p: Vec<DVec3> = corners.iter().map(|c| (*c - corners[0]).as_dvec3()).collect();
    (0..p.len()).map(|i| p[i].cross(p[(i + 1) % p.len()])).sum()
}

fn triangle_normal(corners: &[Vec3], t: [u32; 3]) -> DVec3 {
    let [a, b, c] = t.map(|i| corners[i as usize].as_dvec3());
    (b - a).cross(c - a)
}

/// n − 2 triangles, none reversed, with the total area of the polygon.
fn check(corners: &[Vec3]) -> Vec<[u32; 3]> {
    let triangles = triangulate(corners);
    assert_eq!(triangles.len(), corners.len() - 2);
    let whole = newell(corners);
    let normal = whole.normalize();
    let mut sum = 0.0;
    for &t in &triangles {
        let area = triangle_normal(corners, t).dot(normal);
        assert!(area >= -1e-5 * whole.length(), "{t:?} is turned over by {area}");
        sum += area.abs();
    }
    assert!((sum - whole.length()).abs() <= 1e-5 * whole.length(), "{sum} for {}", whole.length());
    triangles
}

fn flat(points: &[(f32, f32)]) -> Vec<Vec3> {
    points.iter().map(|&(x, y)| Vec3::new(x, y, 0.0)).collect()
}

#[test]
fn fewer_than_three_corners_give_nothing() {
    for n in 0..3 {
        assert!(triangulate(&vec![Vec3::X; n]).is_empty());
    }
}

#[test]
fn a_convex_quad_takes_the_shorter_diagonal_and_the_first_of_two_equal_ones() {
    let square = flat(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
    assert_eq!(triangulate(&square), [[0, 1, 2], [0, 2, 3]]);
    let slanted = flat(&[(0.0, 0.0), (1.0, 0.0), (2.0, 1.0), (1.0, 1.0)]);
    assert_eq!(triangulate(&slanted), [[0, 1, 3], [1, 2, 3]]);
}

#[test]
fn a_concave_quad_is_cut_at_its_reflex_corner() {
    let dart = [(0.0, 0.0), (1.0, 1.0), (0.0, 0.3), (-1.0, 1.0)];
    for first in 0..4 {
        let corners: Vec<_> = (0..4).map(|i| dart[(first + i) % 4]).collect();
        for scale in [1e-30, 1.0, 1e30] {
            let scaled: Vec<_> = flat(&corners).iter().map(|c| *c * scale).collect();
            let reflex = (6 - first) as u32 % 4;
            assert!(triangulate(&scaled).iter().all(|t| t.contains(&reflex)), "{first} {scale}");
        }
        check(&flat(&corners));
    }
}

#[test]
fn a_quad_with_three_corners_in_line_has_no_flat_triangle() {
    let corners = flat(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 1.0)]);
    for t in check(&corners) {
        assert!(triangle_normal(&corners, t).z > 0.5);
    }
}

fn ell() -> Vec<Vec3> {
    flat(&[(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 4.0), (0.0, 4.0)])
}

fn star(points: usize) -> Vec<Vec3> {
    (0..2 * points)
        .map(|i| {
            let angle = TAU * i as f64 / (2 * points) as f64;
            let radius = if i % 2 == 0 { 1.0 } else { 0.3 };
            (DVec3::new(angle.cos(), angle.sin(), 0.0) * radius).as_vec3()
        })
        .collect()
}

fn comb(teeth: usize) -> Vec<Vec3> {
    let mut points = vec![(0.0, 0.0), (2.0 * teeth as f32, 0.0)];
    for tooth in (0..teeth).rev() {
        let x = 2.0 * tooth as f32;
        points.extend([(x + 1.5, 1.0), (x + 1.5, 9.0), (x + 0.5, 9.0), (x + 0.5, 1.0)]);
    }
    flat(&points)
}

fn spiral(corners: usize) -> Vec<Vec3> {
    let arm = |i: usize, offset: f64| {
        let angle = 0.6 * i as f64;
        (DVec3::new(angle.cos(), angle.sin(), 0.0) * (1.0 + offset + 0.12 * angle)).as_vec3()
    };
    let half = corners / 2;
    (0..half).map(|i| arm(i, 0.3)).chain((0..half).rev().map(|i| arm(i, 0.0))).collect()
}

#[test]
fn concave_polygons_keep_their_area() {
    for corners in [ell(), star(5), star(50), comb(3), comb(40), spiral(40)] {
        check(&corners);
        let reversed: Vec<_> = corners.iter().rev().copied().collect();
        check(&reversed);
        let turned = glam::Mat3::from_rotation_y(1.1) * glam::Mat3::from_rotation_x(0.7);
        check(&corners.iter().map(|&c| turned * c + Vec3::new(5.0, -3.0, 2.0)).collect::<Vec<_>>());
    }
}

#[test]
fn concave_polygons_of_any_scale_keep_their_area() {
    for scale in [1e-35, 1e-30, 1e-10, 1e10, 1e30, 1e37] {
        for corners in [ell(), spiral(40)] {
            let scaled: Vec<_> = corners.iter().map(|&c| c * scale).collect();
            let triangles = triangulate(&scaled);
            let whole: f64 = newell(&scaled).length();
            let sum: f64 = triangles.iter().map(|&t| triangle_normal(&scaled, t).length()).sum();
            assert!((sum - whole).abs() <= 1e-5 * whole, "{scale}");
        }
    }
}

#[test]
fn convex_polygons_are_not_fans() {
    for n in 5..70 {
        let corners: Vec<_> = (0..n)
            .map(|i| {
                let angle = TAU * i as f64 / n as f64;
                DVec3::new(angle.cos(), 0.0, angle.sin()).as_vec3()
            })
            .collect();
        let triangles = check(&corners);
        let most = (0..n as u32).map(|i| triangles.iter().filter(|t| t.contains(&i)).count()).max();
        assert!(most.unwrap() <= 2 * (usize::BITS - (n as usize).leading_zeros()) as usize);
    }
}

#[test]
fn a_pentagram_is_not_taken_for_a_convex_polygon() {
    assert!(!is_strictly_convex(&project(&pentagram()).unwrap()));
    assert_eq!(triangulate(&pentagram()).len(), 3);
}

#[test]
fn a_keyhole_leaves_its_hole_open() {
    let corners = flat(&[
        (0.0, 0.0),
        (4.0, 0.0),
        (4.0, 4.0),
        (0.0, 4.0),
        (0.0, 0.0),
        (1.0, 1.0),
        (1.0, 3.0),
        (3.0, 3.0),
        (3.0, 1.0),
        (1.0, 1.0),
    ]);
    let triangles = check(&corners);
    for t in triangles {
        let middle = t.iter().map(|&i| corners[i as usize]).sum::<Vec3>() / 3.0;
        let in_hole = middle.cmpgt(Vec3::ONE).bitmask() & 3 == 3 && middle.cmplt(Vec3::splat(3.0)).bitmask() & 3 == 3;
        assert!(!in_hole, "{t:?}");
    }
}

#[test]
fn corners_in_line_and_repeated_corners_keep_area_and_count() {
    check(&flat(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 2.0), (0.0, 2.0), (0.0, 1.0)]));
    check(&flat(&[(0.0, 0.0), (2.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (0.0, 2.0)]));
    check(&flat(&[(0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]));
    // A corner that touches an edge.
    check(&flat(&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (2.0, 0.0), (0.0, 3.0)]));
    // A spike of zero width.
    check(&flat(&[(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (5.0, 1.0), (2.0, 1.0), (2.0, 2.0), (0.0, 2.0)]));
}

#[test]
fn what_has_no_area_still_gives_all_triangles() {
    let cases = [
        flat(&[(1.0, 1.0); 7]),
        flat(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (4.0, 0.0)]),
        flat(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]),
        flat(&[(0.0, 0.0), (f32::NAN, 0.0), (1.0, 1.0), (0.0, 1.0), (-1.0, 0.5)]),
        flat(&[(0.0, 0.0), (f32::INFINITY, 0.0), (1.0, 1.0), (0.0, 1.0), (-1.0, 0.5)]),
        flat(&[(f32::NAN, f32::NAN); 4]),
        flat(&[(f32::MAX, f32::MAX), (-f32::MAX, f32::MAX), (-f32::MAX, -f32::MAX), (f32::MAX, -f32::MAX), (0.0, 0.0)]),
    ];
    for corners in cases {
        let triangles = triangulate(&corners);
        assert_eq!(triangles.len(), corners.len() - 2);
        assert!(triangles.iter().flatten().all(|&i| (i as usize) < corners.len()));
    }
}

#[test]
fn an_outline_that_goes_round_and_round_ends() {
    // Every corner is an ear, since all corners are at three positions.
    let places = flat(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]);
    let corners: Vec<_> = (0..99_000).map(|i| places[i % 3]).collect();
    let start = std::time::Instant::now();
    assert_eq!(triangulate(&corners).len(), 98_998);
    assert!(start.elapsed().as_secs() < 5, "took {:?}", start.elapsed());
}

fn pentagram() -> Vec<Vec3> {
    (0..5)
        .map(|i| {
            let angle = TAU * (2 * i) as f64 / 5.0;
            DVec3::new(angle.cos(), angle.sin(), 0.0).as_vec3()
        })
        .collect()
}

#[test]
fn polygons_that_are_clipped_share_one_budget_of_tests() {
    // All corners are on a circle, so each is an ear. The first is compared with the two other corners, the next with
    // the remaining one: 3 tests.
    let mut triangles = Vec::new();
    let mut left = 10;
    for expected in [7, 4, 1, 0, 0] {
        triangulate_within(&pentagram(), &mut triangles, &mut left);
        assert_eq!((left, triangles.len()), (expected, 3));
    }
    // Also if the shared budget exceeds that of one polygon.
    let mut left = EAR_TESTS + 10;
    triangulate_within(&pentagram(), &mut triangles, &mut left);
    assert_eq!(left, EAR_TESTS + 7);
    // Polygons that need no ear clipping use no tests.
    for corners in [ell(), star(5), flat(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])] {
        triangulate_within(&corners, &mut triangles, &mut left);
        assert_eq!(left, EAR_TESTS + 7);
    }
}

#[test]
fn an_ear_is_empty_only_if_no_corner_is_inside_or_on_a_side() {
    let ear = [DVec2::new(0.0, 0.0), DVec2::new(4.0, 1.0), DVec2::new(1.0, 4.0)];
    let is_empty_with = |x: f64, y: f64| {
        let flat = [ear[0], ear[1], ear[2], DVec2::new(x, y)];
        let mut tests_left = 5;
        let empty = is_empty(&flat, &[1, 2, 3, 0], [0, 1, 2], &mut tests_left);
        assert_eq!(tests_left, 4);
        empty
    };
    // Inside, and in the middle of each side.
    for (x, y) in [(1.5, 1.5), (3.5, 1.0), (1.0, 3.5), (0.5, 0.5), (2.0, 0.5), (2.5, 2.5), (0.5, 2.0)] {
        assert!(!is_empty_with(x, y), "{x} {y}");
    }
    // Beyond each side, within the ear's bounding box.
    for (x, y) in [(2.0, 0.4), (3.5, 0.1), (2.6, 2.5), (3.5, 3.5), (0.4, 2.0), (0.1, 3.5)] {
        assert!(is_empty_with(x, y), "{x} {y}");
    }
    // Outside the bounding box, and at the ear's own corners.
    for (x, y) in [(5.0, 1.0), (-1.0, 0.0), (1.0, 5.0), (1.0, -1.0), (0.0, 0.0), (4.0, 1.0), (1.0, 4.0)] {
        assert!(is_empty_with(x, y), "{x} {y}");
    }
    // Without remaining tests nothing is known about the other corners.
    let with_another = [ear[0], ear[1], ear[2], DVec2::new(9.0, 9.0)];
    assert!(!is_empty(&with_another, &[1, 2, 3, 0], [0, 1, 2], &mut 0));
}

#[test]
fn clipped_ears_of_a_simple_outline_keep_its_area() {
    for corners in [ell(), star(5), star(50), comb(3), comb(40), spiral(40)] {
        let flat = project(&corners).unwrap();
        let mut triangles = Vec::new();
        clip_ears(&flat, &mut triangles, &mut { EAR_TESTS });
        assert_eq!(triangles.len(), corners.len() - 2);
        let (mut whole, mut sum) = (0.0, 0.0);
        for i in 0..flat.len() {
            whole += flat[i].perp_dot(flat[(i + 1) % flat.len()]);
        }
        for [a, b, c] in triangles {
            let area = turn(flat[a as usize], flat[b as usize], flat[c as usize]);
            assert!(area >= -1e-12, "turned over by {area}");
            sum += area;
        }
        assert!((sum - whole).abs() < 1e-9, "{sum} for {whole}");
    }
}

#[test]
fn a_polygon_far_from_the_origin_is_projected_and_cut_as_at_the_origin() {
    // 3 by 4: the longer side of the box is scaled to -1..1, the shorter to -3/4..3/4.
    let (at_origin, triangles) = (project(&ell()).unwrap(), triangulate(&ell()));
    // Integers, which f32 represents exactly up to 2^24.
    for offset in [Vec3::ZERO, Vec3::new(1e6, -2e6, 3e6), Vec3::new(-8e6, 0.0, 0.0), Vec3::splat(1.6e7)] {
        let corners: Vec<Vec3> = ell().iter().map(|&corner| corner + offset).collect();
        let flat = project(&corners).unwrap();
        let (low, high) = (flat.iter().copied().reduce(DVec2::min), flat.iter().copied().reduce(DVec2::max));
        let (low, high) = (low.unwrap(), high.unwrap());
        assert!(low.abs_diff_eq(-high, 1e-12) && (high.max_element() - 1.0).abs() < 1e-12, "{low} {high}");
        assert!((high.min_element() - 0.75).abs() < 1e-12, "{low} {high}");
        assert!(flat.iter().zip(&at_origin).all(|(a, b)| a.abs_diff_eq(*b, 1e-12)), "{offset}");
        assert_eq!(check(&corners), triangles, "{offset}");
    }
}

fn tangle(corners: usize) -> Vec<Vec3> {
    let mut state = 1u64;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 40) as f32 / (1 << 24) as f32
    };
    (0..corners).map(|_| Vec3::new(random(), random(), random())).collect()
}

#[test]
fn a_large_tangle_ends() {
    assert_eq!(triangulate(&tangle(3000)).len(), 2998);
}

#[test]
fn one_tangle_does_not_take_what_other_polygons_of_its_file_need() {
    // Too many corners to compare all pairs.
    let (mut triangles, mut left) = (Vec::new(), 3 * EAR_TESTS);
    for expected in [2 * EAR_TESTS, EAR_TESTS, 0, 0] {
        triangulate_within(&tangle(12_000), &mut triangles, &mut left);
        assert_eq!((left, triangles.len()), (expected, 11_998));
    }
}

proptest! {
    #[test]
    fn simple_polygons_keep_their_area(
        radii in prop::collection::vec(0.2f64..1.0, 4..40),
        axis in (-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0),
        angle in 0.0..TAU,
    ) {
        let n = radii.len() as f64;
        let axis = (DVec3::from(axis) + DVec3::new(0.0, 0.0, 1.5)).normalize();
        let turned = glam::DMat3::from_axis_angle(axis, angle);
        let corners: Vec<_> = radii
            .iter()
            .enumerate()
            .map(|(i, r)| {
                let a = TAU * i as f64 / n;
                (turned * DVec3::new(a.cos() * r, a.sin() * r, 0.0)).as_vec3()
            })
            .collect();
        check(&corners);
    }

    #[test]
    fn any_corners_give_all_triangles(
        // A coarse lattice, on which corners often coincide, touch edges or are collinear.
        lattice in prop::collection::vec((-3i8..4, -3i8..4, 0i8..2), 3..14),
    ) {
        let corners: Vec<_> =
            lattice.iter().map(|&(x, y, z)| Vec3::new(x.into(), y.into(), f32::from(z) * 0.1)).collect();
        let triangles = triangulate(&corners);
        prop_assert_eq!(triangles.len(), corners.len() - 2);
        prop_assert!(triangles.iter().flatten().all(|&i| (i as usize) < corners.len()));
    }
}

#![allow(clippy::print_stdout)]

use super::*;
use glam::dcamera::rh::proj::directx as proj;
use proptest::prelude::*;
use std::f64::consts::FRAC_PI_4;

const NEAR: f64 = 0.1;
const SIZE: DVec2 = DVec2::new(640.0, 480.0);

/// An eye at the origin that looks along -z, with an infinite far plane.
fn perspective() -> LineView {
    let fov = 1.0f64;
    LineView {
        clip_from_world: proj::perspective_infinite_reverse(fov, SIZE.x / SIZE.y, NEAR),
        viewport_px: SIZE,
        depth_per_px: DVec2::new(2.0 * (0.5 * fov).tan() / SIZE.y, 0.0),
    }
}

/// 20 units high, from z = 0 to z = -100.
fn parallel() -> LineView {
    let (half_width, half_height) = (10.0 * SIZE.x / SIZE.y, 10.0);
    LineView {
        clip_from_world: proj::orthographic(-half_width, half_width, -half_height, half_height, 100.0, 0.0),
        viewport_px: SIZE,
        depth_per_px: DVec2::new(0.0, 20.0 / SIZE.y / 100.0),
    }
}

fn project(ends: [DVec3; 2], normals: [DVec3; 2], view: &LineView) -> ScreenSegment {
    outline_project(ends, normals, 2.0, view).unwrap()
}

/// Depth-buffer value of the plane `normal · p = d` at a pixel's centre, 0 where it does not lie before the eye.
fn plane_depth(normal: DVec3, d: f64, view: &LineView) -> impl Fn(i64, i64) -> f64 {
    let world_from_clip = view.clip_from_world.inverse();
    let size = view.viewport_px;
    let clip_from_world = view.clip_from_world;
    move |x, y| {
        let ndc = (DVec2::new(x as f64, y as f64) + 0.5) / size * DVec2::new(2.0, -2.0) + DVec2::new(-1.0, 1.0);
        let at = |z: f64| world_from_clip * ndc.extend(z).extend(1.0);
        let [near, far] = [1.0, 1e-3].map(|z| at(z).truncate() / at(z).w);
        let along = far - near;
        let t = (d - normal.dot(near)) / normal.dot(along);
        let clip = clip_from_world * (near + along * t).extend(1.0);
        let depth = clip.z / clip.w;
        if t.is_finite() && clip.w > 0.0 && (0.0..=1.0).contains(&depth) { depth } else { 0.0 }
    }
}

/// Integral of the coverage across the line, at a fraction of its length.
fn width_across(segment: &ScreenSegment, fraction: f64, width_px: f64) -> f64 {
    let (middle, _) = segment.at(fraction);
    let (direction, _) = segment.direction();
    let across = DVec2::new(-direction.y, direction.x);
    let steps = 4000;
    let reach = 0.5 * width_px + 1.0;
    (0..steps)
        .map(|i| {
            let offset = reach * (2.0 * (f64::from(i) + 0.5) / f64::from(steps) - 1.0);
            outline_coverage(segment, middle + across * offset, width_px)
        })
        .sum::<f64>()
        * 2.0
        * reach
        / f64::from(steps)
}

#[test]
fn the_width_is_the_same_all_along_a_receding_segment() {
    let view = perspective();
    let segment = project([DVec3::new(-0.1, -0.1, -0.5), DVec3::new(4.0, 3.0, -50.0)], [DVec3::ZERO; 2], &view);
    assert!(segment.direction().1 > 60.0);
    for width_px in [0.5, 1.0, 2.0, 4.0, 8.0] {
        for fraction in [0.1, 0.3, 0.5, 0.7, 0.9] {
            let width = width_across(&segment, fraction, width_px);
            assert!((width - width_px).abs() < 2e-3, "{width_px} px at {fraction}: {width}");
        }
    }
}

/// The width that the pixels' coverages add up to, per px of length, of a line through the middle of a 200 px square.
fn summed_width(direction: DVec2, middle: DVec2, width_px: f64) -> f64 {
    let ends_px = [middle - 60.0 * direction, middle + 60.0 * direction];
    let segment = ScreenSegment { ends_px, depths: [0.5; 2], slopes: [0.0; 2] };
    let mut sum = 0.0;
    for y in 0..200 {
        for x in 0..200 {
            let point = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            // A smooth window along the line, of integral 40, so that no pixel row begins or ends abruptly.
            let along = (point - middle).dot(direction) / 40.0;
            if along.abs() < 1.0 {
                let window = 0.5 + 0.5 * (std::f64::consts::PI * along).cos();
                sum += window * outline_coverage(&segment, point, width_px);
            }
        }
    }
    sum / 40.0
}

#[test]
fn coverage_integrates_to_the_width_per_unit_of_length() {
    for width_px in [1.0, 2.0, 3.5, 8.0] {
        let mut worst = 0.0f64;
        for degrees in [0.0, 7.0, 18.0, 26.5650511771, 30.0, 45.0, 63.0, 90.0, 131.0] {
            let direction = DVec2::from_angle(f64::to_radians(degrees));
            let across = direction.perp();
            // Over all places of the line relative to the pixels' centres: one px is a period in x and in y.
            let places = 16;
            let widths = (0..places).map(|place| {
                let offset = f64::from(place) / f64::from(places);
                let shift = if across.x.abs() > across.y.abs() { DVec2::X } else { DVec2::Y } * offset;
                summed_width(direction, DVec2::splat(100.0) + shift, width_px)
            });
            let mut mean = 0.0;
            for width in widths {
                mean += width / f64::from(places);
                worst = worst.max((width / width_px - 1.0).abs());
            }
            assert!((mean / width_px - 1.0).abs() < 0.01, "{width_px} px at {degrees}°: {mean}");
        }
        println!("{width_px} px: at the worst angle and place the sum is off by {:.1} %", 100.0 * worst);
        // Exactly diagonal, rows of centres are 0.7 px apart, and the 1 px ramp is sampled at that.
        assert!(worst < 0.125 / width_px);
    }
}

#[test]
fn a_segment_through_the_eyes_plane_is_cut_at_the_near_plane() {
    let view = perspective();
    let ends = [DVec3::new(0.05, -0.02, -4.0), DVec3::new(-0.01, 0.03, 3.0)];
    let clip = ends.map(|end| view.clip_from_world * end.extend(1.0));
    let [a, b] = outline_clip(clip, view.viewport_px, 3.0).unwrap();
    assert_eq!(a, clip[0]);
    assert!((b.w - NEAR).abs() < 1e-12 && (b.z - b.w).abs() < 1e-12);
    let segment = project(ends, [DVec3::X, DVec3::Y], &view);
    assert!(segment.ends_px.iter().all(|p| p.is_finite()) && (segment.depths[1] - 1.0).abs() < 1e-12);
    assert!(segment.slopes.iter().all(|s| s.is_finite()));
    // The other way round it is the same segment.
    let flipped = project([ends[1], ends[0]], [DVec3::X, DVec3::Y], &view);
    assert!(flipped.ends_px[0].distance(segment.ends_px[1]) < 1e-9);
}

#[test]
fn segments_outside_the_view_are_left_out() {
    let view = perspective();
    let none = |ends| outline_project(ends, [DVec3::ZERO; 2], 2.0, &view).is_none();
    assert!(none([DVec3::new(0.0, 0.0, 1.0), DVec3::new(0.5, 0.0, 3.0)]), "behind the eye");
    assert!(none([DVec3::new(0.0, 0.0, -0.05), DVec3::new(0.01, 0.0, -0.09)]), "before the near plane");
    assert!(none([DVec3::new(9.0, 0.0, -2.0), DVec3::new(9.0, 1.0, -2.0)]), "right of the picture");
    // From far left to far right: cut to the widened picture.
    let segment = project([DVec3::new(-1e6, 0.0, -2.0), DVec3::new(1e6, 0.1, -2.0)], [DVec3::ZERO; 2], &view);
    assert!((segment.ends_px[0].x + 3.0).abs() < 1e-6 && (segment.ends_px[1].x - 643.0).abs() < 1e-6);
    // An end exactly on the eye's plane, in a view whose near plane does not cut it.
    assert!(none([DVec3::ZERO, DVec3::ZERO]));
}

#[test]
fn a_segment_that_points_at_the_eye_is_a_dot() {
    let segment =
        project([DVec3::new(0.0, 0.0, -2.0), DVec3::new(0.0, 0.0, -4.0)], [DVec3::X, DVec3::Y], &perspective());
    assert_eq!(segment.direction(), (DVec2::X, 0.0));
    assert_eq!(segment.nearest(DVec2::new(3.0, 4.0)), 0.0);
    let centre = 0.5 * SIZE;
    assert_eq!(outline_coverage(&segment, centre, 4.0), 1.0);
    assert_eq!(outline_coverage(&segment, centre + DVec2::new(0.0, 2.0), 4.0), 0.5);
    assert_eq!(outline_coverage(&segment, centre + DVec2::new(3.0, 0.0), 4.0), 0.0);
}

#[test]
fn a_slope_is_that_of_the_faces_plane() {
    for view in [perspective(), parallel()] {
        // The ridge of a roof seen from the front: one face towards the eye, the other behind it.
        let ends = [DVec3::new(-1.0, 1.0, -5.0), DVec3::new(1.0, 1.3, -6.0)];
        let edge = ends[1] - ends[0];
        for tilt in [0.6, 0.9, 1.2] {
            // A face below the edge, that falls towards the eye; the edge runs to the right, so the face is on its
            // right, and it runs over the edge backwards.
            let inward = DVec3::new(0.0, -f64::cos(tilt), f64::sin(tilt));
            let normal = inward.cross(edge).normalize();
            let segment = project(ends, [DVec3::ZERO, normal], &view);
            let depth_at = plane_depth(normal, normal.dot(ends[0]), &view);
            for fraction in [0.25, 0.5, 0.75] {
                let (on_line, depth) = segment.at(fraction);
                let pixel = (on_line + DVec2::new(0.0, 6.0)).floor();
                let centre = pixel + 0.5;
                let nearest = segment.nearest(centre);
                let there = segment.at(nearest).1;
                let offset = segment.offset_px(centre);
                assert!(offset > 0.0 && depth > 0.0);
                let measured = (depth_at(pixel.x as i64, pixel.y as i64) - there) / offset;
                // The slope is that at the middle of the line; in perspective it changes along it.
                let slope = segment.slopes[0];
                assert!(measured > 0.0 && (measured / slope - 1.0).abs() < 0.35, "{measured} {slope}");
                if fraction == 0.5 {
                    assert!((measured / slope - 1.0).abs() < 0.03, "{measured} {slope}");
                }
            }
        }
    }
}

fn visible_share(segment: &ScreenSegment, view: &LineView, depth_at: impl Fn(i64, i64) -> f64) -> f64 {
    let steps = 500;
    let seen = (0..steps)
        .filter(|i| outline_is_visible(segment, (f64::from(*i) + 0.5) / f64::from(steps), view, false, &depth_at));
    seen.count() as f64 / f64::from(steps)
}

#[test]
fn a_line_on_a_plane_is_visible_at_any_slant() {
    for view in [perspective(), parallel()] {
        // From head-on to 80°; beyond 83° the bound on slopes hides it by design.
        for degrees in [0.0, 20.0, 45.0, 60.0, 75.0, 80.0] {
            for turn in [0.0, 0.3, 1.2, 2.5] {
                let tilt = f64::to_radians(degrees);
                let normal = DVec3::new(tilt.sin() * f64::cos(turn), tilt.sin() * f64::sin(turn), tilt.cos());
                let side = normal.any_orthonormal_vector();
                for spin in [0.0, 0.4, 1.0, 2.0] {
                    let along = glam::DQuat::from_axis_angle(normal, spin) * side;
                    let middle = DVec3::new(0.2, -0.1, -6.0);
                    let ends = [middle - along, middle + along];
                    let segment = project(ends, [normal, normal], &view);
                    let share = visible_share(&segment, &view, plane_depth(normal, normal.dot(middle), &view));
                    assert_eq!(share, 1.0, "{degrees}° {turn} {spin}");
                }
            }
        }
    }
}

#[test]
fn the_plane_through_four_pixels_is_in_front_by_its_depth_at_the_point_less_the_tolerance() {
    // Depths of the plane a + b x + c y at the centres of four pixels, x to the right and y down.
    let quad = |a: f64, b: f64, c: f64| DVec4::new(a, a + b, a + c, a + b + c);
    let before = |quad, x: f64, y: f64, depth, per_px| outline_plane_in_front(quad, DVec2::new(x, y), depth, per_px);
    let cases = [
        // A plane at one depth, wherever the point is.
        (before(quad(0.5, 0.0, 0.0), 0.5, 0.5, 0.25, 0.0), 0.25),
        (before(quad(0.5, 0.0, 0.0), 0.0, 1.0, 0.75, 0.0), -0.25),
        // 1/100 of what a pixel is wide in depth.
        (before(quad(0.5, 0.0, 0.0), 0.5, 0.5, 0.25, 2.0), 0.25 - 0.02),
        // 1/128 of each slope, whatever its sign.
        (before(quad(0.5, 0.25, 0.0), 0.5, 0.5, 0.5, 0.0), 0.125 - 0.25 / 128.0),
        (before(quad(0.5, -0.25, 0.0), 0.25, 0.5, 0.25, 0.0), 0.1875 - 0.25 / 128.0),
        (before(quad(0.5, 0.0, 0.25), 0.5, 0.75, 0.25, 0.0), 0.4375 - 0.25 / 128.0),
        (before(quad(0.5, 0.0, -0.25), 0.5, 0.25, 0.25, 0.0), 0.1875 - 0.25 / 128.0),
        (before(quad(0.5, 0.25, -0.125), 1.0, 0.0, 0.5, 1.0), 0.25 - 0.01 - 0.375 / 128.0),
        (before(quad(0.5, -0.125, 0.25), 0.0, 1.0, 0.5, 1.0), 0.25 - 0.01 - 0.375 / 128.0),
    ];
    for (i, (value, expected)) in cases.into_iter().enumerate() {
        assert!((value - expected).abs() < 1e-15, "{i}: {value} for {expected}");
    }
    // One corner off the plane of the other three by 1/4: the best plane's mean is 1/16 off and each of its slopes 1/8,
    // and the whole 1/4 is taken off, whichever corner it is and to whichever side.
    for corner in 0..4 {
        for off in [0.25, -0.25] {
            let mut quad = [0.5; 4];
            quad[corner] += off;
            let value = before(DVec4::from(quad), 0.5, 0.5, 0.25, 0.0);
            let expected = 0.25 + off / 4.0 - 0.25 / 128.0 - 0.25;
            assert!((value - expected).abs() < 1e-15, "{corner} {off}: {value} for {expected}");
        }
    }
}

#[test]
fn a_silhouette_before_the_background_is_seen_and_hidden_behind_a_nearer_plane() {
    let view = perspective();
    let ends = [DVec3::new(-1.0, 0.3, -5.0), DVec3::new(1.2, 0.5, -5.5)];
    let normals = [DVec3::new(0.0, 0.3, 1.0).normalize(), DVec3::new(0.0, 0.3, -1.0).normalize()];
    let segment = project(ends, normals, &view);
    let (first, _) = segment.at(0.0);
    let (direction, _) = segment.direction();
    // Below the line its own surface, far nearer than its rim; above it nothing.
    let own = |x: i64, y: i64| {
        let offset = direction.perp_dot(DVec2::new(x as f64, y as f64) + 0.5 - first);
        if offset > 0.0 { NEAR / 4.0 } else { 0.0 }
    };
    assert_eq!(visible_share(&segment, &view, own), 1.0);
    assert_eq!(visible_share(&segment, &view, |_, _| 0.0), 1.0);
    // A wall before all of it, and one before the left half of the picture.
    assert_eq!(visible_share(&segment, &view, plane_depth(DVec3::Z, -4.9, &view)), 0.0);
    let half = |x: i64, _| if x < 320 { NEAR / 3.0 } else { 0.0 };
    let expected = 1.0 - (320.0 - segment.ends_px[0].x) / (segment.ends_px[1].x - segment.ends_px[0].x);
    assert!((visible_share(&segment, &view, half) - expected).abs() < 0.01);
    // A wall behind it does not hide it.
    assert_eq!(visible_share(&segment, &view, plane_depth(DVec3::Z, -7.0, &view)), 1.0);
}

#[test]
fn a_concave_corner_is_seen() {
    let view = perspective();
    // Floor and wall meet at y = -1, z = -6; both come towards the eye on their side of the line. The eye looks down on
    // the floor at 10°.
    let ends = [DVec3::new(-2.0, -1.0, -6.0), DVec3::new(2.0, -1.0, -6.0)];
    let floor = plane_depth(DVec3::Y, -1.0, &view);
    let wall = plane_depth(DVec3::Z, -6.0, &view);
    let corner = |x: i64, y: i64| floor(x, y).max(wall(x, y));
    // Wall: inwards is up, the edge runs right: the wall lies on its left seen from +z, so the wall is the first face.
    let segment = project(ends, [DVec3::Z, DVec3::Y], &view);
    assert_eq!(visible_share(&segment, &view, corner), 1.0);
    // A slanted corner, with pixels on either side.
    let turn = glam::DQuat::from_rotation_z(0.3) * glam::DQuat::from_rotation_y(0.2);
    let ends = ends.map(|end| turn * end);
    let (n0, n1) = (turn * DVec3::Z, turn * DVec3::Y);
    let segment = project(ends, [n0, n1], &view);
    let (floor, wall) = (plane_depth(n1, n1.dot(ends[0]), &view), plane_depth(n0, n0.dot(ends[0]), &view));
    assert_eq!(visible_share(&segment, &view, |x, y| floor(x, y).max(wall(x, y))), 1.0);
}

#[test]
fn a_groove_with_steep_sides_is_seen_and_lost_without_its_normals() {
    let view = perspective();
    let turn = glam::DQuat::from_rotation_z(0.3);
    let steep = f64::to_radians(80.0);
    let (up, down) = (DVec3::new(0.0, steep.cos(), steep.sin()), DVec3::new(0.0, -steep.cos(), steep.sin()));
    let ends = [DVec3::new(-2.0, 0.1, -6.0), DVec3::new(2.0, 0.1, -6.0)].map(|end| turn * end);
    let normals = [turn * DVec3::X.cross(up), turn * DVec3::NEG_X.cross(down)];
    let [above, below] = normals.map(|normal| plane_depth(normal, normal.dot(ends[0]), &view));
    let groove = |x: i64, y: i64| above(x, y).max(below(x, y));
    assert_eq!(visible_share(&project(ends, normals, &view), &view, groove), 1.0);
    // With the slopes unknown, it is seen only where it runs close by a pixel's centre.
    let share = visible_share(&project(ends, [DVec3::ZERO; 2], &view), &view, groove);
    assert!(share < 0.8, "{share}");
}

#[test]
fn a_line_behind_a_grazing_surface_is_hidden() {
    let view = perspective();
    let ends = [DVec3::new(-1.0, 0.0, -8.0), DVec3::new(1.0, 0.4, -8.0)];
    let segment = project(ends, [DVec3::Z, DVec3::Z], &view);
    // A plane at 80° to the view, some px of depth before the line everywhere along it.
    let tilt = f64::to_radians(80.0);
    let normal = DVec3::new(0.0, tilt.sin(), tilt.cos());
    let per_px = 8.0 * view.depth_per_px.x;
    let nearest = normal.dot(ends[1]).max(normal.dot(ends[0]));
    assert_eq!(visible_share(&segment, &view, plane_depth(normal, nearest + 8.0 * per_px, &view)), 0.0);
    // The bound on slopes: a face of the edge seen at 89° must not count as a hole in a surface in front of it.
    let grazing = DVec3::new(0.0, f64::to_radians(89.0).sin(), f64::to_radians(89.0).cos());
    let segment = project(ends, [grazing, grazing], &view);
    let allowed = DEPTH_SLACK_PX + MAX_SLOPE * std::f64::consts::SQRT_2;
    assert_eq!(visible_share(&segment, &view, plane_depth(DVec3::Z, -8.0 + 1.1 * allowed * per_px, &view)), 0.0);
}

#[test]
fn a_line_just_behind_a_grazing_surface_is_hidden() {
    for view in [perspective(), parallel()] {
        for degrees in [0.0, 30.0, 60.0, 80.0, 85.0] {
            let tilt = f64::to_radians(degrees);
            let normal = DVec3::new(0.0, tilt.sin(), tilt.cos());
            // A solid on the other side: one face along the surface, one away from it.
            for spin in [0.0, 0.3, 1.1, 1.6] {
                let along = glam::DQuat::from_axis_angle(normal, spin) * DVec3::X;
                let middle = DVec3::new(0.1, 0.0, -6.0);
                let ends = [middle - 0.6 * along, middle + 0.6 * along];
                let segment = project(ends, [normal, -normal.cross(along)], &view);
                // The size of a px at the middle's distance.
                let px = if view.depth_per_px.y == 0.0 { 6.0 * view.depth_per_px.x } else { 20.0 / SIZE.y };
                let before = |gap_px: f64| plane_depth(normal, normal.dot(middle) + gap_px * px, &view);
                assert_eq!(visible_share(&segment, &view, before(0.05)), 0.0, "{degrees} {spin}");
                // On the surface, and before it.
                assert_eq!(visible_share(&segment, &view, before(0.0)), 1.0, "{degrees} {spin}");
                assert_eq!(visible_share(&segment, &view, before(-0.05)), 1.0, "{degrees} {spin}");
            }
        }
    }
}

#[test]
fn a_fold_is_visible_at_any_angle() {
    let view = perspective();
    let ends = [DVec3::new(-2.0, 0.1, -6.0), DVec3::new(2.0, 0.13, -6.2)];
    let edge = (ends[1] - ends[0]).normalize();
    let facing = DVec3::Z.reject_from(edge).normalize();
    // Half the angle by which the surface turns; valleys first.
    for half_degrees in [-70.0, -45.0, -20.0, -8.0, -3.0, -1.0, -0.2, 0.0, 0.2, 3.0, 30.0, 70.0] {
        for lean_degrees in [-55.0f64, -20.0, 0.0, 33.0, 60.0] {
            for spin in [0.0, 0.3, FRAC_PI_4, 1.2] {
                let lean = lean_degrees.to_radians();
                let [above, below] = [1.0, -1.0].map(|side| {
                    let turn = glam::DQuat::from_axis_angle(edge, lean - side * f64::to_radians(half_degrees));
                    glam::DQuat::from_rotation_z(spin) * turn * facing
                });
                // Beyond the bound on slopes nothing is promised.
                if above.z < 0.2 || below.z < 0.2 {
                    continue;
                }
                let ends = ends.map(|end| glam::DQuat::from_rotation_z(spin) * end);
                let [on_above, on_below] = [above, below].map(|n| plane_depth(n, n.dot(ends[0]), &view));
                let segment = project(ends, [above, below], &view);
                let valley = half_degrees < 0.0;
                let surface = |x: i64, y: i64| {
                    let (a, b) = (on_above(x, y), on_below(x, y));
                    if valley { a.max(b) } else { a.min(b) }
                };
                let share = visible_share(&segment, &view, surface);
                assert_eq!(share, 1.0, "{half_degrees}° {lean_degrees}° {spin}");
            }
        }
    }
}

#[test]
fn a_cut_out_needs_a_surface_at_its_own_depth() {
    let view = perspective();
    let ends = [DVec3::new(-1.0, 0.3, -5.0), DVec3::new(1.2, 0.5, -5.5)];
    let segment = project(ends, [DVec3::Z, DVec3::ZERO], &view);
    let seen =
        |cut_out, depth_at: &dyn Fn(i64, i64) -> f64| outline_is_visible(&segment, 0.4, &view, cut_out, depth_at);
    let nothing = |_: i64, _: i64| 0.0;
    assert!(seen(false, &nothing) && !seen(true, &nothing));
    let (_, depth) = segment.at(0.4);
    let own = |_: i64, _: i64| depth;
    assert!(seen(false, &own) && seen(true, &own));
    let far_behind = |_: i64, _: i64| 0.5 * depth;
    assert!(seen(false, &far_behind) && !seen(true, &far_behind));
}

proptest! {
    #[test]
    fn projected_segments_are_finite_and_within_the_guard(
        a in prop::array::uniform3(-30.0..30.0f64),
        b in prop::array::uniform3(-30.0..30.0f64),
        normal in prop::array::uniform3(-1.0..1.0f64),
        width_px in 0.0..20.0f64,
    ) {
        let normal = DVec3::from_array(normal).normalize_or_zero();
        for view in [perspective(), parallel()] {
            let ends = [DVec3::from_array(a), DVec3::from_array(b)];
            if let Some(segment) = outline_project(ends, [normal, -normal], width_px, &view) {
                let margin = 0.5 * width_px + 2.0 + 1e-6;
                for (p, depth) in segment.ends_px.iter().zip(segment.depths) {
                    prop_assert!(p.cmpge(DVec2::splat(-margin)).all() && p.cmple(SIZE + margin).all());
                    prop_assert!(depth <= 1.0 + 1e-12 && depth.is_finite());
                }
                prop_assert!(segment.slopes.iter().all(|s| s.is_finite() && *s >= 0.0));
            }
        }
    }

    #[test]
    fn a_split_line_covers_what_the_whole_does(cut in 0.01..0.99f64, x in -10.0..70.0f64, y in -10.0..50.0f64) {
        let ends_px = [DVec2::new(3.0, 4.0), DVec2::new(51.0, 30.5)];
        let whole = ScreenSegment { ends_px, depths: [0.9, 0.1], slopes: [0.0; 2] };
        let (middle, depth) = whole.at(cut);
        let parts = [
            ScreenSegment { ends_px: [ends_px[0], middle], depths: [0.9, depth], slopes: [0.0; 2] },
            ScreenSegment { ends_px: [middle, ends_px[1]], depths: [depth, 0.1], slopes: [0.0; 2] },
        ];
        let point = DVec2::new(x, y);
        for width_px in [0.3, 1.0, 5.0] {
            let of_parts = parts.map(|part| outline_coverage(&part, point, width_px));
            let of_whole = outline_coverage(&whole, point, width_px);
            prop_assert!((of_parts[0].max(of_parts[1]) - of_whole).abs() < 1e-12);
        }
    }
}

/// Each side of a line has the slope of its own face: a surface in front of the line within it does not hide the line, on
/// the other side it does.
#[test]
fn a_vote_allows_for_the_slope_of_its_own_side() {
    let (depth, per_px) = (0.5, 0.01);
    // The face on the positive side rises by 3 px of depth a px towards the eye.
    let slopes = [0.03, 0.0];
    let in_front = depth + 2.0 * per_px;
    assert!(outline_vote(in_front, depth, 1.0, slopes, per_px).0);
    assert!(!outline_vote(in_front, depth, -1.0, slopes, per_px).0);
    assert!(outline_vote(in_front, depth, -1.0, [0.0, 0.03], per_px).0);
    assert!(!outline_vote(in_front, depth, 1.0, [0.0, 0.03], per_px).0);
    // On the line itself the slack of half a px of depth is all there is.
    assert!(outline_vote(depth + 0.49 * per_px, depth, 0.0, slopes, per_px).0);
    assert!(!outline_vote(depth + 0.51 * per_px, depth, 0.0, slopes, per_px).0);
}

/// A flat surface before a line hides it, but not where it is curved along the row or the column of pixels that is nearest
/// to the line's point; curvature along the others is farther away and does not count.
#[test]
fn only_curvature_beside_the_point_lets_a_line_through_a_surface_in_front() {
    let view = parallel();
    let (corner, depth) = (DVec2::new(100.0, 200.0), 0.5);
    let surface = depth + 10.0 * view.depth_per_px.y;
    for (right, lower) in [(false, false), (true, false), (false, true), (true, true)] {
        let within = DVec2::new(if right { 0.8 } else { 0.2 }, if lower { 0.8 } else { 0.2 });
        let on_line = corner + 0.5 + within;
        let hidden = |odd: (i64, i64)| {
            // One pixel of the eight around the four is so much nearer that the surface is curved there.
            let at = |x: i64, y: i64| if (x, y) == odd { surface + 0.2 } else { surface };
            outline_plane_hides(DVec4::splat(surface), corner, on_line, depth, &view, at)
        };
        let (x, y) = (100 + i64::from(right), 200 + i64::from(lower));
        assert!(hidden((-1, -1)), "a plane hides");
        for beside in [(99, y), (102, y), (x, 199), (x, 202)] {
            assert!(!hidden(beside), "{right} {lower}: curved at {beside:?}");
        }
        let (other_x, other_y) = (201 - x, 401 - y);
        for beside in [(99, other_y), (102, other_y), (other_x, 199), (other_x, 202)] {
            assert!(hidden(beside), "{right} {lower}: {beside:?} is not beside it");
        }
    }
}

/// Outside the picture there are no depths: of the last four pixels at the lower right border all are inside, of those one
/// pixel farther only some.
#[test]
fn no_surface_hides_a_line_at_the_border_of_the_picture() {
    let view = parallel();
    let surface = 0.5 + 10.0 * view.depth_per_px.y;
    let hides = |x: f64, y: f64| {
        let corner = DVec2::new(x, y);
        outline_plane_hides(DVec4::splat(surface), corner, corner + 1.0, 0.5, &view, |_, _| surface)
    };
    assert!(hides(0.0, 0.0) && hides(SIZE.x - 2.0, SIZE.y - 2.0));
    assert!(!hides(-1.0, 5.0) && !hides(5.0, -1.0));
    assert!(!hides(SIZE.x - 1.0, 5.0) && !hides(5.0, SIZE.y - 1.0));
}

/// A face seen nearly edge-on covers no pixel, and its slope is none: from 1024 px of depth a px on.
#[test]
fn a_face_seen_edge_on_has_no_slope() {
    for view in [perspective(), parallel()] {
        let ends = [DVec3::new(-1.0, 0.0, -5.0), DVec3::new(1.0, 0.0, -5.0)];
        let along_view = if view.depth_per_px.x > 0.0 { DVec3::new(0.0, 0.0, -1.0) } else { DVec3::NEG_Z };
        // The inward direction of a face below the line, turned away from the line of sight by 1 in `steep`.
        let slope = |steep: f64| {
            let inward = (along_view * steep - DVec3::Y).normalize();
            let edge = ends[1] - ends[0];
            let normal = edge.cross(inward).normalize();
            let segment = project(ends, [normal, DVec3::ZERO], &view);
            segment.slopes[0].max(segment.slopes[1])
        };
        // Away from the eye a face's depth falls, so its slope is taken as 0; towards the eye it rises.
        let rising = |steep: f64| slope(-steep);
        assert!(rising(100.0) > 0.0 && rising(900.0) > 0.0, "{} {}", rising(100.0), rising(900.0));
        assert_eq!((rising(1200.0), slope(100.0)), (0.0, 0.0));
    }
}

/// The line is visible beside its own face, which rises on one side as its slope says, with something in front of it on the
/// other; it would not be if the slopes were those of the other sides.
#[test]
fn a_line_is_seen_beside_its_own_face_on_whichever_side_that_is() {
    let view = parallel();
    let per_px = view.depth_per_px.y;
    // Positive offsets are below a line to the right. The pixels of the own face are those that are farther away.
    for (own_is_below, y) in [(true, 200.7), (false, 201.3)] {
        let ends_px = [DVec2::new(100.3, y), DVec2::new(140.3, y)];
        let surface = |_: i64, y: i64| {
            let offset = y as f64 + 0.5 - ends_px[0].y;
            if (offset > 0.0) == own_is_below { 0.5 + 2.0 * per_px * offset.abs() } else { 0.5 + 100.0 * per_px }
        };
        let visible = |slopes: [f64; 2]| {
            let segment = ScreenSegment { ends_px, depths: [0.5; 2], slopes };
            outline_is_visible(&segment, 0.4, &view, false, surface)
        };
        let (below, above) = ([2.2 * per_px, 0.0], [0.0, 2.2 * per_px]);
        assert_eq!((visible(below), visible(above)), (own_is_below, !own_is_below));
    }
}

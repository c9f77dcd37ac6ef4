#![allow(clippy::print_stdout)]

use super::*;
use crate::raster::rasterise;
use glam::dcamera::rh::proj::directx as proj;
use glam::dcamera::rh::view::look_at_mat4;
use npr_mesh::edges::{EdgeOptions, find};
use npr_mesh::{Material, embedded};

const FOV: f64 = 0.8;
const NEAR: f64 = 0.05;
const SIZE: [u32; 2] = [320, 240];

fn edges_of(model: &Model) -> Edges {
    find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &EdgeOptions::default())
}

fn hull_of(model: &Model, normals: HullNormals) -> Hull {
    Hull::new(model, &edges_of(model), normals)
}

fn view(view_from_world: DMat4, size: [u32; 2], width_px: f64) -> HullView {
    let viewport_px = DVec2::new(f64::from(size[0]), f64::from(size[1]));
    HullView {
        clip_from_world: proj::perspective_infinite_reverse(FOV, viewport_px.x / viewport_px.y, NEAR) * view_from_world,
        view_from_normal: DMat3::from_mat4(view_from_world),
        viewport_px,
        depth_per_px: DVec2::new(2.0 * (0.5 * FOV).tan() / viewport_px.y, 0.0),
        width_px,
        mirrored: false,
    }
}

fn looking_from(eye: DVec3) -> DMat4 {
    look_at_mat4(eye, DVec3::ZERO, if eye.x == 0.0 && eye.z == 0.0 { DVec3::Z } else { DVec3::Y })
}

/// The depth of a model's nearest surface at each pixel, 0 where there is none, and the pixels that the hull inks.
fn drawn(model: &Model, hull: &Hull, view: &HullView) -> (Vec<f64>, Vec<bool>) {
    let size = view.viewport_px.as_uvec2().to_array();
    let at = |x: u32, y: u32| (y * size[0] + x) as usize;
    let clip = |vertex: u32| view.clip_from_world * model.positions[vertex as usize].as_dvec3().extend(1.0);
    let surface: Vec<_> = model.faces.iter().map(|face| face.map(clip)).collect();
    let mut depth = vec![0.0f64; (size[0] * size[1]) as usize];
    rasterise(&surface, size, |_, _| 0.0, |x, y, d| depth[at(x, y)] = depth[at(x, y)].max(d));
    let mut inked = vec![false; depth.len()];
    rasterise(&hull_triangles(hull, view), size, |x, y| depth[at(x, y)], |x, y, _| inked[at(x, y)] = true);
    (depth, inked)
}

/// The pixels without ink beside the surface's outline: background with a neighbour on the surface.
fn gaps(depth: &[f64], inked: &[bool], [width, height]: [u32; 2]) -> usize {
    let on_surface = |x: i64, y: i64| {
        let inside = (0..i64::from(width)).contains(&x) && (0..i64::from(height)).contains(&y);
        inside && depth[(y * i64::from(width) + x) as usize] > 0.0
    };
    let is_gap = |&pixel: &usize| {
        let (x, y) = (pixel as i64 % i64::from(width), pixel as i64 / i64::from(width));
        let beside = (-1..=1).any(|dy| (-1..=1).any(|dx| on_surface(x + dx, y + dy)));
        beside && !on_surface(x, y) && !inked[pixel]
    };
    (0..depth.len()).filter(is_gap).count()
}

fn directions() -> impl Iterator<Item = DVec3> {
    (0..40u32).map(|i| {
        let z = (f64::from(i) + 0.5) / 20.0 - 1.0;
        DVec2::from_angle(f64::from(i) * 2.4).extend(0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
    })
}

#[test]
fn welded_normals_do_not_depend_on_how_polygons_are_cut() {
    let mut model = embedded::cube();
    // One square is cut along its other diagonal, so that at some corners one of its triangles meets, at others two.
    let [a, b, c] = model.faces[0];
    let d = model.faces[1][2];
    assert_eq!(model.faces[1], [a, c, d]);
    (model.faces[0], model.faces[1]) = ([a, b, d], [b, c, d]);
    let hull = hull_of(&model, HullNormals::Welded);
    assert_eq!((hull.vertices.len(), hull.faces.len()), (8, 12));
    for vertex in &hull.vertices {
        assert!(vertex.normal.distance(vertex.position.normalize()) < 1e-6, "{vertex:?}");
    }
    let as_games = hull_of(&model, HullNormals::Vertices);
    assert_eq!((as_games.vertices.len(), as_games.faces.len()), (24, 12));
    for (face, of_model) in as_games.faces.iter().zip(&model.faces) {
        let vertices = face.map(|vertex| as_games.vertices[vertex as usize]);
        assert_eq!(vertices.map(|v| v.position), of_model.map(|v| model.positions[v as usize]));
        assert_eq!(vertices.map(|v| v.normal), of_model.map(|v| model.normals[v as usize]));
    }
}

#[test]
fn a_cube_has_gaps_with_the_normals_of_vertices_and_none_with_welded_ones() {
    let model = embedded::cube();
    let [welded, torn] = [HullNormals::Welded, HullNormals::Vertices].map(|normals| hull_of(&model, normals));
    let (mut views_with_gaps, mut all) = (0, [0, 0]);
    for direction in directions() {
        let view = view(looking_from(5.0 * direction), SIZE, 6.0);
        let [closed, open] = [&welded, &torn].map(|hull| {
            let (depth, inked) = drawn(&model, hull, &view);
            gaps(&depth, &inked, SIZE)
        });
        assert_eq!(closed, 0, "from {direction}");
        views_with_gaps += u32::from(open > 0);
        all[1] += open;
        all[0] += closed;
    }
    println!("{views_with_gaps} of 40 views have gaps, {all:?} px in all");
    assert!(views_with_gaps > 30, "{views_with_gaps} of 40 views have gaps");
}

/// The mean width of the ink around a sphere in the middle of the picture, from the areas of two discs, px; and the area of
/// the sphere.
fn ring_px(depth: &[f64], inked: &[bool]) -> (f64, usize) {
    let ink = inked.iter().filter(|&&inked| inked).count();
    let inside = depth.iter().filter(|&&depth| depth > 0.0).count();
    let radius = |area: usize| (area as f64 / std::f64::consts::PI).sqrt();
    (radius(inside + ink) - radius(inside), inside)
}

#[test]
fn a_sphere_has_a_ring_of_the_width_asked_for_near_and_far() {
    let model = embedded::sphere(96);
    for normals in [HullNormals::Welded, HullNormals::Vertices] {
        let hull = hull_of(&model, normals);
        for distance in [3.2, 5.0, 10.0, 30.0] {
            for width_px in [1.0, 3.0, 8.0] {
                let size = [600, 600];
                let view = view(looking_from(distance * DVec3::new(0.48, 0.6, 0.64)), size, width_px);
                let (depth, inked) = drawn(&model, &hull, &view);
                let (ring, inside) = ring_px(&depth, &inked);
                println!("{normals:?}: at {distance} {width_px} px: {ring:.3} px around {inside} px");
                assert!(!inked.iter().zip(&depth).any(|(&inked, &depth)| inked && depth > 0.0), "ink on the sphere");
                // The band is measured by counting pixels.
                assert!((ring - width_px).abs() < 0.02 * width_px + 0.05, "{ring} px at {distance}, {width_px} asked");
            }
        }
    }
}

/// Off the axis a sphere's image is an ellipse, here about 1.24 times as long as wide. The width is measured
/// perpendicular to it.
#[test]
fn the_ring_is_as_wide_off_the_axis() {
    let model = embedded::sphere(256);
    let hull = hull_of(&model, HullNormals::Welded);
    let size = [800u32, 800];
    let width_px = 6.0;
    let mut view = view(look_at_mat4(DVec3::new(0.0, 0.0, 9.0), DVec3::ZERO, DVec3::Y), size, width_px);
    // A wide view, in which the sphere is at the border.
    let fov = 1.6;
    let aside = DMat4::from_translation(DVec3::new(5.6, 3.5, 0.0));
    let view_from_world = look_at_mat4(DVec3::new(0.0, 0.0, 9.0), DVec3::ZERO, DVec3::Y);
    view.clip_from_world = proj::perspective_infinite_reverse(fov, 1.0, NEAR) * view_from_world * aside;
    let px = 800.0 / (2.0 * (0.5 * fov).tan());
    view.depth_per_px = DVec2::new(1.0 / px, 0.0);
    // Distance of a point of the plane at depth 1 from the contour, by its cone around the direction to the centre.
    let centre = DVec3::new(5.6, 3.5, -9.0);
    let cos = (1.0 - 1.0 / centre.length_squared()).sqrt();
    let inside = |point: DVec2| {
        let ray = ((point - 400.0) / px * DVec2::new(1.0, -1.0)).extend(-1.0);
        ray.normalize().dot(centre.normalize()) - cos
    };
    let (_, inked) = drawn(&model, &hull, &view);
    let (mut outer, mut inner) = (0.0f64, f64::INFINITY);
    for (pixel, &inked) in inked.iter().enumerate() {
        let point = DVec2::new((pixel % 800) as f64 + 0.5, (pixel / 800) as f64 + 0.5);
        let gradient = DVec2::new(
            inside(point + DVec2::X * 1e-3) - inside(point - DVec2::X * 1e-3),
            inside(point + DVec2::Y * 1e-3) - inside(point - DVec2::Y * 1e-3),
        ) / 2e-3;
        // Newton's method along the gradient: the nearest point of the contour, for points a few px beside it.
        let mut foot = point;
        for _ in 0..3 {
            foot -= gradient * (inside(foot) / gradient.length_squared());
        }
        let distance = if inside(point) < 0.0 { point.distance(foot) } else { continue };
        if inked {
            outer = outer.max(distance);
        } else if distance < 20.0 {
            inner = inner.min(distance);
        }
    }
    println!("ink up to {outer:.3} px from the contour, none from {inner:.3} px on");
    assert!((outer - width_px).abs() < 0.3 && (inner - width_px).abs() < 0.3, "{outer} {inner}");
}

/// A box without a lid: its inside is the back of its faces.
fn open_box() -> Model {
    let mut model = embedded::cube();
    let edges = edges_of(&model);
    let is_lid = |face: usize| edges.face_normals[face] == Vec3::Z;
    let kept: Vec<_> = (0..model.faces.len()).filter(|&face| !is_lid(face)).collect();
    model.faces = kept.iter().map(|&face| model.faces[face]).collect();
    model.face_polygon = kept.iter().map(|&face| model.face_polygon[face]).collect();
    model.face_material.clear();
    model
}

#[test]
fn a_surface_hides_its_own_hull_where_its_back_is_visible() {
    let model = open_box();
    assert_eq!(model.faces.len(), 10);
    let hull = hull_of(&model, HullNormals::Welded);
    // The last are nearly along a corner's normal, which turns to either side of the view.
    let eyes =
        [[0.0, 0.0, 1.0], [0.2, 0.1, 1.0], [-0.5, 0.4, 1.0], [0.9, 0.7, 1.0], [0.97, 1.0, 1.03], [1.0, 1.0, 0.93]];
    for (eye, parallel) in eyes.map(DVec3::from).into_iter().flat_map(|eye| [(eye, false), (eye, true)]) {
        let mut view = view(looking_from(4.0 * eye), SIZE, 4.0);
        if parallel {
            // 4 high, 10 deep, reversed.
            let clip_from_view = proj::orthographic(-8.0 / 3.0, 8.0 / 3.0, -2.0, 2.0, 10.0, 0.0);
            view.clip_from_world = clip_from_view * looking_from(4.0 * eye);
            view.depth_per_px = DVec2::new(0.0, 4.0 / 240.0 / 10.0);
        }
        let (depth, inked) = drawn(&model, &hull, &view);
        let on_surface = inked.iter().zip(&depth).filter(|&(&inked, &depth)| inked && depth > 0.0).count();
        let beside = inked.iter().zip(&depth).filter(|&(&inked, &depth)| inked && depth == 0.0).count();
        assert_eq!(on_surface, 0, "from {eye}");
        assert!(beside > 500, "from {eye}: {beside}");
    }
}

#[test]
fn an_open_surface_has_no_band_from_the_front_and_a_displaced_copy_from_the_back() {
    let model = embedded::ground(1.0);
    let hull = hull_of(&model, HullNormals::Welded);
    let front = view(looking_from(DVec3::new(0.5, 3.0, 2.0)), SIZE, 4.0);
    assert!(hull_triangles(&hull, &front).is_empty());
    let back = view(looking_from(DVec3::new(0.5, -3.0, 2.0)), SIZE, 4.0);
    assert_eq!(hull_triangles(&hull, &back).len(), model.faces.len());
    let (depth, inked) = drawn(&model, &hull, &back);
    assert!(!inked.iter().zip(&depth).any(|(&inked, &depth)| inked && depth > 0.0));
    // On one side only.
    assert!(gaps(&depth, &inked, SIZE) > 100 && inked.iter().any(|&inked| inked));
}

/// The width beside a hard edge is the component of its ends' displacement across it.
#[test]
fn beside_the_edges_of_a_cube_the_band_is_narrower_than_asked() {
    let model = embedded::cube();
    let edges = edges_of(&model);
    let hull = Hull::new(&model, &edges, HullNormals::Welded);
    let (mut shares, width_px) = (Vec::new(), 4.0);
    for eye in directions().map(|direction| 6.0 * direction) {
        let view = view(looking_from(eye), SIZE, width_px);
        for edge in &edges.edges {
            let ends = edge.ends.map(|vertex| model.positions[vertex as usize].as_dvec3());
            let faces_eye = |face: u32| {
                let normal = edges.face_normals[face as usize].as_dvec3();
                normal.dot(eye - ends[0]) > 0.0
            };
            if faces_eye(edge.faces()[0]) == faces_eye(edge.faces()[1]) {
                continue;
            }
            let px = |clip: DVec4| clip.truncate().truncate() / clip.w * 0.5 * view.viewport_px;
            let [from, to] = ends.map(|end| px(view.clip_from_world * end.extend(1.0)));
            let across = (to - from).normalize().perp();
            for end in ends {
                let corner = hull.vertices.iter().find(|v| v.position.as_dvec3() == end).unwrap();
                shares.push(hull_offset(corner.normal.as_dvec3(), &view).dot(across).abs() / width_px);
            }
        }
    }
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    let least = shares.iter().copied().fold(1.0, f64::min);
    println!("{} ends of edges: {mean:.3} of the width in the mean, {least:.3} at least", shares.len());
    assert!(shares.iter().all(|share| *share < 1.0 + 1e-9) && least > 0.5 && (0.7..0.95).contains(&mean));
}

#[test]
fn the_hull_hides_and_is_hidden_as_depth_says() {
    let model = embedded::sphere(32);
    let hull = hull_of(&model, HullNormals::Welded);
    let view = view(looking_from(4.0 * DVec3::Z), SIZE, 5.0);
    let triangles = hull_triangles(&hull, &view);
    let count = |scene: f64| {
        let mut count = 0;
        rasterise(&triangles, SIZE, |_, _| scene, |_, _, _| count += 1);
        count
    };
    let depth_at = |distance: f64| NEAR / distance;
    // The hull is between the sphere's contour, 3.75 from the eye, and its back, at 5, moved away by 3 %.
    assert!(count(0.0) > 5000);
    assert_eq!(count(depth_at(3.7)), 0);
    assert_eq!(count(depth_at(5.3)), count(0.0));
    let some = count(depth_at(4.2));
    assert!(some > 0 && some < count(0.0), "{some}");
}

#[test]
fn a_mirrored_view_is_that_of_the_mirrored_model() {
    let mut model = embedded::teapot(4);
    model.positions.iter_mut().for_each(|p| p.z += 0.3 * p.x);
    let mut mirrored = model.clone();
    mirrored.positions.iter_mut().chain(&mut mirrored.normals).for_each(|v| v.x = -v.x);
    mirrored.faces.iter_mut().for_each(|face| face.swap(1, 2));
    let plain = view(looking_from(DVec3::new(3.0, 4.0, 7.0)), SIZE, 4.0);
    let mirror = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
    let through_mirror = HullView {
        clip_from_world: plain.clip_from_world * DMat4::from_mat3(mirror),
        view_from_normal: plain.view_from_normal * mirror,
        mirrored: true,
        ..plain
    };
    for normals in [HullNormals::Welded, HullNormals::Vertices] {
        let by_hand = drawn(&mirrored, &hull_of(&mirrored, normals), &plain).1;
        let by_view = drawn(&model, &hull_of(&model, normals), &through_mirror).1;
        assert!(by_hand.iter().filter(|&&inked| inked).count() > 500);
        assert_eq!(by_hand.iter().zip(&by_view).filter(|(a, b)| a != b).count(), 0, "{normals:?}");
    }
}

#[test]
fn what_has_no_normal_stays_in_place() {
    let view = view(looking_from(4.0 * DVec3::Z), SIZE, 5.0);
    assert_eq!(hull_offset(DVec3::ZERO, &view), DVec2::ZERO);
    // Along the view, and nearly so.
    assert!(hull_offset(DVec3::NEG_Z, &view).length() < 1e-9);
    assert!((hull_offset(DVec3::new(0.005, 0.0, -1.0), &view).length() - 2.5).abs() < 1e-3);
    assert!((hull_offset(DVec3::new(0.1, 0.1, -1.0), &view).length() - 5.0).abs() < 1e-12);
    // Two faces back to back cancel out.
    let mut model = embedded::ground(1.0);
    let other: Vec<_> = model.faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
    model.faces.extend(other);
    model.face_polygon.clear();
    model.face_material.clear();
    let mut edges = edges_of(&model);
    edges.skipped.clear();
    let hull = Hull::new(&model, &edges, HullNormals::Welded);
    assert!(hull.vertices.iter().all(|vertex| vertex.normal == Vec3::ZERO));
    model.normals[0] = Vec3::NAN;
    let hull = Hull::new(&model, &edges, HullNormals::Vertices);
    assert_eq!(hull.vertices.iter().filter(|vertex| vertex.normal == Vec3::ZERO).count(), 1);
}

#[test]
fn redundant_blended_and_cut_out_faces_are_left_out() {
    let mut model = embedded::cube();
    model.faces.push(model.faces[3]);
    model.face_polygon.push(6);
    model.face_material.clear();
    assert_eq!(hull_of(&model, HullNormals::Welded).faces.len(), 12);
    model.face_material = (0..13).map(|face| face / 4).collect();
    let modes = [AlphaMode::Opaque, AlphaMode::Blend, AlphaMode::Mask { cutoff: 0.5 }, AlphaMode::Opaque];
    model.materials = modes.map(|alpha_mode| Material { alpha_mode, ..Material::default() }).to_vec();
    let hull = hull_of(&model, HullNormals::Welded);
    assert_eq!(hull.faces.len(), 4);
    // The first two squares, ±x, share no corner; their normals are their own.
    assert!(hull.vertices.len() == 8 && hull.vertices.iter().all(|v| v.normal.y == 0.0 && v.normal.z == 0.0));
}

//! Tests of the CPU executor against analytic results.
#![allow(clippy::print_stdout)]

use glam::{DVec2, DVec3, Vec3};
use npr_harness::camera::{Camera, Projection};
use npr_harness::capabilities::Capabilities;
use npr_harness::check::{Reference, Shot};
use npr_harness::color::{encode_srgb, to_byte};
use npr_harness::cpu::{CpuFrame, CpuOptions, PrimaryHits, render};
use npr_harness::gallery::still_life_camera;
use npr_harness::lights::lights_in_world;
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::shadow::ShadowLines;
use npr_harness::style::{Style, style};
use npr_harness::view::View;
use npr_imagespace::composite::Composite;
use npr_imagespace::morphology::disc::Disc;
use npr_mesh::{Model, embedded};
use npr_outline::segment::outline_screen;
use npr_toon::source::toon_to_light;
use std::collections::HashSet;
use std::sync::Mutex;
use std::thread;

const PERSPECTIVE: Projection = Projection::Perspective { fov_y_rad: 0.6 };

fn camera(eye: DVec3, projection: Projection) -> Camera {
    Camera { eye, target: DVec3::ZERO, up: DVec3::Y, projection, near: 0.1 }
}

fn frame(scene: &Scene, style: &Style, camera: &Camera, size: (u32, u32), samples: u32) -> CpuFrame {
    let view = View { samples, ..View::new(*camera, size) };
    let plan = Plan::new(scene, style, &view, &Capabilities::RAY_CASTER).expect("a good style");
    render(scene, &plan, &CpuOptions::default(), &|_| {})
}

fn named(name: &str) -> Style {
    style(name).expect("a style of the crate")
}

/// The centre and the value of each pixel.
fn centres<T: Copy>(values: &[T], width: u32) -> impl Iterator<Item = (DVec2, T)> + '_ {
    (0u32..).zip(values).map(move |(i, &v)| (DVec2::new(f64::from(i % width), f64::from(i / width)) + 0.5, v))
}

#[test]
fn a_sphere_is_a_circle() {
    let segments = 256;
    let scene = Scene::new(embedded::sphere(segments));
    let size = (400, 400);
    for (projection, radius) in [
        // The angle of the tangent at a distance of 5: sin = 1 / 5.
        (PERSPECTIVE, 200.0 * (0.2f64.asin().tan()) / 0.3f64.tan()),
        (Projection::Orthographic { height: 3.0, far: 20.0 }, 400.0 / 3.0),
    ] {
        let frame = frame(&scene, &named("lambert"), &camera(DVec3::Z * 5.0, projection), size, 1);
        // Facets lie inside the sphere: at most half a step in each of two directions.
        let step = std::f64::consts::PI / f64::from(segments);
        let sag = radius * (1.0 - step.cos().powi(2));
        let mut inside = 0;
        for (centre, depth) in centres(&frame.depth, size.0) {
            let distance = centre.distance(DVec2::splat(200.0));
            if depth > 0.0 {
                inside += 1;
                assert!(distance <= radius + 0.05, "{centre} is {distance} px from the centre");
            } else {
                assert!(distance >= radius - sag - 0.05, "{centre} is {distance} px from the centre");
            }
        }
        println!("radius {radius:.3} px, sag {sag:.4} px, {inside} px inside");
        assert!((f64::from(inside) / (std::f64::consts::PI * radius * radius) - 1.0).abs() < 0.01);
    }
}

#[test]
fn a_planes_depth_is_linear_on_the_screen() {
    // Corners that f32 holds exactly, so that all four lie in one plane.
    let corners = [[-64.0, -6.0, 16.0], [64.0, -6.0, 16.0], [64.0, 14.0, -64.0], [-64.0, 14.0, -64.0]];
    let scene = Scene::new(Model {
        positions: corners.map(Vec3::from_array).to_vec(),
        normals: vec![Vec3::new(0.0, 4.0, 1.0).normalize(); 4],
        faces: vec![[0, 1, 2], [0, 2, 3]],
        face_material: vec![0; 2],
        materials: vec![Default::default()],
        ..Default::default()
    });
    let size = (120, 80);
    let eye = DVec3::new(1.3, 2.0, 9.0);
    for projection in [PERSPECTIVE, Projection::Orthographic { height: 3.0, far: 100.0 }] {
        let camera = camera(eye, projection);
        let frame = frame(&scene, &named("lambert"), &camera, size, 1);
        let at = |x: u32, y: u32| frame.depth[(y * size.0 + x) as usize];
        let (along_x, along_y) = ((at(100, 20) - at(10, 20)) / 90.0, (at(10, 70) - at(10, 20)) / 50.0);
        assert!(at(10, 20) > 0.0 && along_y.abs() > 1e-6);
        let normal = DVec3::new(0.0, 4.0, 1.0);
        for y in 0..size.1 {
            for x in 0..size.0 {
                let linear = at(10, 20) + along_x * (f64::from(x) - 10.0) + along_y * (f64::from(y) - 20.0);
                assert!((at(x, y) - linear).abs() < 1e-9, "({x}, {y}): {} is not {linear}", at(x, y));
                // The depth is that of the intersection of the ray with 4 y + z = -8.
                let centre = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
                let (origin, direction) = camera.ray(centre, DVec2::new(120.0, 80.0));
                let depth = (-8.0 - normal.dot(origin)) / normal.dot(direction);
                assert!((at(x, y) - camera.buffer_depth(depth)).abs() < 1e-9);
            }
        }
    }
}

/// Distance of a point from the nearest of some segments.
fn distance_to(point: DVec2, segments: &[[DVec2; 2]]) -> f64 {
    segments
        .iter()
        .map(|[a, b]| {
            let t = ((point - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            point.distance(a.lerp(*b, t))
        })
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn nine_of_a_cubes_twelve_edges_are_seen() {
    let scene = Scene::new(embedded::cube());
    let (size, size_px) = ((400, 400), DVec2::splat(400.0));
    let camera = camera(DVec3::new(3.0, 4.5, 6.0), PERSPECTIVE);
    let view = View::new(camera, size);
    let plan = Plan::new(&scene, &named("lines"), &view, &Capabilities::RAY_CASTER).expect("a good style");
    // Those of two back faces are none, on a closed solid seen from outside.
    assert_eq!(plan.lines(&scene).0.len(), 9);
    let corner = |i: u8| DVec3::from_array([0, 1, 2].map(|axis| f64::from(i >> axis & 1) * 2.0 - 1.0));
    let on_screen = |i| outline_screen(camera.clip_from_world(1.0) * corner(i).extend(1.0), size_px).0;
    // The three faces at corner 7 are front-facing; the edges of corner 0 belong to none of them.
    let edges = (0..8u8).flat_map(|a| [1, 2, 4].map(|bit| (a, a | bit))).filter(|(a, b)| a != b);
    let (hidden, seen): (Vec<_>, Vec<_>) = edges.partition(|&(a, _)| a == 0);
    let segment = |&(a, b): &(u8, u8)| [on_screen(a), on_screen(b)];
    let seen: Vec<_> = seen.iter().map(segment).collect();
    assert_eq!((seen.len(), hidden.len()), (9, 3));
    let image = frame(&scene, &named("lines"), &camera, size, 1).image();
    let is_ink = |point: DVec2| image.pixel(point.x as u32, point.y as u32)[1] < 160;
    for [a, b] in &seen {
        for step in 0..=40 {
            let point = a.lerp(*b, f64::from(step) / 40.0);
            assert!(is_ink(point), "no ink at {point}");
        }
    }
    for [a, b] in hidden.iter().map(segment) {
        let away = (0..=40).map(|step| a.lerp(b, f64::from(step) / 40.0)).filter(|&p| distance_to(p, &seen) > 3.0);
        assert!(away.clone().count() > 25);
        assert!(away.into_iter().all(|point| !is_ink(point)), "ink on a hidden edge");
    }
    let inked: Vec<_> = centres(&image.rgba8.chunks_exact(4).map(|p| p[1]).collect::<Vec<_>>(), 400)
        .filter(|&(_, green)| green < 200)
        .map(|(centre, _)| distance_to(centre, &seen))
        .collect();
    println!("{} px of ink, at most {:.2} px away", inked.len(), inked.iter().fold(0.0, |a: f64, &b| a.max(b)));
    assert!(inked.len() > 1000 && inked.iter().all(|&distance| distance < 1.3));
}

#[test]
fn bands_lie_where_the_light_says() {
    let scene = Scene::new(embedded::sphere(256));
    let (size, size_px) = ((400, 400), DVec2::splat(400.0));
    let camera = camera(DVec3::new(2.0, 1.0, 4.0), PERSPECTIVE);
    let lights = lights_in_world(&named("printed-bands").lights, 1, &scene, &camera);
    let to_light = toon_to_light(lights[0].place, DVec3::ZERO);
    let image = frame(&scene, &named("printed-bands"), &camera, size, 1).image();
    let base = encode_srgb(f64::from(0.8f32));
    let mut judged = [0u32; 3];
    for (at, pixel) in centres(&image.rgba8.chunks_exact(4).map(|p| [p[0], p[1], p[2]]).collect::<Vec<_>>(), 400) {
        let (origin, direction) = camera.ray(at, size_px);
        // The nearer root of |origin + t direction| = 1.
        let (a, b) = (direction.length_squared(), origin.dot(direction));
        let root = b * b - a * (origin.length_squared() - 1.0);
        // Near the silhouette, facets deviate from the sphere.
        if root < 0.06 * a {
            continue;
        }
        let normal = origin + direction * ((-b - root.sqrt()) / a);
        let n_dot_l = normal.dot(to_light);
        if (n_dot_l - 0.1).abs() < 2e-3 || (n_dot_l - 0.8).abs() < 2e-3 {
            continue;
        }
        let band = usize::from(n_dot_l > 0.1) + usize::from(n_dot_l > 0.8);
        let tone = [[0.2; 3], [0.6; 3], [0.9, 0.9, 1.0]][band];
        assert_eq!(pixel, tone.map(|t: f32| to_byte(base * f64::from(t))), "at {at}, N·L is {n_dot_l}");
        judged[band] += 1;
    }
    println!("{judged:?} px by band");
    assert!(judged.iter().all(|&n| n > 1000));
}

#[test]
fn more_samples_converge() {
    let scene = Scene::new(embedded::scene());
    let picture = |samples| frame(&scene, &named("cartoon"), &still_life_camera(), (160, 90), samples).color;
    let truth = picture(8);
    let rmse = [1, 2, 4].map(|samples| {
        let sum: f64 = picture(samples).iter().zip(&truth).map(|(a, b)| (*a - *b).length_squared()).sum();
        (sum / truth.len() as f64).sqrt()
    });
    println!("RMSE against 8 × 8 samples, with 1, 2 and 4 along each axis: {rmse:.5?}");
    assert!(rmse[0] > 1.5 * rmse[1] && rmse[1] > 1.5 * rmse[2] && rmse[2] > 0.0);
    assert!(rmse[0] < 0.1);
}

/// A fold too flat for a crease runs through the pixels of one column, within a thousandth of a pixel of their centres.
/// One side of it is lit, the other back-facing. A GPU that rounds may find any shadow state in that column, and lines
/// next to it.
#[test]
fn a_fold_through_pixels_leaves_their_shadows_open_and_no_others() {
    let corners = [(-1.0, -0.2), (-1.0, -0.2), (0.0, 0.0), (0.0, 0.0), (1.0, -0.2), (1.0, -0.2)];
    let positions =
        (0..6).map(|i| Vec3::new(corners[i].0, if i % 2 == 0 { -1.0 } else { 1.0 }, corners[i].1)).collect();
    let faces = vec![[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5]];
    let normals = [Vec3::new(-0.2, 0.0, 1.0), Vec3::new(0.2, 0.0, 1.0)].map(Vec3::normalize);
    let mut model = Model { positions, faces, ..embedded::ground(1.0) };
    // A hard fold: each side has its own vertices.
    model.positions.extend_from_within(2..4);
    model.faces[2] = [6, 4, 7];
    model.faces[3] = [7, 4, 5];
    model.normals = [0, 0, 0, 0, 1, 1, 1, 1].map(|side: usize| normals[side]).to_vec();
    (model.uvs, model.colors) = (Vec::new(), Vec::new());
    model.face_material = vec![0; 4];
    model.face_mesh = vec![0; 4];
    model.face_polygon = Vec::new();
    let scene = Scene::new(model);
    let camera = camera(DVec3::Z * 5.0, Projection::Orthographic { height: 2.0, far: 20.0 });
    let mut style = named("shadow-lines");
    style.lights[0].light = npr_toon::source::Light::directional(Vec3::X);
    // Shadow lines are wider than those of objects, so that they can be distinguished.
    let ink = style.lines.image.as_mut().expect("a style with lines in the image");
    let dilation = Some(Disc { radius_px: 3.0, antialias: false });
    ink.shadows = ShadowLines::Separate { composite: Composite::Over { color: Vec3::X, opacity: 1.0 }, dilation };
    // With 33 columns, the fold at x = 0 is in the middle of the 17th.
    let size = (33, 33);
    let plan = Plan::new(&scene, &style, &View::new(camera, size), &Capabilities::RAY_CASTER).expect("a good style");
    let hits = PrimaryHits::new(&scene, View::new(camera, size));
    let mut reference = Reference::new(Shot { hits: &hits, style: &style, plan: &plan }).expect("pictures");
    reference.look_closer().expect("pictures");
    let columns: Vec<u32> = (0..33).filter(|&x| reference.exempt[(16 * 33 + x) as usize]).collect();
    assert!(columns.contains(&16), "the fold: {columns:?}");
    assert!(columns.contains(&17), "a line of the object: {columns:?}");
    assert!(columns.contains(&19), "a line that a cast shadow in the fold's column would have beside it: {columns:?}");
    assert!(columns.iter().all(|x| (12..=20).contains(x)), "{columns:?}");
}

#[test]
fn faces_without_material_have_the_default_one() {
    let with = Model { materials: vec![npr_mesh::Material::default()], ..embedded::cube() };
    let without = Model { face_material: Vec::new(), materials: Vec::new(), ..with.clone() };
    let camera = camera(DVec3::new(3.0, 4.0, 5.0), PERSPECTIVE);
    let [with, without] =
        [with, without].map(|model| frame(&Scene::new(model), &named("cartoon"), &camera, (32, 24), 1).image());
    assert_eq!(with, without);
}

/// If threads cannot be started, as on wasm32-unknown-unknown, the calling thread renders.
#[test]
fn one_thread_is_the_callers() {
    let (scene, style, size) = (Scene::new(embedded::scene()), named("ink-image"), (40, 30));
    let camera = still_life_camera();
    let plan = Plan::new(&scene, &style, &View::new(camera, size), &Capabilities::RAY_CASTER).expect("it can be drawn");
    let rendered = |threads: usize| {
        let seen = Mutex::new(HashSet::new());
        let tell = |_| {
            seen.lock().expect("no thread panics").insert(thread::current().id());
        };
        let options = CpuOptions { threads, ..Default::default() };
        let image = render(&scene, &plan, &options, &tell).image();
        (image, seen.into_inner().expect("no thread panics"))
    };
    let (alone, threads) = rendered(1);
    assert_eq!(threads, HashSet::from([thread::current().id()]));
    let (shared, threads) = rendered(3);
    assert!(!threads.contains(&thread::current().id()));
    assert_eq!(alone, shared);
}

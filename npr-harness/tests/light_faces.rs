//! Light that is constant over faces and over pieces of faces: each has the one tone that geometry demands, on both
//! executors.
#![allow(clippy::print_stdout)]

mod common;

use common::{device, planned, rendered};
use glam::{DAffine3, DMat3, DVec2, DVec3, Vec3};
use npr_harness::camera::{Camera, Framing};
use npr_harness::capabilities::{Capabilities, ExecutorKind};
use npr_harness::cpu::{self, CpuOptions};
use npr_harness::error::HarnessError;
use npr_harness::lights::{LightFrame, StyleLight};
use npr_harness::picture::Image;
use npr_harness::plan::Plan;
use npr_harness::rays::Hit;
use npr_harness::scene::Scene;
use npr_harness::shade::Shade;
use npr_harness::shade::ramp::{RampShade, RampSource};
use npr_harness::style::{Style, style};
use npr_harness::view::View;
use npr_mesh::{AlphaMode, Material, Model, Object, embedded};
use npr_toon::normal::{MAX_DIVISIONS, NormalUse};
use npr_toon::ramp::{Ramp, RampBlend, RampStop};
use npr_toon::source::Light;
use npr_toon::{Bands, Highlight};
use std::collections::{HashMap, HashSet};

const SIZE: (u32, u32) = (160, 100);
const LAMP: Vec3 = Vec3::new(-2.0, 3.0, 4.0);

/// White surfaces whose grey is N·L of a lamp in world space, from -1 to 1.
fn gray(normals: NormalUse) -> Style {
    let stops = [(-1.0, 0.0), (1.0, 1.0)].map(|(at, gray)| RampStop { at, color: Vec3::splat(gray) }).to_vec();
    let ramp = RampSource::Stops(Ramp { stops, blend: RampBlend::Smooth });
    let lights = vec![StyleLight { light: Light::positional(LAMP), frame: LightFrame::World }];
    let shade = Shade::Ramp(RampShade { ramp, half_lambert: None });
    Style { shade, normals, lights, ..style("toon").expect("a style of this crate") }
}

fn white(mut model: Model) -> Model {
    for material in &mut model.materials {
        material.base_color = glam::Vec4::ONE;
    }
    model
}

/// A sphere of triangles, a cylinder of quads with smooth normals that is scaled unevenly, and its mirror image.
fn scene() -> Scene {
    let place = |mesh, scale: DVec3, x: f64| {
        let turn = DMat3::from_rotation_z(0.4);
        let world_from_mesh =
            DAffine3 { matrix3: turn * DMat3::from_diagonal(scale), translation: DVec3::new(x, 0.0, 0.0) };
        Object { name: String::new(), mesh, world_from_mesh }
    };
    let models = vec![white(embedded::sphere(8)), white(embedded::cylinder(7))];
    let objects = vec![
        place(0, DVec3::ONE, 0.0),
        place(1, DVec3::new(0.9, 1.1, 0.6), 2.4),
        place(1, DVec3::new(-0.9, 1.1, 0.6), -2.4),
    ];
    Scene::with_objects(models, objects).expect("a scene")
}

fn camera(scene: &Scene) -> Camera {
    let framing = Framing { yaw_rad: 0.35, pitch_rad: 0.3, ..Framing::default() };
    Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing)
}

/// The pictures of both executors, or of the CPU alone where there is no device.
fn pictures(scene: &Scene, style: &Style, camera: &Camera) -> Vec<Image> {
    let plan = planned(scene, style, camera, SIZE);
    let on_cpu = cpu::render(scene, &plan, &CpuOptions::default(), &|_| {}).image();
    let on_device = device().map(|executor| rendered(&executor, scene, style, camera, SIZE));
    [Some(on_cpu), on_device].into_iter().flatten().collect()
}

/// The hit at the centre of each pixel whose neighbours show the same face, so that rounding does not decide what it
/// shows.
fn inner_hits(scene: &Scene, camera: &Camera) -> Vec<(u32, u32, Hit)> {
    let size_px = DVec2::new(SIZE.0.into(), SIZE.1.into());
    let hit = |x: u32, y: u32, dx: f64, dy: f64| {
        let point = DVec2::new(f64::from(x) + 0.5 + dx, f64::from(y) + 0.5 + dy);
        let (origin, direction) = camera.ray(point, size_px);
        scene.closest(origin, direction, (0.0, f64::INFINITY), |_| true)
    };
    let mut hits = Vec::new();
    for y in 0..SIZE.1 {
        for x in 0..SIZE.0 {
            let Some(found) = hit(x, y, 0.0, 0.0) else { continue };
            let is_same =
                |(dx, dy)| hit(x, y, dx, dy).is_some_and(|h| (h.object, h.face) == (found.object, found.face));
            if [(-0.2, 0.0), (0.2, 0.0), (0.0, -0.2), (0.0, 0.2)].into_iter().all(is_same) {
                hits.push((x, y, found));
            }
        }
    }
    hits
}

/// The polygon of a hit and the corners of its faces in world space.
fn polygon(scene: &Scene, hit: &Hit) -> (u32, Vec<[DVec3; 3]>) {
    let object = &scene.objects()[hit.object as usize];
    let model = scene.mesh_of(object).model();
    let corners = |face: usize| model.faces[face].map(|v| object.point(model.positions[v as usize]));
    let Some(&polygon) = model.face_polygon.get(hit.face as usize) else {
        return (hit.face, vec![corners(hit.face as usize)]);
    };
    let of_polygon = (0..model.faces.len()).filter(|&face| model.face_polygon[face] == polygon);
    (polygon, of_polygon.map(corners).collect())
}

fn unit_to_lamp(at: DVec3) -> DVec3 {
    (LAMP.as_dvec3() - at).normalize()
}

/// The grey of N·L, of 255.
fn expected(n_dot_l: f64) -> f64 {
    (n_dot_l + 1.0) / 2.0 * 255.0
}

#[test]
fn each_face_has_the_one_tone_of_its_plane() {
    let scene = scene();
    let camera = camera(&scene);
    let hits = inner_hits(&scene, &camera);
    assert!(hits.len() > 3000, "{}", hits.len());
    for image in pictures(&scene, &gray(NormalUse::PerFace), &camera) {
        let mut tones: HashMap<(u32, u32), HashSet<[u8; 4]>> = HashMap::new();
        for (x, y, hit) in &hits {
            let (number, faces) = polygon(&scene, hit);
            // All polygons here are flat, so the triangle's plane is the polygon's. Seen from the eye's side.
            let [a, b, c] = faces[0];
            let normal = (b - a).cross(c - a).normalize();
            let to_eye = camera.eye - a;
            let normal = if normal.dot(to_eye) < 0.0 { -normal } else { normal };
            let areas = faces.iter().map(|[a, b, c]| (*b - *a).cross(*c - *a).length());
            let area: f64 = areas.clone().sum();
            let centroid =
                faces.iter().zip(areas).map(|([a, b, c], area)| (*a + *b + *c) / 3.0 * area).sum::<DVec3>() / area;
            let expected = expected(normal.dot(unit_to_lamp(centroid)));
            let tone = image.pixel(*x, *y);
            assert!((f64::from(tone[0]) - expected).abs() < 0.6, "{x} {y}: {tone:?}, not {expected}");
            tones.entry((hit.object, number)).or_default().insert(tone);
        }
        assert!(tones.len() > 20, "{}", tones.len());
        for (face, tones) in tones {
            assert_eq!(tones.len(), 1, "{face:?}: {tones:?}");
        }
    }
}

#[test]
fn bands_of_a_face_have_one_tone_and_no_border_within() {
    let scene = scene();
    let camera = camera(&scene);
    let hits = inner_hits(&scene, &camera);
    let highlight = Highlight { threshold: 0.9, color: Vec3::ONE, strength: 1.0, lit_only: false };
    let bands = Bands {
        thresholds: vec![0.2, 0.7],
        tones: vec![Vec3::splat(0.2), Vec3::splat(0.4), Vec3::splat(0.6)],
        highlight: Some(highlight),
        antialias: true,
        absolute: false,
    };
    let banded = |normals| Style { shade: Shade::Toon(bands.clone()), ..gray(normals) };
    let of_bands: HashSet<u8> = [51, 102, 153, 255].into();
    for normals in [NormalUse::PerFace, NormalUse::PerSubdividedFace(1), NormalUse::PerSubdividedFace(5)] {
        for image in pictures(&scene, &banded(normals), &camera) {
            for (x, y, hit) in &hits {
                let tone = image.pixel(*x, *y)[0];
                assert!(of_bands.contains(&tone), "{normals:?}, {x} {y}, face {}: {tone}", hit.face);
            }
        }
    }
    // With light at pixels there are borders, which have tones in between.
    let image = pictures(&scene, &banded(NormalUse::PerPixel), &camera).remove(0);
    assert!(hits.iter().any(|(x, y, _)| !of_bands.contains(&image.pixel(*x, *y)[0])));
}

#[test]
fn one_division_is_the_interpolated_normal_at_the_centroid() {
    let scene = scene();
    let camera = camera(&scene);
    let hits = inner_hits(&scene, &camera);
    for image in pictures(&scene, &gray(NormalUse::PerSubdividedFace(1)), &camera) {
        for (x, y, hit) in &hits {
            let object = &scene.objects()[hit.object as usize];
            let model = scene.mesh_of(object).model();
            let corners = model.faces[hit.face as usize].map(|v| v as usize);
            let normal: DVec3 = corners.iter().map(|&v| object.normal(model.normals[v])).sum();
            let centroid = corners.iter().map(|&v| object.point(model.positions[v])).sum::<DVec3>() / 3.0;
            let expected = expected(normal.normalize().dot(unit_to_lamp(centroid)));
            let tone = image.pixel(*x, *y);
            assert!((f64::from(tone[0]) - expected).abs() < 0.6, "{x} {y}: {tone:?}, not {expected}");
        }
    }
}

#[test]
fn pictures_of_pieces_approach_that_of_pixels() {
    let scene = scene();
    let camera = camera(&scene);
    let per_pixel = pictures(&scene, &gray(NormalUse::PerPixel), &camera);
    let divisions = [1, 2, 4, 8, 16, MAX_DIVISIONS];
    let mut errors = vec![Vec::new(); per_pixel.len()];
    for divisions in divisions {
        let pieces = pictures(&scene, &gray(NormalUse::PerSubdividedFace(divisions)), &camera);
        for ((truth, image), errors) in per_pixel.iter().zip(&pieces).zip(&mut errors) {
            let squares = truth.rgba8.iter().zip(&image.rgba8).map(|(&a, &b)| (f64::from(a) - f64::from(b)).powi(2));
            errors.push((squares.sum::<f64>() / truth.rgba8.len() as f64).sqrt());
        }
    }
    println!("RMSE of {divisions:?} divisions: {errors:.3?}");
    for errors in errors {
        // N·L is nearly linear within a piece, so the error is halved with each doubling.
        assert!(errors.windows(2).all(|pair| pair[1] < 0.65 * pair[0]), "{errors:?}");
        assert!(errors[0] > 5.0 && errors[5] < 0.5, "{errors:?}");
    }
}

/// Opaque and blended surfaces, and those of a closed model seen from behind, have the same pieces.
#[test]
fn blended_faces_have_the_tones_of_opaque_ones() {
    let model = |alpha_mode| {
        let mut model = white(embedded::sphere(8));
        model.materials = vec![Material { alpha_mode, base_color: glam::Vec4::ONE, ..Material::default() }];
        Scene::new(model)
    };
    let (opaque, blended) = (model(AlphaMode::Opaque), model(AlphaMode::Blend));
    let camera = camera(&opaque);
    for normals in [NormalUse::PerFace, NormalUse::PerSubdividedFace(3)] {
        let pairs =
            pictures(&opaque, &gray(normals), &camera).into_iter().zip(pictures(&blended, &gray(normals), &camera));
        for (opaque, blended) in pairs {
            let most = opaque.rgba8.iter().zip(&blended.rgba8).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(most <= Some(1), "{normals:?}: {most:?}");
        }
    }
}

/// Faces are read from a texture. An adapter whose textures are too small says so, and the CPU has no such limit.
#[test]
fn more_faces_than_fit_a_texture_are_refused() {
    let scene = Scene::new(embedded::sphere(64));
    let style = gray(NormalUse::PerSubdividedFace(4));
    let view = View::new(camera(&scene), (64, 64));
    let small =
        |texture_px| Capabilities { kind: ExecutorKind::HardwareAdapter, texture_px, ..Capabilities::RAY_CASTER };
    let faces = scene.face_count();
    let plan = Plan::new(&scene, &style, &view, &small(256)).expect("it fits");
    assert!(plan.to_string().contains("corners of faces in a texture"), "{plan}");
    assert!(6 * faces > 100 * 100 && 6 * faces < 256 * 256, "{faces}");
    let error = Plan::new(&scene, &style, &view, &small(100)).expect_err("it does not fit").to_string();
    assert!(error.contains("the faces' corners"), "{error}");
    Plan::new(&scene, &style, &view, &Capabilities { texture_px: 100, ..Capabilities::RAY_CASTER })
        .expect("the CPU can");
    // One pair of texels a face.
    let per_face = gray(NormalUse::PerFace);
    Plan::new(&scene, &per_face, &view, &small(100)).expect("it fits");
}

#[test]
fn divisions_out_of_range_are_refused() {
    for divisions in [0, MAX_DIVISIONS + 1] {
        let error = gray(NormalUse::PerSubdividedFace(divisions)).validate().expect_err("an error");
        assert!(matches!(error, HarnessError::Toon(_)), "{error}");
        assert!(error.to_string().contains(&format!("{divisions} divisions")), "{error}");
    }
}

//! What is in the picture: which way is up, where the camera looks, what is left out, and the ground.

mod common;

use common::{Folder, device, rendered, shared_models};
use glam::{DAffine3, DVec2, DVec3, Vec3};
use npr_harness::camera::{Camera, Framing};
use npr_harness::capabilities::Capabilities;
use npr_harness::executor::Executor;
use npr_harness::hatch::{HatchEncoding, HatchMapping};
use npr_harness::image_lines::InkScale;
use npr_harness::lights::{LightFrame, StyleLight};
use npr_harness::outliers::{self, Outliers};
use npr_harness::picture::Image;
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::shade::Shade;
use npr_harness::shadow::ShadowMethod;
use npr_harness::style::{Style, style, styles};
use npr_harness::view::View;
use npr_mesh::{Material, Model, Object, UpAxis};
use npr_toon::normal::NormalUse;
use npr_toon::source::Light;
use std::path::Path;

const SIZE: (u32, u32) = (120, 90);
const SIZE_PX: DVec2 = DVec2::new(SIZE.0 as f64, SIZE.1 as f64);
const ASPECT: f64 = SIZE.0 as f64 / SIZE.1 as f64;

/// The CPU, and the device if there is one.
fn executors() -> Vec<Executor> {
    [Some(Executor::Cpu { why: None }), device()].into_iter().flatten().collect()
}

fn named(name: &str) -> Style {
    style(name).expect("it is built in")
}

/// A polygon per list of corners, with flat normals and a material each.
fn polygons(of: &[(&[[f32; 3]], [f32; 3])]) -> Model {
    let mut model = Model::default();
    for (number, (corners, color)) in (0u32..).zip(of) {
        let first = model.positions.len() as u32;
        let corners: Vec<Vec3> = corners.iter().copied().map(Vec3::from).collect();
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
        model.normals.extend(corners.iter().map(|_| normal));
        model.uvs.extend(corners.iter().map(|corner| corner.truncate()));
        for corner in 1..corners.len() as u32 - 1 {
            model.faces.push([first, first + corner, first + corner + 1]);
            model.face_material.push(number);
            model.face_polygon.push(number);
        }
        model.positions.extend(corners);
        let base_color = Vec3::from(*color).extend(1.0);
        model.materials.push(Material { base_color, double_sided: true, ..Material::default() });
    }
    model
}

/// A box of one colour.
fn cuboid(low: [f32; 3], high: [f32; 3]) -> Model {
    let ([a, b, c], [d, e, f]) = (low, high);
    let gray = [0.6; 3];
    polygons(&[
        (&[[a, b, c], [a, b, f], [a, e, f], [a, e, c]], gray),
        (&[[d, b, c], [d, e, c], [d, e, f], [d, b, f]], gray),
        (&[[a, b, c], [d, b, c], [d, b, f], [a, b, f]], gray),
        (&[[a, e, c], [a, e, f], [d, e, f], [d, e, c]], gray),
        (&[[a, b, c], [a, e, c], [d, e, c], [d, b, c]], gray),
        (&[[a, b, f], [d, b, f], [d, e, f], [a, e, f]], gray),
    ])
}

fn joined(models: impl IntoIterator<Item = Model>) -> Model {
    let mut all = Model::default();
    models.into_iter().for_each(|model| all.append(&model));
    all
}

fn framed(scene: &Scene, framing: &Framing) -> Camera {
    Camera::framed(scene.framed_corners(), ASPECT, framing)
}

fn pixel(image: &Image, at_px: DVec2) -> [u8; 3] {
    let at = at_px.floor().as_uvec2();
    assert!(at.x < image.width && at.y < image.height, "{at_px} is not in the picture");
    let start = 4 * (at.y * image.width + at.x) as usize;
    [0, 1, 2].map(|channel| image.rgba8[start + channel])
}

/// Where a point of the scene is in the picture, px.
fn on_screen(camera: &Camera, point: DVec3) -> DVec2 {
    let clip = camera.clip_from_world(ASPECT) * point.extend(1.0);
    (DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * SIZE_PX
}

/// The number of pixels of which a channel differs by more than `by`.
fn differing(a: &Image, b: &Image, by: u8) -> usize {
    let pixels = a.rgba8.chunks(4).zip(b.rgba8.chunks(4));
    pixels.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > by)).count()
}

/// At most a thousandth of the pixels differ visibly.
fn assert_alike(a: &Image, b: &Image, what: &str) {
    let (found, all) = (differing(a, b, 16), a.rgba8.len() / 4);
    assert!(found * 1000 <= all, "{what}: {found} of {all} pixels differ");
}

fn bytes(color: Vec3) -> [u8; 3] {
    (color * 255.0).round().to_array().map(|channel| channel as u8)
}

// Which way is up

/// A house with a chimney, written with an axis up: a wall to the front, a ridge along X.
fn house(up: UpAxis) -> String {
    let points = [
        [-2.0, 0.0, 1.0],
        [2.0, 0.0, 1.0],
        [2.0, 0.0, -1.0],
        [-2.0, 0.0, -1.0],
        [-2.0, 1.5, 1.0],
        [2.0, 1.5, 1.0],
        [2.0, 1.5, -1.0],
        [-2.0, 1.5, -1.0],
        [-2.0, 2.3, 0.0],
        [2.0, 2.3, 0.0],
        [1.0, 2.0, 0.9],
        [1.4, 2.0, 0.9],
        [1.4, 3.0, 0.9],
        [1.0, 3.0, 0.7],
    ];
    let mut text = String::new();
    for point in points {
        let DVec3 { x, y, z } = up.turned_back(DVec3::from(point));
        text.push_str(&format!("v {x} {y} {z}\nvt {} {}\n", point[0] * 0.3, point[1] * 0.3));
    }
    for face in ["1 2 6 5", "3 4 8 7", "2 3 7 10 6", "4 1 5 9 8", "5 6 10 9", "7 8 9 10", "4 3 2 1", "11 12 13 14"] {
        let corners: Vec<_> = face.split(' ').map(|corner| format!("{corner}/{corner}")).collect();
        text.push_str(&format!("f {}\n", corners.join(" ")));
    }
    text
}

fn loaded_with_up(folder: &Path, up: UpAxis) -> Scene {
    let path = folder.join("house.obj");
    std::fs::write(&path, house(up)).expect("written");
    let mut loaded = npr_mesh::load(&path, &Default::default()).expect("it loads");
    up.turn(&mut loaded.meshes, loaded.objects.iter_mut().map(|object| &mut object.world_from_mesh));
    Scene::from(loaded)
}

#[test]
fn every_axis_up_gives_the_picture_of_the_file_with_y_up_in_all_styles() {
    let folder = Folder::new();
    let ups = [UpAxis::Z, UpAxis::X, UpAxis::NegativeX, UpAxis::NegativeY, UpAxis::NegativeZ];
    let standing = loaded_with_up(&folder.0, UpAxis::Y);
    let camera = framed(&standing, &Framing::default());
    for executor in executors() {
        for mut style in styles() {
            // A light of the world comes from above whatever the file calls up.
            style.lights[0].frame = LightFrame::World;
            let expected = rendered(&executor, &standing, &style, &camera, SIZE);
            for up in ups {
                // One axis suffices for most styles.
                if up != UpAxis::Z && style.name != "toon-shadow" {
                    continue;
                }
                let turned = loaded_with_up(&folder.0, up);
                assert_eq!(framed(&turned, &Framing::default()), camera);
                let found = rendered(&executor, &turned, &style, &camera, SIZE);
                assert_eq!(differing(&found, &expected, 0), 0, "{} {up:?} {}", style.name, executor.describe());
            }
        }
    }
}

#[test]
fn a_house_with_z_up_stands_only_if_it_is_turned() {
    let folder = Folder::new();
    let turned = loaded_with_up(&folder.0, UpAxis::Z);
    let (low, high) = turned.bounds().expect("it has faces");
    assert_eq!((low.y, high.y), (0.0, 3.0));
    // The wall at −Y of the file, which is at Z 1 of a file with Y up, looks at a viewer at yaw 0.
    let camera = framed(&turned, &Framing { yaw_rad: 0.0, pitch_rad: 0.0, ..Framing::default() });
    let (origin, direction) = camera.ray(on_screen(&camera, DVec3::new(-1.0, 0.7, 1.0)), SIZE_PX);
    let hit = turned.closest(origin, direction, (0.0, f64::INFINITY), |_| true).expect("a wall");
    assert!(hit.front && (origin.z + direction.z * hit.t - 1.0).abs() < 1e-9);
}

#[test]
fn transforms_of_objects_are_turned_with_their_meshes() {
    // A box, placed beside its origin and above the ground by a file with Z up.
    let mut meshes = [cuboid([0.0; 3], [1.0, 2.0, 3.0])];
    let mut transforms = [DAffine3::from_translation(DVec3::new(500_000.25, 5_400_000.5, 40.0))];
    UpAxis::Z.turn(&mut meshes, &mut transforms);
    let object = |world_from_mesh| Object { name: String::new(), mesh: 0, world_from_mesh };
    let scene = Scene::with_objects(meshes.to_vec(), transforms.map(object).to_vec()).expect("a scene");
    let (low, high) = scene.bounds().expect("it has faces");
    assert_eq!(scene.place_in_file(low.as_dvec3()), DVec3::new(500_000.25, 40.0, -5_400_002.5));
    assert_eq!(scene.place_in_file(high.as_dvec3()), DVec3::new(500_001.25, 43.0, -5_400_000.5));
}

// Roll and target

#[test]
fn a_roll_of_half_a_turn_turns_the_picture_over() {
    let scene = Scene::new(cuboid([0.0; 3], [3.0, 1.0, 2.0]));
    for executor in executors() {
        for fov_y_rad in [Some(0.6), None] {
            let [upright, over] = [0.0, std::f64::consts::PI].map(|roll_rad| {
                let camera = framed(&scene, &Framing { roll_rad, fov_y_rad, ..Framing::default() });
                rendered(&executor, &scene, &named("lines"), &camera, SIZE)
            });
            let turned: Vec<u8> = upright.rgba8.chunks(4).rev().flatten().copied().collect();
            let turned = Image::new(SIZE.0, SIZE.1, turned).expect("a picture");
            assert_alike(&turned, &over, &executor.describe());
        }
    }
}

#[test]
fn a_roll_turns_the_camera_clockwise_and_everything_still_fits() {
    // A pole.
    let scene = Scene::new(cuboid([-0.1, 0.0, -0.1], [0.1, 4.0, 0.1]));
    for fov_y_rad in [Some(0.6), None] {
        let at = |roll_deg: f64| {
            let roll_rad = roll_deg.to_radians();
            let framing = Framing { roll_rad, pitch_rad: 0.0, yaw_rad: 0.0, fov_y_rad, ..Framing::default() };
            let camera = framed(&scene, &framing);
            [0.0, 4.0].map(|y| on_screen(&camera, DVec3::new(0.0, y, 0.0)))
        };
        let [foot, top] = at(0.0);
        assert!((foot.x - top.x).abs() < 1e-9 && foot.y > top.y + 60.0);
        // The pole leans to the left, and lies at a quarter turn.
        let [foot, top] = at(30.0);
        assert!(top.x < foot.x - 20.0 && top.y < foot.y - 20.0, "{foot} {top}");
        let [foot, top] = at(90.0);
        assert!((foot.y - top.y).abs() < 1e-9 && top.x < foot.x - 90.0 && top.x > 0.0 && foot.x < SIZE_PX.x);
    }
}

/// A flat field of gray squares with a red one, 0.5 wide; the middle of the red one is at `at`.
fn field(at: DVec3) -> Scene {
    let square = |x: f32, z: f32, half: f32, y: f32| {
        [[x - half, y, z + half], [x + half, y, z + half], [x + half, y, z - half], [x - half, y, z - half]]
    };
    let (gray, red) = (square(0.0, 0.0, 4.0, -0.01), square(2.5, 1.5, 0.25, 0.0));
    let model = polygons(&[(&gray, [0.5; 3]), (&red, [1.0, 0.0, 0.0])]);
    let world_from_mesh = DAffine3::from_translation(at - DVec3::new(2.5, 0.0, 1.5));
    Scene::with_objects(vec![model], vec![Object { name: String::new(), mesh: 0, world_from_mesh }]).expect("a scene")
}

#[test]
fn the_target_is_in_the_middle_and_everything_fits() {
    for at in [DVec3::new(2.5, 0.0, 1.5), DVec3::new(500_000.25, 120.5, -5_400_000.75)] {
        let scene = field(at);
        for executor in executors() {
            for (fov_y_rad, roll_rad) in [(Some(0.6), 0.0), (None, 0.0), (Some(0.6), 0.5), (None, 2.0)] {
                let framing = Framing { pitch_rad: 0.8, fov_y_rad, roll_rad, ..Framing::default() };
                let camera = framed(&scene, &Framing { target: Some(scene.place_here(at)), ..framing });
                let image = rendered(&executor, &scene, &named("lambert"), &camera, SIZE);
                let [r, g, b] = pixel(&image, SIZE_PX / 2.0);
                assert!(r > 60 && g < 10 && b < 10, "{at} {fov_y_rad:?}: {r} {g} {b}");
                // No surface at the border, but one near it.
                let paper = bytes(named("lambert").paper);
                let is_paper = |x: u32, y: u32| pixel(&image, DVec2::new(x.into(), y.into())) == paper;
                let (w, h) = SIZE;
                let border = |inset: u32| {
                    (0..w)
                        .flat_map(move |x| [(x, inset), (x, h - 1 - inset)])
                        .chain((0..h).flat_map(move |y| [(inset, y), (w - 1 - inset, y)]))
                };
                assert!(border(0).all(|(x, y)| is_paper(x, y)), "{at} {fov_y_rad:?} {roll_rad}");
                assert!(border(8).any(|(x, y)| !is_paper(x, y)), "{at} {fov_y_rad:?} {roll_rad}");
            }
        }
    }
}

#[test]
fn a_target_away_from_the_model_is_still_in_the_middle() {
    let scene = Scene::new(cuboid([0.0; 3], [1.0; 3]));
    for target in [DVec3::new(0.0, 0.0, 20.0), DVec3::new(0.0, 3.0, -20.0), DVec3::splat(-5.0)] {
        for fov_y_rad in [Some(0.6), None] {
            let camera = framed(&scene, &Framing { target: Some(target), fov_y_rad, ..Framing::default() });
            assert!(on_screen(&camera, target).distance(SIZE_PX / 2.0) < 1e-6);
            let image = rendered(&Executor::Cpu { why: None }, &scene, &named("lambert"), &camera, SIZE);
            for corner in scene.corners() {
                let at = on_screen(&camera, corner.as_dvec3());
                assert!(at.cmpgt(DVec2::ZERO).all() && at.cmplt(SIZE_PX).all(), "{corner} at {at}");
            }
            let middle = on_screen(&camera, DVec3::splat(0.5));
            assert_ne!(
                pixel(&image, middle),
                bytes(named("lambert").paper),
                "{target} {fov_y_rad:?}: it is not clipped"
            );
        }
    }
}

#[test]
fn points_and_lines_can_be_targets_and_be_rolled() {
    for model in [
        polygons(&[(&[[1.0; 3], [1.0; 3], [1.0; 3]], [0.5; 3])]),
        polygons(&[(&[[0.0; 3], [1.0; 3], [2.0; 3]], [0.5; 3])]),
    ] {
        let mut scene = Scene::new(model);
        scene.ground = true;
        for (target, fov_y_rad) in [(None, None), (Some(DVec3::ONE), Some(0.6)), (Some(DVec3::ZERO), None)] {
            let camera = framed(&scene, &Framing { roll_rad: 1.0, target, fov_y_rad, ..Framing::default() });
            assert!(camera.eye.is_finite() && camera.near > 0.0 && camera.eye != camera.target, "{camera:?}");
            for executor in executors() {
                rendered(&executor, &scene, &named("toon-shadow"), &camera, (16, 16));
            }
        }
        assert_eq!(outliers::find(&scene), None);
    }
}

// Outliers

fn stray(at: Vec3, size: f32) -> Model {
    let [x, y, z] = at.to_array();
    polygons(&[(&[[x, y, z], [x + size, y, z], [x, y + size, z]], [0.5; 3])])
}

#[test]
fn a_stray_triangle_is_found_named_and_left_out() {
    let alone = Scene::new(cuboid([-1.0; 3], [1.0; 3]));
    let expected = framed(&alone, &Framing::default());
    for (at, size) in [(Vec3::X * 1000.0, 0.01), (Vec3::new(-3.0, 30.0, 4.0), 0.5), (Vec3::NEG_Z * 1e5, 1.0)] {
        let mut scene = Scene::new(joined([cuboid([-1.0; 3], [1.0; 3]), stray(at, size)]));
        let found = outliers::find(&scene).expect("an outlier");
        let Outliers { parts, rest_share, .. } = &found;
        let [part] = &parts[..] else { panic!("{parts:?}") };
        let expected_at = (at + Vec3::new(size / 2.0, size / 2.0, 0.0)).as_dvec3();
        assert!(part.faces == 1 && scene.place_in_file(part.at).distance(expected_at) < 1e-6 * expected_at.length());
        let whole = scene.bounds().map(|(low, high)| (high - low).length()).expect("it has faces");
        assert!((rest_share - 12f64.sqrt() / f64::from(whole)).abs() < 1e-6, "{rest_share}");
        assert!(scene.framed_corners().count() == 27);
        scene.set_subject(Some(found.rest));
        assert_eq!(scene.framed_corners().count(), 24);
        let camera = framed(&scene, &Framing::default());
        // The scene may have an origin of its own.
        let scale = scene.scale;
        assert!((scene.place_in_file(camera.eye) - alone.place_in_file(expected.eye)).length() < 1e-6, "{at}");
        assert!((camera.near / scale - expected.near).abs() < 1e-6);
        for executor in executors() {
            for name in ["cartoon", "hatch", "x-toon", "two-lights", "toon-shadow"] {
                let image = rendered(&executor, &scene, &named(name), &camera, SIZE);
                let of_box = rendered(&executor, &alone, &named(name), &expected, SIZE);
                assert_alike(&image, &of_box, &format!("{name} {at}"));
            }
        }
    }
}

#[test]
fn the_sentence_says_how_many_faces_where_and_how_much() {
    let scene = Scene::new(joined([cuboid([-1.0; 3], [1.0; 3]), stray(Vec3::new(1000.0, 0.0, 0.0), 0.01)]));
    let found = outliers::find(&scene).expect("an outlier");
    assert_eq!(
        found.describe(&scene, UpAxis::Y),
        "1 face of 13, at 1000, 0.005, 0, far from the rest, takes 99.7 % of the extent"
    );
    // The file has Z up.
    let turned = found.describe(&scene, UpAxis::Z);
    assert!(turned.contains("at 1000, 0, 0.005,"), "{turned}");
    let many = (0..10).map(|i| cuboid([-1.0, 2.0 * i as f32, -1.0], [1.0, 2.0 * i as f32 + 1.0, 1.0]));
    let strays = [stray(Vec3::X * 500.0, 0.1), stray(Vec3::X * -2000.0, 0.1)];
    let scene = Scene::new(joined(many.chain(strays)));
    let said = outliers::find(&scene).expect("outliers").describe(&scene, UpAxis::Y);
    assert!(
        said.starts_with("2 faces of 122 in 2 parts, the farthest at -2000, 0.05, 0, far from the rest, take "),
        "{said}"
    );
}

#[test]
fn a_stray_object_is_named() {
    let meshes = vec![cuboid([-1.0; 3], [1.0; 3]), stray(Vec3::ZERO, 1.0)];
    let object =
        |name: &str, mesh, at| Object { name: name.into(), mesh, world_from_mesh: DAffine3::from_translation(at) };
    let mut objects = vec![object("leaf", 1, DVec3::new(0.0, 0.0, 900_000.0))];
    objects.extend((0..20).map(|i| object("box", 0, DVec3::new(3.0 * f64::from(i % 5), 0.0, 3.0 * f64::from(i / 5)))));
    let scene = Scene::with_objects(meshes, objects).expect("a scene");
    let found = outliers::find(&scene).expect("an outlier");
    assert_eq!((found.parts.len(), found.parts[0].object), (1, 0));
    assert!(found.describe(&scene, UpAxis::Y).contains("\"leaf\" at 0.5, 0.5, 900000, "));
}

#[test]
fn what_belongs_to_the_model_is_no_outlier() {
    let cube = || cuboid([-1.0; 3], [1.0; 3]);
    let moved = |x: f32| cuboid([x - 1.0, -1.0, -1.0], [x + 1.0, 1.0, 1.0]);
    let cases = [
        ("one box", cube()),
        ("two boxes far from each other", joined([cube(), moved(100.0)])),
        ("a large ground", joined([cube(), cuboid([-500.0, -1.1, -500.0], [500.0, -1.0, 500.0])])),
        ("an antenna", joined([cube(), cuboid([-0.01, 1.0, -0.01], [0.01, 60.0, 0.01])])),
        ("a near leaf", joined([cube(), stray(Vec3::X * 3.0, 0.1)])),
        ("a sun and a planet", joined([cube(), cuboid([60.0, 0.0, 0.0], [60.1, 0.1, 0.1])])),
        ("two leaves of a small model", joined([cube(), stray(Vec3::X * 50.0, 0.1), stray(Vec3::X * 60.0, 0.1)])),
        (
            "a wall far away",
            joined((0..20).map(|i| moved(2.0 * i as f32)).chain([stray(Vec3::new(0.0, 0.0, 900.0), 100.0)])),
        ),
        ("a row", joined((0..40).map(|i| moved(10.0 * i as f32)))),
        ("a triangle", stray(Vec3::ZERO, 1.0)),
        ("a flat field", joined((0..100).map(|i| stray(Vec3::new((i % 10) as f32, 0.0, (i / 10) as f32), 0.9)))),
        ("nothing", Model::default()),
        ("built-in scene", npr_mesh::embedded::scene()),
    ];
    for (name, model) in cases {
        assert_eq!(outliers::find(&Scene::new(model)), None, "{name}");
    }
}

#[test]
fn no_shared_model_has_outliers() {
    let Some(folder) = shared_models() else { return };
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let extension = path.extension().and_then(|extension| extension.to_str());
        if matches!(extension, Some("obj" | "glb")) {
            let scene = Scene::from(npr_mesh::load(&path, &Default::default()).expect("it loads"));
            assert_eq!(outliers::find(&scene), None, "{}", path.display());
        }
    }
}

// The ground

/// A plate of 2 × 2 at a height of 2, held by nothing, and a small foot on the ground beside it.
fn plate() -> Model {
    let plate = [[-1.0, 2.0, 1.0], [1.0, 2.0, 1.0], [1.0, 2.0, -1.0], [-1.0, 2.0, -1.0]];
    joined([polygons(&[(&plate, [0.6; 3])]), cuboid([1.5, 0.0, -0.2], [1.9, 0.4, 0.2])])
}

/// The style with light from above and from the right, so that the plate's shadow is 1 to the left of it and 0.3 behind.
fn lit_from_above(name: &str) -> Style {
    let mut style = named(name);
    let light = Light { place: Light::directional(Vec3::new(0.5, 1.0, 0.15)).place, ..style.lights[0].light };
    style.lights[0] = StyleLight { light, frame: LightFrame::World };
    style
}

fn above() -> Framing {
    Framing { yaw_rad: 0.2, pitch_rad: 0.6, distance: 1.4, ..Framing::default() }
}

/// The middle of the plate's shadow, and a point beside it that no shadow falls on.
const IN_SHADOW: DVec3 = DVec3::new(-1.0, 0.0, 0.3);
const LIT: DVec3 = DVec3::new(-2.6, 0.0, 0.9);

/// Pictures without and with a ground.
fn pair(executor: &Executor, model: Model, style: &Style, framing: &Framing) -> (Camera, [Image; 2]) {
    let mut scene = Scene::new(model);
    let camera = framed(&scene, framing);
    let without = rendered(executor, &scene, style, &camera, SIZE);
    scene.ground = true;
    assert_eq!(framed(&scene, framing), camera, "a ground does not change the view");
    (camera, [without, rendered(executor, &scene, style, &camera, SIZE)])
}

#[test]
fn the_ground_is_paper_where_it_is_lit_and_dark_in_the_shadow_and_has_no_outline() {
    for executor in executors() {
        for fov_y_rad in [Some(0.6), None] {
            let style = lit_from_above("toon-shadow");
            let paper = bytes(style.paper);
            let (camera, [without, with]) = pair(&executor, plate(), &style, &Framing { fov_y_rad, ..above() });
            let Shade::Toon(bands) = &style.shade else { panic!("a toon shade") };
            assert_eq!(pixel(&with, on_screen(&camera, IN_SHADOW)), bytes(style.paper * bands.tones[0]));
            assert_eq!(pixel(&with, on_screen(&camera, LIT)), paper);
            assert_eq!(pixel(&without, on_screen(&camera, IN_SHADOW)), paper);
            // The border of the shadow is a line, on its left and its front.
            for border in [DVec3::new(-2.0, 0.0, 0.0), DVec3::new(-1.2, 0.0, 0.7)] {
                let at = on_screen(&camera, border);
                let darkest = (-1..=1).flat_map(|x| (-1..=1).map(move |y| DVec2::new(x.into(), y.into())));
                let darkest = darkest.map(|by| pixel(&with, at + by)[0]).min();
                assert!(darkest < Some(60), "{border}: {darkest:?}");
            }
            // Nothing changes but within the shadow of the plate and of the foot, and their lines.
            let (mut dark, mut outside) = (0, 0);
            for y in 0..SIZE.1 {
                for x in 0..SIZE.0 {
                    let at = DVec2::new(x.into(), y.into()) + 0.5;
                    if pixel(&with, at) == pixel(&without, at) {
                        continue;
                    }
                    let (origin, direction) = camera.ray(at, SIZE_PX);
                    let on_ground = origin - direction * (origin.y / direction.y);
                    let shadows = [(-2.0, 0.0, -1.3, 0.7), (1.3, 1.9, -0.26, 0.2)];
                    let around = 0.12;
                    let is_within = shadows.iter().any(|&(left, right, back, front)| {
                        (left - around..=right + around).contains(&on_ground.x)
                            && (back - around..=front + around).contains(&on_ground.z)
                    });
                    dark += 1;
                    outside += u32::from(!is_within);
                }
            }
            assert!(dark > 200 && outside == 0, "{dark} {outside} {}", executor.describe());
        }
    }
}

/// Each way to draw the ground: shades, lights, methods, sizes of ink, samples, uses of normals.
fn variants() -> Vec<(String, Style, u32)> {
    let shadows = |name: &str| {
        let mut style = lit_from_above(name);
        style.shadow = named("toon-shadow").shadow;
        style
    };
    let mut all: Vec<(String, Style, u32)> = Vec::new();
    for name in [
        "toon-shadow",
        "hatch-shadow",
        "printed-shadow",
        "cartoon",
        "lambert",
        "gooch",
        "wash",
        "x-toon",
        "two-lights",
        "hatch",
        "hatch-planes",
        "hatch-color",
        "printed-hatch",
        "vertex-light",
        "printed-bands",
        "printed-gooch",
        "ink-thick",
    ] {
        all.push((name.into(), shadows(name), 1));
    }
    let toon = || shadows("toon-shadow");
    all.push(("samples".into(), toon(), 2));
    let mut map = toon();
    map.shadow.as_mut().expect("shadows").method = ShadowMethod::Map { side: 1024 };
    all.push(("map".into(), map, 1));
    let mut double = toon();
    double.lines.image.as_mut().expect("ink").scale = InkScale::Double;
    all.push(("double".into(), double, 1));
    for normals in [NormalUse::PerFace, NormalUse::PerSubdividedFace(2), NormalUse::PerVertex, NormalUse::Interpolated]
    {
        for name in ["toon-shadow", "hatch-shadow"] {
            all.push((format!("{name} {normals:?}"), Style { normals, ..shadows(name) }, 1));
        }
    }
    for name in ["toon-shadow", "hatch-shadow", "two-lights"] {
        let mut lamp = shadows(name);
        lamp.lights[0] = StyleLight { light: Light::positional(Vec3::new(5.0, 12.0, 0.0)), frame: LightFrame::World };
        all.push((format!("{name} by a lamp"), lamp, 1));
    }
    let mut six_tones = shadows("printed-hatch");
    let Shade::Hatch(hatch) = &mut six_tones.shade else { panic!("hatched") };
    (hatch.mapping, hatch.encoding) = (HatchMapping::Planes, HatchEncoding::SixTones);
    all.push(("six tones at vertices, by planes".into(), six_tones, 1));
    let mut painter = shadows("two-lights");
    painter.lights.push(StyleLight { light: Light::directional(Vec3::X), frame: LightFrame::World });
    all.push(("pairs of lights".into(), painter, 1));
    all
}

#[test]
fn both_executors_draw_the_same_ground_in_every_way() {
    for (name, style, samples) in variants() {
        let mut scene = Scene::new(plate());
        let camera = framed(&scene, &above());
        let view = View { samples, ..View::new(camera, SIZE) };
        let mut pictures = Vec::new();
        for executor in executors() {
            let picture = |scene: &Scene| {
                let picture = npr_harness::executor::Picture::new(scene, &style, view);
                executor.render(&picture, &|_| {}).unwrap_or_else(|error| panic!("{name}: {error}"))
            };
            scene.ground = false;
            let without = picture(&scene);
            scene.ground = true;
            let with = picture(&scene);
            let at = on_screen(&camera, IN_SHADOW);
            let mean = |image: &Image| {
                let around = (-3..=3).flat_map(|x| (-3..=3).map(move |y| DVec2::new(x.into(), y.into())));
                around.map(|by| pixel(image, at + by).map(u32::from).iter().sum::<u32>()).sum::<u32>() / (49 * 3)
            };
            let (bright, dark) = (mean(&without), mean(&with));
            assert!(dark + 20 < bright, "{name} {}: {bright} {dark}", executor.describe());
            assert_eq!(pixel(&with, on_screen(&camera, LIT)), bytes(style.paper), "{name}");
            pictures.push(with);
        }
        if let [on_cpu, on_device] = &pictures[..] {
            // A map is as coarse as its texels.
            if name != "map" {
                assert_alike(on_cpu, on_device, &name);
            }
        }
    }
}

#[test]
fn a_ground_without_shadows_or_from_below_is_not_there() {
    let below = Framing { pitch_rad: -0.4, ..above() };
    let mut dark = lit_from_above("toon-shadow");
    dark.lights[0].light = Light::directional(Vec3::new(0.5, -1.0, 0.2));
    let cases = [
        (named("cartoon"), above()),
        (named("hatch"), above()),
        (named("ink-image"), above()),
        (lit_from_above("toon-shadow"), below),
        (dark, above()),
    ];
    for executor in executors() {
        for (style, framing) in &cases {
            let (_, [without, with]) = pair(&executor, plate(), style, framing);
            assert_eq!(differing(&without, &with, 0), 0, "{}", style.name);
        }
    }
}

#[test]
fn a_model_that_lies_on_the_ground_is_in_front_of_it() {
    // Flat, and a box that stands on it.
    let flat =
        polygons(&[(&[[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0]], [0.9, 0.1, 0.1])]);
    for executor in executors() {
        for name in ["toon-shadow", "hatch-shadow", "shadow-lines"] {
            for pitch_rad in [0.1, 0.6, 1.4] {
                let framing = Framing { pitch_rad, ..above() };
                let (_, [without, with]) = pair(&executor, flat.clone(), &lit_from_above(name), &framing);
                assert_alike(&without, &with, &format!("{name} {pitch_rad}"));
            }
        }
    }
}

#[test]
fn edge_lines_are_the_same_with_a_ground() {
    // Edges that lie in the ground are not dotted: only pixels of the shadow change.
    let mut style = lit_from_above("cartoon");
    style.shadow = named("toon-shadow").shadow;
    for executor in executors() {
        let model = cuboid([-1.0, 0.0, -1.0], [1.0, 1.0, 1.0]);
        let (_, [without, with]) = pair(&executor, model, &style, &above());
        let lost = without.rgba8.chunks(4).zip(with.rgba8.chunks(4)).filter(|(a, b)| b[0] > a[0] + 2).count();
        assert_eq!(lost, 0, "no pixel is brighter with a ground");
        assert!(differing(&without, &with, 16) > 50);
    }
}

/// What is below the ground, since it is not framed, is hidden by it; its lines are not.
#[test]
fn the_ground_hides_no_edge_lines() {
    let mut style = lit_from_above("cartoon");
    style.shadow = named("toon-shadow").shadow;
    let mut scene =
        Scene::new(joined([cuboid([-1.0, 0.0, -1.0], [1.0, 1.0, 1.0]), cuboid([-1.4, -0.8, -1.4], [1.4, -0.4, 1.4])]));
    scene.set_subject(Some((Vec3::new(-1.0, 0.0, -1.0), Vec3::ONE)));
    let camera = framed(&scene, &above());
    let mut pictures = Vec::new();
    for executor in executors() {
        scene.ground = false;
        let without = rendered(&executor, &scene, &style, &camera, SIZE);
        scene.ground = true;
        let with = rendered(&executor, &scene, &style, &camera, SIZE);
        // Between full ink and paper there are pixels that a line covers in part.
        let pixels = without.rgba8.chunks(4).zip(with.rgba8.chunks(4));
        let lost = pixels.filter(|(without, with)| without[0] < 45 && with[0] > 110).count();
        assert_eq!(lost, 0, "{}", executor.describe());
        // The lower box is covered by paper.
        assert!(differing(&without, &with, 16) > 30);
        pictures.push(with);
    }
    if let [on_cpu, on_device] = &pictures[..] {
        assert_alike(on_cpu, on_device, "what is below");
    }
}

#[test]
fn the_plan_says_why_there_is_a_ground_or_none() {
    let mut scene = Scene::new(plate());
    scene.ground = true;
    let camera = framed(&scene, &above());
    let mut dark = lit_from_above("toon-shadow");
    dark.lights[0].light = Light::directional(Vec3::NEG_Y);
    let plan = |scene: &Scene, style: &Style| {
        Plan::new(scene, style, &View::new(camera, SIZE), &Capabilities::RAY_CASTER).expect("a plan")
    };
    let is_ground = |reason: &&npr_harness::plan::Reason| reason.pass == "ground";
    let with = plan(&scene, &lit_from_above("toon-shadow"));
    assert!(with.ground().is_some() && with.passes.iter().any(|reason| is_ground(&reason)));
    for (style, why) in [(named("cartoon"), "no shadows"), (dark, "not above")] {
        let without = plan(&scene, &style);
        let reason = without.left_out.iter().find(is_ground).expect("a reason");
        assert!(without.ground().is_none() && reason.why.contains(why), "{}", reason.why);
    }
    scene.ground = false;
    let none = plan(&scene, &lit_from_above("toon-shadow"));
    assert!(!none.passes.iter().chain(&none.left_out).any(|reason| is_ground(&reason)));
}

#[test]
fn a_shadow_map_leaves_the_ground_lit_beyond_its_range() {
    let mut style = lit_from_above("toon-shadow");
    style.lights[0].light = Light::directional(Vec3::new(1.0, 0.25, 0.1));
    style.lines = npr_harness::style::Lines::NONE;
    style.shadow.as_mut().expect("shadows").method = ShadowMethod::Map { side: 2048 };
    let mut scene = Scene::new(plate());
    scene.ground = true;
    let camera = framed(&scene, &Framing { distance: 3.5, pitch_rad: 0.7, yaw_rad: -0.2, ..Framing::default() });
    let pictures: Vec<Image> =
        executors().iter().map(|executor| rendered(executor, &scene, &style, &camera, SIZE)).collect();
    if let [on_cpu, on_device] = &pictures[..] {
        // A map is as coarse as its texels, where light is grazing.
        let differ = differing(on_cpu, on_device, 16);
        assert!(differ < 40, "{differ} pixels differ");
        let paper = bytes(style.paper);
        assert!(on_cpu.rgba8.chunks(4).filter(|pixel| pixel[..3] != paper).count() > 150);
    }
}

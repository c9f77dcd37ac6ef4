//! Tests of the inverted hull: its width, what it hides and what hides it, objects, and both executors.
#![allow(clippy::print_stdout)]

mod common;

use common::{device, planned, rendered};
use glam::{DAffine3, DMat3, DVec3, Vec3};
use npr_harness::camera::{Camera, Framing, Projection};
use npr_harness::capabilities::Capabilities;
use npr_harness::check::{PLACES, Reference, Shot, agrees, magnitude};
use npr_harness::compare::compare;
use npr_harness::cpu::{CpuOptions, PrimaryHits, render};
use npr_harness::error::HarnessError;
use npr_harness::executor::{Executor, Picture};
use npr_harness::gallery::still_life_camera;
use npr_harness::hull_lines::HullLines;
use npr_harness::picture::Image;
use npr_harness::plan::Plan;
use npr_harness::scene::{ObjectLines, Scene};
use npr_harness::shade::Shade;
use npr_harness::style::{Lines, Style, style};
use npr_harness::view::View;
use npr_mesh::{AlphaMode, Material, Object, embedded};
use npr_outline::hull::HullNormals;
use npr_outline::line_style::LineStyle;

const SIZE: (u32, u32) = (320, 240);
const RED: Vec3 = Vec3::X;
const BOTH: [HullNormals; 2] = [HullNormals::Welded, HullNormals::Vertices];

fn hull(width_px: f32, ink: Vec3, normals: HullNormals) -> HullLines {
    HullLines { width_px, ink, normals }
}

/// Ink on white surfaces and white paper.
fn only_hull(width_px: f32, ink: Vec3) -> Style {
    let lines = Lines::hull(hull(width_px, ink, HullNormals::Welded));
    Style { paper: Vec3::ONE, shade: Shade::Paper, lines, ..style("lines").expect("a style of the crate") }
}

fn painted(width_px: f32, normals: HullNormals) -> Style {
    let lines = Lines::hull(hull(width_px, Vec3::ZERO, normals));
    Style { lines, ..style("cartoon").expect("a style of the crate") }
}

fn camera_at(eye: DVec3, target: DVec3) -> Camera {
    Camera { eye, target, up: DVec3::Y, projection: Projection::Perspective { fov_y_rad: 0.6 }, near: 0.1 }
}

fn framed(scene: &Scene, fov_y_rad: Option<f64>) -> Camera {
    let framing = Framing { yaw_rad: 0.4, pitch_rad: 0.3, fov_y_rad, ..Framing::default() };
    Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing)
}

fn picture(scene: &Scene, style: &Style, camera: &Camera) -> Image {
    render(scene, &planned(scene, style, camera, SIZE), &CpuOptions::default(), &|_| {}).image()
}

fn placed(mesh: usize, matrix3: DMat3, translation: DVec3) -> Object {
    Object { name: String::new(), mesh, world_from_mesh: DAffine3 { matrix3, translation } }
}

fn executors() -> Vec<Executor> {
    device().into_iter().chain([Executor::Cpu { why: None }]).collect()
}

fn differing(a: &Image, b: &Image) -> usize {
    let far = |(a, b): (&[u8], &[u8])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
    a.rgba8.chunks(4).zip(b.rgba8.chunks(4)).filter(|pair| far(*pair)).count()
}

/// The shear keeps the handedness, the scales of the last are uneven and mirror.
fn objects() -> Scene {
    let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.6, 1.0, 0.2), DVec3::new(0.0, -0.3, 1.0));
    let turned = DMat3::from_rotation_y(0.7) * DMat3::from_rotation_x(0.4);
    let objects = vec![
        placed(0, turned, DVec3::new(-2.6, 0.0, 0.0)),
        placed(0, turned * DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)), DVec3::new(2.6, 0.2, -0.5)),
        placed(1, shear, DVec3::new(-1.6, 3.2, -1.0)),
        placed(1, turned * DMat3::from_diagonal(DVec3::new(1.5, 0.5, -1.0)), DVec3::new(1.9, 3.2, 0.3)),
    ];
    let mut letter = embedded::cube();
    let mut arm = embedded::cube();
    for position in &mut arm.positions {
        *position = *position * Vec3::new(0.5, 0.3, 0.5) + Vec3::new(1.4, -0.7, 0.2);
    }
    letter.append(&arm);
    Scene::with_objects(vec![letter, embedded::torus(1.0, 0.4, 48, 24)], objects).expect("good transforms")
}

#[test]
fn both_executors_agree() {
    let Some(executor) = device() else { return };
    let (sphere, still_life, objects) = (Scene::new(embedded::sphere(64)), Scene::new(embedded::scene()), objects());
    let cases = [
        ("sphere", &sphere, camera_at(DVec3::new(1.0, 2.0, 5.0), DVec3::ZERO)),
        ("scene", &still_life, still_life_camera()),
        ("objects", &objects, framed(&objects, Some(0.6))),
        ("objects, parallel", &objects, framed(&objects, None)),
    ];
    for (name, scene, camera) in cases {
        let hits = PrimaryHits::kept(scene, View::new(camera, SIZE), PLACES);
        for normals in BOTH {
            let style = painted(3.0, normals);
            let plan = planned(scene, &style, &camera, SIZE);
            let Reference { image, exempt, .. } =
                Reference::new(Shot { hits: &hits, style: &style, plan: &plan }).expect("pictures");
            let agrees = |style: &Style| {
                let comparison = compare(&image, &rendered(&executor, scene, style, &camera, SIZE), &exempt);
                let comparison = comparison.expect("one size");
                println!(
                    "{name}, {normals:?}: {} of 255, {:.2} % exempt",
                    comparison.worst,
                    100.0 * comparison.exempt_share()
                );
                agrees(&comparison, magnitude(&plan))
            };
            assert!(agrees(&style), "{name}, {normals:?}");
            assert!(!agrees(&painted(3.25, normals)), "{name}, {normals:?}: a wider hull passes");
            assert!(!agrees(&Style { lines: Lines::NONE, ..style.clone() }), "{name}, {normals:?}: no hull passes");
        }
    }
}

/// The ink around a sphere in the middle of the picture is a ring between two circles, the inner of which is known.
#[test]
fn a_ring_is_as_wide_as_asked_in_px_of_the_picture() {
    let scene = Scene::new(embedded::sphere(256));
    let (executors, width_px) = (executors(), 4.0);
    for (executor, samples) in executors.iter().flat_map(|executor| [1, 2].map(|samples| (executor, samples))) {
        for distance in [3.6, 8.0, 15.0] {
            let camera = camera_at(distance * DVec3::new(0.48, 0.6, 0.64), DVec3::ZERO);
            let view = View { samples, ..View::new(camera, SIZE) };
            let style = only_hull(width_px as f32, Vec3::ZERO);
            let image = executor.render(&Picture::new(&scene, &style, view), &|_| {}).expect("a picture");
            let ink: f64 = image.rgba8.chunks(4).map(|px| 1.0 - f64::from(px[0]) / 255.0).sum();
            let radius = 120.0 / 0.3f64.tan() / (distance * distance - 1.0f64).sqrt();
            let width = (ink / std::f64::consts::PI + radius * radius).sqrt() - radius;
            println!("{}, {samples} samples: {width:.3} px at {distance}", executor.describe());
            assert!((width - width_px).abs() < 0.1, "{width} px at {distance} with {samples} samples");
        }
    }
}

/// A ball before a board: the ring around the ball covers the board, its own lines and its hull, and the board covers
/// the hull of a ball behind it.
#[test]
fn the_hull_hides_and_is_hidden() {
    let ball = || placed(0, DMat3::from_diagonal(DVec3::splat(0.5)), DVec3::new(0.3, 0.2, 1.5));
    let behind = placed(0, DMat3::from_diagonal(DVec3::splat(0.5)), DVec3::new(-0.4, -0.2, -1.5));
    let board = placed(1, DMat3::from_diagonal(DVec3::new(0.9, 0.6, 0.1)), DVec3::ZERO);
    let meshes = || vec![embedded::sphere(64), embedded::cube()];
    let camera = camera_at(DVec3::new(0.0, 0.0, 6.0), DVec3::ZERO);
    let mut scene = Scene::with_objects(meshes(), vec![ball(), behind, board]).expect("good transforms");
    let no_lines = ObjectLines::Own(LineStyle { width_px: [0.0; 5], ink: [0.0; 4] });
    (scene.object_mut(0).lines, scene.object_mut(1).lines) = (no_lines, no_lines);
    let alone = Scene::with_objects(meshes(), vec![ball()]).expect("good transforms");
    let with_edges = |ink| {
        let edges = style("lines").expect("a style").lines.edges;
        Style { lines: Lines { edges, ..only_hull(5.0, ink).lines }, ..only_hull(5.0, ink) }
    };
    for executor in executors() {
        let draw = |scene: &Scene, style: &Style| rendered(&executor, scene, style, &camera, SIZE);
        let is_red = |px: &[u8]| px[0] == 255 && px[1] == 0;
        // What the ring covers, by itself; it is seen whole before the board.
        let ring = draw(&alone, &only_hull(5.0, RED));
        let all = draw(&scene, &with_edges(RED));
        let without = draw(&scene, &Style { lines: Lines { hull: None, ..with_edges(RED).lines }, ..with_edges(RED) });
        let (mut covered, mut lines, mut wrong) = (0, 0, 0);
        for ((ring, all), without) in ring.rgba8.chunks(4).zip(all.rgba8.chunks(4)).zip(without.rgba8.chunks(4)) {
            covered += usize::from(is_red(ring));
            lines += usize::from(is_red(ring) && without[0] < 128);
            wrong += usize::from(is_red(ring) && !is_red(all));
        }
        println!("{}: {covered} px of ring, {lines} of them on lines, {wrong} not red", executor.describe());
        assert!(covered > 500 && lines > 10, "{covered} {lines}");
        // A line's visibility is decided on its centreline: where one enters the ring, its border may be drawn over it.
        assert!(wrong * 4 <= lines, "{}: {wrong} of {lines}", executor.describe());
        // The ball behind the board reaches beyond it on the left. Within the board, nothing of its ring is seen.
        scene.object_mut(0).lines = ObjectLines::None;
        scene.object_mut(2).lines = ObjectLines::None;
        let hidden = draw(&scene, &only_hull(5.0, RED));
        let board_px = |x: f64, y: f64| (x * 0.9 * 120.0 / 0.3f64.tan() / 5.9, y * 0.6 * 120.0 / 0.3f64.tan() / 5.9);
        let (right, down) = board_px(1.0, 1.0);
        let mut outside = 0;
        for y in 0..SIZE.1 {
            for x in 0..SIZE.0 {
                let red = is_red(&hidden.pixel(x, y));
                let on_board = (f64::from(x) - 159.5).abs() < right - 1.0 && (f64::from(y) - 119.5).abs() < down - 1.0;
                assert!(!(red && on_board), "{x} {y}");
                outside += usize::from(red);
            }
        }
        println!("{}: {outside} px of the hull behind the board", executor.describe());
        scene.object_mut(0).lines = no_lines;
        scene.object_mut(2).lines = ObjectLines::OfStyle;
    }
}

#[test]
fn mirrored_objects_have_the_hull_of_the_mirrored_mesh() {
    let mesh = || {
        let mut model = embedded::teapot(6);
        model.positions.iter_mut().for_each(|p| p.y += 0.3 * p.x);
        model
    };
    let mirror = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
    let mut mirrored = mesh();
    mirrored.positions.iter_mut().chain(&mut mirrored.normals).for_each(|v| v.x = -v.x);
    mirrored.faces.iter_mut().for_each(|face| face.swap(1, 2));
    let by_hand = Scene::new(mirrored);
    let by_object = Scene::with_objects(vec![mesh()], vec![placed(0, mirror, DVec3::ZERO)]).expect("a good transform");
    let camera = framed(&by_hand, Some(0.6));
    for normals in BOTH {
        let style = painted(4.0, normals);
        let [a, b] = [&by_object, &by_hand].map(|scene| picture(scene, &style, &camera));
        let without = picture(&by_hand, &Style { lines: Lines::NONE, ..style }, &camera);
        assert!(differing(&a, &without) > 500);
        assert_eq!(differing(&a, &b), 0, "{normals:?}");
    }
}

/// Uneven scales and shears: the normals are the mesh's own, and go into the scene by the inverse transpose.
#[test]
fn uneven_objects_have_the_hull_of_their_shape() {
    let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.9, 1.0, 0.2), DVec3::new(0.0, -0.6, 1.0));
    for matrix in [DMat3::from_diagonal(DVec3::new(0.3, 1.0, -2.0)), shear * 1e-3] {
        let placing = placed(0, matrix, DVec3::new(0.1, 0.2, 0.3));
        let model = embedded::sphere(96);
        let baked = Scene::new(model.clone().transformed(&placing.world_from_mesh));
        let by_object = Scene::with_objects(vec![model], vec![placing]).expect("a good transform");
        let camera = framed(&baked, Some(0.6));
        let style = only_hull(4.0, Vec3::ZERO);
        let [a, b] = [&by_object, &baked].map(|scene| picture(scene, &style, &camera));
        let (differing, ink) = (differing(&a, &b), b.rgba8.chunks(4).filter(|px| px[0] == 0).count());
        println!("{differing} of {ink} px differ");
        assert!(ink > 500 && differing * 50 < ink, "{differing} of {ink}");
    }
}

#[test]
fn objects_without_lines_and_translucent_ones_have_no_hull() {
    let mut scene = Scene::new(embedded::sphere(32));
    let camera = camera_at(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO);
    let ink = |scene: &Scene| {
        picture(scene, &only_hull(3.0, Vec3::ZERO), &camera).rgba8.chunks(4).filter(|px| px[0] == 0).count()
    };
    assert!(ink(&scene) > 500);
    scene.object_mut(0).lines = ObjectLines::None;
    assert_eq!(ink(&scene), 0);
    for alpha_mode in [AlphaMode::Blend, AlphaMode::Mask { cutoff: 0.5 }] {
        // With alpha 1 either is opaque.
        let base_color = glam::Vec4::new(0.8, 0.8, 0.8, 0.4);
        let glass = Material { alpha_mode, base_color, ..Material::default() };
        assert_eq!(ink(&Scene::new(embedded::placed(embedded::sphere(32), glam::Mat4::IDENTITY, glass))), 0);
    }
}

#[test]
fn the_plan_has_the_pass_its_reason_and_its_limits() {
    let scene = Scene::new(embedded::cube());
    let camera = framed(&scene, None);
    let view = View::new(camera, SIZE);
    let plan = |scene: &Scene, style: &Style| Plan::new(scene, style, &view, &Capabilities::RAY_CASTER);
    let style = only_hull(3.0, RED);
    let with = plan(&scene, &style).expect("a good style");
    let is_hull = |pass: &str| pass.starts_with("inverted hull");
    assert!(with.draws_surfaces && with.passes.iter().any(|reason| is_hull(reason.pass)));
    let hulls = with.hulls.expect("a hull");
    assert_eq!((hulls.hulls.len(), hulls.hulls[0].vertices.len(), hulls.hulls[0].faces.len()), (1, 8, 12));
    let again = plan(&scene, &only_hull(1.0, RED)).expect("a good style").hulls.expect("a hull");
    assert!(std::sync::Arc::ptr_eq(&hulls.hulls[0], &again.hulls[0]), "made once for each mesh");
    let without = plan(&scene, &Style { lines: Lines::NONE, ..style.clone() }).expect("a good style");
    assert!(without.hulls.is_none() && without.left_out.iter().any(|reason| is_hull(reason.pass)));
    for (width_px, is_good) in [(0.0, true), (256.0, true), (256.5, false), (-0.5, false), (f32::NAN, false)] {
        let outcome = plan(&scene, &only_hull(width_px, RED));
        assert_eq!(outcome.is_ok(), is_good, "{width_px}");
        assert!(is_good || matches!(outcome, Err(HarnessError::Range { .. })));
    }
    assert!(matches!(plan(&scene, &only_hull(3.0, Vec3::splat(1.5))), Err(HarnessError::Range { .. })));
    let mut cut = Scene::new(embedded::cube());
    cut.clip = Some(glam::DVec4::new(0.0, 1.0, 0.0, 0.0));
    assert!(matches!(plan(&cut, &style), Err(HarnessError::ClippedEdges { .. })));
}

#[test]
fn without_faces_in_it_and_with_a_width_of_0_nothing_is_drawn() {
    let camera = camera_at(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO);
    let base_color = glam::Vec4::new(0.8, 0.8, 0.8, 0.4);
    let glass = Material { alpha_mode: AlphaMode::Blend, base_color, ..Material::default() };
    let glass = embedded::placed(embedded::sphere(32), glam::Mat4::IDENTITY, glass);
    for executor in executors() {
        for (model, width_px) in [(glass.clone(), 3.0), (embedded::sphere(32), 0.0)] {
            let scene = Scene::new(model);
            let image = rendered(&executor, &scene, &only_hull(width_px, RED), &camera, SIZE);
            let ink = image.rgba8.chunks(4).filter(|px| px[1] < 255).count();
            // A contour's back faces may round to a pixel that its front faces miss.
            assert!(ink <= 2, "{}: {ink}", executor.describe());
        }
    }
}

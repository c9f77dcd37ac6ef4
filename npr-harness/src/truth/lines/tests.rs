//! Tests of the true lines against analytic solutions, of the comparison against known defects, and of the drawn lines
//! against the true ones.
#![allow(clippy::print_stdout)]

use super::*;
use crate::camera::{Framing, Projection};
use crate::capabilities::Capabilities;
use crate::cpu::{CpuOptions, render};
use crate::plan::Plan;
use crate::style::{Lines, Style, style};
use crate::view::View;
use glam::{Mat4, Vec3};
use npr_mesh::AlphaMode;
use npr_mesh::embedded::{cube, placed, scene as still_life, sphere};
use npr_mesh::{LoadOptions, Material, Model, load};
use npr_outline::line_style::LineStyle;
use std::path::{Path, PathBuf};

const CREASE_RAD: f64 = std::f64::consts::FRAC_PI_4;
const SIZE: (u32, u32) = (640, 360);

fn framed(scene: &Scene, yaw_deg: f64, pitch_deg: f64) -> Camera {
    let framing = Framing { yaw_rad: yaw_deg.to_radians(), pitch_rad: pitch_deg.to_radians(), ..Framing::default() };
    Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing)
}

/// A camera on +Z looking at the origin, with a vertical field of view of 90°, so that 1 at distance 1 is half the
/// picture's height.
fn from_z(distance: f64) -> Camera {
    Camera {
        eye: DVec3::Z * distance,
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y_rad: std::f64::consts::FRAC_PI_2 },
        near: 0.01,
    }
}

fn moved(model: Model, x: f32, y: f32, z: f32, scale: Vec3) -> Model {
    placed(model, Mat4::from_translation(Vec3::new(x, y, z)) * Mat4::from_scale(scale), Material::default())
}

fn together(parts: impl IntoIterator<Item = Model>) -> Scene {
    let mut model = Model::default();
    parts.into_iter().for_each(|part| model.append(&part));
    Scene::new(model)
}

fn length_px(lines: &TrueLines) -> f64 {
    lines.segments.iter().map(|s| s.ends_px[0].distance(s.ends_px[1])).sum()
}

#[test]
fn a_cube_shows_nine_edges_from_corner_to_corner() {
    let scene = Scene::new(cube());
    for fov_y_rad in [Some(0.6), None] {
        let framing = Framing { yaw_rad: 0.7, pitch_rad: 0.4, fov_y_rad, ..Framing::default() };
        let camera = Camera::framed(scene.corners(), 16.0 / 9.0, &framing);
        let lines = true_lines(&scene, &camera, SIZE, CREASE_RAD);
        // An edge of the cube is visible unless both of its faces are back-facing.
        let eye = camera.homogeneous_eye();
        let on_screen = |p: DVec3| {
            let clip = camera.clip_from_world(16.0 / 9.0) * p.extend(1.0);
            DVec2::new(320.0 + 320.0 * clip.x / clip.w, 180.0 - 180.0 * clip.y / clip.w)
        };
        let mut expected = Vec::new();
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            for (su, sv) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                if su * eye[u] > eye.w || sv * eye[v] > eye.w {
                    let mut end = DVec3::ZERO;
                    (end[u], end[v], end[axis]) = (su, sv, -1.0);
                    let mut other = end;
                    other[axis] = 1.0;
                    expected.push([on_screen(end), on_screen(other)]);
                }
            }
        }
        assert_eq!((expected.len(), lines.segments.len()), (9, 9));
        for [a, b] in expected {
            let same = |s: &&TrueSegment| {
                let [p, q] = s.ends_px;
                (p.distance(a) + q.distance(b)).min(p.distance(b) + q.distance(a)) < 1e-9
            };
            assert_eq!(lines.segments.iter().filter(same).count(), 1, "{a} {b}");
        }
        let silhouettes = lines.segments.iter().filter(|s| s.kind == LineKind::Silhouette).count();
        assert_eq!(silhouettes, 6);
    }
}

#[test]
fn a_sphere_is_a_circle() {
    let segments = 256;
    let scene = Scene::new(sphere(segments));
    let camera = from_z(2.0);
    let lines = true_lines(&scene, &camera, (800, 800), CREASE_RAD);
    // Tangents from distance 2 touch the unit sphere at an angle whose sine is 1/2; its tangent is the radius in half
    // pictures.
    let radius = 400.0 * (0.5f64).asin().tan();
    // A facet's corner deviates by half the turn from the true tangent point, and its edge by the sag.
    let turn = std::f64::consts::TAU / f64::from(segments);
    let sag_px = radius * 2.0 * turn * turn;
    let from_center = |p: DVec2| p.distance(DVec2::splat(400.0));
    for segment in &lines.segments {
        assert_eq!(segment.kind, LineKind::Silhouette);
        for end in segment.ends_px {
            assert!((from_center(end) - radius).abs() < sag_px, "{end}: {} of {radius}", from_center(end));
        }
    }
    let around = std::f64::consts::TAU * radius;
    let length = length_px(&lines);
    assert!((length / around - 1.0).abs() < 0.01, "{length} of {around}");
    // Every direction has a part of the circle, within two samples.
    for i in 0..720 {
        let on_circle = DVec2::splat(400.0) + DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 720.0) * radius;
        assert!(distances_to_lines(&lines, &[on_circle], 1.0)[0] < 0.5, "gap at {on_circle}");
    }
}

#[test]
fn a_box_behind_a_wall_is_not_seen() {
    let wall = || moved(cube(), 0.0, 0.0, 0.0, Vec3::new(1.0, 1.0, 0.1));
    let hidden = || moved(cube(), 0.0, 0.0, -2.0, Vec3::splat(0.5));
    let camera = from_z(4.0);
    let alone = true_lines(&together([wall()]), &camera, SIZE, CREASE_RAD);
    let both = true_lines(&together([wall(), hidden()]), &camera, SIZE, CREASE_RAD);
    assert_eq!(alone.segments.len(), 4);
    assert_eq!(alone.segments, both.segments);
    // Clear glass occludes nothing, not even its own far side; nor does a single-sided sheet that is back-facing, which has no
    // lines of its own either.
    let glass = |alpha: f32| {
        let mut glass = wall();
        glass.materials[0].alpha_mode = AlphaMode::Blend;
        glass.materials[0].base_color.w = alpha;
        glass
    };
    let sheet = |turned: bool, double_sided: bool| {
        let mut sheet = wall();
        // The fifth polygon, which faces +Z.
        sheet.faces = sheet.faces[8..10].to_vec();
        sheet.face_polygon.truncate(2);
        sheet.face_material.truncate(2);
        sheet.materials[0].double_sided = double_sided;
        if turned {
            sheet.faces.iter_mut().for_each(|face| face.swap(0, 1));
        }
        sheet
    };
    let glasses =
        [(0.0, 16), (0.3, 16), (0.49, 16), (0.5, 4), (0.7, 4), (1.0, 4)].map(|(alpha, seen)| (glass(alpha), seen));
    let sheets = [(sheet(true, false), 4), (sheet(true, true), 4), (sheet(false, false), 4)];
    let alone = together([sheet(true, false)]);
    assert!(true_lines(&alone, &camera, SIZE, CREASE_RAD).segments.is_empty(), "seen from behind");
    let cases = glasses.into_iter().chain(sheets);
    for (front, seen) in cases {
        let segments = true_lines(&together([front, hidden()]), &camera, SIZE, CREASE_RAD).segments;
        assert_eq!(segments.len(), seen);
    }
}

#[test]
fn a_half_hidden_edge_is_cut_where_it_is_hidden() {
    // The wall's near face is at z = 1 and ends at x = 0; the bar's front edges at z = 0 run from x = -0.9 to 0.9.
    let wall = moved(cube(), -1.0, 0.0, 0.5, Vec3::new(1.0, 1.0, 0.5));
    let bar = moved(cube(), 0.2, 0.0, -0.5, Vec3::new(0.9, 0.2, 0.5));
    let mut camera = from_z(4.0);
    camera.eye.x = 1.0;
    camera.target.x = 1.0;
    let lines = true_lines(&together([wall, bar]), &camera, SIZE, CREASE_RAD);
    let px = |x: f64, depth: f64| 320.0 + 180.0 * (x - 1.0) / depth;
    // From x = 1 the nearest part of the wall is its right face, whose far border is at z = 0: there the bar becomes
    // visible.
    let cut = px(0.0, 4.0).max(px(0.0, 3.0));
    let upper = 180.0 - 180.0 * 0.2 / 4.0;
    let along: Vec<_> =
        lines.segments.iter().filter(|s| s.ends_px.iter().all(|p| (p.y - upper).abs() < 1e-6)).collect();
    assert_eq!(along.len(), 1, "{along:?}");
    let [a, b] = along[0].ends_px.map(|p| p.x);
    assert!((a.min(b) - cut).abs() < 0.3, "{} for {cut}", a.min(b));
    assert!((a.max(b) - px(1.1, 4.0)).abs() < 1e-4);
}

#[test]
fn edges_are_cut_to_the_picture_and_the_near_plane() {
    let mut camera = from_z(0.5);
    camera.near = 0.1;
    let scene = Scene::new(Model {
        positions: vec![Vec3::new(0.1, -0.1, 2.0), Vec3::new(0.1, -0.1, -50.0), Vec3::new(0.1, -9.0, -50.0)],
        normals: vec![Vec3::X; 3],
        faces: vec![[0, 1, 2]],
        face_material: vec![0],
        materials: vec![Material::default()],
        ..Model::default()
    });
    let lines = true_lines(&scene, &camera, (100, 100), CREASE_RAD);
    assert!(!lines.segments.is_empty());
    for end in lines.segments.iter().flat_map(|s| s.ends_px) {
        assert!(end.is_finite() && (end - 50.0).abs().max_element() <= 50.0 + MARGIN_PX + 1e-9, "{end}");
    }
    // The edge that passes the eye is cut by the near plane, in px at (50 + 50, 50 + 50), and ends far away.
    let [a, b] = lines.segments.iter().find(|s| s.ends_px.iter().all(|p| (p.x - p.y).abs() < 1e-9)).unwrap().ends_px;
    assert!(a.max(b).distance(DVec2::splat(100.0)) < 1e-4, "{a} {b}");
    let far = 50.0 + 50.0 * f64::from(0.1f32) / 50.5;
    assert!(a.min(b).distance(DVec2::splat(far)) < 1e-4, "{a} {b}");
}

/// Segments well within the picture: parallel slanted lines 100 px long, 20 px apart.
fn hatching(count: u32) -> TrueLines {
    let segments = (0..count)
        .map(|i| {
            let from = DVec2::new(40.3 + 20.0 * f64::from(i), 40.7);
            TrueSegment { ends_px: [from, from + DVec2::new(60.0, 80.0)], kind: LineKind::Crease, edge: i }
        })
        .collect();
    TrueLines { segments, size_px: SIZE }
}

/// Lines 1 px wide, offset.
fn drawn(lines: &TrueLines, by: DVec2) -> Vec<DVec2> {
    let darkness: Vec<f64> = (0..SIZE.1)
        .flat_map(|y| (0..SIZE.0).map(move |x| DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)))
        .map(|p| {
            let distance = lines.segments.iter().map(|s| distance_to_segment(p - by, s.ends_px)).fold(9.0, f64::min);
            (1.0 - distance).clamp(0.0, 1.0)
        })
        .collect();
    drawn_centreline(&darkness, SIZE.0, SIZE.1)
}

#[test]
fn lines_drawn_as_they_are_agree() {
    let found = accuracy(&hatching(10), &drawn(&hatching(10), DVec2::ZERO), 1.5);
    assert_eq!((found.precision, found.recall, found.f1), (1.0, 1.0, 1.0));
    assert!((found.true_length_px - 1000.0).abs() < 1e-6);
    assert!(found.mean_distance_px < 0.35 && found.drawn_px > 800);
    let empty = accuracy(&hatching(0), &[], 1.5);
    assert_eq!((empty.precision, empty.recall), (1.0, 1.0));
    let nothing = accuracy(&hatching(10), &[], 1.5);
    assert_eq!((nothing.precision, nothing.recall, nothing.f1), (1.0, 0.0, 0.0));
}

#[test]
fn a_missing_line_lowers_recall_and_a_spurious_one_precision_by_its_share() {
    let missing = accuracy(&hatching(10), &drawn(&hatching(9), DVec2::ZERO), 1.5);
    assert_eq!(missing.precision, 1.0);
    assert!((missing.recall - 0.9).abs() < 1e-9, "{missing:?}");
    let spurious = accuracy(&hatching(9), &drawn(&hatching(10), DVec2::ZERO), 1.5);
    assert_eq!(spurious.recall, 1.0);
    assert!((spurious.precision - 0.9).abs() < 0.005, "{spurious:?}");
}

#[test]
fn a_px_aside_is_near_and_three_are_not() {
    let aside = DVec2::new(0.8, -0.6);
    let near = accuracy(&hatching(10), &drawn(&hatching(10), aside), 1.5);
    assert_eq!((near.precision, near.recall), (1.0, 1.0));
    let far = accuracy(&hatching(10), &drawn(&hatching(10), aside * 3.0), 1.5);
    assert!(far.precision < 0.02 && far.recall < 0.02, "{far:?}");
}

#[test]
fn what_runs_along_the_border_does_not_count_as_missed() {
    let segments = [(0.3, 1.0), (-0.4, 1.0), (20.0, 99.0)]
        .map(|(x, edge)| TrueSegment {
            ends_px: [DVec2::new(x, 20.0), DVec2::new(x, 80.0)],
            kind: LineKind::Crease,
            edge: edge as u32,
        })
        .to_vec();
    let truth = TrueLines { segments, size_px: SIZE };
    // Drawn are the pixels of the first column, which are near both lines at the border, and the line inside.
    let points: Vec<DVec2> = (20..80).flat_map(|y| [0.5, 20.5].map(|x| DVec2::new(x, f64::from(y) + 0.5))).collect();
    let found = accuracy(&truth, &points, 1.5);
    assert_eq!((found.precision, found.recall), (1.0, 1.0));
    assert!((found.true_length_px - 60.0).abs() < 1e-9);
    assert_eq!(accuracy(&truth, &points[1..], 1.5).recall, 1.0);
}

fn one_px_style() -> Style {
    let look = LineStyle { width_px: [1.0; 5], ink: [0.0, 0.0, 0.0, 1.0] };
    Style { paper: Vec3::ONE, lines: Lines::edges(look), ..style("lines").expect("there is such a style") }
}

fn measure(name: &str, scene: &Scene, camera: &Camera) -> LineAccuracy {
    let style = one_px_style();
    let plan = Plan::new(scene, &style, &View::new(*camera, SIZE), &Capabilities::RAY_CASTER).expect("a valid style");
    let frame = render(scene, &plan, &CpuOptions::default(), &|_| {});
    let darkness: Vec<f64> = frame.color.iter().map(|c| 1.0 - c.x).collect();
    let truth = true_lines(scene, camera, SIZE, f64::from(style.crease_angle_rad));
    let points = drawn_centreline(&darkness, SIZE.0, SIZE.1);
    let found = accuracy(&truth, &points, 1.5);
    println!(
        "{name:<24} precision {:.4} recall {:.4} F1 {:.4} drawn {:>6} px, true {:>7.1} px, off by {:.2} px",
        found.precision, found.recall, found.f1, found.drawn_px, found.true_length_px, found.mean_distance_px
    );
    if let Some(folder) = std::env::var_os("NPR_LINE_TRUTH_DUMP") {
        dump(&PathBuf::from(folder).join(format!("{}.png", name.replace(' ', "_"))), &truth, &darkness, &points);
    }
    found
}

/// Writes a picture enlarged three times: ink is grey, drawn points without a true line red, true lines green, or blue
/// where nothing is drawn.
fn dump(path: &Path, truth: &TrueLines, darkness: &[f64], points: &[DVec2]) {
    const TIMES: u32 = 3;
    let mut picture = image::RgbImage::from_fn(SIZE.0 * TIMES, SIZE.1 * TIMES, |x, y| {
        let dark = darkness[(y / TIMES * SIZE.0 + x / TIMES) as usize];
        image::Rgb([(255.0 * (1.0 - 0.4 * dark)) as u8; 3])
    });
    for (point, distance) in points.iter().zip(distances_to_lines(truth, points, 1.5)) {
        if distance > 1.5 {
            for i in 0..TIMES * TIMES {
                let (x, y) = (point.x as u32 * TIMES + i % TIMES, point.y as u32 * TIMES + i / TIMES);
                picture.put_pixel(x, y, image::Rgb([255, 0, 0]));
            }
        }
    }
    let samples = truth.samples();
    for ((point, ..), found) in samples.iter().zip(are_near(points, samples.iter().map(|s| s.0), 1.5)) {
        let at = *point * f64::from(TIMES);
        picture.put_pixel(at.x as u32, at.y as u32, image::Rgb(if found { [0, 160, 0] } else { [0, 0, 255] }));
    }
    picture.save(path).expect("the folder can be written to");
}

#[test]
fn the_reference_draws_the_still_life_as_it_is() {
    let scene = Scene::new(still_life());
    let found = measure("still life", &scene, &framed(&scene, 30.0, 20.0));
    assert!(found.precision >= 0.98 && found.recall >= 0.98, "{found:?}");
}

/// A cube with warped sides, for some of which a diagonal is part of the outline.
#[test]
fn warped_quads_have_all_of_their_outline() {
    let mut model = cube();
    let turn = Mat4::from_rotation_y(60f32.to_radians());
    for position in model.positions.iter_mut().filter(|position| position.y > 0.0) {
        *position = turn.transform_point3(*position);
    }
    let of_triangles = Scene::new(Model { face_polygon: Vec::new(), ..model.clone() });
    let scene = Scene::new(model);
    for (yaw, pitch) in [(0.0, 0.0), (20.0, 10.0), (45.0, 30.0), (200.0, -20.0)] {
        let camera = framed(&scene, yaw, pitch);
        let found = measure(&format!("twisted cube {yaw} {pitch}"), &scene, &camera);
        assert!(found.precision >= 0.99 && found.recall >= 0.999, "{yaw} {pitch}: {found:?}");
        let silhouettes = |scene: &Scene| -> f64 {
            let lines = true_lines(scene, &camera, SIZE, CREASE_RAD);
            let silhouettes = lines.segments.iter().filter(|segment| segment.kind == LineKind::Silhouette);
            silhouettes.map(|segment| segment.ends_px[0].distance(segment.ends_px[1])).sum()
        };
        assert!((silhouettes(&scene) / silhouettes(&of_triangles) - 1.0).abs() < 0.01);
    }
}

/// The rims of the solids lie 0.001 above the ground.
#[test]
fn the_ground_seen_from_below_does_not_let_rims_through() {
    let scene = Scene::new(still_life());
    for (yaw, pitch) in [(10.0, -10.0), (100.0, -10.0), (150.0, -10.0), (280.0, -10.0), (60.0, -20.0), (120.0, -45.0)] {
        let found = measure(&format!("still life {yaw} {pitch}"), &scene, &framed(&scene, yaw, pitch));
        assert!(found.precision >= 0.98 && found.recall >= 0.98, "{found:?}");
    }
}

/// Prints a table; if `NPR_LINE_TRUTH_DUMP` is set to a folder, also writes pictures there.
#[test]
#[ignore = "a minute; models that may not be there"]
fn accuracy_of_the_reference() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let mut scenes = vec![("still life", Scene::new(still_life()))];
    for name in ["stanford-bunny", "fandisk", "rocker-arm", "teapot"] {
        match load(&data.join(name).with_extension("obj"), &LoadOptions::default()) {
            Ok(loaded) => scenes.push((name, Scene::from(loaded))),
            Err(why) => println!("{name} left out: {why}"),
        }
    }
    let mut worst = (1.0f64, 1.0f64);
    for (name, scene) in &scenes {
        for (yaw, pitch) in [(30.0, 20.0), (150.0, -10.0), (270.0, 50.0)] {
            let found = measure(&format!("{name} {yaw} {pitch}"), scene, &framed(scene, yaw, pitch));
            worst = (worst.0.min(found.precision), worst.1.min(found.recall));
        }
    }
    println!("worst precision {:.4}, worst recall {:.4}", worst.0, worst.1);
}

//! Pictures of meshes whose topology is not what their shape is are those of clean meshes of the same shape.

mod common;
#[path = "../../npr-mesh/tests/topology/union.rs"]
mod union;

use common::{Folder, device, rendered};
use glam::{Quat, Vec3};
use npr_harness::camera::{Camera, Framing};
use npr_harness::compare::compare;
use npr_harness::executor::Executor;
use npr_harness::picture::Image;
use npr_harness::scene::Scene;
use npr_harness::style::style;
use npr_mesh::edges::EdgeKind;
use npr_mesh::{LoadOptions, Model, normals};
use std::fmt::Write;
use union::{Cells, Cut, union};

const SIZE: (u32, u32) = (160, 120);

fn executors() -> Vec<Executor> {
    [Some(Executor::Cpu { why: None }), device()].into_iter().flatten().collect()
}

fn scene(text: &str) -> Scene {
    let folder = Folder::new();
    let path = folder.join("model.obj");
    std::fs::write(&path, text).expect("a file");
    Scene::from(npr_mesh::load(&path, &LoadOptions::default()).expect("a model"))
}

fn camera(scene: &Scene, yaw_deg: f64, pitch_deg: f64) -> Camera {
    let framing = Framing { yaw_rad: yaw_deg.to_radians(), pitch_rad: pitch_deg.to_radians(), ..Framing::default() };
    Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing)
}

/// Each scene is framed by itself.
fn picture(executor: &Executor, scene: &Scene, name: &str, [yaw_deg, pitch_deg]: [f64; 2]) -> Image {
    rendered(executor, scene, &style(name).expect("a style"), &camera(scene, yaw_deg, pitch_deg), SIZE)
}

/// At most one pixel in a thousand differs by more than 16.
fn assert_same(expected: &Image, actual: &Image, what: &str) {
    let over = compare(expected, actual, &[]).expect("pictures of one size").over(16);
    assert!(over * 1000 <= u64::from(SIZE.0 * SIZE.1), "{what}: {over} px differ");
}

/// The pictures of a model and of a clean one, in some styles, on all executors.
fn assert_drawn_as(clean: &str, irregular: &str, styles: &[&str]) {
    let (clean, irregular) = (scene(clean), scene(irregular));
    for executor in executors() {
        for name in styles {
            for view in [[30.0, 20.0], [-60.0, -25.0]] {
                let [expected, actual] = [&clean, &irregular].map(|scene| picture(&executor, scene, name, view));
                assert_same(&expected, &actual, &format!("{} {name} {view:?}", executor.name()));
            }
        }
    }
}

const CUBE: &str = "v -.5 -.5 -.5\nv .5 -.5 -.5\nv .5 .5 -.5\nv -.5 .5 -.5\nv -.5 -.5 .5\nv .5 -.5 .5\nv .5 .5 .5\n\
                    v -.5 .5 .5\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
const STYLES: [&str; 3] = ["cartoon", "lines", "ink-image"];

/// A tube around Y whose last column is a column of its own, computed at 2π, or the first.
fn tube(closed: bool) -> String {
    let mut text = String::new();
    let columns = 24;
    for column in 0..columns + u32::from(!closed) {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(column) / f64::from(columns)).sin_cos();
        writeln!(text, "v {sin:e} -1 {cos:e}\nv {sin:e} 1 {cos:e}").expect("a string");
    }
    for column in 0..columns {
        let next = if closed { (column + 1) % columns } else { column + 1 };
        let (a, b) = (2 * column + 1, 2 * next + 1);
        writeln!(text, "f {a} {b} {} {}", b + 1, a + 1).expect("a string");
    }
    text
}

#[test]
fn a_seam_within_rounding_is_not_seen() {
    assert_drawn_as(&tube(true), &tube(false), &STYLES);
    // The seam is at +Z.
    let open = scene(&tube(false));
    for executor in executors() {
        let picture = picture(&executor, &open, "lines", [0.0, 0.0]);
        let dark = (60..100).flat_map(|x| (40..80).map(move |y| (x, y))).filter(|&(x, y)| picture.pixel(x, y)[1] < 200);
        assert_eq!(dark.count(), 0, "{}", executor.name());
    }
}

#[test]
fn a_flat_sheet_with_t_junctions_has_its_outline() {
    let sheet = "v -1 0 0\nv 1 0 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";
    let cut = "v -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv 1 0 0\nv 1 .5 0\nv 0 .5 0\nv 1 1 0\nf 1 2 3 4\nf 2 5 6 7\n\
               f 7 6 8 3\n";
    assert_drawn_as(sheet, cut, &STYLES);
    let triangles = "v -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv 1 0 0\nv 1 .5 0\nv 0 .5 0\nv 1 1 0\nf 1 2 3\nf 1 3 4\n\
                     f 7 6 8\nf 7 8 3\nf 2 5 6\nf 2 6 7\n";
    assert_drawn_as(sheet, triangles, &STYLES);
}

#[test]
fn three_faces_at_an_edge_are_drawn_alike_in_any_order() {
    let text = |faces: [&str; 3]| {
        format!("v 0 0 0\nv 1 0 0\nv .5 1 0\nv -.5 1 0\nv .5 .5 .8\nf {}\nf {}\nf {}\n", faces[0], faces[1], faces[2])
    };
    let [a, b, c] = ["1 2 3", "1 3 4", "1 5 3"];
    for order in [[a, c, b], [c, a, b], [b, a, c], ["3 1 2", "5 3 1", "4 1 3"]] {
        assert_drawn_as(&text([a, b, c]), &text(order), &["cartoon", "lines"]);
    }
}

#[test]
fn a_square_back_to_back_has_its_outline() {
    let sheet = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n";
    let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n";
    for faces in [
        "f 1 2 3 4\nf 4 3 2 1\nf 2 5 6 3\nf 3 6 5 2\n",
        "f 1 2 3\nf 1 3 4\nf 4 2 1\nf 4 3 2\nf 2 5 6 3\nf 3 6 5 2\n",
        "f 1 2 3 4\nf 4 3 2 1\nf 2 5 6 3\n",
    ] {
        assert_drawn_as(sheet, &format!("{corners}{faces}"), &["lines"]);
    }
}

#[test]
fn faces_without_area_change_nothing() {
    for more in [
        "f 3 7 3\n",
        "f 7 3 3\n",
        "f 3 7 3 7\n",
        "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 9 10 11\n",
        "v .1 .1 .3\nv .2 .2 .6\nv .3 .3 .9\nf 9 10 11\n",
        "v .5 .5 .1\nf 3 9 7\n",
        "v 5 5 5\nf 9 9 9\n",
    ] {
        assert_drawn_as(CUBE, &format!("{CUBE}{more}"), &STYLES);
        // Before all others.
        let (vertices, faces): (Vec<&str>, Vec<&str>) = more.lines().partition(|line| line.starts_with('v'));
        let (of_cube, sides): (Vec<&str>, Vec<&str>) = CUBE.lines().partition(|line| line.starts_with('v'));
        let first = [of_cube, vertices, faces, sides].concat().join("\n") + "\n";
        assert_drawn_as(CUBE, &first, &["cartoon"]);
    }
}

/// A solid of boxes above a ground, turned in f32 by `turn`, and its normals.
fn solid(boxes: &[Cells], cut: Cut, turn: Quat) -> Scene {
    let (mut positions, polygons) = union(boxes, cut);
    positions.iter_mut().for_each(|p| *p -= Vec3::new(2.5, 0.0, 2.5));
    let mut model = Model::default();
    let mut add = |polygons: &[Vec<u32>], positions: &[Vec3]| {
        let first = model.positions.len() as u32;
        model.positions.extend(positions.iter().map(|&p| turn * p));
        for polygon in polygons {
            let number = model.face_polygon.last().map_or(0, |last| last + 1);
            for pair in polygon[1..].windows(2) {
                model.faces.push([polygon[0], pair[0], pair[1]].map(|vertex| first + vertex));
                model.face_polygon.push(number);
            }
        }
    };
    add(&polygons, &positions);
    let ground = [(-9.0, -9.0), (-9.0, 9.0), (9.0, 9.0), (9.0, -9.0)].map(|(x, z)| Vec3::new(x, -0.5, z));
    add(&[vec![0, 1, 2, 3]], &ground);
    normals::fill_missing(&mut model, LoadOptions::default().normal_crease_angle_rad);
    Scene::new(model)
}

const STAIRS: [Cells; 4] =
    [([0, 0, 0], [4, 0, 4]), ([0, 1, 0], [2, 1, 4]), ([0, 2, 1], [1, 2, 3]), ([3, 1, 2], [3, 4, 2])];

#[test]
fn a_solid_with_t_junctions_has_the_lines_and_the_shadow_of_its_shape() {
    for turn in [Quat::IDENTITY, Quat::from_euler(glam::EulerRot::YXZ, 0.3, 0.1, -0.2)] {
        let clean = solid(&STAIRS, Cut::Unit, turn);
        for cut in [Cut::Wide, Cut::High] {
            let cut = solid(&STAIRS, cut, turn);
            let found = cut.meshes()[0].edges();
            let of = |kind| found.edges.iter().filter(|edge| edge.kind() == kind).count();
            // The border of the ground.
            assert_eq!((of(EdgeKind::Boundary), of(EdgeKind::NonManifold)), (4, 0));
            for executor in executors() {
                for name in ["toon-shadow", "lines", "cartoon"] {
                    let [expected, actual] = [&clean, &cut].map(|scene| picture(&executor, scene, name, [30.0, 35.0]));
                    assert_same(&expected, &actual, &format!("{} {name} {turn}", executor.name()));
                }
            }
        }
    }
}

#[test]
fn a_closed_solid_with_t_junctions_is_closed() {
    let closed = |cut: Cut| {
        let (positions, polygons) = union(&STAIRS, cut);
        let mut model = Model { positions, ..Model::default() };
        for polygon in &polygons {
            model.faces.extend(polygon[1..].windows(2).map(|pair| [polygon[0], pair[0], pair[1]]));
        }
        model.normals = vec![Vec3::Y; model.positions.len()];
        Scene::new(model).meshes()[0].is_closed()
    };
    assert_eq!([Cut::Unit, Cut::Wide, Cut::High].map(closed), [true; 3]);
}

#[test]
fn a_face_without_area_does_not_frame_the_picture() {
    let bounds = |text: &str| scene(text).bounds();
    assert_eq!(bounds(&format!("{CUBE}v 0 0 0\nv 1 1 1\nv 2 2 2\nf 9 10 11\n")), bounds(CUBE));
    // Unless there is no other.
    let line = "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n";
    assert_eq!(bounds(line), Some((Vec3::ZERO, Vec3::splat(2.0))));
}

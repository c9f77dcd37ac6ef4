//! Smoothing groups of OBJ files.

use crate::load_alone;
use glam::Vec3;
use npr_mesh::Model;

/// Faces of a cube, outwards: z = 1, x = 1, z = 0, x = 0, y = 1, y = 0.
const FACES: [&str; 6] = ["5 6 8 7", "2 4 8 6", "1 3 4 2", "1 5 7 3", "3 7 8 4", "1 2 6 5"];

fn cube(statements: [&str; 6]) -> Model {
    let mut obj = String::new();
    for corner in 0..8 {
        obj += &format!("v {} {} {}\n", corner & 1, corner >> 1 & 1, corner >> 2);
    }
    for (statement, face) in statements.iter().zip(FACES) {
        obj += &format!("{statement}\nf {face}\n");
    }
    load_alone("m.obj", obj).expect("it loads").into_model()
}

/// Whether all corners of a face have its own normal.
fn is_flat(model: &Model, polygon: usize) -> bool {
    let normals = [Vec3::Z, Vec3::X, -Vec3::Z, -Vec3::X, Vec3::Y, -Vec3::Y];
    let faces = &model.faces[2 * polygon..2 * polygon + 2];
    faces.iter().flatten().all(|&vertex| model.normals[vertex as usize].distance(normals[polygon]) < 1e-6)
}

fn normal_at(model: &Model, polygon: usize, at: Vec3) -> Vec3 {
    let faces = &model.faces[2 * polygon..2 * polygon + 2];
    let vertex = faces.iter().flatten().find(|&&vertex| model.positions[vertex as usize] == at).expect("a corner");
    model.normals[*vertex as usize]
}

#[test]
fn off_is_flat_and_a_group_is_smooth_whatever_the_angle() {
    let all = |first: &'static str| cube([first, "", "", "", "", ""]);
    // A cube of one group is as round as can be.
    let smooth = all("s 1");
    let diagonal = Vec3::ONE.normalize();
    assert!((0..6).all(|polygon| !is_flat(&smooth, polygon)));
    for polygon in [0, 1, 4] {
        assert!(normal_at(&smooth, polygon, Vec3::ONE).distance(diagonal) < 1e-6);
    }
    assert_eq!(smooth.positions.len(), 8);
    for off in ["s off", "s 0"] {
        let flat = all(off);
        assert!((0..6).all(|polygon| is_flat(&flat, polygon)), "{off}");
        assert_eq!(flat.positions.len(), 24);
    }
    assert_eq!(all("s on"), smooth);
}

#[test]
fn groups_share_normals_within_and_not_between() {
    // The first two faces are a group, the third and the fourth another, the fifth flat; the sixth is in the first.
    let model = cube(["s 1", "", "s 2", "", "s off", "s 1"]);
    let two = (Vec3::Z + Vec3::X).normalize();
    assert!(normal_at(&model, 0, Vec3::ONE).distance(two) < 1e-6, "the flat face does not count");
    assert!(normal_at(&model, 1, Vec3::ONE).distance(two) < 1e-6);
    assert!(is_flat(&model, 4));
    // Three faces of group 1 meet at (1, 0, 1), two of group 2 at (0, 1, 0).
    let three = (Vec3::Z + Vec3::X - Vec3::Y).normalize();
    assert!(normal_at(&model, 5, Vec3::new(1.0, 0.0, 1.0)).distance(three) < 1e-6);
    assert!(normal_at(&model, 2, Vec3::Y).distance(-two) < 1e-6);
    assert!(normal_at(&model, 0, Vec3::new(0.0, 1.0, 1.0)).distance(Vec3::Z) < 1e-6, "alone in its group there");
}

#[test]
fn faces_before_any_statement_follow_the_crease_angle() {
    let model = cube(["", "", "", "", "s 3", ""]);
    assert!((0..4).all(|polygon| is_flat(&model, polygon)));
    assert_eq!(cube([""; 6]), cube([""; 6]));
    assert!((0..6).all(|polygon| is_flat(&cube([""; 6]), polygon)));
}

#[test]
fn a_smooth_surface_in_one_group_is_what_it_is_without() {
    let mut obj = String::new();
    for i in 0..10 {
        for j in 0..10 {
            obj += &format!("v {i} {} {j}\n", 0.02 * f64::from((i - 5) * (i - 5) + j * j));
        }
    }
    let mut faces = String::new();
    for i in 0..9 {
        for j in 0..9 {
            let a = 10 * i + j + 1;
            faces += &format!("f {} {} {} {}\n", a, a + 1, a + 11, a + 10);
        }
    }
    let load = |text: String| load_alone("m.obj", text).expect("it loads").into_model();
    let without = load(format!("{obj}{faces}"));
    assert_eq!(load(format!("{obj}s 7\n{faces}")), without);
    assert_ne!(load(format!("{obj}s off\n{faces}")).normals, without.normals);
}

#[test]
fn normals_of_the_file_have_precedence() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\ns off\nf 1//1 2//1 3\n";
    let model = load_alone("m.obj", text).expect("it loads").into_model();
    let [a, b, c] = model.faces[0].map(|vertex| model.normals[vertex as usize]);
    assert_eq!([a, b, c], [Vec3::X, Vec3::X, Vec3::Z]);
}

#[test]
fn faces_of_a_group_that_only_touch_share_a_normal() {
    // Two triangles at right angles that share one corner.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\ns 1\nf 1 2 3\nf 1 4 5\n";
    let model = load_alone("m.obj", text).expect("it loads").into_model();
    let [a, b] = [0, 1].map(|face: usize| model.normals[model.faces[face][0] as usize]);
    assert_eq!(a, b);
}

#[test]
fn opposite_windings_in_a_group_have_opposite_normals() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ns 1\nf 1 2 3\nf 1 4 3\n";
    let model = load_alone("m.obj", text).expect("it loads").into_model();
    let normals = [0, 1].map(|face: usize| model.normals[model.faces[face][0] as usize]);
    assert_eq!(normals, [Vec3::Z, -Vec3::Z]);
}

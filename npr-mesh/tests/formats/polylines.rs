//! Lines of OBJ files.

use crate::{load_alone, warnings};
use glam::{Vec3, Vec4};

#[test]
fn polylines_become_segments() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1 2 3\nv 2 0 0\nl 1/1 2/1 4/1\nl -1 -2\nl 3 3\n";
    let loaded = load_alone("m.obj", text).expect("it loads");
    assert_eq!(warnings(&loaded), ["1 lines from a vertex to itself are left out"]);
    let model = loaded.into_model();
    let ends: Vec<_> = model.lines.iter().map(|line| line.map(|vertex| model.positions[vertex as usize])).collect();
    let [a, b, c, d] = [Vec3::ZERO, Vec3::X, Vec3::Y, 2.0 * Vec3::X];
    assert_eq!(ends, [[a, b], [b, d], [d, c]]);
    assert_eq!((model.faces.len(), model.normals.len()), (1, model.positions.len()));
}

#[test]
fn a_file_of_lines_alone_is_a_model() {
    let loaded = load_alone("m.obj", "v 0 0 0\nv 1 0 0 1 0 0\nl 1 2\nl 2 1\n").expect("it loads");
    let model = loaded.into_model();
    assert_eq!((model.faces.len(), &model.lines[..]), (0, &[[0, 1], [1, 0]][..]));
    assert_eq!(model.colors, [Vec4::ONE, Vec4::new(1.0, 0.0, 0.0, 1.0)]);
    assert_eq!(model.bounds(), Some((Vec3::ZERO, Vec3::X)));
}

#[test]
fn points_are_still_warned_of() {
    let loaded = load_alone("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\np 1 2\np 3\n").expect("it loads");
    assert_eq!(warnings(&loaded), ["2 points are left out"]);
    let error = load_alone("m.obj", "v 0 0 0\np 1\n").unwrap_err();
    assert!(error.to_string().contains("points are left out"), "{error}");
}

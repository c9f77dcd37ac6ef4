//! STL files.

use crate::{load_alone, warnings};
use glam::Vec3;
use npr_mesh::edges::{self, EdgeKind, EdgeOptions};
use npr_mesh::{Limits, LoadError, LoadOptions, Model, load_bytes};

/// The triangles of a tetrahedron, outwards.
fn triangles() -> [[[f32; 3]; 3]; 4] {
    let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    [[a, c, b], [a, b, d], [a, d, c], [b, c, d]]
}

fn text(normal: &str) -> String {
    let mut text = "solid a name of words\n".to_owned();
    for triangle in triangles() {
        text += &format!("  facet normal {normal}\n    outer loop\n");
        for [x, y, z] in triangle {
            text += &format!("      vertex {x:e} {y} {z}\n");
        }
        text += "    endloop\n  endfacet\n";
    }
    text + "endsolid a name of words\n"
}

fn binary(header: &str, normal: [f32; 3], attribute: u16) -> Vec<u8> {
    let mut bytes = header.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend(4u32.to_le_bytes());
    for triangle in triangles() {
        normal.iter().chain(triangle.as_flattened()).for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend(attribute.to_le_bytes());
    }
    bytes
}

fn model(bytes: impl Into<Vec<u8>>) -> Model {
    let loaded = load_alone("m.stl", bytes).expect("it loads");
    assert_eq!(warnings(&loaded), [""; 0]);
    loaded.into_model()
}

#[test]
fn a_tetrahedron_in_every_form() {
    let expected = model(text("0 0 0"));
    assert_eq!(expected.faces.len(), 4);
    let Model { positions, faces, face_polygon, face_material, .. } = &expected;
    let found = edges::find(positions, faces, face_polygon, face_material, &EdgeOptions::default());
    assert_eq!((found.edges.len(), found.edges.iter().all(|e| e.kind() == EdgeKind::TwoFace)), (6, true));
    let slope = Vec3::ONE.normalize();
    assert!(faces[3].iter().all(|&v| expected.normals[v as usize].distance(slope) < 1e-6), "from the corners");
    for (name, bytes) in [
        ("wrong normals", text("1 0 0").into_bytes()),
        ("normals that are none", text("nan nan -nan").into_bytes()),
        ("capitals", text("0 0 0").to_uppercase().into_bytes()),
        ("carriage returns", text("0 0 0").replace('\n', "\r\n").into_bytes()),
        ("one line", text("0 0 0").replace("words\n", "words\n#").replace('\n', " ").replace('#', "\n").into_bytes()),
        ("no name", text("0 0 0").replace(" a name of words", "").into_bytes()),
        ("binary", binary("made by hand", [0.0; 3], 0)),
        ("binary with attributes", binary("", [0.0, 0.0, 9.0], 0xFFFF)),
        ("binary that begins like text", binary("solid facet", [f32::NAN; 3], 0)),
    ] {
        assert_eq!(model(bytes), expected, "{name}");
    }
}

#[test]
fn several_solids_are_one_mesh() {
    let moved = text("0 0 0").replace("vertex ", "vertex 1").replace("vertex 11e0", "vertex 2e0");
    let model = model(text("0 0 0") + &moved);
    assert_eq!(model.faces.len(), 8);
}

#[test]
fn zeros_of_both_signs_are_one_position() {
    let text = "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
                facet normal 0 0 0\nouter loop\nvertex -0 0 0\nvertex 0 1 -0.0\nvertex -1 0 0\nendloop\nendfacet\nendsolid\n";
    assert_eq!(model(text).positions.len(), 4);
}

#[test]
fn faults_are_named() {
    let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    let solid = |body: &str| format!("solid x\n{body}endsolid x\n").into_bytes();
    let mut cut = binary("", [0.0; 3], 0);
    cut.truncate(200);
    let mut more = binary("", [0.0; 3], 0);
    more[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut not_finite = binary("", [0.0; 3], 0);
    not_finite[84 + 50 + 12..][..4].copy_from_slice(&f32::INFINITY.to_le_bytes());
    for (bytes, part) in [
        (Vec::new(), "neither text nor binary"),
        (b"solid".to_vec(), "neither text nor binary"),
        (solid(""), "no triangle"),
        (solid(&facet.replace("vertex 1 0 0\n", "")), "line 7: a facet that does not have three vertices"),
        (solid(&facet.replace("vertex 1 0 0", "vertex 1 0")), "a vertex that is not three numbers"),
        (solid(&facet.replace("vertex 1 0 0", "vertex 1e39 0 0")), "line 5: a vertex that is not finite"),
        (solid(&facet.replace("outer loop", "inner loop")), "\"inner\" is no word"),
        (solid("vertex 0 0 0\nfacet\n"), "not in a facet"),
        (solid(&facet.replace("endfacet\n", "")), "three vertices"),
        (format!("solid x\n{}", facet.replace("endfacet\n", "")).into_bytes(), "cut off within a facet"),
        (cut, "cut off: 4 triangles by its header, 2 in the file"),
        (more, "4294967295 triangles by its header"),
        (not_finite, "triangle 1 has a position that is not finite"),
    ] {
        let error = load_alone("m.stl", bytes).expect_err(part).to_string();
        assert!(error.starts_with("m.stl: ") && error.contains(part), "{error}, not {part}");
    }
    let options = LoadOptions { limits: Limits { faces: 3, ..Limits::default() }, ..LoadOptions::default() };
    for bytes in [text("0 0 0").into_bytes(), binary("", [0.0; 3], 0)] {
        let error = load_bytes("m.stl", bytes, &|_| unreachable!("no other file"), &options).unwrap_err();
        assert!(matches!(error, LoadError::TooLarge { what: "faces", count: 4, limit: 3, .. }), "{error}");
    }
}

#[test]
fn bytes_behind_the_last_triangle_are_warned_of() {
    let mut bytes = binary("", [0.0; 3], 0);
    bytes.extend([0; 3]);
    let loaded = load_alone("m.stl", bytes).expect("it loads");
    assert_eq!(warnings(&loaded), ["3 bytes behind the last triangle are passed over"]);
}

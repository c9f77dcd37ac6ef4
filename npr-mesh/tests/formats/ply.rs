//! PLY files.

use crate::{load_alone, warnings};
use glam::{Vec2, Vec3, Vec4};
use npr_mesh::{AlphaMode, Limits, LoadError, LoadOptions, Model, load_bytes};

/// A square and a triangle, with everything that a vertex may have.
fn text() -> String {
    "ply\nformat ascii 1.0\ncomment made by hand\nobj_info x\nelement vertex 5\nproperty float x\nproperty float y\n\
     property double z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n\
     property uchar green\nproperty uchar blue\nproperty uchar alpha\nproperty float s\nproperty float t\n\
     property short quality\nelement face 2\nproperty uchar flags\nproperty list uchar int vertex_indices\n\
     element edge 2\nproperty int vertex1\nproperty int vertex2\nelement other 2\nproperty list uchar float more\nend_header\n\
     0 0 0 0 0 1 255 0 0 255 0 0 7\n1 0 0 0 0 1 0 255 0 255 1 0 7\n1 1 0 0 0 1 0 0 255 255 1 1 7\n\
     0 1 0 0 0 1 255 255 255 255 0 1 7\n0.5 2 0 0 0 1 128 128 128 255 0.5 0.5 7\n\
     0 4 0 1 2 3\n1 3 3 2 4\n0 4\n4 1\n1 0.5\n0\n"
        .to_owned()
}

/// The same in a binary form.
fn binary(big: bool) -> Vec<u8> {
    let text = text();
    let (header, body) = text.split_once("end_header\n").unwrap();
    let name = if big { "binary_big_endian" } else { "binary_little_endian" };
    let mut bytes = (header.replace("ascii", name) + "end_header\n").into_bytes();
    let mut words = body.split_whitespace();
    let mut put = |number: &str, kind: &str| {
        let mut little: Vec<u8> = match kind {
            "uchar" => vec![number.parse::<u8>().unwrap()],
            "short" => number.parse::<i16>().unwrap().to_le_bytes().to_vec(),
            "int" => number.parse::<i32>().unwrap().to_le_bytes().to_vec(),
            "float" => number.parse::<f32>().unwrap().to_le_bytes().to_vec(),
            _ => number.parse::<f64>().unwrap().to_le_bytes().to_vec(),
        };
        if big {
            little.reverse();
        }
        bytes.extend(little);
    };
    let elements = header.split("element ").skip(1);
    for element in elements {
        let mut lines = element.lines();
        let count: usize = lines.next().unwrap().split(' ').nth(1).unwrap().parse().unwrap();
        let properties: Vec<Vec<&str>> = lines.map(|line| line.split(' ').collect()).collect();
        for _ in 0..count {
            for property in &properties {
                let first = words.next().unwrap();
                if property[1] == "list" {
                    put(first, property[2]);
                    (0..first.parse().unwrap()).for_each(|_| put(words.next().unwrap(), property[3]));
                } else {
                    put(first, property[1]);
                }
            }
        }
    }
    bytes
}

fn model(bytes: impl Into<Vec<u8>>) -> Model {
    let loaded = load_alone("m.ply", bytes).expect("it loads");
    assert_eq!(warnings(&loaded), [""; 0]);
    loaded.into_model()
}

#[test]
fn vertices_faces_and_edges() {
    let model = model(text());
    assert_eq!(model.positions[4], Vec3::new(0.5, 2.0, 0.0));
    assert_eq!(model.normals, [Vec3::Z; 5]);
    assert_eq!(model.uvs[1], Vec2::new(1.0, 1.0), "t runs upwards");
    assert_eq!(model.faces, [[0, 1, 2], [0, 2, 3], [3, 2, 4]]);
    assert_eq!(model.face_polygon, [0, 0, 1]);
    assert_eq!(model.lines, [[0, 4], [4, 1]]);
    assert_eq!(model.colors[..2], [Vec4::new(1.0, 0.0, 0.0, 1.0), Vec4::new(0.0, 1.0, 0.0, 1.0)]);
    assert!((model.colors[4].x - 0.2159).abs() < 1e-4, "sRGB-encoded");
    assert_eq!((model.materials[0].base_color, model.materials[0].alpha_mode), (Vec4::ONE, AlphaMode::Opaque));
}

#[test]
fn the_encodings_are_equal() {
    let ascii = model(text());
    assert_eq!(model(binary(false)), ascii);
    assert_eq!(model(binary(true)), ascii);
    assert_eq!(model(text().replace('\n', "\r\n")), ascii);
    assert_eq!(model(text().replace("0 4 0 1 2 3", "0\n4 0 1\n2 3")), ascii, "a list on several lines");
    assert_eq!(model(text().replace("0.5 2 0", "+.5 2. 0e0")), ascii);
}

#[test]
fn colors_and_coordinates_by_other_names_and_types() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                property float red\nproperty float green\nproperty float blue\nproperty ushort alpha\n\
                property float texture_u\nproperty float texture_v\n\
                element face 1\nproperty list uint8 uint32 vertex_index\nend_header\n\
                0 0 0 1 0 0 65535 0 0\n1 0 0 1 0 0 32768 1 0\n0 1 0 1 0 0 0 0 1\n3 0 1 2\n";
    let model = model(text);
    assert_eq!(model.colors[0], Vec4::new(1.0, 0.0, 0.0, 1.0));
    assert_eq!((model.colors[2].w, model.materials[0].alpha_mode), (0.0, AlphaMode::Blend));
    assert_eq!(model.uvs, [Vec2::new(0.0, 1.0), Vec2::new(1.0, 1.0), Vec2::new(0.0, 0.0)]);
}

#[test]
fn strips_are_triangles() {
    let text = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
                element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
                0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 4 -1 0 1 2\n";
    assert_eq!(model(text).faces, [[0, 1, 2], [2, 1, 3], [2, 3, 4], [0, 1, 2]]);
}

fn small(vertices: &str, faces: &str, body: &str) -> Result<Model, String> {
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {faces}\nproperty list uchar int vertex_indices\nend_header\n{body}"
    );
    load_alone("m.ply", text).map(|loaded| loaded.into_model()).map_err(|error| error.to_string())
}

#[test]
fn faults_are_named() {
    let square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    for (vertices, faces, body, part) in [
        ("4", "0", square.to_owned(), "a point cloud: 4 vertices"),
        ("4", "1", format!("{square}3 0 1 4\n"), "a face uses vertex 4, and there are 4"),
        ("4", "1", format!("{square}3 0 1 -1\n"), "\"face\" 0: -1 is no vertex"),
        ("4", "1", format!("{square}3 0 1 1.5\n"), "1.5 is no vertex"),
        ("4", "1", format!("{square}3 0 1\n"), "\"face\" 0: cut off"),
        ("4", "1", format!("{square}-1 0 1\n"), "a list whose length"),
        ("4", "1", format!("{square}99999 0 1\n"), "a list whose length"),
        ("4", "1", format!("{square}3 0 x 1\n"), "a word that is no number"),
        ("4", "1", square.replace("1 1 0", "nan 1 0") + "3 0 1 2\n", "vertex 2 is not finite"),
        ("4", "1", square.replace("1 1 0", "1e39 1 0") + "3 0 1 2\n", "vertex 2 is not finite"),
        ("4000000000", "1", format!("{square}3 0 1 2\n"), "4000000000 vertices, more than the limit"),
        ("18446744073709551615", "1", square.to_owned(), "more than the limit"),
        ("90000000", "1", square.to_owned(), "cut off: 90000000 \"vertex\" by its header"),
        ("4", "4000000000", format!("{square}3 0 1 2\n"), "4000000000 faces, more than the limit"),
        ("4", "40000000", format!("{square}3 0 1 2\n"), "cut off: 40000000 \"face\""),
        ("99999999999999999999", "1", square.to_owned(), "line 3"),
    ] {
        let fault = small(vertices, faces, &body).expect_err(part);
        assert!(fault.starts_with("m.ply: ") && fault.contains(part), "{fault}");
    }
    let unused = small("5", "1", "0 0 0\n1 0 0\n1 1 0\n0 1 0\nnan inf 0\n3 0 1 2\n").expect("an unused vertex");
    assert!(unused.positions.iter().all(|p| p.is_finite()));
    let short = small("3", "2", "0 0 0\n1 0 0\n1 1 0\n2 0 1\n3 0 1 2\n").expect("it loads");
    assert_eq!(short.faces.len(), 1);
}

#[test]
fn headers_that_ask_for_much_get_nothing() {
    let header = |elements: &str| format!("ply\nformat binary_little_endian 1.0\n{elements}end_header\n");
    for (elements, part) in [
        ("element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n", "4000000000 vertices"),
        ("element junk 18446744073709551615\nproperty double a\n", "cut off"),
        ("element junk 18446744073709551615\n", "no triangle"),
        ("element face 4000000000\n", "faces"),
        ("element face 40000000\n", "no triangle"),
        ("element tristrips 18446744073709551615\n", "no triangle"),
        ("element edge 40000000\n", "no triangle"),
        ("element junk 1\nproperty list uint double a\n", "cut off"),
        ("element vertex 0\nproperty float x\n", "without x, y and z"),
    ] {
        let error = load_alone("m.ply", header(elements)).expect_err(part).to_string();
        assert!(error.contains(part), "{elements}: {error}");
    }
    let list = [header("element junk 1\nproperty list uint double a\n").as_bytes(), &[255; 8]].concat();
    assert!(load_alone("m.ply", list).is_err());
    let options = LoadOptions { limits: Limits { vertices: 4, ..Limits::default() }, ..LoadOptions::default() };
    let error = load_bytes("m.ply", text().into(), &|_| unreachable!("no other file"), &options).unwrap_err();
    assert!(matches!(error, LoadError::TooLarge { what: "vertices", count: 5, limit: 4, .. }), "{error}");
}

#[test]
fn what_is_skipped_and_would_be_missed_is_warned_of() {
    let text = "ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 3\nproperty float x\nproperty float y\n\
                property float z\nelement face 1\nproperty list uchar int vertex_indices\nproperty uchar red\n\
                property list uchar float texcoord\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 6 0 0 1 0 0 1\n";
    assert_eq!(warnings(&load_alone("m.ply", text).expect("it loads")).len(), 3);
}

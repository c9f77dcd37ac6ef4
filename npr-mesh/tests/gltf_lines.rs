//! glTF: primitives of lines, and the edges of `EXT_mesh_primitive_edge_visibility`.
#![cfg(feature = "gltf")]

mod glb;

use glam::Vec3;
use glb::Document;
use npr_mesh::edges::{self, EdgeKind};
use npr_mesh::{Limits, LoadError, Loaded, Model, SideVisibility, edge_visibility};
use serde_json::{Value, json};

const PENTAGON: [[f32; 3]; 5] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 1.0, 0.0], [1.0, 2.0, 0.0], [-1.0, 1.0, 0.0]];

/// The ends of the lines.
fn lines(model: &Model) -> Vec<[Vec3; 2]> {
    model.lines.iter().map(|line| line.map(|vertex| model.positions[vertex as usize])).collect()
}

fn told(loaded: &Loaded) -> Vec<String> {
    loaded.warnings.iter().map(ToString::to_string).collect()
}

/// A primitive of lines along the corners of the pentagon.
fn primitive(document: &mut Document, mode: u32, ends: Option<&[u8]>) -> Value {
    let mut primitive = json!({"attributes": {"POSITION": document.vec3s(&PENTAGON)}, "mode": mode});
    if let Some(ends) = ends {
        primitive["indices"] = document.bytes(ends).into();
    }
    primitive
}

#[test]
fn all_modes_of_lines_with_and_without_indices() {
    let all = [
        (1, [0, 2, 2, 4], vec![[0, 2], [2, 4]]),
        (2, [0, 2, 4, 1], vec![[0, 2], [2, 4], [4, 1], [1, 0]]),
        (3, [0, 2, 4, 1], vec![[0, 2], [2, 4], [4, 1]]),
    ];
    let at = |vertex: usize| Vec3::from_array(PENTAGON[vertex]);
    for (mode, ends, expected) in all {
        let mut document = Document::default();
        let lines_only = primitive(&mut document, mode, Some(&ends));
        let model = document.load(json!([lines_only])).unwrap();
        assert_eq!((told(&model), model.meshes[0].faces.len()), (vec![], 0));
        let expected: Vec<_> = expected.iter().map(|line| line.map(at)).collect();
        assert_eq!(lines(&model.into_model()), expected, "mode {mode}");
    }
    // Without indices the ends are the vertices in their order; LINES leave the fifth over.
    let around = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 0]].map(|line| line.map(at));
    let expected = [(1, vec![around[0], around[2]]), (2, around.to_vec()), (3, around[..4].to_vec())];
    for (mode, expected) in expected {
        let mut document = Document::default();
        let lines_only = primitive(&mut document, mode, None);
        let loaded = document.load(json!([lines_only])).unwrap();
        let warned = mode == 1;
        let warning = "mesh 0 primitive 0: 5 ends, which are no whole number of lines".to_owned();
        assert_eq!(told(&loaded), if warned { vec![warning] } else { vec![] });
        assert_eq!(lines(&loaded.into_model()), expected, "mode {mode}");
    }
}

#[test]
fn a_loop_of_two_ends_runs_there_and_back_and_one_end_makes_no_line() {
    let mut document = Document::default();
    let two = primitive(&mut document, 2, Some(&[0, 1]));
    assert_eq!(document.load(json!([two])).unwrap().meshes[0].lines, [[0, 1], [1, 0]]);
    for mode in 1..=3 {
        let mut document = Document::default();
        let one = primitive(&mut document, mode, Some(&[0]));
        assert!(matches!(document.load(json!([one])), Err(LoadError::Empty { .. })));
    }
}

#[test]
fn lines_follow_nodes_morph_targets_and_skins_and_stand_beside_triangles() {
    let mut document = Document::default();
    let mut morphed = primitive(&mut document, 3, Some(&[0, 1, 2]));
    let displaced = document.vec3s(&[[0.0, 0.0, 4.0]; 5]);
    morphed["targets"] = json!([{"POSITION": displaced}]);
    let triangles = primitive(&mut document, 4, Some(&[0, 1, 2]));
    document.rest = json!({
        "meshes": [{"primitives": [triangles, morphed], "weights": [0.5]}],
        "nodes": [{"mesh": 0, "translation": [10, 0, 0]}, {"mesh": 0, "scale": [-1, 1, 1], "weights": [0]}],
    });
    let model = document.load_whole().unwrap().into_model();
    assert_eq!(model.faces.len(), 2);
    let moved = |vertex: usize| Vec3::from_array(PENTAGON[vertex]) + Vec3::new(10.0, 0.0, 2.0);
    let mirrored = |vertex: usize| Vec3::from_array(PENTAGON[vertex]) * Vec3::new(-1.0, 1.0, 1.0);
    let expected = [[moved(0), moved(1)], [moved(1), moved(2)], [mirrored(0), mirrored(1)], [mirrored(1), mirrored(2)]];
    assert_eq!(lines(&model), expected);

    let mut document = Document::default();
    let mut skinned = primitive(&mut document, 3, Some(&[0, 1]));
    skinned["attributes"]["JOINTS_0"] = document.vec4_bytes(&[[0, 0, 0, 0]; 5]).into();
    skinned["attributes"]["WEIGHTS_0"] = document.vec4s(&[[1.0, 0.0, 0.0, 0.0]; 5]).into();
    document.rest = json!({
        "meshes": [{"primitives": [skinned]}],
        "nodes": [{"mesh": 0, "skin": 0}, {"translation": [0, 7, 0]}],
        "skins": [{"joints": [1]}],
    });
    let model = document.load_whole().unwrap().into_model();
    assert_eq!(lines(&model), [[Vec3::new(0.0, 7.0, 0.0), Vec3::new(2.0, 7.0, 0.0)]]);
}

#[test]
fn colours_of_lines_are_warned_of_once_and_faults_of_lines_are_errors() {
    let mut document = Document::default();
    let mut colored = primitive(&mut document, 3, None);
    colored["material"] = json!(0);
    document.rest =
        json!({"materials": [{}], "meshes": [{"primitives": [colored.clone(), colored]}], "nodes": [{"mesh": 0}]});
    let loaded = document.load_whole().unwrap();
    assert_eq!(told(&loaded), ["colours of lines are ignored: lines have the style's ink (2 times)"]);

    let fails = |document: &Document, primitives: Value, text: &str| {
        let error = document.load(primitives).expect_err("it is faulty").to_string();
        assert!(error.contains(text), "{error}");
    };
    let mut document = Document::default();
    let beyond = primitive(&mut document, 1, Some(&[0, 5]));
    fails(&document, json!([beyond]), "element 1: vertex 5 of 5");
    let mut document = Document::default();
    let positions = document.vec3s(&[[0.0; 3], [f32::NAN; 3]]);
    fails(&document, json!([{"attributes": {"POSITION": positions}, "mode": 1}]), "vertex 1 is not finite");
    let mut document = Document::default();
    let many = primitive(&mut document, 2, None);
    document.limits = Limits { faces: 4, ..Limits::default() };
    fails(&document, json!([many]), "5 lines, more than the limit of 4");
}

/// Two triangles of a square with their sides' classes.
fn square(document: &mut Document, edges: Value) -> Value {
    let positions = document.vec3s(&[[0.0, 1.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
    let indices = document.bytes(&[0, 1, 2, 0, 2, 3]);
    json!({
        "attributes": {"POSITION": positions}, "indices": indices,
        "extensions": {"EXT_mesh_primitive_edge_visibility": edges},
    })
}

use SideVisibility::{Hard, Hidden, RepeatedHard, Silhouette, Unstated};

/// The two examples of the extension's text: [2,0,1, 0,2,0] is the bytes 18, 2 and [2,0,2, 3,2,0] is 226, 2.
#[test]
fn the_examples_of_the_extension() {
    let examples = [
        ([18, 2], [[Hard, Hidden, Silhouette], [Hidden, Hard, Hidden]], Silhouette),
        ([226, 2], [[Hard, Hidden, Hard], [RepeatedHard, Hard, Hidden]], Hard),
    ];
    for (bytes, expected, diagonal) in examples {
        let mut document = Document::default();
        let visibility = document.bytes(&bytes);
        let mut edges = json!({"visibility": visibility});
        if diagonal == Silhouette {
            edges["silhouetteNormals"] = document.vec3s(&[[0.0, 0.0, 1.0]; 2]).into();
        }
        let primitive = square(&mut document, edges);
        let loaded = document.load(json!([primitive])).unwrap();
        assert_eq!(told(&loaded), ["no normals: they are made from the faces"]);
        let model = loaded.into_model();
        assert_eq!(model.side_visibility, expected);
        let found = edges::find(&model.positions, &model.faces, &[], &[], &Default::default());
        for (edge, class) in found.edges.iter().zip(edge_visibility(&model, &found)) {
            let is_vertical = [[0, 1], [1, 0], [2, 3], [3, 2]].contains(&edge.ends);
            let expected = match edge.kind() {
                EdgeKind::TwoFace => diagonal,
                _ if is_vertical => Hard,
                _ => Hidden,
            };
            assert_eq!(class, expected, "{edge:?}");
        }
    }
}

#[test]
fn sides_follow_mirrored_nodes_fans_strips_and_other_primitives() {
    let mut document = Document::default();
    let visibility = document.bytes(&[226, 2]);
    let stated = square(&mut document, json!({"visibility": visibility}));
    let mut silent = stated.clone();
    silent.as_object_mut().unwrap().remove("extensions");
    document.rest = json!({
        "meshes": [{"primitives": [silent, stated]}],
        "nodes": [{"mesh": 0, "scale": [-1, 1, 1]}],
    });
    let model = document.load_whole().unwrap().into_model();
    assert_eq!(
        model.side_visibility,
        [[Unstated; 3], [Unstated; 3], [Hard, Hidden, Hard], [Hidden, Hard, RepeatedHard]]
    );
    // The hard sides are the vertical ones and the diagonal, whatever corner comes first.
    for (face, sides) in model.faces.iter().zip(&model.side_visibility).skip(2) {
        for (side, class) in sides.iter().enumerate() {
            let [a, b] = [side, (side + 1) % 3].map(|corner| model.positions[face[corner] as usize]);
            assert_eq!(*class == Hidden, a.y == b.y, "{a} {b}");
        }
    }
    // A strip 0 1 2 3 is the triangles 0 1 2 and 1 3 2, and a fan 1 2 0 and 2 3 0.
    for (mode, faces) in [(5, [[0, 1, 2], [1, 3, 2]]), (6, [[1, 2, 0], [2, 3, 0]])] {
        let mut document = Document::default();
        let visibility = document.bytes(&[0b00_01_10, 0]);
        let mut primitive = square(&mut document, json!({"visibility": visibility}));
        (primitive["mode"], primitive["indices"]) = (json!(mode), document.bytes(&[0, 1, 2, 3]).into());
        let model = document.load(json!([primitive])).unwrap().into_model();
        // Vertices may have been split for their normals.
        let at = |vertex: u32| model.positions[vertex as usize].truncate().to_array();
        let corners = [[0.0, 1.0], [0.0; 2], [1.0, 0.0], [1.0; 2]];
        let found: Vec<_> = model.faces.iter().map(|face| face.map(at)).collect();
        assert_eq!(found, faces.map(|face| face.map(|vertex| corners[vertex])));
        assert_eq!(model.side_visibility[0], [Hard, Silhouette, Hidden]);
    }
}

#[test]
fn line_strings_are_lines() {
    let mut document = Document::default();
    let (both, one) = (document.bytes(&[0, 1, 2, 255, 3, 0]), document.bytes(&[2, 3]));
    let edges = json!({"lineStrings": [{"indices": both}, {"indices": one, "material": 0}]});
    let primitive = square(&mut document, edges);
    let loaded = document.load(json!([primitive])).unwrap();
    assert!(told(&loaded)[0].contains("materials of EXT_mesh_primitive_edge_visibility are ignored"), "{loaded:?}");
    let model = loaded.into_model();
    assert_eq!((model.lines, model.side_visibility), (vec![[0, 1], [1, 2], [3, 0], [2, 3]], vec![]));
}

#[test]
fn faulty_edges_are_errors_that_name_them() {
    let fault = |bytes: &[u8], edges: fn(usize) -> Value| {
        let mut document = Document::default();
        let accessor = document.bytes(bytes);
        let primitive = square(&mut document, edges(accessor));
        document.load(json!([primitive])).expect_err("it is faulty").to_string()
    };
    let visibility = |accessor| json!({"visibility": accessor});
    let strings = |accessor| json!({"lineStrings": [{"indices": accessor}]});
    type Fault<'a> = (&'a [u8], fn(usize) -> Value, &'a str);
    let all: [Fault<'_>; 9] = [
        (&[0], visibility, "visibility: accessor 0: 1 bytes for 2 triangles, expected 2"),
        (&[0; 3], visibility, "visibility: accessor 0: 3 bytes for 2 triangles, expected 2"),
        (&[0; 2], |_| json!({"visibility": 9}), "accessor 9 does not exist"),
        (&[0; 2], |_| json!({"visibility": "a"}), "visibility is not the number of an accessor"),
        (&[0; 2], |_| json!({}), "neither visibility nor lineStrings"),
        (&[0; 2], |_| json!([1]), "not an object"),
        (&[0, 1, 4], strings, "element 2: vertex 4 of 4"),
        (&[0, 255, 1, 2], strings, "a line string of less than two vertices"),
        (&[0, 1, 255], strings, "a line string of less than two vertices"),
    ];
    for (bytes, edges, text) in all {
        let found = fault(bytes, edges);
        assert!(found.contains(text) && found.contains("EXT_mesh_primitive_edge_visibility"), "{found}, not {text}");
    }
    // A wrong number of normals is no reason to refuse a file, since they are not used.
    let mut document = Document::default();
    let (visibility, normals) = (document.bytes(&[18, 2]), document.vec3s(&[[0.0, 0.0, 1.0]]));
    let primitive = square(&mut document, json!({"visibility": visibility, "silhouetteNormals": normals}));
    assert!(told(&document.load(json!([primitive])).unwrap())[0].contains("1 normals for 1 silhouettes"));
}

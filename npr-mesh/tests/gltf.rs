//! glTF: small generated files, invalid files, and the shared test models if available.
#![allow(clippy::print_stdout)]
#![cfg(feature = "gltf")]

use glam::{DAffine3, DVec3, Quat, Vec2, Vec3, Vec4, dvec3};
use npr_mesh::{AlphaMode, Limits, LoadError, LoadOptions, Loaded, Model, Wrap, load};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// A temporary folder, which is removed when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("npr-mesh-gltf-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Accessors, each with its own buffer view, and their bytes.
#[derive(Default)]
struct Doc {
    bin: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl Doc {
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let (offset, length) = (self.bin.len(), bytes.len());
        self.views.push(format!(r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{length}}}"#));
        self.bin.extend_from_slice(bytes);
        self.views.len() - 1
    }

    fn accessor(&mut self, json: String) -> usize {
        self.accessors.push(json);
        self.accessors.len() - 1
    }

    fn floats(&mut self, kind: &str, lanes: usize, values: &[f32]) -> usize {
        let view = self.view(&values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<_>>());
        let count = values.len() / lanes;
        self.accessor(format!(r#"{{"bufferView":{view},"componentType":5126,"type":"{kind}","count":{count}}}"#))
    }

    fn vec3s(&mut self, values: &[[f32; 3]]) -> usize {
        self.floats("VEC3", 3, values.as_flattened())
    }

    fn bytes(&mut self, kind: &str, lanes: usize, more: &str, values: &[u8]) -> usize {
        let (view, count) = (self.view(values), values.len() / lanes);
        self.accessor(format!(r#"{{"bufferView":{view},"componentType":5121,"type":"{kind}","count":{count}{more}}}"#))
    }

    fn indices(&mut self, values: &[u8]) -> usize {
        self.bytes("SCALAR", 1, "", values)
    }

    fn json(&self, uri: &str, rest: &str) -> String {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{}{uri}}}],"bufferViews":[{}],"accessors":[{}],{rest}}}"#,
            self.bin.len(),
            self.views.join(","),
            self.accessors.join(",")
        )
    }

    fn load(&self, rest: &str) -> Result<Loaded, LoadError> {
        load_bytes("m.glb", &glb(&self.json("", rest), &self.bin))
    }

    /// A file with one mesh in one node.
    fn mesh(&self, primitive: &str, node: &str, rest: &str) -> Result<Loaded, LoadError> {
        self.load(&format!(
            r#""meshes":[{{"primitives":[{{{primitive}}}]}}],"nodes":[{{"mesh":0{node}}}],"scenes":[{{"nodes":[0]}}],"scene":0{rest}"#
        ))
    }
}

fn glb(json: &str, bin: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, bin) = (padded(json.as_bytes(), b' '), padded(bin, 0));
    let word = |n: usize| (n as u32).to_le_bytes();
    let mut file = [&b"glTF"[..], &word(2), &word(28 + json.len() + bin.len())].concat();
    file.extend([&word(json.len())[..], b"JSON", &json, &word(bin.len()), b"BIN\0", &bin].concat());
    file
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for group in bytes.chunks(3) {
        let bits = group.iter().enumerate().fold(0u32, |bits, (i, &b)| bits | u32::from(b) << (16 - 8 * i));
        for i in 0..4 {
            let digit = char::from(DIGITS[(bits >> (18 - 6 * i)) as usize & 63]);
            text.push(if i <= group.len() { digit } else { '=' });
        }
    }
    text
}

fn load_with(name: &str, bytes: &[u8], limits: Limits) -> Result<Loaded, LoadError> {
    let folder = Folder::new();
    load(&folder.write(name, bytes), &LoadOptions { limits, ..LoadOptions::default() })
}

fn load_bytes(name: &str, bytes: &[u8]) -> Result<Loaded, LoadError> {
    load_with(name, bytes, Limits::default())
}

/// By face, since computing normals may split vertices.
fn corners(model: &Model) -> Vec<[Vec3; 3]> {
    model.faces.iter().map(|f| f.map(|v| model.positions[v as usize])).collect()
}

fn assert_corners(model: &Model, expected: &[[[f32; 3]; 3]]) {
    let found = corners(model);
    assert_eq!(found.len(), expected.len());
    for (face, expected) in found.iter().zip(expected) {
        for (p, e) in face.iter().zip(expected) {
            assert!(p.distance(Vec3::from_array(*e)) < 1e-5, "{found:?}, expected {expected:?}");
        }
    }
}

fn signed_volume(model: &Model) -> f32 {
    corners(model).iter().map(|[a, b, c]| a.dot(b.cross(*c)) / 6.0).sum()
}

/// Six sides of two faces each, with outward winding.
fn cube(doc: &mut Doc) -> String {
    let corner = |i: u8| [i & 1, i >> 1 & 1, i >> 2 & 1].map(|b| f32::from(b) * 2.0 - 1.0);
    let positions = doc.vec3s(&(0..8).map(corner).collect::<Vec<_>>());
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]
        .map(|[a, b, c, d]| [a, b, c, a, c, d]);
    let indices = doc.indices(quads.as_flattened());
    format!(r#""attributes":{{"POSITION":{positions}}},"indices":{indices}"#)
}

const TRIANGLE: [[f32; 3]; 3] = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]];
const UP: [[f32; 3]; 3] = [[0., 0., 1.]; 3];

fn triangle(doc: &mut Doc) -> String {
    let (positions, normals) = (doc.vec3s(&TRIANGLE), doc.vec3s(&UP));
    format!(r#""attributes":{{"POSITION":{positions},"NORMAL":{normals}}}"#)
}

#[test]
fn translation_rotation_scale() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let half = 0.5f32.sqrt();
    // A quarter turn about Z; a rotation that is not a unit quaternion is normalised.
    let node = format!(r#","translation":[10,0,0],"rotation":[0,0,{},{}],"scale":[2,3,4]"#, half * 2., half * 2.);
    let loaded = doc.mesh(&primitive, &node, "").unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let model = loaded.into_model();
    assert_corners(&model, &[[[10., 0., 0.], [10., 2., 0.], [7., 0., 0.]]]);
    assert!(model.normals.iter().all(|n| n.distance(Vec3::Z) < 1e-6));
    assert_eq!(model.materials[0].base_color, Vec4::ONE);
    assert!(!model.materials[0].double_sided);
    assert!(model.uvs.is_empty() && model.colors.is_empty());
}

#[test]
fn normals_by_the_inverse_transpose() {
    let mut doc = Doc::default();
    let (positions, normals) = (doc.vec3s(&TRIANGLE), doc.vec3s(&[[0.6, 0.8, 0.]; 3]));
    let primitive = format!(r#""attributes":{{"POSITION":{positions},"NORMAL":{normals}}}"#);
    let model = doc.mesh(&primitive, r#","scale":[2,1,-1]"#, "").unwrap().into_model();
    let expected = Vec3::new(0.3, 0.8, 0.).normalize();
    assert!(model.normals.iter().all(|n| n.distance(expected) < 1e-6), "{:?}", model.normals);
}

#[test]
fn matrices_down_a_chain_of_nodes() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let rest = format!(
        r#""meshes":[{{"primitives":[{{{primitive}}}]}}],
        "nodes":[{{"mesh":0,"translation":[0,0,5]}},{{"children":[0],"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,1,2,3,1]}}]"#
    );
    // Without a scene all root nodes are shown.
    assert_corners(&doc.load(&rest).unwrap().into_model(), &[[[1., 2., 8.], [1., 3., 8.], [0., 2., 8.]]]);
}

#[test]
fn a_deep_chain_and_an_instanced_mesh() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let depth = 50_000;
    let chain: Vec<String> =
        (0..depth).map(|i| format!(r#"{{"children":[{}],"translation":[1,0,0]}}"#, i + 1)).collect();
    let rest = format!(
        r#""meshes":[{{"primitives":[{{{primitive}}}]}}],"scenes":[{{"nodes":[0,{}]}}],"nodes":[{},{{"mesh":0}},{{"mesh":0}}]"#,
        depth + 1,
        chain.join(",")
    );
    let model = doc.load(&rest).unwrap().into_model();
    let faces = corners(&model);
    assert_eq!((faces.len(), model.materials.len()), (2, 1));
    assert_eq!((faces[0][0].x, faces[1][0].x), (depth as f32, 0.0));
    // Two nodes with one mesh of the file are two meshes.
    assert_eq!(model.face_mesh, [0, 1]);
}

/// Meshes of one triangle each, and nodes.
fn triangles(doc: &mut Doc, meshes: usize, nodes: &str) -> Loaded {
    let primitive = triangle(doc);
    let mesh = |number: usize| format!(r#"{{"name":"mesh {number}","primitives":[{{{primitive}}}]}}"#);
    let meshes: Vec<String> = (0..meshes).map(mesh).collect();
    doc.load(&format!(r#""meshes":[{}],"nodes":[{nodes}]"#, meshes.join(","))).unwrap()
}

#[test]
fn two_nodes_place_one_mesh() {
    let loaded = triangles(
        &mut Doc::default(),
        1,
        r#"{"name":"root","translation":[10000000,0,0],"children":[2,1]},
        {"name":"right","mesh":0,"translation":[0.1,0,0],"scale":[2,2,2]},{"name":"","mesh":0,"translation":[-0.1,0,0]}"#,
    );
    assert_eq!((loaded.meshes.len(), loaded.objects.len()), (1, 2));
    // In its own space, and the transforms are more precise than f32: depth first, so node 2 is before node 1.
    assert_corners(&loaded.meshes[0], &[TRIANGLE]);
    let [first, second] = &loaded.objects[..] else { unreachable!() };
    assert_eq!((first.mesh, first.name.as_str()), (0, "mesh 0"));
    assert_eq!(first.world_from_mesh, DAffine3::from_translation(dvec3(1e7 - 0.1, 0., 0.)));
    assert_eq!((second.mesh, second.name.as_str()), (0, "right"));
    let scale = DAffine3::from_scale(DVec3::splat(2.));
    assert_eq!(second.world_from_mesh, DAffine3::from_translation(dvec3(1e7 + 0.1, 0., 0.)) * scale);
}

#[test]
fn a_mirrored_node_has_the_mesh_of_the_others() {
    let loaded = triangles(&mut Doc::default(), 1, r#"{"mesh":0},{"mesh":0,"scale":[-1,1,1]}"#);
    assert_eq!((loaded.meshes.len(), &loaded.meshes[0].faces[..]), (1, &[[0, 1, 2]][..]));
    assert_eq!(loaded.objects[1].world_from_mesh.matrix3.determinant(), -1.);
    let model = loaded.into_model();
    assert_corners(&model, &[TRIANGLE, [[0., 0., 0.], [0., 1., 0.], [-1., 0., 0.]]]);
    assert_eq!((model.normals, model.face_mesh), (vec![Vec3::Z; 6], vec![0, 1]));
}

#[test]
fn a_mesh_of_1000_nodes_is_loaded_once() {
    let nodes = (0..1000).map(|x| format!(r#"{{"mesh":{},"translation":[{x},0,0]}}"#, x % 2)).collect::<Vec<_>>();
    let loaded = triangles(&mut Doc::default(), 2, &nodes.join(","));
    assert_eq!((loaded.meshes.len(), loaded.objects.len()), (2, 1000));
    assert!(loaded.objects.iter().enumerate().all(|(number, object)| object.mesh == number % 2));
    let model = loaded.into_model();
    assert_eq!((model.faces.len(), model.materials.len()), (1000, 1));
    assert_eq!(model.positions[3 * 999].x, 999.);
}

#[test]
fn limits_count_every_node() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let rest = format!(r#""meshes":[{{"primitives":[{{{primitive}}}]}}],"nodes":[{{"mesh":0}},{{"mesh":0}}]"#);
    let file = glb(&doc.json("", &rest), &doc.bin);
    let all = Limits::default();
    assert_fault(load_with("m.glb", &file, Limits { vertices: 5, ..all }), "6 vertices, more than the limit of 5");
    assert_fault(load_with("m.glb", &file, Limits { faces: 1, ..all }), "2 faces, more than the limit of 1");
    assert_fault(load_with("m.glb", &file, Limits { instances: 1, ..all }), "2 primitives, more than the limit of 1");
    assert!(load_with("m.glb", &file, Limits { vertices: 6, faces: 2, instances: 2, ..all }).is_ok());
}

#[test]
fn meshes_without_faces_make_no_object_and_long_names_are_cut() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let long = "ä".repeat(1000);
    let rest = format!(
        r#""meshes":[{{"primitives":[{{{primitive},"mode":0}}]}},{{"primitives":[{{{primitive}}}]}}],
        "nodes":[{{"mesh":0}},{{"mesh":1,"name":"{long}"}},{{"mesh":0}},{{"mesh":1}}]"#
    );
    let loaded = doc.load(&rest).unwrap();
    assert_eq!((loaded.meshes.len(), loaded.objects.len()), (1, 2));
    assert_eq!((loaded.objects[0].name.as_str(), loaded.objects[1].name.as_str()), (&long[..200], ""));
    assert_eq!(told(&loaded), ["mesh 0 primitive 0: Points are left out"]);
}

#[test]
fn singular_nodes_have_normals_in_one_model() {
    let loaded =
        triangles(&mut Doc::default(), 1, r#"{"mesh":0},{"mesh":0,"scale":[1,-1,0]},{"mesh":0,"scale":[0,0,0]}"#);
    assert_eq!(told(&loaded), [""; 0]);
    let model = loaded.into_model();
    assert_eq!(model.faces.len(), 3);
    assert!(model.normals.iter().all(|normal| normal.is_normalized()), "{:?}", model.normals);
}

#[test]
fn mirrored_nodes_keep_their_outside() {
    let mut doc = Doc::default();
    let primitive = cube(&mut doc);
    for (node, volume) in
        [("", 8.), (r#","scale":[-1,1,1]"#, 8.), (r#","scale":[-1,-2,1]"#, 16.), (r#","scale":[-1,-1,-3]"#, 24.)]
    {
        let found = signed_volume(&doc.mesh(&primitive, node, "").unwrap().into_model());
        assert!((found - volume).abs() < 1e-4, "{node}: {found}");
    }
}

#[test]
fn strips_and_fans() {
    let mut doc = Doc::default();
    let zigzag = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 0.], [0., 2., 0.]];
    let positions = doc.vec3s(&zigzag);
    let ring = doc.vec3s(&[[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]]);
    let strip = doc.mesh(&format!(r#""attributes":{{"POSITION":{positions}}},"mode":5"#), "", "").unwrap().into_model();
    let [a, b, c, d, e] = zigzag;
    assert_corners(&strip, &[[a, b, c], [b, d, c], [c, d, e]]);
    let order = doc.indices(&[0, 1, 2, 3]);
    let fan = format!(r#""attributes":{{"POSITION":{ring}}},"mode":6,"indices":{order}"#);
    let fan = doc.mesh(&fan, "", "").unwrap().into_model();
    for model in [strip, fan] {
        assert!(corners(&model).iter().all(|[a, b, c]| (b - a).cross(c - a).z > 0.0));
    }
}

#[test]
fn points_and_lines_are_left_out_with_a_warning() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let rest = format!(
        r#""meshes":[{{"primitives":[{{{primitive}}},{{{primitive},"mode":1}}]}}],"nodes":[{{"mesh":0}},{{"mesh":0}}]"#
    );
    let loaded = doc.load(&rest).unwrap();
    assert_eq!(
        (loaded.meshes[0].faces.len(), loaded.objects.len(), loaded.warnings),
        (1, 2, vec!["mesh 0 primitive 1: Lines are left out".to_owned().into()])
    );
    assert!(matches!(doc.mesh(&format!(r#"{primitive},"mode":0"#), "", ""), Err(LoadError::Empty { .. })));
}

#[test]
fn sparse_accessors_with_and_without_a_base() {
    let mut doc = Doc::default();
    let base = doc.view(&TRIANGLE.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<_>>());
    let indices = doc.view(&[2]);
    let values = doc.view(&[7f32, 8., 9.].iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<_>>());
    let sparse = format!(
        r#""sparse":{{"count":1,"indices":{{"bufferView":{indices},"componentType":5121}},"values":{{"bufferView":{values}}}}}"#
    );
    let common = r#""componentType":5126,"type":"VEC3","count":3"#;
    doc.accessor(format!(r#"{{"bufferView":{base},{common},{sparse}}}"#));
    doc.accessor(format!(r#"{{{common},{sparse}}}"#));
    let model = doc.mesh(r#""attributes":{"POSITION":0}"#, "", "").unwrap().into_model();
    assert_corners(&model, &[[TRIANGLE[0], TRIANGLE[1], [7., 8., 9.]]]);
    let model = doc.mesh(r#""attributes":{"POSITION":1}"#, "", "").unwrap().into_model();
    assert_corners(&model, &[[[0.; 3], [0.; 3], [7., 8., 9.]]]);
}

#[test]
fn strided_and_quantised_positions() {
    let mut doc = Doc::default();
    let bytes: Vec<u8> = [[0i16, 0, 0, -1], [32767, 0, 0, -1], [0, -32768, 0, -1]]
        .as_flattened()
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    doc.view(&bytes[..22]);
    doc.views[0] = doc.views[0].replace('}', r#","byteStride":8}"#);
    doc.accessor(r#"{"bufferView":0,"componentType":5122,"normalized":true,"type":"VEC3","count":3}"#.into());
    let rest = r#","extensionsRequired":["KHR_mesh_quantization"],"extensionsUsed":["KHR_mesh_quantization"]"#;
    let loaded = doc.mesh(r#""attributes":{"POSITION":0}"#, "", rest).unwrap();
    assert_corners(&loaded.meshes[0], &[[[0.; 3], [1., 0., 0.], [0., -1., 0.]]]);
    assert_eq!(told(&loaded), ["no normals: they are made from the faces"]);
    assert_fault(
        doc.mesh(r#""attributes":{"POSITION":0}"#, "", ""),
        "signed 16-bit integers, normalised, and the file",
    );
}

#[test]
fn morph_targets_at_their_default_weights() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let up = doc.vec3s(&[[0., 0., 2.]; 3]);
    let right = doc.vec3s(&[[1., 0., 0.]; 3]);
    let tilt = doc.vec3s(&[[1., 0., 0.]; 3]);
    let mesh = format!(
        r#""meshes":[{{"primitives":[{{{primitive},"targets":[{{"POSITION":{up}}},{{"POSITION":{right},"NORMAL":{tilt}}}]}}],"weights":[0.5,0]}}]"#
    );
    let model = doc.load(&format!(r#"{mesh},"nodes":[{{"mesh":0}}]"#)).unwrap().into_model();
    assert_corners(&model, &[[[0., 0., 1.], [1., 0., 1.], [0., 1., 1.]]]);
    let model = doc.load(&format!(r#"{mesh},"nodes":[{{"mesh":0,"weights":[0,1]}}]"#)).unwrap().into_model();
    assert_corners(&model, &[[[1., 0., 0.], [2., 0., 0.], [1., 1., 0.]]]);
    assert!(model.normals.iter().all(|n| n.distance(Vec3::new(1., 0., 1.).normalize()) < 1e-6));
}

#[test]
fn a_mesh_for_each_pose() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let up = doc.vec3s(&[[0., 0., 2.]; 3]);
    let joints = doc.bytes("VEC4", 4, "", &[0; 12]);
    let weights = doc.floats("VEC4", 4, &[1.; 12]);
    let skinned = primitive
        .replace("\"attributes\":{", &format!("\"attributes\":{{\"JOINTS_0\":{joints},\"WEIGHTS_0\":{weights},"));
    let loaded = doc
        .load(&format!(
            r#""meshes":[{{"primitives":[{{{primitive},"targets":[{{"POSITION":{up}}}]}}],"weights":[0.5]}},{{"primitives":[{{{skinned}}}]}}],
            "skins":[{{"joints":[7]}}],
            "nodes":[{{"mesh":0}},{{"mesh":0,"weights":[1]}},{{"mesh":0,"weights":[0.5],"translation":[1,0,0]}},
            {{"mesh":0,"weights":[1]}},{{"mesh":1,"weights":[1]}},{{"mesh":1,"skin":0,"translation":[9,9,9]}},
            {{"mesh":1,"skin":0}},{{"translation":[0,0,5]}}]"#
        ))
        .unwrap();
    // Equal weights are one mesh, and each skinned node has its own, which is in world space.
    assert_eq!(loaded.objects.iter().map(|object| object.mesh).collect::<Vec<_>>(), [0, 1, 0, 1, 2, 3, 4]);
    let z: Vec<f32> = loaded.meshes.iter().map(|mesh| mesh.positions[0].z).collect();
    assert_eq!(z, [1., 2., 0., 5., 5.]);
    let moved: Vec<_> = loaded.objects.iter().map(|object| object.world_from_mesh.translation.x).collect();
    assert_eq!(moved, [0., 0., 1., 0., 0., 0., 0.]);
}

/// Joint 0 is fixed; joint 1 is at y = 1 and rotated by a quarter turn about Z.
fn skinned(doc: &mut Doc, weights: [[f32; 4]; 3], joint: u8, root: &str) -> Result<Loaded, LoadError> {
    let positions = doc.vec3s(&[[0., 0., 0.], [1., 0., 0.], [0., 2., 0.]]);
    let normals = doc.vec3s(&[[0., 1., 0.]; 3]);
    let joints = doc.bytes("VEC4", 4, "", &[0, joint, 0, 0].repeat(3));
    let weights = doc.floats("VEC4", 4, weights.as_flattened());
    let mut binds = glam::Mat4::IDENTITY.to_cols_array().to_vec();
    binds.extend(glam::Mat4::from_translation(Vec3::NEG_Y).to_cols_array());
    let binds = doc.floats("MAT4", 16, &binds);
    let turn = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2).to_array();
    doc.load(&format!(
        r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions},"NORMAL":{normals},"JOINTS_0":{joints},"WEIGHTS_0":{weights}}}}}]}}],
        "skins":[{{"joints":[1,2],"inverseBindMatrices":{binds}}}],"scenes":[{{"nodes":[0,1]}}],
        "nodes":[{{"mesh":0,"skin":0,"translation":[100,100,100]}},{{"children":[2]{root}}},{{"translation":[0,1,0],"rotation":{turn:?}}}]"#
    ))
}

#[test]
fn a_skin_with_two_joints() {
    let weights = [[1., 0., 0., 0.], [0.5, 0.5, 0., 0.], [0., 1., 0., 0.]];
    // Joint 1 takes (x, y) to (1 - y, 1 + x): (1, 0) to (1, 2) and (0, 2) to (-1, 1).
    let expected = [[[0., 0., 0.], [1., 1., 0.], [-1., 1., 0.]]];
    let model = skinned(&mut Doc::default(), weights, 1, "").unwrap().into_model();
    assert_corners(&model, &expected);
    for (n, e) in model.normals.iter().zip([Vec3::Y, Vec3::new(-1., 1., 0.).normalize(), Vec3::NEG_X]) {
        assert!(n.distance(e) < 1e-6, "{n}, expected {e}");
    }
    // Weights are normalised; without weights a vertex follows its first joint.
    let twice = [[2., 0., 0., 0.], [0.2, 0.2, 0., 0.], [0., 7., 0., 0.]];
    assert_corners(&skinned(&mut Doc::default(), twice, 1, "").unwrap().into_model(), &expected);
    let none = [[0.; 4], [0.5, 0.5, 0., 0.], [0., 1., 0., 0.]];
    assert_corners(&skinned(&mut Doc::default(), none, 1, "").unwrap().into_model(), &expected);
    // A mirrored skeleton reverses the winding.
    let mirrored = skinned(&mut Doc::default(), weights, 1, r#","scale":[-1,1,1]"#).unwrap().into_model();
    assert_corners(&mirrored, &[[[0., 0., 0.], [1., 1., 0.], [-1., 1., 0.]]]);
    let fault = skinned(&mut Doc::default(), weights, 9, "").unwrap_err().to_string();
    assert!(fault.contains("mesh 0 primitive 0: vertex 1: joint 9 of a skin with 2"), "{fault}");
}

#[test]
fn vertex_colours_and_alpha_modes() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let rgba = doc.bytes("VEC4", 4, r#","normalized":true"#, &[255, 0, 51, 255].repeat(3));
    let rgb = doc.floats("VEC3", 3, &[0.25, 0.5, 2.].repeat(3));
    let with = |color: usize, material: &str| {
        let primitive = primitive.replace("\"attributes\":{", &format!("\"attributes\":{{\"COLOR_0\":{color},"));
        doc.mesh(&format!(r#"{primitive},"material":0"#), "", &format!(r#","materials":[{{{material}}}]"#))
            .unwrap()
            .into_model()
    };
    let model = with(rgba, r#""name":"paint","alphaMode":"MASK","doubleSided":true"#);
    assert_eq!(model.colors, [Vec4::new(1., 0., 0.2, 1.); 3]);
    let material = &model.materials[0];
    assert_eq!((material.name.as_str(), material.alpha_mode), ("paint", AlphaMode::Mask { cutoff: 0.5 }));
    assert!(material.double_sided);
    let model = with(rgb, r#""alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4]}"#);
    assert_eq!(model.colors, [Vec4::new(0.25, 0.5, 2., 1.); 3]);
    assert_eq!(model.materials[0].alpha_mode, AlphaMode::Blend);
    assert_eq!(model.materials[0].base_color, Vec4::new(0.1, 0.2, 0.3, 0.4));
    let model = with(rgb, r#""alphaMode":"MASK","alphaCutoff":0.25"#);
    assert_eq!(model.materials[0].alpha_mode, AlphaMode::Mask { cutoff: 0.25 });
}

#[test]
fn optional_arrays_are_filled_up() {
    let mut doc = Doc::default();
    let plain = triangle(&mut doc);
    let uv = doc.floats("VEC2", 2, &[0.5; 6]);
    let colors = doc.floats("VEC4", 4, &[0.5; 12]);
    let full =
        plain.replace("\"attributes\":{", &format!("\"attributes\":{{\"COLOR_0\":{colors},\"TEXCOORD_0\":{uv},"));
    let rest = format!(r#""meshes":[{{"primitives":[{{{plain}}},{{{full}}},{{{plain}}}]}}],"nodes":[{{"mesh":0}}]"#);
    let model = doc.load(&rest).unwrap().into_model();
    let of_three = |a, b, c| [[a; 3], [b; 3], [c; 3]].concat();
    assert_eq!(model.uvs, of_three(Vec2::ZERO, Vec2::splat(0.5), Vec2::ZERO));
    assert_eq!(model.colors, [[Vec4::ONE; 3], [Vec4::splat(0.5); 3], [Vec4::ONE; 3]].concat());
}

/// 2 × 1 texels, red and green.
const PNG: &[u8] = &[
    137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 2, 0, 0, 0, 1, 8, 2, 0, 0, 0, 123, 64, 232,
    221, 0, 0, 0, 15, 73, 68, 65, 84, 120, 156, 99, 248, 207, 192, 192, 240, 159, 1, 0, 7, 255, 1, 255, 1, 127, 137,
    167, 0, 0, 0, 0, 73, 69, 78, 68, 174, 66, 96, 130,
];

#[test]
fn textures_samplers_and_the_texture_transform() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let zeros = doc.floats("VEC2", 2, &[0.; 6]);
    let uv = doc.floats("VEC2", 2, &[0., 0., 1., 0., 0., 1.]);
    let image = doc.view(PNG);
    let primitive =
        primitive.replace("\"attributes\":{", &format!("\"attributes\":{{\"TEXCOORD_0\":{zeros},\"TEXCOORD_1\":{uv},"));
    let material = |texture: usize, more: &str| {
        format!(r#"{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":{texture}{more}}}}}}}"#)
    };
    // The example of the extension: the lower left quadrant, rotated by a quarter turn.
    let turn = r#","extensions":{"KHR_texture_transform":{"offset":[0,1],"rotation":1.57079632679,"scale":[0.5,0.5],"texCoord":1}}"#;
    let materials = [material(0, turn), material(1, ""), material(2, r#","texCoord":1"#)].join(",");
    let primitives = [0, 1, 2].map(|m| format!(r#"{{{primitive},"material":{m}}}"#)).join(",");
    let data = base64(PNG);
    let loaded = doc
        .load(&format!(
            r#""meshes":[{{"primitives":[{primitives}]}}],"nodes":[{{"mesh":0}}],"materials":[{materials}],
            "extensionsRequired":["KHR_texture_transform"],
            "textures":[{{"source":0,"sampler":0}},{{"source":0}},{{"source":1,"sampler":1}}],
            "samplers":[{{"wrapS":33071,"wrapT":33648,"magFilter":9728}},{{"magFilter":9729}}],
            "images":[{{"bufferView":{image},"mimeType":"image/png","name":"two"}},{{"uri":"data:image/png;base64,{data}"}}]"#
        ))
        .unwrap();
    let model = &loaded.meshes[0];
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    assert_eq!(model.materials.iter().map(|m| m.texture).collect::<Vec<_>>(), [Some(0), Some(1), Some(2)]);
    let [first, second, third] = &model.textures[..] else { panic!("{} textures", model.textures.len()) };
    assert_eq!((first.wrap, first.smooth, first.name.as_str()), ([Wrap::Clamp, Wrap::Mirror], false, "two"));
    assert_eq!((second.wrap, second.smooth), ([Wrap::Repeat; 2], true));
    for texture in [first, second, third] {
        assert_eq!((texture.width, texture.height), (2, 1));
        assert_eq!(texture.rgba8[..], [255, 0, 0, 255, 0, 255, 0, 255]);
    }
    let expected = [(0., 1.), (0., 0.5), (0.5, 1.)].map(Vec2::from);
    assert!(model.uvs[..3].iter().zip(expected).all(|(uv, e)| uv.distance(e) < 1e-6), "{:?}", model.uvs);
    assert_eq!(model.uvs[3..6], [Vec2::ZERO; 3]);
    assert_eq!(model.uvs[6..], [Vec2::ZERO, Vec2::X, Vec2::Y]);
}

#[test]
fn meshes_have_their_own_materials_and_share_images() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let image = doc.view(PNG);
    let with = |material: usize| format!(r#"{{{primitive},"material":{material}}}"#);
    let textured = |texture: usize, name: &str| {
        format!(r#"{{"name":"{name}","pbrMetallicRoughness":{{"baseColorTexture":{{"index":{texture}}}}}}}"#)
    };
    let loaded = doc
        .load(&format!(
            r#""meshes":[{{"primitives":[{},{},{},{}]}},{{"primitives":[{},{}]}}],"nodes":[{{"mesh":0}},{{"mesh":1}}],
            "materials":[{},{},{},{{"name":"same"}},{{"name":"same"}}],"textures":[{{"source":0}},{{"source":0,"sampler":0}}],
            "samplers":[{{"wrapS":33071,"wrapT":33071}}],"images":[{{"bufferView":{image}}}]"#,
            with(3),
            with(0),
            with(4),
            with(3),
            with(1),
            with(0),
            textured(0, "a"),
            textured(1, "b"),
            textured(0, "unused")
        ))
        .unwrap();
    let names = |model: &Model| model.materials.iter().map(|m| m.name.clone()).collect::<Vec<_>>();
    let textures = |model: &Model| model.materials.iter().map(|m| m.texture).collect::<Vec<_>>();
    let [first, second] = &loaded.meshes[..] else { panic!("{} meshes", loaded.meshes.len()) };
    assert_eq!(
        (names(first), &first.face_material[..]),
        (vec!["same".into(), "a".into(), "same".into()], &[0, 1, 2, 0][..])
    );
    assert_eq!((names(second), &second.face_material[..]), (vec!["b".into(), "a".into()], &[0, 1][..]));
    assert_eq!((textures(first), textures(second)), (vec![None, Some(0), None], vec![Some(0), Some(1)]));
    assert_eq!((first.textures.len(), second.textures.len()), (1, 2));
    // One image, decoded once, whatever the sampler.
    for texture in &second.textures {
        assert!(Arc::ptr_eq(&texture.rgba8, &first.textures[0].rgba8));
    }
    // In one model nothing is there twice, except what is twice in one mesh.
    let model = loaded.into_model();
    assert_eq!(names(&model), ["same", "a", "same", "b"]);
    assert_eq!((textures(&model), model.textures.len()), (vec![None, Some(0), None, Some(1)], 2));
    assert_eq!(model.face_material, [0, 1, 2, 0, 3, 1]);
}

#[test]
fn an_image_that_is_not_there_is_a_warning() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let garbage = doc.view(b"nothing of the kind");
    for image in [
        r#"{"uri":"missing.png"}"#.to_owned(),
        r#"{"uri":"../secret.png"}"#.to_owned(),
        format!(r#"{{"bufferView":{garbage}}}"#),
        "{}".to_owned(),
    ] {
        let rest = format!(
            r#","materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],"textures":[{{"source":0}}],"images":[{image}]"#
        );
        let loaded = doc.mesh(&format!(r#"{primitive},"material":0"#), "", &rest).unwrap();
        assert!(loaded.meshes[0].textures.is_empty() && loaded.meshes[0].materials[0].texture.is_none());
        assert!(loaded.warnings[0].text.starts_with("image 0 is left out: "), "{:?}", loaded.warnings);
    }
}

#[test]
fn buffers_from_data_uris_and_files() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let rest = format!(r#""meshes":[{{"primitives":[{{{primitive}}}]}}],"nodes":[{{"mesh":0}}]"#);
    let uri = format!(r#","uri":"data:application/octet-stream;base64,{}""#, base64(&doc.bin));
    let model = load_bytes("m.gltf", doc.json(&uri, &rest).as_bytes()).unwrap().into_model();
    assert_corners(&model, &[TRIANGLE]);

    let folder = Folder::new();
    folder.write("a b.bin", &doc.bin);
    let json = |uri: &str| doc.json(&format!(r#","uri":"{uri}""#), &rest);
    let model = folder.write("m.gltf", json("a%20b.bin").as_bytes());
    assert_corners(&load(&model, &LoadOptions::default()).unwrap().into_model(), &[TRIANGLE]);
    for (uri, fault) in [
        ("../a b.bin", "leads out of the model's folder"),
        ("sub/%2e%2e/../a b.bin", "leads out of the model's folder"),
        ("/etc/hostname", "leads out of the model's folder"),
        ("file:///etc/hostname", "leads out of the model's folder"),
        ("http://localhost/a.bin", "not a relative path"),
        ("data:;base64,AAA*", "base 64"),
        ("data:;base64,AAAA", "72 bytes stated, 3 there"),
        ("missing.bin", "missing.bin"),
    ] {
        let model = folder.write("m.gltf", json(uri).as_bytes());
        let error = load(&model, &LoadOptions::default()).unwrap_err().to_string();
        assert!(error.contains(fault), "{uri}: {error}");
    }
    folder.write("a b.bin", &doc.bin[1..]);
    let model = folder.write("m.gltf", json("a b.bin").as_bytes());
    let error = load(&model, &LoadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("buffer 0: 72 bytes stated, 71 there"), "{error}");
    let error = load(&folder.0.join("none.glb"), &LoadOptions::default()).unwrap_err();
    assert!(matches!(error, LoadError::Read { .. }), "{error}");
    std::fs::create_dir(folder.0.join("folder.glb")).unwrap();
    let error = load(&folder.0.join("folder.glb"), &LoadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("folder.glb: not a regular file"), "{error}");
}

#[track_caller]
fn told(loaded: &Loaded) -> Vec<String> {
    loaded.warnings.iter().map(ToString::to_string).collect()
}

fn assert_fault(result: Result<Loaded, LoadError>, fault: &str) {
    let error = result.expect_err(fault).to_string();
    assert!(error.contains(fault) && error.contains("m.gl"), "{error}\nexpected: {fault}");
}

#[test]
fn broken_scenes() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let mesh = format!(r#""meshes":[{{"primitives":[{{{primitive}}}]}}]"#);
    for (rest, fault) in [
        (r#""nodes":[{"mesh":0},{"children":[2]},{"children":[1]}]"#, "is its own ancestor"),
        (r#""nodes":[{"mesh":0,"children":[0]}],"scenes":[{"nodes":[0]}]"#, "node 0 is its own ancestor"),
        (r#""nodes":[{"mesh":0},{"children":[0]},{"children":[0]}]"#, "node 0 is a child of node 1 and of node 2"),
        (r#""nodes":[{"mesh":0,"children":[7]}]"#, "node 0: children: node 7 does not exist"),
        (r#""nodes":[{"mesh":0}],"scenes":[{"nodes":[3]}]"#, "scene 0: nodes: node 3 does not exist"),
        (r#""nodes":[{"mesh":0}],"scene":4"#, "scene 4 does not exist"),
        (r#""nodes":[{"mesh":1}]"#, "node 0: mesh: mesh 1 does not exist"),
        (r#""nodes":[{"mesh":0,"skin":1}]"#, "node 0: skin: skin 1 does not exist"),
        (r#""nodes":[{"mesh":0,"skin":0}],"skins":[{"joints":[9]}]"#, "skin 0: joints: node 9 does not exist"),
        (r#""nodes":[{"mesh":0,"skin":0}],"skins":[{"joints":[0]}]"#, "neither JOINTS_0 nor WEIGHTS_0"),
        (r#""nodes":[{"mesh":0,"rotation":[0,0,0,0]}]"#, "node 0: its rotation has no length"),
        (r#""nodes":[{"mesh":0,"scale":[1e38,1,1e38],"translation":[1e39,0,0]}]"#, "vertex 0 is not finite"),
    ] {
        assert_fault(doc.load(&format!("{mesh},{rest}")), fault);
    }
    let limits = Limits { nodes: 1, ..Limits::default() };
    let file = glb(&doc.json("", &format!(r#"{mesh},"nodes":[{{"mesh":0}},{{}}]"#)), &doc.bin);
    assert_fault(load_with("m.glb", &file, limits), "2 nodes, more than the limit of 1");
}

#[test]
fn broken_accessors() {
    let mut doc = Doc::default();
    triangle(&mut doc);
    let float = |more: &str| format!(r#"{{"componentType":5126,"type":"VEC3",{more}}}"#);
    let big = doc.accessor(float(r#""bufferView":0,"count":4000000000"#));
    let zeros = doc.accessor(float(r#""count":4000000000"#));
    let many = doc.accessor(r#"{"componentType":5125,"type":"SCALAR","count":4000000000}"#.into());
    let long = doc.accessor(float(r#""bufferView":0,"count":4"#));
    let late = doc.accessor(float(r#""bufferView":0,"byteOffset":18446744073709551615,"count":3"#));
    doc.accessor(float(r#""bufferView":0,"count":3"#));
    let outside = doc.accessor(float(r#""bufferView":2,"count":3"#));
    doc.views.push(r#"{"buffer":0,"byteOffset":40,"byteLength":36000}"#.into());
    let scalar = doc.floats("SCALAR", 1, &[0.; 3]);
    let four = doc.vec3s(&[[0.; 3]; 4]);
    let indices = doc.indices(&[0, 1, 3]);
    let nan = doc.vec3s(&[[0.; 3], [f32::NAN, 0., 0.], [0., 1., 0.], [1., 0., 0.]]);
    let around_nan = doc.indices(&[0, 2, 3]);
    let unknown = doc.accessor(r#"{"componentType":5130,"type":"VEC3","count":3}"#.into());
    let position = |p: usize| format!(r#""attributes":{{"POSITION":{p}}}"#);
    for (primitive, fault) in [
        (position(big), "POSITION: accessor 2: 4000000000 elements of 12 bytes"),
        (position(zeros), "4000000000 vertices, more than the limit of 100000000"),
        (position(long), "mesh 0 primitive 0: POSITION: accessor 5: 4 elements of 12 bytes every 12 bytes from byte 0"),
        (position(late), "reach beyond buffer view 0, which has 36 bytes"),
        (position(outside), "buffer view 2: 36000 bytes from byte 40 reach beyond buffer 0"),
        (position(12345), "mesh 0 primitive 0: POSITION: accessor 12345 does not exist"),
        (position(scalar), "1 numbers in an element, expected 3"),
        (position(unknown), "unknown component type"),
        (format!(r#"{},"indices":{indices}"#, position(0)), "indices: accessor 11: element 2: vertex 3 of 3"),
        (format!(r#"{},"indices":{many}"#, position(0)), "faces, more than the limit"),
        (format!(r#"{},"indices":0"#, position(0)), "indices: accessor 0: floats are not allowed here"),
        (format!(r#""attributes":{{"POSITION":0,"NORMAL":{four}}}"#), "NORMAL: accessor 10: 4 elements for 3 vertices"),
        (format!(r#"{},"mode":5"#, position(nan)), "mesh 0 primitive 0: the position of vertex 1 is not finite"),
        (format!(r#"{},"material":5"#, position(0)), "mesh 0 primitive 0: material: material 5 does not exist"),
        (format!(r#"{},"mode":9"#, position(0)), "unknown mode"),
    ] {
        assert_fault(doc.mesh(&primitive, "", ""), fault);
    }
    let unused = doc.mesh(&format!(r#"{},"indices":{around_nan}"#, position(nan)), "", "").unwrap().into_model();
    assert!(unused.positions.iter().all(|p| p.is_finite()));
    let limits = Limits { faces: 11, ..Limits::default() };
    let mut doc = Doc::default();
    let rest = format!(r#""meshes":[{{"primitives":[{{{}}}]}}],"nodes":[{{"mesh":0}}]"#, cube(&mut doc));
    let file = glb(&doc.json("", &rest), &doc.bin);
    assert_fault(load_with("m.glb", &file, limits), "12 faces, more than the limit of 11");
    let limits = Limits { file_bytes: 100, ..Limits::default() };
    assert_fault(load_with("m.glb", &file, limits), "more than the limit of 100");
}

#[test]
fn broken_files() {
    let mut doc = Doc::default();
    let primitive = triangle(&mut doc);
    let rest = format!(r#""meshes":[{{"primitives":[{{{primitive}}}]}}],"nodes":[{{"mesh":0}}]"#);
    let json = doc.json("", &rest);
    let whole = glb(&json, &doc.bin);
    assert!(load_bytes("m.glb", &whole).is_ok());
    for length in 0..whole.len() {
        let error = load_bytes("m.glb", &whole[..length]).expect_err("cut off");
        assert!(error.to_string().contains("m.glb: "), "{error}");
    }
    // Random bytes in the header and in place of the JSON.
    for at in 0..28 {
        for value in [0, 1, 11, 0x7F, 0xFF] {
            let mut file = whole.clone();
            file[at] = value;
            let _ = load_bytes("m.glb", &file);
        }
    }
    assert_fault(load_bytes("m.gltf", json.as_bytes()), "buffer view 0: buffer 0: no URI and no binary chunk");
    assert_fault(load_bytes("m.gltf", b"{}"), "not glTF 2.0: it states no version");
    assert_fault(load_bytes("m.gltf", b""), "not glTF 2.0");
    assert_fault(load_bytes("m.gltf", &[0x93; 1000]), "not glTF 2.0");
    assert_fault(load_bytes("m.gltf", &b"[".repeat(100_000)), "not glTF 2.0");
    for (head, fault) in [
        (r#""asset":{"version":"1.0"}"#, "needs glTF 1.0, which is not supported"),
        (r#""asset":{"version":"2.0","minVersion":"2.3"}"#, "needs glTF 2.3, which is not supported"),
        (
            r#""asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"]"#,
            "needs the extension KHR_draco_mesh_compression, which is not supported",
        ),
    ] {
        assert_fault(load_bytes("m.gltf", json.replace(r#""asset":{"version":"2.0"}"#, head).as_bytes()), fault);
    }
    let used = json.replace(r#""asset""#, r#""extensionsUsed":["KHR_materials_ior"],"asset""#);
    let loaded = load_bytes("m.glb", &glb(&used, &doc.bin)).unwrap();
    assert_eq!(told(&loaded), ["the extension KHR_materials_ior is ignored"]);
}

#[allow(clippy::print_stdout, reason = "a skipped test says so")]
fn shared(name: &str) -> Option<PathBuf> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    if !folder.is_dir() {
        println!("skipped {name}: no shared models here");
        return None;
    }
    Some(folder.join(name))
}

fn shared_model(name: &str) -> Option<Model> {
    let loaded = load(&shared(name)?, &LoadOptions::default()).unwrap();
    // One of the models has no normals, and one has faces of zero area; there are no other warnings.
    let told = ["no normals: they are made from the faces", "10419 of 75730 faces have no area"];
    assert!(loaded.warnings.iter().all(|w| told.contains(&w.text.as_str())), "{name}: {:?}", loaded.warnings);
    let model = loaded.into_model();
    assert!(model.faces.iter().flatten().all(|&v| (v as usize) < model.positions.len()));
    assert!(model.positions.iter().all(|p| p.is_finite()));
    assert_eq!((model.normals.len(), model.face_material.len()), (model.positions.len(), model.faces.len()));
    Some(model)
}

#[test]
fn every_shared_model_loads() {
    for (name, vertices, faces) in [
        ("2CylinderEngine.glb", 0, 0),
        ("AlphaBlendModeTest.glb", 137, 61),
        ("Box.glb", 24, 12),
        ("BoxTextured-embedded.gltf", 24, 12),
        ("BoxTextured/BoxTextured.gltf", 24, 12),
        ("BoxVertexColors.glb", 24, 12),
        ("CesiumMan.glb", 3273, 4672),
        ("CesiumMilkTruck.glb", 0, 0),
        ("Duck.glb", 2399, 4212),
        ("Fox.glb", 1728, 576),
        ("TextureSettingsTest.glb", 0, 0),
        ("VertexColorTest.glb", 72, 36),
    ] {
        let Some(model) = shared_model(name) else { return };
        // Where several nodes show one mesh, the total is tested elsewhere.
        if vertices > 0 {
            assert_eq!((model.positions.len(), model.faces.len()), (vertices, faces), "{name}");
        }
        let lengths = model.normals.iter().map(|n| n.length());
        assert!(lengths.into_iter().all(|l| (l - 1.0).abs() < 1e-3), "{name}: normals");
    }
}

fn size(model: &Model) -> Vec3 {
    let (low, high) = model.bounds().unwrap();
    high - low
}

#[test]
fn shared_models_are_as_they_should_be() {
    let Some(truck) = shared_model("CesiumMilkTruck.glb") else { return };
    let wheels = truck.materials.iter().position(|m| m.name == "wheels").unwrap() as u32;
    let of_wheels: Vec<f32> = (truck.faces.iter().zip(&truck.face_material))
        .filter(|(_, m)| **m == wheels)
        .map(|(f, _)| truck.positions[f[0] as usize].x)
        .collect();
    let front = of_wheels.iter().filter(|x| **x > 0.0).count();
    assert_eq!(front * 2, of_wheels.len(), "two axles of one mesh");

    let duck = shared_model("Duck.glb").unwrap();
    assert!(size(&duck).min_element() > 1.0 && size(&duck).max_element() < 2.0, "{}", size(&duck));
    let man = shared_model("CesiumMan.glb").unwrap();
    assert!((1.3..1.7).contains(&size(&man).y), "{}", size(&man));
    assert!(man.bounds().unwrap().0.y.abs() < 0.1, "stands on the ground");
    let fox = shared_model("Fox.glb").unwrap();
    assert!((100.0..200.0).contains(&size(&fox).max_element()), "{}", size(&fox));

    let blend = shared_model("AlphaBlendModeTest.glb").unwrap();
    for cutoff in [0.25, 0.5, 0.75] {
        assert!(blend.materials.iter().any(|m| m.alpha_mode == AlphaMode::Mask { cutoff }), "{cutoff}");
    }
    assert!(blend.materials.iter().any(|m| m.alpha_mode == AlphaMode::Blend));
    let wraps = shared_model("TextureSettingsTest.glb").unwrap();
    for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
        for axis in 0..2 {
            assert!(wraps.textures.iter().any(|t| t.wrap[axis] == wrap), "{wrap:?}");
        }
    }
    assert!(!shared_model("BoxVertexColors.glb").unwrap().colors.is_empty());
}

#[test]
fn the_engine_has_82_nodes() {
    let Some(path) = shared("2CylinderEngine.glb") else { return };
    let with =
        |nodes| load(&path, &LoadOptions { limits: Limits { nodes, ..Limits::default() }, ..Default::default() });
    assert!(with(82).is_ok());
    assert!(matches!(with(81), Err(LoadError::TooLarge { count: 82, .. })));
}

//! glTF 2.0 as JSON and in the binary container.

use crate::case::{Case, Expect, fails, loads};
use crate::doc::{Doc, PRIMITIVE, data_uri, glb_of};
use crate::images::{picture, png_that_says};
use image::ImageFormat;
use serde_json::{Value, json};

pub fn cases() -> Vec<Case> {
    [containers(), documents(), scenes(), accessors(), primitives(), skins(), externals(), materials()]
        .into_iter()
        .flatten()
        .collect()
}

fn containers() -> Vec<Case> {
    let doc = Doc::square();
    let whole = doc.glb();
    let raw = |name: &str, file: &str, bytes: Vec<u8>, expect| Case::new(&format!("gltf-{name}"), file, bytes, expect);
    let patched = |name: &str, at: usize, word: u32, fault: &str| {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        raw(name, "m.glb", bytes, fails(&[fault]))
    };
    let text = doc.text();
    let cut = |length: usize| raw(&format!("glb-cut-{length}"), "m.glb", whole[..length].to_vec(), fails(&["GLB"]));
    let json_length = u32::from_le_bytes(whole[12..16].try_into().expect("four bytes")) as usize;
    vec![
        raw("plain-glb", "m.glb", whole.clone(), loads(2, &[])),
        raw("plain-text", "m.gltf", text.clone().into(), loads(2, &[])),
        raw("text-named-glb", "m.glb", text.clone().into(), loads(2, &[])),
        raw("glb-named-gltf", "m.gltf", whole.clone(), loads(2, &[])),
        raw("upper-case-ending", "M.GLB", whole.clone(), loads(2, &[])),
        raw("byte-order-mark", "m.gltf", format!("\u{feff}{text}").into(), loads(2, &["byte-order mark"])),
        raw(
            "byte-order-mark-in-glb",
            "m.glb",
            glb_of(format!("\u{feff}{}", doc.json).as_bytes(), &doc.bin),
            loads(2, &["byte-order mark"]),
        ),
        raw("utf16", "m.gltf", text.encode_utf16().flat_map(u16::to_le_bytes).collect(), fails(&["not glTF 2.0"])),
        raw("empty", "m.gltf", Vec::new(), fails(&["not glTF 2.0"])),
        raw("zeros", "m.glb", vec![0; 1000], fails(&["not glTF 2.0"])),
        raw("html", "m.gltf", b"<html></html>".to_vec(), fails(&["not glTF 2.0"])),
        raw("trailing-text", "m.gltf", format!("{text} x").into(), fails(&["not glTF 2.0"])),
        raw("cut-text", "m.gltf", text[..text.len() / 2].into(), fails(&["not glTF 2.0"])),
        raw("deep-json", "m.gltf", b"[".repeat(1 << 20), fails(&["not glTF 2.0"])),
        raw(
            "deep-extras",
            "m.gltf",
            text.replacen('{', &format!("{{\"extras\":{}{},", "[".repeat(100), "]".repeat(100)), 1).into(),
            loads(2, &[]),
        ),
        patched("glb-version-1", 4, 1, "GLB version 1"),
        patched("glb-version-3", 4, 3, "GLB version 3"),
        patched("glb-length-0", 8, 0, "GLB length 0"),
        patched("glb-length-11", 8, 11, "GLB length 11"),
        patched("glb-length-12", 8, 12, "GLB without a chunk"),
        patched("glb-length-largest", 8, u32::MAX, "GLB cut off"),
        patched("glb-chunk-largest", 12, u32::MAX, "GLB chunk 0 cut off"),
        patched("glb-chunk-0", 12, 0, "GLB chunk 1 cut off"),
        patched("glb-chunk-kind", 16, 0x004E_4942, "first GLB chunk is not JSON"),
        patched("glb-binary-largest", 20 + json_length, u32::MAX, "GLB chunk 1 cut off"),
        patched("glb-binary-kind", 24 + json_length, 0x5858_5858, "no URI and no binary chunk"),
        patched("glb-magic", 0, 0x4654_4C67, "not glTF 2.0"),
        cut(5),
        cut(11),
        cut(19),
        cut(whole.len() - 1),
        raw("glb-more-behind", "m.glb", [&whole[..], b"tail"].concat(), loads(2, &[])),
    ]
}

fn documents() -> Vec<Case> {
    let square = Doc::square;
    let text = square().text();
    let edited = |name: &str, from: &str, to: &str, expect| {
        assert!(text.contains(from), "{from} in {text}");
        Case::new(&format!("gltf-{name}"), "m.gltf", text.replacen(from, to, 1), expect)
    };
    let set = |name: &str, pointer: &str, value: Value, expect| square().set(pointer, value).case(name, expect);
    let required = |names: &[&str], parts: &[&str]| {
        set(&format!("requires-{}", names.len()), "/extensionsRequired", json!(names), fails(parts))
    };
    vec![
        edited("version-1", "\"2.0\"", "\"1.0\"", fails(&["needs glTF 1.0"])),
        edited("version-3", "\"2.0\"", "\"3.0\"", fails(&["needs glTF 3.0"])),
        edited("version-20", "\"2.0\"", "\"20.0\"", fails(&["needs glTF 20.0"])),
        edited("version-2-1", "\"2.0\"", "\"2.1\"", loads(2, &[])),
        edited("version-text", "\"2.0\"", "\"2.x\"", fails(&["needs glTF 2.x"])),
        edited("version-empty", "\"2.0\"", "\"\"", fails(&["needs glTF"])),
        edited("version-number", "\"2.0\"", "2.0", fails(&["not glTF 2.0", "is a number"])),
        edited("version-number-1", "\"2.0\"", "1.0", fails(&["needs glTF 1.0"])),
        edited("version-long", "\"2.0\"", &format!("\"{}\"", "3".repeat(100_000)), fails(&["needs glTF 333"])),
        set("minimum-version", "/asset/minVersion", json!("2.1"), fails(&["needs glTF 2.1"])),
        set("minimum-version-3", "/asset/minVersion", json!("3.0"), fails(&["needs glTF 3.0"])),
        set("minimum-version-same", "/asset/minVersion", json!("2.0"), loads(2, &[])),
        square().without("/asset").case("no-asset", fails(&["it states no version"])),
        set("asset-without-version", "/asset", json!({}), fails(&["it states no version"])),
        required(&["KHR_draco_mesh_compression"], &["needs the extension KHR_draco_mesh_compression,"]),
        required(
            &["KHR_draco_mesh_compression", "KHR_materials_unlit", "KHR_texture_basisu", "X"],
            &["needs the extensions KHR_draco_mesh_compression, KHR_texture_basisu, X,"],
        ),
        set(
            "uses-unknown",
            "/extensionsUsed",
            json!(["KHR_lights_punctual"]),
            loads(2, &["KHR_lights_punctual is ignored"]),
        ),
        set("uses-known", "/extensionsUsed", json!(["KHR_materials_unlit", "KHR_texture_transform"]), loads(2, &[])),
        set("uses-many", "/extensionsUsed", json!(vec!["X"; 5000]), loads(2, &["X is ignored (5000 times)"])),
        set("null-members", "/nodes/0/skin", json!(null), loads(2, &[])),
        set("null-list", "/cameras", json!(null), loads(2, &[])),
        set("extras-number", "/extras", json!(5), loads(2, &[])),
        set("extras-text", "/nodes/0/extras", json!("text"), loads(2, &[])),
        set("extras-list", "/meshes/0/extras", json!([1, 2]), loads(2, &[])),
        set("name-number", "/nodes/0/name", json!(5), loads(2, &["names are no strings"])),
        edited("whole-number-with-point", "\"count\":4", "\"count\":4.0", loads(2, &["whole numbers"])),
        edited("whole-number-with-exponent", "\"count\":4", "\"count\":4e0", loads(2, &["whole numbers"])),
        edited("fractional-count", "\"count\":4", "\"count\":4.5", fails(&["not glTF 2.0"])),
        edited("negative-count", "\"count\":4", "\"count\":-4", fails(&["not glTF 2.0"])),
        edited("count-1e400", "\"count\":4", "\"count\":1e400", fails(&["not glTF 2.0", "out of range"])),
        edited("duplicate-field", "\"count\":4", "\"count\":4,\"count\":3", fails(&["duplicate field `count`"])),
        edited("nan-in-json", "\"count\":4", "\"count\":NaN", fails(&["not glTF 2.0"])),
        set(
            "animation-without-node",
            "/animations",
            json!([{
                "channels": [{"sampler": 0, "target": {"path": "pointer", "extensions": {}}}],
                "samplers": [{"input": 0, "output": 1}]
            }]),
            loads(2, &[]),
        ),
        set("animation-broken", "/animations", json!("none"), loads(2, &[])),
        set("camera-broken", "/cameras", json!([{"type": 7}]), loads(2, &[])),
        set("bounds-missing-and-wrong", "/accessors/0/min", json!([5, 5]), loads(2, &[])),
        set("unknown-members", "/nodes/0/whatever", json!({"a": [1]}), loads(2, &[])),
        set("meshes-no-list", "/meshes", json!({}), fails(&["not glTF 2.0"])),
    ]
}

fn scenes() -> Vec<Case> {
    let square = Doc::square;
    let nodes = |name: &str, nodes: Value, expect| square().set("/nodes", nodes).case(name, expect);
    let chain = |length: usize| {
        let mut nodes: Vec<Value> = (1..length).map(|i| json!({"children": [i]})).collect();
        nodes.push(json!({"mesh": 0}));
        json!(nodes)
    };
    let fan = json!((0..40).map(|i| json!({"mesh": 0, "children": [(i + 1) % 40, (i + 1) % 40]})).collect::<Vec<_>>());
    vec![
        nodes("cycle-of-one", json!([{"mesh": 0, "children": [0]}]), fails(&["node 0 is its own ancestor"])),
        nodes(
            "cycle-of-two",
            json!([{"children": [1]}, {"mesh": 0, "children": [0]}]),
            fails(&["is its own ancestor"]),
        ),
        nodes(
            "two-parents",
            json!([{"children": [1, 2]}, {"children": [2]}, {"mesh": 0}]),
            fails(&["node 2 is a child"]),
        ),
        nodes("fan-out", fan, fails(&["node 1 is a child of node 0"])),
        nodes("deep-chain", chain(200_000), loads(2, &[])),
        nodes("too-many", json!(vec![json!({}); 1_000_001]), fails(&["1000001 nodes", "1000000"])),
        nodes(
            "missing-child",
            json!([{"mesh": 0, "children": [9]}]),
            fails(&["node 0: children: node 9 does not exist"]),
        ),
        nodes("missing-mesh", json!([{"mesh": 9}]), fails(&["node 0: mesh: mesh 9 does not exist"])),
        nodes("no-mesh", json!([{}]), fails(&["no node of the scene places any of its 1 meshes"])),
        nodes("none", json!([]), fails(&["scene 0: nodes: node 0 does not exist"])),
        nodes("rotation-zero", json!([{"mesh": 0, "rotation": [0, 0, 0, 0]}]), fails(&["node 0", "rotation"])),
        nodes("rotation-long", json!([{"mesh": 0, "rotation": [0, 0, 3e30, 3e30]}]), loads(2, &[])),
        nodes("scale-zero", json!([{"mesh": 0, "scale": [0, 0, 0]}]), loads(2, &[])),
        nodes(
            "scale-zero-once",
            json!([{"children": [1, 2]}, {"mesh": 0, "scale": [1, 0, 1]}, {"mesh": 0}]),
            loads(4, &[]),
        ),
        nodes("scale-mirrored", json!([{"mesh": 0, "scale": [-1, 1, 1]}]), loads(2, &[])),
        nodes("scale-1e-30", json!([{"mesh": 0, "scale": [1e-30, 1e-30, 1e-30]}]), loads(2, &[])),
        nodes("scale-1e30", json!([{"mesh": 0, "scale": [1e30, 1e30, 1e30]}]), loads(2, &[])),
        nodes(
            "scale-too-large",
            json!([{"mesh": 0, "scale": [3e38, 3e38, 1], "translation": [3e38, 0, 0]}]),
            fails(&["vertex 1 is not finite"]),
        ),
        nodes("far-away", json!([{"mesh": 0, "translation": [1e7, 1e7, 1e7]}]), loads(2, &[])),
        nodes(
            "singular-matrix",
            json!([{"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]}]),
            loads(2, &[]),
        ),
        nodes("matrix-too-short", json!([{"mesh": 0, "matrix": [1, 0]}]), fails(&["not glTF 2.0"])),
        square().set("/scene", json!(3)).case("missing-scene", fails(&["scene 3 does not exist"])),
        square().set("/scenes/0", json!({})).case("scene-without-nodes", fails(&["no node of the scene places any"])),
        square().set("/scenes/0/nodes", json!([0, 0])).case("scene-with-a-node-twice", loads(2, &[])),
        square().without("/scenes").without("/scene").case("no-scenes", loads(2, &[])),
    ]
}

fn accessors() -> Vec<Case> {
    let square = Doc::square;
    let set = |name: &str, pointer: &str, value: Value, expect| square().set(pointer, value).case(name, expect);
    let raw_positions = |name: &str, component: u32, kind: &str, expect| {
        let mut doc = square();
        let accessor = doc.add(&[0; 64], json!({"componentType": component, "type": kind, "count": 4}));
        doc.attribute("POSITION", accessor).case(name, expect)
    };
    let with_nan = |unused: bool| {
        let mut doc = square();
        let mut positions = vec![0f32, 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.];
        positions.extend([f32::NAN, f32::INFINITY, 0.]);
        let accessor = doc.floats("VEC3", &positions);
        let doc = doc.attribute("POSITION", accessor).without(&format!("{PRIMITIVE}/attributes/NORMAL"));
        let mut doc = doc.without(&format!("{PRIMITIVE}/attributes/TEXCOORD_0"));
        let indices: [u8; 6] = if unused { [0, 1, 2, 0, 2, 3] } else { [0, 1, 2, 0, 2, 4] };
        let indices = doc.add(&indices, json!({"componentType": 5121, "type": "SCALAR", "count": 6}));
        doc.set(&format!("{PRIMITIVE}/indices"), json!(indices))
    };
    let indices = |name: &str, values: &[u32], expect| {
        let mut doc = square();
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        let accessor = doc.add(&bytes, json!({"componentType": 5125, "type": "SCALAR", "count": values.len()}));
        doc.set(&format!("{PRIMITIVE}/indices"), json!(accessor)).case(name, expect)
    };
    let sparse = |name: &str, count: u64, at: &[u16], expect| {
        let mut doc = square();
        let at: Vec<u8> = at.iter().flat_map(|v| v.to_le_bytes()).collect();
        let (at, values) = (doc.view(&at), doc.view(&[0; 48]));
        let sparse = json!({
            "count": count,
            "indices": {"bufferView": at, "componentType": 5123},
            "values": {"bufferView": values}
        });
        doc.set("/accessors/0/sparse", sparse).case(name, expect)
    };
    let quantized = |name: &str, used: bool, component: u32, normalized: bool, expect| {
        let mut doc = square();
        let values: Vec<u8> = [[0u16, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]]
            .iter()
            .flat_map(|p| p.iter().flat_map(|v| v.to_le_bytes()).chain([0, 0]))
            .collect();
        let accessor =
            doc.add(&values, json!({"componentType": component, "type": "VEC3", "count": 4, "normalized": normalized}));
        let view = doc.json["accessors"][accessor]["bufferView"].clone();
        let doc = doc.attribute("POSITION", accessor).set(&format!("/bufferViews/{view}/byteStride"), json!(8));
        let doc = if used { doc.set("/extensionsUsed", json!(["KHR_mesh_quantization"])) } else { doc };
        doc.case(name, expect)
    };
    let beyond = "reach beyond buffer view";
    vec![
        set("count-0", "/accessors/0/count", json!(0), fails(&["NORMAL: accessor 1: 4 elements for 0 vertices"])),
        set("indices-count-0", "/accessors/2/count", json!(0), fails(&["no triangle"])),
        set("count-5", "/accessors/0/count", json!(5), fails(&["POSITION: accessor 0: 5 elements", beyond])),
        set("count-largest", "/accessors/0/count", json!(u64::MAX), fails(&["accessor 0", beyond])),
        set("indices-count-largest", "/accessors/2/count", json!(u64::MAX), fails(&["accessor 2", beyond])),
        set("indices-truncated", "/accessors/2/count", json!(7), fails(&["indices: accessor 2", beyond])),
        set("offset-largest", "/accessors/0/byteOffset", json!(u64::MAX), fails(&["accessor 0", beyond])),
        set("offset-1", "/accessors/0/byteOffset", json!(4), fails(&["accessor 0", beyond])),
        set("view-missing", "/accessors/0/bufferView", json!(99), fails(&["buffer view 99 does not exist"])),
        set(
            "view-too-long",
            "/bufferViews/0/byteLength",
            json!(100_000),
            fails(&["buffer view 0: 100000 bytes", "beyond buffer 0"]),
        ),
        set(
            "view-offset-largest",
            "/bufferViews/0/byteOffset",
            json!(u64::MAX),
            fails(&["buffer view 0", "beyond buffer 0"]),
        ),
        set("view-without-buffer", "/bufferViews/0/buffer", json!(7), fails(&["buffer 7 does not exist"])),
        set("stride-4", "/bufferViews/0/byteStride", json!(4), fails(&["12 bytes every 4 bytes"])),
        set("stride-0", "/bufferViews/0/byteStride", json!(0), fails(&["12 bytes every 0 bytes"])),
        set("stride-largest", "/bufferViews/0/byteStride", json!(u32::MAX), fails(&["accessor 0", beyond])),
        set("buffer-shorter", "/buffers/0/byteLength", json!(10), fails(&["beyond buffer 0"])),
        set("buffer-longer", "/buffers/0/byteLength", json!(100_000), fails(&["buffer 0: 100000 bytes stated"])),
        set("type-unknown", "/accessors/0/type", json!("VEC5"), fails(&["accessor 0: unknown type"])),
        set("component-unknown", "/accessors/0/componentType", json!(5130), fails(&["accessor 0: unknown component"])),
        set("component-double", "/accessors/0/componentType", json!(5124), fails(&["unknown component"])),
        set(
            "indices-of-floats",
            "/accessors/2/componentType",
            json!(5126),
            fails(&["indices", "floats are not allowed"]),
        ),
        set("indices-signed", "/accessors/2/componentType", json!(5122), fails(&["indices", "signed 16-bit"])),
        set("indices-of-vectors", "/accessors/2/type", json!("VEC2"), fails(&["indices"])),
        set("no-bounds", "/accessors/0/name", json!("no min, no max"), loads(2, &[])),
        raw_positions("positions-vec2", 5126, "VEC2", fails(&["POSITION", "2 numbers in an element, expected 3"])),
        raw_positions("positions-vec4", 5126, "VEC4", fails(&["POSITION", "4 numbers in an element, expected 3"])),
        raw_positions("positions-mat3", 5126, "MAT3", fails(&["POSITION", "matrix"])),
        raw_positions("positions-u32", 5125, "VEC3", fails(&["POSITION", "unsigned 32-bit integers are not allowed"])),
        raw_positions("positions-u16", 5123, "VEC3", fails(&["POSITION", "unsigned 16-bit", "KHR_mesh_quantization"])),
        quantized("quantized-u16", true, 5123, false, loads(2, &[])),
        quantized("quantized-i16", true, 5122, true, loads(2, &[])),
        quantized("quantized-not-declared", false, 5122, true, fails(&["KHR_mesh_quantization"])),
        quantized("quantized-u32", true, 5125, false, fails(&["unsigned 32-bit integers are not allowed"])),
        square()
            .without("/accessors/0/bufferView")
            .case("positions-without-view", loads(2, &["2 of 2 faces have no area"])),
        square().without("/accessors/1/bufferView").case("normals-without-view", loads(2, &[])),
        square().without("/accessors/3/bufferView").case("texture-coordinates-without-view", loads(2, &[])),
        square()
            .without("/accessors/2/bufferView")
            .case("indices-without-view", loads(2, &["2 of 2 faces have no area"])),
        square()
            .without("/accessors/0/bufferView")
            .set("/accessors/0/count", json!(50_000_000))
            .without(&format!("{PRIMITIVE}/attributes/NORMAL"))
            .case("fifty-million-zeros", fails(&["50000000 vertices from a file so small"])),
        square()
            .without("/accessors/2/bufferView")
            .set("/accessors/2/count", json!(90_000_000))
            .case("ninety-million-zero-indices", fails(&["30000000 faces from a file so small"])),
        with_nan(true).case("nan-unused", loads(2, &["1 positions are not finite, and no face uses them"])),
        with_nan(false).case("nan-used", fails(&["the position of vertex 4 is not finite"])),
        indices("index-beyond", &[0, 1, 4], fails(&["element 2: vertex 4 of 4"])),
        indices("index-largest", &[0, 1, u32::MAX], fails(&["vertex 4294967295 of 4"])),
        indices("index-all-same", &[1, 1, 1], loads(1, &["1 of 1 faces have no area"])),
        indices("index-five", &[0, 1, 2, 0, 1], loads(1, &["no whole number of triangles"])),
        indices("index-two", &[0, 1], fails(&["no triangle"])),
        sparse("sparse", 1, &[3], loads(2, &["1 of 2 faces have no area"])),
        sparse("sparse-0", 0, &[], loads(2, &[])),
        sparse("sparse-index-beyond", 1, &[4], fails(&["accessor 0: sparse index 4 of 4"])),
        sparse("sparse-count-beyond", 5, &[0, 1, 2, 3, 4], fails(&["accessor 0: 5 sparse elements of 4"])),
        sparse("sparse-count-largest", u64::MAX, &[0], fails(&["sparse elements"])),
        sparse("sparse-truncated", 2, &[0], fails(&["2 sparse indices", beyond])),
        sparse("sparse-descending", 2, &[3, 1], loads(2, &["2 of 2 faces have no area"])),
    ]
}

fn primitives() -> Vec<Case> {
    let square = Doc::square;
    let prim = |key: &str| format!("{PRIMITIVE}/{key}");
    let mode = |name: &str, mode: Value, expect| square().set(&prim("mode"), mode).case(name, expect);
    let attribute = |name: &str, semantic: &str, kind: &str, values: &[f32], expect| {
        let mut doc = square();
        let accessor = doc.floats(kind, values);
        doc.attribute(semantic, accessor).case(name, expect)
    };
    let target = |name: &str, weights: Value, values: &[f32], expect| {
        let mut doc = square();
        let accessor = doc.floats("VEC3", values);
        doc.set(&prim("targets"), json!([{"POSITION": accessor}])).set("/meshes/0/weights", weights).case(name, expect)
    };
    let both = |other: Value| {
        let doc = square();
        let first = doc.json.pointer(PRIMITIVE).expect("it").clone();
        let mut second = first.clone();
        second["mode"] = other;
        doc.set("/meshes/0/primitives", json!([first, second]))
    };
    vec![
        mode("mode-points", json!(0), fails(&["no triangle in it (mesh 0 primitive 0: Points are left out)"])),
        mode("mode-strip", json!(5), loads(4, &["1 of 4 faces have no area"])),
        mode("mode-fan", json!(6), loads(4, &["faces have no area"])),
        mode("mode-7", json!(7), fails(&["unknown mode"])),
        mode("mode-negative", json!(-1), fails(&["not glTF 2.0"])),
        both(json!(0)).case("points-beside", loads(2, &["Points are left out"])),
        both(json!(1)).case("lines-beside", loads(2, &["Lines are left out"])),
        both(json!(2)).case("line-loop-beside", loads(2, &["LineLoop are left out"])),
        both(json!(3)).case("line-strip-beside", loads(2, &["LineStrip are left out"])),
        square().set("/meshes/0/primitives", json!([])).case("no-primitives", fails(&["no triangle"])),
        square().without("/meshes/0/primitives").case("primitives-missing", fails(&["missing field `primitives`"])),
        square().set(&prim("attributes"), json!({})).case("no-attributes", fails(&["no triangle"])),
        square()
            .set(&prim("attributes/POSITION"), json!(77))
            .case("position-missing", fails(&["accessor 77 does not exist"])),
        square()
            .set(&prim("attributes/NORMAL"), json!(77))
            .case("normal-missing", fails(&["accessor 77 does not exist"])),
        square().set(&prim("indices"), json!(77)).case("indices-missing", fails(&["accessor 77 does not exist"])),
        square()
            .set(&prim("attributes/WHATEVER"), json!(77))
            .case("unknown-attribute", fails(&["mesh 0 primitive 0: attributes: accessor 77 does not exist"])),
        square()
            .set(&prim("attributes/_MINE"), json!(77))
            .case("own-attribute", fails(&["mesh 0 primitive 0: attributes: accessor 77 does not exist"])),
        attribute("normals-short", "NORMAL", "VEC3", &[0.; 9], fails(&["3 elements for 4 vertices"])),
        attribute("normals-zero", "NORMAL", "VEC3", &[0.; 12], loads(2, &[])),
        attribute("normals-nan", "NORMAL", "VEC3", &[f32::NAN; 12], loads(2, &[])),
        attribute("normals-huge", "NORMAL", "VEC3", &[3e38; 12], loads(2, &[])),
        attribute("normals-tiny", "NORMAL", "VEC3", &[1e-45; 12], loads(2, &[])),
        attribute("normals-vec2", "NORMAL", "VEC2", &[0.; 8], fails(&["NORMAL", "expected 3"])),
        attribute(
            "normals-some-zero",
            "NORMAL",
            "VEC3",
            &[0., 0., 0., 0., 0., 1., 0., 0., 1., 0., 0., 1.],
            loads(2, &["1 of 4 vertices have no normal"]),
        ),
        attribute("texture-coordinates-nan", "TEXCOORD_0", "VEC2", &[f32::NAN; 8], loads(2, &[])),
        attribute("texture-coordinates-vec3", "TEXCOORD_0", "VEC3", &[0.; 12], fails(&["TEXCOORD_0", "expected 2"])),
        attribute("colours-nan", "COLOR_0", "VEC3", &[f32::NAN; 12], loads(2, &["4 colours are not finite"])),
        attribute("colours-huge", "COLOR_0", "VEC4", &[3e38; 16], loads(2, &["4 colours are not finite"])),
        attribute("colours-negative", "COLOR_0", "VEC4", &[-1.; 16], loads(2, &["4 colours are not finite"])),
        attribute("colours-bright", "COLOR_0", "VEC3", &[2.; 12], loads(2, &[])),
        attribute("colours-scalar", "COLOR_0", "SCALAR", &[1.; 4], fails(&["COLOR_0"])),
        target("target", json!([0.5]), &[1.; 12], loads(2, &[])),
        target("target-short", json!([0.5]), &[1.; 9], fails(&["morph target 0", "3 elements for 4 vertices"])),
        target("target-short-unused", json!([0]), &[1.; 9], loads(2, &[])),
        target("target-nan", json!([1]), &[f32::NAN; 12], fails(&["is not finite"])),
        target("target-too-large", json!([3e38]), &[3e38; 12], fails(&["is not finite"])),
        target("target-more-weights", json!([0.5, 1, 1]), &[1.; 12], loads(2, &[])),
        square()
            .set(&prim("targets"), json!([{"POSITION": 99}]))
            .set("/meshes/0/weights", json!([1]))
            .case("target-missing", fails(&["accessor 99 does not exist"])),
    ]
}

fn skins() -> Vec<Case> {
    let skinned = |joints: [u8; 16], weights: [f32; 16], skin: Value| {
        let mut doc = Doc::square();
        let joints = doc.add(&joints, json!({"componentType": 5121, "type": "VEC4", "count": 4}));
        let weights = doc.floats("VEC4", &weights);
        doc.attribute("JOINTS_0", joints)
            .attribute("WEIGHTS_0", weights)
            .set("/skins", json!([skin]))
            .set("/nodes", json!([{"mesh": 0, "skin": 0}, {"translation": [0, 0, 1]}]))
    };
    let first = |weight: f32| [weight, 0., 0., 0.].repeat(4).try_into().expect("sixteen");
    let plain = || skinned([0; 16], first(1.0), json!({"joints": [1]}));
    let mut with_short_matrices = plain();
    let short = with_short_matrices.floats("MAT4", &[]);
    let mut with_nan_matrices = plain();
    let nan = with_nan_matrices.floats("MAT4", &[f32::NAN; 16]);
    let mut with_float_joints = plain();
    let floats = with_float_joints.floats("VEC4", &[0.; 16]);
    vec![
        plain().case("skin", loads(2, &[])),
        skinned([7; 16], first(1.0), json!({"joints": [1]}))
            .case("skin-joint-beyond", fails(&["joint 7 of a skin with 1"])),
        skinned([0; 16], first(0.0), json!({"joints": [1]})).case("skin-weights-zero", loads(2, &[])),
        skinned([0; 16], first(f32::NAN), json!({"joints": [1]}))
            .case("skin-weights-nan", fails(&["weight is not finite"])),
        skinned([0; 16], first(-1.0), json!({"joints": [1]})).case("skin-weights-negative", loads(2, &[])),
        skinned([0; 16], first(1e-40), json!({"joints": [1]})).case("skin-weights-tiny", loads(2, &[])),
        skinned([0; 16], first(1.0), json!({"joints": []}))
            .case("skin-without-joints", fails(&["joint 0 of a skin with 0"])),
        skinned([0; 16], first(1.0), json!({"joints": [9]}))
            .case("skin-joint-missing", fails(&["skin 0: joints: node 9 does not exist"])),
        skinned([0; 16], first(1.0), json!({})).case("skin-empty", fails(&["missing field `joints`"])),
        plain().set("/nodes/0/skin", json!(4)).case("skin-missing", fails(&["skin 4 does not exist"])),
        plain()
            .without(&format!("{PRIMITIVE}/attributes/WEIGHTS_0"))
            .case("skin-no-weights", fails(&["only one of JOINTS_0"])),
        with_short_matrices
            .set("/skins/0/inverseBindMatrices", json!(short))
            .case("skin-matrices-short", fails(&["0 inverse bind matrices for 1 joints"])),
        with_nan_matrices
            .set("/skins/0/inverseBindMatrices", json!(nan))
            .case("skin-matrices-nan", fails(&["is not finite"])),
        plain().set("/skins/0/inverseBindMatrices", json!(0)).case("skin-matrices-vec3", fails(&["skin 0"])),
        with_float_joints.attribute("JOINTS_0", floats).case("skin-joints-floats", fails(&["JOINTS_0", "floats"])),
    ]
}

fn externals() -> Vec<Case> {
    let doc = Doc::square();
    let uri = |name: &str, uri: &str, expect| {
        let text = doc.clone().set("/buffers/0/uri", json!(uri)).json.to_string();
        Case::new(&format!("gltf-uri-{name}"), "m.gltf", text, expect)
    };
    let outside = || fails(&["buffer 0", "leads out of the model's folder"]);
    let bin = || doc.bin.clone();
    let unused = |name: &str, buffer: Value, warning: &str| {
        doc.clone()
            .set("/buffers/1", buffer)
            .case(&format!("unused-buffer-{name}"), loads(2, &["buffer 1", warning]).last())
    };
    vec![
        uri("file", "a.bin", loads(2, &[])).with("a.bin", bin()),
        uri("percent", "a%20%62.bin", loads(2, &[])).with("a b.bin", bin()),
        uri("folders", "./x/../y/a.bin", loads(2, &[])).with("y/a.bin", bin()),
        uri("backslash", "y\\a.bin", loads(2, &[])).with("y/a.bin", bin()),
        uri("missing", "none.bin", fails(&["buffer 0", "none.bin"])),
        uri("parent", "../u1.bin", outside()).with("../u1.bin", bin()),
        uri("parent-percent", "%2e%2e%2fu2.bin", outside()).with("../u2.bin", bin()),
        uri("parent-behind-folder", "x/../../u3.bin", outside()).with("../u3.bin", bin()).with("x/y", ""),
        uri("parent-backslash", "..\\u4.bin", outside()).with("../u4.bin", bin()),
        uri("absolute", "/etc/hostname", outside()),
        uri("absolute-percent", "%2Fetc%2Fhostname", outside()),
        uri("file-scheme", "file:///etc/hostname", outside()),
        uri("file-scheme-host", "file://server/etc/hostname", fails(&["is not a relative path"])),
        uri("http", "http://localhost/a.bin", fails(&["is not a relative path"])),
        uri("drive", "C:/a.bin", fails(&["is not a relative path"])),
        uri("device", "/dev/zero", outside()),
        uri("empty", "", fails(&["names no file"])),
        uri("folder", "sub", fails(&["not a regular file"])).with("sub/x", ""),
        uri("percent-broken", "a%2", fails(&["two hexadecimal digits"])),
        uri("percent-nul", "a%00.bin", fails(&["is not a relative path"])),
        uri("percent-not-utf8", "a%ff.bin", fails(&["is not UTF-8"])),
        uri("long", &"x".repeat(1 << 20), fails(&["buffer 0"])),
        uri("link-inside", "l.bin", loads(2, &[])).with("a.bin", bin()).link("l.bin", "a.bin"),
        uri("link-outside", "l.bin", outside()).with("../u5.bin", bin()).link("l.bin", "../u5.bin"),
        Case { pipe: Some("p.bin".to_owned()), ..uri("pipe", "p.bin", fails(&["not a regular file"])) },
        uri("asset-root", "a.bin", loads(2, &[])).with("../assets-7/a.bin", bin()).asset_root("../assets-7"),
        uri("asset-root-parent", "../assets-8/a.bin", loads(2, &[]))
            .with("../assets-8/a.bin", bin())
            .asset_root("../assets-8"),
        uri("asset-root-absolute", "/etc/hostname", outside())
            .with("../assets-9/a.bin", bin())
            .asset_root("../assets-9"),
        uri("asset-root-link", "l.bin", outside())
            .with("../assets-10/x", "")
            .with("../u6.bin", bin())
            .link("../assets-10/l.bin", "../u6.bin")
            .asset_root("../assets-10"),
        uri("shorter", "a.bin", fails(&["buffer 0: 140 bytes stated, 139 there"])).with("a.bin", bin()[1..].to_vec()),
        uri("data-cut-off", "data:;base64,AAAAA", fails(&["base 64 data cut off"])),
        uri("data-not-base64", "data:;base64,****", fails(&["base 64"])),
        uri("data-without-comma", "data:application/octet-stream;base64", fails(&["without a comma"])),
        uri("data-short", "data:;base64,AAAA", fails(&["140 bytes stated, 3 there"])),
        unused("missing", json!({"byteLength": 4, "uri": "none.bin"}), "none.bin"),
        unused("outside", json!({"byteLength": 4, "uri": "../none.bin"}), "leads out of the model's folder"),
        unused("for-an-extension", json!({"byteLength": 4}), "no URI"),
        unused("largest", json!({"byteLength": u64::MAX, "uri": "data:,"}), "bytes stated, 0 there"),
    ]
}

impl Expect {
    /// Expects one warning with the last of the parts.
    fn last(self) -> Self {
        match self {
            Expect::Loads(faces, mut warnings) => Expect::Loads(faces, warnings.split_off(warnings.len() - 1)),
            fails => fails,
        }
    }
}

fn materials() -> Vec<Case> {
    let with = |material: Value| {
        Doc::square().set(&format!("{PRIMITIVE}/material"), json!(0)).set("/materials", json!([material]))
    };
    let factor = |name: &str, factor: Value, expect| {
        with(json!({"pbrMetallicRoughness": {"baseColorFactor": factor}})).case(&format!("base-colour-{name}"), expect)
    };
    let textured = |info: Value| with(json!({"pbrMetallicRoughness": {"baseColorTexture": info}}));
    let image = |name: &str, image: Value, expect| {
        textured(json!({"index": 0}))
            .set("/textures", json!([{"source": 0}]))
            .set("/images", json!([image]))
            .case(&format!("image-{name}"), expect)
    };
    let viewed = |name: &str, bytes: &[u8], expect| {
        let mut doc = textured(json!({"index": 0})).set("/textures", json!([{"source": 0}]));
        let view = doc.view(bytes);
        doc.set("/images", json!([{"bufferView": view, "mimeType": "image/png"}]))
            .case(&format!("image-{name}"), expect)
    };
    let png = picture(2, 2, ImageFormat::Png);
    let transform = |transform: Value| json!({"index": 0, "extensions": {"KHR_texture_transform": transform}});
    let left_out = |why: &str| loads(2, &[&format!("image 0 is left out: {why}")]);
    vec![
        Doc::square()
            .set(&format!("{PRIMITIVE}/material"), json!(5))
            .case("material-missing", fails(&["material 5 does not exist"])),
        with(json!({})).case("material-empty", loads(2, &[])),
        with(json!({"alphaMode": "WHAT"})).case("alpha-mode-unknown", fails(&["material 0: unknown alpha mode"])),
        with(json!({"alphaMode": "MASK", "alphaCutoff": -3})).case("alpha-cutoff-negative", loads(2, &[])),
        with(json!({"extensions": {"KHR_materials_unlit": {}}})).case("unlit", loads(2, &[])),
        factor("huge", json!([1e38, 1, 1, 1]), loads(2, &["material 0: its base colour"])),
        factor("negative", json!([-1, 0, 0, 1]), loads(2, &["is not within 0 to 1"])),
        factor("1e300", json!([1e300, 0, 0, 1]), fails(&["its base colour is not finite"])),
        factor("short", json!([1, 1]), fails(&["not glTF 2.0"])),
        textured(json!({"index": 0})).case("texture-missing", fails(&["texture 0 does not exist"])),
        textured(json!({"index": 0}))
            .set("/textures", json!([{}]))
            .case("texture-without-source", loads(2, &["it has no image"])),
        textured(json!({"index": 0}))
            .set("/textures", json!([{"extensions": {"KHR_texture_basisu": {"source": 0}}}]))
            .set("/extensionsUsed", json!(["KHR_texture_basisu"]))
            .case(
                "texture-of-an-extension",
                loads(2, &["KHR_texture_basisu is ignored", "its image is in the extension KHR_texture_basisu"]),
            ),
        textured(json!({"index": 0}))
            .set("/textures", json!([{"source": 3}]))
            .case("texture-source-missing", fails(&["texture 0: source: image 3 does not exist"])),
        textured(json!({"index": 0}))
            .set("/textures", json!([{"source": 0, "sampler": 8}]))
            .case("sampler-missing", fails(&["sampler 8 does not exist"])),
        textured(json!({"index": 0, "texCoord": 5}))
            .set("/textures", json!([{"source": 0}]))
            .set("/images", json!([{"uri": data_uri(&png)}]))
            .case("texture-coordinates-missing", loads(2, &["no TEXCOORD_5"])),
        textured(transform(json!({"scale": [3e38, 3e38], "offset": [3e38, 3e38]})))
            .set("/textures", json!([{"source": 0}]))
            .set("/images", json!([{"uri": data_uri(&png)}]))
            .case("texture-transform-huge", loads(2, &[])),
        textured(transform(json!({"scale": [1e300, 1]})))
            .set("/textures", json!([{}]))
            .case("texture-transform-not-finite", fails(&["texture transform is not finite"])),
        image("empty", json!({}), left_out("neither a buffer view nor a URI")),
        image("missing", json!({"uri": "none.png"}), left_out("")),
        image("parent", json!({"uri": "../u7.png"}), left_out("URI \"../u7.png\" leads out"))
            .with("../u7.png", png.clone()),
        image("device", json!({"uri": "/dev/urandom"}), left_out("")),
        image("scheme", json!({"uri": "https://localhost/a.png"}), left_out("URI")),
        image(
            "view-missing",
            json!({"bufferView": 77}),
            fails(&["image 0: bufferView: buffer view 77 does not exist"]),
        ),
        image("data", json!({"uri": data_uri(&png)}), loads(2, &[])),
        image("data-broken", json!({"uri": "data:image/png;base64,AAAA"}), left_out("image #0")),
        image("file", json!({"uri": "a%20b.png"}), loads(2, &[])).with("a b.png", png.clone()),
        image("asset-root", json!({"uri": "wood/a.png"}), loads(2, &[]))
            .with("../assets-11/wood/a.png", png.clone())
            .asset_root("../assets-11"),
        textured(json!({"index": 0}))
            .set("/textures", json!([{"source": 0}]))
            .set("/images", json!([{"bufferView": 4}]))
            .set("/bufferViews/4", json!({"buffer": 0, "byteOffset": 100, "byteLength": 1000}))
            .case("image-view-beyond-its-buffer", left_out("buffer view 4: 1000 bytes from byte 100 reach beyond")),
        viewed("viewed", &png, loads(2, &[])),
        viewed("cut-off", &png[..30], left_out("image #0")),
        viewed("nothing", &[], left_out("image #0")),
        viewed("bomb", &png_that_says(50_000, 50_000), fails(&["2500000000 texels in an image"])),
    ]
}

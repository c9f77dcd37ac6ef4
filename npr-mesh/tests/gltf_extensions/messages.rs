//! Errors that name what is wrong.

use crate::doc::{Doc, PRIMITIVE};
use crate::{assert_fails, load_bytes, load_with, loaded, warnings};
use npr_mesh::{Limits, LoadError};
use serde_json::json;

#[test]
fn other_versions_are_named() {
    // Dictionaries instead of arrays.
    let old = json!({
        "accessors": {"a": {"bufferView": "v", "componentType": 5126, "count": 3, "type": "VEC3"}},
        "meshes": {"m": {"primitives": [{"attributes": {"POSITION": "a"}, "material": "x"}]}},
        "nodes": {"n": {"meshes": ["m"]}},
        "scenes": {"s": {"nodes": ["n"]}},
        "scene": "s"
    });
    for asset in [json!(null), json!({}), json!({"version": "1.0"}), json!({"version": 1.0}), json!({"version": "1.1"})]
    {
        let mut file = old.clone();
        if !asset.is_null() {
            file["asset"] = asset.clone();
        }
        let error = load_bytes("m.gltf", file.to_string().as_bytes(), Limits::default()).expect_err("another version");
        assert!(matches!(&error, LoadError::Unsupported { feature, .. } if feature.starts_with("glTF 1.")), "{error}");
    }
    let fault = "not glTF 2.0: it states no version, which is \"2.0\" in `asset`";
    for doc in [
        Doc::square().without("/asset"),
        Doc::square().without("/asset/version"),
        Doc::square().set("/asset/version", json!(null)),
    ] {
        assert_fails(&doc, fault);
    }
}

#[test]
fn meshes_that_nothing_places_are_named_as_that() {
    let doc = Doc::square();
    for doc in [
        doc.clone().set("/nodes/0", json!({})),
        // A node that is not of the scene.
        doc.clone().set("/nodes", json!([{}, {"mesh": 0}])),
        doc.clone().set("/scenes/0/nodes", json!([])),
        doc.clone().without("/nodes").without("/scenes").without("/scene"),
    ] {
        assert_fails(&doc, "no node of the scene places any of its 1 meshes");
    }
    // Nothing at all, and a mesh without a face.
    let empty = doc.clone().set("/meshes", json!([])).set("/nodes/0", json!({}));
    assert_fails(&empty, "no triangle in it");
    assert_fails(
        &doc.set(&format!("{PRIMITIVE}/mode"), json!(0)),
        "no triangle in it (primitives of points are left out)",
    );
}

#[test]
fn an_image_that_is_too_large_is_named_with_its_model() {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbaImage::new(8, 8).write_to(&mut bytes, image::ImageFormat::Png).expect("a picture");
    let mut doc = Doc::square();
    let view = doc.view(&bytes.into_inner());
    let doc = doc
        .set("/materials", json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]))
        .set("/textures", json!([{"source": 0}]))
        .set("/images", json!([{"bufferView": view, "name": "wood"}]))
        .set(&format!("{PRIMITIVE}/material"), json!(0));
    for limits in [Limits { texels: 63, ..Limits::default() }, Limits { texels_in_all: 63, ..Limits::default() }] {
        let error = load_with(&doc, limits).expect_err("too large").to_string();
        assert!(error.contains("m.glb: image wood: 64 texels in "), "{error}");
    }
}

#[test]
fn what_is_ignored_is_warned_of_once() {
    let doc = Doc::square()
        .set("/extensionsUsed", json!(["KHR_materials_ior", "KHR_materials_ior", "EXT_unknown"]))
        .set("/nodes", json!([{"mesh": 0}, {"mesh": 0}]))
        .set("/scenes/0/nodes", json!([0, 1]));
    let told = warnings(&loaded(&doc));
    assert_eq!(told, ["the extension KHR_materials_ior is ignored (2 times)", "the extension EXT_unknown is ignored"]);
}

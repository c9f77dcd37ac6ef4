//! An index out of range is an error of one form, wherever it is and whether or not its element is used.

use crate::doc::Doc;
use crate::{assert_fails, loaded};
use serde_json::{Value, json};

#[test]
fn every_index_is_checked() {
    let texture = |name: &str| json!({"materials": [{name: {"index": 5}}]});
    let metallic = |name: &str| json!({"materials": [{"pbrMetallicRoughness": {name: {"index": 5}}}]});
    let glossy = |name: &str| json!({"materials": [{"extensions": {"KHR_materials_pbrSpecularGlossiness": {name: {"index": 5}}}}]});
    let animation =
        |channel: Value, sampler: Value| json!({"animations": [{"channels": [channel], "samplers": [sampler]}]});
    let channel = |sampler: u32, node: u32| json!({"sampler": sampler, "target": {"node": node, "path": "scale"}});
    let sampler = |input: u32, output: u32| json!({"input": input, "output": output});
    let sparse = |indices: u32, values: u32| {
        json!({"componentType": 5126, "type": "SCALAR", "count": 1, "sparse": {
            "count": 1, "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}}})
    };
    // Nothing of this is used by what is shown.
    for (more, fault) in [
        (json!({"scene": 9}), "scene 9 does not exist"),
        (json!({"scenes+": {"nodes": [9]}}), "scene 1: nodes: node 9 does not exist"),
        (json!({"nodes+": {"children": [9]}}), "node 1: children: node 9 does not exist"),
        (json!({"nodes+": {"mesh": 9}}), "node 1: mesh: mesh 9 does not exist"),
        (json!({"nodes+": {"skin": 9}}), "node 1: skin: skin 9 does not exist"),
        (json!({"nodes+": {"camera": 0}}), "node 1: camera: camera 0 does not exist"),
        (
            json!({"nodes+": {"extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"SCALE": 9}}}}}),
            "node 1: SCALE: accessor 9 does not exist",
        ),
        (
            json!({"meshes+": {"primitives": [{"attributes": {"COLOR_0": 9}}]}}),
            "mesh 1 primitive 0: COLOR_0: accessor 9 does not exist",
        ),
        (
            json!({"meshes+": {"primitives": [{"attributes": {}, "indices": 9}]}}),
            "mesh 1 primitive 0: indices: accessor 9 does not exist",
        ),
        (
            json!({"meshes+": {"primitives": [{"attributes": {}, "material": 9}]}}),
            "mesh 1 primitive 0: material: material 9 does not exist",
        ),
        (
            json!({"meshes+": {"primitives": [{"attributes": {}, "targets": [{"NORMAL": 9}]}]}}),
            "mesh 1 primitive 0: targets: accessor 9 does not exist",
        ),
        (
            json!({"accessors+": {"bufferView": 9, "componentType": 5126, "type": "SCALAR", "count": 1}}),
            "accessor 4: bufferView: buffer view 9 does not exist",
        ),
        (json!({"accessors+": sparse(9, 0)}), "accessor 4: sparse.indices: buffer view 9 does not exist"),
        (json!({"accessors+": sparse(0, 9)}), "accessor 4: sparse.values: buffer view 9 does not exist"),
        (json!({"bufferViews+": {"buffer": 9, "byteLength": 1}}), "buffer view 4: buffer: buffer 9 does not exist"),
        (json!({"images": [{"bufferView": 9}]}), "image 0: bufferView: buffer view 9 does not exist"),
        (json!({"textures": [{"source": 9}]}), "texture 0: source: image 9 does not exist"),
        (
            json!({"textures": [{"extensions": {"EXT_texture_webp": {"source": 9}}}]}),
            "texture 0: source: image 9 does not exist",
        ),
        (json!({"textures": [{"sampler": 9}]}), "texture 0: sampler: sampler 9 does not exist"),
        (texture("normalTexture"), "material 0: normalTexture: texture 5 does not exist"),
        (texture("occlusionTexture"), "material 0: occlusionTexture: texture 5 does not exist"),
        (texture("emissiveTexture"), "material 0: emissiveTexture: texture 5 does not exist"),
        (metallic("baseColorTexture"), "material 0: baseColorTexture: texture 5 does not exist"),
        (metallic("metallicRoughnessTexture"), "material 0: metallicRoughnessTexture: texture 5 does not exist"),
        (glossy("diffuseTexture"), "material 0: diffuseTexture: texture 5 does not exist"),
        (glossy("specularGlossinessTexture"), "material 0: specularGlossinessTexture: texture 5 does not exist"),
        (json!({"skins": [{"joints": [9]}]}), "skin 0: joints: node 9 does not exist"),
        (json!({"skins": [{"joints": [0], "skeleton": 9}]}), "skin 0: skeleton: node 9 does not exist"),
        (
            json!({"skins": [{"joints": [0], "inverseBindMatrices": 9}]}),
            "skin 0: inverseBindMatrices: accessor 9 does not exist",
        ),
        (animation(channel(0, 9), sampler(0, 0)), "animation 0: target: node 9 does not exist"),
        (animation(channel(9, 0), sampler(0, 0)), "animation 0: channel: sampler 9 does not exist"),
        (animation(channel(0, 0), sampler(9, 0)), "animation 0: input: accessor 9 does not exist"),
        (animation(channel(0, 0), sampler(0, 9)), "animation 0: output: accessor 9 does not exist"),
    ] {
        let mut doc = Doc::square();
        for (name, value) in more.as_object().expect("an object") {
            match name.strip_suffix('+') {
                Some(name) => doc.json[name].as_array_mut().expect("an array").push(value.clone()),
                None => doc.json[name] = value.clone(),
            }
        }
        assert_fails(&doc, fault);
        // The same where the document is repaired first: a name that is a number.
        doc.json["meshes"][0]["name"] = json!(5);
        assert_fails(&doc, fault);
    }
}

#[test]
fn indices_within_range_are_accepted() {
    let doc = Doc::square()
        .set("/cameras", json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}]))
        .set("/nodes/0/camera", json!(0))
        .set("/images", json!([{"bufferView": 3}]))
        .set("/textures", json!([{"source": 0}, {}]))
        .set("/skins", json!([{"joints": [0], "skeleton": 0}]))
        .set(
            "/animations",
            json!([{
                "channels": [{"sampler": 0, "target": {"node": 0, "path": "scale"}}],
                "samplers": [{"input": 0, "output": 1}]
            }]),
        );
    assert!(loaded(&doc).warnings.is_empty());
    // An animation whose target an extension states is not understood, and not needed.
    let pointer = json!({"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {}}}});
    assert!(loaded(&doc.set("/animations/0/channels/0", pointer)).warnings.is_empty());
}

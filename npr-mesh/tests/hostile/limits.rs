//! Small files that request large amounts of memory or time.

use crate::case::{Case, fails, loads};
use crate::doc::{Doc, PRIMITIVE, data_uri};
use crate::images::picture;
use image::ImageFormat;
use npr_mesh::{Limits, LoadOptions};
use serde_json::{Value, json};

pub fn cases() -> Vec<Case> {
    let square = Doc::square;
    let small = |case: Case, limits: Limits| Case { options: LoadOptions { limits, ..LoadOptions::default() }, ..case };
    let all = Limits::default();
    let instances = |nodes: usize| {
        square().set("/nodes", json!(vec![json!({"mesh": 0}); nodes])).without("/scenes").without("/scene")
    };
    let big = |vertices: usize, nodes: usize, name: &str, expect| {
        let mut doc = square();
        let positions = doc.floats("VEC3", &vec![0.5; vertices * 3]);
        doc.set(&format!("{PRIMITIVE}/attributes"), json!({"POSITION": positions}))
            .without(&format!("{PRIMITIVE}/indices"))
            .set("/nodes", json!(vec![json!({"mesh": 0}); nodes]))
            .without("/scenes")
            .without("/scene")
            .case(name, expect)
    };
    let primitives = |primitive: Value, count: usize, nodes: usize| {
        square()
            .set("/meshes/0/primitives", json!(vec![primitive; count]))
            .set("/nodes", json!(vec![json!({"mesh": 0}); nodes]))
            .without("/scenes")
            .without("/scene")
    };
    let targets = |count: usize| {
        let mut doc = square();
        let vertices = 30_000;
        let positions = doc.floats("VEC3", &vec![0.5; vertices * 3]);
        doc.set(&format!("{PRIMITIVE}/attributes"), json!({"POSITION": positions}))
            .set(&format!("{PRIMITIVE}/targets"), json!(vec![json!({"POSITION": positions}); count]))
            .set("/meshes/0/weights", json!(vec![1; count]))
    };
    let joints = |sets: usize| {
        let mut doc = square();
        let joints = doc.add(&[0; 16], json!({"componentType": 5121, "type": "VEC4", "count": 4}));
        let weights = doc.floats("VEC4", &[1.; 16]);
        for set in 0..sets {
            doc = doc.attribute(&format!("JOINTS_{set}"), joints).attribute(&format!("WEIGHTS_{set}"), weights);
        }
        doc.set("/skins", json!([{"joints": [0]}])).set("/nodes/0/skin", json!(0))
    };
    let skins = |count: usize| {
        let mut doc = square();
        let matrices = doc.floats("MAT4", &[1.; 16 * 5000]);
        let joints = doc.add(&[0; 16], json!({"componentType": 5121, "type": "VEC4", "count": 4}));
        let weights = doc.floats("VEC4", &[1.; 16]);
        let skin = json!({"joints": [0], "inverseBindMatrices": matrices});
        let nodes: Vec<Value> = (0..count).map(|skin| json!({"mesh": 0, "skin": skin})).collect();
        doc.attribute("JOINTS_0", joints)
            .attribute("WEIGHTS_0", weights)
            .set("/skins", json!(vec![skin; count]))
            .set("/nodes", json!(nodes))
            .without("/scenes")
            .without("/scene")
    };
    let textures = |count: usize| {
        // 2 MiB of texels in a few kB, used by many materials.
        let png = picture(1024, 512, ImageFormat::Png);
        let mut doc = square();
        let view = doc.view(&png);
        let images: Vec<Value> = vec![json!({"bufferView": view}); count];
        let primitive = doc.json.pointer(PRIMITIVE).expect("it").clone();
        let primitives: Vec<Value> = (0..count)
            .map(|material| {
                let mut primitive = primitive.clone();
                primitive["material"] = json!(material);
                primitive
            })
            .collect();
        let material = |texture: usize| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}});
        doc.set("/images", json!(images))
            .set("/textures", json!((0..count).map(|source| json!({"source": source})).collect::<Vec<_>>()))
            .set("/materials", json!((0..count).map(material).collect::<Vec<_>>()))
            .set("/meshes/0/primitives", json!(primitives))
    };
    let warnings = primitives(json!({"attributes": {"POSITION": 0}, "mode": 0}), 10_000, 1);
    let left_out = "no POSITION, it is left out";
    vec![
        instances(1000).case("instances", loads(2000, &[])),
        big(100_000, 100, "instances-too-many-vertices", fails(&["vertices from a file so small"])),
        small(big(1000, 100, "instances-within-a-limit", loads(33_300, &["no area", "no whole number"])), all),
        small(
            big(1000, 100, "instances-over-a-limit", fails(&["vertices from a file so small"])),
            Limits { repeated: 10_000, ..all },
        ),
        primitives(json!({"attributes": {}}), 2000, 2000).case("primitives-too-many", fails(&["1002000 primitives"])),
        primitives(json!({"attributes": {"POSITION": 0}, "indices": 2}), 300, 300)
            .case("primitives-times-nodes", loads(180_000, &[])),
        targets(100).case("targets-100", loads(2, &["2 of 2 faces have no area"])),
        targets(10_000).case("targets-10000", fails(&["displacements and weights of joints"])),
        joints(8).case("joints-8-sets", loads(2, &[])),
        joints(9).case("joints-9-sets", fails(&["more than 8 sets"])),
        joints(2000).case("joints-2000-sets", fails(&["more than 8 sets"])),
        skins(3000).case("skins-3000", loads(6000, &["6000 of 6000 faces have no area"])),
        textures(20).case("textures-20", loads(40, &[])),
        textures(400).case("textures-400", fails(&["texels in all images", "100663296"])),
        warnings.case("warnings-10000", fails(&["no triangle"])),
        primitives(json!({"attributes": {}}), 10_000, 1)
            .set("/meshes/0/primitives/0", json!({"attributes": {"POSITION": 0}, "indices": 2}))
            .case("warnings-9999", loads(2, &[left_out, "and 9899 more"])),
        square().set("/skins", json!(vec![json!({"joints": [0]}); 50_000])).case("skins-unused", loads(2, &[])),
        square()
            .set("/buffers", json!([{"byteLength": 140, "uri": data_uri(&square().bin)}]))
            .set("/bufferViews/4", json!({"buffer": 0, "byteLength": u64::MAX}))
            .case("view-unused", loads(2, &[])),
        small(
            square().case("limit-vertices", fails(&["4 vertices, more than the limit of 3"])),
            Limits { vertices: 3, ..all },
        ),
        small(square().case("limit-faces", fails(&["2 faces, more than the limit of 1"])), Limits { faces: 1, ..all }),
        small(square().case("limit-nodes", fails(&["1 nodes, more than the limit of 0"])), Limits { nodes: 0, ..all }),
        small(square().case("limit-bytes", fails(&["more than the limit of 100"])), Limits { file_bytes: 100, ..all }),
        small(
            Case::new(
                "limit-bytes-in-all",
                "m.gltf",
                {
                    let two = json!([{"byteLength": 140, "uri": "a.bin"}, {"byteLength": 140, "uri": "b.bin"}]);
                    square().set("/buffers", two).json.to_string()
                },
                fails(&["bytes in the file"]),
            )
            .with("a.bin", square().bin)
            .with("b.bin", vec![0; 2000]),
            Limits { file_bytes: 2100, ..all },
        ),
    ]
}

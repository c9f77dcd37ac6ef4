//! Geometry that an extension compresses.

use crate::doc::{Doc, PRIMITIVE};
use crate::{assert_fails, load_with, loaded};
use glam::Vec3;
use meshoptimizer_rs::{Workspace, codec};
use npr_mesh::{Limits, Model};
use serde_json::{Value, json};

const EXT: &str = "EXT_meshopt_compression";
const KHR: &str = "KHR_meshopt_compression";

/// Replaces the content of a buffer view by compressed bytes. The view then refers to buffer 1, which has no content.
fn compress(mut doc: Doc, view: usize, extension: &str, bytes: &[u8], mut properties: Value) -> Doc {
    let at = doc.view(bytes);
    let stored = doc.json["bufferViews"][at].clone();
    for name in ["buffer", "byteOffset", "byteLength"] {
        properties[name] = stored[name].clone();
    }
    let pointer = format!("/bufferViews/{view}");
    doc.set(&format!("{pointer}/extensions"), json!({extension: properties}))
        .set(&format!("{pointer}/buffer"), json!(1))
        .set(&format!("{pointer}/byteOffset"), json!(0))
        .set("/buffers/1", json!({"byteLength": 4096, "extensions": {extension: {"fallback": true}}}))
        .set("/extensionsUsed", json!([extension]))
        .set("/extensionsRequired", json!([extension]))
}

/// The bytes of a buffer view.
fn content(doc: &Doc, view: usize) -> Vec<u8> {
    let view = &doc.json["bufferViews"][view];
    let number = |name: &str| view[name].as_u64().expect("a number") as usize;
    doc.bin[number("byteOffset")..][..number("byteLength")].to_vec()
}

/// The version of the codec that both extensions have.
const V0: codec::VertexEncoding = match codec::VertexEncoding::new(0, 0) {
    Ok(version) => version,
    Err(_) => panic!("version 0"),
};

fn vertices(bytes: &[u8], stride: usize, level: codec::VertexEncoding) -> Vec<u8> {
    codec::encode_vertex_buffer(bytes, bytes.len() / stride, stride, level, &mut Workspace::default()).expect("encoded")
}

/// A square whose positions and indices are compressed.
fn square(extension: &str) -> Doc {
    let doc = Doc::square();
    let (positions, indices) = (content(&doc, 0), content(&doc, 2));
    let positions = vertices(&positions, 12, V0);
    let indices: Vec<u32> = indices.chunks(2).map(|b| u32::from(u16::from_le_bytes([b[0], b[1]]))).collect();
    let indices = codec::encode_index_buffer(&indices, codec::IndexEncoding::DEFAULT, &mut Workspace::default())
        .expect("encoded");
    let doc = compress(doc, 0, extension, &positions, json!({"byteStride": 12, "count": 4, "mode": "ATTRIBUTES"}));
    compress(doc, 2, extension, &indices, json!({"byteStride": 2, "count": 6, "mode": "TRIANGLES"}))
}

fn model(doc: &Doc) -> Model {
    let file = loaded(doc);
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    file.into_model()
}

#[test]
fn compressed_buffer_views_are_decompressed() {
    let expected = model(&Doc::square());
    for extension in [EXT, KHR] {
        let found = model(&square(extension));
        assert_eq!(found.positions, expected.positions);
        assert_eq!(found.normals, expected.normals);
        // The codec may rotate the corners of a face.
        let sorted = |model: &Model| {
            let first = |face: &[u32; 3]| (0..3).min_by_key(|&corner| face[corner]).expect("a corner");
            let mut faces: Vec<_> =
                model.faces.iter().map(|face| [0, 1, 2].map(|i| face[(first(face) + i) % 3])).collect();
            faces.sort_unstable();
            faces
        };
        assert_eq!(sorted(&found), sorted(&expected));
    }
}

/// A stream of meshoptimizer's own test suite, for triangles (0 1 2), (2 1 3), (4 6 5), (7 8 9).
#[test]
fn a_stream_of_another_encoder() {
    const STREAM: [u8; 27] = [
        0xe0, 0xf0, 0x10, 0xfe, 0xff, 0xf0, 0x0c, 0xff, 0x02, 0x02, 0x02, 0x00, 0x76, 0x87, 0x56, 0x67, 0x78, 0xa9,
        0x86, 0x65, 0x89, 0x68, 0x98, 0x01, 0x69, 0x00, 0x00,
    ];
    let mut doc = Doc::square();
    let positions: Vec<f32> = (0..10).flat_map(|v| [v as f32, (v * v) as f32, 0.0]).collect();
    let positions = doc.floats("VEC3", &positions);
    let indices = doc.add(&[0; 48], json!({"componentType": 5125, "type": "SCALAR", "count": 12}));
    // With normals, so that no vertex is split for them.
    let normals = doc.floats("VEC3", &[0., 0., 1.].repeat(10));
    let attributes = json!({"POSITION": positions, "NORMAL": normals});
    let doc = doc.set(PRIMITIVE, json!({"attributes": attributes, "indices": indices}));
    let doc = compress(doc, 5, EXT, &STREAM, json!({"byteStride": 4, "count": 12, "mode": "TRIANGLES"}));
    assert_eq!(loaded(&doc).meshes[0].faces, [[0, 1, 2], [2, 1, 3], [4, 6, 5], [7, 8, 9]]);
}

#[test]
fn filters_are_applied() {
    // An octahedral normal: x, y and the length of the diamond, here 127; then an exponential position.
    let mut doc = Doc::square();
    let normals = doc.add(&[0; 16], json!({"componentType": 5120, "normalized": true, "type": "VEC3", "count": 4}));
    let encoded: Vec<u8> = [[127u8, 0, 127, 0], [0, 127, 127, 0], [0, 0, 127, 0], [0x81, 0, 127, 0]].concat();
    let stream = vertices(&encoded, 4, V0);
    let properties = json!({"byteStride": 4, "count": 4, "mode": "ATTRIBUTES", "filter": "OCTAHEDRAL"});
    let doc = compress(doc, 4, EXT, &stream, properties)
        .set("/bufferViews/4/byteStride", json!(4))
        .set("/extensionsUsed", json!([EXT, "KHR_mesh_quantization"]))
        .set(&format!("{PRIMITIVE}/attributes/NORMAL"), json!(normals));
    let found = model(&doc).normals;
    for (normal, expected) in found.iter().zip([Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X]) {
        assert!(normal.distance(expected) < 0.01, "{found:?}");
    }

    // 3 * 2^-1 = 1.5 in all lanes: a mantissa of 24 bits and an exponent of 8.
    let word = (3u32 | 0xFF << 24).to_le_bytes();
    let stream = vertices(&word.repeat(12), 12, V0);
    let properties = json!({"byteStride": 12, "count": 4, "mode": "ATTRIBUTES", "filter": "EXPONENTIAL"});
    let doc = compress(Doc::square(), 0, KHR, &stream, properties);
    assert_eq!(loaded(&doc).meshes[0].positions, [Vec3::splat(1.5); 4]);
}

#[test]
fn wrong_compressed_views_are_errors() {
    let doc = square(EXT);
    let view = |name: &str| format!("/bufferViews/0/extensions/{EXT}/{name}");
    for (name, value, fault) in [
        ("buffer", json!(9), "buffer view 0: EXT_meshopt_compression: buffer 9 does not exist"),
        ("buffer", json!("no"), "buffer view 0: EXT_meshopt_compression: invalid type"),
        ("count", json!(5), "5 elements of 12 bytes in a buffer view of 48 bytes"),
        ("count", json!(1u64 << 63), "in a buffer view of 48 bytes"),
        ("mode", json!("SOMETHING"), "unknown mode SOMETHING"),
        ("filter", json!("COLOR"), "unknown filter COLOR"),
        ("filter", json!("OCTAHEDRAL"), "buffer view 0: EXT_meshopt_compression: invalid vertex layout"),
        (
            "byteLength",
            json!(3),
            "POSITION: accessor 0: buffer view 0: EXT_meshopt_compression: invalid encoded stream",
        ),
        ("byteLength", json!(1u64 << 40), "reach beyond buffer 0"),
        ("byteOffset", json!(u64::MAX), "reach beyond buffer 0"),
    ] {
        assert_fails(&doc.clone().set(&view(name), value), fault);
    }
    let filtered = doc.clone().set(&format!("/bufferViews/2/extensions/{EXT}/filter"), json!("EXPONENTIAL"));
    assert_fails(&filtered, "filter EXPONENTIAL of TRIANGLES");
    // The first extension has only the first version of the codec.
    let newer = vertices(&content(&Doc::square(), 0), 12, codec::VertexEncoding::new(1, 2).expect("version 1"));
    let properties = json!({"byteStride": 12, "count": 4, "mode": "ATTRIBUTES"});
    assert_fails(&compress(Doc::square(), 0, EXT, &newer, properties.clone()), "another version of the codec");
    assert_eq!(model(&compress(Doc::square(), 0, KHR, &newer, properties)).positions, model(&Doc::square()).positions);
    // A small file that says it is large.
    let huge = (doc.set("/bufferViews/0/byteLength", json!(12u64 << 40))).set(&view("count"), json!(1u64 << 40));
    assert_fails(&huge, "13194139533324 bytes in compressed buffer views, more than the limit");
    let limits = Limits { file_bytes: 4000, ..Limits::default() };
    assert!(load_with(&square(EXT), limits).is_ok());
}

#[test]
fn geometry_in_an_extension_that_is_not_supported_is_an_error() {
    let draco = json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}});
    let doc = Doc::square()
        .set(&format!("{PRIMITIVE}/extensions"), draco)
        .set("/extensionsUsed", json!(["KHR_draco_mesh_compression"]));
    // The accessors have data for readers without the extension.
    assert_eq!(loaded(&doc).meshes[0].faces.len(), 2);
    for accessor in [0, 1, 2] {
        let without = doc.clone().without(&format!("/accessors/{accessor}/bufferView"));
        assert_fails(
            &without,
            "needs the extension KHR_draco_mesh_compression for the geometry of mesh 0 primitive 0, which is not supported",
        );
        // Without the extension such an accessor is zeros.
        let plain = load_with(&without.without(&format!("{PRIMITIVE}/extensions")), Limits::default());
        assert!(plain.is_ok_and(|file| !file.warnings.is_empty()));
    }
    let sparse = json!({"count": 1, "indices": {"bufferView": 2, "componentType": 5123}, "values": {"bufferView": 0}});
    let sparse = doc.without("/accessors/0/bufferView").set("/accessors/0/sparse", sparse);
    assert!(load_with(&sparse, Limits::default()).is_ok());
}

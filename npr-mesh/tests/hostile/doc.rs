//! A builder of glTF files.

use crate::case::{Case, Expect};
use serde_json::{Value, json};

/// A glTF file under construction.
#[derive(Clone)]
pub struct Doc {
    pub json: Value,
    pub bin: Vec<u8>,
}

impl Doc {
    /// A unit square of two triangles with normals and texture coordinates.
    ///
    /// Accessors and buffer views: 0 positions, 1 normals, 2 indices of 16 bits, 3 texture coordinates.
    pub fn square() -> Self {
        let corners = [[0f32, 0.], [1., 0.], [1., 1.], [0., 1.]];
        let positions: Vec<f32> = corners.iter().flat_map(|c| [c[0], c[1], 0.]).collect();
        let normals: Vec<f32> = [0f32, 0., 1.].repeat(4);
        let mut doc = Doc {
            json: json!({
                "asset": {"version": "2.0"},
                "buffers": [{"byteLength": 0}],
                "bufferViews": [],
                "accessors": [],
                "meshes": [{"primitives": [{
                    "attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 3}, "indices": 2
                }]}],
                "nodes": [{"mesh": 0}],
                "scenes": [{"nodes": [0]}],
                "scene": 0
            }),
            bin: Vec::new(),
        };
        doc.floats("VEC3", &positions);
        doc.floats("VEC3", &normals);
        doc.add(
            &[0u16, 1, 2, 0, 2, 3].map(u16::to_le_bytes).concat(),
            json!({"componentType": 5123, "type": "SCALAR", "count": 6}),
        );
        doc.floats("VEC2", corners.as_flattened());
        doc
    }

    /// Adds a buffer view of these bytes, and returns its index.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len()});
        self.bin.extend_from_slice(bytes);
        self.json["buffers"][0]["byteLength"] = json!(self.bin.len());
        let views = self.json["bufferViews"].as_array_mut().expect("views");
        views.push(view);
        views.len() - 1
    }

    /// Adds an accessor with its own view, and returns its index.
    pub fn add(&mut self, bytes: &[u8], mut accessor: Value) -> usize {
        accessor["bufferView"] = json!(self.view(bytes));
        let accessors = self.json["accessors"].as_array_mut().expect("accessors");
        accessors.push(accessor);
        accessors.len() - 1
    }

    pub fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let lanes = match kind {
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            "MAT4" => 16,
            _ => 1,
        };
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.add(&bytes, json!({"componentType": 5126, "type": kind, "count": values.len() / lanes}))
    }

    /// Replaces or adds the value at a JSON pointer, whose parent must exist.
    pub fn set(mut self, pointer: &str, value: Value) -> Self {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        let parent = self.json.pointer_mut(parent).expect(pointer);
        match (parent, key.parse::<usize>()) {
            (Value::Array(elements), Ok(index)) if index < elements.len() => elements[index] = value,
            (Value::Array(elements), Ok(_)) => elements.push(value),
            (parent, _) => parent[key] = value,
        }
        self
    }

    pub fn without(mut self, pointer: &str) -> Self {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        self.json.pointer_mut(parent).expect(pointer).as_object_mut().expect(pointer).remove(key);
        self
    }

    /// Replaces the attributes of the only primitive.
    pub fn attribute(self, name: &str, accessor: usize) -> Self {
        self.set(&format!("{PRIMITIVE}/attributes/{name}"), json!(accessor))
    }

    pub fn glb(&self) -> Vec<u8> {
        glb_of(self.json.to_string().as_bytes(), &self.bin)
    }

    /// Stores the buffer as a `data:` URI.
    pub fn text(&self) -> String {
        self.clone().set("/buffers/0/uri", json!(data_uri(&self.bin))).json.to_string()
    }

    pub fn case(&self, name: &str, expect: Expect) -> Case {
        Case::new(&format!("gltf-{name}"), "m.glb", self.glb(), expect)
    }
}

pub const PRIMITIVE: &str = "/meshes/0/primitives/0";

pub fn glb_of(json: &[u8], bin: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, bin) = (padded(json, b' '), padded(bin, 0));
    let word = |n: usize| (n as u32).to_le_bytes();
    [
        &b"glTF"[..],
        &word(2),
        &word(28 + json.len() + bin.len()),
        &word(json.len()),
        b"JSON",
        &json,
        &word(bin.len()),
        b"BIN\0",
        &bin,
    ]
    .concat()
}

pub fn data_uri(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = "data:application/octet-stream;base64,".to_owned();
    for group in bytes.chunks(3) {
        let bits = group.iter().enumerate().fold(0u32, |bits, (i, &b)| bits | u32::from(b) << (16 - 8 * i));
        for i in 0..4 {
            let digit = char::from(DIGITS[(bits >> (18 - 6 * i)) as usize & 63]);
            text.push(if i <= group.len() { digit } else { '=' });
        }
    }
    text
}

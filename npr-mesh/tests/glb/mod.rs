//! Small `.glb` files, made in memory.
#![allow(dead_code)]

use npr_mesh::{Limits, LoadError, LoadOptions, Loaded, load};
use serde_json::{Value, json};
use std::sync::atomic::{AtomicU32, Ordering};

/// Loads a file of these bytes.
pub fn load_glb(bytes: &[u8], limits: Limits) -> Result<Loaded, LoadError> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let folder = std::env::temp_dir().join(format!("npr-mesh-glb-{}-{number}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("the folder can be made");
    let path = folder.join("m.glb");
    std::fs::write(&path, bytes).expect("the file can be written");
    let loaded = load(&path, &LoadOptions { limits, ..LoadOptions::default() });
    let _ = std::fs::remove_dir_all(&folder);
    loaded
}

/// Accessors, each with a buffer view of its own, and what else the file has.
#[derive(Default)]
pub struct Document {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    pub rest: Value,
    pub limits: Limits,
}

impl Document {
    fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        self.views.push(json!({"buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len()}));
        self.binary.extend_from_slice(bytes);
        let view = self.views.len() - 1;
        self.accessors.push(json!({"bufferView": view, "componentType": component, "type": kind, "count": count}));
        view
    }

    fn floats(&mut self, values: &[f32], kind: &str, count: usize) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(&bytes, 5126, kind, count)
    }

    pub fn vec3s(&mut self, values: &[[f32; 3]]) -> usize {
        self.floats(values.as_flattened(), "VEC3", values.len())
    }

    pub fn vec4s(&mut self, values: &[[f32; 4]]) -> usize {
        self.floats(values.as_flattened(), "VEC4", values.len())
    }

    pub fn vec4_bytes(&mut self, values: &[[u8; 4]]) -> usize {
        self.accessor(values.as_flattened(), 5121, "VEC4", values.len())
    }

    pub fn bytes(&mut self, values: &[u8]) -> usize {
        self.accessor(values, 5121, "SCALAR", values.len())
    }

    /// Loads a file of one node with a mesh of these primitives.
    pub fn load(&self, primitives: Value) -> Result<Loaded, LoadError> {
        self.load_with(&json!({"meshes": [{"primitives": primitives}], "nodes": [{"mesh": 0}]}))
    }

    /// Loads a file with [`Document::rest`].
    pub fn load_whole(&self) -> Result<Loaded, LoadError> {
        self.load_with(&self.rest)
    }

    fn load_with(&self, rest: &Value) -> Result<Loaded, LoadError> {
        let mut root = json!({
            "asset": {"version": "2.0"}, "buffers": [{"byteLength": self.binary.len()}],
            "bufferViews": self.views, "accessors": self.accessors,
        });
        let members = rest.as_object().cloned().unwrap_or_default();
        root.as_object_mut().expect("it is one").extend(members);
        load_glb(&container(root.to_string().as_bytes(), &self.binary), self.limits)
    }
}

fn container(json: &[u8], binary: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, binary) = (padded(json, b' '), padded(binary, 0));
    let word = |number: usize| (number as u32).to_le_bytes();
    let mut file = [&b"glTF"[..], &word(2), &word(28 + json.len() + binary.len())].concat();
    file.extend([&word(json.len())[..], b"JSON", &json, &word(binary.len()), b"BIN\0", &binary].concat());
    file
}

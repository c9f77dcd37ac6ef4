//! The buffer of a file, its views and accessors.

use serde_json::{Map, Value, json};

/// Bytes, and what reads them.
#[derive(Default)]
pub(super) struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

/// The type of indices.
#[derive(Clone, Copy)]
pub(super) enum Component {
    U16,
    U32,
}

impl Buffer {
    /// The number of a view of these bytes, which begin at a multiple of 4.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend_from_slice(bytes);
        self.views.len() - 1
    }

    fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        self.accessors.push(json!({"bufferView": view, "componentType": component, "type": kind, "count": count}));
        self.accessors.len() - 1
    }

    /// The number of an accessor of floats; `kind` is `VEC2`, `VEC3` or `VEC4`.
    pub fn floats(&mut self, values: &[f32], kind: &str) -> usize {
        let lanes = usize::from(kind.as_bytes()[3] - b'0');
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(&bytes, 5126, kind, values.len() / lanes)
    }

    /// The number of an accessor of positions, with their bounds, which glTF requires.
    pub fn positions(&mut self, positions: &[[f32; 3]]) -> usize {
        let number = self.floats(positions.as_flattened(), "VEC3");
        let bound = |pick: fn(f32, f32) -> f32| {
            positions.iter().copied().reduce(|a, b| [0, 1, 2].map(|axis| pick(a[axis], b[axis])))
        };
        if let (Some(low), Some(high)) = (bound(f32::min), bound(f32::max)) {
            self.accessors[number]["min"] = json!(low.map(f64::from));
            self.accessors[number]["max"] = json!(high.map(f64::from));
        }
        number
    }

    /// The number of an accessor of indices.
    pub fn integers<T: bytemuck::Pod>(&mut self, values: &[T], component: Component) -> usize {
        let component = match component {
            Component::U16 => 5123,
            Component::U32 => 5125,
        };
        self.accessor(bytemuck::cast_slice(values), component, "SCALAR", values.len())
    }

    /// The number of an accessor of bytes.
    pub fn bytes(&mut self, values: &[u8]) -> usize {
        self.accessor(values, 5121, "SCALAR", values.len())
    }

    /// Adds views and accessors to the file's members, and returns the bytes.
    pub fn finish(self, members: &mut Map<String, Value>) -> Vec<u8> {
        // Empty arrays are not allowed.
        for (key, values) in [("bufferViews", self.views), ("accessors", self.accessors)] {
            if !values.is_empty() {
                members.insert(key.to_owned(), Value::Array(values));
            }
        }
        if !self.bytes.is_empty() {
            members.insert("buffers".to_owned(), json!([{"byteLength": self.bytes.len()}]));
        }
        self.bytes
    }
}

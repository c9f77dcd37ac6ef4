//! What the structures of the `gltf` crate leave out: transforms in f64, extensions, and the indices of unused parts.

use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// Further properties of a document. The arrays have the order of the file.
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Extra {
    pub nodes: Vec<ExtraNode>,
    pub meshes: Vec<ExtraMesh>,
    pub textures: Vec<ExtraTexture>,
    pub buffer_views: Vec<ExtraView>,
    pub animations: Vec<ExtraAnimation>,
    pub cameras: Vec<IgnoredAny>,
}

/// The transform of a node in the precision of the file.
#[derive(Default, Deserialize)]
#[serde(default)]
pub(super) struct ExtraNode {
    // Boxed, since most nodes lack most of them and a file may have a million nodes.
    pub translation: Option<Box<[f64; 3]>>,
    pub rotation: Option<Box<[f64; 4]>>,
    pub scale: Option<Box<[f64; 3]>>,
    pub matrix: Option<Box<[f64; 16]>>,
    extensions: Option<Box<NodeExtensions>>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct NodeExtensions {
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    instancing: Option<Instancing>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct Instancing {
    attributes: BTreeMap<String, u32>,
}

impl ExtraNode {
    /// The accessors of `EXT_mesh_gpu_instancing` by attribute.
    pub fn instancing(&self) -> Option<&BTreeMap<String, u32>> {
        self.extensions.as_ref()?.instancing.as_ref().map(|instancing| &instancing.attributes)
    }
}

#[derive(Default, Deserialize)]
#[serde(default)]
pub(super) struct ExtraMesh {
    primitives: Vec<ExtraPrimitive>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct ExtraPrimitive {
    extensions: Option<BTreeMap<String, IgnoredAny>>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
pub(super) struct ExtraTexture {
    pub extensions: Option<Map<String, Value>>,
}

impl ExtraTexture {
    /// The image that an extension states.
    pub fn source(&self, extension: &str) -> Option<u64> {
        self.extensions.as_ref()?.get(extension)?.get("source")?.as_u64()
    }
}

#[derive(Default, Deserialize)]
#[serde(default)]
pub(super) struct ExtraView {
    pub extensions: Option<Box<Map<String, Value>>>,
}

/// The indices in an animation, which has no other use here.
#[derive(Default, Deserialize)]
#[serde(default)]
pub(super) struct ExtraAnimation {
    pub channels: Vec<ExtraChannel>,
    pub samplers: Vec<ExtraSampler>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
pub(super) struct ExtraChannel {
    pub sampler: Option<u32>,
    pub target: ExtraTarget,
}

#[derive(Default, Deserialize)]
#[serde(default)]
pub(super) struct ExtraTarget {
    /// Absent where an extension states the target.
    pub node: Option<u32>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
pub(super) struct ExtraSampler {
    pub input: Option<u32>,
    pub output: Option<u32>,
}

impl Extra {
    /// The names of the extensions of a primitive.
    pub fn primitive_extensions(&self, mesh: usize, primitive: usize) -> impl Iterator<Item = &str> {
        let found = self.meshes.get(mesh).and_then(|mesh| mesh.primitives.get(primitive));
        found
            .and_then(|primitive| primitive.extensions.as_ref())
            .into_iter()
            .flat_map(|of| of.keys().map(String::as_str))
    }
}

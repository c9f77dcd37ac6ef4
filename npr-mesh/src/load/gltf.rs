//! glTF 2.0, `.gltf` and `.glb`, flattened into one posed [`Model`](crate::Model).
//!
//! The `gltf` crate turns the JSON into typed structures and does nothing else here. Its validation is not run: it
//! panics where a POSITION attribute names an accessor that does not exist, it lets cycles of nodes and accessors
//! beyond their buffers pass, and it refuses files that can be drawn (a POSITION accessor without bounds). So every
//! index is looked up with a check, and vertex data goes through [`accessor`], which checks its bounds.
//!
//! What of a file counts: the meshes of its default scene (or the first one, or all nodes where there is no scene)
//! with node transforms, skins and morph targets in the pose that the file states, no animation; base colour,
//! alpha mode, sidedness and vertex colours. Extensions: `KHR_texture_transform` (base colour texture),
//! `KHR_mesh_quantization`, and `KHR_materials_unlit`, which changes nothing that is kept.

mod accessor;
mod files;
mod materials;
mod meshes;
mod pose;
mod scene;

use super::{Loaded, read_file};
use crate::{Limits, LoadError};
use files::Bytes;
use gltf::json::{self, Root};
use std::path::Path;

const EXTENSIONS: [&str; 3] = ["KHR_materials_unlit", "KHR_mesh_quantization", "KHR_texture_transform"];

/// A parsed file and the bytes that it refers to.
struct Document<'a> {
    path: &'a Path,
    limits: &'a Limits,
    root: Root,
    /// One for each buffer, as long as the file says.
    buffers: Vec<Bytes<'a>>,
}

impl Document<'_> {
    fn malformed(&self, fault: impl Into<String>) -> LoadError {
        malformed(self.path, fault)
    }

    fn too_large(&self, what: &'static str, count: u64, limit: u64) -> LoadError {
        LoadError::TooLarge { path: self.path.to_owned(), what, count, limit }
    }
}

fn malformed(path: &Path, fault: impl Into<String>) -> LoadError {
    LoadError::Malformed { path: path.to_owned(), fault: fault.into() }
}

/// Reads a file. Normals that it does not have are zero; the model may be empty.
///
/// # Errors
/// [`LoadError`], which names the file and the fault.
pub(super) fn load(path: &Path, limits: &Limits) -> Result<Loaded, LoadError> {
    let bytes = read_file(path, limits)?;
    let (text, binary) = files::split_container(&bytes).map_err(|fault| malformed(path, fault))?;
    let root: Root =
        json::deserialize::from_slice(text).map_err(|error| malformed(path, format!("not glTF 2.0: {error}")))?;
    let mut warnings = Vec::new();
    check_requirements(path, &root, &mut warnings)?;
    let buffers = files::buffers(path, limits, &root, binary)?;
    let document = Document { path, limits, root, buffers };
    let nodes = scene::pose(&document)?;
    let model = meshes::flatten(&document, &nodes, &mut warnings)?;
    Ok(Loaded { model, warnings })
}

/// The version (glTF 2.0, 3.2 "Asset") and the extensions (3.12 "Specifying Extensions").
fn check_requirements(path: &Path, root: &Root, warnings: &mut Vec<String>) -> Result<(), LoadError> {
    let unsupported = |feature: String| Err(LoadError::Unsupported { path: path.to_owned(), feature });
    // `minVersion` is what a file needs; without it, any 2.x may be read as 2.0.
    let asset = &root.asset;
    if let Some(needed) = asset.min_version.as_deref().filter(|v| *v != "2.0") {
        return unsupported(format!("glTF {needed}"));
    }
    if asset.version != "2" && !asset.version.starts_with("2.") {
        return unsupported(format!("glTF {}", asset.version));
    }
    if let Some(name) = root.extensions_required.iter().find(|name| !EXTENSIONS.contains(&name.as_str())) {
        return unsupported(format!("the extension {name}"));
    }
    let ignored = root.extensions_used.iter().filter(|name| !EXTENSIONS.contains(&name.as_str()));
    warnings.extend(ignored.map(|name| format!("the extension {name} is ignored")));
    Ok(())
}

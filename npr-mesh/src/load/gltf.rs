//! Loads glTF 2.0, `.gltf` and `.glb`: meshes, and the objects that place them.
//!
//! The `gltf` crate only converts the JSON prepared by [`parse`] to typed structures. Its validation is not used: it
//! panics on a POSITION attribute with a missing accessor, accepts cycles of nodes and accessors beyond their
//! buffers, and rejects files that can be drawn (a POSITION accessor without bounds). Every index is therefore
//! checked here, and vertex data is read through [`accessor`], which checks bounds.
//!
//! The objects are the nodes with meshes of the default scene (or of the first scene, or all of them if there is no
//! scene), with node transforms, skins and morph targets in the pose that the file states, without animation.
//! Materials consist of base colour, alpha mode and sidedness, and there are vertex colours. Supported extensions: `KHR_texture_transform` (base colour
//! texture), `KHR_mesh_quantization`, and `KHR_materials_unlit`, which has no effect here.

mod accessor;
mod document;
mod files;
mod materials;
mod meshes;
mod parse;
mod pose;
mod scene;

use super::external::{External, shortened};
use super::file::Parsed;
use crate::LoadError;
use document::{Bytes, Document, QUANTIZATION, malformed};
use gltf::json::Root;
use std::path::Path;

const EXTENSIONS: [&str; 3] = ["KHR_materials_unlit", QUANTIZATION, "KHR_texture_transform"];

/// Loads a file. Missing normals are zero, and there may be no objects.
///
/// # Errors
/// [`LoadError`] with the file and the fault.
pub(super) fn load(file: Vec<u8>, external: &External) -> Result<Parsed, LoadError> {
    let (path, limits) = (external.model, external.limits);
    let mut warnings = Vec::new();
    let (text, binary) = files::split_container(&file, &mut warnings).map_err(|fault| malformed(path, fault))?;
    let root = parse::parse(text, &mut warnings).map_err(|fault| malformed(path, format!("not glTF 2.0: {fault}")))?;
    check_requirements(path, &root, &mut warnings)?;
    let (buffers, of_buffers) = files::buffers(external, &root, binary)?;
    let quantized = root.extensions_used.iter().chain(&root.extensions_required).any(|name| name == QUANTIZATION);
    let bytes = file.len() as u64 + of_buffers;
    let document = Document { path, limits, external, root, buffers, bytes, quantized };
    let nodes = scene::pose(&document)?;
    let (meshes, objects) = meshes::load(&document, &nodes, &mut warnings)?;
    warnings.extend(document.buffers.iter().enumerate().filter_map(|(number, bytes)| match bytes {
        Bytes::Missing(fault) => Some(format!("buffer {number} is left out, and no mesh needs it: {fault}")),
        _ => None,
    }));
    Ok(Parsed { meshes, objects, warnings, ..Parsed::default() })
}

/// Checks the version (glTF 2.0, 3.2 "Asset") and the extensions (3.12 "Specifying Extensions").
fn check_requirements(path: &Path, root: &Root, warnings: &mut Vec<String>) -> Result<(), LoadError> {
    let unsupported = |feature: String| Err(LoadError::Unsupported { path: path.to_owned(), feature });
    let version = |text: &str| {
        let (major, minor) = text.split_once('.')?;
        let number = |digits: &str| digits.bytes().all(|b| b.is_ascii_digit()).then(|| digits.parse::<u32>().ok())?;
        Some((number(major)?, number(minor)?))
    };
    // `minVersion` is the required version. Without it, any version 2.x is read as 2.0.
    let asset = &root.asset;
    if let Some(needed) = asset.min_version.as_deref()
        && version(needed).is_none_or(|needed| needed > (2, 0))
    {
        return unsupported(format!("glTF {}", shortened(needed)));
    }
    if asset.version != "2" && version(&asset.version).is_none_or(|(major, _)| major != 2) {
        return unsupported(format!("glTF {}", shortened(&asset.version)));
    }
    let unknown = |names: &[String]| -> Vec<String> {
        names.iter().filter(|name| !EXTENSIONS.contains(&name.as_str())).map(|name| shortened(name)).collect()
    };
    match &unknown(&root.extensions_required)[..] {
        [] => {}
        [name] => return unsupported(format!("the extension {name}")),
        names => return unsupported(format!("the extensions {}", names.join(", "))),
    }
    warnings.extend(unknown(&root.extensions_used).iter().map(|name| format!("the extension {name} is ignored")));
    Ok(())
}

//! Loads glTF 2.0, `.gltf` and `.glb`: meshes, and the objects that place them.
//!
//! The `gltf` crate only converts the JSON prepared by [`parse`] to typed structures. Its validation is not used: it
//! panics on a POSITION attribute with a missing accessor, accepts cycles of nodes and accessors beyond their
//! buffers, and rejects files that can be drawn (a POSITION accessor without bounds). Every index is therefore
//! checked here, and vertex data is read through [`accessor`], which checks bounds.
//!
//! The objects are the nodes with meshes of the default scene (or of the first scene, or all of them if there is no
//! scene), with node transforms, instances, skins and morph targets in the pose that the file states, without animation.
//! Transforms are composed in f64. Materials consist of base colour, emission, alpha mode and sidedness, and there are
//! vertex colours. Primitives of lines become [`crate::Model::lines`]; those of points are ignored.
//!
//! Supported extensions are [`EXTENSIONS`]. Where an extension is supported, what it states is used, and what the file
//! has for readers without the extension is not: a specular-glossiness material before a metallic-roughness material, a
//! WebP image before the texture's own source, compressed data before those of the fallback buffer. Of an extension that
//! is not supported, the fallback is used; without one, a texture is left out with a warning, and geometry is an error.

mod accessor;
mod compressed;
mod compressed_view;
mod document;
mod edge_visibility;
mod extensions;
mod extra;
mod files;
mod indices;
mod instancing;
mod lines;
mod materials;
mod meshes;
mod parse;
mod pose;
mod scene;
mod slice;

use super::external::{External, shortened};
use super::file::Parsed;
use crate::LoadError;
use document::{Bytes, Document, malformed};
use extensions::{EXTENSIONS, QUANTIZATION};
use gltf::json::Root;
use parse::ParseFault;
use std::path::Path;

/// Loads a file. Missing normals are zero, and there may be no objects.
///
/// # Errors
/// [`LoadError`] with the file and the fault.
pub(super) fn load(file: Vec<u8>, external: &External) -> Result<Parsed, LoadError> {
    let (path, limits) = (external.model, external.limits);
    let mut warnings = Vec::new();
    let (text, binary) = files::split_container(&file, &mut warnings).map_err(|fault| malformed(path, fault))?;
    let (root, extra) = parse::parse(text, &mut warnings).map_err(|fault| match fault {
        ParseFault::Version(version) => version_error(path, &version),
        ParseFault::Malformed(fault) => malformed(path, format!("not glTF 2.0: {fault}")),
    })?;
    check_requirements(path, &root, &mut warnings)?;
    let (buffers, of_buffers) = files::buffers(external, &root, binary)?;
    let quantized = root.extensions_used.iter().chain(&root.extensions_required).any(|name| name == QUANTIZATION);
    let bytes = file.len() as u64 + of_buffers;
    let mut document =
        Document { path, limits, external, root, extra, buffers, bytes, quantized, decoded: Default::default() };
    indices::check(&document)?;
    compressed::find(&mut document)?;
    let nodes = scene::pose(&document)?;
    let (meshes, objects) = meshes::load(&document, &nodes, &mut warnings)?;
    if objects.is_empty() && nodes.shown.iter().all(|&node| document.root.nodes[node].mesh.is_none()) {
        let meshes = document.root.meshes.len();
        return if meshes == 0 {
            Ok(Parsed { objects, warnings, ..Parsed::default() })
        } else {
            Err(LoadError::NotPlaced { path: path.to_owned(), meshes })
        };
    }
    warnings.extend(document.buffers.iter().enumerate().filter_map(|(number, bytes)| match bytes {
        Bytes::Missing(fault) if !compressed::is_fallback(&document, number) => {
            Some(format!("buffer {number} is left out, and no mesh needs it: {fault}"))
        }
        _ => None,
    }));
    Ok(Parsed { meshes, objects, warnings, ..Parsed::default() })
}

fn version_error(path: &Path, version: &str) -> LoadError {
    LoadError::Unsupported { path: path.to_owned(), feature: format!("glTF {version}") }
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
        return Err(version_error(path, &shortened(&asset.version)));
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

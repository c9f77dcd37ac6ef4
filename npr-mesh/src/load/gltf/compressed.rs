//! Geometry that is compressed by an extension: `EXT_meshopt_compression` and `KHR_meshopt_compression`, which are
//! decompressed, and others, which are errors.

use super::compressed_view::{CompressedView, Meshopt};
use super::document::Document;
use super::extensions::{EXTENSIONS, MESHOPT};
use crate::LoadError;
use gltf::json::mesh::Primitive;
use gltf::json::{Index, accessor};
use serde::Deserialize;

/// The maximum ratio of decompressed to compressed bytes, beyond [`FREE_BYTES`].
const MOST_EXPANSION: u64 = 64;

/// Decompressed bytes of a file, however small it is.
const FREE_BYTES: u64 = 256 << 20;

/// Finds the compressed buffer views. Their decompressed bytes are added to those of the document.
///
/// # Errors
/// Invalid properties, a buffer that does not exist, and exceeded limits.
pub(super) fn find(document: &mut Document) -> Result<(), LoadError> {
    let mut found = std::collections::BTreeMap::new();
    let mut bytes = 0u64;
    for (number, extra) in document.extra.buffer_views.iter().enumerate() {
        let Some(extensions) = &extra.extensions else { continue };
        let Some((extension, value)) = MESHOPT.iter().find_map(|name| Some((*name, extensions.get(*name)?))) else {
            continue;
        };
        let fail = |fault: String| document.malformed(format!("buffer view {number}: {extension}: {fault}"));
        let stated = Meshopt::deserialize(value).map_err(|error| fail(error.to_string()))?;
        if stated.buffer >= document.buffers.len() {
            return Err(fail(format!("buffer {} does not exist", stated.buffer)));
        }
        let length = document.root.buffer_views[number].byte_length.0;
        let size = (stated.count as u64).checked_mul(stated.byte_stride as u64);
        if size != Some(length) {
            let Meshopt { count, byte_stride, .. } = stated;
            return Err(fail(format!("{count} elements of {byte_stride} bytes in a buffer view of {length} bytes")));
        }
        bytes = bytes.saturating_add(length);
        found.insert(number, CompressedView::new(extension, stated));
    }
    let limit =
        FREE_BYTES.saturating_add(document.bytes.saturating_mul(MOST_EXPANSION)).min(document.limits.file_bytes);
    if bytes > limit {
        return Err(document.too_large("bytes in compressed buffer views", bytes, limit));
    }
    document.bytes += bytes;
    document.decoded = found;
    Ok(())
}

/// Whether a buffer holds only the uncompressed content of buffer views that are decompressed here.
pub(super) fn is_fallback(document: &Document, buffer: usize) -> bool {
    let mut of_buffer =
        (document.root.buffer_views.iter().enumerate()).filter(|(_, view)| view.buffer.value() == buffer);
    let is_compressed = |(number, _): (usize, _)| document.decoded.contains_key(&number);
    !document.decoded.is_empty() && of_buffer.all(is_compressed)
}

/// Refuses a primitive whose geometry is in an extension that is not supported: one of its accessors has no data.
/// Without an extension such an accessor is all zeros.
///
/// # Errors
/// [`LoadError::Unsupported`] with the names of the extensions.
pub(super) fn refuse_unsupported(
    document: &Document,
    mesh: usize,
    at: usize,
    primitive: &Primitive,
) -> Result<(), LoadError> {
    let has_data = |index: Index<accessor::Accessor>| {
        let accessor = &document.root.accessors[index.value()];
        accessor.buffer_view.is_some() || accessor.sparse.is_some() || accessor.count.0 == 0
    };
    if primitive.attributes.values().copied().chain(primitive.indices).all(has_data) {
        return Ok(());
    }
    let unknown: Vec<String> = (document.extra.primitive_extensions(mesh, at))
        .filter(|name| !EXTENSIONS.contains(name))
        .map(crate::load::external::shortened)
        .collect();
    match &unknown[..] {
        [] => Ok(()),
        names => Err(document.unsupported(format!(
            "the extension {} for the geometry of mesh {mesh} primitive {at}",
            names.join(" or ")
        ))),
    }
}

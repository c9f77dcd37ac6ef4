//! Geometry that is compressed by an extension: `EXT_meshopt_compression` and `KHR_meshopt_compression`, which are
//! decompressed, and others, which are errors.

use super::document::Document;
use super::files;
use super::{EXTENSIONS, document};
use crate::LoadError;
use gltf::json::mesh::Primitive;
use gltf::json::{Index, accessor};
use meshoptimizer_rs::{Workspace, codec};
use serde::Deserialize;
use std::cell::OnceCell;

/// The extensions of a buffer view that is compressed by meshoptimizer: the second has a further version of the vertex
/// codec and a filter for colours.
pub(super) const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// The maximum ratio of decompressed to compressed bytes, beyond [`FREE_BYTES`].
const MOST_EXPANSION: u64 = 64;

/// Decompressed bytes of a file, however small it is.
const FREE_BYTES: u64 = 256 << 20;

/// A buffer view whose content is compressed.
pub(super) struct CompressedView {
    extension: &'static str,
    stated: Meshopt,
    /// The decompressed content, or why there is none.
    content: OnceCell<Result<Vec<u8>, String>>,
}

/// The properties of both extensions.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Meshopt {
    buffer: usize,
    #[serde(default)]
    byte_offset: u64,
    byte_length: u64,
    byte_stride: usize,
    count: usize,
    mode: String,
    #[serde(default)]
    filter: Option<String>,
}

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
        found.insert(number, CompressedView { extension, stated, content: OnceCell::new() });
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

impl CompressedView {
    /// The decompressed content.
    ///
    /// # Errors
    /// The fault with the name of the extension.
    pub fn content(&self, document: &Document) -> Result<&[u8], String> {
        let decode = || {
            let Meshopt { buffer, byte_offset, byte_length, .. } = self.stated;
            let fail = |fault: String| format!("{}: {fault}", self.extension);
            let bytes =
                document.buffers[buffer].as_slice().map_err(|fault| fail(format!("buffer {buffer}: {fault}")))?;
            let source = files::slice(bytes, byte_offset, byte_length).ok_or_else(|| {
                let range = format!("{byte_length} bytes from byte {byte_offset}");
                fail(format!("{range} reach beyond buffer {buffer}, which has {}", bytes.len()))
            })?;
            self.decode(source).map_err(fail)
        };
        self.content.get_or_init(decode).as_deref().map_err(Clone::clone)
    }

    fn decode(&self, source: &[u8]) -> Result<Vec<u8>, String> {
        let Meshopt { count, byte_stride: stride, .. } = self.stated;
        let space = &mut Workspace::default();
        let mode = self.stated.mode.as_str();
        let is_khr = self.extension == MESHOPT[1];
        if mode == "ATTRIBUTES" && !is_khr && source.first().is_some_and(|head| *head != 0xA0) {
            return Err("another version of the codec than that of the extension".to_owned());
        }
        let decoded = match mode {
            "ATTRIBUTES" => codec::decode_vertex_buffer(count, stride, source, space),
            "TRIANGLES" => codec::decode_index_buffer(count, stride, source, space),
            "INDICES" => codec::decode_index_sequence(count, stride, source, space),
            other => return Err(format!("unknown mode {}", document::name(Some(other)))),
        };
        let mut bytes = decoded.map_err(|error| error.to_string())?;
        let filtered = match self.stated.filter.as_deref().unwrap_or("NONE") {
            "NONE" => Ok(()),
            filter if mode != "ATTRIBUTES" => return Err(format!("filter {filter} of {mode}")),
            "OCTAHEDRAL" => codec::decode_filter_oct(&mut bytes, count, stride, space),
            "QUATERNION" => codec::decode_filter_quat(&mut bytes, count, stride, space),
            "EXPONENTIAL" => codec::decode_filter_exp(&mut bytes, count, stride, space),
            "COLOR" if is_khr => codec::decode_filter_color(&mut bytes, count, stride, space),
            other => return Err(format!("unknown filter {}", document::name(Some(other)))),
        };
        filtered.map_err(|error| error.to_string())?;
        Ok(bytes)
    }
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

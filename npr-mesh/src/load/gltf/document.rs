//! A parsed glTF file.

use super::compressed_view::CompressedView;
use super::extra::Extra;
use crate::load::external::External;
use crate::{Limits, LoadError};
use gltf::json::Root;
use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;

/// A parsed file and the data that it refers to.
pub(super) struct Document<'a> {
    pub path: &'a Path,
    pub limits: &'a Limits,
    pub external: &'a External<'a>,
    pub root: Root,
    pub extra: Extra,
    /// The buffers, with the lengths that the file states.
    pub buffers: Vec<Bytes<'a>>,
    /// The total size of the file and its buffers in bytes.
    pub bytes: u64,
    /// Whether attributes may have the types of `KHR_mesh_quantization`.
    pub quantized: bool,
    /// Compressed buffer views, decompressed on first use.
    pub decoded: BTreeMap<usize, CompressedView>,
}

impl Document<'_> {
    pub fn malformed(&self, fault: impl Into<String>) -> LoadError {
        malformed(self.path, fault)
    }

    pub fn unsupported(&self, feature: String) -> LoadError {
        LoadError::Unsupported { path: self.path.to_owned(), feature }
    }

    pub fn too_large(&self, what: &'static str, count: u64, limit: u64) -> LoadError {
        LoadError::TooLarge { path: self.path.to_owned(), what, count, limit }
    }
}

pub fn malformed(path: &Path, fault: impl Into<String>) -> LoadError {
    LoadError::Malformed { path: path.to_owned(), fault: fault.into() }
}

/// A name in the file, or empty. Many objects may repeat one name, so a long one is cut.
pub fn name(name: Option<&str>) -> String {
    const MOST: usize = 100;
    let name = name.unwrap_or_default();
    let end = name.char_indices().nth(MOST).map_or(name.len(), |(end, _)| end);
    name[..end].to_owned()
}

/// The content of a buffer.
pub enum Bytes<'a> {
    /// The binary chunk of the file.
    Chunk(&'a [u8]),
    /// The content of a URI and the length of the buffer; buffers may share a file.
    Resource(Rc<Vec<u8>>, usize),
    /// Unavailable, with the reason. It is an error only if a shown mesh needs the buffer.
    Missing(String),
}

impl Bytes<'_> {
    pub fn as_slice(&self) -> Result<&[u8], &str> {
        match self {
            Bytes::Chunk(bytes) => Ok(bytes),
            Bytes::Resource(bytes, length) => Ok(&bytes[..*length]),
            Bytes::Missing(fault) => Err(fault),
        }
    }
}

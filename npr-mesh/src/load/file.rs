//! What the loaders of all formats read and return.

use crate::{Limits, LoadError, Model, Object};
use std::fs;
use std::io::{self, Read};
use std::path::Path;

/// The result of a format's loader: normals may be missing, and there may be no object.
#[derive(Default)]
pub struct Parsed {
    /// Each with faces or lines.
    pub meshes: Vec<Model>,
    pub objects: Vec<Object>,
    /// In the order of occurrence, with repetitions.
    pub warnings: Vec<String>,
    /// Per mesh, or shorter: the smoothing group of each face, see [`crate::normals::fill_missing_in_groups`]. Empty
    /// where the file has no groups.
    pub smoothing: Vec<Vec<u32>>,
}

/// Reads a regular file within [`Limits::file_bytes`].
pub fn read_file(path: &Path, limits: &Limits) -> Result<Vec<u8>, LoadError> {
    let failed = |source: io::Error| LoadError::Read { path: path.to_owned(), source };
    let too_large = |count| LoadError::TooLarge {
        path: path.to_owned(),
        what: "bytes in the file",
        count,
        limit: limits.file_bytes,
    };
    // Checked before opening, since opening a pipe may block.
    let metadata = fs::metadata(path).map_err(failed)?;
    if !metadata.is_file() {
        return Err(failed(io::Error::other("not a regular file")));
    }
    if metadata.len() > limits.file_bytes {
        return Err(too_large(metadata.len()));
    }
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).unwrap_or(0));
    let file = fs::File::open(path).map_err(failed)?;
    // The file may grow after its length was read.
    file.take(limits.file_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > limits.file_bytes {
        return Err(too_large(bytes.len() as u64));
    }
    Ok(bytes)
}

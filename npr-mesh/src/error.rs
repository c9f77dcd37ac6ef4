//! What can be wrong with a model file.

use std::path::PathBuf;

/// Why a model could not be loaded. Every variant names the file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The ending is none that a loader of this build answers to.
    #[error("{}: unknown model format (expected .obj, .gltf or .glb)", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The file, or one that it refers to, could not be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file that could not be read.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file that the model names is neither in the model's own folder nor in
    /// `LoadOptions::asset_root`.
    #[error("{}: \"{name}\" leads out of the model's folder", path.display())]
    Outside {
        /// The model.
        path: PathBuf,
        /// The name in it.
        name: String,
    },
    /// The bytes are not what the format prescribes.
    #[error("{}: {fault}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// The element and what is wrong with it.
        fault: String,
    },
    /// Well-formed, and nothing in it to draw.
    #[error("{}: no triangle in it{}", path.display(), why.as_ref().map(|why| format!(" ({why})")).unwrap_or_default())]
    Empty {
        /// The file.
        path: PathBuf,
        /// The first of what was left out, if anything was.
        why: Option<String>,
    },
    /// A required extension, or another feature, that this crate does not have.
    #[error("{}: needs {feature}, which is not supported", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// What it asks for.
        feature: String,
    },
    /// More of something than [`crate::Limits`] allows.
    #[error("{}: {count} {what}, more than the limit of {limit}", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// What there is too much of.
        what: &'static str,
        /// How much there is.
        count: u64,
        /// How much is allowed.
        limit: u64,
    },
}

//! Errors of loading a model.

use std::path::PathBuf;

/// An error of loading a model. Every variant names the file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file extension belongs to no enabled loader.
    #[error("{}: unknown model format (expected .obj, .gltf, .glb, .ply or .stl)", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The file, or a file that it refers to, could not be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file that could not be read.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// A file that the model refers to is outside the model's folder and `LoadOptions::asset_root`.
    #[error("{}: \"{name}\" leads out of the model's folder", path.display())]
    Outside {
        /// The model file.
        path: PathBuf,
        /// The name in the model file.
        name: String,
    },
    /// The content of the file violates the format.
    #[error("{}: {fault}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// The element and its fault.
        fault: String,
    },
    /// The file is valid but contains neither a triangle nor a line.
    #[error("{}: no triangle in it{}", path.display(), why.as_ref().map(|why| format!(" ({why})")).unwrap_or_default())]
    Empty {
        /// The file.
        path: PathBuf,
        /// The first warning, if there is any.
        why: Option<String>,
    },
    /// The file has meshes, but no node of its scene places one.
    #[error("{}: no node of the scene places any of its {meshes} meshes", path.display())]
    NotPlaced {
        /// The file.
        path: PathBuf,
        /// The number of its meshes.
        meshes: usize,
    },
    /// The file requires an extension or another feature that is not supported.
    #[error("{}: needs {feature}, which is not supported", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// The required feature.
        feature: String,
    },
    /// A limit of [`crate::Limits`] is exceeded.
    #[error("{}: {count} {what}, more than the limit of {limit}", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The counted elements.
        what: &'static str,
        /// Their number.
        count: u64,
        /// The maximum number.
        limit: u64,
    },
    /// An image exceeds a limit of [`crate::Limits`].
    #[error("{}: image {image}: {count} {what}, more than the limit of {limit}", path.display())]
    ImageTooLarge {
        /// The model file.
        path: PathBuf,
        /// The name of the image in the model, or its number.
        image: String,
        /// The counted elements.
        what: &'static str,
        /// Their number.
        count: u64,
        /// The maximum number.
        limit: u64,
    },
}

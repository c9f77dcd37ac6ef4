//! Errors of writing models.

/// An error of writing a model.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// An object places a mesh that is not there.
    #[error("object {object} places mesh {mesh} of {meshes}")]
    Mesh {
        /// The index of the object.
        object: usize,
        /// The index of the mesh.
        mesh: usize,
        /// The number of meshes.
        meshes: usize,
    },
    /// A position, normal, texture coordinate, colour or transform is not finite.
    #[error("mesh {mesh}: {what} is not finite")]
    NotFinite {
        /// The index of the mesh.
        mesh: usize,
        /// What is not finite, in the singular.
        what: &'static str,
    },
    /// A texture cannot be encoded, for instance since its bytes are not those of its size.
    #[error("texture \"{name}\": {source}")]
    Texture {
        /// The name of the texture.
        name: String,
        /// The error of the encoder.
        source: image::ImageError,
    },
    /// A `.glb` file has at most 4 GiB.
    #[error("{bytes} bytes, more than the {limit} of a .glb file", limit = u32::MAX)]
    TooLarge {
        /// The size of the file.
        bytes: u64,
    },
}

//! Limits on the size of files.

/// Limits on what a loader accepts. Exceeding one is [`crate::LoadError::TooLarge`].
///
/// With the defaults, a small file is loaded in less than 2 GiB of memory whatever its content, and any model that
/// fits a machine of 16 GiB is loaded, unless it exceeds the limits on repetition or texture size. Raise those for
/// such models.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of the model file, and of all files together that it refers to.
    pub file_bytes: u64,
    /// Vertices of the flattened scene, including all instances.
    pub vertices: u64,
    /// Triangles of the flattened scene, including all instances; never more than [`crate::edges::MOST_FACES`].
    pub faces: u64,
    /// Vertices, and likewise triangles, that need not be backed by data. Above this number there must be 8 bytes per
    /// element in the file and its buffers. It limits the amplification by instances and by accessors without data.
    pub repeated: u64,
    /// Corners of one polygon.
    pub polygon_corners: u64,
    /// Nodes of a glTF file.
    pub nodes: u64,
    /// Primitives of glTF meshes, including all instances.
    pub instances: u64,
    /// Morph target displacements and joint weights that are read, including all instances.
    pub displacements: u64,
    /// Texels of one image.
    pub texels: u64,
    /// Texels of all images of a model; an image with two different samplers counts twice.
    pub texels_in_all: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            file_bytes: 4 << 30,
            vertices: 100_000_000,
            faces: 50_000_000,
            repeated: 2_000_000,
            polygon_corners: 100_000,
            nodes: 1_000_000,
            instances: 1_000_000,
            displacements: 200_000_000,
            texels: 1 << 26,
            texels_in_all: 3 << 25,
        }
    }
}

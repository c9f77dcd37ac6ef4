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
    /// Vertices of all objects: a mesh counts for every object that places it. This and the next limit also bound the
    /// model of `Loaded::into_model`.
    pub vertices: u64,
    /// Triangles of all objects, counted likewise; never more than [`crate::edges::MOST_FACES`].
    pub faces: u64,
    /// Vertices, and likewise triangles, that need not be backed by data. Above this number there must be 8 bytes per
    /// element in the file and its buffers. It limits the amplification by objects and by accessors without data.
    pub repeated: u64,
    /// Corners of one polygon.
    pub polygon_corners: u64,
    /// Nodes of a glTF file.
    pub nodes: u64,
    /// Primitives of all objects of a glTF file, counted like vertices.
    pub instances: u64,
    /// Morph target displacements and joint weights that are read, for every skinned node anew.
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

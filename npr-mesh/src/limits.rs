//! How large a file may be: all bounds in one place.

/// Bounds on what a loader accepts. Exceeding one is [`crate::LoadError::TooLarge`].
///
/// With the defaults a small file, whatever it says, is loaded in less than 2 GiB; any model that fits a machine of
/// 16 GiB is loaded too, unless it repeats itself more often, or has more texture, than they say. Raise them for those.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of the model file, and of all files together that it refers to.
    pub file_bytes: u64,
    /// Vertices of the flattened scene, all instances counted.
    pub vertices: u64,
    /// Triangles of the flattened scene, all instances counted; never more than [`crate::edges::MOST_FACES`].
    pub faces: u64,
    /// Vertices, and as many triangles, that need no bytes of their own in a file: beyond these there must be 8 bytes
    /// in the file and its buffers for each. Bounds what instances and accessors without data make of a few bytes.
    pub repeated: u64,
    /// Corners of one polygon.
    pub polygon_corners: u64,
    /// Nodes of a glTF file.
    pub nodes: u64,
    /// Primitives of glTF meshes, all instances counted.
    pub instances: u64,
    /// Displacements by morph targets and weights of joints that are read, all instances counted.
    pub displacements: u64,
    /// Texels of one image.
    pub texels: u64,
    /// Texels of all images of a model; one that is looked up in two ways counts twice.
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

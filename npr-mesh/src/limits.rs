//! How large a file may be: all bounds in one place.

/// Bounds on what a loader accepts. Exceeding one is [`crate::LoadError::TooLarge`].
///
/// The defaults fit any model that fits a machine of 16 GiB; raise them for larger ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of the model file, and of each file that it refers to.
    pub file_bytes: u64,
    /// Vertices of the flattened scene, all instances counted.
    pub vertices: u64,
    /// Triangles of the flattened scene, all instances counted.
    pub faces: u64,
    /// Corners of one polygon.
    pub polygon_corners: u64,
    /// Nodes of a glTF scene that are visited.
    pub nodes: u64,
    /// Texels of one image.
    pub texels: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            file_bytes: 4 << 30,
            vertices: 100_000_000,
            faces: 50_000_000,
            polygon_corners: 100_000,
            nodes: 1_000_000,
            texels: 1 << 28,
        }
    }
}

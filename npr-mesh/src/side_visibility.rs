//! What a file says about the edges of its faces.

/// What a file says about the line along a side of a face: the classes of the glTF extension
/// [`EXT_mesh_primitive_edge_visibility`](https://github.com/KhronosGroup/glTF/pull/2479), which programs for technical
/// drawing write.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum SideVisibility {
    /// The file says nothing, as of a primitive without the extension.
    #[default]
    Unstated,
    /// The edge is never drawn. Also the second side of an edge that is stated as a silhouette at its first.
    Hidden,
    /// The edge is drawn where it separates a front-facing from a back-facing face.
    Silhouette,
    /// The edge is always drawn.
    Hard,
    /// A further side of an edge that is stated as hard at another face.
    RepeatedHard,
}

impl SideVisibility {
    /// The sides (between corners 0 and 1, 1 and 2, 2 and 0) of a face whose corners 1 and 2 are exchanged.
    pub(crate) fn reversed([a, b, c]: [Self; 3]) -> [Self; 3] {
        [c, b, a]
    }
}

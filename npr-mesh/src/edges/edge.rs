//! A unique edge.

/// Represents a missing face.
pub const NO_FACE: u32 = u32::MAX;

/// The maximum number of faces that [`find`](super::find) accepts.
pub const MOST_FACES: usize = FACE as usize;

/// The number of faces at an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeKind {
    /// One face.
    Boundary,
    /// Two faces.
    TwoFace,
    /// Three or more faces.
    NonManifold,
}

/// A unique edge, 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Edge {
    /// The two vertices, as representatives of their positions, in the direction of the first face.
    pub ends: [u32; 2],
    /// The first two faces, and flags in the upper two bits of each.
    pub(super) packed: [u32; 2],
}

const _: () = assert!(size_of::<Edge>() == 16);

/// The bits of [`Edge::packed`] that hold a face index; all set if there is no face.
pub(super) const FACE: u32 = (1 << 30) - 1;
/// A flag in the first element of [`Edge::packed`].
pub(super) const NON_MANIFOLD: u32 = 1 << 30;
/// A flag in the first element of [`Edge::packed`].
pub(super) const TWO_MATERIALS: u32 = 1 << 31;
/// A flag in the second element of [`Edge::packed`].
pub(super) const SURROUNDED: u32 = 1 << 30;
/// A flag in the second element of [`Edge::packed`].
pub(super) const WOUND_OPPOSITELY: u32 = 1 << 31;

impl Edge {
    /// An edge with one face, such as a line that was drawn on it.
    ///
    /// # Panics
    /// If the face cannot be numbered.
    pub fn boundary(ends: [u32; 2], face: u32) -> Self {
        assert!(face < FACE, "face {face}, where there are at most {MOST_FACES}");
        Self { ends, packed: [face, FACE] }
    }

    /// The first two faces of the edge. The second is [`NO_FACE`] at a boundary.
    #[inline]
    pub fn faces(&self) -> [u32; 2] {
        self.packed.map(|packed| if packed & FACE == FACE { NO_FACE } else { packed & FACE })
    }

    /// The same edge of vertices and faces that are counted from these numbers on.
    pub(super) fn moved(&self, first_vertex: u32, first_face: u32) -> Self {
        // Flags are above the faces' bits, and a missing face stays missing.
        let face = |packed: u32| if packed & FACE == FACE { packed } else { packed + first_face };
        Self { ends: self.ends.map(|vertex| vertex + first_vertex), packed: self.packed.map(face) }
    }

    /// The number of faces at the edge.
    #[inline]
    pub fn kind(&self) -> EdgeKind {
        if self.packed[0] & NON_MANIFOLD != 0 {
            EdgeKind::NonManifold
        } else if self.packed[1] == FACE {
            EdgeKind::Boundary
        } else {
            EdgeKind::TwoFace
        }
    }

    /// Whether the first two faces traverse the edge in the same direction.
    #[inline]
    pub fn wound_oppositely(&self) -> bool {
        self.packed[1] & WOUND_OPPOSITELY != 0
    }

    /// Whether the faces of a non-manifold edge lie on all sides of it, so that for no eye all of them are on one side of
    /// the edge: it is never a silhouette. Known if the edges were found with
    /// [`EdgeOptions::merge_overlaps`](super::EdgeOptions::merge_overlaps).
    #[inline]
    pub fn is_surrounded(&self) -> bool {
        self.packed[1] & SURROUNDED != 0
    }

    /// Whether faces of different materials meet at the edge.
    #[inline]
    pub fn joins_two_materials(&self) -> bool {
        self.packed[0] & TWO_MATERIALS != 0
    }
}

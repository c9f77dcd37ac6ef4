//! Every unique edge of a model, with its faces, its kind and its dihedral angle.
//!
//! # Rules for topology that is not that of a closed surface
//!
//! - Vertices at exactly equal positions are one vertex ([`crate::weld`]).
//! - A diagonal that triangulation added (an edge between two faces of one polygon) is no edge, and a polygon's
//!   faces all have the polygon's Newell normal. Where a polygon is *folded* along its diagonals, though, by more than
//!   [`EdgeOptions::fold_rad`], some of its triangles can be turned towards an eye and others away. Its diagonals are
//!   never creases, but its contour may run along them, so they are listed apart ([`Edges::folds`]).
//! - An edge with one face is a *boundary*, with two a *two-face* edge, with more *non-manifold*. A face that runs
//!   over one edge twice (two of its corners are at one place) counts twice there.
//! - Two faces that run over their edge in the same direction are wound oppositely; the dihedral angle is that of
//!   the surface, with one of them turned round. So a face that a modeller turned by mistake makes no crease.
//! - A face of zero area has no normal, and its edges have no dihedral angle.
//! - For drawing, faces that add nothing to be seen are best left out ([`EdgeOptions::skip_redundant`]): a second
//!   face over the same three corners, whichever way it is wound, and a face with two corners at one place. Each
//!   would make edges non-manifold that are not.

mod diagonals;
mod folds;
mod normal;
mod redundant;
mod unique;

pub use normal::{face_normals, has_zero_area, triangle_normal};

use crate::weld;
use glam::Vec3;

/// Stands where there is no face.
pub const NO_FACE: u32 = u32::MAX;

/// More faces than this [`find`] does not take.
pub const MOST_FACES: usize = FACE as usize;

/// What [`find`] shall do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeOptions {
    /// Vertices within this distance are one; 0 means those at exactly equal positions. World units.
    pub weld_tolerance: f32,
    /// Leave out faces that lie exactly on another one or have two corners at one place. For drawing this is right;
    /// for counting what a file holds it is not.
    pub skip_redundant: bool,
    /// A polygon that turns by more than this at one of its diagonals, or lacks more than this of folding back, is
    /// folded: all of its diagonals are listed in [`Edges::folds`]. From π/2 on none is.
    pub fold_rad: f32,
}

/// [`EdgeOptions::fold_rad`] by default: 2°.
///
/// Of a polygon that is turned as a whole and stands out less, the contour strays by a quarter of its breadth times the
/// sine of the angle at most, half a pixel where it is 60 px broad. With 1° quads that are all but flat and seen edge-on
/// get a second line within a pixel of the first; with 5° the outlines of a smooth model made of quads already lose
/// pieces.
pub const FOLD_RAD: f32 = 0.035;

impl Default for EdgeOptions {
    fn default() -> Self {
        Self { weld_tolerance: 0.0, skip_redundant: true, fold_rad: FOLD_RAD }
    }
}

/// How many faces meet at an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeKind {
    /// Exactly one.
    Boundary,
    /// Exactly two.
    TwoFace,
    /// Three or more.
    NonManifold,
}

/// A unique edge, in 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Edge {
    /// The two vertices, representatives of their positions, in the direction in which the first face runs.
    pub ends: [u32; 2],
    /// The first two faces, and what else is known of the edge in the two upper bits of each.
    packed: [u32; 2],
}

const _: () = assert!(size_of::<Edge>() == 16);

/// The bits of [`Edge::packed`] that number a face; all of them set where there is none.
const FACE: u32 = (1 << 30) - 1;
/// In the first of [`Edge::packed`].
const NON_MANIFOLD: u32 = 1 << 30;
/// In the first of [`Edge::packed`].
const TWO_MATERIALS: u32 = 1 << 31;
/// In the second of [`Edge::packed`].
const WOUND_OPPOSITELY: u32 = 1 << 31;

impl Edge {
    /// The first two faces that have this edge; the second is [`NO_FACE`] at a boundary.
    #[inline]
    pub fn faces(&self) -> [u32; 2] {
        self.packed.map(|packed| if packed & FACE == FACE { NO_FACE } else { packed & FACE })
    }

    /// How many faces meet here.
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

    /// Whether its first two faces run over it in the same direction.
    #[inline]
    pub fn wound_oppositely(&self) -> bool {
        self.packed[1] & WOUND_OPPOSITELY != 0
    }

    /// Whether faces of different materials meet here.
    #[inline]
    pub fn joins_two_materials(&self) -> bool {
        self.packed[0] & TWO_MATERIALS != 0
    }
}

/// What [`find`] finds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Edges {
    /// The unique edges.
    pub edges: Vec<Edge>,
    /// Per face its unit normal (of a polygon's face, the polygon's), or zero where the area is zero.
    pub face_normals: Vec<Vec3>,
    /// Per vertex the lowest-numbered vertex at its position.
    pub representative: Vec<u32>,
    /// (edge, face) for the third and further faces of non-manifold edges, sorted by edge.
    pub further_faces: Vec<(u32, u32)>,
    /// Per face whether it was left out as redundant; empty if none was.
    pub skipped: Vec<bool>,
    /// The diagonals of folded polygons, each with its two triangles. Apart from [`Edges::edges`]: for counting what a
    /// file holds they are no edges, and for drawing they are silhouettes or nothing.
    pub folds: Vec<Edge>,
}

impl Edges {
    /// Cosine of the angle between the two faces' normals, wound alike: 1 where the surface goes straight on, −1
    /// where it folds back. `None` at a boundary or non-manifold edge and beside a face of zero area.
    #[inline]
    pub fn cos_dihedral(&self, edge: &Edge) -> Option<f32> {
        if edge.kind() != EdgeKind::TwoFace {
            return None;
        }
        let [n0, n1] = edge.faces().map(|face| self.face_normals[face as usize]);
        let cos = n0.dot(n1);
        // The normals are unit or zero, and a dot product of exactly 0 is a right angle far more often than a face
        // of zero area.
        if cos == 0.0 && (n0 == Vec3::ZERO || n1 == Vec3::ZERO) {
            return None;
        }
        Some(if edge.wound_oppositely() { -cos } else { cos })
    }

    /// What is irregular and was settled by a rule, as lines for people: faces that were left out, opposite windings.
    pub fn warnings(&self) -> Vec<String> {
        let skipped = self.skipped.iter().filter(|skipped| **skipped).count();
        let opposite = |edge: &&Edge| edge.kind() == EdgeKind::TwoFace && edge.wound_oppositely();
        let opposite = self.edges.iter().filter(opposite).count();
        [
            (skipped, "faces lie on another one or have two corners at one place: they have no edges of their own"),
            (opposite, "edges have faces wound oppositely: they make no crease"),
        ]
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{count} {what}"))
        .collect()
    }

    /// The angle by which the surface turns at an edge: 0 where it goes straight on, π where it folds back.
    /// `None` as for [`Edges::cos_dihedral`].
    pub fn dihedral_rad(&self, edge: &Edge) -> Option<f32> {
        self.cos_dihedral(edge).map(|cos| cos.clamp(-1.0, 1.0).acos())
    }
}

/// Finds all unique edges.
///
/// - `positions`: per vertex.
/// - `faces`: three vertices each, every one below `positions.len()`.
/// - `face_polygon`: as [`crate::Model::face_polygon`], empty or per face.
/// - `face_material`: per face, or empty where materials do not matter.
///
/// The edges are sorted by their lower ends, those of one by their upper ends, and each one's faces come in ascending
/// order.
///
/// Memory: 16 bytes an edge and a fold, 12 a face and 4 a vertex for what is returned; on the way the weld's, at most 24
/// bytes a vertex, and then 24 bytes a face and 4 a vertex. At most `3 * faces.len()` edges. Linear in faces and vertices;
/// n log n in the faces around a vertex that has many.
///
/// # Panics
/// If a face names a vertex that is not there, a per-face array has another length than stated, or there are more than
/// [`MOST_FACES`] faces.
pub fn find(
    positions: &[Vec3],
    faces: &[[u32; 3]],
    face_polygon: &[u32],
    face_material: &[u32],
    options: &EdgeOptions,
) -> Edges {
    assert!(face_polygon.is_empty() || face_polygon.len() == faces.len());
    assert!(face_material.is_empty() || face_material.len() == faces.len());
    assert!(faces.len() <= MOST_FACES, "{} faces, of which at most {MOST_FACES} can be numbered", faces.len());
    let representative = weld::weld_within(positions, options.weld_tolerance);
    let face_normals = face_normals(positions, faces, face_polygon);
    let mut found = unique::unique(faces, &representative, &[]);
    let mut skipped = Vec::new();
    if options.skip_redundant {
        skipped = redundant::skippable(&found.redundant, faces.len(), face_polygon);
        if !skipped.is_empty() {
            found = unique::unique(faces, &representative, &skipped);
        }
    }
    let unique::Unique { mut edges, mut further_faces, .. } = found;
    let mut folds = Vec::new();
    if !face_polygon.is_empty() {
        folds = diagonals::drop_diagonals(&mut edges, &mut further_faces, faces, &representative, face_polygon);
        folds::keep_folded(&mut folds, positions, faces, face_polygon, options.fold_rad);
    }
    mark_materials(&mut edges, &further_faces, face_material);
    Edges { edges, face_normals, representative, further_faces, skipped, folds }
}

fn mark_materials(edges: &mut [Edge], further_faces: &[(u32, u32)], face_material: &[u32]) {
    if face_material.windows(2).all(|pair| pair[0] == pair[1]) {
        return;
    }
    let material = |face: u32| face_material[face as usize];
    for edge in edges.iter_mut() {
        let [first, second] = edge.faces();
        if second != NO_FACE && material(first) != material(second) {
            edge.packed[0] |= TWO_MATERIALS;
        }
    }
    for &(edge, face) in further_faces {
        let edge = &mut edges[edge as usize];
        if material(face) != material(edge.faces()[0]) {
            edge.packed[0] |= TWO_MATERIALS;
        }
    }
}

#[cfg(test)]
mod tests;

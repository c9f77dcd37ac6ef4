//! The unique edges of a model, with their faces, kinds and dihedral angles.
//!
//! # Rules for non-manifold and degenerate topology
//!
//! - Vertices at exactly equal positions are one vertex ([`crate::weld`]).
//! - A diagonal that triangulation added, an edge between two faces of one polygon, is not an edge. All faces of a
//!   polygon have its Newell normal. If a polygon is *folded* along its diagonals by more than
//!   [`EdgeOptions::fold_rad`], some of its triangles can be front-facing and others back-facing. Its diagonals are
//!   never creases, but a contour may run along them, so they are listed separately ([`Edges::folds`]).
//! - An edge with one face is a *boundary* edge, with two faces a *two-face* edge, with more a *non-manifold* edge. A
//!   face with two corners at one position that contains an edge twice counts twice.
//! - Two faces that traverse their common edge in the same direction have opposite windings. The dihedral angle is
//!   then computed with one normal negated, so that a face with the wrong winding creates no crease.
//! - A face of zero area has no normal, and its edges have no dihedral angle.
//! - For drawing, redundant faces should be skipped ([`EdgeOptions::skip_redundant`]): duplicate faces with the same
//!   three corners in any winding, and faces with two corners at one position. They would make their edges
//!   non-manifold.

mod diagonals;
mod edge;
mod folds;
mod normal;
mod redundant;
mod unique;

pub use edge::{Edge, EdgeKind, MOST_FACES, NO_FACE};
pub use normal::{face_normals, has_zero_area, triangle_normal};

use crate::weld;
use edge::TWO_MATERIALS;
use glam::Vec3;

/// Options of [`find`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeOptions {
    /// Vertices within this distance are merged, in units of the positions. 0 merges vertices at exactly equal
    /// positions.
    pub weld_tolerance: f32,
    /// Whether to skip duplicate faces and faces with two corners at one position. Use `true` for drawing, and
    /// `false` to analyse the content of a file.
    pub skip_redundant: bool,
    /// The angle in radians from which on a polygon is folded: if the normals at one of its diagonals differ by more
    /// than this, and by less than π minus this, all of its diagonals are listed in [`Edges::folds`]. From π/2 on no
    /// polygon is folded.
    pub fold_rad: f32,
}

/// The default of [`EdgeOptions::fold_rad`], 2°.
///
/// For a polygon folded by a smaller angle, the contour deviates by at most a quarter of its width times the sine of
/// the angle, which is half a pixel at a width of 60 px. With 1°, nearly flat quads seen edge-on get a second line
/// within a pixel of the first; with 5°, the outlines of smooth models made of quads have gaps.
pub const FOLD_RAD: f32 = 0.035;

impl Default for EdgeOptions {
    fn default() -> Self {
        Self { weld_tolerance: 0.0, skip_redundant: true, fold_rad: FOLD_RAD }
    }
}

/// The result of [`find`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Edges {
    /// The unique edges.
    pub edges: Vec<Edge>,
    /// Per face its unit normal, that of the polygon for a face of a polygon, or zero for a face of zero area.
    pub face_normals: Vec<Vec3>,
    /// Per vertex the lowest-numbered vertex at its position.
    pub representative: Vec<u32>,
    /// (edge, face) for the third and further faces of non-manifold edges, sorted by edge.
    pub further_faces: Vec<(u32, u32)>,
    /// Per face whether it was skipped as redundant; empty if none was.
    pub skipped: Vec<bool>,
    /// The diagonals of folded polygons, each with its two triangles. They are not edges of the file, and are drawn
    /// only where they are silhouettes.
    pub folds: Vec<Edge>,
}

impl Edges {
    /// The cosine of the angle between the normals of the two faces in equal winding: 1 where the surface is flat, −1
    /// where it folds back. `None` at boundary and non-manifold edges and beside faces of zero area.
    #[inline]
    pub fn cos_dihedral(&self, edge: &Edge) -> Option<f32> {
        if edge.kind() != EdgeKind::TwoFace {
            return None;
        }
        let [n0, n1] = edge.faces().map(|face| self.face_normals[face as usize]);
        let cos = n0.dot(n1);
        // Normals are unit or zero. A dot product of exactly 0 usually is a right angle, so it is checked first.
        if cos == 0.0 && (n0 == Vec3::ZERO || n1 == Vec3::ZERO) {
            return None;
        }
        Some(if edge.wound_oppositely() { -cos } else { cos })
    }

    /// Messages about irregular topology that was resolved by a rule: skipped faces and opposite windings.
    pub fn warnings(&self) -> Vec<String> {
        let skipped = self.skipped.iter().filter(|skipped| **skipped).count();
        let opposite = |edge: &&Edge| edge.kind() == EdgeKind::TwoFace && edge.wound_oppositely();
        let opposite = self.edges.iter().filter(opposite).count();
        [
            (skipped, "faces are duplicates or have two corners at one position: they are skipped"),
            (opposite, "edges have faces of opposite winding: they are not creases"),
        ]
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{count} {what}"))
        .collect()
    }

    /// Appends the edges of another model, whose vertices and faces are counted from these numbers on. The two share no
    /// edge, even where they touch.
    ///
    /// # Panics
    /// If there are then more than [`MOST_FACES`] faces.
    pub fn append(&mut self, other: &Edges, first_vertex: u32, first_face: u32) {
        let (edges, faces) = (self.edges.len() as u32, first_face as usize + other.face_normals.len());
        assert!(faces <= MOST_FACES, "{faces} faces, of which at most {MOST_FACES} can be numbered");
        self.edges.extend(other.edges.iter().map(|edge| edge.moved(first_vertex, first_face)));
        self.folds.extend(other.folds.iter().map(|fold| fold.moved(first_vertex, first_face)));
        self.face_normals.extend_from_slice(&other.face_normals);
        self.representative.extend(other.representative.iter().map(|vertex| vertex + first_vertex));
        self.further_faces.extend(other.further_faces.iter().map(|(edge, face)| (edge + edges, face + first_face)));
        if !(self.skipped.is_empty() && other.skipped.is_empty()) {
            self.skipped.resize(first_face as usize, false);
            self.skipped.extend_from_slice(&other.skipped);
            self.skipped.resize(faces, false);
        }
    }

    /// The dihedral angle in radians: 0 where the surface is flat, π where it folds back. `None` as for
    /// [`Edges::cos_dihedral`].
    pub fn dihedral_rad(&self, edge: &Edge) -> Option<f32> {
        self.cos_dihedral(edge).map(|cos| cos.clamp(-1.0, 1.0).acos())
    }
}

/// Finds all unique edges.
///
/// - `positions`: per vertex.
/// - `faces`: three vertices each, every index below `positions.len()`.
/// - `face_polygon`: as [`crate::Model::face_polygon`], empty or per face.
/// - `face_material`: per face, or empty to ignore materials.
///
/// The edges are sorted by their lower and then by their upper vertex. The faces of an edge are in ascending order.
///
/// Memory: the result takes 16 bytes per edge and per fold, 12 bytes per face and 4 bytes per vertex. Temporarily,
/// welding takes up to 24 bytes per vertex, and the search 24 bytes per face and 4 bytes per vertex. There are at
/// most `3 * faces.len()` edges. The time is linear in faces and vertices, and n log n in the number of faces at a
/// vertex.
///
/// # Panics
/// If a face has an invalid vertex index, if a per-face array has another length than stated, or if there are more
/// than [`MOST_FACES`] faces.
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

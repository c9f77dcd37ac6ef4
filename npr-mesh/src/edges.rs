//! The unique edges of a model, with their faces, kinds and dihedral angles.
//!
//! # Rules for non-manifold and degenerate topology
//!
//! - Vertices that only rounding separates are one vertex ([`crate::weld`], [`EdgeOptions::weld`]).
//! - A diagonal that triangulation added, an edge between two faces of one polygon, is not an edge. All faces of a
//!   polygon have its Newell normal. If a polygon is *folded* along its diagonals by more than
//!   [`EdgeOptions::fold_rad`], some of its triangles can be front-facing and others back-facing. Its diagonals are
//!   never creases, but a contour may run along them, so they are listed separately ([`Edges::folds`]).
//! - An edge with one face is a *boundary* edge, with two faces a *two-face* edge, with more a *non-manifold* edge. A
//!   face with two corners at one position that contains an edge twice counts twice.
//! - Two faces that traverse their common edge in the same direction have opposite windings. The dihedral angle is
//!   then computed with one normal negated, so that a face with the wrong winding creates no crease.
//! - A face of zero area has no normal, and its edges have no dihedral angle.
//!
//! For drawing, the file's topology is not taken literally ([`EdgeOptions::default`]); for statistics it is
//! ([`EdgeOptions::of_file`]):
//!
//! - *Redundant* faces are skipped ([`EdgeOptions::skip_redundant`]): duplicate faces with the same three corners in any
//!   winding, and faces with two corners at one position. They would make their edges non-manifold.
//! - Polygons without area are skipped ([`EdgeOptions::skip_without_area`]): those that are no higher than rounding of
//!   their coordinates accounts for. Their neighbours on both sides then meet at a T-junction or at an edge.
//! - Faces that *overlap* at an edge, on the same side of it and in one plane, count once there
//!   ([`EdgeOptions::merge_overlaps`]): a polygon and its back, the same polygon cut along other diagonals, a mark within
//!   a larger face. The face with the lowest number remains at the edge.
//! - The first two faces of a non-manifold edge are the outer ones, if all of its faces lie within a half-space: it is a
//!   silhouette where these make it one. Otherwise it is [surrounded](Edge::is_surrounded) and never a silhouette.
//!   Neither depends on the order of the faces.
//! - At *T-junctions* boundary edges that cover each other on one line are shared ([`EdgeOptions::share_junctions`]):
//!   they are split at each other's ends, and a piece that several faces have is an edge of all of them. Its ends need
//!   not be corners of these faces ([`runs_along`]).

mod around;
mod diagonals;
mod edge;
mod folds;
mod junctions;
mod normal;
mod overlaps;
mod points;
mod redundant;
mod sides;
mod unique;

pub use edge::{Edge, EdgeKind, MOST_FACES, NO_FACE};
pub use normal::{face_normals, has_zero_area, triangle_normal};
pub use sides::{runs_along, side_of};

use crate::weld::{self, Rounding, Weld};
use around::Surface;
use edge::TWO_MATERIALS;
use glam::Vec3;

/// Options of [`find`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeOptions {
    /// Which vertices are one vertex.
    pub weld: Weld,
    /// Whether to skip duplicate faces and faces with two corners at one position.
    pub skip_redundant: bool,
    /// Whether to skip polygons whose area is due to rounding, or zero.
    pub skip_without_area: bool,
    /// Whether faces that overlap at their common edge count once there.
    pub merge_overlaps: bool,
    /// Whether boundary edges that cover each other on one line, within the tolerance of welding and at least within
    /// [`weld::rounding_tolerance`], are shared.
    pub share_junctions: bool,
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
    /// Options for drawing.
    fn default() -> Self {
        Self {
            weld: Weld::Rounding,
            skip_redundant: true,
            skip_without_area: true,
            merge_overlaps: true,
            share_junctions: true,
            fold_rad: FOLD_RAD,
        }
    }
}

impl EdgeOptions {
    /// Options to analyse the content of a file: vertices at equal positions are one, every face counts, and every side
    /// of a face is one edge.
    pub const fn of_file() -> Self {
        Self {
            weld: Weld::Exact,
            skip_redundant: false,
            skip_without_area: false,
            merge_overlaps: false,
            share_junctions: false,
            fold_rad: FOLD_RAD,
        }
    }
}

/// The result of [`find`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Edges {
    /// The unique edges.
    pub edges: Vec<Edge>,
    /// Per face its unit normal, that of the polygon for a face of a polygon, or zero for a face of zero area.
    pub face_normals: Vec<Vec3>,
    /// Per vertex the lowest-numbered vertex that is one vertex with it.
    pub representative: Vec<u32>,
    /// (edge, face) for the third and further faces of non-manifold edges, sorted by edge.
    pub further_faces: Vec<(u32, u32)>,
    /// Per face whether it was skipped, as redundant or without area; empty if none was.
    pub skipped: Vec<bool>,
    /// Pairs of faces that overlap: one that has its edges, and one that was skipped as a duplicate of it or counts with
    /// it at an edge. Possibly repeated, in no particular order.
    pub overlaps: Vec<[u32; 2]>,
    /// The distance within which positions were one vertex, or were on one line; in units of the positions.
    pub tolerance: f32,
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
            (skipped, "faces are duplicates, have two corners at one position or no area: they are skipped"),
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
        self.overlaps.extend(other.overlaps.iter().map(|pair| pair.map(|face| face + first_face)));
        self.tolerance = self.tolerance.max(other.tolerance);
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
/// The edges are sorted by their lower and then by their upper vertex. The faces of an edge are in ascending order, after
/// the first two of a non-manifold edge, with [`EdgeOptions::merge_overlaps`].
///
/// Memory: the result takes 16 bytes per edge and per fold, 12 bytes per face and 4 bytes per vertex. Temporarily,
/// welding takes up to 24 bytes per vertex, the search 24 bytes per face and 4 bytes per vertex, and T-junctions 16 bytes
/// per boundary edge. There are at most `3 * faces.len()` edges, and with T-junctions at most 16 times the number of
/// boundaries in addition. The time is linear in faces and vertices, and n log n in the number of faces at a vertex and
/// in the number of boundary edges.
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
    if options.weld == Weld::Exact && !options.skip_without_area && !options.share_junctions {
        let mesh = Arrays { positions, faces, face_polygon, face_material };
        return find_with(mesh, weld::weld_exact(positions), 0.0, None, options);
    }
    let rounding = Rounding::new(positions, faces);
    let representative = match options.weld {
        Weld::Rounding => weld::weld_by(positions, faces, &rounding),
        other => other.representatives(positions, faces),
    };
    let tolerance = match options.weld {
        Weld::Within(tolerance) => rounding.tolerance.max(tolerance),
        Weld::Exact | Weld::Rounding => rounding.tolerance,
    };
    let mesh = Arrays { positions, faces, face_polygon, face_material };
    find_with(mesh, representative, tolerance, Some(&rounding), options)
}

/// As [`find`], with vertices that were welded before.
///
/// - `representative`: per vertex the lowest-numbered of those that are one vertex with it. [`EdgeOptions::weld`] is not
///   used.
/// - `tolerance`: the distance within which positions are on one line, in units of the positions.
///
/// # Panics
/// As [`find`], and if a representative is missing or no vertex.
pub fn find_welded(
    positions: &[Vec3],
    faces: &[[u32; 3]],
    face_polygon: &[u32],
    face_material: &[u32],
    representative: Vec<u32>,
    tolerance: f32,
    options: &EdgeOptions,
) -> Edges {
    let mesh = Arrays { positions, faces, face_polygon, face_material };
    find_with(mesh, representative, tolerance, None, options)
}

/// The arguments of [`find`].
#[derive(Clone, Copy)]
struct Arrays<'a> {
    positions: &'a [Vec3],
    faces: &'a [[u32; 3]],
    face_polygon: &'a [u32],
    face_material: &'a [u32],
}

fn find_with(
    Arrays { positions, faces, face_polygon, face_material }: Arrays,
    representative: Vec<u32>,
    tolerance: f32,
    rounding: Option<&Rounding>,
    options: &EdgeOptions,
) -> Edges {
    assert!(face_polygon.is_empty() || face_polygon.len() == faces.len());
    assert!(face_material.is_empty() || face_material.len() == faces.len());
    assert!(faces.len() <= MOST_FACES, "{} faces, of which at most {MOST_FACES} can be numbered", faces.len());
    assert_eq!(representative.len(), positions.len());
    let face_normals = face_normals(positions, faces, face_polygon);
    let mut found = unique::unique(faces, &representative, &[]);
    let (mut skipped, mut overlaps) = (Vec::new(), Vec::new());
    if options.skip_redundant {
        redundant::skip_redundant(&mut skipped, &found.collapsed, &mut found.twins, faces.len(), face_polygon);
        overlaps.append(&mut found.twins);
    }
    if options.skip_without_area {
        let own;
        let rounding = match rounding {
            Some(rounding) => rounding,
            None => {
                own = Rounding::new(positions, faces);
                &own
            }
        };
        redundant::skip_without_area(&mut skipped, positions, faces, face_polygon, rounding);
    }
    if !skipped.is_empty() {
        found = unique::unique(faces, &representative, &skipped);
    }
    let unique::Unique { mut edges, mut further_faces, .. } = found;
    let mut folds = Vec::new();
    if !face_polygon.is_empty() {
        folds = diagonals::drop_diagonals(&mut edges, &mut further_faces, faces, &representative, face_polygon);
        folds::keep_folded(&mut folds, positions, faces, face_polygon, options.fold_rad);
    }
    let surface =
        Surface { positions, faces, face_normals: &face_normals, tolerance, merge_overlaps: options.merge_overlaps };
    let upwards = |face, ends| runs_along(positions, faces[face as usize].map(|v| representative[v as usize]), ends);
    if options.merge_overlaps {
        overlaps.extend(overlaps::merge_overlaps(&mut edges, &mut further_faces, &surface, upwards));
    }
    if options.share_junctions {
        overlaps.extend(junctions::share(&mut edges, &mut further_faces, &surface, upwards));
    }
    mark_materials(&mut edges, &further_faces, face_material);
    Edges { edges, face_normals, representative, further_faces, skipped, overlaps, tolerance, folds }
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

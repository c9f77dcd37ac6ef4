//! Every unique edge of a model, with its faces, its kind and its dihedral angle.
//!
//! # Rules for topology that is not that of a closed surface
//!
//! - Vertices at exactly equal positions are one vertex ([`crate::weld`]).
//! - A diagonal that triangulation added (an edge between two faces of one polygon) is no edge, and a polygon's
//!   faces all have the polygon's Newell normal.
//! - An edge with one face is a *boundary*, with two a *two-face* edge, with more *non-manifold*. A face that runs
//!   over one edge twice (two of its corners are at one place) counts twice there.
//! - Two faces that run over their edge in the same direction are wound oppositely; the dihedral angle is that of
//!   the surface, with one of them turned round. So a face that a modeller turned by mistake makes no crease.
//! - A face of zero area has no normal, and its edges have no dihedral angle.
//! - For drawing, faces that add nothing to be seen are best left out ([`EdgeOptions::skip_redundant`]): a second
//!   face over the same three corners, whichever way it is wound, and a face with two corners at one place. Each
//!   would make edges non-manifold that are not.
//!
//! # How
//!
//! A face's edges are put into the bucket of their lower-numbered vertex by a counting sort: two passes over the faces.
//! Within a bucket a table over all vertices tells whether the higher end was met before: one look-up an entry, and no
//! comparing of entries, whose outcome no processor predicts. So the time is linear for any mesh, the hub of a fan
//! included. Edges come by their lower vertex, and there in the order in which faces show them; an edge's faces come in
//! the order of the faces.

use crate::weld;
use glam::{DVec3, Vec3};

/// Stands where there is no face.
pub const NO_FACE: u32 = u32::MAX;

/// What [`find`] shall do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeOptions {
    /// Vertices within this distance are one; 0 means those at exactly equal positions. World units.
    pub weld_tolerance: f32,
    /// Leave out faces that lie exactly on another one or have two corners at one place. For drawing this is right;
    /// for counting what a file holds it is not.
    pub skip_redundant: bool,
}

impl Default for EdgeOptions {
    fn default() -> Self {
        Self { weld_tolerance: 0.0, skip_redundant: true }
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

/// A unique edge.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Edge {
    /// The two vertices, representatives of their positions, the lower number first.
    pub ends: [u32; 2],
    /// The first two faces that have this edge; the second is [`NO_FACE`] at a boundary.
    pub faces: [u32; 2],
    /// Cosine of the angle between the two faces' normals, wound alike: 1 where the surface goes straight on, −1
    /// where it folds back. NaN at a boundary or non-manifold edge and beside a face of zero area.
    pub cos_dihedral: f32,
    flags: u32,
}

const FLAG_NON_MANIFOLD: u32 = 1;
const FLAG_WOUND_OPPOSITELY: u32 = 2;
const FLAG_TWO_MATERIALS: u32 = 4;
const FLAG_FIRST_ASCENDS: u32 = 8;

impl Edge {
    /// How many faces meet here.
    #[inline]
    pub fn kind(&self) -> EdgeKind {
        if self.flags & FLAG_NON_MANIFOLD != 0 {
            EdgeKind::NonManifold
        } else if self.faces[1] == NO_FACE {
            EdgeKind::Boundary
        } else {
            EdgeKind::TwoFace
        }
    }

    /// Whether its first two faces run over it in the same direction.
    #[inline]
    pub fn wound_oppositely(&self) -> bool {
        self.flags & FLAG_WOUND_OPPOSITELY != 0
    }

    /// Whether the first face runs from the lower-numbered end to the higher one.
    #[inline]
    pub fn first_face_ascends(&self) -> bool {
        self.flags & FLAG_FIRST_ASCENDS != 0
    }

    /// Whether faces of different materials meet here.
    #[inline]
    pub fn joins_two_materials(&self) -> bool {
        self.flags & FLAG_TWO_MATERIALS != 0
    }

    /// The angle by which the surface turns at this edge: 0 where it goes straight on, π where it folds back.
    /// `None` where [`Edge::cos_dihedral`] is NaN.
    pub fn dihedral_rad(&self) -> Option<f32> {
        (!self.cos_dihedral.is_nan()).then(|| self.cos_dihedral.clamp(-1.0, 1.0).acos())
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
    /// (edge, face) for the third and further faces of non-manifold edges, in the order met.
    pub further_faces: Vec<(u32, u32)>,
    /// Per face whether it was left out as redundant; empty if none was.
    pub skipped: Vec<bool>,
}

/// Finds all unique edges.
///
/// - `positions`: per vertex.
/// - `faces`: three vertices each, every one below `positions.len()`.
/// - `face_polygon`: as [`crate::Model::face_polygon`], empty or per face.
/// - `face_material`: per face, or empty where materials do not matter.
///
/// Memory: 24 bytes an edge, 12 a face and 4 a vertex for what is returned; on the way 24 bytes a face, 8 a vertex, and
/// the weld's table of at most 12 bytes a vertex. At most `3 * faces.len()` edges.
///
/// # Panics
/// If a face names a vertex that is not there, or a per-face array has another length than stated.
pub fn find(
    positions: &[Vec3],
    faces: &[[u32; 3]],
    face_polygon: &[u32],
    face_material: &[u32],
    options: &EdgeOptions,
) -> Edges {
    assert!(face_polygon.is_empty() || face_polygon.len() == faces.len());
    assert!(face_material.is_empty() || face_material.len() == faces.len());
    let representative = weld::weld_within(positions, options.weld_tolerance);
    let face_normals = face_normals(positions, faces, face_polygon);
    let mut skipped = Vec::new();
    let Collected { mut edges, mut further_faces, redundant } =
        collect(positions.len(), faces, &representative, &skipped);
    if options.skip_redundant {
        skipped = skippable(&redundant, faces.len(), face_polygon);
        if !skipped.is_empty() {
            Collected { edges, further_faces, .. } = collect(positions.len(), faces, &representative, &skipped);
        }
    }
    if !face_polygon.is_empty() {
        drop_diagonals(&mut edges, &mut further_faces, faces, &representative, face_polygon);
    }
    classify(&mut edges, &further_faces, &face_normals, face_material);
    Edges { edges, face_normals, representative, further_faces, skipped }
}

/// Unit normals, computed in f64: of thin triangles an f32 cross product keeps no direction. A polygon's faces get
/// the sum of their areas' vectors, which is the polygon's Newell normal however it was cut.
pub fn face_normals(positions: &[Vec3], faces: &[[u32; 3]], face_polygon: &[u32]) -> Vec<Vec3> {
    let unit = |area: DVec3| {
        let squared = area.length_squared();
        if squared >= f64::MIN_POSITIVE && squared.is_finite() {
            (area / squared.sqrt()).as_vec3()
        } else {
            // Squares of f32 lengths under 1e-77 or over 1e77 leave the range of f64: scale first.
            let largest = area.abs().max_element();
            if largest > 0.0 && largest.is_finite() { (area / largest).normalize().as_vec3() } else { Vec3::ZERO }
        }
    };
    if face_polygon.is_empty() {
        return faces.iter().map(|face| unit(area_vector(positions, face))).collect();
    }
    let mut normals = Vec::with_capacity(faces.len());
    for polygon in chunks_of_equal(face_polygon) {
        let area = faces[polygon.clone()].iter().map(|face| area_vector(positions, face)).sum();
        normals.resize(polygon.end, unit(area));
    }
    normals
}

/// Ranges of equal values that stand next to each other.
fn chunks_of_equal(values: &[u32]) -> impl Iterator<Item = std::ops::Range<usize>> {
    let mut start = 0;
    values.chunk_by(|a, b| a == b).map(move |chunk| {
        let range = start..start + chunk.len();
        start = range.end;
        range
    })
}

/// Twice the face's area, along its normal.
#[inline]
fn area_vector(positions: &[Vec3], &[a, b, c]: &[u32; 3]) -> DVec3 {
    let a = positions[a as usize].as_dvec3();
    (positions[b as usize].as_dvec3() - a).cross(positions[c as usize].as_dvec3() - a)
}

/// Whether the corners lie on one line. Differences and products of f32 values are exact in f64 unless their
/// magnitudes are 2²⁹ apart, so this is decided exactly for anything like a mesh.
pub fn has_zero_area(positions: &[Vec3], face: &[u32; 3]) -> bool {
    area_vector(positions, face) == DVec3::ZERO
}

/// What one pass over the faces finds.
struct Collected {
    /// `cos_dihedral` is not yet set.
    edges: Vec<Edge>,
    further_faces: Vec<(u32, u32)>,
    /// Faces that lie on an earlier one or have two corners at one place.
    redundant: Vec<u32>,
}

/// A face's side of an edge, in the bucket of the edge's lower end.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    /// The edge's higher end.
    high: u32,
    /// Twice the face's number, and 1 where it runs upwards.
    face_up: u32,
}

/// More faces than this cannot be numbered beside a flag.
const MOST_FACES: usize = 1 << 31;
/// Buckets up to this size are searched for twins in pairs.
const SMALL_BUCKET: usize = 24;

fn collect(vertices: usize, faces: &[[u32; 3]], representative: &[u32], skipped: &[bool]) -> Collected {
    assert!(faces.len() < MOST_FACES, "{} faces, of which at most {MOST_FACES} can be numbered", faces.len());
    let welded = |face: u32| faces[face as usize].map(|v| representative[v as usize]);
    let is_skipped = |face: usize| !skipped.is_empty() && skipped[face];
    let mut redundant = Vec::new();
    // Where each vertex's bucket ends, once filled; one more than there are vertices.
    let mut bucket_end = vec![0u32; vertices + 1];
    for (number, face) in faces.iter().enumerate() {
        if is_skipped(number) {
            continue;
        }
        let [a, b, c] = face.map(|v| representative[v as usize]);
        if a == b || b == c || c == a {
            redundant.push(number as u32);
        }
        for (from, to) in [(a, b), (b, c), (c, a)] {
            bucket_end[from.min(to) as usize + 1] += u32::from(from != to);
        }
    }
    let mut total = 0;
    for end in &mut bucket_end {
        total += *end;
        *end = total;
    }
    let mut sides = vec![Side::default(); total as usize];
    for (number, face) in faces.iter().enumerate() {
        if is_skipped(number) {
            continue;
        }
        let [a, b, c] = face.map(|v| representative[v as usize]);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            if from != to {
                let slot = &mut bucket_end[from.min(to) as usize];
                let face_up = (number as u32) << 1 | u32::from(from < to);
                sides[*slot as usize] = Side { high: from.max(to), face_up };
                *slot += 1;
            }
        }
    }
    let mut edges: Vec<Edge> = Vec::with_capacity(sides.len() / 2 + sides.len() / 32 + 16);
    let mut further_faces = Vec::new();
    // Per vertex one more than the number of the newest edge that has it as its higher end. Edges are numbered as
    // their buckets come, so a number from an earlier bucket is known by being too low.
    let mut newest = vec![0u32; vertices];
    let mut start = 0;
    for (low, &end) in (0u32..).zip(&bucket_end[..vertices]) {
        let first_of_bucket = edges.len();
        for &Side { high, face_up } in &sides[start..end as usize] {
            let known = newest[high as usize];
            let face = face_up >> 1;
            if known as usize <= first_of_bucket {
                let flags = if face_up & 1 != 0 { FLAG_FIRST_ASCENDS } else { 0 };
                edges.push(Edge { ends: [low, high], faces: [face, NO_FACE], cos_dihedral: f32::NAN, flags });
                newest[high as usize] = edges.len() as u32;
                continue;
            }
            let edge = &mut edges[known as usize - 1];
            if edge.faces[1] == NO_FACE {
                edge.faces[1] = face;
                if (face_up & 1 != 0) == (edge.flags & FLAG_FIRST_ASCENDS != 0) {
                    edge.flags |= FLAG_WOUND_OPPOSITELY;
                }
            } else {
                edge.flags |= FLAG_NON_MANIFOLD;
                further_faces.push((known - 1, face));
            }
        }
        start = end as usize;
        twins_of_bucket(&edges[first_of_bucket..], &mut redundant);
    }
    twins_at_crowded_edges(&edges, &further_faces, welded, &mut redundant);
    Collected { edges, further_faces, redundant }
}

/// Which faces to leave out; empty if none.
///
/// A triangle cut from a larger polygon may coincide with one cut from another without the polygons doing so; such
/// polygons are left alone.
fn skippable(redundant: &[u32], faces: usize, face_polygon: &[u32]) -> Vec<bool> {
    let is_cut = |face: usize| {
        !face_polygon.is_empty()
            && (face.checked_sub(1).is_some_and(|before| face_polygon[before] == face_polygon[face])
                || face_polygon.get(face + 1) == Some(&face_polygon[face]))
    };
    let mut skipped = Vec::new();
    for &face in redundant.iter().filter(|&&face| !is_cut(face as usize)) {
        skipped.resize(faces, false);
        skipped[face as usize] = true;
    }
    skipped
}

/// A face on an earlier one shares all its edges with it. Two of these are in the bucket of the lowest of the three
/// corners, so two edges of a bucket with the same two faces tell of it.
fn twins_of_bucket(bucket: &[Edge], redundant: &mut Vec<u32>) {
    let is_twin = |a: &Edge, b: &Edge| a.faces == b.faces && a.faces[1] != NO_FACE && a.faces[0] != a.faces[1];
    if bucket.len() <= SMALL_BUCKET {
        for (i, edge) in bucket.iter().enumerate() {
            if bucket[i + 1..].iter().any(|other| is_twin(edge, other)) {
                redundant.push(edge.faces[1]);
            }
        }
        return;
    }
    let mut sorted = bucket.to_vec();
    sorted.sort_unstable_by_key(|edge| edge.faces);
    redundant.extend(sorted.windows(2).filter(|pair| is_twin(&pair[0], &pair[1])).map(|pair| pair[1].faces[1]));
}

/// At an edge with three faces and more any two can be twins; of each set of corners all but the first are redundant.
fn twins_at_crowded_edges(
    edges: &[Edge],
    further_faces: &[(u32, u32)],
    welded: impl Fn(u32) -> [u32; 3],
    redundant: &mut Vec<u32>,
) {
    let keyed = |edge: u32, face: u32| {
        let mut corners = welded(face);
        corners.sort_unstable();
        (edge, corners, face)
    };
    let mut of_edge: Vec<(u32, [u32; 3], u32)> = further_faces
        .iter()
        .flat_map(|&(edge, face)| {
            let [first, second] = edges[edge as usize].faces;
            [first, second, face].map(|face| keyed(edge, face))
        })
        .collect();
    of_edge.sort_unstable();
    of_edge.dedup();
    let twins = of_edge.windows(2).filter(|pair| pair[0].0 == pair[1].0 && pair[0].1 == pair[1].1);
    redundant.extend(twins.map(|pair| pair[1].2));
}

fn classify(edges: &mut [Edge], further_faces: &[(u32, u32)], face_normals: &[Vec3], face_material: &[u32]) {
    let many_materials = face_material.windows(2).any(|pair| pair[0] != pair[1]);
    for edge in edges.iter_mut() {
        edge.cos_dihedral = f32::NAN;
        let [first, second] = edge.faces;
        if second == NO_FACE {
            continue;
        }
        if edge.flags & FLAG_NON_MANIFOLD == 0 {
            let (n0, n1) = (face_normals[first as usize], face_normals[second as usize]);
            let cos = n0.dot(n1);
            // The normals are unit or zero, and a dot product of exactly 0 is a right angle far more often than a
            // face of zero area.
            if cos != 0.0 || (n0 != Vec3::ZERO && n1 != Vec3::ZERO) {
                edge.cos_dihedral = if edge.wound_oppositely() { -cos } else { cos };
            }
        }
        if many_materials && face_material[first as usize] != face_material[second as usize] {
            edge.flags |= FLAG_TWO_MATERIALS;
        }
    }
    if many_materials {
        for &(edge, face) in further_faces {
            let edge = &mut edges[edge as usize];
            if face_material[face as usize] != face_material[edge.faces[0] as usize] {
                edge.flags |= FLAG_TWO_MATERIALS;
            }
        }
    }
}

/// Takes pairs of faces of one polygon out of each edge: between those, the edge is a diagonal. Two polygons side by
/// side can be cut along the same one, which then has four faces and is still no line.
fn drop_diagonals(
    edges: &mut Vec<Edge>,
    further_faces: &mut Vec<(u32, u32)>,
    faces: &[[u32; 3]],
    representative: &[u32],
    face_polygon: &[u32],
) {
    let polygon = |face: u32| face_polygon[face as usize];
    further_faces.sort_by_key(|&(edge, _)| edge);
    let mut kept_further = Vec::new();
    let mut further = further_faces.iter().copied().peekable();
    let (mut old_number, mut new_number) = (0, 0);
    edges.retain_mut(|edge| {
        let number = old_number;
        old_number += 1;
        let [first, second] = edge.faces;
        if edge.kind() != EdgeKind::NonManifold {
            let diagonal = second != NO_FACE && first != second && polygon(first) == polygon(second);
            new_number += u32::from(!diagonal);
            return !diagonal;
        }
        let mut left = vec![first, second];
        left.extend(std::iter::from_fn(|| further.next_if(|f| f.0 == number)).map(|(_, face)| face));
        let before = left.len();
        while let Some((a, b)) = pair_of_one_polygon(&left, polygon) {
            left.remove(b);
            left.remove(a);
        }
        if left.is_empty() {
            return false;
        }
        if left.len() < before {
            edge.faces = [left[0], left.get(1).copied().unwrap_or(NO_FACE)];
            let ascends =
                edge.faces.map(|face| face != NO_FACE && runs_upwards(faces, representative, face, edge.ends));
            edge.flags = if left.len() < 3 { 0 } else { FLAG_NON_MANIFOLD };
            edge.flags |= if ascends[0] { FLAG_FIRST_ASCENDS } else { 0 };
            edge.flags |= if left.len() > 1 && ascends[0] == ascends[1] { FLAG_WOUND_OPPOSITELY } else { 0 };
        }
        kept_further.extend(left.iter().skip(2).map(|&face| (new_number, face)));
        new_number += 1;
        true
    });
    *further_faces = kept_further;
}

/// Whether the face runs over the edge from its first end to its second.
fn runs_upwards(faces: &[[u32; 3]], representative: &[u32], face: u32, [low, high]: [u32; 2]) -> bool {
    let [a, b, c] = faces[face as usize].map(|v| representative[v as usize]);
    [(a, b), (b, c), (c, a)].contains(&(low, high))
}

/// The positions of two different faces of one polygon.
fn pair_of_one_polygon(faces: &[u32], polygon: impl Fn(u32) -> u32) -> Option<(usize, usize)> {
    (0..faces.len()).find_map(|a| {
        let b = (a + 1..faces.len()).find(|&b| faces[a] != faces[b] && polygon(faces[a]) == polygon(faces[b]))?;
        Some((a, b))
    })
}

#[cfg(test)]
mod tests;

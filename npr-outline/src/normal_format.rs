//! Formats for the face normals of edges, and the share of silhouettes that they misclassify.
//!
//! Card & Mitchell 2002 keep two face normals with each of a fin's vertices and propose byte or short 4-tuples for
//! them. Two numbers suffice for a unit vector: the octahedral formats unfold the octahedron |x| + |y| + |z| = 1
//! into a square (Meyer, Süßmuth, Sußner, Stamminger & Greiner 2010, "On Floating-Point Normal Vectors"). Rounding is
//! that of the "precise" encoder of Cigolle, Donow, Evangelakos, Mara, McGuire & Meyer 2014, "A Survey of Efficient
//! Representations for Independent Unit Vectors": of the four neighbours on the grid the one is taken whose direction
//! is nearest, compared in f64.
//!
//! The zero normal of a face without area stays zero in every format. No octahedral code stands for it, but
//! four stand for −z, the square's corners: the corner (−1, −1) is used for zero.
//!
//! The tuples are signed-normalised, −1..=1 in steps of 1/32767 or 1/127, each number rounded to the nearest; they
//! are not renormalised after decoding, since only the signs of their dot products are used. The twin of
//! `normal_format.wgsl`.

use crate::contour::{contour_edges, facing_exact, outline_is_silhouette};
use crate::{ContourOptions, OutlineError};
use glam::{DVec2, DVec3, Vec2, Vec3};
use npr_mesh::Model;
use npr_mesh::edges::{Edge, EdgeKind, Edges, triangle_normal};
use std::collections::HashMap;

/// WGSL decoders: no bindings, no entry points.
pub const NORMAL_FORMAT_WGSL: &str = include_str!("normal_format.wgsl");

/// How a face normal is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NormalFormat {
    /// Three f32.
    F32,
    /// The chapter's short 4-tuple: four i16, the fourth 0.
    Snorm16,
    /// The chapter's byte 4-tuple: four i8, the fourth 0.
    Snorm8,
    /// Octahedral, two i16.
    Oct16,
    /// Octahedral, two i8.
    Oct8,
}

impl NormalFormat {
    /// All formats.
    pub const ALL: [Self; 5] = [Self::F32, Self::Snorm16, Self::Snorm8, Self::Oct16, Self::Oct8];

    /// Bytes of one normal, tuples with their unused fourth number.
    pub fn bytes_per_normal(self) -> usize {
        match self {
            Self::F32 => 12,
            Self::Snorm16 => 8,
            Self::Snorm8 | Self::Oct16 => 4,
            Self::Oct8 => 2,
        }
    }

    /// Bytes of one fin of [`crate::fin_printed`]: four vertices, each with a position and a smooth normal of three f32
    /// and two face normals. Its six indices (24 bytes) are not counted.
    pub fn bytes_per_fin(self) -> usize {
        4 * (24 + 2 * self.bytes_per_normal())
    }

    /// Appends a normal, unit or zero, as [`NormalFormat::bytes_per_normal`] little-endian bytes.
    pub fn encode(self, normal: Vec3, bytes: &mut Vec<u8>) {
        let mut shorts = |values: &[i16]| bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
        let snorm = |v: f32, most: f32| (v.clamp(-1.0, 1.0) * most).round() as i16;
        match self {
            Self::F32 => bytes.extend(normal.to_array().iter().flat_map(|v| v.to_le_bytes())),
            Self::Snorm16 => shorts(&[normal.x, normal.y, normal.z, 0.0].map(|v| snorm(v, 32767.0))),
            Self::Snorm8 => bytes.extend([normal.x, normal.y, normal.z, 0.0].map(|v| snorm(v, 127.0) as u8)),
            Self::Oct16 => shorts(&oct_encode(normal, 32767)),
            Self::Oct8 => bytes.extend(oct_encode(normal, 127).map(|v| v as u8)),
        }
    }

    /// The normal that a shader makes of an encoded one; of unit length only to the format's precision. The octahedral
    /// formats give exactly unit vectors, up to rounding of f32.
    ///
    /// # Panics
    /// If `bytes` is shorter than [`NormalFormat::bytes_per_normal`].
    pub fn decode(self, bytes: &[u8]) -> Vec3 {
        let short = |i: usize| (f32::from(i16::from_le_bytes([bytes[2 * i], bytes[2 * i + 1]])) / 32767.0).max(-1.0);
        let byte = |i: usize| (f32::from(bytes[i] as i8) / 127.0).max(-1.0);
        let float = |i: usize| f32::from_le_bytes(std::array::from_fn(|k| bytes[4 * i + k]));
        match self {
            Self::F32 => Vec3::from_array(std::array::from_fn(float)),
            Self::Snorm16 => Vec3::from_array(std::array::from_fn(short)),
            Self::Snorm8 => Vec3::from_array(std::array::from_fn(byte)),
            Self::Oct16 => normal_oct_decode(Vec2::new(short(0), short(1))),
            Self::Oct8 => normal_oct_decode(Vec2::new(byte(0), byte(1))),
        }
    }

    /// A normal after encoding and decoding.
    pub fn quantised(self, normal: Vec3) -> Vec3 {
        let mut bytes = Vec::with_capacity(12);
        self.encode(normal, &mut bytes);
        self.decode(&bytes)
    }
}

/// The direction that a point of the unfolded octahedron, −1..=1, stands for; zero for (−1, −1).
fn normal_oct_decode(code: Vec2) -> Vec3 {
    if code == Vec2::NEG_ONE { Vec3::ZERO } else { oct_direction(code.as_dvec2()).as_vec3() }
}

fn oct_direction(code: DVec2) -> DVec3 {
    let z = 1.0 - code.x.abs() - code.y.abs();
    // The lower half is folded outwards over the diamond's sides.
    let fold = (-z).max(0.0);
    let xy = code - DVec2::new(fold.copysign(code.x), fold.copysign(code.y));
    xy.extend(z).normalize()
}

/// The grid point, of `most` steps to 1, whose direction is nearest to the normal's.
fn oct_encode(normal: Vec3, most: i16) -> [i16; 2] {
    let normal = normal.as_dvec3();
    let sum = normal.abs().element_sum();
    if sum == 0.0 {
        return [-most, -most];
    }
    let mut code = normal.truncate() / sum;
    if normal.z < 0.0 {
        let folded = DVec2::ONE - DVec2::new(code.y.abs(), code.x.abs());
        code = DVec2::new(folded.x.copysign(code.x), folded.y.copysign(code.y));
    }
    let steps = f64::from(most);
    let low = (code * steps).floor();
    let (mut best, mut best_cos) = (low, f64::NEG_INFINITY);
    for neighbour in [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE] {
        let candidate = (low + neighbour).min(DVec2::splat(steps));
        let cos = oct_direction(candidate / steps).dot(normal);
        if cos > best_cos {
            (best, best_cos) = (candidate, cos);
        }
    }
    // This corner means zero; the opposite one is the same direction.
    if best == DVec2::splat(-steps) {
        best = -best;
    }
    [best.x as i16, best.y as i16]
}

/// `count` directions, evenly spread: the Fibonacci sphere with points at the middles of slices of equal height.
pub fn fibonacci_sphere(count: usize) -> impl Iterator<Item = DVec3> {
    let golden_angle = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    (0..count).map(move |i| {
        let z = 1.0 - (2 * i + 1) as f64 / count as f64;
        let (sin, cos) = (golden_angle * i as f64).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * cos, radius * sin, z)
    })
}

/// Eyes on the Fibonacci sphere around the model's box, three of its half diagonals from the centre.
fn eyes(model: &Model, views: usize) -> Vec<DVec3> {
    let Some((low, high)) = model.bounds() else { return Vec::new() };
    let centre = low.midpoint(high).as_dvec3();
    let radius = 0.5 * low.as_dvec3().distance(high.as_dvec3());
    fibonacci_sphere(views).map(|direction| centre + 3.0 * radius * direction).collect()
}

/// For each face whether the eye is in front: [`facing_exact`], and for a polygon's faces that of the polygon's plane,
/// with its Newell normal through the mean of its triangles' corners, as [`crate::contour`] has it.
fn true_sides(model: &Model, eye: DVec3) -> Vec<bool> {
    let corners = |face: &[u32; 3]| face.map(|v| model.positions[v as usize]);
    if model.face_polygon.is_empty() {
        return model.faces.iter().map(|face| facing_exact(corners(face), eye.extend(1.0)) >= 0.0).collect();
    }
    let mut sides = Vec::with_capacity(model.faces.len());
    for polygon in model.face_polygon.chunk_by(|a, b| a == b) {
        let faces = &model.faces[sides.len()..][..polygon.len()];
        let (mut normal, mut sum) = (DVec3::ZERO, DVec3::ZERO);
        for [a, b, c] in faces.iter().map(|face| corners(face).map(|corner| corner.as_dvec3())) {
            normal += (b - a).cross(c - a);
            sum += a + b + c;
        }
        let side = normal.dot(eye - sum / (3 * faces.len()) as f64) >= 0.0;
        sides.resize(sides.len() + faces.len(), side);
    }
    sides
}

/// As [`true_sides`], with the triangles of folded polygons each judged by its own plane.
fn true_sides_with_folds(model: &Model, edges: &Edges, eye: DVec3) -> Vec<bool> {
    let mut sides = true_sides(model, eye);
    for face in edges.folds.iter().flat_map(Edge::faces) {
        let corners = model.faces[face as usize].map(|v| model.positions[v as usize]);
        if triangle_normal(&model.positions, &model.faces[face as usize]) != Vec3::ZERO {
            sides[face as usize] = facing_exact(corners, eye.extend(1.0)) >= 0.0;
        }
    }
    sides
}

fn truly_silhouette(edge: &Edge, sides: &[bool]) -> bool {
    let [first, second] = edge.faces().map(|face| sides[face as usize]);
    (first != second) != edge.wound_oppositely()
}

/// The edges that are compared: those with two faces, neither of zero area.
fn judged(edges: &Edges) -> impl Iterator<Item = &Edge> {
    edges.edges.iter().filter(|edge| edge.kind() == EdgeKind::TwoFace && edges.cos_dihedral(edge).is_some())
}

/// The share, 0..=1, of (edge, view) pairs that the chapter's test misclassifies with normals of a format.
///
/// The test: the product of the two normals' dot products with the vector from the eye to the edge's first end is
/// below zero, in f32. The truth: on which sides of its two faces the eye is, in f64 from the corners. Over
/// two-face edges beside no face of zero area, and `views` eyes on a Fibonacci sphere of three times the radius.
/// 0 where there is no pair.
pub fn misclassified_share(model: &Model, edges: &Edges, format: NormalFormat, views: usize) -> f64 {
    let normals: Vec<Vec3> = edges.face_normals.iter().map(|&normal| format.quantised(normal)).collect();
    let classified = |edge: &Edge, eye: Vec3| {
        let view = model.positions[edge.ends[0] as usize] - eye;
        let [first, second] = edge.faces().map(|face| view.dot(normals[face as usize]));
        let product = first * second;
        if edge.wound_oppositely() { -product < 0.0 } else { product < 0.0 }
    };
    let (mut wrong, mut pairs) = (0usize, 0usize);
    for eye in eyes(model, views) {
        let sides = true_sides(model, eye);
        for edge in judged(edges) {
            wrong += usize::from(classified(edge, eye.as_vec3()) != truly_silhouette(edge, &sides));
            pairs += 1;
        }
    }
    wrong as f64 / pairs.max(1) as f64
}

/// As [`misclassified_share`], for the plane records and the test of [`crate::contour`], folds included.
///
/// # Errors
/// None that the input could cause; those of [`contour_edges`].
pub fn misclassified_share_of_planes(model: &Model, edges: &Edges, views: usize) -> Result<f64, OutlineError> {
    let contours = contour_edges(model, edges, &ContourOptions::default())?;
    // Two polygons can be folded along one diagonal.
    let key = |[a, b]: [u32; 2], first_face: u32| (a.min(b), a.max(b), first_face);
    let judged = judged(edges).chain(&edges.folds);
    let judged: HashMap<_, &Edge> = judged.map(|edge| (key(edge.ends, edge.faces()[0]), edge)).collect();
    let planes = |number: usize| contours.edge_planes(number);
    let records: Vec<_> = contours
        .edges
        .iter()
        .enumerate()
        .filter_map(|(number, edge)| Some((*judged.get(&key(edge.ends, edge.faces()[0]))?, planes(number))))
        .collect();
    let (mut wrong, mut pairs) = (0usize, 0usize);
    for eye in eyes(model, views) {
        let sides = true_sides_with_folds(model, edges, eye);
        let local_eye = contours.local_eye(eye.extend(1.0));
        for (edge, planes) in &records {
            wrong += usize::from(outline_is_silhouette(planes, local_eye) != truly_silhouette(edge, &sides));
        }
        pairs += records.len();
    }
    Ok(wrong as f64 / pairs.max(1) as f64)
}

#[cfg(test)]
mod tests;

//! Curved PN triangles: tessellation of a mesh into a smooth surface defined by its normals.
//!
//! A. Vlachos, J. Peters, C. Boyd, J. L. Mitchell, "Curved PN Triangles", Symposium on Interactive 3D Graphics 2001:
//! each face becomes a cubic Bézier triangle defined by its three positions and normals, so that outlines of coarse
//! meshes become round.
//!
//! Two details differ from the paper and its usual implementations:
//!
//! - *Creases remain closed.* In the paper, patches separate where the two sides of an edge have different normals.
//!   Here all faces of an edge share one curve. Where the normals differ, the tangent of the curve is the chord
//!   projected onto the intersection line of both tangent planes. The rim of a cylinder thus becomes round while its
//!   caps remain flat: with 12 sides the error of the rim is 0.0017 of the radius. (The mean of the control points of
//!   both sides, as in J. McDonald and M. Kilgard, "Crack-Free Point-Normal Triangles using Adjacent Edge Normals",
//!   2010, gives half of the bulge and an error of 0.018; the error of the polygon is 0.034.)
//! - *The mixed terms of the normals have the factor 2* of Bernstein polynomials. The usual sum of unit normals, n200
//!   w² + … + n110 wu + …, has a first-order error in the edge length, this one a third-order error.
//!
//! As in the paper, patches do not join smoothly; on coarse meshes the angles between them may count as creases.
//! Measured with the normals of the unit sphere on an octahedron and on an icosahedron and its subdivisions, with 16
//! segments, and 64 for the angles:
//!
//! | faces | farthest from the sphere | widest angle between patches | largest error of a normal, by the usual sum |
//! | --- | --- | --- | --- |
//! | 8 | 0.23 | 47° | 3.17°, 3.03° |
//! | 20 | 0.058 | 16° | 1.04°, 3.20° |
//! | 80 | 0.0063 | 2.9° | 0.184°, 2.17° |
//! | 320 | 0.00047 | 0.56° | 0.0254°, 1.18° |
//! | 1280 | 0.000030 | 0.14° | 0.0033°, 0.60° |

use glam::{DVec3, Vec2, Vec4};

use crate::edges::MOST_FACES;
use crate::weld::weld_exact;
use crate::{Model, SideVisibility};

/// An error of [`tessellate`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TessellateError {
    /// The number of segments per edge is 0.
    #[error("0 segments an edge, of which 1 is the least")]
    NoSegments,
    /// The result would have more faces than [`crate::edges::find`] accepts, or more than `u32::MAX` vertices.
    #[error("{count} {what}, more than the limit of {limit}")]
    TooLarge {
        /// The counted elements: `"faces"` or `"vertices"`.
        what: &'static str,
        /// Their number in the result, saturated at `u64::MAX`.
        count: u64,
        /// The maximum number.
        limit: u64,
    },
}

/// Tessellates each face into `segments`² faces on its PN triangle, with `segments` segments per edge.
///
/// `segments` is at least 1; with 1 the model is unchanged.
///
/// - Positions are on the cubic patch, normals are quadratic and normalised, texture coordinates and colours linear.
///   Points on an edge are computed in the same direction for all its faces.
/// - Edges are those between exactly equal positions ([`crate::weld`]). All faces of an edge have bitwise equal
///   points on it for any normals and texture coordinates, so closed surfaces remain closed. Faces that share both
///   vertices of an edge share its new vertices as well.
/// - Where the normals of both sides at an end of an edge differ by less than 6° (or from opposite by less), the
///   curve is perpendicular to their mean there. From 17° on it follows the crease, with a linear transition in
///   between. Of three and more sides, the first and the one that deviates most from it are used. A boundary has one
///   side.
/// - A zero or non-finite normal does not bend the curve. An end of an edge without any valid normal is straight. New
///   normals between such corners are zero, and can be computed by [`crate::normals::fill_missing`].
/// - A face with the normals of its own plane thus remains planar unless the normals of a neighbour differ slightly,
///   and an edge between planar faces remains straight. Within its plane a thin face beside a strongly curved crease
///   may fold over.
/// - Every new face is a polygon of its own, and [`Model::face_polygon`] is empty: edges within a patch, and former
///   diagonals, are edges of a curved surface, on which a contour may run. (With 1 segment polygons are kept.)
///
/// - Parts of a side are what [`Model::side_visibility`] says of the side, and edges within a patch are silhouettes.
///
/// Existing vertices keep their numbers and values. New vertices follow in the order in which the faces use them,
/// first those on edges and then those inside. The new faces of face f are `segments`² · f and following, in strips
/// from its first corner, with its material.
///
/// The time is n log n in the number of faces of the model and linear in the size of the result. Temporarily 200 to
/// 400 bytes per face of the model are used.
///
/// # Errors
/// `segments` is 0, or the result has more than [`MOST_FACES`] faces or `u32::MAX` vertices. This is checked before
/// memory is allocated.
///
/// # Panics
/// If a face has an invalid vertex index, or an array has another length than [`Model`] requires.
pub fn tessellate(model: &Model, segments: u32) -> Result<Model, TessellateError> {
    if segments == 0 {
        return Err(TessellateError::NoSegments);
    }
    let n = u64::from(segments);
    let faces = (model.faces.len() as u64).saturating_mul(n * n);
    check("faces", faces, MOST_FACES as u64)?;
    if segments == 1 {
        return Ok(model.clone());
    }
    let normals: Vec<DVec3> = model.normals.iter().map(|normal| normal.as_dvec3().normalize_or_zero()).collect();
    let mut network = Network::of(model, &normals);
    let inside = (n - 1) * (n - 2) / 2;
    let added = network.lines.len() as u64 * (n - 1) + model.faces.len() as u64 * inside;
    check("vertices", model.positions.len() as u64 + added, u64::from(u32::MAX))?;

    let repeat = |values: &[u32]| values.iter().flat_map(|&value| (0..n * n).map(move |_| value)).collect();
    let mut fine = Model {
        positions: model.positions.clone(),
        normals: model.normals.clone(),
        uvs: model.uvs.clone(),
        colors: model.colors.clone(),
        faces: Vec::with_capacity(faces as usize),
        face_material: repeat(&model.face_material),
        face_mesh: repeat(&model.face_mesh),
        face_polygon: Vec::new(),
        one_sided: (model.one_sided.iter()).flat_map(|&one| std::iter::repeat_n(one, (n * n) as usize)).collect(),
        lines: model.lines.clone(),
        side_visibility: Vec::new(),
        materials: model.materials.clone(),
        textures: model.textures.clone(),
    };
    fine.positions.reserve_exact(added as usize);
    fine.normals.reserve_exact(added as usize);
    let face_lines = std::mem::take(&mut network.face_lines);
    for (&[a, b, c], [ab, bc, ca]) in model.faces.iter().zip(face_lines) {
        let mut side = |ends, line| network.side(&mut fine, &normals, segments, ends, line);
        let sides = [side([a, b], ab), side([b, c], bc), side([c, a], ca)];
        let first_inside = fine.positions.len() as u32;
        let patch = Patch::new(model, &normals, [a, b, c].map(|v| v as usize), sides);
        for row in 2..segments {
            for column in 1..row {
                patch.push_point(&mut fine, [row - column, column].map(|step| f64::from(step) / f64::from(segments)));
            }
        }
        // Row 0 is the first corner, the last row the opposite edge; columns go from the second corner to the third.
        let at = |row: u32, column: u32| {
            if column == 0 {
                sides[0].vertex(row)
            } else if column == row {
                sides[2].vertex(segments - row)
            } else if row == segments {
                sides[1].vertex(column)
            } else {
                first_inside + (row - 1) * (row - 2) / 2 + column - 1
            }
        };
        for row in 0..segments {
            for column in 0..=row {
                let (here, below) = (at(row, column), at(row + 1, column + 1));
                fine.faces.push([here, at(row + 1, column), below]);
                if column < row {
                    fine.faces.push([here, below, at(row, column + 1)]);
                }
            }
        }
    }
    fine.side_visibility = model.side_visibility.iter().flat_map(|sides| sides_of_patch(sides, segments)).collect();
    Ok(fine)
}

/// What the sides of a patch's faces are: along a side of the patch what that is, and silhouettes within it, stated once
/// for each edge.
fn sides_of_patch(&[ab, bc, ca]: &[SideVisibility; 3], segments: u32) -> Vec<[SideVisibility; 3]> {
    let stated = ab != SideVisibility::Unstated;
    let [silhouette, repeated] = [SideVisibility::Silhouette, SideVisibility::Hidden]
        .map(|inner| if stated { inner } else { SideVisibility::Unstated });
    let mut sides = Vec::with_capacity((segments * segments) as usize);
    for row in 0..segments {
        for column in 0..=row {
            let on = |is_side: bool, side| if is_side { side } else { silhouette };
            sides.push([on(column == 0, ab), on(row + 1 == segments, bc), on(column == row, ca)]);
            if column < row {
                sides.push([repeated; 3]);
            }
        }
    }
    sides
}

fn check(what: &'static str, count: u64, limit: u64) -> Result<(), TessellateError> {
    if count > limit { Err(TessellateError::TooLarge { what, count, limit }) } else { Ok(()) }
}

/// The curves along the edges, and the vertices on them.
struct Network {
    /// Per vertex the lowest-numbered one at its position.
    representative: Vec<u32>,
    /// Per edge between two positions, from the lower-numbered one: the inner control points relative to their ends.
    curves: Vec<[DVec3; 2]>,
    /// Per pair of vertices that is a side of a face.
    lines: Vec<Line>,
    /// The lines of the three sides of each face.
    face_lines: Vec<[u32; 3]>,
}

/// Two vertices that are connected by a curve.
struct Line {
    curve: u32,
    /// The first new vertex on it; [`UNNUMBERED`] until a face uses the line.
    first: u32,
}

const UNNUMBERED: u32 = u32::MAX;

/// A side of a face in the direction of the face.
#[derive(Clone, Copy)]
struct Side {
    ends: [u32; 2],
    segments: u32,
    /// The first new vertex of its line.
    first: u32,
    /// Whether its direction is opposite to that of its line.
    turned: bool,
    /// The inner control points of its curve relative to their ends.
    handles: [DVec3; 2],
}

impl Side {
    /// The vertex at the end of segment `step`.
    fn vertex(&self, step: u32) -> u32 {
        match step {
            0 => self.ends[0],
            _ if step == self.segments => self.ends[1],
            _ if self.turned => self.first + self.segments - 1 - step,
            _ => self.first + step - 1,
        }
    }
}

impl Network {
    fn of(model: &Model, normals: &[DVec3]) -> Self {
        let representative = weld_exact(&model.positions);
        // Sorted by positions and then by vertices, so that sides with a common curve are adjacent. Sorting is faster
        // than hashing here.
        let pair = |[a, b]: [u32; 2]| (u64::from(a) << 32) | u64::from(b);
        let unpair = |pair: u64| [(pair >> 32) as usize, pair as u32 as usize];
        let mut sides = Vec::with_capacity(model.faces.len() * 3);
        for (face, corners) in model.faces.iter().enumerate() {
            for side in 0..3 {
                let (ends, _) = along_line(&representative, [corners[side], corners[(side + 1) % 3]]);
                sides.push((pair(ends.map(|v| representative[v as usize])), pair(ends), 3 * face as u32 + side as u32));
            }
        }
        sides.sort_unstable();
        let mut face_lines = vec![[0; 3]; model.faces.len()];
        let (mut curves, mut lines) = (Vec::with_capacity(sides.len() / 2), Vec::with_capacity(sides.len() / 2));
        for at_edge in sides.chunk_by(|a, b| a.0 == b.0) {
            let [low, high] = unpair(at_edge[0].0).map(|vertex| model.positions[vertex].as_dvec3());
            let normals_at = |end: usize| at_edge.iter().map(move |side| normals[unpair(side.1)[end]]);
            curves.push([handle(high - low, normals_at(0)), handle(low - high, normals_at(1))]);
            for at_line in at_edge.chunk_by(|a, b| a.1 == b.1) {
                for &(_, _, corner) in at_line {
                    face_lines[corner as usize / 3][corner as usize % 3] = lines.len() as u32;
                }
                lines.push(Line { curve: curves.len() as u32 - 1, first: UNNUMBERED });
            }
        }
        Self { representative, curves, lines, face_lines }
    }

    /// A side of a face. Its new vertices are added to `fine` unless another face has added them.
    fn side(&mut self, fine: &mut Model, normals: &[DVec3], segments: u32, ends: [u32; 2], line: u32) -> Side {
        let (along, turned) = along_line(&self.representative, ends);
        let line = &mut self.lines[line as usize];
        let handles = self.curves[line.curve as usize];
        if line.first == UNNUMBERED {
            line.first = fine.positions.len() as u32;
            let [low, high] = along.map(|v| v as usize);
            let [from, to] = [low, high].map(|v| fine.positions[v].as_dvec3());
            let middle = middle_normal(to - from, normals[low], normals[high]);
            for step in 1..segments {
                let t = f64::from(step) / f64::from(segments);
                let s = 1.0 - t;
                let bulge = handles[0] * (3.0 * s * s * t) + handles[1] * (3.0 * s * t * t);
                fine.positions.push((from + (to - from) * (t * t * (3.0 - 2.0 * t)) + bulge).as_vec3());
                let normal = normals[low] * (s * s) + normals[high] * (t * t) + middle * (2.0 * s * t);
                fine.normals.push(normal.normalize_or(normals[low]).as_vec3());
                push_linear(fine, [low, high, high], t, 0.0);
            }
        }
        let handles = if turned { [handles[1], handles[0]] } else { handles };
        Side { ends, segments, first: line.first, turned, handles }
    }
}

/// The ends of a side in a direction that is common to all faces, and whether the side has the opposite direction.
fn along_line(representative: &[u32], [from, to]: [u32; 2]) -> ([u32; 2], bool) {
    let turned = (representative[from as usize], from) > (representative[to as usize], to);
    (if turned { [to, from] } else { [from, to] }, turned)
}

/// Sines of the angle between two normals. Up to the first the normals count as equal up to quantisation; from the
/// second on they form a crease.
const SMOOTH_SINE: f64 = 0.1;
const CREASE_SINE: f64 = 0.3;

/// The inner control point of a curve relative to its end, from the chord to the other end and the unit or zero
/// normals.
fn handle(chord: DVec3, normals: impl Iterator<Item = DVec3>) -> DVec3 {
    let mut normals = normals.filter(|&normal| normal != DVec3::ZERO);
    let Some(first) = normals.next() else {
        return chord / 3.0;
    };
    // The sign of a normal is irrelevant.
    let (cos, other) = normals.fold((1.0, first), |(least, other), normal| {
        let cos = first.dot(normal);
        if cos.abs() < f64::abs(least) { (cos, normal) } else { (least, other) }
    });
    let other = if cos < 0.0 { -other } else { other };
    let mean = (first + other).normalize();
    let mut handle = chord - mean * chord.dot(mean);
    let sine = first.cross(other).length();
    if sine > SMOOTH_SINE {
        // Perpendicular to the mean, in the plane of both normals.
        let across = (first - other).normalize();
        let share = ((sine - SMOOTH_SINE) / (CREASE_SINE - SMOOTH_SINE)).min(1.0);
        handle -= across * (chord.dot(across) * share);
    }
    handle / 3.0
}

/// The coefficient n110 of the paper: the sum of both normals, reflected in the plane perpendicular to the chord.
fn middle_normal(chord: DVec3, a: DVec3, b: DVec3) -> DVec3 {
    let sum = a + b;
    let length_squared = chord.length_squared();
    if a == DVec3::ZERO || b == DVec3::ZERO || length_squared == 0.0 {
        return sum.normalize_or_zero();
    }
    (sum - chord * (2.0 * chord.dot(sum) / length_squared)).normalize_or_zero()
}

/// The Bézier triangle of a face.
struct Patch {
    corners: [usize; 3],
    positions: [DVec3; 3],
    /// The inner control points of each side relative to their ends.
    handles: [[DVec3; 2]; 3],
    normals: [DVec3; 3],
    middle_normals: [DVec3; 3],
}

impl Patch {
    fn new(model: &Model, normals: &[DVec3], corners: [usize; 3], sides: [Side; 3]) -> Self {
        let positions = corners.map(|v| model.positions[v].as_dvec3());
        let normals = corners.map(|v| normals[v]);
        let handles = sides.map(|side| side.handles);
        let middle = |i: usize, j: usize| middle_normal(positions[j] - positions[i], normals[i], normals[j]);
        Self { corners, positions, handles, normals, middle_normals: [middle(0, 1), middle(1, 2), middle(2, 0)] }
    }

    /// Adds the point with the barycentric weights u and v of the second and the third corner.
    fn push_point(&self, fine: &mut Model, [u, v]: [f64; 2]) {
        let w = 1.0 - u - v;
        let [p0, p1, p2] = self.positions;
        // The centre of the paper, E + (E - V) / 2, is V plus a quarter of the sum of all handles.
        let centre = 6.0 * u * v * w;
        let weight = |share: f64| share * share * (3.0 - 2.0 * share) + centre / 3.0;
        let mut position = p0 + (p1 - p0) * weight(u) + (p2 - p0) * weight(v);
        for ([from, to], [s, t]) in self.handles.into_iter().zip([[w, u], [u, v], [v, w]]) {
            position += from * (3.0 * s * s * t + centre / 4.0) + to * (3.0 * s * t * t + centre / 4.0);
        }
        let ([n0, n1, n2], [m0, m1, m2]) = (self.normals, self.middle_normals);
        let normal = n0 * (w * w) + n1 * (u * u) + n2 * (v * v) + (m0 * (w * u) + m1 * (u * v) + m2 * (v * w)) * 2.0;
        fine.positions.push(position.as_vec3());
        fine.normals.push(normal.normalize_or(n0).as_vec3());
        push_linear(fine, self.corners, u, v);
    }
}

/// Adds the texture coordinate and the colour of a new vertex. Values that all corners share remain exact.
fn push_linear(fine: &mut Model, [a, b, c]: [usize; 3], u: f64, v: f64) {
    let (u, v) = (u as f32, v as f32);
    if !fine.uvs.is_empty() {
        let [a, b, c]: [Vec2; 3] = [fine.uvs[a], fine.uvs[b], fine.uvs[c]];
        fine.uvs.push(a + (b - a) * u + (c - a) * v);
    }
    if !fine.colors.is_empty() {
        let [a, b, c]: [Vec4; 3] = [fine.colors[a], fine.colors[b], fine.colors[c]];
        fine.colors.push(a + (b - a) * u + (c - a) * v);
    }
}

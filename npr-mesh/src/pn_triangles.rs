//! Curved PN triangles: a finer mesh that bulges as its normals say.
//!
//! A. Vlachos, J. Peters, C. Boyd, J. L. Mitchell, "Curved PN Triangles", Symposium on Interactive 3D Graphics 2001:
//! each face becomes a cubic Bézier triangle made from its three positions and normals. Outlines that are polygons on
//! a coarse mesh become round.
//!
//! Two things differ from the paper and its usual implementations:
//!
//! - *Creases stay closed.* The paper's patches part where the two sides of an edge have different normals. Here an
//!   edge has one curve for all its faces. Where the sides differ, the curve leaves its end along the crease: the chord
//!   is projected onto the line in which both sides' tangent planes meet. So the rim of a cylinder becomes round and
//!   its lids stay flat: with 12 sides the rim is off by 0.0017 of the radius. (The mean of both sides' control points,
//!   as by J. McDonald and M. Kilgard, "Crack-Free Point-Normal Triangles using Adjacent Edge Normals", 2010, gives it
//!   half of its bulge, 0.018; the polygon is off by 0.034.)
//! - *The normals' mixed terms count twice*, as Bernstein polynomials demand. The usual sum of unit normals, n200 w² +
//!   … + n110 wu + …, errs to first order in the length of an edge, this to third.
//!
//! As the paper's, patches do not meet smoothly, on a coarse mesh at angles that may count as creases. Measured with
//! the unit sphere's normals on an octahedron and an icosahedron, and on the latter subdivided; 16 segments, for the
//! angles 64:
//!
//! | faces | farthest from the sphere | widest angle between patches | largest error of a normal, by the usual sum |
//! | --- | --- | --- | --- |
//! | 8 | 0.23 | 47° | 3.17°, 3.03° |
//! | 20 | 0.058 | 16° | 1.04°, 3.20° |
//! | 80 | 0.0063 | 2.9° | 0.184°, 2.17° |
//! | 320 | 0.00047 | 0.56° | 0.0254°, 1.18° |
//! | 1280 | 0.000030 | 0.14° | 0.0033°, 0.60° |

use glam::{DVec3, Vec2, Vec4};

use crate::Model;
use crate::edges::MOST_FACES;
use crate::weld::weld_exact;

/// Why a model could not be tessellated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TessellateError {
    /// An edge cannot be cut into 0 segments.
    #[error("0 segments an edge, of which 1 is the least")]
    NoSegments,
    /// The result would have more faces than [`crate::edges::find`] takes, or more vertices than a u32 numbers.
    #[error("{count} {what}, more than the limit of {limit}")]
    TooLarge {
        /// What there would be too much of: `"faces"` or `"vertices"`.
        what: &'static str,
        /// How much there would be; `u64::MAX` stands for itself and all above.
        count: u64,
        /// How much is allowed.
        limit: u64,
    },
}

/// Each face cut into `segments`² faces on its PN triangle; every edge into `segments` pieces.
///
/// `segments` is 1 or more; with 1 the model stays as it is.
///
/// - Positions lie on the cubic patch, normals are quadratic (unit), texture coordinates and colours linear. What is on
///   an edge is computed in the same direction whichever face asks.
/// - Edges are those between exactly equal positions ([`crate::weld`]). All faces at an edge have the same points on
///   it, to the last bit, whatever their normals and texture coordinates: what was closed stays closed. Faces that
///   share both its vertices share the new ones as well.
/// - Where the normals of an edge's sides at one of its ends are within 6° of each other (or of opposite), the curve is
///   there perpendicular to their mean; from 17° on it runs along the crease; in between it is in between. Of three
///   sides and more the first and the one that differs most from it count. A boundary has one side.
/// - A normal that is zero or not finite bends nothing: where no face has another, that end of the edge is straight.
///   New normals between such corners are zero, which is what [`crate::normals::fill_missing`] fills.
/// - So a face whose normals are its plane's stays in that plane, unless a neighbour's differ slightly, and an edge
///   between flat faces stays straight. Within its plane a thin face beside a strongly curved crease can fold over.
/// - Every new face is a polygon by itself, [`Model::face_polygon`] is empty: the edges within a patch are edges of a
///   curved surface, at which a contour can run, and so are the former diagonals. (With 1 segment polygons remain.)
///
/// The old vertices keep their numbers and their bits. The new ones follow in the order in which the faces meet them:
/// those on its edges, then those inside. The faces from face f are `segments`² · f and following, in strips that begin
/// at its first corner; each has its material.
///
/// The time is n log n in the model's faces and linear in the result's; on the way it takes 200 to 400 bytes a face
/// of the model.
///
/// # Errors
/// `segments` is 0, or the result has more than [`MOST_FACES`] faces or `u32::MAX` vertices. Nothing is allocated for
/// it before this is known.
///
/// # Panics
/// If a face names a vertex that is not there, or an array has another length than [`Model`] demands.
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
        // Row 0 is the first corner, the last one the opposite edge; columns run from the second corner to the third.
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
    Ok(fine)
}

fn check(what: &'static str, count: u64, limit: u64) -> Result<(), TessellateError> {
    if count > limit { Err(TessellateError::TooLarge { what, count, limit }) } else { Ok(()) }
}

/// The curves on which patches meet, and the vertices on them.
struct Network {
    /// Per vertex the lowest-numbered one at its position.
    place: Vec<u32>,
    /// Per edge between two places, from the lower-numbered one: its inner control points, each less its end.
    curves: Vec<[DVec3; 2]>,
    /// Per pair of vertices that some face has as a side.
    lines: Vec<Line>,
    /// Per face and side its line.
    face_lines: Vec<[u32; 3]>,
}

/// Two vertices joined by a curve.
struct Line {
    curve: u32,
    /// The first of the new vertices on it; [`UNNUMBERED`] until a face meets them.
    first: u32,
}

const UNNUMBERED: u32 = u32::MAX;

/// A side of a face, as it runs around the face.
#[derive(Clone, Copy)]
struct Side {
    ends: [u32; 2],
    segments: u32,
    /// The first new vertex of its line.
    first: u32,
    /// Whether it runs against its line.
    turned: bool,
    /// The inner control points of its curve, each less its end.
    handles: [DVec3; 2],
}

impl Side {
    /// The vertex so many of the segments from its beginning.
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
        let place = weld_exact(&model.positions);
        // Sorted by places, then by vertices; what shares a curve then stands together. Sorting beats hashing here.
        let pair = |[a, b]: [u32; 2]| (u64::from(a) << 32) | u64::from(b);
        let unpair = |pair: u64| [(pair >> 32) as usize, pair as u32 as usize];
        let mut sides = Vec::with_capacity(model.faces.len() * 3);
        for (face, corners) in model.faces.iter().enumerate() {
            for side in 0..3 {
                let (ends, _) = along_line(&place, [corners[side], corners[(side + 1) % 3]]);
                sides.push((pair(ends.map(|v| place[v as usize])), pair(ends), 3 * face as u32 + side as u32));
            }
        }
        sides.sort_unstable();
        let mut face_lines = vec![[0; 3]; model.faces.len()];
        let (mut curves, mut lines) = (Vec::with_capacity(sides.len() / 2), Vec::with_capacity(sides.len() / 2));
        for at_edge in sides.chunk_by(|a, b| a.0 == b.0) {
            let [low, high] = unpair(at_edge[0].0).map(|place| model.positions[place].as_dvec3());
            let normals_at = |end: usize| at_edge.iter().map(move |side| normals[unpair(side.1)[end]]);
            curves.push([handle(high - low, normals_at(0)), handle(low - high, normals_at(1))]);
            for at_line in at_edge.chunk_by(|a, b| a.1 == b.1) {
                for &(_, _, corner) in at_line {
                    face_lines[corner as usize / 3][corner as usize % 3] = lines.len() as u32;
                }
                lines.push(Line { curve: curves.len() as u32 - 1, first: UNNUMBERED });
            }
        }
        Self { place, curves, lines, face_lines }
    }

    /// A side of a face; the vertices on it are added to `fine` if no face has met them before.
    fn side(&mut self, fine: &mut Model, normals: &[DVec3], segments: u32, ends: [u32; 2], line: u32) -> Side {
        let (along, turned) = along_line(&self.place, ends);
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

/// The ends of a side in the direction that is the same for all faces, and whether the side runs against it.
fn along_line(place: &[u32], [from, to]: [u32; 2]) -> ([u32; 2], bool) {
    let turned = (place[from as usize], from) > (place[to as usize], to);
    (if turned { [to, from] } else { [from, to] }, turned)
}

/// Sines of the angle between two normals: up to the first they are one but for their rounding and quantisation, from
/// the second on they make a crease.
const SMOOTH_SINE: f64 = 0.1;
const CREASE_SINE: f64 = 0.3;

/// The inner control point of a curve, less its end, from the chord to the other end and the unit or zero normals here.
fn handle(chord: DVec3, normals: impl Iterator<Item = DVec3>) -> DVec3 {
    let mut normals = normals.filter(|&normal| normal != DVec3::ZERO);
    let Some(first) = normals.next() else {
        return chord / 3.0;
    };
    // Which side of its plane a normal is on does not matter.
    let (cos, other) = normals.fold((1.0, first), |(least, other), normal| {
        let cos = first.dot(normal);
        if cos.abs() < f64::abs(least) { (cos, normal) } else { (least, other) }
    });
    let other = if cos < 0.0 { -other } else { other };
    let mean = (first + other).normalize();
    let mut handle = chord - mean * chord.dot(mean);
    let sine = first.cross(other).length();
    if sine > SMOOTH_SINE {
        // Perpendicular to the mean, and in one plane with it and both normals.
        let across = (first - other).normalize();
        let share = ((sine - SMOOTH_SINE) / (CREASE_SINE - SMOOTH_SINE)).min(1.0);
        handle -= across * (chord.dot(across) * share);
    }
    handle / 3.0
}

/// The paper's n110: the sum of both normals, mirrored in the plane that is perpendicular to the chord.
fn middle_normal(chord: DVec3, a: DVec3, b: DVec3) -> DVec3 {
    let sum = a + b;
    let length_squared = chord.length_squared();
    if a == DVec3::ZERO || b == DVec3::ZERO || length_squared == 0.0 {
        return sum.normalize_or_zero();
    }
    (sum - chord * (2.0 * chord.dot(sum) / length_squared)).normalize_or_zero()
}

/// A face's Bézier triangle.
struct Patch {
    corners: [usize; 3],
    positions: [DVec3; 3],
    /// Per side its inner control points, each less its end.
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

    /// Adds the point with these shares of the second and of the third corner.
    fn push_point(&self, fine: &mut Model, [u, v]: [f64; 2]) {
        let w = 1.0 - u - v;
        let [p0, p1, p2] = self.positions;
        // The paper's centre, E + (E - V) / 2, is V plus a quarter of all handles.
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

/// Adds the texture coordinate and the colour that go with a new vertex. What all corners have in common stays exact.
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

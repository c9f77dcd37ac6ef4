//! Classifies edges as lines: silhouettes for an eye, and creases and boundaries, which are lines for every eye.
//!
//! # The test
//!
//! An edge is a silhouette where one of its faces is front-facing and the other back-facing (Card & Mitchell 2002,
//! listing 1). The listing multiplies two dot products with the view vector at a vertex and tests for a
//! product below zero. That loses an edge whose face is seen exactly edge-on, and, with normals that are not
//! quite perpendicular to their face, gives the two ends of one edge different results, which leaves half a
//! fin.
//!
//! Here a face is classified as a whole: by the side of its plane on which the eye is. The plane's four numbers
//! are the same in the records of all its edges, so that all edges and both ends of each agree, and silhouettes are
//! closed loops even where a face is within rounding of edge-on. With the eye as a homogeneous point, a perspective and
//! a parallel view are one formula.
//!
//! A face of a single-sided material that is seen from behind is not drawn, so an edge is a line only where one of its
//! faces is shown.
//!
//! # The records
//!
//! A plane is 16 bytes a face, and an edge with its ends, its two faces and its kind 16 bytes more. Edges that are lines
//! for every eye (boundaries, non-manifold edges, creases) come first, so that a scan tests only the others.

mod sides;

pub use sides::single_sided_faces;

use crate::OutlineError;
use glam::{DMat3, DVec3, DVec4, Vec3, Vec4};
use npr_mesh::edges::{Edge, EdgeKind, Edges, NO_FACE, triangle_normal};
use npr_mesh::{AlphaMode, Model, SideVisibility, edge_visibility};
use std::collections::HashMap;

/// Why an edge is a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum LineKind {
    /// It separates a front-facing from a back-facing face.
    Silhouette = 0,
    /// It has one face.
    Boundary = 1,
    /// The angle between its faces is more than the crease angle, or there are more than two of them.
    Crease = 2,
    /// Its faces are of two materials.
    MaterialBorder = 3,
    /// It is none of the surface's edges: the file itself draws it ([`Model::lines`]).
    Authored = 4,
}

impl LineKind {
    /// All kinds, each at the index of its number.
    pub const ALL: [Self; 5] = [Self::Silhouette, Self::Boundary, Self::Crease, Self::MaterialBorder, Self::Authored];
}

/// The planes of an edge's two faces: `n · p + d` with a unit normal `n`, relative to [`ContourEdges::origin`].
///
/// Both have the same winding; at a boundary the second is the negated first, so that the edge is a silhouette for
/// every eye (the chapter's step 1b).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgePlanes {
    /// The plane of the first face: nx, ny, nz, d.
    pub plane0: [f32; 4],
    /// The plane of the second face.
    pub plane1: [f32; 4],
}

/// An edge that can be a line, or a line that the file draws; 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct ContourEdge {
    /// The two vertices in the winding order of the first face, reversed where its plane is negated.
    pub ends: [u32; 2],
    /// The two faces, at a boundary twice the first, and above their 28 bits [`SINGLE_SIDED`] and [`TURNED`] of each; then
    /// of the first the [`LineKind`] that the edge has when it is not a silhouette, of the second [`SECOND_NEGATED`] and
    /// [`CUT_OUT`].
    ///
    /// The kind has two bits. A boundary's second plane is always negated, so that the kind of a boundary without that
    /// is [`LineKind::Authored`]. Such a line has the faces of the edge that it runs along, and where there are none the
    /// index after the last face, whose plane is zero. It is shown from both sides of them.
    packed: [u32; 2],
}

const _: () = assert!(size_of::<ContourEdge>() == 16);

/// The bits of a face's number.
const FACE: u32 = (1 << 28) - 1;
/// The most faces that a model's edges can be made for.
pub const MOST_FACES: usize = FACE as usize + 1;
/// The face is not shown to an eye behind it.
const SINGLE_SIDED: u32 = 1 << 28;
/// The plane of the face is opposite to its winding.
const TURNED: u32 = 1 << 29;
/// The plane of the second face is negated for this edge.
const SECOND_NEGATED: u32 = 1 << 30;
/// All faces of the edge are cut out by alpha, so that the line is visible only where they are.
const CUT_OUT: u32 = 1 << 31;

impl ContourEdge {
    /// The two faces; at a boundary twice the first. Of a line that the file draws, one or both may be the index after the
    /// last face.
    #[inline]
    pub fn faces(&self) -> [u32; 2] {
        self.packed.map(|packed| packed & FACE)
    }

    /// The kind of line that the edge is when it is not a silhouette: [`LineKind::Silhouette`] where it is none.
    #[inline]
    pub fn own_kind(&self) -> LineKind {
        match LineKind::ALL[(self.packed[0] >> 30) as usize] {
            LineKind::Boundary if self.packed[1] & SECOND_NEGATED == 0 => LineKind::Authored,
            kind => kind,
        }
    }

    /// Whether the edge is a line for every eye.
    pub fn is_always(&self) -> bool {
        self.own_kind() != LineKind::Silhouette
    }

    /// Whether all faces of the edge are cut out by alpha, so that the line is visible only where they are.
    pub fn is_cut_out(&self) -> bool {
        self.packed[1] & CUT_OUT != 0
    }
}

/// Which edges are lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContourOptions {
    /// An edge with a larger angle between its faces is a crease; radians, 0..=π.
    pub crease_angle_rad: f32,
    /// Whether edges between two materials are lines.
    pub material_borders: bool,
    /// Whether creases are lines. Without them no angle is computed, and an edge of more than two faces is a line where its
    /// first two make it a silhouette.
    pub creases: bool,
    /// Whether boundaries are lines; if not, they have no records.
    pub boundaries: bool,
    /// Whether silhouettes are lines; if not, edges that can be no other line have no records.
    pub silhouettes: bool,
    /// Whether the lines that the file draws are lines.
    pub authored: bool,
    /// Whether the file decides, where it says something of an edge ([`Model::side_visibility`]): a hard edge is a crease
    /// or boundary at any angle, one that is a silhouette is no crease, a hidden one is never a line.
    pub file_edges: bool,
    /// The inverse transpose of the matrix that places the model, where angles between faces are those of the placed
    /// model: shear and non-uniform scale change them. Any factor; the identity for the model's own angles.
    pub world_from_normal: DMat3,
    /// Whether all faces are double-sided, or none is; `None` for what their materials say.
    pub double_sided: Option<bool>,
}

impl Default for ContourOptions {
    /// Silhouettes, boundaries, creases over 45°, lines and edges of the file, no material borders, the model's own
    /// angles, sides by material.
    fn default() -> Self {
        Self {
            crease_angle_rad: 45f32.to_radians(),
            material_borders: false,
            creases: true,
            boundaries: true,
            silhouettes: true,
            authored: true,
            file_edges: true,
            world_from_normal: DMat3::IDENTITY,
            double_sided: None,
        }
    }
}

/// The edges of a model that can be lines, and the lines that its file draws, ready for scanning.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContourEdges {
    /// The origin of the planes' coordinates: the centre of the model's bounds, so that d keeps its precision in f32.
    pub origin: Vec3,
    /// The plane of each face: nx, ny, nz, d. Those of faces that are wound oppositely to the first face of their
    /// connected component are negated. Followed by a plane of zeros if a line of the file runs along no edge.
    pub planes: Vec<[f32; 4]>,
    /// The edges.
    pub edges: Vec<ContourEdge>,
    /// The number of edges that are lines for every eye that sees one of their faces; they come first.
    pub always: usize,
    /// Whether some face is not shown to an eye behind it. An edge is then a line only where one of its faces is shown.
    pub single_sided: bool,
}

/// Makes the records of a model's edges, those that are lines for every eye first.
///
/// `edges`: of this model, best found with [`npr_mesh::edges::EdgeOptions::skip_redundant`]. Where the model's
/// `face_polygon` is empty each face is a polygon; where its `face_material` is, faces are opaque.
///
/// A face of zero area takes the plane of the neighbour across its longest edge, so that a sliver between two faces
/// does not hide their silhouette or crease.
///
/// An edge between faces whose planes are the same numbers is a silhouette for no eye, and neither is a non-manifold edge
/// with faces on all sides ([`Edge::is_surrounded`]). It has no record unless it is another line.
///
/// Lines of the file ([`Model::lines`]) come last among those for every eye, without those of no length. One that runs
/// along an edge has its faces, so that it is as visible as the edge would be at the bottom of a valley.
///
/// A folded polygon's triangles ([`Edges::folds`]) each have their own plane, so that the contour is closed where some
/// of them are back-facing; for creases the polygon's Newell normal is used.
///
/// # Sides
///
/// A face of a single-sided material is not shown to an eye behind it. An edge is a line only for an eye to which one of
/// its faces is shown; between a shown and a culled face it is a contour. A face whose duplicate has the opposite winding,
/// or is double-sided, is shown from both sides. Edges of more than two faces are lines for every eye.
///
/// # Errors
/// [`OutlineError::CreaseAngle`], [`OutlineError::TooManyFaces`].
pub fn contour_edges(model: &Model, edges: &Edges, options: &ContourOptions) -> Result<ContourEdges, OutlineError> {
    let angle_rad = options.crease_angle_rad;
    if !(0.0..=std::f32::consts::PI).contains(&angle_rad) {
        return Err(OutlineError::CreaseAngle { angle_rad });
    }
    if model.faces.len() > MOST_FACES {
        return Err(OutlineError::TooManyFaces { faces: model.faces.len() });
    }
    let origin = model.bounds().map_or(Vec3::ZERO, |(low, high)| low.midpoint(high));
    let cos_crease = angle_rad.cos();
    let borrowed = borrowed_normals(&model.positions, edges);
    let flipped = flipped_faces(edges, &model.face_polygon);
    let is_flipped = |face: u32| flipped.get(face as usize) == Some(&true);
    let cut_out: Vec<bool> = model.materials.iter().map(|m| matches!(m.alpha_mode, AlphaMode::Mask { .. })).collect();
    let wound = |normal: Vec3, face: u32| if is_flipped(face) { -normal } else { normal };
    let normal_of = |face: u32| {
        let own = edges.face_normals[face as usize];
        wound(if own == Vec3::ZERO { borrowed.get(&face).copied().unwrap_or(Vec3::ZERO) } else { own }, face)
    };
    let points = plane_points(model);
    let folded = folded_normals(model, edges);
    // Computed once for each face, since each is in three edges.
    let mut planes: Vec<[f32; 4]> = (0..edges.face_normals.len() as u32)
        .map(|face| {
            let (normal, on) = match folded.get(&face) {
                Some(&own) => (wound(own, face), first_corner(model, face)),
                None => {
                    (normal_of(face), points.get(face as usize).copied().unwrap_or_else(|| first_corner(model, face)))
                }
            };
            normal.extend(-normal.as_dvec3().dot(on - origin.as_dvec3()) as f32).to_array()
        })
        .collect();
    // Of a folded polygon's triangles the planes do not have the polygon's normal.
    let wound_normal = |face: u32| {
        let [x, y, z, _] = planes[face as usize];
        if folded.is_empty() { Vec3::new(x, y, z) } else { normal_of(face) }
    };
    let is_placed = options.world_from_normal != DMat3::IDENTITY;
    let placed = |normal: Vec3| match is_placed {
        true => (options.world_from_normal * normal.as_dvec3()).normalize_or_zero().as_vec3(),
        false => normal,
    };
    // After flipping, two faces with different windings remain only on non-orientable surfaces.
    let fits = |edge: &Edge| {
        let [first, second] = edge.faces();
        edge.kind() == EdgeKind::Boundary || edge.wound_oppositely() == (is_flipped(first) != is_flipped(second))
    };
    let visibility = if options.file_edges { edge_visibility(model, edges) } else { Vec::new() };
    let line_by_angle = |edge: &Edge| match edge.kind() {
        EdgeKind::Boundary => Some(LineKind::Boundary),
        EdgeKind::NonManifold => options.creases.then_some(LineKind::Crease),
        EdgeKind::TwoFace => {
            let is_crease = || {
                let [n0, n1] = edge.faces().map(|face| placed(wound_normal(face)));
                let cos = if fits(edge) { n0.dot(n1) } else { -n0.dot(n1) };
                cos < cos_crease && n0 != Vec3::ZERO && n1 != Vec3::ZERO
            };
            if options.creases && is_crease() {
                Some(LineKind::Crease)
            } else if options.material_borders && edge.joins_two_materials() {
                Some(LineKind::MaterialBorder)
            } else {
                None
            }
        }
    };
    let line_of = |(number, edge): (usize, &Edge)| match visibility.get(number) {
        Some(SideVisibility::Hard) if edge.kind() != EdgeKind::Boundary => options.creases.then_some(LineKind::Crease),
        // A boundary has no other face, so that its side is stated as a silhouette only by mistake.
        Some(SideVisibility::Silhouette) if edge.kind() != EdgeKind::Boundary => {
            (options.material_borders && edge.joins_two_materials()).then_some(LineKind::MaterialBorder)
        }
        _ => line_by_angle(edge),
    };
    let is_hidden = |number: usize| visibility.get(number) == Some(&SideVisibility::Hidden);
    let lines: Vec<u8> =
        edges.edges.iter().enumerate().map(|edge| line_of(edge).unwrap_or(LineKind::Silhouette) as u8).collect();
    let is_always = |line: u8| line != LineKind::Silhouette as u8;
    // Faces in exactly one plane are on the same side of it for every eye.
    let is_flat = |edge: &Edge| {
        let [first, second] = edge.faces();
        edge.is_surrounded()
            || edge.kind() != EdgeKind::Boundary && planes[first as usize] == planes[second as usize] && fits(edge)
    };
    let is_kept = |edge: &Edge, line: u8| match options.silhouettes {
        _ if line == LineKind::Boundary as u8 => options.boundaries,
        true => is_always(line) || !is_flat(edge),
        false => is_always(line),
    };
    let kept: Vec<bool> = edges.edges.iter().zip(&lines).map(|(edge, &line)| is_kept(edge, line)).collect();
    let kept: Vec<bool> = kept.into_iter().enumerate().map(|(number, kept)| kept && !is_hidden(number)).collect();
    let always = lines.iter().zip(&kept).filter(|&(&line, &kept)| is_always(line) && kept).count();
    let authored = if options.authored { authored_lines(model, edges) } else { Vec::new() };
    let always = always + authored.len();
    let folds = if options.silhouettes { &edges.folds[..] } else { &[] };
    let kept_count = kept.iter().filter(|&&kept| kept).count() + authored.len();
    let mut contour_edges: Vec<ContourEdge> = bytemuck::zeroed_vec(kept_count + folds.len());
    let is_cut_out = |face: u32| face == NO_FACE || cut_out[model.face_material[face as usize] as usize];
    // Faces without material are opaque.
    let any_cut_out = !model.face_material.is_empty() && cut_out.contains(&true);
    let of_edges = edges.edges.iter().zip(lines).zip(kept).filter(|&(_, kept)| kept);
    let of_edges = of_edges.map(|((edge, line), _)| (edge, line, fits(edge)));
    // A polygon's triangles are wound consistently, and a fold is a line only where it is a silhouette.
    let of_folds = folds.iter().map(|fold| (fold, LineKind::Silhouette as u8, true));
    let single_sided = single_sided_faces(model, edges, options.double_sided);
    let (mut next_always, mut next, mut any_single_sided) = (0, always, false);
    for (edge, line, fits) in of_edges.chain(of_folds) {
        let position = if is_always(line) { &mut next_always } else { &mut next };
        let [first, second] = edge.faces();
        let is_single = second == NO_FACE;
        let cut_out = if any_cut_out && is_cut_out(first) && is_cut_out(second) { CUT_OUT } else { 0 };
        // Twice the same plane is a silhouette for no eye.
        let (second, fits) = if edge.is_surrounded() { (first, true) } else { (second, fits) };
        let negated = if is_single || !fits { SECOND_NEGATED } else { 0 };
        let second = if is_single { first } else { second };
        let side = |face: u32| match single_sided.get(face as usize) {
            Some(true) if edge.kind() != EdgeKind::NonManifold => {
                SINGLE_SIDED | if is_flipped(face) { TURNED } else { 0 }
            }
            _ => 0,
        };
        let sides = [first, second].map(side);
        any_single_sided |= sides[0] != 0 && sides[1] != 0;
        let [from, to] = edge.ends;
        contour_edges[*position] = ContourEdge {
            ends: if is_flipped(first) { [to, from] } else { [from, to] },
            packed: [first | sides[0] | u32::from(line) << 30, second | sides[1] | negated | cut_out],
        };
        *position += 1;
    }
    let no_face = edges.face_normals.len() as u32;
    for (ends, edge) in authored {
        let (mut ends, mut faces) = (ends, [no_face; 2]);
        if let Some(edge) = edge.filter(|edge| fits(edge)) {
            let [first, second] = edge.faces();
            let [from, to] = edge.ends;
            ends = if is_flipped(first) { [to, from] } else { [from, to] };
            faces = [first, if second == NO_FACE { no_face } else { second }];
        }
        if faces.contains(&no_face) && planes.len() == no_face as usize {
            planes.push([0.0; 4]);
        }
        contour_edges[next_always] =
            ContourEdge { ends, packed: [faces[0] | (LineKind::Boundary as u32) << 30, faces[1]] };
        next_always += 1;
    }
    Ok(ContourEdges { origin, planes, edges: contour_edges, always, single_sided: any_single_sided })
}

/// The lines of the file that have a length, each with the edge that it runs along.
fn authored_lines<'a>(model: &Model, edges: &'a Edges) -> Vec<([u32; 2], Option<&'a Edge>)> {
    if model.lines.is_empty() {
        return Vec::new();
    }
    let sorted = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    let known: HashMap<[u32; 2], &Edge> = edges.edges.iter().map(|edge| (sorted(edge.ends), edge)).collect();
    let of_line = |&line: &[u32; 2]| {
        let [from, to] = line.map(|vertex| edges.representative[vertex as usize]);
        (from != to).then(|| (line, known.get(&sorted([from, to])).copied()))
    };
    model.lines.iter().filter_map(of_line).collect()
}

/// The normals of those triangles of folded polygons that have an area; the others keep their polygon's plane.
fn folded_normals(model: &Model, edges: &Edges) -> HashMap<u32, Vec3> {
    let faces = edges.folds.iter().flat_map(Edge::faces);
    let normals = faces.map(|face| (face, triangle_normal(&model.positions, &model.faces[face as usize])));
    normals.filter(|(_, normal)| *normal != Vec3::ZERO).collect()
}

fn first_corner(model: &Model, face: u32) -> DVec3 {
    model.positions[model.faces[face as usize][0] as usize].as_dvec3()
}

/// For each face a point of its plane, the same for all of its edges: of a polygon, which may be warped, the mean of
/// its triangles' corners. Empty where each face is a polygon; then the point is [`first_corner`].
fn plane_points(model: &Model) -> Vec<DVec3> {
    let mut points = Vec::with_capacity(model.face_polygon.len());
    for polygon in model.face_polygon.chunk_by(|a, b| a == b) {
        let faces = &model.faces[points.len()..points.len() + polygon.len()];
        let corners = faces.iter().flatten().map(|&v| model.positions[v as usize].as_dvec3());
        let mean = corners.sum::<DVec3>() / (3 * polygon.len()) as f64;
        points.resize(points.len() + polygon.len(), mean);
    }
    points
}

/// For each face of zero area the normal, wound like the face, of the neighbour over its longest edge.
fn borrowed_normals(positions: &[Vec3], edges: &Edges) -> HashMap<u32, Vec3> {
    let mut lenders = HashMap::<u32, (f64, u32, bool)>::new();
    if !edges.face_normals.contains(&Vec3::ZERO) {
        return HashMap::new();
    }
    for edge in edges.edges.iter().filter(|edge| edge.kind() == EdgeKind::TwoFace) {
        let [p, q] = edge.ends.map(|v| positions[v as usize].as_dvec3());
        let length = p.distance_squared(q);
        let [first, second] = edge.faces();
        for (face, other) in [(first, second), (second, first)] {
            if edges.face_normals[face as usize] == Vec3::ZERO
                && lenders.get(&face).is_none_or(|&(longest, ..)| length > longest)
            {
                lenders.insert(face, (length, other, edge.wound_oppositely()));
            }
        }
    }
    // The neighbour of a sliver may be a sliver too: chains are followed to the first face with an area, and each face
    // of the chain gets its normal. Chains that end in a cycle have none.
    let mut borrowed = HashMap::<u32, Vec3>::new();
    let mut way = Vec::new();
    for &face in lenders.keys() {
        let mut at = face;
        let mut found = loop {
            let own = edges.face_normals[at as usize];
            if own != Vec3::ZERO {
                break own;
            }
            if let Some(&known) = borrowed.get(&at) {
                break known;
            }
            let Some(&(_, lender, oppositely)) = lenders.get(&at) else { break Vec3::ZERO };
            // Marks the face as visited, which ends cycles.
            borrowed.insert(at, Vec3::ZERO);
            way.push((at, oppositely));
            at = lender;
        };
        while let Some((at, oppositely)) = way.pop() {
            found = if oppositely { -found } else { found };
            borrowed.insert(at, found);
        }
    }
    borrowed.retain(|_, normal| *normal != Vec3::ZERO);
    borrowed
}

/// For each face whether it is wound oppositely to the first face of its connected component; empty if none is.
///
/// The plane of a face is negated in all its edges or in none: an eye exactly in the plane is in front of the plane and
/// of the negated plane, so that a mixture would leave loops of silhouettes open.
fn flipped_faces(edges: &Edges, face_polygon: &[u32]) -> Vec<bool> {
    let two_face = || edges.edges.iter().filter(|edge| edge.kind() == EdgeKind::TwoFace);
    if !two_face().any(|edge| edge.wound_oppositely()) {
        return Vec::new();
    }
    // A union-find forest: for each face its parent and whether the two are wound oppositely.
    let mut above: Vec<(u32, bool)> = (0..edges.face_normals.len() as u32).map(|face| (face, false)).collect();
    fn root(above: &mut [(u32, bool)], mut face: u32) -> (u32, bool) {
        let mut flipped = false;
        loop {
            let (parent, from_parent) = above[face as usize];
            if parent == face {
                return (face, flipped);
            }
            let (next, from_next) = above[parent as usize];
            // A root is its own parent, with the same winding.
            let step = (next, from_parent != from_next);
            above[face as usize] = step;
            (face, flipped) = (step.0, flipped != step.1);
        }
    }
    let mut join = |faces: [u32; 2], oppositely: bool| {
        let [(a, a_flipped), (b, b_flipped)] = faces.map(|face| root(&mut above, face));
        if a != b {
            above[a.max(b) as usize] = (a.min(b), (a_flipped != b_flipped) != oppositely);
        }
    };
    // The diagonals within a polygon are not among the edges.
    for (face, pair) in (1u32..).zip(face_polygon.windows(2)) {
        if pair[0] == pair[1] {
            join([face - 1, face], false);
        }
    }
    for edge in two_face() {
        join(edge.faces(), edge.wound_oppositely());
    }
    (0..above.len() as u32).map(|face| root(&mut above, face).1).collect()
}

/// The signed distance of a homogeneous eye from a plane: positive in front, negative behind.
///
/// `eye`: a point with w = 1, or for a parallel view the direction to the viewer with w = 0, relative to
/// [`ContourEdges::origin`]. The sum is in this order so that the WGSL twin gives the same bits.
#[inline]
pub fn outline_facing(plane: [f32; 4], eye: Vec4) -> f32 {
    plane[0] * eye.x + plane[1] * eye.y + plane[2] * eye.z + plane[3] * eye.w
}

/// Whether exactly one of the two faces is front-facing. A face seen exactly edge-on is front-facing, so that loops of
/// silhouettes are not interrupted there.
#[inline]
pub fn outline_is_silhouette(planes: &EdgePlanes, eye: Vec4) -> bool {
    (outline_facing(planes.plane0, eye) >= 0.0) != (outline_facing(planes.plane1, eye) >= 0.0)
}

/// Whether a face is shown to an eye that is on this side of its plane. `packed`: the face with its flags.
#[inline]
fn outline_is_shown(packed: u32, facing: f32) -> bool {
    packed & SINGLE_SIDED == 0 || if packed & TURNED != 0 { facing <= 0.0 } else { facing >= 0.0 }
}

/// The kind of line that an edge is for an eye, if it is a line. `eye` as for [`outline_facing`].
fn outline_kind(own: LineKind, planes: &EdgePlanes, eye: Vec4) -> LineKind {
    // A boundary's planes make it a silhouette for every eye, but its kind is that of a boundary. A line of the file may
    // have the planes of an edge.
    let is_fixed = matches!(own, LineKind::Boundary | LineKind::Authored);
    if !is_fixed && outline_is_silhouette(planes, eye) { LineKind::Silhouette } else { own }
}

impl ContourEdges {
    /// The size of the largest buffer for finding these edges' lines on a device, bytes.
    pub fn device_bytes(&self, positions: &[Vec3]) -> u64 {
        size_of_val(&self.planes[..]).max(size_of_val(&self.edges[..])).max(size_of_val(positions)) as u64
    }

    /// The eye in the coordinates of the planes. `eye` is a world-space point with w = 1 or direction with w = 0.
    pub fn local_eye(&self, eye: DVec4) -> Vec4 {
        (eye - self.origin.as_dvec3().extend(0.0) * eye.w).as_vec4()
    }

    /// Writes the numbers of all edges that are lines for this eye into `lines`, ascending.
    ///
    /// `eye`: world space, a point with w = 1, or for a parallel view the direction to the viewer with w = 0.
    /// `lines` is cleared first and has at most one entry for each edge.
    pub fn scan(&self, eye: DVec4, lines: &mut Vec<u32>) {
        let eye = self.local_eye(eye);
        lines.clear();
        lines.extend(0..self.always as u32);
        if self.always < self.edges.len() {
            self.scan_contours(eye, lines);
        }
        if self.single_sided {
            lines.retain(|&line| self.is_shown(line as usize, eye));
        }
    }

    /// Adds the numbers of the edges that are lines for this eye only. `eye`: relative to [`Self::origin`].
    fn scan_contours(&self, eye: Vec4, lines: &mut Vec<u32>) {
        // The side of each face once, without branches, which the compiler vectorises: a byte for each.
        let is_front = |plane: &[f32; 4]| u8::from(outline_facing(*plane, eye) >= 0.0);
        let front: Vec<u8> = self.planes.iter().map(is_front).collect();
        // Two passes over each block: the comparison, then the hits. Only about one edge in fifty of a scanned model is
        // a hit.
        const BLOCK: usize = 64;
        for (block_number, block) in self.edges[self.always..].chunks(BLOCK).enumerate() {
            let (mut hits, mut negated) = (0u64, 0u32);
            for (bit, edge) in block.iter().enumerate() {
                let [first, second] = edge.faces();
                hits |= u64::from(front[first as usize] ^ front[second as usize]) << bit;
                negated |= edge.packed[1];
            }
            let first = self.always + block_number * BLOCK;
            if negated & SECOND_NEGATED != 0 {
                // On surfaces without orientation. An eye in the plane is in front of it and of the negated plane.
                let is_hit = |bit: usize| outline_is_silhouette(&self.edge_planes(first + bit), eye);
                hits = (0..block.len()).map(|bit| u64::from(is_hit(bit)) << bit).sum();
            }
            while hits != 0 {
                lines.push(first as u32 + hits.trailing_zeros());
                hits &= hits - 1;
            }
        }
    }

    /// Whether one of an edge's faces is shown to an eye, relative to [`Self::origin`].
    fn is_shown(&self, edge: usize, eye: Vec4) -> bool {
        let edge = &self.edges[edge];
        let facing = |face: u32| outline_facing(self.planes[face as usize], eye);
        edge.packed.iter().zip(edge.faces()).any(|(&packed, face)| outline_is_shown(packed, facing(face)))
    }

    /// The planes of an edge's faces.
    #[inline]
    pub fn edge_planes(&self, edge: usize) -> EdgePlanes {
        let edge = &self.edges[edge];
        let [plane0, plane1] = edge.faces().map(|face| self.planes[face as usize]);
        let negated = edge.packed[1] & SECOND_NEGATED != 0;
        EdgePlanes { plane0, plane1: if negated { plane1.map(|x| -x) } else { plane1 } }
    }

    /// Unit normals of an edge's faces for the same winding; the second is zero at a boundary.
    pub fn normals(&self, edge: usize) -> [Vec3; 2] {
        let EdgePlanes { plane0, plane1 } = self.edge_planes(edge);
        let normal = |plane: [f32; 4]| Vec3::new(plane[0], plane[1], plane[2]);
        let boundary = self.edges[edge].own_kind() == LineKind::Boundary;
        [normal(plane0), if boundary { Vec3::ZERO } else { normal(plane1) }]
    }

    /// What kind of line an edge is for this eye (in the planes' own coordinates, [`ContourEdges::local_eye`]),
    /// or `None` if it is none.
    pub fn kind(&self, edge: usize, eye: Vec4) -> Option<LineKind> {
        let (record, planes) = (&self.edges[edge], &self.edge_planes(edge));
        let is_line = record.is_always() || outline_is_silhouette(planes, eye);
        let is_line = is_line && (!self.single_sided || self.is_shown(edge, eye));
        is_line.then(|| outline_kind(record.own_kind(), planes, eye))
    }
}

/// The side of a triangle's plane on which a homogeneous eye is, in f64 from its corners: positive in front. The
/// reference that records are compared with.
pub(crate) fn facing_exact([a, b, c]: [Vec3; 3], eye: DVec4) -> f64 {
    let [a, b, c] = [a.as_dvec3(), b.as_dvec3(), c.as_dvec3()];
    (b - a).cross(c - a).dot(eye.truncate() - a * eye.w)
}

#[cfg(test)]
mod tests;

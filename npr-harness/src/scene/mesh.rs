//! A mesh prepared for both executors, shared by all objects that place it.

use super::cut::CutLines;
use crate::derived::Derived;
use crate::rays::RayCaster;
use glam::{DVec3, Vec3};
use npr_mesh::edges::{self, EdgeKind, EdgeOptions, Edges};
use npr_mesh::weld::{Weld, weld_within};
use npr_mesh::{AlphaMode, Model, coplanar};
use std::borrow::Cow;
use std::sync::OnceLock;

/// A model and the data derived from it. Its positions are relative to a local origin and scaled by a power of two
/// where products of lengths would otherwise leave the range of f32.
pub struct Mesh {
    model: Model,
    origin: DVec3,
    scale: f64,
    edges: Edges,
    cut: CutLines,
    closed: bool,
    bounds: Option<(Vec3, Vec3)>,
    rays: OnceLock<RayCaster>,
    boundary_sides: OnceLock<Vec<u8>>,
    derived: Derived,
}

impl Mesh {
    /// Finds a model's edges and prepares it. Faces without material get [`npr_mesh::Material::default`]. Of faces that
    /// overlap in one plane those are kept that are seen ([`npr_mesh::coplanar`]).
    ///
    /// `weld`: which vertices are one vertex for edges, before the positions are moved and scaled; a distance is in file
    /// units.
    pub fn new(mut model: Model, weld: Weld) -> Self {
        model.fill_face_material();
        super::opacity::settle(&mut model);
        let mut edges = find_edges(&model, weld);
        let bounds = drawn_bounds(&model, &edges);
        let (origin, scale) =
            bounds.map_or((DVec3::ZERO, 1.0), |(low, high)| normalization(low.as_dvec3(), high.as_dvec3()));
        if origin != DVec3::ZERO || scale != 1.0 {
            for position in &mut model.positions {
                let here = ((position.as_dvec3() - origin) * scale).as_vec3();
                // Vertices that no face uses may lie anywhere; they are never drawn.
                *position = if here.is_finite() { here } else { Vec3::ZERO };
            }
        }
        edges.tolerance = (f64::from(edges.tolerance) * scale) as f32;
        let mesh = match coplanar::separate(&model) {
            Some(separated) => Self::of_separated(separated.model, edges.tolerance),
            None => Self::with_cuts(model, edges),
        };
        Self { origin, scale, ..mesh }
    }

    /// Builds a mesh from a model that needs no normalization, and whose coplanar faces are separated. `tolerance`: the
    /// distance within which its vertices are one vertex for edges.
    pub(super) fn of_separated(model: Model, tolerance: f32) -> Self {
        let welded = weld_within(&model.positions, tolerance);
        let edges = find_edges_welded(&model, welded, tolerance);
        Self::with_cuts(model, edges)
    }

    fn with_cuts(mut model: Model, mut edges: Edges) -> Self {
        let cut = super::cut::cut_lines(&mut model);
        edges.representative.extend(edges.representative.len() as u32..model.positions.len() as u32);
        Self { cut, ..Self::with_edges(model, edges) }
    }

    /// Builds a mesh from a model that needs no normalization, and its edges.
    pub(super) fn with_edges(model: Model, edges: Edges) -> Self {
        let closed = !edges.edges.is_empty()
            && edges.overlaps.is_empty()
            && edges.edges.iter().all(|edge| edge.kind() == EdgeKind::TwoFace && !edge.wound_oppositely())
            && signed_volume(&model) > 0.0;
        Self {
            bounds: drawn_bounds(&model, &edges),
            model,
            origin: DVec3::ZERO,
            scale: 1.0,
            edges,
            cut: CutLines::default(),
            closed,
            rays: OnceLock::new(),
            boundary_sides: OnceLock::new(),
            derived: Derived::default(),
        }
    }

    /// The triangles, of which those that overlap in one plane are separated. A position in file units is the stored position divided by [`Mesh::scale`], plus
    /// [`Mesh::origin`].
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The offset that was subtracted from the positions, in file units: 0, or the centre of the model where that is
    /// far from 0, since f32 positions are most precise near 0.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The factor that was then applied to the positions: 1, or a power of two where half the diagonal of the bounding
    /// box is outside 2⁻²⁰..=2²⁰. Squares and products of lengths then stay within f32, on the GPU too.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The edges to draw, without those of redundant faces.
    pub fn edges(&self) -> &Edges {
        &self.edges
    }

    /// The lines along which alpha cuts faces. Their ends are vertices that no face has.
    pub fn cut_lines(&self) -> &CutLines {
        &self.cut
    }

    /// The edges to draw, with the cut lines.
    pub(crate) fn edges_and_cuts(&self) -> Cow<'_, Edges> {
        if self.cut.edges.is_empty() {
            return Cow::Borrowed(&self.edges);
        }
        // Further faces refer to edges by number, so the cut lines follow.
        let mut edges = self.edges.clone();
        edges.edges.extend_from_slice(&self.cut.edges);
        Cow::Owned(edges)
    }

    /// Whether every edge has two consistently wound faces, so that no back face is visible from outside.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// The bounding box of all lines and faces, if any has an area without those that have none; `None` without either.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.bounds
    }

    /// The ray caster, built on first use.
    pub fn rays(&self) -> &RayCaster {
        self.rays.get_or_init(|| RayCaster::new(&self.model.positions, &self.model.faces))
    }

    /// Per face: a bit mask of its boundary edges; bit i stands for the side from corner i to the next, all or a part of
    /// which is a boundary.
    pub fn boundary_sides(&self) -> &[u8] {
        self.boundary_sides.get_or_init(|| {
            let mut sides = vec![0; self.model.faces.len()];
            for edge in self.edges.edges.iter().filter(|edge| edge.kind() == EdgeKind::Boundary) {
                let face = edge.faces()[0] as usize;
                let corners = self.model.faces[face].map(|v| self.edges.representative[v as usize]);
                sides[face] |= 1 << edges::side_of(&self.model.positions, corners, edge.ends).0;
            }
            sides
        })
    }

    /// The positions of all vertices used by faces with an area or by lines, each once; of all faces if none has an area.
    pub fn corners(&self) -> impl Iterator<Item = Vec3> + Clone + '_ {
        let mut used = vec![false; self.model.positions.len()];
        for vertex in drawn_vertices(&self.model, &self.edges) {
            used[vertex as usize] = true;
        }
        self.model.positions.iter().zip(used).filter_map(|(&position, used)| used.then_some(position))
    }

    /// Whether any face is blended over what is behind it.
    pub(crate) fn has_blend(&self) -> bool {
        self.model.materials.iter().any(|m| m.alpha_mode == AlphaMode::Blend)
    }

    /// Whether a cut-out face may be at the place of another face.
    pub(crate) fn has_coincident_cut_outs(&self) -> bool {
        self.model.materials.iter().any(|m| matches!(m.alpha_mode, AlphaMode::Mask { .. }))
            && !(self.edges.further_faces.is_empty() && self.edges.overlaps.is_empty())
    }

    /// Data that the techniques derive from the mesh and cache.
    pub(crate) fn derived(&self) -> &Derived {
        &self.derived
    }
}

/// Finds the edges of a model with the options used for drawing.
pub(super) fn find_edges(model: &Model, weld: Weld) -> Edges {
    let Model { positions, faces, face_polygon, face_material, .. } = model;
    edges::find(positions, faces, face_polygon, face_material, &EdgeOptions { weld, ..EdgeOptions::default() })
}

/// As [`find_edges`], of a placed copy of a mesh whose vertices are welded. `tolerance`: see [`Edges::tolerance`].
pub(super) fn find_edges_welded(model: &Model, representative: Vec<u32>, tolerance: f32) -> Edges {
    let Model { positions, faces, face_polygon, face_material, .. } = model;
    let options = EdgeOptions::default();
    edges::find_welded(positions, faces, face_polygon, face_material, representative, tolerance, &options)
}

/// The vertices that are drawn: those of lines and of the faces with an area, possibly repeated. Of all faces, if none has
/// an area.
fn drawn_vertices<'a>(model: &'a Model, edges: &'a Edges) -> impl Iterator<Item = u32> + use<'a> {
    let is_skipped = |face: usize| edges.skipped.get(face) == Some(&true);
    let has_area = (0..model.faces.len()).any(|face| !is_skipped(face));
    let faces = model.faces.iter().enumerate().filter(move |&(face, _)| !has_area || !is_skipped(face));
    faces.flat_map(|(_, face)| *face).chain(model.lines.iter().flatten().copied())
}

/// The bounding box of what is drawn; `None` without faces and lines.
fn drawn_bounds(model: &Model, edges: &Edges) -> Option<(Vec3, Vec3)> {
    if edges.skipped.is_empty() {
        return model.bounds();
    }
    let corners = drawn_vertices(model, edges).map(|vertex| model.positions[vertex as usize]);
    corners.map(|corner| (corner, corner)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// Models whose half diagonal is outside 2^-OCTAVES..=2^OCTAVES are rescaled.
const OCTAVES: i32 = 20;

/// The origin to subtract from positions within a box and the factor to apply to them, so that f32 represents them
/// well. The origin is the centre of the box if that is far from 0 relative to the box's size. The factor is a power of
/// two, which rounds nothing, and differs from 1 only if the box is very large or very small.
///
/// Boxes near 0 keep their origin, because the subtraction could round two positions to one. Far from 0 it cannot,
/// since there the difference of two f32 is exact.
pub(super) fn normalization(low: DVec3, high: DVec3) -> (DVec3, f64) {
    let (middle, diagonal) = (low.midpoint(high), (high - low).length());
    if !(middle.is_finite() && diagonal.is_finite()) {
        return (DVec3::ZERO, 1.0);
    }
    let origin = if middle.length() < 4.0 * diagonal { DVec3::ZERO } else { middle.as_vec3().as_dvec3() };
    let octave = if diagonal > 0.0 { (diagonal / 2.0).log2().floor() as i32 } else { 0 };
    let scale = if octave.abs() > OCTAVES { 2f64.powi(-octave) } else { 1.0 };
    (origin, scale)
}

fn signed_volume(model: &Model) -> f64 {
    let corner = |v: u32| model.positions[v as usize].as_dvec3();
    model.faces.iter().map(|&[a, b, c]| corner(a).dot(corner(b).cross(corner(c)))).sum::<f64>() / 6.0
}

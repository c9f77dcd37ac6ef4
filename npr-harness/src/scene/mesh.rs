//! A mesh, ready for both executors, however often it is placed.

use crate::derived::Derived;
use crate::rays::RayCaster;
use glam::{DVec3, Vec3};
use npr_mesh::edges::{self, EdgeKind, EdgeOptions, Edges};
use npr_mesh::{AlphaMode, Model};
use std::sync::OnceLock;

/// A model with everything that is derived from it once. Its positions are relative to an origin of its own and
/// multiplied by a power of two where f32 could not hold their products otherwise.
pub struct Mesh {
    model: Model,
    origin: DVec3,
    scale: f64,
    edges: Edges,
    closed: bool,
    bounds: Option<(Vec3, Vec3)>,
    rays: OnceLock<RayCaster>,
    boundary_sides: OnceLock<Vec<u8>>,
    derived: Derived,
}

impl Mesh {
    /// Finds a model's edges and prepares it. Faces without material get [`npr_mesh::Material::default`].
    pub fn new(mut model: Model) -> Self {
        model.fill_face_material();
        let bounds = model.bounds();
        let (origin, scale) =
            bounds.map_or((DVec3::ZERO, 1.0), |(low, high)| normalization(low.as_dvec3(), high.as_dvec3()));
        if origin != DVec3::ZERO || scale != 1.0 {
            for position in &mut model.positions {
                let here = ((position.as_dvec3() - origin) * scale).as_vec3();
                // What no face uses may lie anywhere, and is not seen.
                *position = if here.is_finite() { here } else { Vec3::ZERO };
            }
        }
        let edges = find_edges(&model);
        Self { origin, scale, ..Self::with_edges(model, edges) }
    }

    /// A model that needs no other origin or size, and its edges.
    pub(super) fn with_edges(model: Model, edges: Edges) -> Self {
        let closed = !edges.edges.is_empty()
            && edges.skipped.is_empty()
            && edges.edges.iter().all(|edge| edge.kind() == EdgeKind::TwoFace && !edge.wound_oppositely())
            && signed_volume(&model) > 0.0;
        Self {
            bounds: model.bounds(),
            model,
            origin: DVec3::ZERO,
            scale: 1.0,
            edges,
            closed,
            rays: OnceLock::new(),
            boundary_sides: OnceLock::new(),
            derived: Derived::default(),
        }
    }

    /// The triangles; a position of the file is a position here divided by [`Mesh::scale`], plus [`Mesh::origin`].
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// What was subtracted from the positions: 0, or the model's middle where that is far from 0, since f32 positions
    /// keep their precision only near 0.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// What the positions were then multiplied by: 1, or a power of two where the half of the box's diagonal is not
    /// within 2⁻²⁰..=2²⁰. Squares and products of lengths then stay within f32, on a device, too.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The edges for drawing: redundant faces are left out.
    pub fn edges(&self) -> &Edges {
        &self.edges
    }

    /// Whether every edge has two faces that are wound alike, so that no back of a face can be seen from outside.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// The box around all faces; `None` without faces.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.bounds
    }

    /// The ray caster, built when it is first asked for.
    pub fn rays(&self) -> &RayCaster {
        self.rays.get_or_init(|| RayCaster::new(&self.model.positions, &self.model.faces))
    }

    /// Per face which of its sides no other face has: bit i for the side from corner i to the next.
    pub fn boundary_sides(&self) -> &[u8] {
        self.boundary_sides.get_or_init(|| {
            let mut sides = vec![0; self.model.faces.len()];
            for edge in self.edges.edges.iter().filter(|edge| edge.kind() == EdgeKind::Boundary) {
                let face = edge.faces()[0] as usize;
                let corners = self.model.faces[face].map(|v| self.edges.representative[v as usize]);
                for side in 0..3 {
                    if edge.ends.contains(&corners[side]) && edge.ends.contains(&corners[(side + 1) % 3]) {
                        sides[face] |= 1 << side;
                    }
                }
            }
            sides
        })
    }

    /// The positions of all vertices that are corners of faces, each once.
    pub fn corners(&self) -> impl Iterator<Item = Vec3> + Clone + '_ {
        let mut used = vec![false; self.model.positions.len()];
        for &vertex in self.model.faces.iter().flatten() {
            used[vertex as usize] = true;
        }
        self.model.positions.iter().zip(used).filter_map(|(&position, used)| used.then_some(position))
    }

    /// Whether any face is blended over what is behind it.
    pub(crate) fn has_blend(&self) -> bool {
        self.model.materials.iter().any(|m| m.alpha_mode == AlphaMode::Blend)
    }

    /// What techniques derive from the mesh.
    pub(crate) fn derived(&self) -> &Derived {
        &self.derived
    }
}

/// The edges of a model as they are drawn.
pub(super) fn find_edges(model: &Model) -> Edges {
    let Model { positions, faces, face_polygon, face_material, .. } = model;
    edges::find(positions, faces, face_polygon, face_material, &EdgeOptions::default())
}

/// Beyond 2 to this, and below 2 to minus this, positions are brought to another size.
const OCTAVES: i32 = 20;

/// What is subtracted from positions within a box, and what they are then multiplied by, so that f32 holds them well: the
/// box's middle if it is far from the origin, measured in the box's own size, and a power of two, which rounds nothing, if
/// the box is very large or very small.
///
/// Others stay where they are: a subtraction could round two positions to one. Far away it cannot, since there the
/// difference of two f32 is exact.
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

//! Tangent planes, and lines in them as complex numbers.
//!
//! A line at an angle t to the first axis of the plane is e^(2it). Both directions of a line have the same number, the
//! perpendicular line has the negative, and numbers can be averaged (Knöppel, Crane, Pinkall, Schröder: *Globally Optimal
//! Direction Fields*, SIGGRAPH 2013).

use glam::{Vec2, Vec3};

/// A plane with a right-handed orthonormal basis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tangent {
    pub u: Vec3,
    pub v: Vec3,
    pub normal: Vec3,
}

/// The value of 1 + cos below which two normals count as opposite, since the axis of the smallest rotation is then
/// undefined.
const OPPOSITE: f32 = 1e-3;

impl Tangent {
    /// The plane perpendicular to a unit normal.
    pub fn new(normal: Vec3) -> Self {
        let (u, v) = normal.any_orthonormal_pair();
        Self { u, v, normal }
    }

    /// The line along the projection of a vector into the plane, with the squared length of the projection as its weight.
    pub fn line(&self, direction: Vec3) -> Vec2 {
        let flat = Vec2::new(direction.dot(self.u), direction.dot(self.v));
        flat.rotate(flat)
    }

    /// A unit vector along a line, or `None` if its weight is zero.
    pub fn direction(&self, line: Vec2) -> Option<Vec3> {
        let line = line.try_normalize()?;
        // The half-angle formulas; that of the sine where the cosine would suffer from cancellation.
        let half = if line.x >= 0.0 {
            let cos = ((1.0 + line.x) * 0.5).sqrt();
            Vec2::new(cos, line.y * 0.5 / cos)
        } else {
            let sin = ((1.0 - line.x) * 0.5).sqrt();
            Vec2::new(line.y * 0.5 / sin, sin)
        };
        (self.u * half.x + self.v * half.y).try_normalize()
    }

    /// The factor by which a line of the plane `from` is multiplied when it is transported into this plane by the smallest
    /// rotation. `None` if the normals are nearly opposite.
    pub fn turn(&self, from: &Tangent) -> Option<Vec2> {
        if 1.0 + self.normal.dot(from.normal) < OPPOSITE {
            return None;
        }
        self.line(carry(from.u, from.normal, self.normal)).try_normalize()
    }
}

/// Transports a tangent vector of the plane with the unit normal `from` into the plane with the unit normal `to` by the
/// smallest rotation, or by projection if the normals are nearly opposite.
pub(super) fn carry(vector: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    let scale = 1.0 + from.dot(to);
    let out = to.dot(vector);
    if scale < OPPOSITE { vector - to * out } else { vector - (from + to) * (out / scale) }
}

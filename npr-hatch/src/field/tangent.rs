//! Tangent planes, and lines in them as complex numbers.
//!
//! A line at angle t to a plane's first axis is e^(2it): its two directions are one number, a line across it is the
//! negative, and numbers can be averaged. (Knöppel, Crane, Pinkall, Schröder: *Globally Optimal Direction Fields*,
//! SIGGRAPH 2013.)

use glam::{Vec2, Vec3};

/// An oriented plane with axes: right-handed, orthonormal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tangent {
    pub u: Vec3,
    pub v: Vec3,
    pub normal: Vec3,
}

/// Where two normals are this near to opposite (1 + cos), the rotation from one to the other has no axis.
const OPPOSITE: f32 = 1e-3;

impl Tangent {
    /// To a unit normal.
    pub fn new(normal: Vec3) -> Self {
        let (u, v) = normal.any_orthonormal_pair();
        Self { u, v, normal }
    }

    /// The line along a direction, its length squared as its weight; the part of it out of the plane does not count.
    pub fn line(&self, direction: Vec3) -> Vec2 {
        let flat = Vec2::new(direction.dot(self.u), direction.dot(self.v));
        flat.rotate(flat)
    }

    /// A unit direction along a line. `None` where it has no weight.
    pub fn direction(&self, line: Vec2) -> Option<Vec3> {
        let line = line.try_normalize()?;
        // Half the angle; from the sine where the cosine would cancel.
        let half = if line.x >= 0.0 {
            let cos = ((1.0 + line.x) * 0.5).sqrt();
            Vec2::new(cos, line.y * 0.5 / cos)
        } else {
            let sin = ((1.0 - line.x) * 0.5).sqrt();
            Vec2::new(line.y * 0.5 / sin, sin)
        };
        (self.u * half.x + self.v * half.y).try_normalize()
    }

    /// The number by which a line of `from` is multiplied when that plane is turned over into this one by the smallest
    /// rotation. `None` where they are nearly opposite.
    pub fn turn(&self, from: &Tangent) -> Option<Vec2> {
        if 1.0 + self.normal.dot(from.normal) < OPPOSITE {
            return None;
        }
        self.line(carry(from.u, from.normal, self.normal)).try_normalize()
    }
}

/// A tangent vector of the plane with unit normal `from`, turned into that of `to` by the smallest rotation; projected
/// where they are nearly opposite.
pub(super) fn carry(vector: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    let scale = 1.0 + from.dot(to);
    let out = to.dot(vector);
    if scale < OPPOSITE { vector - to * out } else { vector - (from + to) * (out / scale) }
}

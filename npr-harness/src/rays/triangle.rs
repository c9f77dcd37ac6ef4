//! The triangles in the hierarchy's leaves.

use glam::Vec3;

/// A triangle of the hierarchy.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Triangle {
    pub corners: [Vec3; 3],
    /// The index of the face; or, with the bit [`DUPLICATES`] set, the index of one of the ray caster's groups of
    /// duplicates.
    pub face: u32,
}

/// The bit that marks a group of duplicates; indices of faces are smaller.
pub const DUPLICATES: u32 = 1 << 31;

/// One of several faces with the same corners.
#[derive(Clone, Copy)]
pub struct Duplicate {
    pub face: u32,
    /// The index of the triangle's corner that is the face's first.
    pub first: usize,
}

/// The padding of boxes, where the scene's larger half size is 1. Errors come from rounding a ray's start and direction
/// to f32 (2⁻²⁴ of at most 2.7), rounding a box, three roundings of the slab test on distances of at most 5, and obvhs,
/// which replaces components of a direction under 1.2e-7 by 1.2e-7: together under 2e-6.
pub const PADDING: f64 = 4e-6;

//! What the hierarchy's leaves hold.

use glam::Vec3;

/// A triangle of the hierarchy.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Triangle {
    pub corners: [Vec3; 3],
    /// The face's number; or, with the bit [`DUPLICATES`], which of the ray caster's lists of duplicates.
    pub face: u32,
}

/// Faces have fewer numbers.
pub const DUPLICATES: u32 = 1 << 31;

/// One of several faces with the same corners.
#[derive(Clone, Copy)]
pub struct Duplicate {
    pub face: u32,
    /// Which of the triangle's corners is the face's first.
    pub first: usize,
}

/// The boxes' padding, where the scene's larger half size is 1. A ray's start and direction are rounded to f32
/// (2⁻²⁴ of at most 2.7), so is a box, its slab test rounds three times on distances of at most 5, and obvhs takes
/// a direction's component under 1.2e-7 for 1.2e-7: together under 2e-6.
pub const PADDING: f64 = 4e-6;

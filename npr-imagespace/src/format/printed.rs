//! The RGBA8 target of Card & Mitchell 2002, listing 8: the normal biased into rgb, depth in alpha.
//!
//! rgb = (n + 1) / 2 and a = (z − near) · scale, each rounded to the nearest of 256 steps. The inverse of rgb is 2 c
//! − 1 (`_bx2`). 0 is not representable: the nearest values are ±1/255.
//!
//! Errors in print:
//!
//! - The target is cleared to the normal +z ([`CLEAR_PRINTED`]). In the chapter's left-handed space +z points away
//!   from the default viewer, in a right-handed space towards them, so that surfaces facing the viewer have no normal
//!   edge against the background. No clear colour solves this for a filter of dot products: a vector whose dot product
//!   with every normal is low has a low one with itself. [`CLEAR`], all zeros, is a code of no normal, and the filters
//!   here treat it as different from every normal and equal to itself.
//! - Listing 8 writes the normal of the vertex buffer. It is the world's only where the model's matrix is the
//!   identity; [`ink_printed_encode`] takes it in any space.
//!
//! The text does not say what alpha is cleared to; both clear to the farthest depth their form allows.

use crate::format::ink_is_surface;
use glam::Vec3;

/// The clear value of the chapter: the normal +z at the farthest depth.
pub const CLEAR_PRINTED: [u8; 4] = [128, 128, 255, 255];
/// The clear value to use: no normal and no surface.
pub const CLEAR: [u8; 4] = [0; 4];

/// Normal of unit length and depth, 0..=1 from near to far, as four bytes. A depth that is NaN or infinite, or a
/// normal that is zero or not finite, gives [`CLEAR`]; other depths are clamped; 0 is a valid depth.
pub fn ink_printed_encode(normal: Vec3, depth: f32) -> [u8; 4] {
    let length2 = normal.length_squared();
    if !(ink_is_surface(depth.abs()) || depth == 0.0) || !ink_is_surface(length2) {
        return CLEAR;
    }
    let unorm = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    let biased = normal * 0.5 + 0.5;
    [unorm(biased.x), unorm(biased.y), unorm(biased.z), unorm(depth)]
}

/// The normal, of unit length only to the format's precision, and the depth 0..=1.
pub fn ink_printed_decode(texel: [u8; 4]) -> (Vec3, f32) {
    let [x, y, z, depth] = texel.map(|c| f32::from(c) / 255.0);
    (Vec3::new(x, y, z) * 2.0 - 1.0, depth)
}

//! G-buffer formats: what a geometry pass writes for the filters, encoded and decoded.
//!
//! - [`printed`]: the one RGBA8 target of Card & Mitchell 2002.
//! - [`depth`]: linear eye-space depth in six formats, and the smallest difference that each resolves.
//! - [`normal`]: normals in five formats.
//! - [`texel`]: normal, region and depth packed into 32 or 64 bits, which the fused filter reads in one load.
//!
//! # Background
//!
//! A depth that is NaN, infinite, zero or negative is background ([`ink_is_surface`]); so are pixels without a surface.
//! Background differs from every surface and not from itself. A direction that is zero or not finite is no normal, and
//! *no normal* differs from every normal and not from itself.

pub mod depth;
pub mod half;
pub mod normal;
pub mod printed;
pub mod texel;

/// WGSL of this module, of those in it, and of [`crate::region`]: no bindings, no entry points.
pub const FORMAT_WGSL: &str = concat!(
    include_str!("format.wgsl"),
    include_str!("format/printed.wgsl"),
    include_str!("format/depth.wgsl"),
    include_str!("format/normal.wgsl"),
    include_str!("format/texel.wgsl"),
    include_str!("region.wgsl"),
);

/// Whether an eye-space depth is one that a surface can have: positive, finite and a number.
///
/// Decided on the bits, since a shader compiler may assume that there is no NaN.
pub fn ink_is_surface(depth: f32) -> bool {
    depth.to_bits().wrapping_sub(1) < 0x7f7f_ffff
}

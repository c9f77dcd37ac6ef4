//! Edge filters: ink where neighbouring pixels differ.
//!
//! - [`normal`], [`depth`], [`region`]: the filters of 2002, each alone and on decoded values or bytes, as printed and
//!   corrected.
//! - [`fused`]: the three at once over the packed texels of [`crate::format::texel`], decided with integers. The
//!   default.
//! - [`inker`]: a filter of four taps that compares opposite pixels.
//! - [`separate`]: any of the three over separate textures of normals, depth and regions.
//! - [`mod@printed`]: the filters and the inker over the bytes of [`crate::format::printed`].
//!
//! All return *ink*: 1 on a line, 0 on paper. The listings output the complement, black lines on white paper.
//!
//! # Soft lines
//!
//! The slides of 2002 say that the filters can be made fuzzy, but not how. Here a comparison `x > t` becomes clamp((x
//! − t) / width + 1/2, 0, 1) ([`ink_ramp`]), and the four taps are summed and weighted
//! ([`crate::picture::Taps::weight`]) so that a straight border is a full line and its outer corners are paler. With a
//! softness of 0 lines are hard.

pub mod depth;
pub mod fused;
pub mod inker;
pub mod normal;
pub mod printed;
pub mod region;
pub mod separate;

/// WGSL of the modules in this one: no bindings, no entry points. Needs [`crate::format::FORMAT_WGSL`]
/// and [`crate::shadow::SHADOW_WGSL`].
pub const FILTER_WGSL: &str = concat!(
    include_str!("filter.wgsl"),
    include_str!("filter/normal.wgsl"),
    include_str!("filter/depth.wgsl"),
    include_str!("filter/region.wgsl"),
    include_str!("filter/fused.wgsl"),
    include_str!("filter/inker.wgsl"),
    include_str!("filter/separate.wgsl"),
    include_str!("filter/printed.wgsl"),
);

/// A ramp from 0 to 1 of the given width around `excess` = 0; where `width` is 0, the step `excess > 0`.
pub fn ink_ramp(excess: f64, width: f64) -> f64 {
    if width > 0.0 { (excess / width + 0.5).clamp(0.0, 1.0) } else { f64::from(u8::from(excess > 0.0)) }
}

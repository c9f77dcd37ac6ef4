//! Shadows in what the filters look at, so that their outlines come from the pass that finds the objects' own.
//!
//! # As printed
//!
//! Card & Mitchell 2002 (fig. 10) render the geometry once where the stencil says light and once where it says shadow,
//! there with the world-space normal negated ([`ink_shadow_normal`]); the slides of Mitchell, Brennan & Card negate the
//! depth as well ([`ink_shadow_depth`]). The filter for normals then sees a fold of up to 180° at a shadow's border, and
//! needs no change. What is wrong with it:
//!
//! - a surface in shadow with normal n is like a lit one with −n, and has no line against it;
//! - negated depth does not fit an unsigned format, which the target of the same chapter is;
//! - where a surface turns away from the light by itself, which a stencil calls shadow too, there is a line that nobody
//!   would draw: the terminator.
//!
//! # Here
//!
//! A state of two bits beside the region's number ([`ink_shadow_region`]): lit, in a cast shadow, or turned away from the
//! light. Only between the first two is there a border ([`ink_shadow_differs`]); what is turned away has one with neither,
//! so the terminator is no line, and a cast shadow that runs into it ends there without one.

use crate::format::texel::TexelLayout;
use glam::Vec3;

/// WGSL of this module: no bindings, no entry points.
pub const SHADOW_WGSL: &str = include_str!("shadow.wgsl");

/// What the light of a pixel's surface is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum ShadowState {
    /// The surface is turned away from the light by itself, or there is no light that casts.
    #[default]
    Turned = 0,
    /// The light reaches it.
    Lit = 1,
    /// It is turned towards the light, and something is between them.
    Cast = 2,
}

impl ShadowState {
    /// All, each at the index of its number.
    pub const ALL: [Self; 3] = [Self::Turned, Self::Lit, Self::Cast];
}

/// A region's number with a state of shadow in its two highest bits. 0, background, stays 0.
///
/// - `folded`: up to [`TexelLayout::shadowed_region_most`];
/// - `state`: a [`ShadowState`] as a number.
pub fn ink_shadow_region(folded: u32, state: u32, layout: TexelLayout) -> u32 {
    if folded == 0 { 0 } else { folded | (state * (layout.shadowed_region_most() + 1)) }
}

/// The state that [`ink_shadow_region`] put into a number.
pub fn ink_shadow_state(region: u32, layout: TexelLayout) -> ShadowState {
    ShadowState::ALL[(region / (layout.shadowed_region_most() + 1)).min(2) as usize]
}

/// Whether of two states, as they lie in `bits` of a region, one is lit and the other in a cast shadow: together they have
/// all bits, and no other pair does.
pub fn ink_shadow_differs(a: u32, b: u32, bits: u32) -> bool {
    a | b == bits
}

/// As printed: the normal, negated in shadow.
pub fn ink_shadow_normal(normal: Vec3, in_shadow: bool) -> Vec3 {
    if in_shadow { -normal } else { normal }
}

/// As printed on the slides: the depth, negated in shadow. Only for formats with a sign.
pub fn ink_shadow_depth(depth: f32, in_shadow: bool) -> f32 {
    if in_shadow { -depth } else { depth }
}

//! Shadow states in the G-buffer, so that the filters that find object outlines find shadow outlines too.
//!
//! # As printed
//!
//! Card & Mitchell 2002 (fig. 10) render the geometry once where the stencil says light and once where it says shadow,
//! there with the world-space normal negated ([`ink_shadow_normal`]); the slides of Mitchell, Brennan & Card negate the
//! depth as well ([`ink_shadow_depth`]). The normal filter then finds an angle of up to 180° at a shadow's border
//! without any change. Its faults:
//!
//! - a surface in shadow with normal n has the stored normal of a lit one with −n, and there is no line between them;
//! - negated depth needs a signed format, and the target of the same chapter is unsigned;
//! - surfaces that face away from the light are shadow in the stencil as well, so that the terminator, the border
//!   between light-facing and back-facing parts of a smooth surface, becomes a line.
//!
//! # Here
//!
//! Two bits beside the region number hold a state ([`ink_shadow_region`]): lit, in a cast shadow, or facing away from
//! the light. Only lit beside cast shadow is a border ([`ink_shadow_differs`]). Back-facing surfaces have no border
//! with either, so the terminator is no line, and the outline of a cast shadow ends at the terminator. Background has no
//! state, which is that of back-facing surfaces, unless it catches shadows ([`ink_shadow_background`]).

use crate::format::texel::TexelLayout;
use glam::Vec3;

/// WGSL of this module: no bindings, no entry points.
pub const SHADOW_WGSL: &str = include_str!("shadow.wgsl");

/// How the light reaches the surface in a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum ShadowState {
    /// The surface faces away from the light, or no light casts shadows.
    #[default]
    BackFacing = 0,
    /// The light reaches the surface.
    Lit = 1,
    /// The surface faces the light, and something between them casts a shadow on it.
    Cast = 2,
}

impl ShadowState {
    /// All states, each at the index of its number.
    pub const ALL: [Self; 3] = [ShadowState::BackFacing, ShadowState::Lit, ShadowState::Cast];
}

/// A region number with a shadow state in its two highest bits. 0, background, stays 0.
///
/// - `folded`: the region number, at most [`TexelLayout::shadowed_region_max`];
/// - `state`: a [`ShadowState`] as a number.
pub fn ink_shadow_region(folded: u32, state: u32, layout: TexelLayout) -> u32 {
    if folded == 0 { 0 } else { folded | (state * (layout.shadowed_region_max() + 1)) }
}

/// The number of background that catches shadows, such as a ground that is not drawn itself: region 0 with a shadow state.
/// It is background for all tests but that of shadows.
pub fn ink_shadow_background(state: u32, layout: TexelLayout) -> u32 {
    state * (layout.shadowed_region_max() + 1)
}

/// The state in a number made by [`ink_shadow_region`].
pub fn ink_shadow_state(region: u32, layout: TexelLayout) -> ShadowState {
    ShadowState::ALL[(region / (layout.shadowed_region_max() + 1)).min(2) as usize]
}

/// Whether one of two states, each masked by `bits` of a region number, is lit and the other in a cast shadow. The
/// bitwise or of these two has all bits set, and that of no other pair does.
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

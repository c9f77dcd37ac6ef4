//! Shadows that a style's first light casts: what a style says of them, and what a scene then needs.
//!
//! A point of a surface is *turned* away from the light, where its face is; *lit*; or in a *cast* shadow, turned towards the
//! light with something between. Only between the last two is there a border: [`npr_imagespace::shadow`]. For lines what
//! is nearly turned away counts as such: N·L of the shading normal is not above the style's terminator. So no line is
//! drawn where a surface turns away from the light by itself, nor around the shadows that the small faces of a coarse
//! model cast on each other there.
//!
//! In a cast shadow, where N·L is above 0, a surface is lit as if its normal were negated, which is what Card & Mitchell 2002 do to it for lines:
//! N·L becomes −|N·L|, and no highlight is seen. Bands get their darkest tone, Gooch's tones turn cool, strokes are as
//! dense as where no light falls, and at the terminator nothing jumps.
//!
//! What casts: every face that is not blended, whichever way it is wound, and whether or not a plane cuts it off for the
//! viewer. What is cut out by alpha casts the shadow of its whole faces. On blended surfaces no shadow falls.

pub(crate) mod cpu;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
pub mod plan;
pub(crate) mod schema;
pub mod style;

pub use plan::{ShadowPlan, ShadowTechnique, VolumeMethod};
pub use style::{ShadowLines, ShadowMethod, ShadowStyle};

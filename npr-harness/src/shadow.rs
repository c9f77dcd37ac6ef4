//! Shadows that the first light of a style casts: their settings in a style and their part of a plan.
//!
//! A surface point is in one of three states. It is *back-facing* if its face is turned away from the light; else it is
//! *lit*, or in a *cast* shadow if something lies between it and the light. Only the border between the last two is a
//! shadow border: [`npr_imagespace::shadow`]. For lines, points that are nearly back-facing count as back-facing: those
//! where N·L of the shading normal is not above the style's terminator. So no line is drawn where a surface turns away
//! from the light, nor around the shadows that small faces of a coarse model cast on each other there.
//!
//! In a cast shadow, where N·L is above 0, a surface is lit as if its normal were negated, which is what Card &
//! Mitchell 2002 do for lines: N·L becomes −|N·L|, and there is no highlight. Bands get their darkest tone, Gooch's
//! tones become cool, and strokes are as dense as where no light falls. Shading is continuous at the terminator.
//!
//! All unblended faces cast shadows, regardless of their winding and of the clipping plane. Alpha-tested faces cast the
//! shadow of the whole face. Blended surfaces receive no shadows.

pub(crate) mod cpu;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
pub mod plan;
pub(crate) mod schema;
pub mod style;
mod variants;

pub use plan::{ShadowPlan, ShadowTechnique, VolumeMethod};
pub use style::{ShadowLines, ShadowMethod, ShadowStyle};
pub(crate) use variants::VARIANTS;

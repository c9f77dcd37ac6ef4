//! The settings of shadows in a style.

use crate::error::HarnessError;
use npr_imagespace::composite::Composite;
use npr_imagespace::morphology::disc::Disc;

/// How the GPU computes shadows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ShadowMethod {
    /// Shadow volumes in a stencil buffer: exact.
    #[default]
    Volumes,
    /// A shadow map. Its cost does not depend on the number of edges; its borders are as coarse as its texels.
    Map {
        /// The side in texels, 16..=16384.
        side: u32,
    },
}

/// The settings of shadows in a style.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowStyle {
    /// How the GPU computes shadows; the CPU casts rays.
    pub method: ShadowMethod,
    /// The N·L at or below which shadows have no lines, 0..1.
    pub terminator: f32,
}

impl Default for ShadowStyle {
    fn default() -> Self {
        Self { method: ShadowMethod::Volumes, terminator: 0.15 }
    }
}

impl ShadowStyle {
    pub(crate) fn validate(&self) -> Result<(), HarnessError> {
        let range = |what, value, range| Err(HarnessError::Range { what, value, range });
        if !(0.0..1.0).contains(&self.terminator) {
            return range("a shadow's terminator", f64::from(self.terminator), "0..1");
        }
        match self.method {
            ShadowMethod::Map { side } if !(16..=16_384).contains(&side) => {
                range("the side of a shadow map", f64::from(side), "16..=16384 texels")
            }
            _ => Ok(()),
        }
    }
}

/// How the borders of shadows are drawn, by styles whose lines are found in the image.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ShadowLines {
    /// Shadows have no lines.
    #[default]
    None,
    /// As in Card & Mitchell 2002: normals are negated in shadow, also on surfaces that face away from the light.
    Negated,
    /// With the style of the objects' lines, by the same pass.
    Lines,
    /// By a separate pass, below the objects' lines.
    Separate {
        /// How the lines are composited over the picture.
        composite: Composite,
        /// The disc by which the lines are dilated, if any.
        dilation: Option<Disc>,
    },
}

impl ShadowLines {
    /// Whether texels hold a shadow state.
    pub(crate) fn has_states(self) -> bool {
        matches!(self, Self::Lines | Self::Separate { .. })
    }
}

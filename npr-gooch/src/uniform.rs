//! The uniform buffer layout of [`Gooch`].

use bytemuck::{Pod, Zeroable};

use crate::{Gooch, GoochError};

/// `GoochModel` of the WGSL, 64 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GoochUniform {
    /// k_blue, and the share of the object's colour in the cool tone: α, or β for [`crate::Tones::SwappedShares`].
    pub blue: [f32; 4],
    /// k_yellow, and the share of the object's colour in the warm tone.
    pub yellow: [f32; 4],
    /// The colour and the strength of the highlight; strength 0 without a highlight.
    pub highlight: [f32; 4],
    /// The exponent of the highlight; 1 without a highlight.
    pub exponent: f32,
    /// Unused, 0.
    pub padding: [u32; 3],
}

impl GoochUniform {
    /// Checks and packs `model`.
    pub fn new(model: &Gooch) -> Result<Self, GoochError> {
        model.validate()?;
        let [cool, warm] = model.shares();
        let mut uniform = Self {
            blue: model.blue.extend(cool).to_array(),
            yellow: model.yellow.extend(warm).to_array(),
            highlight: [0.0; 4],
            exponent: 1.0,
            padding: [0; 3],
        };
        if let Some(highlight) = model.highlight {
            uniform.highlight = highlight.color.extend(highlight.strength).to_array();
            uniform.exponent = highlight.exponent;
        }
        Ok(uniform)
    }
}

//! The bands as the shader reads them.

use bytemuck::{Pod, Zeroable};

use crate::{Bands, ToonError};

/// How many bands a [`ToonUniform`] holds.
pub const MAX_BANDS: usize = 8;

/// Finite, so that the shader meets no infinity; beyond the reach of any border's ramp.
const UNREACHED: f32 = 1e4;

/// `ToonBands` of the WGSL: what to write into the uniform buffer, 160 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ToonUniform {
    /// From dark to light: the tone, and N·L where the next band begins. In the last band in use this is 10,000, which
    /// no pixel reaches; those that are not in use repeat it.
    pub bands: [[f32; 4]; MAX_BANDS],
    /// The highlight's colour, and its threshold on N·H.
    pub highlight: [f32; 4],
    /// How many bands there are, 1..=[`MAX_BANDS`].
    pub count: u32,
    /// The highlight's opacity; 0 where there is none.
    pub highlight_strength: f32,
    /// 1: no highlight at N·L < 0.
    pub highlight_lit_only: u32,
    /// 1: borders are antialiased.
    pub antialias: u32,
}

impl ToonUniform {
    /// Checks and packs `bands`.
    pub fn new(bands: &Bands) -> Result<Self, ToonError> {
        bands.validate()?;
        if bands.tones.len() > MAX_BANDS {
            return Err(ToonError::TooManyTones { tones: bands.tones.len(), max: MAX_BANDS });
        }
        let last = bands.tones[bands.tones.len() - 1];
        let mut uniform = Self {
            bands: [last.extend(UNREACHED).to_array(); MAX_BANDS],
            count: bands.tones.len() as u32,
            antialias: u32::from(bands.antialias),
            ..Self::zeroed()
        };
        for (band, tone) in uniform.bands.iter_mut().zip(&bands.tones) {
            band[..3].copy_from_slice(&tone.to_array());
        }
        for (band, &threshold) in uniform.bands.iter_mut().zip(&bands.thresholds) {
            band[3] = threshold;
        }
        if let Some(highlight) = bands.highlight {
            uniform.highlight = highlight.color.extend(highlight.threshold).to_array();
            uniform.highlight_strength = highlight.strength;
            uniform.highlight_lit_only = u32::from(highlight.lit_only);
        }
        Ok(uniform)
    }
}

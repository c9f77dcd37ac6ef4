//! The uniform buffer layout of [`Bands`].

use bytemuck::{Pod, Zeroable};

use crate::{Bands, ToonError};

/// The maximum number of bands of a [`ToonUniform`].
pub const MAX_BANDS: usize = 8;

/// The threshold after the last band: finite, and above any N·L plus half the maximum border width.
const UNUSED_THRESHOLD: f32 = 1e4;

/// `ToonBands` of the WGSL, 176 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ToonUniform {
    /// The bands from dark to light: the tone, and the N·L at which the next band begins, which is 10,000 in the last band.
    /// Unused entries repeat the last band.
    pub bands: [[f32; 4]; MAX_BANDS],
    /// The colour of the highlight and its threshold on N·H.
    pub highlight: [f32; 4],
    /// The number of bands, 1..=[`MAX_BANDS`].
    pub count: u32,
    /// The opacity of the highlight; 0 without a highlight.
    pub highlight_strength: f32,
    /// 1 if there is no highlight at N·L < 0, else 0.
    pub highlight_lit_only: u32,
    /// 1 if borders are antialiased, else 0.
    pub antialias: u32,
    /// 1 if tones replace the surface's colour, 0 if they are factors on it.
    pub absolute: u32,
    /// Unused, 0.
    pub padding: [u32; 3],
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
            bands: [last.extend(UNUSED_THRESHOLD).to_array(); MAX_BANDS],
            count: bands.tones.len() as u32,
            antialias: u32::from(bands.antialias),
            absolute: u32::from(bands.absolute),
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

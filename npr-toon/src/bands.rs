//! The style of banded shading: thresholds, tones and a highlight.

use glam::Vec3;

use crate::ToonError;
use crate::error::is_color;

/// Bands of diffuse light with an optional highlight.
///
/// Values that do not come from a constructor should be checked with [`Bands::validate`]. The functions of this crate do
/// not panic on invalid values, but their results are then unspecified.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(default, rename_all = "kebab-case", deny_unknown_fields))]
pub struct Bands {
    /// The values of N·L at which the next brighter band begins: strictly ascending, one fewer than tones. A value equal to
    /// a threshold belongs to the brighter band.
    pub thresholds: Vec<f32>,
    /// The tones of the bands from dark to light: display-referred RGB factors on the surface's colour, or, with
    /// [`Bands::absolute`], the colours themselves. At least one.
    pub tones: Vec<Vec3>,
    /// The highlight, which covers the bands where N·H is large.
    pub highlight: Option<Highlight>,
    /// Whether borders are antialiased. If not, [`crate::toon_shade`] ignores its width arguments.
    pub antialias: bool,
    /// Whether the tones are the colours of the picture, whatever colour the surface has, as in Card & Mitchell 2002,
    /// listing 3, which reads no colour of a surface.
    pub absolute: bool,
}

/// A highlight of one flat colour.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case", deny_unknown_fields))]
pub struct Highlight {
    /// The least N·H that belongs to the highlight.
    pub threshold: f32,
    /// Display-referred RGB. It replaces the band's colour and is not multiplied by the surface's colour.
    pub color: Vec3,
    /// The opacity of the highlight, 0..=1.
    pub strength: f32,
    /// Whether the highlight is limited to N·L >= 0. At grazing angles N·H can be large on surfaces that face away from
    /// the light; Card & Mitchell do not exclude that case.
    pub lit_only: bool,
}

impl Bands {
    /// Two tones with an antialiased border at N·L = 0 (Lake et al. 2000, section 3).
    pub fn hard_shading() -> Self {
        Self {
            thresholds: vec![0.0],
            tones: vec![Vec3::splat(0.5), Vec3::ONE],
            highlight: None,
            antialias: true,
            absolute: false,
        }
    }

    /// Three diffuse bands with the constants and the aliased borders of Card & Mitchell 2002, listing 3. As factors, which
    /// give the listing's colours on white; on every surface with [`Bands::absolute`].
    pub fn three_diffuse_bands() -> Self {
        Self {
            thresholds: vec![0.1, 0.8],
            tones: vec![Vec3::splat(0.2), Vec3::splat(0.6), Vec3::new(0.9, 0.9, 1.0)],
            highlight: None,
            antialias: false,
            absolute: false,
        }
    }

    /// An ambient and a diffuse tone separated by a threshold on N·L, and a specular colour above a threshold on N·H, as the
    /// text of Card & Mitchell 2002 describes cartoon shading.
    ///
    /// The text states no numbers, so thresholds and tones are those of listing 3, as factors like those of
    /// [`Bands::three_diffuse_bands`].
    pub fn diffuse_and_specular() -> Self {
        Self {
            thresholds: vec![0.1],
            tones: vec![Vec3::splat(0.2), Vec3::splat(0.6)],
            highlight: Some(Highlight {
                threshold: 0.8,
                color: Vec3::new(0.9, 0.9, 1.0),
                strength: 1.0,
                lit_only: false,
            }),
            antialias: false,
            absolute: false,
        }
    }

    /// Checks all fields and returns the first violation.
    pub fn validate(&self) -> Result<(), ToonError> {
        if self.tones.is_empty() {
            return Err(ToonError::NoTones);
        }
        if self.thresholds.len() + 1 != self.tones.len() {
            return Err(ToonError::Counts { tones: self.tones.len(), thresholds: self.thresholds.len() });
        }
        for (index, &value) in self.thresholds.iter().enumerate() {
            if !value.is_finite() {
                return Err(ToonError::ThresholdNotFinite { index, value });
            }
            if index > 0 && value <= self.thresholds[index - 1] {
                return Err(ToonError::ThresholdOrder { index, value, before: self.thresholds[index - 1] });
            }
        }
        for (index, &value) in self.tones.iter().enumerate() {
            if !is_color(value) {
                return Err(ToonError::Tone { index, value });
            }
        }
        if let Some(Highlight { threshold, color, strength, .. }) = self.highlight {
            if !threshold.is_finite() {
                return Err(ToonError::HighlightThreshold { value: threshold });
            }
            if !is_color(color) {
                return Err(ToonError::HighlightColor { value: color });
            }
            if !(0.0..=1.0).contains(&strength) {
                return Err(ToonError::HighlightStrength { value: strength });
            }
        }
        Ok(())
    }
}

impl Default for Bands {
    /// Three antialiased bands with a bluish shadow tone, and a small highlight on the lit side.
    fn default() -> Self {
        Self {
            thresholds: vec![0.05, 0.55],
            tones: vec![Vec3::new(0.48, 0.47, 0.60), Vec3::new(0.80, 0.79, 0.84), Vec3::ONE],
            highlight: Some(Highlight {
                threshold: 0.98,
                color: Vec3::new(1.0, 0.99, 0.95),
                strength: 0.85,
                lit_only: true,
            }),
            antialias: true,
            absolute: false,
        }
    }
}

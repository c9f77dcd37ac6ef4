//! What a surface's light is cut into.

use glam::Vec3;

use crate::ToonError;
use crate::error::is_color;

/// Bands of diffuse light, and perhaps a highlight.
///
/// Check a value that was not made by a constructor with [`Bands::validate`]. The functions of this crate do
/// not panic on bad ones, but what they return then means nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Bands {
    /// N·L where one band ends and the next, brighter one begins: strictly ascending, one fewer than tones. A value
    /// equal to the threshold belongs to the band above it.
    pub thresholds: Vec<f32>,
    /// The bands from dark to light, display-referred RGB, factors on the surface's colour. At least one.
    pub tones: Vec<Vec3>,
    /// What lies over the bands where N·H is large.
    pub highlight: Option<Highlight>,
    /// Whether borders are antialiased; without it [`crate::toon_shade`] takes no notice of its widths.
    pub antialias: bool,
}

/// A spot of one colour that replaces the band's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Highlight {
    /// The least N·H that belongs to the highlight.
    pub threshold: f32,
    /// Display-referred RGB; it replaces the band's colour, and is not multiplied with the surface's.
    pub color: Vec3,
    /// How opaque the highlight is: 0 leaves the band, 1 replaces it.
    pub strength: f32,
    /// Whether there is a highlight only at N·L >= 0. At grazing angles N·H can be large on a surface that is
    /// turned away from the light; the chapter does not exclude it.
    pub lit_only: bool,
}

impl Bands {
    /// Two colours with a hard transition where N·L crosses zero (Lake 2000), antialiased.
    pub fn hard_shading() -> Self {
        Self { thresholds: vec![0.0], tones: vec![Vec3::splat(0.5), Vec3::ONE], highlight: None, antialias: true }
    }

    /// The three diffuse bands of Card & Mitchell's listing 3, with the constants and the aliased borders printed.
    pub fn listing_3() -> Self {
        Self {
            thresholds: vec![0.1, 0.8],
            tones: vec![Vec3::splat(0.2), Vec3::splat(0.6), Vec3::new(0.9, 0.9, 1.0)],
            highlight: None,
            antialias: false,
        }
    }

    /// Ambient, diffuse and specular as Card & Mitchell's text has them: one threshold on N·L, one on N·H, and the
    /// specular colour replaces the other two wherever N·H is above its own.
    ///
    /// The text gives no numbers: the thresholds and tones are those of listing 3.
    pub fn chapter_text() -> Self {
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
        }
    }

    /// Which rule is broken, if one is; the first found.
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
    /// Three bands with a cool shadow, and a small highlight on the lit side; antialiased.
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
        }
    }
}

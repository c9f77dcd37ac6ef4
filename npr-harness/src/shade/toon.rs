//! Bands of light, with a highlight where N·H is above a threshold.

use super::model::{LitPoint, ShadeModel, ShadeOnDevice, ShadeView, Shading, flag};
use crate::error::HarnessError;
use crate::schema::{Color, one, white, yes};
use glam::{DVec2, DVec3};
use npr_toon::source::{Light, toon_to_light};
use npr_toon::{Bands, Highlight, ToonUniform, toon_half, toon_n_dot_h, toon_n_dot_h_interpolated, toon_shade};
use serde::{Deserialize, Serialize};

/// The table `[shade.toon]`.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct ToonTable {
    #[serde(default = "yes")]
    antialias: bool,
    #[serde(default)]
    absolute: bool,
    thresholds: Vec<f32>,
    tones: Vec<Color>,
    #[serde(skip_serializing_if = "Option::is_none")]
    highlight: Option<HighlightTable>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct HighlightTable {
    threshold: f32,
    #[serde(default = "white")]
    color: Color,
    #[serde(default = "one")]
    strength: f32,
    #[serde(default)]
    lit_only: bool,
}

impl ToonTable {
    pub(super) fn new(bands: &Bands) -> Self {
        Self {
            antialias: bands.antialias,
            absolute: bands.absolute,
            thresholds: bands.thresholds.clone(),
            tones: bands.tones.iter().copied().map(Color).collect(),
            highlight: bands.highlight.map(|highlight| HighlightTable {
                threshold: highlight.threshold,
                color: Color(highlight.color),
                strength: highlight.strength,
                lit_only: highlight.lit_only,
            }),
        }
    }

    pub(super) fn bands(self) -> Bands {
        Bands {
            thresholds: self.thresholds,
            tones: self.tones.into_iter().map(|color| color.0).collect(),
            highlight: self.highlight.map(|highlight| Highlight {
                threshold: highlight.threshold,
                color: highlight.color.0,
                strength: highlight.strength,
                lit_only: highlight.lit_only,
            }),
            antialias: self.antialias,
            absolute: self.absolute,
        }
    }
}

/// Whether the highlight is visible; N·H is only computed if it is.
fn has_highlight(bands: &Bands) -> bool {
    bands.highlight.is_some_and(|highlight| highlight.strength > 0.0)
}

impl ShadeModel for Bands {
    fn validate(&self) -> Result<(), HarnessError> {
        ToonUniform::new(self)?;
        Ok(())
    }

    fn second(&self, point: &LitPoint, to_light: DVec3, _lights: &[Light], _view: &ShadeView) -> f64 {
        if has_highlight(self) { toon_n_dot_h(point.normal, to_light, point.to_eye) } else { 0.0 }
    }

    fn second_vector(&self, point: &LitPoint, lights: &[Light], _view: &ShadeView) -> DVec3 {
        lights.first().map_or(DVec3::ZERO, |light| toon_half(toon_to_light(light.place, point.at), point.to_eye))
    }

    fn second_interpolated(
        &self,
        normal: DVec3,
        _to_light: DVec3,
        second: DVec3,
        _lights: &[Light],
        _view: &ShadeView,
    ) -> f64 {
        if has_highlight(self) { toon_n_dot_h_interpolated(normal, second) } else { 0.0 }
    }

    fn shows_surface_color(&self) -> bool {
        !self.absolute
    }

    fn color(&self, shading: &Shading<'_>) -> DVec3 {
        let width = if self.antialias { (shading.widths)(&|light| light) } else { DVec2::ZERO };
        let light = shading.light;
        // Absolute tones ignore the colours of surface and light.
        toon_shade(self, shading.base * shading.light_color, light.x, width.x, light.y, width.y)
    }

    fn on_device(&self, _view: &ShadeView) -> Result<ShadeOnDevice, HarnessError> {
        Ok(ShadeOnDevice {
            // The number of bands is a constant so that loops over them are unrolled.
            constants: vec![
                (npr_toon::TOON_BANDS_OVERRIDE, self.tones.len() as f64),
                ("shade_highlight", flag(has_highlight(self))),
                ("shade_absolute", flag(self.absolute)),
            ],
            uniform: bytemuck::bytes_of(&ToonUniform::new(self)?).to_vec(),
            ..ShadeOnDevice::new(&[("npr-toon", npr_toon::WGSL), ("toon.wgsl", include_str!("toon.wgsl"))])
        })
    }
}

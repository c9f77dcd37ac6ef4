//! Gooch shading, from cool to warm.

use super::model::{LitPoint, ShadeModel, ShadeOnDevice, ShadeView, Shading};
use crate::error::HarnessError;
use crate::schema::{Color, one, white};
use glam::DVec3;
use npr_gooch::{Gooch, GoochUniform, Highlight, Tones, gooch_highlight, gooch_over, gooch_r_dot_e, gooch_tone};
use npr_toon::source::Light;
use serde::{Deserialize, Serialize};

/// The table `[shade.gooch]`.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(crate) struct GoochTable {
    blue: Color,
    yellow: Color,
    alpha: f32,
    beta: f32,
    tones: TonesName,
    #[serde(skip_serializing_if = "Option::is_none")]
    highlight: Option<HighlightTable>,
}

impl Default for GoochTable {
    fn default() -> Self {
        // As for bands, there is no highlight unless the file has a table for it.
        Self::new(&Gooch { highlight: None, ..Gooch::default() })
    }
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum TonesName {
    Equation,
    SwappedShares,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct HighlightTable {
    #[serde(default = "white")]
    color: Color,
    #[serde(default = "one")]
    strength: f32,
    exponent: f32,
}

impl GoochTable {
    pub(super) fn new(gooch: &Gooch) -> Self {
        Self {
            blue: Color(gooch.blue),
            yellow: Color(gooch.yellow),
            alpha: gooch.alpha,
            beta: gooch.beta,
            tones: match gooch.tones {
                Tones::Equation => TonesName::Equation,
                Tones::SwappedShares => TonesName::SwappedShares,
            },
            highlight: gooch.highlight.map(|highlight| HighlightTable {
                color: Color(highlight.color),
                strength: highlight.strength,
                exponent: highlight.exponent,
            }),
        }
    }

    pub(super) fn gooch(self) -> Gooch {
        Gooch {
            blue: self.blue.0,
            yellow: self.yellow.0,
            alpha: self.alpha,
            beta: self.beta,
            tones: match self.tones {
                TonesName::Equation => Tones::Equation,
                TonesName::SwappedShares => Tones::SwappedShares,
            },
            highlight: self.highlight.map(|highlight| Highlight {
                color: highlight.color.0,
                strength: highlight.strength,
                exponent: highlight.exponent,
            }),
        }
    }
}

impl ShadeModel for Gooch {
    fn validate(&self) -> Result<(), HarnessError> {
        GoochUniform::new(self)?;
        Ok(())
    }

    /// Gooch's tones depend only on the direction of the light, not on its brightness.
    fn diffuse(&self, n_dot_l: f64, _brightness: f64) -> f64 {
        n_dot_l
    }

    fn second(&self, point: &LitPoint, to_light: DVec3, _lights: &[Light], _view: &ShadeView) -> f64 {
        gooch_r_dot_e(point.normal, to_light, point.to_eye)
    }

    fn second_vector(&self, point: &LitPoint, _lights: &[Light], _view: &ShadeView) -> DVec3 {
        point.to_eye.normalize_or_zero()
    }

    fn second_interpolated(
        &self,
        normal: DVec3,
        to_light: DVec3,
        second: DVec3,
        _lights: &[Light],
        _view: &ShadeView,
    ) -> f64 {
        2.0 * npr_toon::toon_n_dot_l_interpolated(normal, to_light) * normal.dot(second) - to_light.dot(second)
    }

    fn color(&self, shading: &Shading<'_>) -> DVec3 {
        let light = shading.light;
        gooch_over(self, gooch_tone(self, shading.base, light.x), gooch_highlight(self, light.x, light.y))
    }

    fn on_device(&self, _view: &ShadeView) -> Result<ShadeOnDevice, HarnessError> {
        Ok(ShadeOnDevice {
            uniform: bytemuck::bytes_of(&GoochUniform::new(self)?).to_vec(),
            ..ShadeOnDevice::new(&[
                ("npr-toon", npr_toon::WGSL),
                ("npr-gooch", npr_gooch::WGSL),
                ("gooch.wgsl", include_str!("gooch.wgsl")),
            ])
        })
    }
}

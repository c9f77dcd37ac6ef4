//! Ambient and diffuse light.

use super::model::{ShadeModel, ShadeOnDevice, ShadeView, Shading};
use crate::error::HarnessError;
use crate::schema::within;
use glam::DVec3;
use serde::{Deserialize, Serialize};

pub(super) const ONE_LIGHT_WGSL: &str = include_str!("one_light.wgsl");

/// Ambient and diffuse light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lambert {
    /// The fraction of the surface's colour where N·L is not above 0, 0..=1.
    pub ambient: f32,
}

/// The table `[shade.lambert]`.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct LambertTable {
    ambient: f32,
}

impl LambertTable {
    pub(super) fn new(lambert: Lambert) -> Self {
        Self { ambient: lambert.ambient }
    }

    pub(super) fn lambert(self) -> Lambert {
        Lambert { ambient: self.ambient }
    }
}

impl ShadeModel for Lambert {
    fn validate(&self) -> Result<(), HarnessError> {
        within("ambient light", self.ambient, 0.0, 1.0, "0..=1")
    }

    fn color(&self, shading: &Shading<'_>) -> DVec3 {
        let ambient = f64::from(self.ambient);
        shading.base * shading.light_color * (ambient + (1.0 - ambient) * shading.light.x.max(0.0))
    }

    fn on_device(&self, _view: &ShadeView) -> Result<ShadeOnDevice, HarnessError> {
        Ok(ShadeOnDevice {
            uniform: bytemuck::bytes_of(&[self.ambient, 0.0, 0.0, 0.0]).to_vec(),
            ..ShadeOnDevice::new(&[
                ("npr-toon", npr_toon::WGSL),
                ("one_light.wgsl", ONE_LIGHT_WGSL),
                ("lambert.wgsl", include_str!("lambert.wgsl")),
            ])
        })
    }
}

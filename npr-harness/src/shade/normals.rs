//! World-space normals as colours, negated in shadow.

use super::model::{ShadeModel, ShadeOnDevice, ShadeView, Shading};
use crate::error::HarnessError;
use glam::DVec3;

pub(super) struct Normals;

impl ShadeModel for Normals {
    fn validate(&self) -> Result<(), HarnessError> {
        Ok(())
    }

    fn is_normals(&self) -> bool {
        true
    }

    fn shows_surface_color(&self) -> bool {
        false
    }

    fn color(&self, shading: &Shading<'_>) -> DVec3 {
        (shading.normal)() * 0.5 + 0.5
    }

    fn on_device(&self, _view: &ShadeView) -> Result<ShadeOnDevice, HarnessError> {
        Ok(ShadeOnDevice::new(&[
            ("npr-toon", npr_toon::WGSL),
            ("one_light.wgsl", super::lambert::ONE_LIGHT_WGSL),
            ("normals.wgsl", include_str!("normals.wgsl")),
        ]))
    }
}

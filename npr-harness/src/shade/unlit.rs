//! Surfaces without a shading function: paper, and hatched surfaces, which use only the diffuse term.

use super::model::{ShadeModel, ShadeOnDevice, ShadeView, Shading};
use crate::error::HarnessError;
use glam::DVec3;

pub(super) struct Unlit;

impl ShadeModel for Unlit {
    fn validate(&self) -> Result<(), HarnessError> {
        Ok(())
    }

    fn color(&self, shading: &Shading<'_>) -> DVec3 {
        shading.base
    }

    fn on_device(&self, _view: &ShadeView) -> Result<ShadeOnDevice, HarnessError> {
        Ok(ShadeOnDevice::new(&[
            ("npr-toon", npr_toon::WGSL),
            ("one_light.wgsl", super::lambert::ONE_LIGHT_WGSL),
            ("unlit.wgsl", include_str!("unlit.wgsl")),
        ]))
    }
}

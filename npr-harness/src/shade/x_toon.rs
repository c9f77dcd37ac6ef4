//! Bands that fade with depth or near the silhouette: X-Toon (Barla, Thollot, Markosian 2006).

use super::model::{LitPoint, ShadeModel, ShadeOnDevice, ShadeView, Shading, flag};
use super::ramp_table::StopsTable;
use crate::error::HarnessError;
use crate::schema::{StyleFile, within};
use glam::DVec3;
use npr_toon::ramp::{Ramp, RampUniform};
use npr_toon::source::Light;
use npr_toon::x_toon::{Detail, toon_depth_detail, toon_silhouette_detail, toon_x_toon};
use serde::{Deserialize, Serialize};

/// Two ramps, and the level of detail that blends between them.
#[derive(Clone, Debug, PartialEq)]
pub struct XToon {
    /// The ramp at full detail; its colours multiply the surface's colour.
    pub detailed: Ramp,
    /// The ramp at no detail.
    pub abstracted: Ramp,
    /// The level of detail.
    pub detail: XToonDetail,
}

/// The level of detail.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub enum XToonDetail {
    /// Detail decreases from full at depth `from` to none at depth `to`. Depths are relative to the scene: 0 is its
    /// nearest point, 1 its farthest.
    Depth {
        /// −10..=10.
        from: f32,
        /// Above `from`, up to 10.
        to: f32,
    },
    /// Detail |N·V|^exponent, which is 0 at the silhouette.
    Silhouette {
        /// Above 0, up to 64.
        exponent: f32,
    },
}

impl XToonDetail {
    /// Converts relative depths to eye depths.
    fn in_view(self, view: &ShadeView) -> Detail {
        match self {
            Self::Depth { from, to } => {
                let (near, far) = view.depth_range;
                // A relative depth below 0 may lie behind the eye.
                let at = |share: f32| (near + (far - near) * f64::from(share)).max(near * 1e-3) as f32;
                Detail::Depth { near: at(from), far: at(to).max(at(from) * 1.001) }
            }
            Self::Silhouette { exponent } => Detail::Silhouette { exponent },
        }
    }
}

/// The table `[shade.x-toon]`.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct XToonTable {
    detailed: StopsTable,
    abstracted: StopsTable,
    detail: XToonDetail,
}

impl XToonTable {
    pub(super) fn new(x_toon: &XToon) -> Self {
        let XToon { detailed, abstracted, detail } = x_toon;
        Self { detailed: StopsTable::new(detailed), abstracted: StopsTable::new(abstracted), detail: *detail }
    }

    pub(super) fn x_toon(self, file: &StyleFile<'_>) -> Result<XToon, HarnessError> {
        Ok(XToon {
            detailed: self.detailed.ramp("shade.x-toon.detailed", file)?,
            abstracted: self.abstracted.ramp("shade.x-toon.abstracted", file)?,
            detail: self.detail,
        })
    }
}

/// The uniform `shade` of `x_toon.wgsl`.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct XToonUniform {
    detailed: RampUniform,
    abstracted: RampUniform,
    eye_depth: [f32; 4],
    near: f32,
    far: f32,
    exponent: f32,
    padding: f32,
}

fn detail_of(detail: Detail, depth: impl FnOnce() -> f64, n_dot_v: impl FnOnce() -> f64) -> f64 {
    match detail {
        Detail::Depth { near, far } => toon_depth_detail(depth(), near.into(), far.into()),
        Detail::Silhouette { exponent } => toon_silhouette_detail(n_dot_v(), exponent.into()),
    }
}

impl ShadeModel for XToon {
    fn validate(&self) -> Result<(), HarnessError> {
        RampUniform::new(&self.detailed)?;
        RampUniform::new(&self.abstracted)?;
        match self.detail {
            XToonDetail::Depth { from, to } => {
                within("the first depth of detail", from, -10.0, 10.0, "-10..=10")?;
                within("the last depth of detail", to, from + 1e-3, 10.0, "what is above the first..=10")
            }
            XToonDetail::Silhouette { exponent } => within("an exponent of detail", exponent, 1e-3, 64.0, "0.001..=64"),
        }
    }

    fn needs_position(&self) -> bool {
        matches!(self.detail, XToonDetail::Depth { .. })
    }

    fn second(&self, point: &LitPoint, _to_light: DVec3, _lights: &[Light], view: &ShadeView) -> f64 {
        let n_dot_v = || point.normal.normalize_or_zero().dot(point.to_eye.normalize_or_zero());
        detail_of(self.detail.in_view(view), || view.eye_depth.dot(point.at.extend(1.0)), n_dot_v)
    }

    fn second_vector(&self, point: &LitPoint, _lights: &[Light], view: &ShadeView) -> DVec3 {
        match self.detail {
            XToonDetail::Depth { .. } => DVec3::X * view.eye_depth.dot(point.at.extend(1.0)),
            XToonDetail::Silhouette { .. } => point.to_eye.normalize_or_zero(),
        }
    }

    fn second_interpolated(
        &self,
        normal: DVec3,
        _to_light: DVec3,
        second: DVec3,
        _lights: &[Light],
        view: &ShadeView,
    ) -> f64 {
        detail_of(self.detail.in_view(view), || second.x, || normal.dot(second))
    }

    fn second_in_shadow(&self, second: f64) -> f64 {
        second
    }

    fn color(&self, shading: &Shading<'_>) -> DVec3 {
        let (light, width) = (shading.light, (shading.widths)(&|light| light).x);
        shading.base
            * shading.light_color
            * toon_x_toon(&self.detailed, &self.abstracted, light.x, width, light.y.clamp(0.0, 1.0))
    }

    fn on_device(&self, view: &ShadeView) -> Result<ShadeOnDevice, HarnessError> {
        let (near, far, exponent) = match self.detail.in_view(view) {
            Detail::Depth { near, far } => (near, far, 1.0),
            Detail::Silhouette { exponent } => (1.0, 2.0, exponent),
        };
        let uniform = XToonUniform {
            detailed: RampUniform::new(&self.detailed)?,
            abstracted: RampUniform::new(&self.abstracted)?,
            eye_depth: view.eye_depth.as_vec4().to_array(),
            near,
            far,
            exponent,
            padding: 0.0,
        };
        let stops = self.detailed.stops.len().max(self.abstracted.stops.len());
        Ok(ShadeOnDevice {
            constants: vec![
                (npr_toon::ramp::TOON_STOPS_OVERRIDE, stops as f64),
                ("shade_by_depth", flag(self.needs_position())),
            ],
            uniform: bytemuck::bytes_of(&uniform).to_vec(),
            ..ShadeOnDevice::new(&[("npr-toon", npr_toon::WGSL), ("x_toon.wgsl", include_str!("x_toon.wgsl"))])
        })
    }
}

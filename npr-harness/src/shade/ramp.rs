//! Colours from a 1D ramp, indexed by light.

use super::model::{ShadeModel, ShadeOnDevice, ShadeView, Shading, flag};
use super::ramp_table::{FilterName, StopsTable, image_filter, texels_of};
use crate::error::HarnessError;
use crate::schema::{StyleFile, Texel};
use glam::{DVec2, DVec3};
use npr_toon::half_lambert::{HalfLambert, toon_half_lambert};
use npr_toon::ramp::{Ramp, RampUniform, toon_ramp};
use npr_toon::row::{RampRow, toon_row};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A 1D ramp and its lookup coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct RampShade {
    /// The colours, which multiply the surface's colour.
    pub ramp: RampSource,
    /// The transformation applied to N·L before the lookup; `None` uses N·L itself.
    pub half_lambert: Option<HalfLambert>,
}

/// The source of a 1D ramp.
#[derive(Clone, Debug, PartialEq)]
pub enum RampSource {
    /// Computed from stops.
    Stops(Ramp),
    /// Read from a row of texels.
    Image(RampRow),
}

/// The table `[shade.ramp]`.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct RampTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    stops: Option<StopsTable>,
    #[serde(skip_serializing_if = "Option::is_none")]
    image: Option<RowTable>,
    #[serde(skip_serializing_if = "Option::is_none")]
    half_lambert: Option<HalfLambertTable>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RowTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<PathBuf>,
    /// The row of the image, counted from the top.
    #[serde(default)]
    row: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    texels: Option<Vec<Texel>>,
    from: f32,
    to: f32,
    #[serde(default)]
    filter: FilterName,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct HalfLambertTable {
    #[serde(default = "half")]
    scale: f32,
    #[serde(default = "half")]
    bias: f32,
    #[serde(default)]
    squared: bool,
}

fn half() -> f32 {
    0.5
}

impl RampTable {
    pub(super) fn new(RampShade { ramp, half_lambert }: &RampShade) -> Self {
        let (stops, image) = match ramp {
            RampSource::Stops(ramp) => (Some(StopsTable::new(ramp)), None),
            RampSource::Image(row) => (None, Some(RowTable::new(row))),
        };
        let half_lambert =
            half_lambert.map(|HalfLambert { scale, bias, squared }| HalfLambertTable { scale, bias, squared });
        Self { stops, image, half_lambert }
    }

    pub(super) fn ramp(self, file: &StyleFile<'_>) -> Result<RampShade, HarnessError> {
        let ramp = match (self.stops, self.image) {
            (Some(stops), None) => RampSource::Stops(stops.ramp("shade.ramp.stops", file)?),
            (None, Some(row)) => RampSource::Image(row.row(file)?),
            _ => return Err(file.wrong("shade.ramp needs either a table `stops` or a table `image`")),
        };
        let half_lambert =
            self.half_lambert.map(|HalfLambertTable { scale, bias, squared }| HalfLambert { scale, bias, squared });
        Ok(RampShade { ramp, half_lambert })
    }
}

impl RowTable {
    fn new(row: &RampRow) -> Self {
        Self {
            file: None,
            row: 0,
            texels: Some(row.texels.iter().copied().map(Texel).collect()),
            from: row.from,
            to: row.to,
            filter: row.filter.into(),
        }
    }

    fn row(self, style: &StyleFile<'_>) -> Result<RampRow, HarnessError> {
        let texels = match (self.file, self.texels) {
            (Some(file), None) => {
                let image = style.image(&file)?;
                let rows = texels_of(&image.rgba8);
                let row = rows.chunks_exact(image.width.max(1) as usize).nth(self.row as usize);
                let outside = || {
                    let (row, height) = (self.row, image.height);
                    style
                        .wrong(format!("shade.ramp.image asks for row {row} of {}, which has {height}", file.display()))
                };
                row.ok_or_else(outside)?.to_vec()
            }
            (None, Some(texels)) => texels.into_iter().map(|texel| texel.0).collect(),
            _ => return Err(style.wrong("shade.ramp.image needs either a file or texels")),
        };
        Ok(RampRow { texels, from: self.from, to: self.to, filter: self.filter.into() })
    }
}

/// The uniform `shade` of `ramp.wgsl`.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct RampShadeUniform {
    ramp: RampUniform,
    half_scale: f32,
    half_bias: f32,
    half_squared: u32,
    padding: u32,
    row_ends: [f32; 2],
    padding_b: [u32; 2],
}

impl ShadeModel for RampShade {
    fn validate(&self) -> Result<(), HarnessError> {
        self.half_lambert.map_or(Ok(()), |how| how.validate())?;
        match &self.ramp {
            RampSource::Stops(ramp) => {
                RampUniform::new(ramp)?;
            }
            RampSource::Image(row) => row.validate()?,
        }
        Ok(())
    }

    fn color(&self, shading: &Shading<'_>) -> DVec3 {
        let input = |light: DVec2| match &self.half_lambert {
            Some(how) => DVec2::new(toon_half_lambert(how, light.x), 0.0),
            None => light,
        };
        let x = input(shading.light).x;
        let factor = match &self.ramp {
            RampSource::Stops(ramp) => toon_ramp(ramp, x, (shading.widths)(&input).x),
            RampSource::Image(row) => toon_row(row, x),
        };
        shading.base * shading.light_color * factor
    }

    fn on_device(&self, _view: &ShadeView) -> Result<ShadeOnDevice, HarnessError> {
        let mut uniform: RampShadeUniform = bytemuck::Zeroable::zeroed();
        if let Some(HalfLambert { scale, bias, squared }) = self.half_lambert {
            (uniform.half_scale, uniform.half_bias, uniform.half_squared) = (scale, bias, u32::from(squared));
        }
        let (mut stops, mut filter, mut image) = (1, None, None);
        match &self.ramp {
            RampSource::Stops(ramp) => {
                uniform.ramp = RampUniform::new(ramp)?;
                stops = ramp.stops.len();
            }
            RampSource::Image(row) => {
                uniform.row_ends = [row.from, row.to];
                filter = Some(row.filter);
                image = Some((row.texels.len() as u32, 1, row.texels.clone()));
            }
        }
        Ok(ShadeOnDevice {
            constants: vec![
                (npr_toon::ramp::TOON_STOPS_OVERRIDE, stops as f64),
                ("shade_image_filter", image_filter(filter)),
                ("shade_half_lambert", flag(self.half_lambert.is_some())),
            ],
            uniform: bytemuck::bytes_of(&uniform).to_vec(),
            image,
            ..ShadeOnDevice::new(&[
                ("npr-toon", npr_toon::WGSL),
                ("one_light.wgsl", super::lambert::ONE_LIGHT_WGSL),
                ("ramp_image.wgsl", include_str!("ramp_image.wgsl")),
                ("ramp.wgsl", include_str!("ramp.wgsl")),
            ])
        })
    }
}

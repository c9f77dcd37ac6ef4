//! Two lights, each mapped to an axis of a 2D ramp: the painter of *The Evolution of a Cartoon Renderer*.

use super::model::{LitPoint, ShadeModel, ShadeOnDevice, ShadeView, Shading};
use super::ramp_table::{FilterName, StopsTable, image_filter, texels_of};
use crate::error::HarnessError;
use crate::scene::MAX_LIGHTS;
use crate::schema::{Color, StyleFile, Texel};
use glam::{DVec2, DVec3, UVec2};
use npr_toon::painter::{Painter, toon_diffuse, toon_overbright};
use npr_toon::source::{Light, toon_to_light};
use npr_toon::table::{Corner, Ramp2d, Ramp2dUniform, RampTable, toon_ramp_2d, toon_table};
use npr_toon::{toon_n_dot_l, toon_n_dot_l_interpolated};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The settings of the painter, without its lights, which belong to the style.
#[derive(Clone, Debug, PartialEq)]
pub struct PainterShade {
    /// The 2D ramp.
    pub ramp: Ramp2dSource,
    /// [`Painter::light_scale`].
    pub light_scale: f32,
    /// Whether the alpha of a material's colour selects either the colour or the texture
    /// ([`npr_toon::painter::toon_material`]), as in listing 2; else the two are multiplied, as model files specify.
    pub material_by_alpha: bool,
}

/// The source of a 2D ramp.
#[derive(Clone, Debug, PartialEq)]
pub enum Ramp2dSource {
    /// Computed from the stops of two ramps.
    Ramps(Ramp2d),
    /// Read from an image.
    Image(RampTable),
}

/// The table `[shade.painter]`.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct PainterTable {
    #[serde(default = "light_scale")]
    light_scale: f32,
    #[serde(default)]
    material_by_alpha: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    first: Option<StopsTable>,
    #[serde(skip_serializing_if = "Option::is_none")]
    second: Option<StopsTable>,
    #[serde(skip_serializing_if = "Option::is_none")]
    corner: Option<CornerTable>,
    #[serde(skip_serializing_if = "Option::is_none")]
    image: Option<ImageTable>,
}

fn light_scale() -> f32 {
    Painter::LIGHT_SCALE
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct CornerTable {
    threshold: f32,
    color: Color,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct ImageTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<PathBuf>,
    /// In row order, from the dark corner.
    #[serde(skip_serializing_if = "Option::is_none")]
    texels: Option<Vec<Vec<Texel>>>,
    #[serde(default)]
    filter: FilterName,
}

impl PainterTable {
    pub(super) fn new(PainterShade { ramp, light_scale, material_by_alpha }: &PainterShade) -> Self {
        let mut table = Self {
            light_scale: *light_scale,
            material_by_alpha: *material_by_alpha,
            first: None,
            second: None,
            corner: None,
            image: None,
        };
        match ramp {
            Ramp2dSource::Ramps(ramps) => {
                table.first = Some(StopsTable::new(&ramps.a));
                table.second = Some(StopsTable::new(&ramps.b));
                table.corner =
                    ramps.corner.map(|corner| CornerTable { threshold: corner.threshold, color: Color(corner.color) });
            }
            Ramp2dSource::Image(image) => {
                let rows = image.texels.chunks(image.size.x.max(1) as usize);
                let texels = rows.map(|row| row.iter().copied().map(Texel).collect()).collect();
                table.image = Some(ImageTable { file: None, texels: Some(texels), filter: image.filter.into() });
            }
        }
        table
    }

    pub(super) fn painter(self, file: &StyleFile<'_>) -> Result<PainterShade, HarnessError> {
        let ramp = match (self.first, self.second, self.corner, self.image) {
            (Some(first), Some(second), corner, None) => Ramp2dSource::Ramps(Ramp2d {
                a: first.ramp("shade.painter.first", file)?,
                b: second.ramp("shade.painter.second", file)?,
                corner: corner.map(|corner| Corner { threshold: corner.threshold, color: corner.color.0 }),
            }),
            (None, None, None, Some(image)) => Ramp2dSource::Image(image.table(file)?),
            _ => {
                let what = "shade.painter needs either tables `first` and `second`, of stops, or a table `image`";
                return Err(file.wrong(what));
            }
        };
        Ok(PainterShade { ramp, light_scale: self.light_scale, material_by_alpha: self.material_by_alpha })
    }
}

impl ImageTable {
    fn table(self, style: &StyleFile<'_>) -> Result<RampTable, HarnessError> {
        let filter = self.filter.into();
        match (self.file, self.texels) {
            (Some(file), None) => {
                let image = style.image(&file)?;
                let size = UVec2::new(image.width, image.height);
                Ok(RampTable { size, texels: texels_of(&image.rgba8), filter })
            }
            (None, Some(rows)) => {
                let width = rows.first().map_or(0, Vec::len);
                if let Some(row) = rows.iter().position(|row| row.len() != width) {
                    let what = format!("row {row} of shade.painter.image has {} texels, not {width}", rows[row].len());
                    return Err(style.wrong(what));
                }
                let size = UVec2::new(width as u32, rows.len() as u32);
                Ok(RampTable { size, texels: rows.into_iter().flatten().map(|texel| texel.0).collect(), filter })
            }
            _ => Err(style.wrong("shade.painter.image needs either a file or texels")),
        }
    }
}

impl ShadeModel for PainterShade {
    fn validate(&self) -> Result<(), HarnessError> {
        Painter { lights: Vec::new(), light_scale: self.light_scale }.validate()?;
        match &self.ramp {
            Ramp2dSource::Ramps(ramps) => {
                Ramp2dUniform::new(ramps)?;
            }
            Ramp2dSource::Image(table) => table.validate()?,
        }
        Ok(())
    }

    fn lights(&self) -> usize {
        MAX_LIGHTS
    }

    fn pairs_lights(&self) -> bool {
        true
    }

    fn material_by_alpha(&self) -> bool {
        self.material_by_alpha
    }

    fn second(&self, point: &LitPoint, _to_light: DVec3, lights: &[Light], _view: &ShadeView) -> f64 {
        lights.get(1).map_or(0.0, |second| {
            let to_light = toon_to_light(second.place, point.at);
            toon_diffuse(toon_n_dot_l(point.normal, to_light), f64::from(second.brightness))
        })
    }

    fn second_vector(&self, point: &LitPoint, lights: &[Light], _view: &ShadeView) -> DVec3 {
        lights.get(1).map_or(DVec3::ZERO, |second| toon_to_light(second.place, point.at))
    }

    fn second_interpolated(
        &self,
        normal: DVec3,
        _to_light: DVec3,
        second: DVec3,
        lights: &[Light],
        _view: &ShadeView,
    ) -> f64 {
        lights
            .get(1)
            .map_or(0.0, |light| toon_diffuse(toon_n_dot_l_interpolated(normal, second), f64::from(light.brightness)))
    }

    fn second_in_shadow(&self, second: f64) -> f64 {
        second
    }

    fn color(&self, shading: &Shading<'_>) -> DVec3 {
        let shade = match &self.ramp {
            Ramp2dSource::Ramps(ramps) => toon_ramp_2d(ramps, shading.light, (shading.widths)(&|light: DVec2| light)),
            Ramp2dSource::Image(table) => toon_table(table, shading.light),
        };
        toon_overbright(shading.base * shade, shading.light_color, f64::from(self.light_scale))
    }

    fn on_device(&self, _view: &ShadeView) -> Result<ShadeOnDevice, HarnessError> {
        let mut uniform: Ramp2dUniform = bytemuck::Zeroable::zeroed();
        let (mut stops, mut filter, mut image) = (1, None, None);
        match &self.ramp {
            Ramp2dSource::Ramps(ramps) => {
                uniform = Ramp2dUniform::new(ramps)?;
                stops = ramps.a.stops.len().max(ramps.b.stops.len());
            }
            Ramp2dSource::Image(table) => {
                filter = Some(table.filter);
                image = Some((table.size.x, table.size.y, table.texels.clone()));
            }
        }
        Ok(ShadeOnDevice {
            constants: vec![
                (npr_toon::ramp::TOON_STOPS_OVERRIDE, stops as f64),
                ("shade_image_filter", image_filter(filter)),
            ],
            uniform: bytemuck::bytes_of(&uniform).to_vec(),
            image,
            light_scale: self.light_scale,
            ..ShadeOnDevice::new(&[
                ("npr-toon", npr_toon::WGSL),
                ("ramp_image.wgsl", include_str!("ramp_image.wgsl")),
                ("painter.wgsl", include_str!("painter.wgsl")),
            ])
        })
    }
}

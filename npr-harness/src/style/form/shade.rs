//! The keys of surfaces' paint.

use super::hatch::HatchForm;
use super::{At, Color, ColorForm, one, white, yes};
use crate::style::file::StyleFileError;
use crate::style::{PainterShade, Ramp2dSource, RampShade, RampSource, Shade};
use glam::UVec2;
use npr_gooch::{Gooch, Tones};
use npr_toon::half_lambert::HalfLambert;
use npr_toon::painter::Painter;
use npr_toon::ramp::{Ramp, RampBlend, RampStop};
use npr_toon::row::{RampRow, TexelFilter};
use npr_toon::table::{Corner, Ramp2d, RampTable};
use npr_toon::{Bands, Highlight};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) enum ShadeForm {
    Paper,
    Normals,
    Lambert(LambertForm),
    Toon(BandsForm),
    Ramp(RampShadeForm),
    Painter(PainterForm),
    Gooch(GoochForm),
    Hatch(HatchForm),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct LambertForm {
    ambient: f32,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct BandsForm {
    #[serde(default = "yes")]
    antialias: bool,
    thresholds: Vec<f32>,
    tones: Vec<Color>,
    #[serde(skip_serializing_if = "Option::is_none")]
    highlight: Option<HighlightForm>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct HighlightForm {
    threshold: f32,
    #[serde(default = "white")]
    color: Color,
    #[serde(default = "one")]
    strength: f32,
    #[serde(default)]
    lit_only: bool,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct RampShadeForm {
    #[serde(skip_serializing_if = "Option::is_none")]
    stops: Option<RampForm>,
    #[serde(skip_serializing_if = "Option::is_none")]
    image: Option<RowForm>,
    #[serde(skip_serializing_if = "Option::is_none")]
    half_lambert: Option<HalfLambertForm>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RampForm {
    #[serde(default)]
    blend: BlendForm,
    at: Vec<f32>,
    colors: Vec<Color>,
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum BlendForm {
    #[default]
    Hard,
    Smooth,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RowForm {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<PathBuf>,
    /// Of the file, from the top.
    #[serde(default)]
    row: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    texels: Option<Vec<Texel>>,
    from: f32,
    to: f32,
    #[serde(default)]
    filter: FilterForm,
}

/// A colour of 8 bits a component.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(try_from = "ColorForm", into = "String")]
struct Texel([u8; 4]);

impl TryFrom<ColorForm> for Texel {
    type Error = String;

    fn try_from(form: ColorForm) -> Result<Self, String> {
        let Color(color) = Color::try_from(form)?;
        let [r, g, b] = color.to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
        Ok(Self([r, g, b, 255]))
    }
}

impl From<Texel> for String {
    fn from(Texel([r, g, b, _]): Texel) -> Self {
        format!("#{r:02x}{g:02x}{b:02x}")
    }
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum FilterForm {
    Nearest,
    #[default]
    Linear,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct HalfLambertForm {
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

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct PainterForm {
    #[serde(default = "light_scale")]
    light_scale: f32,
    #[serde(default)]
    material_by_alpha: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    first: Option<RampForm>,
    #[serde(skip_serializing_if = "Option::is_none")]
    second: Option<RampForm>,
    #[serde(skip_serializing_if = "Option::is_none")]
    corner: Option<CornerForm>,
    #[serde(skip_serializing_if = "Option::is_none")]
    image: Option<TableForm>,
}

fn light_scale() -> f32 {
    Painter::LIGHT_SCALE
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct CornerForm {
    threshold: f32,
    color: Color,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct TableForm {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<PathBuf>,
    /// Row by row, from the dark corner.
    #[serde(skip_serializing_if = "Option::is_none")]
    texels: Option<Vec<Vec<Texel>>>,
    #[serde(default)]
    filter: FilterForm,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(super) struct GoochForm {
    blue: Color,
    yellow: Color,
    alpha: f32,
    beta: f32,
    tones: TonesForm,
    #[serde(skip_serializing_if = "Option::is_none")]
    highlight: Option<GoochHighlightForm>,
}

impl Default for GoochForm {
    fn default() -> Self {
        // Without a table for it there is no highlight, as with bands.
        Self::new(&Gooch { highlight: None, ..Gooch::default() })
    }
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum TonesForm {
    Equation,
    #[serde(rename = "listing-7")]
    Listing7,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct GoochHighlightForm {
    #[serde(default = "white")]
    color: Color,
    #[serde(default = "one")]
    strength: f32,
    exponent: f32,
}

impl ShadeForm {
    pub(super) fn new(shade: &Shade) -> Self {
        match shade {
            Shade::Paper => Self::Paper,
            Shade::Normals => Self::Normals,
            Shade::Lambert { ambient } => Self::Lambert(LambertForm { ambient: *ambient }),
            Shade::Toon(bands) => Self::Toon(BandsForm::new(bands)),
            Shade::Ramp(ramp) => Self::Ramp(RampShadeForm::new(ramp)),
            Shade::Painter(painter) => Self::Painter(PainterForm::new(painter)),
            Shade::Gooch(model) => Self::Gooch(GoochForm::new(model)),
            Shade::Hatch(hatch) => Self::Hatch(HatchForm::new(hatch)),
        }
    }

    pub(super) fn shade(self, at: &At<'_>) -> Result<Shade, StyleFileError> {
        Ok(match self {
            Self::Paper => Shade::Paper,
            Self::Normals => Shade::Normals,
            Self::Lambert(LambertForm { ambient }) => Shade::Lambert { ambient },
            Self::Toon(bands) => Shade::Toon(bands.bands()),
            Self::Ramp(ramp) => Shade::Ramp(ramp.ramp(at)?),
            Self::Painter(painter) => Shade::Painter(painter.painter(at)?),
            Self::Gooch(gooch) => Shade::Gooch(gooch.gooch()),
            Self::Hatch(hatch) => Shade::Hatch(hatch.hatch(at)?),
        })
    }
}

impl BandsForm {
    fn new(bands: &Bands) -> Self {
        Self {
            antialias: bands.antialias,
            thresholds: bands.thresholds.clone(),
            tones: bands.tones.iter().copied().map(Color).collect(),
            highlight: bands.highlight.map(|highlight| HighlightForm {
                threshold: highlight.threshold,
                color: Color(highlight.color),
                strength: highlight.strength,
                lit_only: highlight.lit_only,
            }),
        }
    }

    fn bands(self) -> Bands {
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
        }
    }
}

impl RampForm {
    fn new(ramp: &Ramp) -> Self {
        let blend = match ramp.blend {
            RampBlend::Hard => BlendForm::Hard,
            RampBlend::Smooth => BlendForm::Smooth,
        };
        let at = ramp.stops.iter().map(|stop| stop.at).collect();
        Self { blend, at, colors: ramp.stops.iter().map(|stop| Color(stop.color)).collect() }
    }

    fn ramp(self, table: &str, at: &At<'_>) -> Result<Ramp, StyleFileError> {
        if self.at.len() != self.colors.len() {
            let (stops, colors) = (self.at.len(), self.colors.len());
            return Err(at.wrong(format!("{table} has {stops} numbers in `at` and {colors} in `colors`")));
        }
        let blend = match self.blend {
            BlendForm::Hard => RampBlend::Hard,
            BlendForm::Smooth => RampBlend::Smooth,
        };
        let stops = self.at.into_iter().zip(self.colors).map(|(at, color)| RampStop { at, color: color.0 });
        Ok(Ramp { blend, stops: stops.collect() })
    }
}

fn filter_form(filter: TexelFilter) -> FilterForm {
    match filter {
        TexelFilter::Nearest => FilterForm::Nearest,
        TexelFilter::Linear => FilterForm::Linear,
    }
}

fn texel_filter(filter: FilterForm) -> TexelFilter {
    match filter {
        FilterForm::Nearest => TexelFilter::Nearest,
        FilterForm::Linear => TexelFilter::Linear,
    }
}

fn texels_of(rgba8: &[u8]) -> Vec<[u8; 4]> {
    rgba8.as_chunks::<4>().0.to_vec()
}

impl RampShadeForm {
    fn new(RampShade { ramp, half_lambert }: &RampShade) -> Self {
        let (stops, image) = match ramp {
            RampSource::Stops(ramp) => (Some(RampForm::new(ramp)), None),
            RampSource::Image(row) => (None, Some(RowForm::new(row))),
        };
        let half_lambert =
            half_lambert.map(|HalfLambert { scale, bias, squared }| HalfLambertForm { scale, bias, squared });
        Self { stops, image, half_lambert }
    }

    fn ramp(self, at: &At<'_>) -> Result<RampShade, StyleFileError> {
        let ramp = match (self.stops, self.image) {
            (Some(stops), None) => RampSource::Stops(stops.ramp("shade.ramp.stops", at)?),
            (None, Some(row)) => RampSource::Image(row.row(at)?),
            _ => return Err(at.wrong("shade.ramp needs either a table `stops` or a table `image`")),
        };
        let half_lambert =
            self.half_lambert.map(|HalfLambertForm { scale, bias, squared }| HalfLambert { scale, bias, squared });
        Ok(RampShade { ramp, half_lambert })
    }
}

impl RowForm {
    fn new(row: &RampRow) -> Self {
        Self {
            file: None,
            row: 0,
            texels: Some(row.texels.iter().copied().map(Texel).collect()),
            from: row.from,
            to: row.to,
            filter: filter_form(row.filter),
        }
    }

    fn row(self, at: &At<'_>) -> Result<RampRow, StyleFileError> {
        let texels = match (self.file, self.texels) {
            (Some(file), None) => {
                let image = at.image(&file)?;
                let rows = texels_of(&image.rgba8);
                let row = rows.chunks_exact(image.width.max(1) as usize).nth(self.row as usize);
                let outside = || {
                    let (row, height) = (self.row, image.height);
                    at.wrong(format!("shade.ramp.image asks for row {row} of {}, which has {height}", file.display()))
                };
                row.ok_or_else(outside)?.to_vec()
            }
            (None, Some(texels)) => texels.into_iter().map(|texel| texel.0).collect(),
            _ => return Err(at.wrong("shade.ramp.image needs either a file or texels")),
        };
        Ok(RampRow { texels, from: self.from, to: self.to, filter: texel_filter(self.filter) })
    }
}

impl PainterForm {
    fn new(PainterShade { ramp, light_scale, material_by_alpha }: &PainterShade) -> Self {
        let mut form = Self {
            light_scale: *light_scale,
            material_by_alpha: *material_by_alpha,
            first: None,
            second: None,
            corner: None,
            image: None,
        };
        match ramp {
            Ramp2dSource::Ramps(ramps) => {
                form.first = Some(RampForm::new(&ramps.a));
                form.second = Some(RampForm::new(&ramps.b));
                form.corner =
                    ramps.corner.map(|corner| CornerForm { threshold: corner.threshold, color: Color(corner.color) });
            }
            Ramp2dSource::Image(table) => {
                let rows = table.texels.chunks(table.size.x.max(1) as usize);
                let texels = rows.map(|row| row.iter().copied().map(Texel).collect()).collect();
                form.image = Some(TableForm { file: None, texels: Some(texels), filter: filter_form(table.filter) });
            }
        }
        form
    }

    fn painter(self, at: &At<'_>) -> Result<PainterShade, StyleFileError> {
        let ramp = match (self.first, self.second, self.corner, self.image) {
            (Some(first), Some(second), corner, None) => Ramp2dSource::Ramps(Ramp2d {
                a: first.ramp("shade.painter.first", at)?,
                b: second.ramp("shade.painter.second", at)?,
                corner: corner.map(|corner| Corner { threshold: corner.threshold, color: corner.color.0 }),
            }),
            (None, None, None, Some(table)) => Ramp2dSource::Image(table.table(at)?),
            _ => {
                let what = "shade.painter needs either tables `first` and `second`, of stops, or a table `image`";
                return Err(at.wrong(what));
            }
        };
        Ok(PainterShade { ramp, light_scale: self.light_scale, material_by_alpha: self.material_by_alpha })
    }
}

impl TableForm {
    fn table(self, at: &At<'_>) -> Result<RampTable, StyleFileError> {
        let filter = texel_filter(self.filter);
        match (self.file, self.texels) {
            (Some(file), None) => {
                let image = at.image(&file)?;
                let size = UVec2::new(image.width, image.height);
                Ok(RampTable { size, texels: texels_of(&image.rgba8), filter })
            }
            (None, Some(rows)) => {
                let width = rows.first().map_or(0, Vec::len);
                if let Some(row) = rows.iter().position(|row| row.len() != width) {
                    let what = format!("row {row} of shade.painter.image has {} texels, not {width}", rows[row].len());
                    return Err(at.wrong(what));
                }
                let size = UVec2::new(width as u32, rows.len() as u32);
                Ok(RampTable { size, texels: rows.into_iter().flatten().map(|texel| texel.0).collect(), filter })
            }
            _ => Err(at.wrong("shade.painter.image needs either a file or texels")),
        }
    }
}

impl GoochForm {
    fn new(model: &Gooch) -> Self {
        Self {
            blue: Color(model.blue),
            yellow: Color(model.yellow),
            alpha: model.alpha,
            beta: model.beta,
            tones: match model.tones {
                Tones::Equation => TonesForm::Equation,
                Tones::Listing7 => TonesForm::Listing7,
            },
            highlight: model.highlight.map(|highlight| GoochHighlightForm {
                color: Color(highlight.color),
                strength: highlight.strength,
                exponent: highlight.exponent,
            }),
        }
    }

    fn gooch(self) -> Gooch {
        Gooch {
            blue: self.blue.0,
            yellow: self.yellow.0,
            alpha: self.alpha,
            beta: self.beta,
            tones: match self.tones {
                TonesForm::Equation => Tones::Equation,
                TonesForm::Listing7 => Tones::Listing7,
            },
            highlight: self.highlight.map(|highlight| npr_gooch::Highlight {
                color: highlight.color.0,
                strength: highlight.strength,
                exponent: highlight.exponent,
            }),
        }
    }
}

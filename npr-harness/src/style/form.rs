//! The shape of a style's file, key by key.

use super::file::StyleFileError;
use super::{Lines, PainterShade, Ramp2dSource, RampShade, RampSource, Shade, Style};
use crate::compare::Image;
use crate::image_ink::{ImageInk, InkScale, Regions};
use crate::light::{LightFrame, StyleLight};
use glam::{UVec2, Vec3};
use npr_gooch::{Gooch, Tones};
use npr_imagespace::composite::{AlphaTest, Composite};
use npr_imagespace::filter::fused::{DepthTest, FusedFilter};
use npr_imagespace::format::texel::TexelLayout;
use npr_imagespace::morphology::disc::Disc;
use npr_imagespace::picture::Taps;
use npr_outline::LineKind;
use npr_outline::line_look::{LineLook, widths_px};
use npr_toon::half_lambert::HalfLambert;
use npr_toon::normal::NormalUse;
use npr_toon::painter::Painter;
use npr_toon::ramp::{Ramp, RampBlend, RampStop};
use npr_toon::row::{RampRow, TexelFilter};
use npr_toon::source::{Light, LightPlace};
use npr_toon::table::{Corner, Ramp2d, RampTable};
use npr_toon::{Bands, Highlight};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Red, green and blue; read from `"#rrggbb"`, too.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(try_from = "ColorForm", into = "[f32; 3]")]
struct Color(Vec3);

#[derive(Deserialize)]
#[serde(untagged, expecting = "a colour: [r, g, b], 0 to 1, or \"#rrggbb\"")]
enum ColorForm {
    Numbers([f32; 3]),
    Hex(String),
}

impl TryFrom<ColorForm> for Color {
    type Error = String;

    fn try_from(form: ColorForm) -> Result<Self, String> {
        match form {
            ColorForm::Numbers(rgb) => Ok(Self(rgb.into())),
            ColorForm::Hex(text) => {
                let digits =
                    text.strip_prefix('#').filter(|d| d.len() == 6 && d.bytes().all(|b| b.is_ascii_hexdigit()));
                let number = digits.and_then(|digits| u32::from_str_radix(digits, 16).ok());
                let [_, r, g, b] = number.ok_or_else(|| format!("{text:?} is no colour: #rrggbb"))?.to_be_bytes();
                Ok(Self(Vec3::new(r.into(), g.into(), b.into()) / 255.0))
            }
        }
    }
}

impl From<Color> for [f32; 3] {
    fn from(color: Color) -> Self {
        color.0.to_array()
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(super) struct StyleForm {
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    about: String,
    paper: Color,
    crease_angle_deg: f32,
    normals: NormalsForm,
    light: Vec<LightForm>,
    shade: ShadeForm,
    #[serde(skip_serializing_if = "Option::is_none")]
    lines: Option<LinesForm>,
}

impl Default for StyleForm {
    fn default() -> Self {
        Self {
            name: None,
            about: String::new(),
            paper: Color(Vec3::ONE),
            crease_angle_deg: 45.0,
            normals: NormalsForm::PerPixel,
            light: vec![LightForm::new(&StyleLight::KEY)],
            shade: ShadeForm::Toon(BandsForm::default()),
            lines: None,
        }
    }
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum NormalsForm {
    PerPixel,
    Interpolated,
    PerVertex,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct LightForm {
    #[serde(skip_serializing_if = "Option::is_none")]
    direction: Option<[f32; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    position: Option<[f32; 3]>,
    #[serde(default)]
    frame: FrameForm,
    #[serde(default = "white")]
    color: Color,
    #[serde(default = "one")]
    brightness: f32,
}

fn white() -> Color {
    Color(Vec3::ONE)
}

fn one() -> f32 {
    1.0
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum FrameForm {
    #[default]
    View,
    World,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
enum ShadeForm {
    Paper,
    Lambert(LambertForm),
    Toon(BandsForm),
    Ramp(RampShadeForm),
    Painter(PainterForm),
    Gooch(GoochForm),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct LambertForm {
    ambient: f32,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct BandsForm {
    #[serde(default = "yes")]
    antialias: bool,
    thresholds: Vec<f32>,
    tones: Vec<Color>,
    #[serde(skip_serializing_if = "Option::is_none")]
    highlight: Option<HighlightForm>,
}

fn yes() -> bool {
    true
}

impl Default for BandsForm {
    fn default() -> Self {
        Self::new(&Bands::default())
    }
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
struct RampShadeForm {
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
struct PainterForm {
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
struct GoochForm {
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

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
enum LinesForm {
    Fins(FinsForm),
    Printed(PrintedForm),
    Image(Box<ImageForm>),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct FinsForm {
    silhouette_px: f32,
    boundary_px: f32,
    crease_px: f32,
    #[serde(default)]
    material_border_px: f32,
    ink: Color,
    #[serde(default = "one")]
    opacity: f32,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct PrintedForm {
    width_px: f32,
    ink: Color,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
struct ImageForm {
    /// Whether normals make lines, and the cosine below which two differ.
    normals: bool,
    normal_cos: f32,
    depth: bool,
    depth_step: f32,
    depth_plain: bool,
    regions: RegionsForm,
    taps: TapsForm,
    softness: f32,
    layout: LayoutForm,
    artist: bool,
    scale: ScaleForm,
    #[serde(skip_serializing_if = "Option::is_none")]
    brush: Option<BrushForm>,
    composite: CompositeForm,
}

impl Default for ImageForm {
    fn default() -> Self {
        Self::new(&ImageInk::default())
    }
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum RegionsForm {
    None,
    One,
    Material,
    Mesh,
    Patch,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum TapsForm {
    Diagonal,
    Cross,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum LayoutForm {
    Narrow,
    Wide,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ScaleForm {
    Half,
    One,
    Double,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct BrushForm {
    radius_px: f32,
    #[serde(default = "yes")]
    antialias: bool,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
enum CompositeForm {
    Multiply,
    AlphaTested(AlphaForm),
    Over(OverForm),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct AlphaForm {
    less: bool,
    reference: u8,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct OverForm {
    color: Color,
    #[serde(default = "one")]
    opacity: f32,
}

impl StyleForm {
    pub(super) fn new(style: &Style) -> Self {
        Self {
            name: Some(style.name.clone()),
            about: style.about.clone(),
            paper: Color(style.paper),
            crease_angle_deg: style.crease_angle_rad.to_degrees(),
            normals: match style.normals {
                NormalUse::PerPixel => NormalsForm::PerPixel,
                NormalUse::Interpolated => NormalsForm::Interpolated,
                NormalUse::PerVertex => NormalsForm::PerVertex,
            },
            light: style.lights.iter().map(LightForm::new).collect(),
            shade: ShadeForm::new(&style.shade),
            lines: style.lines.as_ref().map(LinesForm::new),
        }
    }

    /// `path` is the file's: images are named relative to it.
    pub(super) fn style(self, path: &Path) -> Result<Style, StyleFileError> {
        let at = At { path };
        let lights = self.light.into_iter().enumerate().map(|(index, light)| light.light(index, &at));
        Ok(Style {
            name: self.name.unwrap_or_else(|| {
                path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
            }),
            about: self.about,
            paper: self.paper.0,
            shade: self.shade.shade(&at)?,
            normals: match self.normals {
                NormalsForm::PerPixel => NormalUse::PerPixel,
                NormalsForm::Interpolated => NormalUse::Interpolated,
                NormalsForm::PerVertex => NormalUse::PerVertex,
            },
            lights: lights.collect::<Result<_, _>>()?,
            lines: self.lines.map(LinesForm::lines),
            crease_angle_rad: self.crease_angle_deg.to_radians(),
        })
    }
}

/// Whose file it is.
struct At<'a> {
    path: &'a Path,
}

impl At<'_> {
    fn wrong(&self, what: impl Into<String>) -> StyleFileError {
        StyleFileError::Form { path: self.path.to_owned(), what: what.into() }
    }

    fn image(&self, file: &Path) -> Result<Image, StyleFileError> {
        Ok(Image::load_png(&self.path.parent().unwrap_or(Path::new("")).join(file))?)
    }
}

impl LightForm {
    fn new(StyleLight { light, frame }: &StyleLight) -> Self {
        let (direction, position) = match light.place {
            LightPlace::Directional { to_light } => (Some(to_light.to_array()), None),
            LightPlace::Positional { position } => (None, Some(position.to_array())),
        };
        let frame = match frame {
            LightFrame::View => FrameForm::View,
            LightFrame::World => FrameForm::World,
        };
        Self { direction, position, frame, color: Color(light.color), brightness: light.brightness }
    }

    fn light(self, index: usize, at: &At<'_>) -> Result<StyleLight, StyleFileError> {
        let place = match (self.direction, self.position) {
            (Some(to_light), None) => LightPlace::Directional { to_light: to_light.into() },
            (None, Some(position)) => LightPlace::Positional { position: position.into() },
            _ => return Err(at.wrong(format!("light {index} needs either a direction or a position"))),
        };
        let frame = match self.frame {
            FrameForm::View => LightFrame::View,
            FrameForm::World => LightFrame::World,
        };
        Ok(StyleLight { light: Light { place, color: self.color.0, brightness: self.brightness }, frame })
    }
}

impl ShadeForm {
    fn new(shade: &Shade) -> Self {
        match shade {
            Shade::Paper => Self::Paper,
            Shade::Lambert { ambient } => Self::Lambert(LambertForm { ambient: *ambient }),
            Shade::Toon(bands) => Self::Toon(BandsForm::new(bands)),
            Shade::Ramp(ramp) => Self::Ramp(RampShadeForm::new(ramp)),
            Shade::Painter(painter) => Self::Painter(PainterForm::new(painter)),
            Shade::Gooch(model) => Self::Gooch(GoochForm::new(model)),
        }
    }

    fn shade(self, at: &At<'_>) -> Result<Shade, StyleFileError> {
        Ok(match self {
            Self::Paper => Shade::Paper,
            Self::Lambert(LambertForm { ambient }) => Shade::Lambert { ambient },
            Self::Toon(bands) => Shade::Toon(bands.bands()),
            Self::Ramp(ramp) => Shade::Ramp(ramp.ramp(at)?),
            Self::Painter(painter) => Shade::Painter(painter.painter(at)?),
            Self::Gooch(gooch) => Shade::Gooch(gooch.gooch()),
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

impl LinesForm {
    fn new(lines: &Lines) -> Self {
        match lines {
            Lines::Fins(look) => {
                let width = |kind: LineKind| look.width_px[kind as usize];
                let [r, g, b, opacity] = look.ink;
                Self::Fins(FinsForm {
                    silhouette_px: width(LineKind::Silhouette),
                    boundary_px: width(LineKind::Boundary),
                    crease_px: width(LineKind::Crease),
                    material_border_px: width(LineKind::MaterialBorder),
                    ink: Color(Vec3::new(r, g, b)),
                    opacity,
                })
            }
            Lines::Printed { width_px, ink } => Self::Printed(PrintedForm { width_px: *width_px, ink: Color(*ink) }),
            Lines::Image(ink) => Self::Image(Box::new(ImageForm::new(ink))),
        }
    }

    fn lines(self) -> Lines {
        match self {
            Self::Fins(fins) => Lines::Fins(LineLook {
                width_px: widths_px(fins.silhouette_px, fins.boundary_px, fins.crease_px, fins.material_border_px),
                ink: fins.ink.0.extend(fins.opacity).to_array(),
            }),
            Self::Printed(PrintedForm { width_px, ink }) => Lines::Printed { width_px, ink: ink.0 },
            Self::Image(image) => Lines::Image(image.ink()),
        }
    }
}

impl ImageForm {
    fn new(ink: &ImageInk) -> Self {
        let FusedFilter { normal_cos, depth, regions, taps, softness } = ink.filter;
        let fallback = FusedFilter::default();
        let test = depth.or(fallback.depth).unwrap_or_default();
        Self {
            normals: normal_cos.is_some(),
            normal_cos: normal_cos.or(fallback.normal_cos).unwrap_or_default(),
            depth: depth.is_some(),
            depth_step: test.step,
            depth_plain: test.plain,
            regions: match ink.regions {
                _ if !regions => RegionsForm::None,
                Regions::One => RegionsForm::One,
                Regions::Material => RegionsForm::Material,
                Regions::Mesh => RegionsForm::Mesh,
                Regions::Patch => RegionsForm::Patch,
            },
            taps: match taps {
                Taps::Diagonal => TapsForm::Diagonal,
                Taps::Cross => TapsForm::Cross,
            },
            softness,
            layout: match ink.layout {
                TexelLayout::Narrow => LayoutForm::Narrow,
                TexelLayout::Wide => LayoutForm::Wide,
            },
            artist: ink.artist,
            scale: match ink.scale {
                InkScale::Half => ScaleForm::Half,
                InkScale::One => ScaleForm::One,
                InkScale::Double => ScaleForm::Double,
            },
            brush: ink.brush.map(|Disc { radius_px, antialias }| BrushForm { radius_px, antialias }),
            composite: match ink.composite {
                Composite::Multiply => CompositeForm::Multiply,
                Composite::AlphaTested(AlphaTest { less, reference }) => {
                    CompositeForm::AlphaTested(AlphaForm { less, reference })
                }
                Composite::Over { color, opacity } => CompositeForm::Over(OverForm { color: Color(color), opacity }),
            },
        }
    }

    fn ink(self) -> ImageInk {
        ImageInk {
            filter: FusedFilter {
                normal_cos: self.normals.then_some(self.normal_cos),
                depth: self.depth.then_some(DepthTest { step: self.depth_step, plain: self.depth_plain }),
                regions: !matches!(self.regions, RegionsForm::None),
                taps: match self.taps {
                    TapsForm::Diagonal => Taps::Diagonal,
                    TapsForm::Cross => Taps::Cross,
                },
                softness: self.softness,
            },
            layout: match self.layout {
                LayoutForm::Narrow => TexelLayout::Narrow,
                LayoutForm::Wide => TexelLayout::Wide,
            },
            regions: match self.regions {
                RegionsForm::One => Regions::One,
                RegionsForm::Material => Regions::Material,
                RegionsForm::Mesh => Regions::Mesh,
                RegionsForm::None | RegionsForm::Patch => Regions::Patch,
            },
            artist: self.artist,
            brush: self.brush.map(|BrushForm { radius_px, antialias }| Disc { radius_px, antialias }),
            scale: match self.scale {
                ScaleForm::Half => InkScale::Half,
                ScaleForm::One => InkScale::One,
                ScaleForm::Double => InkScale::Double,
            },
            composite: match self.composite {
                CompositeForm::Multiply => Composite::Multiply,
                CompositeForm::AlphaTested(AlphaForm { less, reference }) => {
                    Composite::AlphaTested(AlphaTest { less, reference })
                }
                CompositeForm::Over(OverForm { color, opacity }) => Composite::Over { color: color.0, opacity },
            },
        }
    }
}

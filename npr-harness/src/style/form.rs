//! The shape of a style's file, key by key.

mod hatch;
mod lines;
mod shade;
mod shadow;

use super::file::StyleFileError;
use super::{Shade, Style};
use crate::compare::Image;
use crate::light::{LightFrame, StyleLight};
use glam::Vec3;
use lines::LinesForm;
use npr_toon::Bands;
use npr_toon::normal::NormalUse;
use npr_toon::source::{Light, LightPlace};
use serde::{Deserialize, Serialize};
use shade::ShadeForm;
use shadow::ShadowForm;
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
    shadow: Option<ShadowForm>,
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
            shade: ShadeForm::new(&Shade::Toon(Bands::default())),
            shadow: None,
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

fn yes() -> bool {
    true
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
            shadow: style.shadow.as_ref().map(ShadowForm::new),
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
            shadow: self.shadow.map(ShadowForm::shadow).transpose().map_err(|what| at.wrong(what))?,
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

    /// Where a file lies that the style names.
    fn beside(&self, file: &Path) -> PathBuf {
        let path = self.path.parent().unwrap_or(Path::new("")).join(file);
        // So that it is found from anywhere when it is written again.
        std::path::absolute(&path).unwrap_or(path)
    }

    fn image(&self, file: &Path) -> Result<Image, StyleFileError> {
        Ok(Image::load_png(&self.beside(file))?)
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

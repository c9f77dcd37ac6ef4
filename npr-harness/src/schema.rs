//! Types that the tables of a style file share: colours, file names, errors.

use crate::error::HarnessError;
use crate::picture::Image;
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// A display-referred colour: `[r, g, b]`, 0..=1, or `"#rrggbb"`.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(try_from = "ColorText", into = "[f32; 3]")]
pub(crate) struct Color(pub(crate) Vec3);

#[derive(Deserialize)]
#[serde(untagged, expecting = "a colour: [r, g, b], 0 to 1, or \"#rrggbb\"")]
enum ColorText {
    Numbers([f32; 3]),
    Hex(String),
}

impl TryFrom<ColorText> for Color {
    type Error = String;

    fn try_from(text: ColorText) -> Result<Self, String> {
        match text {
            ColorText::Numbers(rgb) => Ok(Self(rgb.into())),
            ColorText::Hex(text) => {
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

/// A colour of 8 bits a component, written as `"#rrggbb"`.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(try_from = "ColorText", into = "String")]
pub(crate) struct Texel(pub(crate) [u8; 4]);

impl TryFrom<ColorText> for Texel {
    type Error = String;

    fn try_from(text: ColorText) -> Result<Self, String> {
        let Color(color) = Color::try_from(text)?;
        let [r, g, b] = color.to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
        Ok(Self([r, g, b, 255]))
    }
}

impl From<Texel> for String {
    fn from(Texel([r, g, b, _]): Texel) -> Self {
        format!("#{r:02x}{g:02x}{b:02x}")
    }
}

pub(crate) fn white() -> Color {
    Color(Vec3::ONE)
}

pub(crate) fn black() -> Color {
    Color(Vec3::ZERO)
}

pub(crate) fn one() -> f32 {
    1.0
}

pub(crate) fn yes() -> bool {
    true
}

/// The file that contains a table.
pub(crate) struct StyleFile<'a> {
    pub(crate) path: &'a Path,
}

impl StyleFile<'_> {
    pub(crate) fn wrong(&self, what: impl Into<String>) -> HarnessError {
        HarnessError::StyleTable { path: self.path.to_owned(), what: what.into() }
    }

    /// Adds the name of the file to an error about its content.
    pub(crate) fn rule(&self, source: HarnessError) -> HarnessError {
        HarnessError::StyleRule { path: self.path.to_owned(), source: Box::new(source) }
    }

    /// Resolves a path in a style relative to the style's file.
    pub(crate) fn beside(&self, file: &Path) -> PathBuf {
        let path = self.path.parent().unwrap_or(Path::new("")).join(file);
        // Absolute, so that a copy of the style written elsewhere still finds it.
        std::path::absolute(&path).unwrap_or(path)
    }

    pub(crate) fn image(&self, file: &Path) -> Result<Image, HarnessError> {
        Image::load_png(&self.beside(file)).map_err(HarnessError::RampImage)
    }
}

/// Checks that a number of a style is within its range.
pub(crate) fn within(
    what: &'static str,
    value: f32,
    low: f32,
    high: f32,
    range: &'static str,
) -> Result<(), HarnessError> {
    if (low..=high).contains(&value) {
        Ok(())
    } else {
        Err(HarnessError::Range { what, value: f64::from(value), range })
    }
}

/// Checks that all components of a colour are within 0..=1.
pub(crate) fn within_colors(what: &'static str, components: &[f32]) -> Result<(), HarnessError> {
    components.iter().try_for_each(|&component| within(what, component, 0.0, 1.0, "0..=1"))
}

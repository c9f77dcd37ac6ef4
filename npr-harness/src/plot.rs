//! Diagrams as SVG, and as PNG made from the same SVG.
//!
//! Lengths are CSS pixels; the drawing's own unit is a sixteenth of one, so that coordinates are integers. The pictures
//! are the same on every machine: text is measured, and rendered to PNG, with a font that is compiled in (Noto Sans).
//! A browser uses its own sans-serif font; boxes of text are taken a little wider for that.

mod canvas;
mod curves;
pub mod labels;
mod scale;
mod scatter;

pub use curves::{Curve, Curves, curves};
pub use scale::number;
pub use scatter::{Point, Scatter, mark_positions, scatter};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg;
use std::sync::{Arc, LazyLock};

/// An axis of a diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity with its unit.
    pub title: String,
    /// Whether the scale is logarithmic. Values that are not positive are drawn on a line of their own, marked 0.
    pub logarithmic: bool,
}

/// A colour of the diagrams, by its role.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Color {
    /// The red, green and blue of the light theme.
    pub light: [u8; 3],
    /// Those of the dark theme.
    pub dark: [u8; 3],
    /// The CSS variable that [`themed`] puts in its place.
    pub variable: &'static str,
}

const fn color(light: u32, dark: u32, variable: &'static str) -> Color {
    const fn rgb(hex: u32) -> [u8; 3] {
        [(hex >> 16) as u8, (hex >> 8) as u8, hex as u8]
    }
    Color { light: rgb(light), dark: rgb(dark), variable }
}

/// The ground of the picture.
pub const GROUND: Color = color(0xFFFFFF, 0x16181C, "--plot-ground");
/// Text, and the front.
pub const INK: Color = color(0x1B1F24, 0xE8EAED, "--plot-ink");
/// Secondary text and axes.
pub const FAINT: Color = color(0x59616B, 0xA3ABB6, "--plot-faint");
/// Grid lines.
pub const GRID: Color = color(0xE3E6EA, 0x2F343B, "--plot-grid");
/// Groups and curves: hues that the common colour-vision deficiencies distinguish (after Okabe and Ito, 2008), darkened
/// or lightened to a contrast of at least 4.5 against the ground of each theme.
pub const SERIES: [Color; 7] = [
    color(0x0069A6, 0x5AB4E8, "--plot-1"),
    color(0xB84A00, 0xF39552, "--plot-2"),
    color(0x007A59, 0x3FCBA0, "--plot-3"),
    color(0x9A3B80, 0xE39ACB, "--plot-4"),
    color(0x7A6200, 0xDEC04D, "--plot-5"),
    color(0x4B5875, 0xA9B9DA, "--plot-6"),
    color(0xA6243C, 0xFF9DA8, "--plot-7"),
];

/// All colours.
pub fn palette() -> Vec<Color> {
    [GROUND, INK, FAINT, GRID].into_iter().chain(SERIES).collect()
}

/// A diagram for a page that defines the variables of the [`palette`]: its colours become `var(…)`, and it takes the
/// width of its surroundings.
pub fn themed(svg: &str) -> String {
    let mut svg = svg.to_owned();
    for color in palette() {
        let [r, g, b] = color.light;
        svg = svg.replace(&format!("\"#{r:02X}{g:02X}{b:02X}\""), &format!("\"var({})\"", color.variable));
    }
    for attribute in [" width=\"", " height=\""] {
        // The first of each is the root's.
        if let Some(start) = svg.find(attribute)
            && let Some(length) = svg[start + attribute.len()..].find('"')
        {
            svg.replace_range(start..=start + attribute.len() + length, "");
        }
    }
    svg
}

/// A picture that could not be made from an SVG.
#[derive(Debug, thiserror::Error)]
pub enum PngError {
    /// The text is no SVG.
    #[error("the SVG of a diagram: {0}")]
    Svg(#[from] usvg::Error),
    /// The picture has no pixels or too many.
    #[error("a diagram of {width} × {height} px cannot be rendered")]
    Size {
        /// Px.
        width: u32,
        /// Px.
        height: u32,
    },
    /// The encoder failed.
    #[error("a diagram could not be encoded: {0}")]
    Encode(String),
}

static FONTS: LazyLock<Arc<usvg::fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(notosans::REGULAR_TTF.to_vec());
    fonts.load_font_data(notosans::BOLD_TTF.to_vec());
    fonts.set_sans_serif_family("Noto Sans");
    Arc::new(fonts)
});

/// Parses a diagram with the fonts that it is drawn with.
pub(crate) fn parse(svg: &str) -> Result<usvg::Tree, usvg::Error> {
    usvg::Tree::from_str(svg, &usvg::Options { fontdb: FONTS.clone(), ..usvg::Options::default() })
}

/// The PNG file of a diagram, with `scale` pixels for each CSS pixel.
///
/// # Errors
/// [`PngError`].
pub fn png(svg: &str, scale: f32) -> Result<Vec<u8>, PngError> {
    let tree = parse(svg)?;
    let [width, height] = [tree.size().width(), tree.size().height()].map(|side| (side * scale).round() as u32);
    let mut pixels = Pixmap::new(width, height).ok_or(PngError::Size { width, height })?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| PngError::Encode(error.to_string()))
}

#[cfg(test)]
mod tests;

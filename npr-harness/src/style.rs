//! What a picture looks like, whatever it shows.

use crate::image_ink::{ImageInk, InkScale};
use glam::Vec3;
use npr_imagespace::composite::Composite;
use npr_imagespace::morphology::disc::Disc;
use npr_outline::line_look::LineLook;
use npr_toon::Bands;

/// How surfaces are painted.
#[derive(Clone, Debug, PartialEq)]
pub enum Shade {
    /// Not at all: paper, with only lines on it.
    Paper,
    /// Ambient and diffuse light without bands: the plain renderer that others are timed against.
    Lambert {
        /// What is left where no light falls, 0..=1.
        ambient: f32,
    },
    /// Bands of light.
    Toon(Bands),
}

/// How lines are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lines {
    /// Screen-aligned, antialiased, hidden where their centreline is.
    Fins(LineLook),
    /// As Card & Mitchell printed them, to be compared with.
    Printed {
        /// Width far away, px.
        width_px: f32,
        /// Display-referred colour.
        ink: Vec3,
    },
    /// Found in the image.
    Image(ImageInk),
}

/// A style.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// What `--style` calls it.
    pub name: &'static str,
    /// One line.
    pub about: &'static str,
    /// Display-referred colour of what no surface covers.
    pub paper: Vec3,
    /// How surfaces are painted.
    pub shade: Shade,
    /// How lines are drawn, if they are.
    pub lines: Option<Lines>,
    /// Edges whose faces meet at more than this angle are lines.
    pub crease_angle_rad: f32,
}

/// A warm white.
const PAPER: Vec3 = Vec3::new(0.98, 0.97, 0.94);
/// Not quite black.
const INK: [f32; 4] = [0.10, 0.09, 0.11, 1.0];

fn ink_lines(silhouette_px: f32, crease_px: f32) -> Option<Lines> {
    Some(Lines::Fins(LineLook {
        width_px: npr_outline::line_look::widths_px(silhouette_px, silhouette_px, crease_px, crease_px),
        ink: INK,
    }))
}

fn image_lines(ink: ImageInk) -> Option<Lines> {
    let [r, g, b, opacity] = INK;
    Some(Lines::Image(ImageInk { composite: Composite::Over { color: Vec3::new(r, g, b), opacity }, ..ink }))
}

/// The styles there are; the first is the default.
pub fn styles() -> Vec<Style> {
    let style = |name, about, shade, lines| Style {
        name,
        about,
        paper: PAPER,
        shade,
        lines,
        crease_angle_rad: 45f32.to_radians(),
    };
    let hard = Bands { antialias: false, ..Bands::hard_shading() };
    vec![
        style("cartoon", "banded light, highlight, ink lines", Shade::Toon(Bands::default()), ink_lines(2.0, 1.3)),
        style("toon", "banded light alone", Shade::Toon(Bands::default()), None),
        style("lines", "ink on paper, hidden lines removed", Shade::Paper, ink_lines(1.4, 1.0)),
        style("bold", "two tones and a heavy pen", Shade::Toon(Bands::hard_shading()), ink_lines(4.0, 2.0)),
        style("lambert", "plain diffuse light, no bands, no lines", Shade::Lambert { ambient: 0.25 }, None),
        style(
            "ink-image",
            "banded light, lines found in the image",
            Shade::Toon(Bands::default()),
            image_lines(ImageInk::default()),
        ),
        style(
            "ink-thick",
            "the same at twice the size, widened by a round brush",
            Shade::Toon(Bands::default()),
            image_lines(ImageInk {
                brush: Some(Disc { radius_px: 3.0, antialias: true }),
                scale: InkScale::Double,
                ..ImageInk::default()
            }),
        ),
        style(
            "ink-fine",
            "lines on paper, found at twice the picture's size",
            Shade::Paper,
            image_lines(ImageInk { scale: InkScale::Double, ..ImageInk::default() }),
        ),
        style(
            "artist",
            "lines where an artist painted them, material by material",
            Shade::Toon(Bands::default()),
            image_lines(ImageInk { artist: true, ..ImageInk::default() }),
        ),
        style(
            "printed-bands",
            "the three bands of the 2002 chapter's listing 3, aliased",
            Shade::Toon(Bands::listing_3()),
            None,
        ),
        style(
            "printed-fins",
            "the outline of the 2002 chapter's listing 1, as printed",
            Shade::Toon(hard),
            Some(Lines::Printed { width_px: 2.0, ink: Vec3::ZERO }),
        ),
    ]
}

/// The style of a name.
pub fn style(name: &str) -> Option<Style> {
    styles().into_iter().find(|style| style.name == name)
}

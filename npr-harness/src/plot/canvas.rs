//! Lines, marks and text on an SVG.

use super::{Color, GROUND};
use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::{
    Circle, DrawingArea, IntoDrawingArea, PathElement, Polygon, RGBAColor, Rectangle, SVGBackend, ShapeStyle, Text,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, IntoFont, TextStyle};
use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};

/// Units of the drawing for each CSS pixel.
const UNITS: f64 = 16.0;
/// The height of a line of text for each pixel of its size.
pub const LINE_HEIGHT: f64 = 1.25;
/// Common sans-serif fonts are up to this much wider than Noto Sans.
const WIDER: f64 = 1.08;

/// Where the position of a text lies within it; vertically it is the middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    Left,
    Middle,
    Right,
}

/// The shapes of marks, one for each group.
const SHAPES: usize = 6;

/// A drawing.
pub struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

fn unit(px: f64) -> i32 {
    (px * UNITS).round() as i32
}

fn units((x, y): (f64, f64)) -> (i32, i32) {
    (unit(x), unit(y))
}

fn rgba(color: Color, opacity: f64) -> RGBAColor {
    let [r, g, b] = color.light;
    RGBAColor(r, g, b, opacity)
}

fn stroke(color: Color, width_px: f64) -> ShapeStyle {
    ShapeStyle { color: rgba(color, 1.0), filled: false, stroke_width: unit(width_px).unsigned_abs() }
}

/// Draws a picture of the given size, px, and returns its SVG.
pub fn draw((width, height): (f64, f64), content: impl FnOnce(&Canvas<'_>)) -> String {
    let mut svg = String::new();
    {
        let size = (unit(width).unsigned_abs(), unit(height).unsigned_abs());
        let canvas = Canvas { area: SVGBackend::with_string(&mut svg, size).into_drawing_area() };
        canvas.rectangle((0.0, 0.0), (width, height), GROUND);
        content(&canvas);
        // Text in memory cannot fail to be written.
        let _ = canvas.area.present();
    }
    // The backend's size is in units of the drawing.
    let end = svg.find(" viewBox").unwrap_or(0);
    let start = svg.find(" width").unwrap_or(0);
    svg.replace_range(start..end, &format!(" width=\"{width}\" height=\"{height}\""));
    svg
}

impl Canvas<'_> {
    /// A filled rectangle.
    pub fn rectangle(&self, from: (f64, f64), to: (f64, f64), color: Color) {
        let _ = self.area.draw(&Rectangle::new([units(from), units(to)], rgba(color, 1.0).filled_shape()));
    }

    /// An open line through points.
    pub fn line(&self, points: &[(f64, f64)], color: Color, width_px: f64) {
        let points: Vec<_> = points.iter().copied().map(units).collect();
        let _ = self.area.draw(&PathElement::new(points, stroke(color, width_px)));
    }

    /// A dashed line through points.
    pub fn dashed(&self, points: &[(f64, f64)], color: Color, width_px: f64) {
        let points: Vec<_> = points.iter().copied().map(units).collect();
        let _ = self.area.draw(&DashedPathElement::new(points, unit(5.0), unit(4.0), stroke(color, width_px)));
    }

    /// Text at `size_px`; its middle is at the height of `at`.
    pub fn text(&self, text: &str, at: (f64, f64), size_px: f64, color: Color, align: Align, bold: bool) {
        let horizontal = match align {
            Align::Left => HPos::Left,
            Align::Middle => HPos::Center,
            Align::Right => HPos::Right,
        };
        let style = if bold { FontStyle::Bold } else { FontStyle::Normal };
        // The backend divides sizes by 1.24.
        let font = ("sans-serif", size_px * UNITS * 1.24, style).into_font();
        let color = rgba(color, 1.0);
        let style = TextStyle::from(font).color(&color).pos(Pos::new(horizontal, VPos::Center));
        let _ = self.area.draw(&Text::new(text.to_owned(), units(at), style));
    }

    /// The mark of a group, solid or hollow.
    pub fn mark(&self, group: usize, (x, y): (f64, f64), radius_px: f64, color: Color, hollow: bool) {
        let fill = rgba(if hollow { GROUND } else { color }, 1.0).filled_shape();
        let outline = if hollow { stroke(color, 1.8) } else { stroke(GROUND, 1.0) };
        let corners: &[(f64, f64)] = match group % SHAPES {
            0 => {
                let at = units((x, y));
                let _ = self.area.draw(&Circle::new(at, unit(radius_px), fill));
                let _ = self.area.draw(&Circle::new(at, unit(radius_px), outline));
                return;
            }
            1 => &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
            2 => &[(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)],
            3 => &[(0.0, -1.25), (1.25, 0.0), (0.0, 1.25), (-1.25, 0.0)],
            4 => &[(0.0, 1.2), (1.1, -0.8), (-1.1, -0.8)],
            _ => &[
                (-0.4, -1.1),
                (0.4, -1.1),
                (0.4, -0.4),
                (1.1, -0.4),
                (1.1, 0.4),
                (0.4, 0.4),
                (0.4, 1.1),
                (-0.4, 1.1),
                (-0.4, 0.4),
                (-1.1, 0.4),
                (-1.1, -0.4),
                (-0.4, -0.4),
            ],
        };
        let corners: Vec<_> = corners.iter().map(|(dx, dy)| units((x + dx * radius_px, y + dy * radius_px))).collect();
        let _ = self.area.draw(&Polygon::new(corners.clone(), fill));
        let closed: Vec<_> = corners.iter().chain(corners.first()).copied().collect();
        let _ = self.area.draw(&PathElement::new(closed, outline));
    }
}

trait Filled {
    fn filled_shape(self) -> ShapeStyle;
}

impl Filled for RGBAColor {
    fn filled_shape(self) -> ShapeStyle {
        ShapeStyle { color: self, filled: true, stroke_width: 0 }
    }
}

/// The width of a text, px, with room for a browser's own font.
pub fn text_width(text: &str, size_px: f64, bold: bool) -> f64 {
    let font = if bold { notosans::BOLD_TTF } else { notosans::REGULAR_TTF };
    let Ok(font) = FontRef::new(font) else { return text.chars().count() as f64 * size_px * 0.6 };
    let metrics = font.glyph_metrics(Size::new(size_px as f32), LocationRef::default());
    let charmap = font.charmap();
    // A character that the font does not have is as wide as a wide one.
    let advance = |c: char| charmap.map(c).and_then(|glyph| metrics.advance_width(glyph)).map_or(size_px, f64::from);
    text.chars().map(advance).sum::<f64>() * WIDER
}

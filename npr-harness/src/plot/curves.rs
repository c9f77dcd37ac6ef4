//! Curves of one quantity over another, with the limits at which something fails.

use super::Axis;
use super::canvas::{Align, LINE_HEIGHT, draw, text_width};
use super::labels::Box2;
use super::scale::Scale;
use super::scatter::{axes, series};
use super::{FAINT, INK};

/// A diagram of curves.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    /// The title; empty for none.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The name.
    pub name: String,
    /// Its points, by ascending horizontal value. It is interrupted where a value is not finite.
    pub points: Vec<(f64, f64)>,
    /// The horizontal value of the measured limit: a solid vertical line.
    pub measured: Option<f64>,
    /// That of the predicted limit: a dashed one.
    pub predicted: Option<f64>,
}

const WIDTH: f64 = 720.0;
const PLOT_HEIGHT: f64 = 320.0;
const LEFT: f64 = 72.0;
const RIGHT: f64 = 20.0;
const MARGIN: f64 = 16.0;
const TITLE_PX: f64 = 17.0;
const TEXT_PX: f64 = 13.0;
const LABEL_PX: f64 = 12.0;
const MARK_PX: f64 = 3.6;
/// The height of a row of values above the plot.
const LABEL_ROW: f64 = 16.0;
/// Curves with more points than this have no marks.
const MOST_MARKED: usize = 40;

/// The SVG of a diagram of curves. Limits outside the horizontal range of the points are not drawn.
pub fn curves(diagram: &Curves) -> String {
    let mut top = MARGIN;
    if !diagram.title.is_empty() {
        top += TITLE_PX * LINE_HEIGHT + 6.0;
    }
    let legend = legend(diagram, &mut top);
    let sides = (LEFT, WIDTH - RIGHT);
    let all = || diagram.curves.iter().flat_map(|curve| &curve.points);
    let x = Scale::new(&diagram.x, all().map(|point| point.0), sides);
    let values = limit_values(diagram, &x);
    let rows = values.iter().map(|value| value.row + 1).max().unwrap_or(0);
    let values_px = rows as f64 * LABEL_ROW;
    // The title of the vertical axis, and the values of the limits above the plot.
    top += 14.0 + 16.0 + values_px;
    let plot = Box2 { left: sides.0, top, right: sides.1, bottom: top + PLOT_HEIGHT };
    let y = Scale::new(&diagram.y, all().map(|point| point.1), (plot.bottom, plot.top));
    draw((WIDTH, plot.bottom + 58.0), |canvas| {
        if !diagram.title.is_empty() {
            let at = (MARGIN, MARGIN + 0.5 * TITLE_PX * LINE_HEIGHT);
            canvas.text(&diagram.title, at, TITLE_PX, INK, Align::Left, true);
        }
        axes(canvas, [&diagram.x, &diagram.y], [&x, &y], plot, plot.top - 16.0 - values_px);
        for entry in &legend {
            let (left, y) = entry.at;
            match entry.kind {
                Kind::Curve(number) => {
                    canvas.line(&[(left, y), (left + 24.0, y)], series(number), 2.0);
                    canvas.mark(number, (left + 12.0, y), MARK_PX, series(number), false);
                }
                Kind::Measured => canvas.line(&[(left + 12.0, y - 8.0), (left + 12.0, y + 8.0)], FAINT, 1.6),
                Kind::Predicted => canvas.dashed(&[(left + 12.0, y - 9.0), (left + 12.0, y + 9.0)], FAINT, 1.6),
            }
            canvas.text(&entry.text, (left + 32.0, y), TEXT_PX, INK, Align::Left, false);
        }
        for (number, curve) in diagram.curves.iter().enumerate() {
            for (limit, is_measured) in [(curve.measured, true), (curve.predicted, false)] {
                let Some(value) = limit.filter(|value| x.shows(*value)) else { continue };
                let line = [(x.at(value), plot.top), (x.at(value), plot.bottom)];
                if is_measured {
                    canvas.line(&line, series(number), 1.6);
                } else {
                    canvas.dashed(&line, series(number), 1.6);
                }
            }
        }
        for (number, curve) in diagram.curves.iter().enumerate() {
            // A curve that later ones coincide with is wider than these.
            let coinciding =
                diagram.curves[number + 1..].iter().filter(|later| coincide(&curve.points, &later.points, &x, &y));
            let wider = 3.0 * coinciding.count() as f64;
            let is_finite = |point: &(f64, f64)| point.0.is_finite() && point.1.is_finite();
            for part in curve.points.split(|point| !is_finite(point)) {
                let positions: Vec<_> = part.iter().map(|point| (x.at(point.0), y.at(point.1))).collect();
                canvas.line(&positions, series(number), 2.0 + wider);
                if curve.points.len() <= MOST_MARKED || positions.len() == 1 {
                    for at in positions {
                        canvas.mark(number, at, MARK_PX + 0.7 * wider, series(number), false);
                    }
                }
            }
        }
        for LimitValue { text, center, row, curve } in &values {
            let at = (*center, plot.top - (0.5 + *row as f64) * LABEL_ROW - 2.0);
            canvas.text(text, at, LABEL_PX, series(*curve), Align::Middle, false);
        }
    })
}

/// The value of a limit, above the plot.
struct LimitValue {
    text: String,
    center: f64,
    /// From the plot upwards.
    row: usize,
    curve: usize,
}

/// The values of the limits over their lines, from the left, each in the lowest row that has room.
fn limit_values(diagram: &Curves, x: &Scale) -> Vec<LimitValue> {
    let limits = diagram.curves.iter().enumerate().flat_map(|(n, curve)| [(n, curve.measured), (n, curve.predicted)]);
    let mut values: Vec<(f64, usize)> =
        limits.filter_map(|(n, value)| Some((value?, n))).filter(|(value, _)| x.shows(*value)).collect();
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    // The right ends of the rows.
    let mut ends: Vec<f64> = Vec::new();
    let mut placed = Vec::new();
    for (value, curve) in values {
        let text = super::scale::number(value);
        let width = text_width(&text, LABEL_PX, false) + 6.0;
        let center = x.at(value).clamp(0.5 * width, WIDTH - 0.5 * width);
        let row = ends.iter().position(|end| *end <= center - 0.5 * width).unwrap_or(ends.len());
        if row == ends.len() {
            ends.push(0.0);
        }
        ends[row] = center + 0.5 * width;
        placed.push(LimitValue { text, center, row, curve });
    }
    placed
}

/// Whether two curves lie on each other, within 2 px, at nine tenths of their points or more.
fn coincide(a: &[(f64, f64)], b: &[(f64, f64)], x: &Scale, y: &Scale) -> bool {
    let same = |(a, b): &(&(f64, f64), &(f64, f64))| {
        (x.at(a.0) - x.at(b.0)).abs() < 2.0 && (y.at(a.1) - y.at(b.1)).abs() < 2.0
    };
    let count = a.iter().zip(b).filter(same).count();
    count > 0 && 10 * count >= 9 * a.len().max(b.len())
}

struct Entry {
    at: (f64, f64),
    kind: Kind,
    text: String,
}

enum Kind {
    Curve(usize),
    Measured,
    Predicted,
}

/// The entries of the legend from `top` downwards; moves `top` to below them.
fn legend(diagram: &Curves, top: &mut f64) -> Vec<Entry> {
    let mut kinds: Vec<_> =
        diagram.curves.iter().enumerate().map(|(n, curve)| (Kind::Curve(n), &*curve.name)).collect();
    if diagram.curves.iter().any(|curve| curve.measured.is_some()) {
        kinds.push((Kind::Measured, "measured limit"));
    }
    if diagram.curves.iter().any(|curve| curve.predicted.is_some()) {
        kinds.push((Kind::Predicted, "predicted limit"));
    }
    let mut left = MARGIN;
    let mut entries = Vec::new();
    for (kind, text) in kinds {
        let width = 32.0 + text_width(text, TEXT_PX, false) + 18.0;
        if left > MARGIN && left + width > WIDTH - MARGIN {
            left = MARGIN;
            *top += 22.0;
        }
        entries.push(Entry { at: (left, *top + 10.0), kind, text: text.to_owned() });
        left += width;
    }
    *top += 22.0;
    entries
}

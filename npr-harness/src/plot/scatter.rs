//! Points with error bars, a Pareto front and labels.

use super::canvas::{Align, Canvas, LINE_HEIGHT, draw, text_width};
use super::labels::{Box2, LEADER_PX, Label, Surroundings, place};
use super::scale::Scale;
use super::{Axis, Color, FAINT, GRID, INK, SERIES};

/// A diagram of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Scatter {
    /// The title; empty for none.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// All groups of a set of diagrams, so that each looks the same in every one; more are taken from the points.
    pub groups: Vec<String>,
    /// The points.
    pub points: Vec<Point>,
    /// The indices of the points on the Pareto front, in any order. Small values are better on both axes.
    pub front: Vec<usize>,
}

/// A point.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The name.
    pub label: String,
    /// What its mark and colour stand for.
    pub group: String,
    /// The horizontal value.
    pub x: f64,
    /// The low end of the error bar.
    pub x_low: f64,
    /// The high end of the error bar.
    pub x_high: f64,
    /// The vertical value.
    pub y: f64,
    /// Whether it serves comparison alone: drawn hollow.
    pub historical: bool,
}

const WIDTH: f64 = 960.0;
const PLOT_HEIGHT: f64 = 440.0;
/// The height if points are numbered, which are many.
const TALL_PLOT_HEIGHT: f64 = 620.0;
const LEFT: f64 = 72.0;
const RIGHT: f64 = 24.0;
const MARGIN: f64 = 16.0;
const TITLE_PX: f64 = 17.0;
const TEXT_PX: f64 = 13.0;
const LABEL_PX: f64 = 12.0;
const MARK_PX: f64 = 5.0;
/// With more points than this, only those on the front have their names beside them; the others have numbers, and a
/// table below says which.
const MOST_NAMED: usize = 22;

struct Layout {
    x: Scale,
    y: Scale,
    plot: Box2,
    /// The groups, in the order of their first points.
    groups: Vec<String>,
    marks: Vec<(f64, f64)>,
    legend: Vec<Entry>,
    height: f64,
    /// The text beside each point, and whether it is a name.
    texts: Vec<(String, bool)>,
    /// The numbered names.
    numbered: Vec<String>,
    columns: usize,
}

/// An entry of the legend at its position.
struct Entry {
    at: (f64, f64),
    kind: Kind,
    text: String,
}

enum Kind {
    Group(usize),
    Hollow,
    Front,
}

/// The colour of a group or curve.
pub fn series(number: usize) -> Color {
    SERIES[number % SERIES.len()]
}

fn layout(scatter: &Scatter) -> Layout {
    // In the order of all groups, so that one looks the same in every diagram.
    let mut groups = scatter.groups.clone();
    for point in &scatter.points {
        if !groups.contains(&point.group) {
            groups.push(point.group.clone());
        }
    }
    let is_used = |group: &String| scatter.points.iter().any(|point| point.group == *group);
    let mut top = MARGIN;
    if !scatter.title.is_empty() {
        top += TITLE_PX * LINE_HEIGHT + 6.0;
    }
    let mut kinds: Vec<_> = groups
        .iter()
        .enumerate()
        .filter(|(_, group)| is_used(group))
        .map(|(n, group)| (Kind::Group(n), group.clone()))
        .collect();
    if scatter.points.iter().any(|point| point.historical) {
        kinds.push((Kind::Hollow, "hollow: for comparison only".into()));
    }
    if !scatter.front.is_empty() {
        kinds.push((Kind::Front, "Pareto front".into()));
    }
    let mut legend = Vec::new();
    let mut left = MARGIN;
    for (kind, text) in kinds {
        let width = 24.0 + text_width(&text, TEXT_PX, false) + 18.0;
        if left > MARGIN && left + width > WIDTH - MARGIN {
            left = MARGIN;
            top += 22.0;
        }
        legend.push(Entry { at: (left, top + 10.0), kind, text });
        left += width;
    }
    // The legend's last row, and the title of the vertical axis.
    top += 22.0 + 14.0 + 16.0;
    let is_crowded = scatter.points.len() > MOST_NAMED;
    let plot_height = if is_crowded { TALL_PLOT_HEIGHT } else { PLOT_HEIGHT };
    let plot = Box2 { left: LEFT, top, right: WIDTH - RIGHT, bottom: top + plot_height };
    let xs = scatter.points.iter().flat_map(|point| [point.x, point.x_low, point.x_high]);
    let x = Scale::new(&scatter.x, xs, (plot.left, plot.right));
    let y = Scale::new(&scatter.y, scatter.points.iter().map(|point| point.y), (plot.bottom, plot.top));
    let marks = scatter.points.iter().map(|point| (x.at(point.x), y.at(point.y))).collect();

    let mut numbered: Vec<String> = Vec::new();
    let texts = scatter.points.iter().enumerate().map(|(n, point)| {
        if !is_crowded || scatter.front.contains(&n) {
            return (point.label.clone(), true);
        }
        let number = numbered.iter().position(|name| *name == point.label).unwrap_or_else(|| {
            numbered.push(point.label.clone());
            numbered.len() - 1
        });
        ((number + 1).to_string(), false)
    });
    let texts = texts.collect();
    let widest = numbered.iter().map(|name| 30.0 + text_width(name, LABEL_PX, false)).fold(0.0, f64::max);
    let columns = (((WIDTH - 2.0 * MARGIN) / (widest + 20.0)).floor() as usize).clamp(1, 5);
    let rows = numbered.len().div_ceil(columns);
    let height = plot.bottom + 58.0 + if rows > 0 { rows as f64 * 18.0 + 12.0 } else { 0.0 };
    Layout { x, y, plot, groups, marks, legend, height, texts, numbered, columns }
}

/// The positions of the points' marks in the picture, px from its upper left.
pub fn mark_positions(scatter: &Scatter) -> Vec<(f64, f64)> {
    layout(scatter).marks
}

/// The SVG of a diagram of points. Points whose values are not finite are not drawn.
pub fn scatter(scatter: &Scatter) -> String {
    let layout = layout(scatter);
    draw((WIDTH, layout.height), |canvas| {
        if !scatter.title.is_empty() {
            let at = (MARGIN, MARGIN + 0.5 * TITLE_PX * LINE_HEIGHT);
            canvas.text(&scatter.title, at, TITLE_PX, INK, Align::Left, true);
        }
        axes(canvas, [&scatter.x, &scatter.y], [&layout.x, &layout.y], layout.plot, layout.plot.top - 16.0);
        draw_legend(canvas, &layout);
        let front = front_line(scatter, &layout);
        canvas.line(&front, INK, 1.6);
        let is_drawn = |point: &&Point| point.x.is_finite() && point.y.is_finite();
        for (point, at) in scatter.points.iter().zip(&layout.marks).filter(|(point, _)| is_drawn(point)) {
            let color = series(group_of(&layout, point));
            let (low, high) = bar(point, &layout);
            if high - low > 2.0 * MARK_PX {
                // Many bars would hide the marks.
                let width_px = if layout.numbered.is_empty() { 1.2 } else { 0.6 };
                canvas.line(&[(low, at.1), (high, at.1)], color, width_px);
                for end in [low, high] {
                    canvas.line(&[(end, at.1 - 3.0), (end, at.1 + 3.0)], color, width_px);
                }
            }
        }
        for (point, at) in scatter.points.iter().zip(&layout.marks).filter(|(point, _)| is_drawn(point)) {
            let group = group_of(&layout, point);
            canvas.mark(group, *at, MARK_PX, series(group), point.historical);
        }
        draw_labels(canvas, scatter, &layout, &front);
        draw_numbers(canvas, &layout);
    })
}

fn group_of(layout: &Layout, point: &Point) -> usize {
    layout.groups.iter().position(|group| *group == point.group).unwrap_or(0)
}

/// The ends of a point's error bar, px.
fn bar(point: &Point, layout: &Layout) -> (f64, f64) {
    (layout.x.at(point.x_low.min(point.x)), layout.x.at(point.x_high.max(point.x)))
}

/// The grid, the ticks and the titles of both axes, the horizontal one first; that of the vertical axis at `title_y`.
pub fn axes(canvas: &Canvas<'_>, titles: [&Axis; 2], scales: [&Scale; 2], plot: Box2, title_y: f64) {
    let ([x_axis, y_axis], [x, y]) = (titles, scales);
    for tick in x.ticks(TEXT_PX, false) {
        canvas.line(&[(tick.at, plot.top), (tick.at, plot.bottom)], GRID, 1.0);
        canvas.line(&[(tick.at, plot.bottom), (tick.at, plot.bottom + 4.0)], FAINT, 1.0);
        canvas.text(&tick.text, (tick.at, plot.bottom + 15.0), TEXT_PX, FAINT, Align::Middle, false);
    }
    for tick in y.ticks(TEXT_PX, true) {
        canvas.line(&[(plot.left, tick.at), (plot.right, tick.at)], GRID, 1.0);
        canvas.text(&tick.text, (plot.left - 8.0, tick.at), TEXT_PX, FAINT, Align::Right, false);
    }
    if let Some(zero) = y.zero {
        canvas.dashed(&[(plot.left, zero), (plot.right, zero)], FAINT, 1.0);
    }
    if let Some(zero) = x.zero {
        canvas.dashed(&[(zero, plot.top), (zero, plot.bottom)], FAINT, 1.0);
    }
    canvas.line(&[(plot.left, plot.top), (plot.left, plot.bottom), (plot.right, plot.bottom)], FAINT, 1.0);
    canvas.text(&x_axis.title, (plot.right, plot.bottom + 38.0), TEXT_PX, INK, Align::Right, false);
    canvas.text(&y_axis.title, (MARGIN, title_y), TEXT_PX, INK, Align::Left, false);
}

fn draw_legend(canvas: &Canvas<'_>, layout: &Layout) {
    for Entry { at: (x, y), kind, text } in &layout.legend {
        match kind {
            Kind::Group(number) => canvas.mark(*number, (x + 8.0, *y), MARK_PX, series(*number), false),
            Kind::Hollow => canvas.mark(0, (x + 8.0, *y), MARK_PX, FAINT, true),
            Kind::Front => {
                canvas.line(&[(*x, y - 4.0), (x + 8.0, y - 4.0), (x + 8.0, y + 4.0), (x + 17.0, y + 4.0)], INK, 1.6)
            }
        }
        canvas.text(text, (x + 24.0, *y), TEXT_PX, INK, Align::Left, false);
    }
}

/// The border of what the front dominates, from the upper border of the plot to its right one.
fn front_line(scatter: &Scatter, layout: &Layout) -> Vec<(f64, f64)> {
    let mut corners: Vec<_> = scatter.front.iter().filter_map(|n| layout.marks.get(*n)).copied().collect();
    corners.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.total_cmp(&a.1)));
    let (Some(first), Some(last)) = (corners.first(), corners.last()) else { return Vec::new() };
    let mut line = vec![(first.0, layout.plot.top), *first];
    for pair in corners.windows(2) {
        line.extend([(pair[1].0, pair[0].1), pair[1]]);
    }
    line.push((layout.plot.right, last.1));
    line
}

fn draw_labels(canvas: &Canvas<'_>, scatter: &Scatter, layout: &Layout, front: &[(f64, f64)]) {
    let is_drawn = |n: usize| scatter.points[n].x.is_finite() && scatter.points[n].y.is_finite();
    // The front first, then numbers, which are small and belong near their points, then names from the most crowded.
    let crowd = |n: usize| {
        let (x, y) = layout.marks[n];
        layout.marks.iter().filter(|other| (other.0 - x).abs() < 130.0 && (other.1 - y).abs() < 30.0).count()
    };
    let mut order: Vec<usize> = (0..scatter.points.len()).filter(|n| is_drawn(*n)).collect();
    order.sort_by_key(|n| (!scatter.front.contains(n), layout.texts[*n].1, std::cmp::Reverse(crowd(*n)), *n));
    let labels: Vec<Label> = order
        .iter()
        .map(|n| {
            let size = (text_width(&layout.texts[*n].0, LABEL_PX, false) + 2.0, LABEL_PX * LINE_HEIGHT);
            Label { point: layout.marks[*n], size }
        })
        .collect();
    let bounds = Box2 { left: layout.plot.left + 3.0, right: WIDTH - 4.0, ..layout.plot };
    let placed = place(&labels, &surroundings(scatter, layout, &order, front), bounds);
    for ((n, label), area) in order.iter().zip(&labels).zip(&placed) {
        let Some(area) = area else { continue };
        let nearest = area.nearest(label.point);
        if (nearest.0 - label.point.0).hypot(nearest.1 - label.point.1) > LEADER_PX {
            canvas.line(&[label.point, nearest], FAINT, 0.8);
            let group = group_of(layout, &scatter.points[*n]);
            canvas.mark(group, label.point, MARK_PX, series(group), scatter.points[*n].historical);
        }
    }
    for ((n, label), area) in order.iter().zip(&labels).zip(placed) {
        let Some(area) = area else { continue };
        let (x, y) = area.center();
        // Text begins at the side of the point, so that a browser's narrower font does not leave a gap.
        let (align, x) = if area.left >= label.point.0 {
            (Align::Left, area.left + 1.0)
        } else if area.right <= label.point.0 {
            (Align::Right, area.right - 1.0)
        } else {
            (Align::Middle, x)
        };
        let color = if layout.texts[*n].1 { INK } else { FAINT };
        canvas.text(&layout.texts[*n].0, (x, y), LABEL_PX, color, align, false);
    }
}

/// Marks, error bars and the front, which labels are to leave visible.
fn surroundings(scatter: &Scatter, layout: &Layout, drawn: &[usize], front: &[(f64, f64)]) -> Surroundings {
    let marks = drawn.iter().map(|n| Box2::around(layout.marks[*n], MARK_PX + 2.0, MARK_PX + 2.0)).collect();
    let bars = drawn.iter().map(|n| {
        let (low, high) = bar(&scatter.points[*n], layout);
        [(low, layout.marks[*n].1), (high, layout.marks[*n].1)]
    });
    let segments = bars.chain(front.windows(2).map(|pair| [pair[0], pair[1]])).collect();
    Surroundings { marks, segments }
}

fn draw_numbers(canvas: &Canvas<'_>, layout: &Layout) {
    let rows = layout.numbered.len().div_ceil(layout.columns);
    let column_px = (WIDTH - 2.0 * MARGIN) / layout.columns as f64;
    for (n, name) in layout.numbered.iter().enumerate() {
        let x = MARGIN + (n / rows) as f64 * column_px;
        let y = layout.plot.bottom + 64.0 + (n % rows) as f64 * 18.0;
        canvas.text(&(n + 1).to_string(), (x + 20.0, y), LABEL_PX, FAINT, Align::Right, false);
        canvas.text(name, (x + 28.0, y), LABEL_PX, INK, Align::Left, false);
    }
}

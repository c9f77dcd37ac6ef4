//! Lines, by everything that draws them, against the exact visible lines.
//!
//! All variants are asked for black lines of 1 px at silhouettes, boundaries and creases. True lines are contours,
//! boundaries, creases and the curves where surfaces intersect.

use super::frames::{Candidate, Drawn, candidates, part_of, rows};
use super::{Chart, Lab, Row, Subject};
use crate::camera::{Camera, Projection};
use crate::check::{WITHIN_PX, one_px_style};
use crate::error::HarnessError;
use crate::executor::{Executor, Picture};
use crate::hull_lines::HullLines;
use crate::image_lines::ImageInk;
use crate::printed_fins::PrintedLines;
use crate::scene::Scene;
use crate::shadow::ShadowLines;
use crate::style::{Lines, Style};
use crate::truth::lines::{TrueLines, accuracy, darkness, drawn_centreline, true_intersections, true_lines};
use crate::truth::pieces::{coverage, pieces};
use crate::variant::{Part, RequestedLines, Setup};
use crate::view::View;
use glam::Vec3;
use npr_imagespace::composite::Composite;
use npr_outline::line_style::{LineStyle, widths_px};

pub(super) const CHART: Chart = Chart {
    name: "lines",
    title: "Lines",
    error: F1,
    about: "Black lines of 1 px at silhouettes, boundaries and creases of 45 degrees, against the exact visible ones, \
            intersections of surfaces included. Within 1.5 px; coverage and flicker in shares of full ink.",
    choices: &[],
    run,
};

/// The error of the axis.
pub(super) const F1: &str = "1 - F1";
/// The movement between the pictures of a pan, px.
const PAN_PX: f64 = 0.25;
/// The number of pictures of a pan.
const PAN: usize = 3;

/// The lines that all variants are asked for.
pub(super) fn asked(width_px: f32) -> Setup {
    let width_px = widths_px(width_px, width_px, width_px, 0.0);
    let lines = Lines::edges(LineStyle { width_px, ink: [0.0, 0.0, 0.0, 1.0] });
    Setup { style: one_px_style(lines), samples: 1 }
}

/// The variants of lines, and edge lines with several samples.
fn variants() -> Vec<Candidate> {
    let base = asked(1.0);
    let mut all = candidates(Part::Lines, &base);
    let supersampled: Vec<Candidate> = all
        .iter()
        .filter(|candidate| ["edges", "image, 64 bits"].contains(&candidate.name.as_str()))
        .map(|candidate| Candidate {
            name: format!("{}, 2 x 2 samples", candidate.name),
            setup: Setup { samples: 2, ..candidate.setup.clone() },
            ..candidate.clone()
        })
        .collect();
    all.extend(supersampled);
    all
}

/// The true lines and their coverage in a picture of a pan.
struct Truth {
    camera: Camera,
    lines: TrueLines,
    coverage: Vec<f64>,
}

fn run(lab: &Lab<'_>) -> Result<Vec<Row>, HarnessError> {
    let candidates = variants();
    let mut all = Vec::new();
    for (number, subject) in lab.subjects.iter().enumerate() {
        let truths = pan(subject, lab.size);
        let mut judge = |drawn: &Drawn<'_>| errors(drawn, &truths).map(Some);
        let progress = part_of(lab, number, lab.subjects.len());
        all.extend(rows(CHART.name, lab, subject, &candidates, &mut judge, &progress)?);
    }
    Ok(all)
}

/// 1 − F1 of a style's lines, against the exact ones of the kinds that it draws.
pub(super) fn error_of_style(
    executor: &Executor,
    scene: &Scene,
    view: View,
    setup: &Setup,
    truth: &TrueLines,
) -> Result<f64, HarnessError> {
    let crease_angle_rad = setup.style.crease_angle_rad;
    let style = Style { crease_angle_rad, ..one_px_style(in_black(setup.style.lines)) };
    let view = View { samples: setup.samples, ..view };
    let image = executor.render(&Picture::new(scene, &style, view), &|_| {})?;
    let drawn = drawn_centreline(&darkness(&image), view.size.0, view.size.1);
    Ok(1.0 - accuracy(truth, &drawn, WITHIN_PX).f1)
}

/// The exact lines that a style asks for.
pub(super) fn asked_of_style(scene: &Scene, view: &View, style: &Style) -> TrueLines {
    let flat = scene.flattened();
    let creases = RequestedLines::of(style).is_none_or(|asked| asked.crease_px > 0.0);
    let crease_rad = if creases { f64::from(style.crease_angle_rad) } else { std::f64::consts::PI };
    let mut lines = true_lines(&flat, &view.camera, view.size, crease_rad);
    lines.segments.extend(true_intersections(&flat, &view.camera, view.size, crease_rad).segments);
    lines
}

/// The same lines, black and opaque, without those of shadows.
fn in_black(lines: Lines) -> Lines {
    let composite = Composite::Over { color: Vec3::ZERO, opacity: 1.0 };
    Lines {
        edges: lines.edges.map(|edges| LineStyle { ink: [0.0, 0.0, 0.0, 1.0], ..edges }),
        hull: lines.hull.map(|hull| HullLines { ink: Vec3::ZERO, ..hull }),
        printed: lines.printed.map(|fins| PrintedLines { ink: Vec3::ZERO, ..fins }),
        image: lines.image.map(|ink| ImageInk { composite, shadows: ShadowLines::None, ..ink }),
    }
}

/// Pictures from cameras that move to the right.
fn pan(subject: &Subject, size: (u32, u32)) -> Vec<Truth> {
    let Subject { scene, camera, .. } = subject;
    let style = asked(1.0).style;
    let [right, ..] = camera.axes();
    // World units a pixel at the target.
    let per_px = match camera.projection {
        Projection::Perspective { fov_y_rad } => 2.0 * (fov_y_rad / 2.0).tan() * camera.eye.distance(camera.target),
        Projection::Orthographic { height, .. } => height,
    } / f64::from(size.1);
    let truth = |step: usize| {
        let by = right * (step as f64 * PAN_PX * per_px);
        let camera = Camera { eye: camera.eye + by, target: camera.target + by, ..*camera };
        let lines = asked_of_style(scene, &View::new(camera, size), &style);
        let coverage = coverage(&lines, 1.0);
        Truth { camera, lines, coverage }
    };
    (0..PAN).map(truth).collect()
}

fn errors(drawn: &Drawn<'_>, truths: &[Truth]) -> Result<Vec<(String, f64)>, HarnessError> {
    let size = drawn.view.size;
    let dark = |truth: &Truth| Ok::<_, HarnessError>(darkness(&drawn.image(View::new(truth.camera, size))?));
    let pictures = truths.iter().map(dark).collect::<Result<Vec<_>, _>>()?;
    let (truth, picture) = (&truths[0], &pictures[0]);
    let centreline = drawn_centreline(picture, size.0, size.1);
    let found = accuracy(&truth.lines, &centreline, WITHIN_PX);
    let near = |at: usize| truths.iter().any(|t| t.coverage[at] > 0.0) || pictures.iter().any(|p| p[at] > 0.0);
    let judged: Vec<usize> = (0..picture.len()).filter(|&at| near(at)).collect();
    let mean = |of: &dyn Fn(usize) -> f64| judged.iter().map(|&at| of(at)).sum::<f64>() / judged.len().max(1) as f64;
    let off = mean(&|at| (picture[at] - truth.coverage[at]).powi(2)).sqrt();
    let step = |from: usize| {
        mean(&|at| {
            let change = pictures[from + 1][at] - pictures[from][at];
            let true_change = truths[from + 1].coverage[at] - truths[from].coverage[at];
            (change - true_change).abs()
        })
    };
    let flicker = (0..PAN - 1).map(step).sum::<f64>() / (PAN - 1) as f64;
    let (drawn_pieces, true_pieces) = (pieces(picture, size), pieces(&truth.coverage, size));
    Ok([
        (F1, 1.0 - found.f1),
        ("1 - precision", 1.0 - found.precision),
        ("1 - recall", 1.0 - found.recall),
        ("coverage, RMSE", off),
        ("flicker", flicker),
        ("pieces for each true one", drawn_pieces.count as f64 / true_pieces.count.max(1) as f64),
        ("ink in pieces under 6 px", drawn_pieces.short_share),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .into())
}

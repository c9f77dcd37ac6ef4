//! Edge lines on the CPU: the same segments, coverage and visibility as on the GPU, in f64.

use super::plan::EdgeLinePlan;
use crate::cpu::frame::{CpuFrame, Veils};
use crate::scene::{Mesh, Object, Scene};
use crate::view::View;
use glam::{DVec2, DVec3};
use npr_outline::contour::ContourEdges;
use npr_outline::line_style::LineStyle;
use npr_outline::segment::{
    ScreenSegment, outline_coverage, outline_is_visible, outline_project, outline_share_through,
};

/// Draws lines over `frame`, which has all samples of the view. `shift_px` is the offset of its surface samples from
/// the sample centres, in px of the frame. `veils`: of each pixel, the see-through surfaces that dim lines behind them;
/// empty without any.
pub(crate) fn draw_lines(
    plan: &EdgeLinePlan,
    scene: &Scene,
    view: &View,
    shift_px: DVec2,
    veils: &[Veils],
    frame: &mut CpuFrame,
) {
    for (style, objects) in plan.groups(scene) {
        let mut coverage = vec![0.0f64; frame.color.len()];
        for number in objects {
            let (object, mesh) = scene.placed(number);
            let lines = ObjectEdges { object, mesh, contours: &plan.contours[number as usize], style: &style };
            add_coverage(&lines, view, shift_px, veils, frame, &mut coverage);
        }
        let [r, g, b, opacity] = style.ink;
        let ink = DVec3::new(r.into(), g.into(), b.into());
        for (color, coverage) in frame.color.iter_mut().zip(coverage) {
            if coverage > 0.0 {
                let opacity = f64::from(opacity) * coverage;
                *color = color.truncate().lerp(ink, opacity).extend(opacity + color.w * (1.0 - opacity));
            }
        }
    }
}

/// The edges of an object, and the style of its lines.
struct ObjectEdges<'a> {
    object: &'a Object,
    mesh: &'a Mesh,
    contours: &'a ContourEdges,
    style: &'a LineStyle,
}

/// Adds the coverage of each pixel by the visible lines of an object; the largest coverage of any line counts.
fn add_coverage(
    edges: &ObjectEdges<'_>,
    view: &View,
    shift_px: DVec2,
    veils: &[Veils],
    frame: &CpuFrame,
    coverage: &mut [f64],
) {
    let &ObjectEdges { object, mesh, contours, style } = edges;
    let scale = f64::from(view.samples.max(1));
    let eye = object.homogeneous(view.camera.homogeneous_eye());
    let mut lines = Vec::new();
    contours.scan(eye, &mut lines);
    let view = view.camera.line_view(view.sampled_size_px());
    let local_eye = contours.local_eye(eye);
    let last = (i64::from(frame.width) - 1, i64::from(frame.height) - 1);
    let pixel = |x: i64, y: i64| (y.clamp(0, last.1) * (last.0 + 1) + x.clamp(0, last.0)) as usize;
    let depth_at = |x: i64, y: i64| frame.depth[pixel(x, y)];
    for line in lines {
        let edge = line as usize;
        let Some(kind) = contours.kind(edge, local_eye) else { continue };
        let width_px = f64::from(style.width_px[kind as usize]) * scale;
        if width_px <= 0.0 {
            continue;
        }
        let (ends, normals) = placed_edge(object, mesh, contours, edge);
        let Some(segment) = outline_project(ends, normals, width_px, &view) else { continue };
        // Only the depth samples are shifted: coverage is an analytic function of the pixel's position, not a sample.
        let among_samples = ScreenSegment { ends_px: segment.ends_px.map(|end| end - shift_px), ..segment };
        let cut_out = contours.edges[edge].is_cut_out();
        let reach = 0.5 * width_px + 1.0;
        let [p0, p1] = segment.ends_px;
        let (low, high) = ((p0.min(p1) - reach).floor(), (p0.max(p1) + reach).ceil());
        for y in (low.y.max(0.0) as i64)..=(high.y.min(last.1 as f64) as i64) {
            // Only the part of the row near the line, since the bounding box of a long slanted line is mostly empty.
            let (from, to) = row_reach(segment.ends_px, y as f64 + 0.5, reach);
            for x in (low.x.max(from).max(0.0) as i64)..=(high.x.min(to).min(last.0 as f64) as i64) {
                let covered_before = &mut coverage[(y * (last.0 + 1) + x) as usize];
                // The pixel is already fully covered.
                if *covered_before >= 1.0 {
                    continue;
                }
                let point = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let covered = outline_coverage(&segment, point, width_px);
                let fraction = segment.nearest(point);
                if covered > *covered_before && outline_is_visible(&among_samples, fraction, &view, cut_out, depth_at) {
                    let through = match veils {
                        [] => 1.0,
                        _ => {
                            outline_share_through(&among_samples, fraction, &view, depth_at, |x, y| veils[pixel(x, y)])
                        }
                    };
                    *covered_before = covered_before.max(covered * through);
                }
            }
        }
    }
}

/// The ends of an edge in scene space, in the winding order of its first face, and the unit normals of its faces; zero
/// if there is no second face.
pub(crate) fn placed_edge(
    object: &Object,
    mesh: &Mesh,
    contours: &ContourEdges,
    edge: usize,
) -> ([DVec3; 2], [DVec3; 2]) {
    let [from, to] = contours.edges[edge].ends.map(|v| object.point(mesh.model().positions[v as usize]));
    // A reflection keeps the normal on the front side but reverses the winding relative to it.
    let ends = if object.is_mirrored() { [to, from] } else { [from, to] };
    (ends, contours.normals(edge).map(|normal| object.normal(normal)))
}

/// The range of columns in which a row of pixels may be within `reach` of a line, slightly too wide.
fn row_reach([p0, p1]: [DVec2; 2], row: f64, reach: f64) -> (f64, f64) {
    let along = p1 - p0;
    let length = along.length();
    // A nearly horizontal line uses the full width of its bounding box.
    if along.y.abs() <= 1e-3 * length {
        return (f64::NEG_INFINITY, f64::INFINITY);
    }
    let middle = p0.x + (row - p0.y) / along.y * along.x;
    let half = reach * length / along.y.abs() + 1.0;
    (middle - half, middle + half)
}

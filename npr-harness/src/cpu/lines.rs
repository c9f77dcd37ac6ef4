//! Lines on the CPU: the same segments, coverage and visibility as on the device, in f64.

use super::{CpuFrame, FrameContext};
use glam::{DVec2, DVec3, DVec4, Vec3};
use npr_outline::contour::TRAIT_CUT_OUT;
use npr_outline::fin_printed::{fin_printed_triangles, rasterise};
use npr_outline::line_look::LineLook;
use npr_outline::segment::{ScreenSegment, outline_coverage, outline_is_visible, outline_project};

/// Draws the lines of the frame's plan over `frame`. `scale` multiplies their widths.
pub fn draw_lines(context: &FrameContext<'_>, frame: &mut CpuFrame, look: &LineLook, scale: f64) {
    let coverage = line_coverage(context, frame, look, scale);
    let ink = DVec3::new(look.ink[0].into(), look.ink[1].into(), look.ink[2].into());
    for (color, coverage) in frame.color.iter_mut().zip(coverage) {
        if coverage > 0.0 {
            let opacity = f64::from(look.ink[3]) * coverage;
            *color = color.truncate().lerp(ink, opacity).extend(opacity + color.w * (1.0 - opacity));
        }
    }
}

/// Per pixel how much of it visible lines cover, the greatest of any line.
fn line_coverage(context: &FrameContext<'_>, frame: &CpuFrame, look: &LineLook, scale: f64) -> Vec<f64> {
    let mut coverage = vec![0.0f64; frame.color.len()];
    let Some(contours) = &context.plan.contours else { return coverage };
    let eye = context.camera.homogeneous_eye();
    let view = context.camera.line_view(context.size_px);
    let (lines, _) = context.plan.lines(eye);
    let local_eye = contours.local_eye(eye);
    let last = (i64::from(frame.width) - 1, i64::from(frame.height) - 1);
    let depth_at = |x: i64, y: i64| frame.depth[(y.clamp(0, last.1) * (last.0 + 1) + x.clamp(0, last.0)) as usize];
    for line in lines {
        let edge = line as usize;
        let Some(kind) = contours.kind(edge, local_eye) else { continue };
        let width_px = f64::from(look.width_px[kind as usize]) * scale;
        if width_px <= 0.0 {
            continue;
        }
        let ends = contours.ends[edge].map(|v| context.scene.model.positions[v as usize].as_dvec3());
        let normals = contours.normals(edge).map(|n: Vec3| n.as_dvec3());
        let Some(segment) = outline_project(ends, normals, width_px, &view) else { continue };
        // The depth samples move, the coverage does not: it is no sample, but a function of where the pixel is.
        let among_samples = ScreenSegment { ends_px: segment.ends_px.map(|end| end - context.shift_px), ..segment };
        let cut_out = contours.traits[edge] & TRAIT_CUT_OUT != 0;
        let reach = 0.5 * width_px + 1.0;
        let [p0, p1] = segment.ends_px;
        let (low, high) = ((p0.min(p1) - reach).floor(), (p0.max(p1) + reach).ceil());
        for y in (low.y.max(0.0) as i64)..=(high.y.min(last.1 as f64) as i64) {
            // Of the row what can be within reach: of a long slanted line that is little of its box.
            let (from, to) = row_reach(segment.ends_px, y as f64 + 0.5, reach);
            for x in (low.x.max(from).max(0.0) as i64)..=(high.x.min(to).min(last.0 as f64) as i64) {
                let pixel = &mut coverage[(y * (last.0 + 1) + x) as usize];
                // No line covers more.
                if *pixel >= 1.0 {
                    continue;
                }
                let point = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let covered = outline_coverage(&segment, point, width_px);
                if covered > *pixel
                    && outline_is_visible(&among_samples, segment.nearest(point), &view, cut_out, depth_at)
                {
                    *pixel = covered;
                }
            }
        }
    }
    coverage
}

/// Where a row of pixels may be within reach of a line: the columns' range, a little too wide.
fn row_reach([p0, p1]: [DVec2; 2], row: f64, reach: f64) -> (f64, f64) {
    let along = p1 - p0;
    let length = along.length();
    // A line along the row has all of its box.
    if along.y.abs() <= 1e-3 * length {
        return (f64::NEG_INFINITY, f64::INFINITY);
    }
    let middle = p0.x + (row - p0.y) / along.y * along.x;
    let half = reach * length / along.y.abs() + 1.0;
    (middle - half, middle + half)
}

/// Draws the fins of the printed listing over `frame`. They are sampled where the surfaces are, so that a moved sample
/// shows where their aliased borders are sensitive.
pub fn draw_printed(context: &FrameContext<'_>, frame: &mut CpuFrame, width_px: f64, ink: Vec3) {
    let (Some(fins), Some(bounds)) = (&context.plan.printed_fins, context.scene.bounds()) else { return };
    let view = context.camera.fin_view(context.size_px, width_px, bounds);
    // Clip space is 2 w wide and high, and its y points up.
    let moved = DVec2::new(-2.0, 2.0) * context.shift_px / context.size_px;
    let mut triangles = fin_printed_triangles(fins, &view);
    for corner in triangles.iter_mut().flatten() {
        *corner += DVec4::new(moved.x, moved.y, 0.0, 0.0) * corner.w;
    }
    let CpuFrame { width, height, color, depth, .. } = frame;
    let at = |x: u32, y: u32| y as usize * *width as usize + x as usize;
    let ink = ink.as_dvec3().extend(1.0);
    rasterise(&triangles, [*width, *height], |x, y| depth[at(x, y)], |x, y| color[at(x, y)] = ink);
}

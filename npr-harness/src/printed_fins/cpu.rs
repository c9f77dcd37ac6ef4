//! Printed fins on the CPU.

use super::plan::PrintedFinPlan;
use crate::cpu::frame::CpuFrame;
use crate::scene::{ObjectLines, Scene};
use crate::view::View;
use glam::{DVec2, DVec4};
use npr_outline::fin_printed::{fin_printed_triangles, rasterise};

/// Draws the printed fins over `frame`. They are sampled at the surface samples, so that shifted samples show where
/// their aliased borders are sensitive to sampling.
pub(crate) fn draw_printed(plan: &PrintedFinPlan, scene: &Scene, view: &View, shift_px: DVec2, frame: &mut CpuFrame) {
    let (size_px, scale) = (view.sampled_size_px(), f64::from(view.samples.max(1)));
    // Clip space is 2 w wide and high, and its y points up.
    let moved = DVec2::new(-2.0, 2.0) * shift_px / size_px;
    let mut triangles = Vec::new();
    for object in scene.objects().iter().filter(|object| object.lines != ObjectLines::None) {
        let Some(view) = plan.view(scene, object, &view.camera, size_px, scale) else { continue };
        triangles.extend(fin_printed_triangles(&plan.fins[object.mesh()], &view));
    }
    for corner in triangles.iter_mut().flatten() {
        *corner += DVec4::new(moved.x, moved.y, 0.0, 0.0) * corner.w;
    }
    let CpuFrame { width, height, color, depth, .. } = frame;
    let at = |x: u32, y: u32| y as usize * *width as usize + x as usize;
    let ink = plan.style.ink.as_dvec3().extend(1.0);
    rasterise(&triangles, [*width, *height], |x, y| depth[at(x, y)], |x, y| color[at(x, y)] = ink);
}

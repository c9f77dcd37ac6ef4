//! Inverted hulls on the CPU.

use super::plan::HullPlan;
use crate::cpu::frame::CpuFrame;
use crate::scene::Scene;
use crate::view::View;
use glam::{DVec2, DVec4};
use npr_outline::hull::hull_triangles;
use npr_outline::raster::rasterise;
use std::cell::Cell;

/// Draws the hulls over `frame`, where its surfaces do not hide them, and adds their depth. They are sampled at the
/// surface samples, so that shifted samples show where their aliased borders are sensitive to sampling.
pub(crate) fn draw_hulls(plan: &HullPlan, scene: &Scene, view: &View, shift_px: DVec2, frame: &mut CpuFrame) {
    let (size_px, scale) = (view.sampled_size_px(), f64::from(view.samples.max(1)));
    // Clip space is 2 w wide and high, and its y points up.
    let moved = DVec2::new(-2.0, 2.0) * shift_px / size_px;
    let CpuFrame { width, height, color, depth, .. } = frame;
    let at = |x: u32, y: u32| y as usize * *width as usize + x as usize;
    // Read by the depth test and written where it passes.
    let depth = Cell::from_mut(&mut depth[..]).as_slice_of_cells();
    let ink = plan.style.ink.as_dvec3().extend(1.0);
    for object in plan.objects(scene) {
        let mut triangles =
            hull_triangles(&plan.hulls[object.mesh()], &plan.view(object, &view.camera, size_px, scale));
        for corner in triangles.iter_mut().flatten() {
            *corner += DVec4::new(moved.x, moved.y, 0.0, 0.0) * corner.w;
        }
        let visit = |x: u32, y: u32, nearer: f64| {
            color[at(x, y)] = ink;
            depth[at(x, y)].set(nearer);
        };
        rasterise(&triangles, [*width, *height], |x, y| depth[at(x, y)].get(), visit);
    }
}

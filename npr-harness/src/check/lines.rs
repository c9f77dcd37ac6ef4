//! Classification of edges, and widths of lines.

use super::{
    Checker, FORMAT_VIEWS, LARGEST_FORMAT_EDGES, Limit, PLANES_MISCLASSIFIED, SIZE, WIDTH_ERROR, one_px_style,
};
use crate::camera::{Camera, Projection};
use crate::capabilities::Capabilities;
use crate::cpu::{self, CpuOptions};
use crate::error::HarnessError;
#[cfg(feature = "gpu")]
use crate::executor::{Executor, Picture};
use crate::plan::Plan;
use crate::scene::Scene;
use crate::style::Lines;
use crate::truth::lines::darkness;
use crate::truth::width::{triangle, width_in_the_middle};
use crate::view::View;
use glam::{DVec2, DVec3};
use npr_outline::line_style::LineStyle;
use npr_outline::normal_format::{NormalFormat, misclassified_share, misclassified_share_of_planes};

/// The distances of the segments whose width is measured, scene units.
pub(crate) const WIDTH_DISTANCES: [f64; 7] = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0];
/// The widths requested, px.
pub(crate) const WIDTHS_PX: [f32; 4] = [1.0, 2.0, 4.0, 8.0];
/// The slopes of the segments: level, nearly level, and steep.
const RISES: [f64; 3] = [0.0, 0.07, 0.6];

impl Checker<'_> {
    /// Measures how often silhouettes are misclassified, by the format of face normals and by the plane records.
    pub(super) fn formats(&mut self, model: &str, scene: &Scene) -> Result<(), HarnessError> {
        let edges = scene.single().edges().edges.len();
        if edges > LARGEST_FORMAT_EDGES {
            self.skipped.push(format!("formats of {model}: {edges} edges are more than {LARGEST_FORMAT_EDGES}"));
            return Ok(());
        }
        let view = format!("{FORMAT_VIEWS} around");
        for format in NormalFormat::ALL {
            let share = misclassified_share(scene.single().model(), scene.single().edges(), format, FORMAT_VIEWS);
            let metric = match format {
                NormalFormat::F32 => "misclassified share, f32",
                NormalFormat::Snorm16 => "misclassified share, snorm16",
                NormalFormat::Snorm8 => "misclassified share, snorm8",
                NormalFormat::Oct16 => "misclassified share, oct16",
                NormalFormat::Oct8 => "misclassified share, oct8",
            };
            self.add(model, &view, "formats", metric, share, None);
        }
        let share = misclassified_share_of_planes(scene.single().model(), scene.single().edges(), FORMAT_VIEWS)?;
        let limit = Some(Limit::AtMost(PLANES_MISCLASSIFIED));
        self.add(model, &view, "formats", "misclassified share, planes", share, limit);
        Ok(())
    }

    /// Compares the lines that the compute pass finds with those of the scan.
    #[cfg(feature = "gpu")]
    pub(super) fn line_finder(
        &mut self,
        model: &str,
        view: &str,
        scene: &Scene,
        camera: &Camera,
    ) -> Result<(), HarnessError> {
        use crate::edge_lines::EdgeLineMethod;
        use crate::gpu::GpuRenderer;
        use std::collections::BTreeSet;
        let Executor::Gpu(context) = self.executor else { return Ok(()) };
        if !context.usable().can_find_lines() {
            self.skipped.push(format!("line finder of {model}, {view}: {} cannot run it", context.describe()));
            return Ok(());
        }
        let style = one_px_style(Lines::edges(black(1.0)));
        let mut plan = Plan::new(scene, &style, &View::new(*camera, SIZE), &context.usable())?;
        if let Some(edges) = &mut plan.edge_lines {
            edges.method = EdgeLineMethod::OnDevice;
        }
        let renderer = GpuRenderer::new(context);
        let targets = renderer.targets(&plan.view)?;
        let uploaded = renderer.upload(scene, &plan)?;
        renderer.draw(scene, &uploaded, &plan, &targets)?;
        let found = renderer.found_lines(&uploaded)?.unwrap_or_default();
        let on_device: BTreeSet<[u32; 2]> = found.iter().copied().collect();
        let scanned: BTreeSet<[u32; 2]> = plan.lines(scene).0.into_iter().collect();
        // Lines found twice count as errors.
        let wrong = on_device.symmetric_difference(&scanned).count() + (found.len() - on_device.len());
        self.add(model, view, "line finder", "edges in one set only", wrong as f64, Some(Limit::AtMost(0.0)));
        Ok(())
    }

    /// Measures the width of isolated segments in the picture against the width requested.
    pub(super) fn widths(&mut self) -> Result<(), HarnessError> {
        let limit = Some(Limit::AtMost(WIDTH_ERROR));
        let metric = "largest relative error";
        let size = DVec2::new(f64::from(SIZE.0), f64::from(SIZE.1));
        let on_cpu = largest_width_error(size, |scene, width_px, camera| {
            let style = one_px_style(Lines::edges(black(width_px)));
            let plan = Plan::new(scene, &style, &View::new(*camera, SIZE), &Capabilities::RAY_CASTER)?;
            Ok(cpu::render(scene, &plan, &CpuOptions::default(), &|_| {}).image())
        })?;
        self.add("segments", "on the CPU", "width", metric, on_cpu, limit);
        #[cfg(feature = "gpu")]
        if let Executor::Gpu(context) = self.executor {
            // This picture detects a driver that rejects compute shaders although it reports support; the next method
            // is used then.
            let scene = Scene::new(npr_mesh::embedded::cube());
            let style = one_px_style(Lines::edges(black(1.0)));
            let camera = Camera::framed(scene.corners(), 1.0, &Default::default());
            self.executor.render(&Picture::new(&scene, &style, View::new(camera, (16, 16))), &|_| {})?;
            let renderer = crate::gpu::GpuRenderer::new(context);
            let targets = renderer.targets(&View::new(camera, SIZE))?;
            let on_gpu = largest_width_error(size, |scene, width_px, camera| {
                let style = one_px_style(Lines::edges(black(width_px)));
                let plan = Plan::new(scene, &style, &View::new(*camera, SIZE), &context.usable())?;
                let uploaded = renderer.upload(scene, &plan)?;
                renderer.draw(scene, &uploaded, &plan, &targets)?;
                renderer.read(&targets)
            })?;
            self.add("segments", "on the GPU", "width", metric, on_gpu, limit);
        }
        Ok(())
    }
}

fn black(width_px: f32) -> LineStyle {
    LineStyle { width_px: [width_px; 5], ink: [0.0, 0.0, 0.0, 1.0] }
}

/// The largest relative error of the width over all distances, widths and slopes.
fn largest_width_error(
    size_px: DVec2,
    render: impl Fn(&Scene, f32, &Camera) -> Result<crate::picture::Image, HarnessError>,
) -> Result<f64, HarnessError> {
    let camera = Camera {
        eye: DVec3::ZERO,
        target: DVec3::NEG_Z,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y_rad: 1.0 },
        near: 0.1,
    };
    let mut worst = 0.0f64;
    for distance in WIDTH_DISTANCES {
        for rise in RISES {
            // The other two sides leave the ends of the base at large angles, so that they are far from its middle.
            let corners = [[-0.3, -0.3 * rise - 0.11], [0.3, 0.3 * rise - 0.11], [0.0, 0.4]];
            let corners = corners.map(|[x, y]| DVec3::new(x, y, -1.0) * distance);
            let scene = Scene::new(triangle(corners.map(|corner| corner.as_vec3())));
            let clip_from_world = camera.clip_from_world(size_px.x / size_px.y);
            let ends = [corners[0], corners[1]]
                .map(|end| npr_outline::segment::outline_screen(clip_from_world * end.extend(1.0), size_px).0);
            for width_px in WIDTHS_PX {
                let image = render(&scene, width_px, &camera)?;
                let width = width_in_the_middle(&darkness(&image), image.width, ends, f64::from(width_px));
                worst = worst.max((width / f64::from(width_px) - 1.0).abs());
            }
        }
    }
    Ok(worst)
}

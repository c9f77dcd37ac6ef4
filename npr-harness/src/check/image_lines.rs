//! Lines in the image against the exact contours, filter by filter.
//!
//! Numbers without limits: how good a filter can be depends on the model. What they miss, most of it, is creases with
//! one patch on both sides (their share is told), unless the shading normals are split there; what they draw too much
//! is what lies nearer behind than is asked for, borders of coplanar patches, and the third pixel of a line where a
//! surface turns away steeply.

use super::{Checker, SIZE, WITHIN_PX, darkness, one_px_style};
use crate::camera::Camera;
use crate::error::HarnessError;
use crate::image_ink::{ImageInk, Regions};
use crate::line_truth::{
    MOST_FACES_MEETING, TrueLines, TrueSegment, accuracy, drawn_centreline, true_lines, true_lines_of_steps,
    true_meetings,
};
use crate::plan::Plan;
use crate::scene::Scene;
use crate::style::Lines;
use npr_imagespace::filter::depth::ANY_OS;
use npr_imagespace::filter::fused::{DepthTest, FusedFilter};
use npr_outline::LineKind;

/// Silhouettes and boundaries behind which the next surface is nearer than this share of the model's size, the
/// diagonal of its box, are not asked of a filter.
pub const LEAST_STEP: f64 = 0.01;

/// The filters that are compared, the default first.
fn filters() -> [(&'static str, ImageInk); 6] {
    let none = FusedFilter { normal_cos: None, depth: None, regions: false, ..FusedFilter::default() };
    let with = |filter: FusedFilter| ImageInk { filter, ..ImageInk::default() };
    let plain = DepthTest { step: ANY_OS, plain: true };
    [
        ("image lines", ImageInk::default()),
        ("image, normals", with(FusedFilter { normal_cos: FusedFilter::default().normal_cos, ..none })),
        ("image, bends", with(FusedFilter { depth: Some(DepthTest::default()), ..none })),
        ("image, steps", with(FusedFilter { depth: Some(plain), ..none })),
        ("image, patches", with(FusedFilter { regions: true, ..none })),
        ("image, no patch", ImageInk { regions: Regions::One, ..ImageInk::default() }),
    ]
}

impl Checker<'_> {
    /// Precision, recall and F1 of each filter.
    pub(super) fn image_lines(
        &mut self,
        model: &str,
        view: &str,
        scene: &Scene,
        camera: &Camera,
    ) -> Result<(), HarnessError> {
        let crease_angle_rad = f64::from(one_px_style(Lines::Image(ImageInk::default())).crease_angle_rad);
        let least_step = LEAST_STEP * 2.0 * scene.radius();
        let of_edges = true_lines_of_steps(scene, camera, SIZE, crease_angle_rad, least_step);
        let meetings = |least_angle_rad| true_meetings(scene, camera, SIZE, least_angle_rad).segments;
        let with = |lines: &TrueLines, more: Vec<TrueSegment>| TrueLines {
            segments: [lines.segments.as_slice(), &more].concat(),
            ..lines.clone()
        };
        let asked = with(&of_edges, meetings(crease_angle_rad));
        let all = with(&true_lines(scene, camera, SIZE, crease_angle_rad), meetings(0.0));
        if scene.model.faces.len() > MOST_FACES_MEETING {
            self.skipped.push(format!("where surfaces of {model} meet: more than {MOST_FACES_MEETING} faces"));
        }
        let style = one_px_style(Lines::Image(ImageInk::default()));
        let uncarried = uncarried_share(scene, &of_edges, &Plan::new(scene, &style, camera)?);
        self.add(model, view, "image lines", "share of creases within one patch", uncarried, None);
        for (technique, ink) in filters() {
            let style = one_px_style(Lines::Image(ink));
            let plan = Plan::new(scene, &style, camera)?;
            let image = self.executor.render(scene, &style, &plan, camera, SIZE, 1, &|_| {})?;
            let drawn = drawn_centreline(&darkness(&image), SIZE.0, SIZE.1);
            let found = accuracy(&asked, &drawn, WITHIN_PX);
            self.add(model, view, technique, "F1 within 1.5 px", found.f1, None);
            self.add(model, view, technique, "precision within 1.5 px", found.precision, None);
            self.add(model, view, technique, "recall within 1.5 px", found.recall, None);
            let near_any = accuracy(&all, &drawn, WITHIN_PX).precision;
            self.add(model, view, technique, "precision, any step or meeting a line", near_any, None);
            let without = accuracy(&of_edges, &drawn, WITHIN_PX).f1;
            self.add(model, view, technique, "F1, meetings of surfaces no lines", without, None);
        }
        Ok(())
    }
}

/// The share of the lines' length that are creases with one region on both sides: found only if the shading normals
/// say so.
fn uncarried_share(scene: &Scene, lines: &TrueLines, plan: &Plan) -> f64 {
    let Some(image) = &plan.image else { return 0.0 };
    let is_uncarried = |segment: &&TrueSegment| {
        let [first, second] = scene.edges.edges[segment.edge as usize].faces();
        segment.kind == LineKind::Crease
            && image.face_region.get(first as usize) == image.face_region.get(second as usize)
    };
    let length = |segment: &TrueSegment| segment.ends_px[0].distance(segment.ends_px[1]);
    let total: f64 = lines.segments.iter().map(length).sum();
    lines.segments.iter().filter(is_uncarried).map(length).sum::<f64>() / total.max(f64::MIN_POSITIVE)
}

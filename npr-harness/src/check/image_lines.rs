//! Image-space lines against the exact contours, filter by filter.
//!
//! The default filter has a limit on the models of docs/accuracy.md and recorded limits on some others. The other
//! values have no limits, because the quality of a filter depends on the model. Most missed lines are creases with one
//! region on both sides (their fraction is reported), unless the shading normals are split there. Spurious lines are
//! depth steps smaller than [`LEAST_STEP`], borders between coplanar regions, and the third pixel of a line where a
//! surface curves away steeply.

use super::{Checker, Limit, SIZE, WITHIN_PX, one_px_style};
use crate::camera::Camera;
use crate::capabilities::Capabilities;
use crate::cpu::{self, CpuOptions};
use crate::error::HarnessError;
use crate::executor::Picture;
use crate::image_lines::{ImageInk, Regions};
use crate::plan::Plan;
use crate::scene::Scene;
use crate::style::Lines;
use crate::truth::lines::{
    MOST_FACES_INTERSECTED, TrueLines, TrueSegment, accuracy, darkness, drawn_centreline, scene_edge,
    true_intersections, true_lines, true_lines_of_steps,
};
use crate::view::View;
use glam::UVec2;
use npr_imagespace::filter::depth::{DEPTH_ANY_OUTLINING_SKETCH, DEPTH_SUM_CARD_MITCHELL, DepthPlain};
use npr_imagespace::filter::fused::{DepthTest, FusedFilter};
use npr_imagespace::filter::inker::{Inker, InkerForm};
use npr_imagespace::filter::normal::NORMAL_COS_CARD_MITCHELL;
use npr_imagespace::filter::printed::{
    PrintedDepth, PrintedEdges, PrintedFilter, PrintedNormal, PrintedUniform, ink_printed_edges, ink_printed_inker,
};
use npr_imagespace::format::printed::{CLEAR, CLEAR_PRINTED, ink_printed_encode};
use npr_imagespace::format::texel::{TexelLayout, ink_texel64_tap};
use npr_imagespace::picture::{Taps, filter_picture};
use npr_mesh::edges::NO_FACE;
use npr_outline::LineKind;

/// Silhouettes and boundaries whose next surface behind is nearer than this, relative to the diagonal of the model's
/// bounding box, are not required of a filter.
pub(crate) const LEAST_STEP: f64 = 0.01;

/// The least F1 of the default filter, by the model's file name: 0.95 on the models of docs/accuracy.md, elsewhere the
/// recorded value, rounded down.
pub(crate) const LEAST_F1: [(&str, f64); 11] = [
    ("stanford-bunny.obj", 0.95),
    ("fandisk.obj", 0.95),
    ("rocker-arm.obj", 0.95),
    ("teapot.obj", 0.95),
    ("2CylinderEngine.glb", 0.95),
    ("CesiumMilkTruck.glb", 0.95),
    ("suzanne.obj", 0.88),
    ("spot.obj", 0.96),
    ("Duck.glb", 0.92),
    ("Fox.glb", 0.92),
    ("beetle-alt.obj", 0.98),
];

/// The name of the default filter, the first of [`filters`].
const DEFAULT: &str = "image lines";

/// The filters that are compared, the default first.
fn filters() -> [(&'static str, ImageInk); 6] {
    let none = FusedFilter { normal_cos: None, depth: None, regions: false, ..FusedFilter::default() };
    let with = |filter: FusedFilter| ImageInk { filter, ..ImageInk::default() };
    let plain = DepthTest { step: DEPTH_ANY_OUTLINING_SKETCH, plain: true };
    [
        (DEFAULT, ImageInk::default()),
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
        (scene, flat): (&Scene, &Scene),
        camera: &Camera,
    ) -> Result<(), HarnessError> {
        let crease_angle_rad = f64::from(one_px_style(Lines::image(ImageInk::default())).crease_angle_rad);
        let view_of = View::new(*camera, SIZE);
        let least_step = LEAST_STEP * 2.0 * scene.radius();
        let of_edges = true_lines_of_steps(flat, camera, SIZE, crease_angle_rad, least_step);
        let intersections = |least_angle_rad| true_intersections(flat, camera, SIZE, least_angle_rad).segments;
        let with = |lines: &TrueLines, more: Vec<TrueSegment>| TrueLines {
            segments: [lines.segments.as_slice(), &more].concat(),
            ..lines.clone()
        };
        let asked = with(&of_edges, intersections(crease_angle_rad));
        let all = with(&true_lines(flat, camera, SIZE, crease_angle_rad), intersections(0.0));
        if scene.face_count() > MOST_FACES_INTERSECTED {
            self.skipped
                .push(format!("intersections of surfaces of {model}: more than {MOST_FACES_INTERSECTED} faces"));
        }
        let style = one_px_style(Lines::image(ImageInk::default()));
        let uncarried =
            uncarried_share(flat, &of_edges, &Plan::new(flat, &style, &view_of, &Capabilities::RAY_CASTER)?);
        self.add(model, view, "image lines", "share of creases within one patch", uncarried, None);
        let judge = |checker: &mut Self, technique: &'static str, darkness: &[f64]| {
            let drawn = drawn_centreline(darkness, SIZE.0, SIZE.1);
            let found = accuracy(&asked, &drawn, WITHIN_PX);
            let least = LEAST_F1.iter().find(|(name, _)| technique == DEFAULT && *name == model);
            let limit = least.map(|&(_, least)| Limit::AtLeast(least));
            checker.add(model, view, technique, "F1 within 1.5 px", found.f1, limit);
            checker.add(model, view, technique, "precision within 1.5 px", found.precision, None);
            checker.add(model, view, technique, "recall within 1.5 px", found.recall, None);
            let near_any = accuracy(&all, &drawn, WITHIN_PX).precision;
            checker.add(model, view, technique, "precision, any step or intersection a line", near_any, None);
            let without = accuracy(&of_edges, &drawn, WITHIN_PX).f1;
            checker.add(model, view, technique, "F1, intersections are no lines", without, None);
        };
        for (technique, ink) in filters() {
            let style = one_px_style(Lines::image(ink));
            let picture = Picture::new(scene, &style, view_of);
            let Some((image, _)) = self.render(model, view, technique, &picture)? else { continue };
            judge(self, technique, &darkness(&image));
        }
        let plan = Plan::new(scene, &style, &view_of, &Capabilities::RAY_CASTER)?;
        let texels = cpu::render(scene, &plan, &CpuOptions::default(), &|_| {}).texels;
        for (technique, filter, clear) in printed_filters() {
            judge(self, technique, &printed_ink(&texels, &plan, &filter, clear)?);
        }
        Ok(())
    }
}

/// The filters of 2002 on their original RGBA8 target, as printed and corrected, and the clear colour of the target.
fn printed_filters() -> [(&'static str, PrintedFilter, [u8; 4]); 4] {
    let corrected = PrintedEdges::default();
    let printed = PrintedEdges {
        normal: Some(PrintedNormal { cos: NORMAL_COS_CARD_MITCHELL, printed_background: true }),
        depth: Some(PrintedDepth { form: DepthPlain::SumPrinted, threshold: DEPTH_SUM_CARD_MITCHELL }),
        taps: Taps::Diagonal,
        co_issued: None,
    };
    let inker = |form| PrintedFilter::Inker(Inker { form, ..Inker::default() });
    [
        ("2002, printed", PrintedFilter::Edges(printed), CLEAR_PRINTED),
        ("2002, corrected", PrintedFilter::Edges(corrected), CLEAR),
        ("inker, printed", inker(InkerForm::Printed), CLEAR),
        ("inker, corrected", inker(InkerForm::Explicit), CLEAR),
    ]
}

/// The ink of a printed filter, 0..=1, from packed texels whose depths lie within the code's range.
fn printed_ink(
    texels: &[[u32; 2]],
    plan: &Plan,
    filter: &PrintedFilter,
    clear: [u8; 4],
) -> Result<Vec<f64>, HarnessError> {
    let Some(image) = &plan.image else { return Ok(vec![0.0; texels.len()]) };
    let depth = |code: u32| image.code.depth(code);
    let (near, far) = (depth(TexelLayout::Bits64.depth_max()), depth(0));
    let bytes: Vec<[u8; 4]> = texels
        .iter()
        .map(|&words| {
            let tap = ink_texel64_tap(words);
            if tap.region == 0 {
                return clear;
            }
            let fraction = (depth(tap.depth as u32) - near) / (far - near);
            ink_printed_encode(tap.normal.as_vec3().normalize_or_zero(), fraction as f32)
        })
        .collect();
    let size_px = UVec2::from(SIZE);
    let ink = match filter {
        PrintedFilter::Edges(edges) => {
            let uniform = PrintedUniform::new(edges)?;
            filter_picture(&bytes, size_px, edges.taps, |centre, taps| {
                f32::from(u8::from(ink_printed_edges(edges, &uniform, centre, taps)))
            })?
        }
        PrintedFilter::Inker(inker) => {
            filter_picture(&bytes, size_px, Taps::Diagonal, |_, taps| ink_printed_inker(inker, taps) as f32)?
        }
    };
    Ok(ink.into_iter().map(|ink| f64::from(ink) / 255.0).collect())
}

/// The fraction of the lines' length that are creases with one region on both sides, which are found only if the
/// shading normals differ.
fn uncarried_share(scene: &Scene, lines: &TrueLines, plan: &Plan) -> f64 {
    let Some(image) = &plan.image else { return 0.0 };
    let is_uncarried = |segment: &&TrueSegment| {
        // Lines of the file have no edge.
        if segment.kind != LineKind::Crease {
            return false;
        }
        let [first, second] = scene_edge(scene, segment.edge).faces();
        second != NO_FACE && image.regions.of_face(scene, 0, first) == image.regions.of_face(scene, 0, second)
    };
    let length = |segment: &TrueSegment| segment.ends_px[0].distance(segment.ends_px[1]);
    let total: f64 = lines.segments.iter().map(length).sum();
    lines.segments.iter().filter(is_uncarried).map(length).sum::<f64>() / total.max(f64::MIN_POSITIVE)
}

//! Flicker of lines over a slow pan.

use crate::camera::Camera;
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::hull_lines::HullLines;
use crate::image_lines::ImageInk;
use crate::image_lines::gbuffer::style::GBuffer;
use crate::printed_fins::PrintedLines;
use crate::scene::Scene;
use crate::stability::ink::{beside, black_edges, curve, enlarged, ink, limit, parallel, picture_of};
use crate::stability::{Axis, Finding, Sweep};
use crate::style::Lines;
use crate::view::View;
use glam::{DVec3, Vec3};
use npr_imagespace::filter::fused::FusedFilter;
use npr_mesh::embedded;
use npr_outline::hull::HullNormals;

pub(super) const FLICKER: Sweep = Sweep {
    name: "line-flicker",
    technique: "line flicker",
    what: "A line without coverage moves by whole pixels: from frame to frame a few of its pixels flip from paper to ink \
           and back, where coverage changes all of them a little.",
    needs_adapter: false,
    run: flicker,
};

const SIZE: (u32, u32) = (112, 84);
/// The smallest step of the pan, px.
const STEP_PX: f64 = 1.0 / 16.0;
/// Frames of the smallest step: 1.5 px.
const FRAMES: usize = 25;

/// The root mean square of the change of pixels from frame to frame, over the ink of a frame: 1 where as many pixels flip
/// as have ink.
fn change(frames: &[Vec<f64>], step: usize) -> f64 {
    let (mut changed, mut drawn) = (0.0, 0.0);
    for pair in frames.windows(step + 1) {
        let (before, after) = (&pair[0], &pair[step]);
        changed += before.iter().zip(after).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        drawn += before.iter().sum::<f64>();
    }
    (changed / drawn).sqrt()
}

fn flicker(executor: &Executor) -> Result<Finding, HarnessError> {
    // A ring, whose contours have all directions.
    let scene = Scene::new(embedded::torus(1.0, 0.35, 64, 32));
    let height = 2.4;
    let tilted = Camera { eye: DVec3::new(0.0, 80.0, 60.0), ..parallel(height) };
    let px = height / f64::from(SIZE.1);
    let shifted = |frame: usize| {
        let by = DVec3::X * (STEP_PX * frame as f64 * px);
        Camera { eye: tilted.eye + by, target: tilted.target + by, ..tilted }
    };
    let soft = FusedFilter { softness: 0.39, ..FusedFilter::default() };
    let fins = Lines::printed(PrintedLines { width_px: 2.0, ..PrintedLines::default() });
    let hull = Lines::hull(HullLines { width_px: 2.0, ink: Vec3::ZERO, normals: HullNormals::Welded });
    let methods = [
        ("edge lines, 8 × 8 samples", black_edges(2.0), 8),
        ("edge lines", black_edges(2.0), 1),
        ("fins as printed", fins, 1),
        ("inverted hull", hull, 1),
        ("image lines", Lines::image(ImageInk::default()), 1),
        ("image lines, soft", Lines::image(ImageInk { filter: soft, ..ImageInk::default() }), 1),
        ("printed filters", Lines::image(ImageInk { gbuffer: Some(GBuffer::default()), ..ImageInk::default() }), 1),
    ];
    let steps = [1usize, 2, 4, 8, 16];
    let (mut curves, mut pictures) = (Vec::new(), Vec::new());
    let mut smooth = 1.0;
    for (name, lines, samples) in methods {
        // The supersampled lines change smoothly, so that fewer of their frames do.
        let frames = if samples > 1 { 3 } else { FRAMES };
        let render = |frame: usize| ink(executor, &scene, lines, View { samples, ..View::new(shifted(frame), SIZE) });
        let frames = (0..frames).map(render).collect::<Result<Vec<_>, _>>()?;
        let points: Vec<(f64, f64)> = steps
            .iter()
            .filter(|&&step| step < frames.len())
            .map(|&step| (STEP_PX * step as f64, 100.0 * change(&frames, step)))
            .collect();
        let measured = points[0].1;
        let what = "change of pixels at 1/16 px a frame, root mean square over the ink, %";
        let of = |bound: f64| limit(what, measured, Bound::AtMost(bound));
        // Where a line of a width moves by s across itself, two pixels of s a px of its length change: all of their ink
        // without coverage, and by s with it.
        let flips = |width_px: f64| {
            let across = 2.0 / std::f64::consts::PI;
            100.0 * (2.0 * STEP_PX * across / width_px).sqrt()
        };
        let formula = "√(2 s · 2/π / width): the pixels that flip at both borders of a line whose direction is any";
        let limit = match name {
            "edge lines, 8 × 8 samples" => {
                smooth = measured;
                of(4.4).predicted(
                    100.0 * STEP_PX * (2.0f64 * 0.5 / 2.0).sqrt(),
                    "s √(2 · ½ / width): both borders change by s, all directions alike",
                )
            }
            "edge lines" => of(1.2 * smooth),
            "fins as printed" | "inverted hull" => of(20.5).predicted(flips(2.0), formula),
            "image lines" => of(16.5).predicted(flips(2.0), formula),
            "printed filters" => of(14.0).predicted(flips(2.0), formula),
            _ => of(12.0),
        };
        curves.push(curve(name, points, limit));
        if ["edge lines", "inverted hull", "image lines"].contains(&name) {
            // The change between two frames, a quarter of a px apart.
            let changed: Vec<u8> =
                frames[0].iter().zip(&frames[4]).map(|(a, b)| (255.0 * (a - b).abs()).round() as u8).collect();
            pictures.push(enlarged(&picture_of(&changed, SIZE.0), [6, 4, 50, 76], 2));
        }
    }
    Ok(Finding {
        parameter: Axis::logarithmic("pan from frame to frame", "px"),
        error: Axis::logarithmic("change of pixels, root mean square over the ink", "%"),
        curves,
        pictures: vec![(
            "What changes when a ring moves by a quarter of a px, enlarged twice: edge lines, inverted hull, image lines."
                .into(),
            beside(&pictures),
        )],
    })
}

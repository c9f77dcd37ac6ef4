//! Contours of noisy surfaces, which come apart into fragments.

use crate::check::{Limit as Bound, WITHIN_PX};
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::picture::Image;
use crate::scene::Scene;
use crate::stability::ink::{Random, beside, crossing, curve, drawn, limit, limit_at, parallel, worst};
use crate::stability::{Axis, Finding, Sweep};
use crate::style::Lines;
use crate::truth::lines::darkness;
use crate::view::View;
use glam::DVec2;
use npr_mesh::{Model, embedded};
use npr_outline::line_style::LineStyle;

pub(super) const CONTOUR_NOISE: Sweep = Sweep {
    name: "contour-noise",
    technique: "lines from edges",
    what: "Near the contour of a scanned surface noise tilts faces to and from the viewer, and each of their borders is a \
           silhouette: the contour is lost among fragments.",
    needs_adapter: false,
    run: contour_noise,
};

const SEGMENTS: u32 = 96;
const SIZE_PX: u32 = 240;
/// The height of the picture, for a ball of radius 1.
const HEIGHT: f64 = 2.4;
/// Pieces of ink whose box is smaller than this are fragments, px.
const FRAGMENT_PX: u32 = 6;

/// A ball whose vertices are moved along their radius by up to a share of the length of an edge at the equator.
fn noisy_ball(share: f64) -> Model {
    let mut ball = embedded::sphere(SEGMENTS);
    let mut random = Random(8);
    let edge = std::f64::consts::TAU / f64::from(SEGMENTS);
    for position in &mut ball.positions {
        *position *= (1.0 + share * edge * (2.0 * random.unit() - 1.0)) as f32;
    }
    ball
}

/// The share of the ink that is in pieces whose boxes are smaller than [`FRAGMENT_PX`]; pieces are connected over sides
/// and corners of pixels.
fn fragment_share(ink: &[f64], width: u32) -> f64 {
    const LEAST: f64 = 0.25;
    let height = ink.len() as u32 / width;
    let mut seen: Vec<bool> = ink.iter().map(|&ink| ink < LEAST).collect();
    let (mut all, mut fragments) = (0u32, 0u32);
    for start in 0..ink.len() {
        if seen[start] {
            continue;
        }
        seen[start] = true;
        let (mut waiting, mut count) = (vec![start as u32], 0);
        let (mut low, mut high) = ([u32::MAX; 2], [0; 2]);
        while let Some(at) = waiting.pop() {
            let place = [at % width, at / width];
            count += 1;
            for axis in 0..2 {
                low[axis] = low[axis].min(place[axis]);
                high[axis] = high[axis].max(place[axis]);
            }
            for y in place[1].saturating_sub(1)..=(place[1] + 1).min(height - 1) {
                for x in place[0].saturating_sub(1)..=(place[0] + 1).min(width - 1) {
                    let neighbour = (y * width + x) as usize;
                    if !std::mem::replace(&mut seen[neighbour], true) {
                        waiting.push(neighbour as u32);
                    }
                }
            }
        }
        all += count;
        if (0..2).all(|axis| high[axis] - low[axis] + 1 < FRAGMENT_PX) {
            fragments += count;
        }
    }
    f64::from(fragments) / f64::from(all.max(1))
}

/// The share of the ink that is farther from the contour of the smooth ball than [`WITHIN_PX`].
fn share_off_contour(ink: &[f64], width: u32) -> f64 {
    let radius_px = f64::from(SIZE_PX) / HEIGHT;
    let middle = DVec2::splat(f64::from(SIZE_PX) / 2.0);
    let pixels = ink.iter().zip(0u32..).map(|(&ink, at)| {
        let from_middle = (DVec2::new(f64::from(at % width), f64::from(at / width)) + 0.5).distance(middle);
        (ink, (from_middle - radius_px).abs() > WITHIN_PX)
    });
    let (off, all) =
        pixels.fold((0.0, 0.0), |(off, all), (ink, is_off)| (off + if is_off { ink } else { 0.0 }, all + ink));
    off / all
}

fn contour_noise(executor: &Executor) -> Result<Finding, HarnessError> {
    // No creases: noise would make them too.
    let contours = Lines::edges(LineStyle { width_px: [1.0, 1.0, 0.0, 0.0, 0.0], ink: [0.0, 0.0, 0.0, 1.0] });
    let view = View::new(parallel(HEIGHT), (SIZE_PX, SIZE_PX));
    let picture = |share: f64| -> Result<Image, HarnessError> {
        drawn(executor, &Scene::new(noisy_ball(share)), contours, view, std::f32::consts::PI)
    };
    let (mut off, mut fragments) = (Vec::new(), Vec::new());
    for share in [0.0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.12, 0.16, 0.2, 0.3, 0.4, 0.5] {
        let ink = darkness(&picture(share)?);
        off.push((100.0 * share, 100.0 * share_off_contour(&ink, SIZE_PX)));
        fragments.push((100.0 * share, 100.0 * fragment_share(&ink, SIZE_PX)));
    }
    // Two neighbours that move by the noise, one out and one in, tilt the edge between them by twice the noise over its
    // length; a face seen at that angle lies radius · angle² / 2 within the contour.
    let radius_px = f64::from(SIZE_PX) / HEIGHT;
    let predicted = 100.0 * 0.5 * (2.0 * WITHIN_PX / radius_px).sqrt();
    let how = "Chain contours into strokes and filter these by length, or find contours on interpolated normals";
    let off_limit = limit_at(
        "noise at which a tenth of the ink is off the contour, % of an edge's length",
        crossing(&off, 10.0),
        Bound::AtLeast(6.8),
    )
    .predicted(predicted, "½ √(2 · 1.5 px / radius): faces tilted by twice the noise reach 1.5 px into the ball")
    .mend_by(how);
    let fragment_limit =
        limit("largest share of the ink in pieces under 6 px, %", worst(&fragments), Bound::AtMost(1.2)).mend_by(how);
    let pair = beside(&[crop(&picture(0.0)?), crop(&picture(0.2)?)]);
    Ok(Finding {
        parameter: Axis::linear("noise of the vertices, share of an edge's length", "%"),
        error: Axis::linear("share of the ink", "%"),
        curves: vec![
            curve("more than 1.5 px off the contour", off, off_limit),
            curve("in pieces under 6 px", fragments, fragment_limit),
        ],
        pictures: vec![(
            "Contours of the right half of a ball of 96 segments: smooth, and with vertices moved in or out by up to a \
             fifth of an edge's length."
                .into(),
            pair,
        )],
    })
}

fn crop(picture: &Image) -> Image {
    crate::stability::ink::enlarged(picture, [SIZE_PX / 2 - 20, 0, SIZE_PX / 2 + 20, SIZE_PX], 1)
}

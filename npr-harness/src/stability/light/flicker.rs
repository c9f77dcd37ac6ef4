//! Flicker of band borders that move by fractions of a pixel.

use super::super::setup::{curve, frame_at, front, limit, lit, magnified, side_by_side, tones, whitened};
use super::super::{Axis, Finding, Sweep};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::view::View;
use glam::{DVec2, DVec3, Vec3};
use npr_mesh::Model;
use npr_toon::Bands;

pub(super) const SWEEP: Sweep = Sweep {
    name: "band-edge-flicker",
    technique: "banded light",
    what: "A hard border of a band jumps by whole pixels while the surface moves by fractions of one; an antialiased border \
           changes with the surface.",
    needs_adapter: false,
    run: measure,
};

/// Width and height of the picture, px.
const SIZE: u32 = 32;
/// Frames per pixel of the pan.
const FINE: usize = 16;
/// The length of the pan, px.
const PAN_PX: usize = 4;
/// The angle of the border from the picture's columns: a slope of 1 in 8, so that a picture has all positions of it.
const SLANT: f64 = 0.125;

/// A square whose normals turn, so that N·L is 0 on a straight line through its centre and nowhere else.
fn surface() -> Scene {
    let turned = DVec2::from_angle(-SLANT.atan());
    let corners = [DVec2::new(-4.0, -4.0), DVec2::new(4.0, -4.0), DVec2::new(4.0, 4.0), DVec2::new(-4.0, 4.0)];
    let normal = |at: DVec2| DVec3::new(at.x.signum(), 0.0, 1.0).normalize().as_vec3();
    Scene::new(whitened(Model {
        positions: corners.map(|at| turned.rotate(at).extend(0.0).as_vec3()).to_vec(),
        normals: corners.map(normal).to_vec(),
        faces: vec![[0, 1, 2], [0, 2, 3]],
        ..Model::default()
    }))
}

/// The share of a pixel on the light side of the border, when the pan has moved it by `pan_px`: the mean over 64 rows of
/// the exact length within the pixel.
fn covered(x: u32, y: u32, pan_px: f64) -> f64 {
    const ROWS: u32 = 64;
    let middle = f64::from(SIZE) / 2.0;
    let right = f64::from(x) + 1.0;
    let row = |row: u32| {
        let below = f64::from(y) + (f64::from(row) + 0.5) / f64::from(ROWS) - middle;
        // The border leans by the slant, and the pan moves the samples to the right.
        (right - (middle - pan_px - below * SLANT)).clamp(0.0, 1.0)
    };
    (0..ROWS).map(row).sum::<f64>() / f64::from(ROWS)
}

fn measure(_: &Executor) -> Result<Finding, HarnessError> {
    let scene = surface();
    let tones_of = |antialias| Bands { antialias, tones: vec![Vec3::ZERO, Vec3::ONE], ..Bands::hard_shading() };
    let methods = [("hard", false, 1), ("antialiased", true, 1), ("antialiased, 2 × 2 samples", true, 2)];
    let positions = FINE * PAN_PX;
    let pan_px = |position: usize| position as f64 / FINE as f64;
    let pixels = || (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y)));
    let truth: Vec<Vec<f64>> =
        (0..=positions).map(|at| pixels().map(|(x, y)| covered(x, y, pan_px(at))).collect()).collect();
    let (mut curves, mut images) = (Vec::new(), Vec::new());
    for (name, antialias, samples) in methods {
        let style = lit(Shade::Toon(tones_of(antialias)), DVec3::X);
        let view = View { samples, ..View::new(front(4.0), (SIZE, SIZE)) };
        let mut frames = Vec::new();
        for position in 0..=positions {
            let frame = frame_at(&scene, &style, view, DVec2::new(pan_px(position), 0.0))?;
            if position == 0 && samples == 1 {
                images.push(magnified(&frame.image(), (7, 9), (19, 14), 8));
            }
            frames.push(tones(&frame));
        }
        let flicker = |step: usize| {
            let (mut off, mut true_change) = (0.0, 0.0);
            for at in (step..=positions).step_by(step) {
                for pixel in 0..truth[at].len() {
                    let change = truth[at][pixel] - truth[at - step][pixel];
                    off += (frames[at][pixel] - frames[at - step][pixel] - change).abs();
                    true_change += change.abs();
                }
            }
            off / true_change
        };
        let points: Vec<(f64, f64)> = [1, 2, 4, 8, 16].map(|step| (pan_px(step), flicker(step))).to_vec();
        let what = "flicker at 1/16 px a frame, relative to the true change";
        let measured = points[0].1;
        // A pixel changes by 1 in one frame of 1/s, instead of by s in each: |1 − s| once and |0 − s| otherwise.
        let step = 1.0 / FINE as f64;
        let hard = (2.0 * (1.0 - step), "2 (1 − s) for a step s: each pixel jumps by 1 in one of 1/s frames");
        curves.push(match name {
            "hard" => curve(name, points, limit(what, measured, Some(hard), Bound::AtMost(1.95))),
            _ => {
                curve(name, points, limit(what, measured, None, Bound::AtMost(if samples == 1 { 0.09 } else { 0.03 })))
            }
        });
    }
    Ok(Finding {
        parameter: Axis::logarithmic("motion from frame to frame", "px"),
        error: Axis::linear("flicker: |change − true change|, relative to the true change", ""),
        curves,
        pictures: vec![("a border as it stands in one frame: hard, antialiased".into(), side_by_side(&images))],
    })
}

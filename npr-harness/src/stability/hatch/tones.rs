//! Tones near black and white.

use super::super::setup::{curve, frame, front, limit, side_by_side, worst};
use super::super::{Axis, Finding, Sweep};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::hatch::{HatchEncoding, HatchMapping};
use crate::picture::Image;
use crate::scene::Scene;
use crate::truth::hatch::patch::{PatchView, TILE, Tilted, patch_tones};
use crate::truth::hatch::{LINEAR, black, hatched, strokes};
use crate::view::View;
use glam::DVec3;
use npr_mesh::embedded;
use npr_toon::normal::NormalUse;

pub(super) const SWEEP: Sweep = Sweep {
    name: "hatch-extreme-tones",
    technique: "hatching",
    what: "Six tones end at the darkest of them, so black is shown as a dark gray; thresholds have every tone.",
    needs_adapter: false,
    run: measure,
};

const TONES: [f64; 15] = [0.0, 0.005, 0.01, 0.02, 0.05, 0.1, 0.143, 0.2, 0.35, 0.5, 0.8, 0.9, 0.95, 0.99, 1.0];

/// A cube's side in a tone.
fn picture(encoding: HatchEncoding, tone: f64) -> Result<Image, HarnessError> {
    let scene = Scene::new(embedded::cube());
    let shade = black(&strokes(1), encoding, HatchMapping::Planes, LINEAR, 0.4);
    let to_light = DVec3::new((1.0 - tone * tone).sqrt(), 0.0, tone);
    let style = hatched(&shade, NormalUse::PerPixel, to_light);
    Ok(frame(&scene, &style, View::new(front(1.9), (150, 110)))?.image())
}

fn measure(_: &Executor) -> Result<Finding, HarnessError> {
    let view = PatchView { tilted: Tilted::Camera, tilt_deg: 0.0, distance: 1.0 };
    let mut curves = Vec::new();
    for (name, encoding) in [("six tones", HatchEncoding::SixTones), ("thresholds", HatchEncoding::Thresholds)] {
        let shade = black(&strokes(1), encoding, HatchMapping::Planes, LINEAR, TILE);
        let found = patch_tones(&shade, view, &TONES, 140, 1)?;
        let points: Vec<(f64, f64)> = found.iter().map(|tone| (tone.light, (tone.shown - tone.light).abs())).collect();
        let measured = worst(&points);
        let what = "largest error of the mean tone";
        curves.push(match encoding {
            HatchEncoding::SixTones => {
                let predicted = (1.0 / 7.0, "at black the darkest of the tones i/7, listing 4");
                curve(name, points, limit(what, measured, Some(predicted), Bound::AtMost(0.1435)))
            }
            HatchEncoding::Thresholds => curve(name, points, limit(what, measured, None, Bound::AtMost(0.004))),
        });
    }
    let images = [picture(HatchEncoding::SixTones, 0.0)?, picture(HatchEncoding::Thresholds, 0.0)?];
    Ok(Finding {
        parameter: Axis::linear("tone that is asked for", ""),
        error: Axis::linear("error of the mean tone", ""),
        curves,
        pictures: vec![("black, of six tones and of thresholds".into(), side_by_side(&images))],
    })
}

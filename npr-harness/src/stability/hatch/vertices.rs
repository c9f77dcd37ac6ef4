//! Weights of six tones at the vertices of coarse spheres.

use super::super::setup::{curve, frame, front, limit_at, side_by_side, stays_within, tones};
use super::super::{Axis, Finding, Sweep};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::hatch::{HatchEncoding, HatchMapping};
use crate::scene::Scene;
use crate::truth::hatch::{LINEAR, black, hatched, strokes};
use crate::view::View;
use glam::{DVec2, DVec3};
use npr_mesh::embedded;
use npr_toon::normal::NormalUse;
use std::f64::consts::TAU;

pub(super) const SWEEP: Sweep = Sweep {
    name: "hatch-vertex-weights",
    technique: "hatching",
    what: "Weights of tones at the vertices of a coarse mesh, as in Card & Mitchell's listing 4, give the tones of its \
           chords: spheres become too dark.",
    needs_adapter: false,
    run: measure,
};

const SEGMENTS: [u32; 7] = [8, 12, 16, 24, 32, 48, 64];
const SIZE: u32 = 96;
const HEIGHT: f64 = 2.2;
/// The part of the radius in which tones are compared.
const WITHIN: f64 = 0.8;
/// Full light comes from the eye, so that N·L is above the darkest tone in that part.
const TO_LIGHT: DVec3 = DVec3::Z;
/// The largest mean error of the tone that counts as right.
const MOST: f64 = 0.01;

/// The points of the unit sphere that the pixels see.
fn points() -> impl Iterator<Item = (usize, DVec3)> {
    (0..SIZE * SIZE).filter_map(|pixel| {
        let at = DVec2::new(f64::from(pixel % SIZE) + 0.5, f64::from(pixel / SIZE) + 0.5);
        let at = (at / f64::from(SIZE) * 2.0 - 1.0) * DVec2::new(1.0, -1.0) * HEIGHT / 2.0;
        (at.length() < WITHIN).then(|| (pixel as usize, at.extend((1.0 - at.length_squared()).sqrt())))
    })
}

/// The mean depth of a faceted sphere behind the exact one: on a triangle with the sides θ, θ cos φ and the diagonal the
/// mean sagitta is Σ|side|²/24, and a ray meets it 1/n_z deeper.
fn mean_depth(segments: u32) -> f64 {
    let step = TAU / f64::from(segments);
    let (sum, count) = points().fold((0.0, 0.0), |(sum, count), (_, at)| {
        let squares = 2.0 * step * step * (2.0 - at.y * at.y);
        (sum + squares / 24.0 / at.z, count + 1.0)
    });
    sum / count
}

fn measure(_: &Executor) -> Result<Finding, HarnessError> {
    let view = View::new(front(HEIGHT), (SIZE, SIZE));
    let map = strokes(1);
    // With a side of a few pixels the map shows flat tones, whose error is that of the weights alone.
    let flat = black(&map, HatchEncoding::SixTones, HatchMapping::Planes, LINEAR, 0.04);
    let mut curves = Vec::new();
    for (name, normals) in [("at vertices", NormalUse::PerVertex), ("at pixels", NormalUse::PerPixel)] {
        let mut found = Vec::new();
        for segments in SEGMENTS {
            let scene = Scene::new(embedded::sphere(segments));
            let shown = tones(&frame(&scene, &hatched(&flat, normals, TO_LIGHT), view)?);
            let (sum, count) = points()
                .fold((0.0, 0.0), |(sum, count), (pixel, at)| (sum + (shown[pixel] - at.dot(TO_LIGHT)), count + 1.0));
            found.push((f64::from(segments), (sum / count).abs()));
        }
        let measured = stays_within(&found, MOST);
        let what = "segments from which the mean tone is within 0.01 of N·L";
        let predicted = (
            f64::from(SEGMENTS[0]) * (mean_depth(SEGMENTS[0]) / MOST).sqrt(),
            "mean of Σ|side|²/24 · (L·E) / (N·E) over the sphere, of second order in 1/n",
        );
        curves.push(if normals == NormalUse::PerVertex {
            curve(name, found, limit_at(what, measured, Some(predicted), Bound::AtMost(30.0)))
        } else {
            curve(name, found, limit_at(what, measured, None, Bound::AtMost(18.0)))
        });
    }
    let scene = Scene::new(embedded::sphere(8));
    let visible = black(&map, HatchEncoding::SixTones, HatchMapping::Planes, LINEAR, 0.5);
    let mut images = Vec::new();
    for normals in [NormalUse::PerVertex, NormalUse::PerPixel] {
        let style = hatched(&visible, normals, DVec3::new(-0.5, 0.5, 0.7).normalize());
        images.push(frame(&scene, &style, View::new(front(2.1), (158, 158)))?.image());
    }
    Ok(Finding {
        parameter: Axis::logarithmic("segments around a sphere", ""),
        error: Axis::logarithmic("error of the mean tone", ""),
        curves,
        pictures: vec![("8 segments: weights at vertices, at pixels".into(), side_by_side(&images))],
    })
}

//! Light at faces, at vertices and at pixels on a cylinder of few segments.
//!
//! A chord of a circle with `n` segments lies up to the sagitta R θ²/8 within it, θ = 2π/n. Everything below follows from
//! that: which point of the chord is seen, and which light it has.

use super::super::setup::{curve, frame, front, limit_at, lit, side_by_side, stays_within, tones, whitened};
use super::super::{Axis, Finding, Sweep};
use crate::camera::{Camera, Projection};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::shade::ramp::{RampShade, RampSource};
use crate::style::Style;
use crate::view::View;
use glam::{DVec3, Vec3};
use npr_gooch::Gooch;
use npr_mesh::embedded;
use npr_toon::Bands;
use npr_toon::normal::NormalUse;
use npr_toon::ramp::{Ramp, RampBlend, RampStop};
use std::f64::consts::TAU;

pub(super) const BANDS: Sweep = Sweep {
    name: "vertex-light-bands",
    technique: "banded light",
    what: "On coarse meshes the border of a band is displaced: to the edges of faces where light is constant on a face, and \
           to a chord where light is interpolated between vertices.",
    needs_adapter: false,
    run: bands,
};

pub(super) const TONES: Sweep = Sweep {
    name: "vertex-light-tones",
    technique: "Gooch and other smooth shading",
    what: "Interpolation between the vertices of a coarse mesh gives smooth tones an error of second order in the length of \
           its edges; one tone for each face, of first order.",
    needs_adapter: false,
    run: of_tones,
};

const SEGMENTS: [u32; 12] = [8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384];
const METHODS: [(&str, NormalUse); 3] =
    [("per face", NormalUse::PerFace), ("at vertices", NormalUse::PerVertex), ("at pixels", NormalUse::PerPixel)];
/// The width of the row of pixels that crosses the cylinder.
const WIDTH: u32 = 640;
/// Half the width of the picture, radii of the cylinder.
const HALF: f64 = 1.0625;
/// The radius for which displacements are stated, px.
const RADIUS_PX: f64 = 100.0;
/// Rotations of the cylinder within one segment.
const PHASES: u32 = 16;
/// The direction to the light, from that to the eye.
const LIGHT_RAD: f64 = 30.0 * TAU / 360.0;
/// N·L at the border: 60° from the light.
const THRESHOLD: f64 = 0.5;
/// The part of the radius in which tones are compared: N·E is at least 0.6.
const WITHIN: f64 = 0.8;

/// A horizontal direction at an angle from Z towards X.
fn towards(angle_rad: f64) -> DVec3 {
    DVec3::new(angle_rad.sin(), 0.0, angle_rad.cos())
}

/// The row of pixels across a cylinder, seen from a direction, and the position of each pixel in radii.
fn row(scene: &Scene, style: &Style, from_rad: f64) -> Result<Vec<(f64, f64)>, HarnessError> {
    let projection = Projection::Orthographic { height: 2.0 * HALF / f64::from(WIDTH), far: 20.0 };
    let camera = Camera { eye: towards(from_rad) * 10.0, target: DVec3::ZERO, up: DVec3::Y, projection, near: 0.1 };
    let tones = tones(&frame(scene, style, View::new(camera, (WIDTH, 1)))?);
    let at = |x: usize| (2.0 * (x as f64 + 0.5) / f64::from(WIDTH) - 1.0) * HALF;
    Ok(tones.into_iter().enumerate().map(|(x, tone)| (at(x), tone)).collect())
}

/// The largest error over all rotations, for each number of segments. `error` takes a row.
fn swept(
    shade: &Shade,
    light_rad: f64,
    normals: NormalUse,
    error: impl Fn(&[(f64, f64)]) -> f64,
) -> Result<Vec<(f64, f64)>, HarnessError> {
    let mut points = Vec::new();
    for segments in SEGMENTS {
        let scene = Scene::new(whitened(embedded::cylinder(segments)));
        let mut worst = 0.0f64;
        for phase in 0..PHASES {
            let from_rad = TAU / f64::from(segments) * f64::from(phase) / f64::from(PHASES);
            let style = Style { normals, ..lit(shade.clone(), towards(from_rad + light_rad)) };
            worst = worst.max(error(&row(&scene, &style, from_rad)?));
        }
        points.push((f64::from(segments), worst));
    }
    Ok(points)
}

/// A sphere of few segments, shaded with each use of normals.
fn picture(shade: &Shade, normals: &[NormalUse]) -> Result<crate::picture::Image, HarnessError> {
    let scene = Scene::new(whitened(embedded::sphere(12)));
    let mut images = Vec::new();
    for &normals in normals {
        let style = Style { normals, ..lit(shade.clone(), DVec3::new(-0.5, 0.5, 0.7)) };
        images.push(frame(&scene, &style, View { samples: 2, ..View::new(front(2.2), (104, 104)) })?.image());
    }
    Ok(side_by_side(&images))
}

fn bands(_: &Executor) -> Result<Finding, HarnessError> {
    let black_and_white =
        Bands { thresholds: vec![THRESHOLD as f32], tones: vec![Vec3::ZERO, Vec3::ONE], ..Bands::hard_shading() };
    let shade = Shade::Toon(black_and_white);
    let border_rad = LIGHT_RAD - THRESHOLD.acos();
    let px = 2.0 * HALF / f64::from(WIDTH);
    // The white pixels to the left of the middle end at the border.
    let error = |row: &[(f64, f64)]| {
        let white: f64 = row.iter().filter(|(x, _)| (-0.95..0.0).contains(x)).map(|(_, tone)| tone * px).sum();
        (-white - border_rad.sin()).abs() * RADIUS_PX
    };
    let mut curves = Vec::new();
    for (name, normals) in METHODS {
        let points = swept(&shade, LIGHT_RAD, normals, error)?;
        let measured = stays_within(&points, 1.0);
        let what = "segments from which a border is displaced by at most 1 px on a radius of 100 px";
        let segments = |angle_rad: f64| TAU / angle_rad;
        let (predicted, bound) = match normals {
            NormalUse::PerFace => (
                (
                    segments(2.0 / RADIUS_PX / border_rad.cos()),
                    "borders follow edges, up to R θ/2 cos φ from where they belong",
                ),
                300.0,
            ),
            NormalUse::PerVertex => (
                (
                    segments((8.0 / RADIUS_PX * THRESHOLD.acos().sin() / LIGHT_RAD.cos()).sqrt()),
                    "N·L is linear on a chord: its border lies R θ²/8 · cos(light) / sin(acos t) aside",
                ),
                25.0,
            ),
            _ => (
                (
                    segments((8.0 / RADIUS_PX / border_rad.sin().abs()).sqrt()),
                    "N·L is right for the direction from the axis, and the chord lies R θ²/8 within: R θ²/8 · sin φ",
                ),
                18.0,
            ),
        };
        curves.push(curve(name, points, limit_at(what, measured, Some(predicted), Bound::AtMost(bound))));
    }
    let uses = [NormalUse::PerFace, NormalUse::PerVertex, NormalUse::PerPixel];
    Ok(Finding {
        parameter: Axis::logarithmic("segments around a cylinder", ""),
        error: Axis::logarithmic("largest displacement of a band's border, on a radius of 100 px", "px"),
        curves,
        pictures: vec![(
            "12 segments: light per face, at vertices, at pixels".into(),
            picture(&Shade::Toon(Bands::default()), &uses)?,
        )],
    })
}

fn of_tones(_: &Executor) -> Result<Finding, HarnessError> {
    let ends = [(-1.0, Vec3::ZERO), (1.0, Vec3::ONE)].map(|(at, color)| RampStop { at, color });
    let ramp = RampSource::Stops(Ramp { stops: ends.to_vec(), blend: RampBlend::Smooth });
    let shade = Shade::Ramp(RampShade { ramp, half_lambert: None });
    let error = |row: &[(f64, f64)]| {
        let inner = row.iter().filter(|(x, _)| x.abs() <= WITHIN);
        // Lit from the eye, N·L is the height of the circle.
        inner.map(|&(x, tone)| (2.0 * tone - 1.0 - (1.0 - x * x).sqrt()).abs()).fold(0.0, f64::max)
    };
    const MOST: f64 = 4.0 / 255.0;
    let turned = (1.0 - WITHIN * WITHIN).sqrt();
    let mut curves = Vec::new();
    for (name, normals) in METHODS {
        let points = swept(&shade, 0.0, normals, error)?;
        let measured = stays_within(&points, MOST);
        let what = "segments from which N·L is off by at most 4/255 where N·E is at least 0.6";
        let (predicted, bound) = match normals {
            NormalUse::PerFace => {
                ((TAU / (2.0 * MOST / WITHIN), "θ/2 · sin φ: the turn of N within half a face"), 190.0)
            }
            NormalUse::PerVertex => (
                (TAU / (8.0 * MOST * turned).sqrt(), "θ²/8 / cos φ: the depth between chord and circle on the ray"),
                26.0,
            ),
            _ => (
                (
                    TAU / (8.0 * MOST * turned / WITHIN.powi(2)).sqrt(),
                    "θ²/8 · tan φ · sin φ: the turn of N by the parallax of chord and circle",
                ),
                21.0,
            ),
        };
        curves.push(curve(name, points, limit_at(what, measured, Some(predicted), Bound::AtMost(bound))));
    }
    Ok(Finding {
        parameter: Axis::logarithmic("segments around a cylinder", ""),
        error: Axis::logarithmic("largest error of N·L where N·E is at least 0.6", ""),
        curves,
        pictures: vec![(
            "Gooch shading of 12 segments: per face, at vertices, at pixels".into(),
            picture(&Shade::Gooch(Gooch::default()), &[NormalUse::PerFace, NormalUse::PerVertex, NormalUse::PerPixel])?,
        )],
    })
}

//! A highlight that is smaller than the faces of the mesh.

use super::super::setup::{curve, frame, limit, limit_at, lit, side_by_side, stays_within, tones, whitened};
use super::super::{Axis, Finding, Sweep};
use crate::camera::{Camera, Projection};
use crate::check::Limit as Bound;
use crate::cpu::CpuFrame;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::style::Style;
use crate::view::View;
use glam::{DVec3, Vec3};
use npr_mesh::embedded;
use npr_toon::normal::NormalUse;
use npr_toon::{Bands, Highlight};
use std::f64::consts::PI;

pub(super) const SWEEP: Sweep = Sweep {
    name: "vertex-light-highlight",
    technique: "banded light",
    what: "A highlight that falls between the vertices of a coarse mesh is lost if N·H is computed at the vertices, since \
           interpolated values are nowhere larger.",
    needs_adapter: false,
    run: measure,
};

/// Segments around the sphere.
const SEGMENTS: u32 = 16;
/// The highlight's radii that are tried, relative to the angle from its middle to the nearest vertex.
const RADII: [f64; 12] = [0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.01, 1.05, 1.1, 1.25, 1.5, 2.0];
const SIZE: u32 = 80;
/// The height of the view, radii of the sphere.
const HEIGHT: f64 = 1.2;

/// The middle of a cell at the equator, and its nearest vertices, on the ring above.
fn middle_and_nearest() -> (DVec3, DVec3) {
    let half_rad = PI / f64::from(SEGMENTS);
    let on_sphere = |longitude: f64, latitude: f64| {
        DVec3::new(longitude.cos() * latitude.cos(), latitude.sin(), -longitude.sin() * latitude.cos())
    };
    (on_sphere(half_rad, half_rad), on_sphere(0.0, 2.0 * half_rad))
}

/// The middle of the cell, lit from the eye, so that N·H is N·E, with a highlight of a radius.
fn seen(radius: f64, normals: NormalUse, height: f64, size: u32) -> Result<(CpuFrame, f64), HarnessError> {
    let (middle, nearest) = middle_and_nearest();
    let projection = Projection::Orthographic { height, far: 20.0 };
    let camera = Camera { eye: middle * 10.0, target: DVec3::ZERO, up: DVec3::Y, projection, near: 0.1 };
    let border_rad = radius * middle.dot(nearest).acos();
    let highlight = Highlight { threshold: border_rad.cos() as f32, color: Vec3::ONE, strength: 1.0, lit_only: true };
    let bands =
        Bands { tones: vec![Vec3::splat(0.25), Vec3::splat(0.5)], highlight: Some(highlight), ..Bands::hard_shading() };
    let style = Style { normals, ..lit(Shade::Toon(bands), middle) };
    let scene = Scene::new(whitened(embedded::sphere(SEGMENTS)));
    Ok((frame(&scene, &style, View::new(camera, (size, size)))?, border_rad))
}

fn measure(_: &Executor) -> Result<Finding, HarnessError> {
    let radius_px = f64::from(SIZE) / HEIGHT;
    let mut curves = Vec::new();
    for (name, normals) in [("at vertices", NormalUse::PerVertex), ("at pixels", NormalUse::PerPixel)] {
        let mut points = Vec::new();
        for radius in RADII {
            let (frame, border_rad) = seen(radius, normals, HEIGHT, SIZE)?;
            let found: f64 = tones(&frame).iter().map(|tone| (2.0 * tone - 1.0).max(0.0)).sum();
            points.push((radius, 1.0 - found / (PI * (radius_px * border_rad.sin()).powi(2))));
        }
        curves.push(if normals == NormalUse::PerVertex {
            let measured = stays_within(&points, 0.999);
            let formula = "interpolated values are nowhere above those of the nearest vertex, cos of its angle";
            let what = "largest radius, relative to the nearest vertex's angle, at which a highlight vanishes";
            curve(name, points, limit_at(what, measured, Some((1.0, formula)), Bound::AtMost(1.03)))
        } else {
            let measured = points.iter().fold(0.0f64, |most, point| most.max(point.1.abs()));
            let what = "largest share of a highlight that is lost or added";
            curve(name, points, limit(what, measured, None, Bound::AtMost(0.08)))
        });
    }
    let mut images = Vec::new();
    for normals in [NormalUse::PerVertex, NormalUse::PerPixel] {
        images.push(seen(0.95, normals, 2.2, 150)?.0.image());
    }
    Ok(Finding {
        parameter: Axis::linear("radius of the highlight, relative to the angle from its middle to a vertex", ""),
        error: Axis::linear("share of the highlight's area that is lost", ""),
        curves,
        pictures: vec![("a highlight of 0.95 of that: N·H at vertices, at pixels".into(), side_by_side(&images))],
    })
}

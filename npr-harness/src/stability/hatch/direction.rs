//! Directions of strokes where a surface hardly has any.

use super::super::setup::{curve, frame, front, limit_at, side_by_side, stays_within};
use super::super::{Axis, Finding, Sweep};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::hatch::{HatchEncoding, HatchMapping};
use crate::scene::Scene;
use crate::truth::hatch::{LIT, black, hatched, strokes};
use crate::view::View;
use glam::DVec3;
use npr_hatch::field::{FieldOptions, direction_field};
use npr_mesh::{Model, embedded};
use npr_toon::normal::NormalUse;

pub(super) const SWEEP: Sweep = Sweep {
    name: "hatch-direction",
    technique: "hatching",
    what: "On a surface that is curved nearly equally in all directions, such as a sphere that is a little longer than wide, \
           the directions of strokes are not those of the form.",
    needs_adapter: false,
    run: measure,
};

/// By how much the spheroid is longer than wide.
const LONGER: [f64; 9] = [0.003, 0.01, 0.03, 0.06, 0.1, 0.2, 0.4, 0.8, 1.6];
const SEGMENTS: [u32; 2] = [24, 64];
/// The mean error of an unrelated direction, whose angle is anywhere in 0..90°.
const UNRELATED_DEG: f64 = 45.0;

/// A sphere, stretched along Y.
fn spheroid(segments: u32, longer: f64) -> Model {
    let mut model = embedded::sphere(segments);
    for (position, normal) in model.positions.iter_mut().zip(&mut model.normals) {
        let stretched = DVec3::new(1.0, 1.0 + longer, 1.0);
        *normal = (position.as_dvec3() / stretched).normalize().as_vec3();
        *position = (position.as_dvec3() * stretched).as_vec3();
    }
    model
}

/// The mean angle between the field and the parallels, along which a long spheroid is curved most, for vertices within
/// 60° of the equator.
fn error_deg(model: &Model) -> Result<f64, HarnessError> {
    let own: Vec<u32> = (0..model.positions.len() as u32).collect();
    let field = direction_field(&model.positions, &model.normals, &model.faces, &own, &FieldOptions::default())?;
    let angles = field.iter().zip(&model.normals).filter_map(|(line, normal)| {
        let parallel = DVec3::Y.cross(normal.as_dvec3()).normalize_or_zero();
        let along = line.direction().as_dvec3().dot(parallel).abs().min(1.0);
        (normal.y.abs() < 0.866).then(|| along.acos().to_degrees())
    });
    let (sum, count) = angles.fold((0.0, 0.0), |(sum, count), angle| (sum + angle, count + 1.0));
    Ok(sum / count)
}

fn measure(_: &Executor) -> Result<Finding, HarnessError> {
    let mut curves = Vec::new();
    for segments in SEGMENTS {
        let mut points = Vec::new();
        for longer in LONGER {
            points.push((longer, error_deg(&spheroid(segments, longer))?));
        }
        let measured = stays_within(&points, UNRELATED_DEG / 4.0);
        let what = "least elongation from which directions are within 11° of the parallels, in the mean";
        let bound = Bound::AtMost(0.1);
        curves.push(curve(&format!("{segments} segments"), points, limit_at(what, measured, None, bound)));
    }
    let shade = black(&strokes(1), HatchEncoding::Thresholds, HatchMapping::Form, LIT, 0.5);
    let style = hatched(&shade, NormalUse::PerPixel, DVec3::new(-0.5, 0.6, 0.6));
    let mut images = Vec::new();
    for longer in [0.01, 0.8] {
        let scene = Scene::new(spheroid(64, longer));
        images.push(frame(&scene, &style, View::new(front(2.4 + 1.6 * longer), (158, 180)))?.image());
    }
    Ok(Finding {
        parameter: Axis::logarithmic("by how much a spheroid is longer than wide", ""),
        error: Axis::linear("mean angle between strokes and parallels", "degrees"),
        curves,
        pictures: vec![("1 % longer, and 80 % longer than wide".into(), side_by_side(&images))],
    })
}

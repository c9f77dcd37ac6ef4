//! Models far from the origin.

use super::super::setup::{curve, first_over, frame, limit_at, side_by_side};
use super::super::{Axis, Finding, Sweep};
use crate::camera::{Camera, Framing};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::scene::Scene;
use crate::style::style;
use crate::view::View;
use glam::{DAffine3, DVec3};
use npr_mesh::{Model, Object, embedded};

pub(super) const SWEEP: Sweep = Sweep {
    name: "model-offset",
    technique: "scenes",
    what: "A file whose f32 positions are far from the origin has lost their digits before it is read; a node that carries \
           the offset in f64 keeps them.",
    needs_adapter: false,
    run: measure,
};

/// The height of a picture that the model fills, px, and the model's, units.
const FILLED_PX: f64 = 200.0;
const SIZE: f64 = 2.0;
/// The displacement that counts, px.
const MOST_PX: f64 = 0.5;
/// The direction of the offset.
const AWAY: DVec3 = DVec3::new(1.0, -0.7, 0.3);

fn model() -> Model {
    embedded::torus(0.75, 0.25, 32, 16)
}

/// Offsets along X, in steps that are not those of powers of two.
fn offsets() -> impl Iterator<Item = f64> {
    (4..53).map(|number| (10f64.powf(f64::from(number) / 4.0)).round())
}

/// Half the step of f32 at a number.
fn half_ulp32(x: f64) -> f64 {
    (x.abs().log2().floor() - 24.0).exp2()
}

/// The model with its positions moved, as a file of f32 has them.
fn of_file(offset: DVec3) -> Scene {
    let mut model = model();
    for position in &mut model.positions {
        *position = (position.as_dvec3() + offset).as_vec3();
    }
    Scene::new(model)
}

/// The model placed by a node.
fn of_node(offset: DVec3) -> Result<Scene, HarnessError> {
    let node = Object { name: String::new(), mesh: 0, world_from_mesh: DAffine3::from_translation(offset) };
    Scene::with_objects(vec![model()], vec![node])
}

/// The largest distance of a vertex in scene space from where it belongs, px.
fn displaced_px(scene: &Scene, offset: DVec3) -> f64 {
    let from_origin = offset - scene.origin;
    let right = model().positions.into_iter().map(|position| (position.as_dvec3() + from_origin) * scene.scale);
    let off = scene.corners().zip(right).map(|(here, right)| here.as_dvec3().distance(right));
    off.fold(0.0, f64::max) / scene.scale * FILLED_PX / SIZE
}

fn measure(_: &Executor) -> Result<Finding, HarnessError> {
    let relative = |offset: f64| offset / SIZE;
    let of = |displaced: &dyn Fn(DVec3) -> Result<f64, HarnessError>| {
        let points: Result<Vec<_>, HarnessError> =
            offsets().map(|offset| Ok((relative(offset), displaced((AWAY * offset).round())?))).collect();
        points
    };
    let file = of(&|offset| Ok(displaced_px(&of_file(offset), offset)))?;
    let node = of(&|offset| Ok(displaced_px(&of_node(offset)?, offset)))?;
    // Each axis rounds by up to half a step of f32.
    let px = FILLED_PX / SIZE;
    let rounded = of(&|offset| Ok(DVec3::from_array(offset.to_array().map(half_ulp32)).length() * px))?;
    // The origin is rounded to f32, and the scene rounds what that leaves.
    let twice = |x: f64| half_ulp32(half_ulp32(x));
    let of_rest = of(&|offset| Ok(DVec3::from_array(offset.to_array().map(twice)).length() * px))?;
    let what = "offset at which a vertex is displaced by 0.5 px of 200, in sizes of the model";
    let curves = [
        ("positions in f32", file, rounded, "half a step of f32 at the offset, 2^(⌊log₂ x⌋ − 24), on each axis", 4e4),
        (
            "a node in f64",
            node,
            of_rest,
            "half a step of f32 at the rest that an origin rounded to f32 leaves: about 2⁻⁴⁸ of the offset",
            4e11,
        ),
    ];
    let curves = curves.map(|(name, points, expected, formula, bound)| {
        let (measured, predicted) = (first_over(&points, MOST_PX), first_over(&expected, MOST_PX));
        curve(name, points, limit_at(what, measured, Some((predicted, formula)), Bound::AtLeast(bound)))
    });
    let mut images = Vec::new();
    let far = AWAY * 2e6;
    for scene in [of_file(far), of_node(far)?] {
        let camera = Camera::framed(scene.corners(), 1.0, &Framing { pitch_rad: 0.7, ..Framing::default() });
        let cartoon = style("cartoon").expect("a style of this crate");
        images.push(frame(&scene, &cartoon, View { samples: 2, ..View::new(camera, (158, 158)) })?.image());
    }
    Ok(Finding {
        parameter: Axis::logarithmic("distance from the origin", "sizes of the model"),
        error: Axis::logarithmic("largest displacement of a vertex, of a model 200 px high", "px"),
        curves: curves.to_vec(),
        pictures: vec![(
            "a torus a million sizes from the origin: positions in f32, a node in f64".into(),
            side_by_side(&images),
        )],
    })
}

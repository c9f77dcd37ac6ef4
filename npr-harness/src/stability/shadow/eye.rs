//! The eye in shadow, and lights far away.

use super::super::setup::{curve, faceted, first_over, limit, limit_at, side_by_side, worst};
use super::super::{Axis, Finding, Sweep};
use super::counts::{Count, Volumes, looking, on_ground, receivers};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::scene::Scene;
use crate::shadow::plan::casters;
use glam::{DVec3, DVec4};
use npr_mesh::Model;

pub(super) const INSIDE: Sweep = Sweep {
    name: "shadow-eye-inside",
    technique: "shadows",
    what: "Volumes counted in front of the surface miss those that the eye is in, so that shadow and light are exchanged; \
           counted behind it, as here, they are right.",
    needs_adapter: false,
    run: inside,
};

pub(super) const LIGHT_DISTANCE: Sweep = Sweep {
    name: "shadow-light-distance",
    technique: "shadows",
    what: "The sides of the volumes of a light at a point go away from it. However far the light is, they must be those of a \
           light in that direction.",
    needs_adapter: false,
    run: light_distance,
};

const SIZE: (u32, u32) = (110, 82);
/// The direction to the light.
const TO_LIGHT: DVec3 = DVec3::new(0.6, 1.0, 0.013);
/// Half the width of the box along Z, which is that of its shadow.
const HALF: f64 = 0.507;

/// A box above the ground.
fn box_above() -> Model {
    let corner = |number: u8| {
        let side = |bit: u8, low: f64, high: f64| if number & bit == 0 { low } else { high };
        DVec3::new(side(1, -0.61, 0.59), side(2, 1.03, 1.51), side(4, -HALF, HALF))
    };
    let quads: [[u8; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]];
    let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
    faceted(&triangles.map(|corners| corners.map(corner)).collect::<Vec<_>>())
}

fn scene() -> Scene {
    on_ground(&box_above(), 3.0)
}

fn volumes(scene: &Scene, light: DVec4) -> Volumes {
    let (corners, towards) = casters(scene.single()).triangles(light);
    Volumes::new(&corners, towards, light)
}

fn inside(_: &Executor) -> Result<Finding, HarnessError> {
    let scene = scene();
    // A light from the side only of X and Y, so that the shadow's side lies at the box's.
    let light = TO_LIGHT.with_z(0.0).normalize().extend(0.0);
    let volumes = volumes(&scene, light);
    let depths = [-0.5, -0.3, -0.1, -0.03, -0.01, 0.01, 0.03, 0.1, 0.3, 0.5];
    let (mut pass, mut fail, mut images) = (Vec::new(), Vec::new(), Vec::new());
    for depth in depths {
        // At a height of 0.503 the shadow is 0.3 to the left of the box.
        let eye = DVec3::new(-0.211, 0.503, HALF - depth);
        let camera = looking(eye, DVec3::new(0.103, 0.11, eye.z - 1.307), 75.0);
        let points = receivers(&scene, camera, SIZE, light)?;
        pass.push((depth, points.wrong_share(&volumes, Count::DepthPass)));
        fail.push((depth, points.wrong_share(&volumes, Count::DepthFail)));
        if depth == 0.1 {
            let large = (158, 118);
            let points = receivers(&scene, camera, large, light)?;
            images = [Count::DepthPass, Count::DepthFail].map(|count| points.picture(&volumes, count)).to_vec();
        }
    }
    let enters = first_over(&pass, 0.05);
    let most = worst(&fail);
    let curves = vec![
        curve(
            "counted in front of the surface",
            pass,
            limit_at(
                "depth of the eye in the shadow from which the picture is wrong",
                enters,
                Some((
                    0.0,
                    "the shadow's side is the plane of the box's side, which contains the direction of the light",
                )),
                Bound::AtLeast(-0.01),
            ),
        ),
        curve(
            "counted behind it",
            fail,
            limit(
                "largest share of wrong pixels",
                most,
                Some((0.0, "Everitt & Kilgard 2002: nothing is clipped between the surface and infinity")),
                Bound::AtMost(0.001),
            ),
        ),
    ];
    Ok(Finding {
        parameter: Axis::linear("depth of the eye in the shadow", "sizes of the box"),
        error: Axis::linear("share of the pixels with the wrong shadow", ""),
        curves,
        pictures: vec![(
            "the eye in the shadow: counted in front of the surface, and behind it".into(),
            side_by_side(&images),
        )],
    })
}

fn light_distance(_: &Executor) -> Result<Finding, HarnessError> {
    let scene = scene();
    let eye = DVec3::new(1.503, 2.207, 4.011);
    let camera = looking(eye, DVec3::new(-0.3, 0.5, 0.0), 45.0);
    let (mut points, mut images) = (Vec::new(), Vec::new());
    for power in [1, 2, 4, 6, 8, 10, 12, 15, 18] {
        let distance = 2.0 * 10f64.powi(power);
        // The style holds it in f32.
        let light = (TO_LIGHT.normalize() * distance).as_vec3().as_dvec3().extend(1.0);
        let receivers = receivers(&scene, camera, SIZE, light)?;
        let volumes = volumes(&scene, light);
        points.push((distance / 2.0, receivers.wrong_share(&volumes, Count::DepthFail)));
        if [1, 18].contains(&power) {
            let large = (158, 118);
            let receivers = super::counts::receivers(&scene, camera, large, light)?;
            images.push(receivers.picture(&volumes, Count::DepthFail));
        }
    }
    let limit = limit(
        "largest share of wrong pixels at any distance",
        worst(&points),
        Some((0.0, "directions from the light are differences in f64")),
        Bound::AtMost(0.001),
    );
    Ok(Finding {
        parameter: Axis::logarithmic("distance of the light", "sizes of the scene"),
        error: Axis::linear("share of the pixels with the wrong shadow", ""),
        curves: vec![curve("volumes", points, limit)],
        pictures: vec![("a light ten sizes away, and one at 10¹⁸".into(), side_by_side(&images))],
    })
}

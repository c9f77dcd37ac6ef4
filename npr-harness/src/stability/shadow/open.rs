//! Volumes of meshes with holes.

use super::super::setup::{curve, first_over, limit, limit_at, side_by_side, worst};
use super::super::{Axis, Finding, Sweep};
use super::counts::{Count, Volumes, looking, on_ground, receivers};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::scene::Scene;
use crate::shadow::plan::casters;
use glam::{DVec3, DVec4, Vec3};
use npr_mesh::{Model, embedded};
use npr_outline::shadow_volume::{VOLUME_SECOND, outline_light_side};

pub(super) const SWEEP: Sweep = Sweep {
    name: "shadow-open-mesh",
    technique: "shadows",
    what: "Volumes from the contour of a mesh with a hole are open at its border, and shadow and light leak through; where \
           every face casts by itself, as here, they are closed.",
    needs_adapter: false,
    run: measure,
};

const SIZE: (u32, u32) = (80, 60);
const TO_LIGHT: DVec3 = DVec3::new(0.611, 1.003, 0.297);
/// The direction of the hole's middle.
const HOLE: DVec3 = DVec3::new(0.2, 0.35, 1.0);

/// A ball above the ground without the faces around a direction.
fn scene(hole_deg: f64) -> Scene {
    let mut ball = embedded::sphere(40);
    let hole = HOLE.normalize().as_vec3();
    let cos = hole_deg.to_radians().cos() as f32;
    let middle = |face: &[u32; 3]| face.iter().map(|&v| ball.positions[v as usize]).sum::<Vec3>().normalize();
    let kept: Vec<[u32; 3]> = ball.faces.iter().copied().filter(|face| middle(face).dot(hole) < cos).collect();
    ball.face_material = vec![0; kept.len()];
    let positions = ball.positions.iter().map(|&position| position + Vec3::new(0.0, 1.501, 0.0)).collect();
    on_ground(&Model { positions, faces: kept, ..ball }, 4.0)
}

/// The volumes as if the ball were closed: sides from the edges between a face towards the light and one away from it, and
/// the faces towards the light as caps. The ground, which is not closed either, does not cast.
fn of_contour(scene: &Scene, light: DVec4) -> Volumes {
    let casters = casters(scene.single());
    let local = (light - casters.origin.as_dvec3().extend(0.0) * light.w).as_vec4();
    let mut corners = Vec::new();
    let (near, far) = (|[x, y, z]: [f32; 3]| [x, y, z, 1.0], |[x, y, z]: [f32; 3]| [x, y, z, 0.0]);
    let on_ground = |at: [f32; 3]| at[1] == 0.0;
    for edge in casters.edges().filter(|edge| edge.flags & VOLUME_SECOND != 0 && !on_ground(edge.from)) {
        let [first, second] = [edge.plane0, edge.plane1].map(|plane| outline_light_side(plane, local) > 0);
        if first != second {
            let (from, to) = if first { (edge.from, edge.to) } else { (edge.to, edge.from) };
            corners.extend([near(to), near(from), far(from)]);
        }
    }
    for face in casters.faces().filter(|face| outline_light_side(face.plane, local) > 0 && !on_ground(face.a)) {
        corners.extend([face.a, face.b, face.c].map(near));
    }
    Volumes::new(&corners, corners.len(), light)
}

fn of_every_face(scene: &Scene, light: DVec4) -> Volumes {
    let (corners, towards) = casters(scene.single()).triangles(light);
    Volumes::new(&corners, towards, light)
}

fn measure(_: &Executor) -> Result<Finding, HarnessError> {
    let light = TO_LIGHT.normalize().extend(0.0);
    let eye = DVec3::new(0.503, 2.807, 6.011);
    let camera = looking(eye, DVec3::new(-0.4, 0.75, 0.0), 45.0);
    let (mut ours, mut contour, mut images) = (Vec::new(), Vec::new(), Vec::new());
    for hole_deg in [0.0, 15.0, 26.0, 30.0, 33.0, 36.0, 39.0, 50.0, 70.0] {
        let scene = scene(hole_deg);
        let points = receivers(&scene, camera, SIZE, light)?;
        let volumes = [of_contour(&scene, light), of_every_face(&scene, light)];
        contour.push((hole_deg, points.wrong_share(&volumes[0], Count::DepthFail)));
        ours.push((hole_deg, points.wrong_share(&volumes[1], Count::DepthFail)));
        if hole_deg == 50.0 {
            let large = (158, 120);
            let points = receivers(&scene, camera, large, light)?;
            images = volumes.iter().map(|volumes| points.picture(volumes, Count::DepthFail)).collect();
        }
    }
    let (leaks, most) = (first_over(&contour, 0.005), worst(&ours));
    let curves = vec![
        curve(
            "every face casts",
            ours,
            limit(
                "largest share of wrong pixels with any hole",
                most,
                Some((0.0, "the sweeps of an edge are the sum of its faces' directions, so volumes are closed")),
                Bound::AtMost(0.003),
            ),
        ),
        curve(
            "sides from the contour",
            contour,
            limit_at(
                "radius of the hole from which shadow leaks, degrees",
                leaks,
                Some((
                    90.0 - HOLE.angle_between(TO_LIGHT).to_degrees(),
                    "90° less the angle from the light to the hole's middle: its border reaches the contour",
                )),
                Bound::AtLeast(30.0),
            ),
        ),
    ];
    Ok(Finding {
        parameter: Axis::linear("radius of the hole, seen from the ball's centre", "degrees"),
        error: Axis::linear("share of the pixels with the wrong shadow", ""),
        curves,
        pictures: vec![("a hole of 50°: sides from the contour, and every face casting".into(), side_by_side(&images))],
    })
}

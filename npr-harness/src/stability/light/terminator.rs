//! The terminator of coarse meshes: the faces that are turned away from the light end at edges.

use super::super::setup::{curve, frame, limit, lit, side_by_side, states_image, whitened};
use super::super::{Axis, Finding, Sweep};
use crate::camera::{Camera, Projection};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::shadow::ShadowStyle;
use crate::style::{Style, style};
use crate::truth::shadows::States;
use crate::view::View;
use glam::{DVec2, DVec3};
use npr_imagespace::shadow::ShadowState;
use npr_mesh::embedded;
use std::f64::consts::{PI, SQRT_2, TAU};

pub(super) const SWEEP: Sweep = Sweep {
    name: "terminator-teeth",
    technique: "shadows",
    what: "Whether a face is turned away from the light is decided for whole faces, so the border of attached shadow follows \
           the edges of a coarse mesh in teeth, although its normals are smooth.",
    needs_adapter: false,
    run: measure,
};

const SEGMENTS: [u32; 8] = [8, 12, 16, 24, 32, 48, 64, 96];
const SIZE: u32 = 96;
/// The height of the view, radii.
const HEIGHT: f64 = 2.2;
/// The radius for which heights are stated, px.
const RADIUS_PX: f64 = 100.0;
/// The segments for which the limits are stated.
const AT: u32 = 12;
/// Lights within one segment.
const PHASES: u32 = 4;

/// A light from 45° above the equator: the terminator crosses the cells there along their diagonals, the worst case.
fn to_light(segments: u32, phase: u32) -> DVec3 {
    let longitude = TAU / f64::from(segments) * (f64::from(phase) + 0.5) / f64::from(PHASES);
    DVec3::new(longitude.cos(), 1.0, -longitude.sin()).normalize()
}

/// Sees the light from the side: the terminator is a straight line through the middle of the picture.
fn camera(to_light: DVec3) -> Camera {
    let eye = to_light.cross(DVec3::Y).normalize() * 10.0;
    let projection = Projection::Orthographic { height: HEIGHT, far: 20.0 };
    Camera { eye, target: DVec3::ZERO, up: DVec3::Y, projection, near: 0.1 }
}

/// N·L of the exact sphere at a pixel's centre, which is the distance from the terminator in radii; `None` near the
/// silhouette and outside.
fn n_dot_l(pixel: usize, to_light: DVec3) -> Option<f64> {
    let at = DVec2::new((pixel as u32 % SIZE) as f64 + 0.5, (pixel as u32 / SIZE) as f64 + 0.5);
    let at = (at / f64::from(SIZE) * 2.0 - 1.0) * HEIGHT / 2.0;
    let [right, up, _] = camera(to_light).axes();
    let normal = right * at.x - up * at.y;
    (normal.length() < 0.9).then(|| normal.dot(to_light))
}

fn measure(_: &Executor) -> Result<Finding, HarnessError> {
    let shadow = ShadowStyle::default();
    let terminator = f64::from(shadow.terminator);
    let of_lines = style("shadow-lines").expect("a style of this crate");
    let styles = |to_light: DVec3| {
        let plain = lit(Shade::Normals, to_light);
        let negated = Style { shadow: Some(shadow), ..plain.clone() };
        let states = Style { lights: plain.lights.clone(), shadow: Some(shadow), ..of_lines.clone() };
        [plain, negated, states]
    };
    let (mut negated, mut states, mut images) = (Vec::new(), Vec::new(), Vec::new());
    for segments in SEGMENTS {
        let scene = Scene::new(whitened(embedded::sphere(segments)));
        let (mut tooth, mut tooth_of_states) = (0.0f64, 0.0f64);
        for phase in 0..PHASES {
            let to_light = to_light(segments, phase);
            let view = View::new(camera(to_light), (SIZE, SIZE));
            let [plain, shown, of_states] = styles(to_light).map(|style| frame(&scene, &style, view));
            let (plain, shown) = (plain?, shown?);
            let of_states = States::of_texels(&of_states?.texels, (SIZE, SIZE));
            for pixel in 0..plain.color.len() {
                let Some(light) = n_dot_l(pixel, to_light).filter(|_| plain.depth[pixel] > 0.0) else { continue };
                if (plain.color[pixel] != shown.color[pixel]) != (light <= 0.0) {
                    tooth = tooth.max(light.abs());
                }
                let is_back = of_states.states[pixel] == Some(ShadowState::BackFacing);
                if is_back != (light <= terminator) {
                    tooth_of_states = tooth_of_states.max((light - terminator).abs());
                }
            }
        }
        negated.push((f64::from(segments), tooth * RADIUS_PX));
        states.push((f64::from(segments), tooth_of_states * RADIUS_PX));
        if segments == AT {
            let to_light = to_light(segments, 1);
            let closer = View::new(camera(to_light), (150, 150));
            let [_, negated, states] = styles(to_light).map(|style| frame(&scene, &style, closer));
            let states = States::of_texels(&states?.texels, closer.size);
            images = vec![negated?.image(), states_image(&states, (0, 0), closer.size)];
        }
    }
    let at = |points: &[(f64, f64)]| points.iter().find(|point| point.0 == f64::from(AT)).map_or(0.0, |point| point.1);
    // Half the diagonal of a cell at the equator: the angle between the normal of a face and its farthest corner.
    let half_diagonal = SQRT_2 * PI / f64::from(AT);
    let what = "height of the teeth with 12 segments, px on a radius of 100 px";
    let curves = vec![
        {
            let predicted =
                (RADIUS_PX * half_diagonal.sin(), "R sin(√2 π/n): from a face's normal to its farthest corner");
            let limit = limit(what, at(&negated), Some(predicted), Bound::AtMost(38.0));
            curve(
                "normals negated in shadow",
                negated,
                limit.mend_by("decide by the interpolated normal near the terminator"),
            )
        },
        {
            let predicted = (
                RADIUS_PX * (half_diagonal.sin() - terminator).max(0.0),
                "R (sin(√2 π/n) − t), 0 where that is negative: N·L above t hides the faces' border",
            );
            let limit = limit(what, at(&states), Some(predicted), Bound::AtMost(23.0));
            curve(
                "shadow states of lines",
                states,
                limit.mend_by("decide by the interpolated normal near the terminator"),
            )
        },
    ];
    Ok(Finding {
        parameter: Axis::logarithmic("segments around a sphere", ""),
        error: Axis::linear("height of the teeth at the terminator, on a radius of 100 px", "px"),
        curves,
        pictures: vec![(
            "12 segments: normals negated in shadow, shadow states of lines".into(),
            side_by_side(&images),
        )],
    })
}

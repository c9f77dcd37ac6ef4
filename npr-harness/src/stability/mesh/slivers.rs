//! Faces of no area, or nearly none, at the edges of a prism.

use super::super::setup::{curve, first_over, frame, limit, limit_at, side_by_side, worst};
use super::super::{Axis, Finding, Sweep};
use crate::camera::{Camera, Framing};
use crate::check::Limit as Bound;
use crate::compare::compare;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::picture::Image;
use crate::scene::Scene;
use crate::style::style;
use crate::view::View;
use glam::{DVec3, Vec3};
use npr_mesh::{LoadOptions, Model, normals};
use std::f64::consts::TAU;

pub(super) const SWEEP: Sweep = Sweep {
    name: "zero-area-faces",
    technique: "lines from edges",
    what: "A face of no area has no influence on edges and normals. One that is thinner than anything visible, but has an \
           area, joins its neighbours by two small angles where they met at a large one: the crease is lost, and shading is \
           smoothed across it.",
    needs_adapter: false,
    run: measure,
};

/// Heights of the slivers, relative to the prism's height of 2.
const HEIGHTS: [f64; 12] = [0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 3e-7, 4.5e-7, 5e-7, 1e-6, 1e-4, 1e-3];
const SIZE: (u32, u32) = (104, 150);
/// Six sides meet at 60°, above the crease angle of 45°.
const SIDES: u32 = 6;

/// The face that is put at each upright edge.
#[derive(Clone, Copy, PartialEq)]
enum Sliver {
    /// None: the prism as it should look.
    None,
    /// One with twice the same corner.
    TwoCorners,
    /// One between the edge and a point beside its middle, which one of the sides has as a corner. Its normal, if it has an
    /// area, is halfway between those of the two sides.
    Middle { height: f64 },
}

/// The sides of a prism with six of them, of shared corners, whose normals are computed.
fn prism(sliver: Sliver) -> Model {
    let outwards = |step: u32| {
        let (sin, cos) = (TAU * f64::from(step % SIDES) / f64::from(SIDES)).sin_cos();
        DVec3::new(cos, 0.0, -sin)
    };
    let mut positions = Vec::new();
    for step in 0..SIDES {
        positions.extend([outwards(step) - DVec3::Y, outwards(step) + DVec3::Y]);
    }
    let mut faces = Vec::new();
    for step in 0..SIDES {
        let next = (step + 1) % SIDES;
        let [a, b, c, d] = [2 * step, 2 * next, 2 * next + 1, 2 * step + 1];
        match sliver {
            Sliver::Middle { height } => {
                let middle = positions.len() as u32;
                let along = DVec3::Y.cross(outwards(step));
                positions.push(outwards(step) + along * (2.0 * height));
                faces.extend([[a, b, middle], [b, c, middle], [c, d, middle], [a, middle, d]]);
            }
            Sliver::None => faces.extend([[a, b, c], [a, c, d]]),
            Sliver::TwoCorners => faces.extend([[a, b, c], [a, c, d], [a, d, a]]),
        }
    }
    let mut model = Model {
        normals: vec![Vec3::ZERO; positions.len()],
        positions: positions.into_iter().map(|position| position.as_vec3()).collect(),
        faces,
        ..Model::default()
    };
    model.fill_face_material();
    normals::fill_missing(&mut model, LoadOptions::default().normal_crease_angle_rad);
    model
}

fn picture(model: Model) -> Result<Image, HarnessError> {
    let cartoon = style("cartoon").expect("a style of this crate");
    let framing = Framing { yaw_rad: 0.4, ..Framing::default() };
    let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
    let camera = Camera::framed(prism(Sliver::None).positions.into_iter(), aspect, &framing);
    Ok(frame(&Scene::new(model), &cartoon, View::new(camera, SIZE))?.image())
}

fn measure(_: &Executor) -> Result<Finding, HarnessError> {
    let right = picture(prism(Sliver::None))?;
    let share = |image: &Image| -> Result<f64, HarnessError> {
        Ok(compare(&right, image, &[])?.over(16) as f64 / f64::from(SIZE.0 * SIZE.1))
    };
    let two_corners = picture(prism(Sliver::TwoCorners))?;
    let with_two = vec![(0.0, share(&two_corners)?)];
    let (mut with_middle, mut thin) = (Vec::new(), None);
    for height in HEIGHTS {
        let image = picture(prism(Sliver::Middle { height }))?;
        with_middle.push((height, share(&image)?));
        thin = Some(image).filter(|_| height == 1e-6).or(thin);
    }
    let none = (0.0, "a face without area has no influence");
    let of_two = worst(&with_two);
    let opens = first_over(&with_middle, 0.001);
    let least = (4.0 * f64::from(f32::EPSILON), "8 units in the last place of 1, half of the prism's height");
    let curves = vec![
        curve(
            "two equal corners",
            with_two,
            limit(
                "share of the pixels that differ from those without such faces",
                of_two,
                Some(none),
                Bound::AtMost(0.0),
            ),
        ),
        curve(
            "three points nearly on a line",
            with_middle,
            limit_at(
                "least height of a face, relative to the model, that takes a crease away",
                opens,
                Some(least),
                Bound::AtLeast(4.5e-7),
            )
            .mend_by("treat what is thinner than any pixel like a face of no area"),
        ),
    ];
    Ok(Finding {
        parameter: Axis::logarithmic("height of the face, relative to the model", ""),
        error: Axis::linear("share of the pixels that differ", ""),
        curves,
        pictures: vec![(
            "a prism; with faces of two equal corners at its edges; with faces of a millionth of its height".into(),
            side_by_side(&[vec![right, two_corners], thin.into_iter().collect()].concat()),
        )],
    })
}

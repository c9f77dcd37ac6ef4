//! The background's clear colour.

use crate::check::{Limit as Bound, WITHIN_PX};
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::image_lines::ImageInk;
use crate::image_lines::gbuffer::style::{Background, GBuffer, GBufferTarget};
use crate::scene::Scene;
use crate::stability::ink::{beside, crossing, curve, drawn, ink, limit, limit_at, parallel, worst};
use crate::stability::{Axis, Finding, Sweep};
use crate::style::Lines;
use crate::truth::lines::{accuracy, drawn_centreline, true_lines};
use crate::view::View;
use glam::{Mat4, Quat, Vec3};
use npr_imagespace::filter::normal::NORMAL_COS_CARD_MITCHELL;
use npr_imagespace::filter::printed::{PrintedEdges, PrintedFilter, PrintedNormal};
use npr_mesh::embedded::{self, placed};
use npr_mesh::{Material, Model};

pub(super) const PLUS_Z: Sweep = Sweep {
    name: "plus-z-background",
    technique: "image lines",
    what: "Cleared to the normal +z, the background looks like a surface that faces the viewer, and one that does has no \
           border of normals against it.",
    needs_adapter: false,
    run: plus_z,
};

/// The printed filter of normals alone.
fn normals(background: Background) -> Lines {
    let printed_background = background == Background::PlusZ;
    let edges = PrintedEdges {
        normal: Some(PrintedNormal { cos: NORMAL_COS_CARD_MITCHELL, printed_background }),
        depth: None,
        ..PrintedEdges::default()
    };
    let target = GBufferTarget::Rgba8(PrintedFilter::Edges(edges));
    let gbuffer = GBuffer { target, background, ..GBuffer::default() };
    Lines::image(ImageInk { gbuffer: Some(gbuffer), ..ImageInk::default() })
}

/// A flat square turned by an angle about the vertical.
fn turned(angle_deg: f64) -> Model {
    let upright = Quat::from_rotation_x(std::f32::consts::FRAC_PI_2);
    let turn = Quat::from_rotation_y(angle_deg.to_radians() as f32);
    placed(embedded::ground(1.0), Mat4::from_quat(turn * upright), Material::default())
}

fn plus_z(executor: &Executor) -> Result<Finding, HarnessError> {
    const SIZE: (u32, u32) = (96, 96);
    let view = View::new(parallel(2.6), SIZE);
    let angles_deg = [0.0, 10.0, 20.0, 25.0, 28.0, 30.0, 31.0, 31.5, 32.0, 32.5, 34.0, 36.0, 40.0, 50.0, 60.0];
    let mut curves = Vec::new();
    for (name, background) in
        [("cleared to +z, as printed", Background::PlusZ), ("cleared to no normal", Background::None)]
    {
        let mut points = Vec::new();
        for angle in angles_deg {
            let scene = Scene::new(turned(angle));
            let truth = true_lines(&scene, &view.camera, SIZE, 1.0);
            let found = drawn_centreline(&ink(executor, &scene, normals(background), view)?, SIZE.0, SIZE.1);
            points.push((angle, 100.0 * (1.0 - accuracy(&truth, &found, WITHIN_PX).recall)));
        }
        let limit = match background {
            Background::PlusZ => {
                let predicted = f64::from(NORMAL_COS_CARD_MITCHELL).acos().to_degrees();
                limit_at(
                    "angle to +z below which a surface has no border, degrees",
                    crossing(&points, 50.0),
                    Bound::AtMost(32.4),
                )
                .predicted(predicted, "acos(0.85): the threshold of listing 9")
            }
            Background::None => {
                limit("largest share of a border that is missing, %", worst(&points), Bound::AtMost(0.5))
            }
        };
        curves.push(curve(name, points, limit));
    }
    let mut model = placed(embedded::cube(), Mat4::from_translation(Vec3::new(-1.3, 0.0, 0.0)), Material::default());
    let turn = Mat4::from_translation(Vec3::new(1.3, 0.0, 0.0)) * Mat4::from_rotation_y(0.7);
    model.append(&placed(embedded::cube(), turn, Material::default()));
    let scene = Scene::new(model);
    let picture = |background| drawn(executor, &scene, normals(background), View::new(parallel(3.4), (158, 90)), 1.0);
    Ok(Finding {
        parameter: Axis::linear("angle between normal and +z", "degrees"),
        error: Axis::linear("border missing", "%"),
        curves,
        pictures: vec![(
            "Two cubes, the left one facing the viewer, by normals alone: the background cleared to +z, and to no normal."
                .into(),
            beside(&[picture(Background::PlusZ)?, picture(Background::None)?]),
        )],
    })
}

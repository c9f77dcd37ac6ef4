//! Features thinner than a pixel.

use crate::check::{Limit as Bound, WITHIN_PX};
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::hull_lines::HullLines;
use crate::image_lines::ImageInk;
use crate::scene::Scene;
use crate::stability::ink::{beside, black_edges, crossing, curve, drawn, enlarged, ink, limit, limit_at, parallel};
use crate::stability::{Axis, Finding, Sweep};
use crate::style::Lines;
use crate::truth::lines::{accuracy, drawn_centreline, true_lines};
use crate::view::View;
use glam::{Mat4, Vec3};
use npr_mesh::embedded::{self, placed};
use npr_mesh::{Material, Model};
use npr_outline::hull::HullNormals;

pub(super) const THIN_BARS: Sweep = Sweep {
    name: "thin-bars",
    technique: "image lines",
    what: "A bar thinner than a pixel lies between the pixels' centres along a part of its length, where the image does \
           not have it. Lines from edges do not depend on samples of the surface.",
    needs_adapter: false,
    run: thin_bars,
};

/// The bar's angle to the rows of the picture.
const SLOPE_RAD: f64 = 0.05;
const SIZE: (u32, u32) = (320, 60);

/// A square bar of a thickness in px, with one world unit a px.
fn bar(thickness_px: f64) -> Model {
    let scale = Vec3::new(140.0, (thickness_px / 2.0) as f32, (thickness_px / 2.0) as f32);
    placed(embedded::cube(), Mat4::from_rotation_z(SLOPE_RAD as f32) * Mat4::from_scale(scale), Material::default())
}

fn thin_bars(executor: &Executor) -> Result<Finding, HarnessError> {
    let view = View::new(parallel(f64::from(SIZE.1)), SIZE);
    let widths_px = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.5, 2.0, 4.0];
    let hull = Lines::hull(HullLines { width_px: 2.0, ink: Vec3::ZERO, normals: HullNormals::Welded });
    let methods =
        [("image lines", Lines::image(ImageInk::default())), ("edge lines", black_edges(1.0)), ("inverted hull", hull)];
    let mut points = vec![Vec::new(); methods.len()];
    for width_px in widths_px {
        let scene = Scene::new(bar(width_px));
        let truth = true_lines(&scene, &view.camera, SIZE, std::f64::consts::FRAC_PI_4);
        for ((_, lines), points) in methods.iter().zip(&mut points) {
            let drawn = drawn_centreline(&ink(executor, &scene, *lines, view)?, SIZE.0, SIZE.1);
            points.push((width_px, 100.0 * (1.0 - accuracy(&truth, &drawn, WITHIN_PX).recall)));
        }
    }
    let curves = methods.iter().zip(points).map(|((name, _), points)| {
        let what = "thickness of a bar below which more than 5 % of its lines are missing, px";
        let limit = if *name == "image lines" {
            // Of a row of centres the bar covers a share of its thickness, in one run for each pixel that it rises.
            let reach = 2.0 * (WITHIN_PX + 1.0);
            let predicted = 0.95 * SLOPE_RAD.cos() - reach * SLOPE_RAD.tan();
            limit_at(what, crossing(&points, 5.0), Bound::AtMost(0.8)).predicted(
                predicted,
                "0.95 cos φ − 5 tan φ: runs of centres within the bar, and on either side a pixel of the filter and 1.5 px \
                 within which a line counts as found",
            )
        } else {
            limit("largest share of the lines that is missing, %", points.iter().map(|p| p.1).fold(0.0, f64::max), Bound::AtMost(1.0))
        };
        curve(name, points, limit)
    });
    let curves = curves.collect();
    let scene = Scene::new(bar(0.4));
    let part =
        |lines| Ok::<_, HarnessError>(enlarged(&drawn(executor, &scene, lines, view, 0.8)?, [120, 22, 78, 16], 2));
    let picture = beside(&[part(methods[0].1)?, part(methods[1].1)?]);
    Ok(Finding {
        parameter: Axis::linear("thickness of a bar", "px"),
        error: Axis::linear("lines missing", "%"),
        curves,
        pictures: vec![("A bar 0.4 px thick, enlarged twice: lines in the image, and along edges.".into(), picture)],
    })
}

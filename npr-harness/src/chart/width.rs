//! The width of lines, against the width asked for, over distances and angles to the viewer.
//!
//! One side of a triangle is seen from several distances, with the triangle turned about that side. All variants are
//! asked for [`WIDTH_PX`]. The error of a view is |width / asked − 1| where the line is measured, in the middle third of
//! the side; a line that is missing has an error of 1.

use super::frames::{Drawn, candidates, part_of, rows};
use super::lines::asked;
use super::{Chart, Lab, Row};
use crate::camera::{Camera, Projection};
use crate::error::HarnessError;
use crate::executor::Picture;
use crate::scene::Scene;
use crate::truth::lines::darkness;
use crate::truth::width::{base_of_triangle, width_in_the_middle};
use crate::variant::Part;
use crate::view::View;
use glam::DVec3;

pub(super) const CHART: Chart = Chart {
    name: "width",
    title: "Width of lines",
    error: MEAN,
    about: "Lines of 4 px at one side of a triangle, from distances of 0.5 to 50 and turned by up to 80 degrees away from \
            the viewer: mean and largest relative error of the width.",
    choices: &[],
    run,
};

const MEAN: &str = "mean error of the width";
const WIDTH_PX: f32 = 4.0;
const DISTANCES: [f64; 3] = [0.5, 5.0, 50.0];
/// Angles between the view and the triangle's normal.
const TILTS_DEG: [f64; 3] = [0.0, 60.0, 80.0];
const SIZE: (u32, u32) = (480, 272);

fn run(lab: &Lab<'_>) -> Result<Vec<Row>, HarnessError> {
    let candidates = candidates(Part::Lines, &asked(WIDTH_PX));
    let Some(subject) = lab.subjects.first() else { return Ok(Vec::new()) };
    let views: Vec<(Scene, [glam::DVec2; 2])> = DISTANCES
        .iter()
        .flat_map(|&distance| TILTS_DEG.map(|tilt_deg| base_of_triangle(distance, tilt_deg, &camera(), SIZE)))
        .collect();
    let mut judge = |drawn: &Drawn<'_>| {
        let (mut sum, mut worst) = (0.0, 0.0f64);
        for (scene, ends_px) in &views {
            let setup = &drawn.candidate.setup;
            let view = View { samples: setup.samples, ..View::new(camera(), SIZE) };
            let image = drawn.executor.render(&Picture::new(scene, &setup.style, view), &|_| {})?;
            let width = width_in_the_middle(&darkness(&image), SIZE.0, *ends_px, f64::from(WIDTH_PX));
            let error = (width / f64::from(WIDTH_PX) - 1.0).abs();
            sum += error;
            worst = worst.max(error);
        }
        let errors = [(MEAN, sum / views.len() as f64), ("largest error of the width", worst)];
        Ok(Some(errors.map(|(name, value)| (name.to_owned(), value)).into()))
    };
    rows(CHART.name, lab, subject, &candidates, &mut judge, &part_of(lab, 0, 1))
}

fn camera() -> Camera {
    Camera {
        eye: DVec3::ZERO,
        target: DVec3::NEG_Z,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y_rad: 1.0 },
        near: 0.1,
    }
}

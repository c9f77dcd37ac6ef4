//! T-junctions: a vertex of one face in the middle of another's side.

use super::super::setup::{colored, curve, frame, front, limit, tones};
use super::super::{Axis, Finding, Sweep};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::scene::Scene;
use crate::style::{Style, style};
use crate::view::View;
use glam::Vec3;
use npr_mesh::Model;

pub(super) const SWEEP: Sweep = Sweep {
    name: "t-junctions",
    technique: "lines from edges",
    what: "At a T-junction the sides of the faces are different edges, each with one face, so they are drawn as boundaries \
           within a flat surface.",
    needs_adapter: false,
    run: measure,
};

const JUNCTIONS: [u32; 7] = [0, 1, 2, 4, 8, 16, 32];
const SIZE: (u32, u32) = (200, 120);

/// A rectangle of one face below, and a number of faces above that meet it at junctions.
fn plate(junctions: u32) -> Scene {
    let mut model = Model { materials: vec![colored(0.8, 0.8, 0.8)], ..Model::default() };
    let mut add = |left: f32, right: f32, bottom: f32, top: f32| {
        let first = model.positions.len() as u32;
        let corners = [(left, bottom), (right, bottom), (right, top), (left, top)];
        model.positions.extend(corners.map(|(x, y)| Vec3::new(x, y, 0.0)));
        model.normals.extend([Vec3::Z; 4]);
        model.faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        model.face_polygon.extend([first / 4; 2]);
    };
    add(-1.0, 1.0, -0.5, 0.0);
    let step = |number: u32| -1.0 + 2.0 * number as f32 / (junctions + 1) as f32;
    for number in 0..=junctions {
        add(step(number), step(number + 1), 0.0, 0.5);
    }
    model.face_material = vec![0; model.faces.len()];
    Scene::new(model)
}

fn measure(_: &Executor) -> Result<Finding, HarnessError> {
    let lines: Style = style("lines").expect("a style of this crate");
    let view = View::new(front(1.2), SIZE);
    let (mut points, mut pictures) = (Vec::new(), Vec::new());
    for junctions in JUNCTIONS {
        let frame = frame(&plate(junctions), &lines, view)?;
        let tones = tones(&frame);
        // The seam runs between the two middle rows; columns near the border have the outline.
        let is_dark = |x: u32, y: u32| tones[(y * SIZE.0 + x) as usize] < 0.6;
        let inner = 10..SIZE.0 - 10;
        let rows = SIZE.1 / 2 - 2..SIZE.1 / 2 + 2;
        let dark = inner.clone().filter(|&x| rows.clone().any(|y| is_dark(x, y))).count();
        points.push((f64::from(junctions), dark as f64 / inner.len() as f64));
        if junctions == 4 {
            pictures.push(("4 T-junctions in a flat rectangle".to_owned(), frame.image()));
        }
    }
    let measured = points[1].1;
    let predicted = (1.0, "with one junction no side of the seam has both its ends in common with another");
    let what = "share of a flat seam that is drawn, with one T-junction";
    let limit = limit(what, measured, Some(predicted), Bound::AtMost(1.0));
    let mended = limit.mend_by("collinear boundary edges that cover each other are shared");
    Ok(Finding {
        parameter: Axis::linear("T-junctions at a seam", ""),
        error: Axis::linear("share of the seam's length that is drawn as a line", ""),
        curves: vec![curve("lines from edges", points, mended)],
        pictures,
    })
}

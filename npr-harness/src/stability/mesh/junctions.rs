//! T-junctions: a vertex of one face in the middle of another's side.

use super::super::setup::{colored, curve, frame, front, limit, tones, worst};
use super::super::{Axis, Finding, Sweep};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::scene::Scene;
use crate::style::{Style, style};
use crate::view::View;
use glam::Vec3;
use npr_mesh::Model;
use npr_mesh::edges::{EdgeKind, EdgeOptions, find};

pub(super) const SWEEP: Sweep = Sweep {
    name: "t-junctions",
    technique: "lines from edges",
    what: "At a T-junction no side of a face has both its ends in common with another. Their parts that cover each other on \
           one line are shared; without that rule they are drawn as boundaries within a flat surface.",
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

/// The share of the seam's length that boundaries of the upper faces have, without the rule.
fn open_share(model: &Model) -> f64 {
    let found = find(&model.positions, &model.faces, &model.face_polygon, &[], &EdgeOptions::of_file());
    let place = |vertex: u32| model.positions[vertex as usize];
    let in_seam = found.edges.iter().filter(|edge| edge.kind() == EdgeKind::Boundary && edge.faces()[0] > 1);
    let lengths = in_seam.map(|edge| edge.ends.map(place)).filter(|ends| ends.iter().all(|end| end.y == 0.0));
    lengths.map(|[from, to]| f64::from(from.distance(to)) / 2.0).sum()
}

fn measure(_: &Executor) -> Result<Finding, HarnessError> {
    let lines: Style = style("lines").expect("a style of this crate");
    let view = View::new(front(1.2), SIZE);
    let (mut points, mut apart, mut pictures) = (Vec::new(), Vec::new(), Vec::new());
    for junctions in JUNCTIONS {
        let frame = frame(&plate(junctions), &lines, view)?;
        let tones = tones(&frame);
        // The seam runs between the two middle rows; columns near the border have the outline.
        let is_dark = |x: u32, y: u32| tones[(y * SIZE.0 + x) as usize] < 0.6;
        let inner = 10..SIZE.0 - 10;
        let rows = SIZE.1 / 2 - 2..SIZE.1 / 2 + 2;
        let dark = inner.clone().filter(|&x| rows.clone().any(|y| is_dark(x, y))).count();
        points.push((f64::from(junctions), dark as f64 / inner.len() as f64));
        apart.push((f64::from(junctions), open_share(plate(junctions).meshes()[0].model())));
        if junctions == 4 {
            pictures.push(("4 T-junctions in a flat rectangle".to_owned(), frame.image()));
        }
    }
    let (worst_shared, worst_apart) = (worst(&points), apart[1].1);
    let what = "largest share of a flat seam that is drawn, up to 32 T-junctions";
    let shared = (0.0, "boundary edges that cover each other on one line are shared");
    let limit_shared = limit(what, worst_shared, Some(shared), Bound::AtMost(0.0));
    let none = (1.0, "with one junction no side of the seam has both its ends in common with another");
    let what = "share of a flat seam that is a boundary, with one T-junction";
    let limit_apart = limit(what, worst_apart, Some(none), Bound::AtMost(1.0));
    Ok(Finding {
        parameter: Axis::linear("T-junctions at a seam", ""),
        error: Axis::linear("share of the seam's length that is drawn as a line", ""),
        curves: vec![
            curve("lines from edges", points, limit_shared),
            curve("edges as they are in the file", apart, limit_apart),
        ],
        pictures,
    })
}

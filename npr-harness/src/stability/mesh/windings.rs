//! Faces that are wound against their neighbours.

use super::super::setup::{curve, frame, limit, side_by_side, uniform, worst};
use super::super::{Axis, Finding, Sweep};
use crate::camera::{Camera, Framing};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::scene::Scene;
use crate::style::style;
use crate::view::View;
use glam::DVec3;
use npr_mesh::edges::{Edges, find};
use npr_mesh::{Model, embedded};
use npr_outline::{ContourOptions, contour_edges};
use std::collections::BTreeSet;

pub(super) const SWEEP: Sweep = Sweep {
    name: "opposite-windings",
    technique: "lines from edges",
    what: "A face that is wound against its neighbours would be outlined, as if it were turned away from the eye; the rule \
           for opposite windings turns it back.",
    needs_adapter: false,
    run: measure,
};

const SHARES: [f64; 8] = [0.0, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5];
const EYE: DVec3 = DVec3::new(3.0, 2.0, 5.0);

/// A sphere of which a share of the faces is wound the other way.
fn sphere(share: f64) -> Model {
    let mut model = embedded::sphere(48);
    for (number, face) in (0u64..).zip(&mut model.faces) {
        if uniform(7, number) < share {
            face.swap(1, 2);
        }
    }
    model
}

fn edges_of(model: &Model) -> Edges {
    find(&model.positions, &model.faces, &model.face_polygon, &[], &Default::default())
}

/// The edges that are lines, by their ends.
fn lines(model: &Model) -> Result<BTreeSet<[u32; 2]>, HarnessError> {
    let contours = contour_edges(model, &edges_of(model), &ContourOptions::default())?;
    let mut found = Vec::new();
    contours.scan(EYE.extend(1.0), &mut found);
    Ok(found.into_iter().map(|edge| sorted(contours.edges[edge as usize].ends)).collect())
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The edges of which one face, by its own winding, faces the eye and the other does not: lines without the rule.
fn lines_without_rule(model: &Model) -> BTreeSet<[u32; 2]> {
    let faces_eye = |face: u32| {
        let [a, b, c] = model.faces[face as usize].map(|vertex| model.positions[vertex as usize].as_dvec3());
        (b - a).cross(c - a).dot(EYE - a) >= 0.0
    };
    let edges = edges_of(model).edges;
    let is_line = |edge: &&npr_mesh::edges::Edge| edge.faces().map(faces_eye)[0] != edge.faces().map(faces_eye)[1];
    edges.iter().filter(is_line).map(|edge| sorted(edge.ends)).collect()
}

fn measure(_: &Executor) -> Result<Finding, HarnessError> {
    let expected = lines(&sphere(0.0))?;
    let count = edges_of(&sphere(0.0)).edges.len() as f64;
    let (mut with, mut without) = (Vec::new(), Vec::new());
    for share in SHARES {
        let model = sphere(share);
        let differ = |found: &BTreeSet<[u32; 2]>| found.symmetric_difference(&expected).count() as f64 / count;
        with.push((share, differ(&lines(&model)?)));
        without.push((share, differ(&lines_without_rule(&model))));
    }
    let what = "largest share of the edges that is misjudged, up to half of the faces";
    let half = (0.5, "2 p (1 − p): one of an edge's two faces is turned");
    let (worst_with, worst_without) = (worst(&with), worst(&without));
    let curves = vec![
        curve(
            "by the rule",
            with,
            limit(what, worst_with, Some((0.0, "windings are compared within a component")), Bound::AtMost(0.0)),
        ),
        curve("by each face's own winding", without, limit(what, worst_without, Some(half), Bound::AtMost(0.53))),
    ];
    let style = style("lines").expect("a style of this crate");
    let camera = Camera::framed(embedded::sphere(48).positions.into_iter(), 1.0, &Framing::default());
    let mut images = Vec::new();
    for model in [sphere(0.1), without_neighbours(sphere(0.1))] {
        images.push(frame(&Scene::new(model), &style, View::new(camera, (150, 150)))?.image());
    }
    Ok(Finding {
        parameter: Axis::linear("share of the faces that is wound the other way", ""),
        error: Axis::linear("share of the edges that is misjudged", ""),
        curves,
        pictures: vec![(
            "a tenth of the faces turned: by the rule, and with these faces taken out, as their outlines would be"
                .into(),
            side_by_side(&images),
        )],
    })
}

/// Without the faces that are turned: what is left has boundaries where each of them would be outlined.
fn without_neighbours(model: Model) -> Model {
    let original = embedded::sphere(48);
    let kept: Vec<usize> = (0..model.faces.len()).filter(|&face| model.faces[face] == original.faces[face]).collect();
    Model {
        faces: kept.iter().map(|&face| model.faces[face]).collect(),
        face_material: kept.iter().map(|&face| model.face_material[face]).collect(),
        ..model
    }
}

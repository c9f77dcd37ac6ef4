//! Welding within a tolerance: seams that open, and plates that collapse.

use super::super::setup::{colored, curve, first_over, frame, front, limit, limit_at, stays_within};
use super::super::{Axis, Finding, Sweep};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::scene::Scene;
use crate::style::style;
use crate::view::View;
use glam::Vec3;
use npr_mesh::edges::{EdgeKind, EdgeOptions, find};
use npr_mesh::weld::{Weld, rounding_tolerance};
use npr_mesh::{Model, embedded};

pub(super) const SEAMS: Sweep = Sweep {
    name: "weld-seams",
    technique: "lines from edges",
    what: "A seam whose sides differ by more than the tolerance is drawn as two boundaries. For drawing the tolerance is the \
           rounding of the mesh's largest coordinate; only equal positions are always one vertex.",
    needs_adapter: false,
    run: seams,
};

pub(super) const PLATES: Sweep = Sweep {
    name: "weld-plates",
    technique: "lines from edges",
    what: "Welding within a tolerance joins the two sides of what is thinner, and its edges are lost.",
    needs_adapter: false,
    run: plates,
};

/// The tolerance, for models of a size of 2.
const TOLERANCE: f32 = 1.0 / 1024.0;
const RELATIVE: [f64; 11] = [0.1, 0.25, 0.5, 0.8, 0.95, 0.99, 1.01, 1.05, 1.25, 2.0, 10.0];
/// Quadrilaterals on each side of the seam.
const QUADS: u32 = 8;

/// Two strips that face each other across a gap along Y.
fn strips(gap: f32) -> Model {
    let mut model = Model { materials: vec![colored(0.8, 0.8, 0.8)], ..Model::default() };
    for (left, right) in [(-1.0, 0.0), (gap, 1.0)] {
        for number in 0..QUADS {
            let [bottom, top] = [number, number + 1].map(|step| -1.0 + 2.0 * step as f32 / QUADS as f32);
            let first = model.positions.len() as u32;
            let corners = [(left, bottom), (right, bottom), (right, top), (left, top)];
            model.positions.extend(corners.map(|(x, y)| Vec3::new(x, y, 0.0)));
            model.normals.extend([Vec3::Z; 4]);
            model.faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            model.face_polygon.extend([first / 4; 2]);
        }
    }
    model.face_material = vec![0; model.faces.len()];
    model
}

/// The share of the seam's sides that are boundaries.
fn open_share(model: &Model, weld: Weld) -> f64 {
    let options = EdgeOptions { weld, ..EdgeOptions::default() };
    let found = find(&model.positions, &model.faces, &model.face_polygon, &[], &options);
    let in_seam = |vertex: u32| model.positions[vertex as usize].x.abs() < 0.5;
    let open =
        found.edges.iter().filter(|edge| edge.kind() == EdgeKind::Boundary && edge.ends.map(in_seam) == [true; 2]);
    open.count() as f64 / f64::from(2 * QUADS)
}

fn seams(_: &Executor) -> Result<Finding, HarnessError> {
    let gaps = RELATIVE.map(|gap| (gap, strips(gap as f32 * TOLERANCE)));
    let welded: Vec<(f64, f64)> =
        gaps.iter().map(|(gap, model)| (*gap, open_share(model, Weld::Within(TOLERANCE)))).collect();
    let exact: Vec<(f64, f64)> = gaps.iter().map(|(gap, model)| (*gap, open_share(model, Weld::Exact))).collect();
    let rounding = {
        let Model { positions, faces, .. } = strips(0.0);
        rounding_tolerance(&positions, &faces)
    };
    let of_rounding = |gap: f64| (gap, open_share(&strips(gap as f32 * rounding), Weld::Rounding));
    let rounded: Vec<(f64, f64)> = RELATIVE.map(of_rounding).to_vec();
    let least = open_share(&strips(f32::from_bits(1)), Weld::Exact);
    let (opens, rounded_opens) = (first_over(&welded, 0.5), first_over(&rounded, 0.5));
    let joins = Some((1.0, "a vertex joins a representative at most the tolerance away"));
    let curves = vec![
        curve(
            "within a tolerance",
            welded,
            limit_at("gap at which a seam opens, relative to the tolerance", opens, joins, Bound::AtLeast(0.99)),
        ),
        curve(
            "within rounding, as for drawing",
            rounded,
            limit_at(
                "gap at which a seam opens, relative to 8 units in the last place of the largest coordinate",
                rounded_opens,
                joins,
                Bound::AtLeast(0.99),
            ),
        ),
        curve(
            "exactly",
            exact,
            limit(
                "share of a seam that opens at the smallest gap of f32",
                least,
                Some((1.0, "only equal positions are one vertex")),
                Bound::AtMost(1.0),
            ),
        ),
    ];
    let scene = Scene::new(strips(0.25 * TOLERANCE));
    let lines = style("lines").expect("a style of this crate");
    let picture = frame(&scene, &lines, View::new(front(2.2), (150, 150)))?.image();
    Ok(Finding {
        parameter: Axis::logarithmic("gap, relative to the tolerance", ""),
        error: Axis::linear("share of the seam that is a boundary", ""),
        curves,
        pictures: vec![("a seam with a gap of 1/8192 of the size".into(), picture)],
    })
}

/// A cube flattened to a thickness along Z.
fn plate(thickness: f32) -> Model {
    let mut model = embedded::cube();
    model.positions.iter_mut().for_each(|position| position.z *= thickness / 2.0);
    model
}

fn plates(_: &Executor) -> Result<Finding, HarnessError> {
    let lost = |thickness: f64| {
        let Model { positions, faces, face_polygon, .. } = plate(thickness as f32 * TOLERANCE);
        let options = EdgeOptions { weld: Weld::Within(TOLERANCE), ..EdgeOptions::default() };
        let found = find(&positions, &faces, &face_polygon, &[], &options);
        let kept = found.edges.iter().filter(|edge| edge.kind() == EdgeKind::TwoFace).count();
        1.0 - kept as f64 / 12.0
    };
    let points: Vec<(f64, f64)> = RELATIVE.map(|thickness| (thickness, lost(thickness))).to_vec();
    let measured = stays_within(&points, 0.0);
    let limit = limit_at(
        "least thickness from which a plate keeps its edges, relative to the tolerance",
        measured,
        Some((1.0, "the two sides of what is at most the tolerance thick are one vertex")),
        Bound::AtMost(1.02),
    );
    // The edges as they would be drawn: those of the plate whose vertices are welded.
    let lines = style("lines").expect("a style of this crate");
    let mut collapsed = plate(0.2);
    let options = EdgeOptions { weld: Weld::Within(0.21), ..EdgeOptions::default() };
    let found = find(&collapsed.positions, &collapsed.faces, &collapsed.face_polygon, &[], &options);
    collapsed.faces.iter_mut().flatten().for_each(|vertex| *vertex = found.representative[*vertex as usize]);
    let mut images = Vec::new();
    for model in [plate(0.2), collapsed] {
        let framing = crate::camera::Framing { yaw_rad: 0.9, pitch_rad: 0.3, ..Default::default() };
        let camera = crate::camera::Camera::framed(embedded::cube().positions.into_iter(), 1.0, &framing);
        images.push(frame(&Scene::new(model), &lines, View::new(camera, (150, 150)))?.image());
    }
    Ok(Finding {
        parameter: Axis::logarithmic("thickness, relative to the tolerance", ""),
        error: Axis::linear("share of the plate's 12 edges that is lost", ""),
        curves: vec![curve("a flat box", points, limit)],
        pictures: vec![(
            "a plate, and the same welded within more than its thickness".into(),
            super::super::setup::side_by_side(&images),
        )],
    })
}

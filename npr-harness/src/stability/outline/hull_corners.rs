//! The band of an inverted hull at corners of its outline.

use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::hull_lines::HullLines;
use crate::scene::Scene;
use crate::stability::ink::{beside, crossing, curve, drawn, faceted, ink_along, limit_at, parallel};
use crate::stability::{Axis, Finding, Sweep};
use crate::style::Lines;
use crate::truth::lines::darkness;
use crate::view::View;
use glam::{DVec2, Vec3};
use npr_mesh::Model;
use npr_outline::hull::HullNormals;

pub(super) const HULL_CORNERS: Sweep = Sweep {
    name: "hull-corners",
    technique: "inverted hull",
    what: "Displaced along the normals of its faces a hull comes apart where two of them meet, and the band has a gap at \
           the corner. Displaced along one normal for each position it stays closed, and is thinner beside the corner.",
    needs_adapter: false,
    run: hull_corners,
};

/// The width asked for, px.
const WIDTH_PX: f64 = 24.0;
const SIZE_PX: u32 = 240;
/// The height of the picture, for an outline of radius 1.
const HEIGHT: f64 = 2.6;

/// A regular pyramid of `sides` seen from below its base: its sides all face away. Each face has vertices of its own.
fn pyramid(sides: u32) -> Model {
    let corner = |i: u32| rim(sides, i).extend(0.0).as_vec3();
    let mut positions: Vec<Vec3> = (0..sides).map(corner).collect();
    positions.extend([Vec3::ZERO, Vec3::NEG_Z * 2.0]);
    let next = |i: u32| (i + 1) % sides;
    let faces: Vec<[u32; 3]> = (0..sides).flat_map(|i| [[sides, i, next(i)], [sides + 1, next(i), i]]).collect();
    faceted(&positions, &faces)
}

/// A corner of the base, turned so that no edge runs along the grid.
fn rim(sides: u32, i: u32) -> DVec2 {
    DVec2::from_angle(0.3 + std::f64::consts::TAU * f64::from(i % sides) / f64::from(sides))
}

fn lines(normals: HullNormals) -> Lines {
    Lines::hull(HullLines { width_px: WIDTH_PX as f32, ink: Vec3::ZERO, normals })
}

/// The share of the band that is missing: at the corners, along the bisectors, or across the middles of the edges, whichever
/// is more.
fn missing(ink: &[f64], sides: u32) -> f64 {
    let px = f64::from(SIZE_PX) / HEIGHT;
    let flipped = |v: DVec2| DVec2::new(v.x, -v.y);
    let band = |from: DVec2| {
        let (from_px, along) = (flipped(from) * px + f64::from(SIZE_PX) / 2.0, flipped(from.normalize()));
        // From half a px outside, where the surface's own last pixel ends.
        (0.5 + ink_along(ink, SIZE_PX, from_px + 0.5 * along, along, WIDTH_PX - 0.5)) / WIDTH_PX
    };
    let corners = (0..sides).map(|i| band(rim(sides, i))).sum::<f64>();
    let middles = (0..sides).map(|i| band(rim(sides, i).midpoint(rim(sides, i + 1)))).sum::<f64>();
    1.0 - corners.min(middles) / f64::from(sides)
}

fn hull_corners(executor: &Executor) -> Result<Finding, HarnessError> {
    let sides = [720, 480, 360, 240, 180, 120, 90, 72, 45, 30, 20, 12, 8, 6, 5, 4, 3];
    let view = View::new(parallel(HEIGHT), (SIZE_PX, SIZE_PX));
    let mut curves = Vec::new();
    for (name, normals) in [("normals of vertices", HullNormals::Vertices), ("welded normals", HullNormals::Welded)] {
        let mut points = Vec::new();
        for sides in sides {
            let picture = drawn(executor, &Scene::new(pyramid(sides)), lines(normals), view, 1.0)?;
            let missing = 100.0 * missing(&darkness(&picture), sides);
            points.push((360.0 / f64::from(sides), missing.max(0.0)));
        }
        let limit = match normals {
            HullNormals::Vertices => {
                let measured = crossing(&points, 50.0);
                // Two sides of the pyramid are wedges that are moved apart: the gap is as wide all along.
                let predicted = 2.0 * (0.25 / WIDTH_PX).atan().to_degrees();
                limit_at(
                    "turn of the outline at which half of the band is missing at the corner, degrees",
                    measured,
                    Bound::AtLeast(0.95),
                )
                .predicted(predicted, "2 atan(1 / (4 width)): the gap of 2 width tan(turn / 2) is half a pixel wide")
            }
            HullNormals::Welded => {
                let measured = crossing(&points, 10.0);
                limit_at(
                    "turn of the outline at which the band beside a corner is 10 % too thin, degrees",
                    measured,
                    Bound::AtLeast(49.0),
                )
                .predicted(
                    2.0 * 0.9f64.acos().to_degrees(),
                    "width · cos(turn / 2): the displacement is along the bisector",
                )
            }
        };
        curves.push(curve(name, points, limit));
    }
    let small = View { samples: 2, ..View::new(parallel(3.4), (116, 116)) };
    let scene = Scene::new(pyramid(6));
    let picture = |normals| {
        let hull = HullLines { width_px: 12.0, ink: Vec3::ZERO, normals };
        drawn(executor, &scene, Lines::hull(hull), small, 1.0)
    };
    let picture = beside(&[picture(HullNormals::Vertices)?, picture(HullNormals::Welded)?]);
    Ok(Finding {
        parameter: Axis::linear("turn of the outline at a corner", "degrees"),
        error: Axis::linear("band missing", "%"),
        curves,
        pictures: vec![(
            "A pyramid of six sides from below: bands of 12 px by the normals of its faces, and by one normal for each \
             corner."
                .into(),
            picture,
        )],
    })
}

//! The width of lines against distance, tilt and the near plane.

use crate::camera::Camera;
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::hull_lines::HullLines;
use crate::printed_fins::PrintedLines;
use crate::scene::Scene;
use crate::stability::ink::{
    Random, ahead, beside, black_edges, crossing, curve, drawn, geometric, ink, ink_along, limit, limit_at, parallel,
    plate, worst,
};
use crate::stability::{Axis, Finding, Sweep};
use crate::style::Lines;
use crate::view::View;
use glam::{DVec2, DVec3, Mat4, Quat, Vec3};
use npr_mesh::embedded::{self, placed};
use npr_mesh::{Material, Model};
use npr_outline::hull::HullNormals;

pub(super) const WIDTH_DISTANCE: Sweep = Sweep {
    name: "line-width-distance",
    technique: "line width",
    what: "Fins as printed take their width from clip z, which is 0 at the near plane: they get thinner towards the \
           viewer. Clip w, the distance, keeps the width.",
    needs_adapter: false,
    run: width_distance,
};

pub(super) const WIDTH_TILT: Sweep = Sweep {
    name: "line-width-tilt",
    technique: "line width",
    what: "A fin is as wide as its smooth normal looks from the eye: a boundary's fin points at a viewer who looks at its \
           face. A hull's corner is displaced along the corner's normal, of which a part is along the edge.",
    needs_adapter: false,
    run: width_tilt,
};

pub(super) const NEAR_PLANE: Sweep = Sweep {
    name: "near-plane-lines",
    technique: "line width",
    what: "Fins and hulls are displaced at vertices, in proportion to their distance. Behind the eye that is negative, and \
           where the normals at an edge's ends differ, so do the displacements between them: by more than any width, the \
           farther the end is behind. Edge lines are clipped before they get a width.",
    needs_adapter: false,
    run: near_plane,
};

/// The width asked for, px.
const WIDTH_PX: f32 = 8.0;
/// Samples a px along each axis: fins and hulls have no coverage of their own.
const SAMPLES: u32 = 4;

fn fins(eye_depth: bool) -> Lines {
    Lines::printed(PrintedLines { width_px: WIDTH_PX, eye_depth, ..PrintedLines::default() })
}

fn hull() -> Lines {
    Lines::hull(HullLines { width_px: WIDTH_PX, ink: Vec3::ZERO, normals: HullNormals::Welded })
}

/// The mean ink of the middle columns over `lines` lines across them, in widths.
fn widths_asked(ink: &[f64], width: u32, lines: f64) -> f64 {
    const COLUMNS: u32 = 8;
    let height = f64::from(ink.len() as u32 / width);
    let column =
        |x: u32| ink_along(ink, width, DVec2::new(f64::from(width / 2 - COLUMNS / 2 + x) + 0.5, 0.0), DVec2::Y, height);
    (0..COLUMNS).map(column).sum::<f64>() / f64::from(COLUMNS) / lines / f64::from(WIDTH_PX)
}

fn percent_off(share: f64) -> f64 {
    100.0 * (share - 1.0).abs()
}

fn width_distance(executor: &Executor) -> Result<Finding, HarnessError> {
    const SIZE: (u32, u32) = (24, 160);
    // The near plane is at 1, and a small face behind the picture's border sets the far plane of the printed fins.
    const FAR: f64 = 1000.0;
    // A can across the view, whose radius is this share of its distance.
    const RADIUS: f64 = 0.15;
    let camera = ahead(0.6, 1.0);
    // The contour's depth: the lines of sight touch the can in front of its axis.
    let contour = 1.0 - RADIUS * RADIUS;
    let scene = |depth: f64| {
        let axis = depth / contour;
        let scale = (axis * DVec3::new(RADIUS, 1.0, RADIUS)).as_vec3();
        let across = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2);
        let place = Mat4::from_translation(DVec3::new(0.0, 0.0, -axis).as_vec3())
            * Mat4::from_quat(across)
            * Mat4::from_scale(scale);
        // Without lids, at whose rims the smooth normal is slanted.
        const SIDES: u32 = 128;
        let mut tube = embedded::cylinder(SIDES);
        tube.positions.truncate(2 * SIDES as usize);
        tube.normals.truncate(2 * SIDES as usize);
        tube.faces.truncate(2 * SIDES as usize);
        tube.face_material.truncate(2 * SIDES as usize);
        tube.face_polygon.truncate(2 * SIDES as usize);
        let mut model = placed(tube, place, Material::default());
        let aside = DVec3::new(0.0, 2.0 * FAR, -FAR / 1.01);
        model.append(&plate([DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y].map(|corner| aside + corner)));
        Scene::new(model)
    };
    let view = View { samples: SAMPLES, ..View::new(camera, SIZE) };
    let depths = geometric(1.25, 100.0, 12);
    let methods = [
        ("fins as printed", fins(false)),
        ("fins by eye depth", fins(true)),
        ("edge lines", black_edges(WIDTH_PX)),
        ("inverted hull", hull()),
    ];
    let mut points = vec![Vec::new(); methods.len()];
    for &depth in &depths {
        let scene = scene(depth);
        for ((_, lines), points) in methods.iter().zip(&mut points) {
            let ink = ink(executor, &scene, *lines, view)?;
            points.push((depth, percent_off(widths_asked(&ink, SIZE.0, 2.0))));
        }
    }
    let curves = methods.iter().zip(points).map(|((name, _), points)| {
        let limit = if *name == "fins as printed" {
            // f/(f − n) (1 − n/w) = 0.9
            let predicted = 1.0 / (1.0 - 0.9 * (1.0 - 1.0 / FAR));
            let measured = crossing(&points, 10.0);
            limit_at(
                "distance at which a line is 10 % too thin, in distances of the near plane",
                measured,
                Bound::AtMost(9.5),
            )
            .predicted(predicted, "f / (f − n) · (1 − n / w) = 0.9: listing 1 (Card & Mitchell 2002) with clip z for w")
        } else {
            limit("largest error of the width, %", worst(&points), Bound::AtMost(1.0))
        };
        curve(name, points, limit)
    });
    let curves = curves.collect();
    let picture = {
        // From near to far: the can's axis along the view.
        let road = plate([
            DVec3::new(-0.9, -1.2, -1.05),
            DVec3::new(0.9, -1.2, -1.05),
            DVec3::new(0.9, -1.2, -60.0),
            DVec3::new(-0.9, -1.2, -60.0),
        ]);
        let scene = Scene::new(road);
        let camera = Camera { target: DVec3::new(0.0, -0.55, -1.0), ..ahead(1.5, 1.0) };
        let picture = |lines| drawn(executor, &scene, lines, View { samples: 2, ..View::new(camera, (158, 158)) }, 1.0);
        beside(&[picture(fins(false))?, picture(fins(true))?])
    };
    Ok(Finding {
        parameter: Axis::logarithmic("distance over that of the near plane", ""),
        error: Axis::linear("error of the width", "%"),
        curves,
        pictures: vec![(
            "A road that begins just beyond the near plane: fins of 8 px as printed, from clip z, and from clip w."
                .into(),
            picture,
        )],
    })
}

/// A plate whose normal is `angle_deg` out of the picture's plane; 2 wide and 2 long.
fn tilted_plate(angle_deg: f64) -> Model {
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    // The normal is (0, cos, sin).
    let away = DVec3::new(0.0, sin, -cos);
    plate([-DVec3::X - away, DVec3::X - away, DVec3::X + away, -DVec3::X + away])
}

fn width_tilt(executor: &Executor) -> Result<Finding, HarnessError> {
    const SIZE: (u32, u32) = (64, 192);
    let view = View { samples: SAMPLES, ..View::new(parallel(3.2), SIZE) };
    let angles_deg: Vec<f64> = (1..=11).map(|i| 7.5 * f64::from(i)).collect();
    let mut curves = Vec::new();
    for (name, lines) in [("fins as printed", fins(false)), ("edge lines", black_edges(WIDTH_PX))] {
        let mut points = Vec::new();
        for &angle in &angles_deg {
            let ink = ink(executor, &Scene::new(tilted_plate(angle)), lines, view)?;
            points.push((angle, percent_off(widths_asked(&ink, SIZE.0, 2.0))));
        }
        let limit = if name == "edge lines" {
            limit("largest error of the width, %", worst(&points), Bound::AtMost(1.0))
        } else {
            let measured = crossing(&points, 50.0);
            limit_at(
                "angle of the normal out of the picture's plane at which half of the width is left, degrees",
                measured,
                Bound::AtLeast(59.0),
            )
            .predicted(60.0, "acos ½: the displacement is foreshortened by the cosine")
        };
        curves.push(curve(name, points, limit));
    }
    // A cube that leans towards the viewer: its upper contour is the edge between its top and its back.
    let mut points = Vec::new();
    for &angle in angles_deg.iter().take_while(|&&angle| angle <= 45.0) {
        let lean = Mat4::from_rotation_x(angle.to_radians() as f32);
        let cube = placed(embedded::cube(), lean, Material::default());
        let ink =
            ink(executor, &Scene::new(cube), hull(), View { samples: SAMPLES, ..View::new(parallel(4.4), SIZE) })?;
        points.push((angle, percent_off(widths_asked(&ink, SIZE.0, 2.0))));
    }
    // The corner's normal (1, 1, ±1) leans to (1, cos ± sin, …), and its image has the length of the width.
    let share = |angle_deg: f64| {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        (cos + sin) / (1.0 + (cos + sin) * (cos + sin)).sqrt()
    };
    let least = points.iter().map(|point| percent_off(share(point.0))).fold(0.0, f64::max);
    let formula = "1 − y / √(1 + y²), y = cos α + sin α: the corner's normal (1, 1, −1), leaned by α, has an image whose \
                   length is the width, of which y is across the edge; largest at the least lean";
    let limit = limit("largest error of the width beside a cube's edge, %", worst(&points), Bound::AtMost(27.0));
    curves.push(curve("inverted hull", points, limit.predicted(least, formula)));
    let picture = {
        let view = View { samples: 2, ..View::new(parallel(3.2), (104, 128)) };
        let picture = |angle, lines| drawn(executor, &Scene::new(tilted_plate(angle)), lines, view, 1.0);
        beside(&[picture(20.0, fins(false))?, picture(60.0, fins(false))?, picture(60.0, black_edges(WIDTH_PX))?])
    };
    Ok(Finding {
        parameter: Axis::linear("angle towards the viewer", "degrees"),
        error: Axis::linear("error of the width", "%"),
        curves,
        pictures: vec![(
            "A sheet whose normal points 20° and 60° out of the picture's plane, with fins of 8 px along its border; and \
             at 60° with edge lines of 8 px."
                .into(),
            picture,
        )],
    })
}

fn near_plane(executor: &Executor) -> Result<Finding, HarnessError> {
    const SIZE: (u32, u32) = (120, 90);
    // Nearly edge-on to the left side's normal, so that a fin on either side is wide.
    let rail = |end: f64| {
        let place = |corner: Vec3| {
            let z = if corner.z > 0.0 { end } else { -40.0 };
            DVec3::new(0.31 + 0.3 * f64::from(corner.x), -0.57 + 0.2 * f64::from(corner.y), z).as_vec3()
        };
        let mut bar = embedded::cube();
        bar.positions = bar.positions.iter().map(|&corner| place(corner)).collect();
        bar
    };
    let near = 0.1;
    let camera = Camera { target: DVec3::new(0.15, -0.35, -1.0), ..ahead(1.2, near) };
    let view = View::new(camera, SIZE);
    let ends = geometric(0.1, 1e5, 13);
    let mut random = Random(5);
    // Not at powers of ten, which are as good as any but special.
    let ends: Vec<f64> = ends.iter().map(|end| end * (1.0 + 0.2 * random.unit())).collect();
    let mut curves = Vec::new();
    for (name, lines) in [
        ("edge lines", black_edges(WIDTH_PX)),
        ("fins as printed", fins(false)),
        ("fins by eye depth", fins(true)),
        ("inverted hull", hull()),
    ] {
        // The end just in front of the near plane's crossing lies below the picture: the same picture, without an end
        // behind the eye.
        let whole = ink(executor, &Scene::new(rail(-1.02 * near)), lines, view)?;
        let drawn_px: f64 = whole.iter().sum();
        let mut points = Vec::new();
        for &end in &ends {
            let crossing = ink(executor, &Scene::new(rail(end)), lines, view)?;
            let differs: f64 = whole.iter().zip(&crossing).map(|(a, b)| (a - b).abs()).sum();
            points.push((end / near, 100.0 * differs / drawn_px));
        }
        let limit = if name == "edge lines" {
            limit("largest share of ink that differs, %", worst(&points), Bound::AtMost(1.0))
        } else {
            let least = if name == "inverted hull" { 6.3 } else { 9.7 };
            let what = "distance behind the eye at which a tenth of the ink differs, in distances of the near plane";
            limit_at(what, crossing(&points, 10.0), Bound::AtLeast(least))
        };
        curves.push(curve(name, points, limit));
    }
    let picture = |lines| drawn(executor, &Scene::new(rail(ends[2])), lines, View::new(camera, (104, 100)), 1.0);
    let picture = beside(&[picture(black_edges(3.0))?, picture(fins(true))?, picture(hull())?]);
    Ok(Finding {
        parameter: Axis::logarithmic("end behind the eye, distances of the near plane", ""),
        error: Axis::linear("ink that differs from a bar that ends in front of the eye", "%"),
        curves,
        pictures: vec![(
            "A bar that begins 10 near-plane distances behind the eye: edge lines, fins by eye depth, inverted hull. The last two are displaced at vertices."
                .into(),
            picture,
        )],
    })
}

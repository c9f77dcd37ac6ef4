//! Normals of low precision near tangency: edges misjudged, and fins torn.

use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::Executor;
use crate::figures::Setting;
use crate::picture::Image;
use crate::printed_fins::PrintedLines;
use crate::stability::ink::{Random, beside, curve, drawn, enlarged, geometric, last_above, limit, limit_at};
use crate::stability::{Axis, Finding, Sweep};
use crate::style::Lines;
use crate::view::View;
use glam::{DMat4, DVec3, Quat, Vec3};
use npr_mesh::{edges, embedded};
use npr_outline::fin_printed::{FinDepth, FinView, PrintedFin, PrintedFins, fin_printed_triangles, printed_fins};
use npr_outline::normal_format::{NormalFormat, fibonacci_sphere};

pub(super) const SILHOUETTE_NORMALS: Sweep = Sweep {
    name: "silhouette-normals",
    technique: "lines from edges",
    what: "An edge is a silhouette if the eye is in front of one of its faces and behind the other. A rounded normal \
           puts the eye on the wrong side of a face that is seen nearly edge-on.",
    needs_adapter: false,
    run: silhouette_normals,
};

pub(super) const TORN_FINS: Sweep = Sweep {
    name: "torn-fins",
    technique: "printed fins",
    what: "Each vertex of a fin is tested by itself. A rounded normal is not perpendicular to its face, so that the two \
           ends of an edge lie on different sides of its plane, and a triangle is left of the fin.",
    needs_adapter: false,
    run: torn_fins,
};

/// The name of a format, and the largest angle between a normal and its code, radians, with the formula.
fn format_error(format: NormalFormat) -> (&'static str, f64, &'static str) {
    // Each number is rounded by half a step, so that the error is at most half of a cube's diagonal.
    let tuple = |steps: f64| (3f64.sqrt() / (2.0 * steps)).asin();
    // In the middle of an octant the grid of the unfolded octahedron is one of equilateral triangles whose sides are
    // √2 steps, at 1/√3 from the origin. The nearest of their corners is at most a side over √3 away.
    let octahedral = |steps: f64| 2f64.sqrt() / steps;
    match format {
        NormalFormat::F32 => {
            // Each normal and view component, each product and both sums are rounded by at most 2⁻²⁴.
            let rounded = 5.0 * 2f64.powi(-24);
            ("f32", rounded, "5 roundings of 2⁻²⁴ in a dot product of rounded vectors (Higham 2002, section 3.1)")
        }
        NormalFormat::Snorm16 => ("i16", tuple(32767.0), "asin(√3 / (2 · 32767)): half the diagonal of a step"),
        NormalFormat::Snorm8 => ("i8", tuple(127.0), "asin(√3 / (2 · 127)): half the diagonal of a step"),
        NormalFormat::Oct16 => (
            "octahedral 16",
            octahedral(32767.0),
            "√2 / 32767: circumradius of the grid's triangles, centre of an octant",
        ),
        NormalFormat::Oct8 => {
            ("octahedral 8", octahedral(127.0), "√2 / 127: circumradius of the grid's triangles, centre of an octant")
        }
    }
}

fn silhouette_normals(_: &Executor) -> Result<Finding, HarnessError> {
    const NORMALS: usize = 4000;
    const AROUND: u32 = 8;
    let angles_deg = geometric(1e-6, 2.0, 104);
    let mut curves = Vec::new();
    for format in NormalFormat::ALL {
        let (name, error_rad, formula) = format_error(format);
        // Directions from which a face is seen edge-on, beside its normal and the normal that a shader reads.
        let mut random = Random(1);
        let faces: Vec<(DVec3, DVec3, Vec3)> = fibonacci_sphere(NORMALS)
            .flat_map(|normal| {
                let stored = format.quantised(normal.as_vec3());
                let (across, along) = normal.any_orthonormal_pair();
                let turned = std::f64::consts::TAU * random.unit();
                (0..AROUND).map(move |i| {
                    let angle = turned + std::f64::consts::TAU * f64::from(i) / f64::from(AROUND);
                    (normal, across * angle.cos() + along * angle.sin(), stored)
                })
            })
            .collect();
        let share = |angle_deg: f64| {
            let (sin, cos) = angle_deg.to_radians().sin_cos();
            // The edge's other face is far from tangency, so that the edge is misjudged where this face is.
            let wrong = faces.iter().filter(|(normal, tangent, stored)| {
                let view = (*tangent * cos + *normal * sin).as_vec3();
                view.dot(*stored) <= 0.0
            });
            100.0 * wrong.count() as f64 / faces.len() as f64
        };
        let points: Vec<(f64, f64)> = angles_deg.iter().map(|&angle| (angle, share(angle))).collect();
        let measured = last_above(&points, 0.0);
        let predicted = error_rad.to_degrees();
        let limit = limit_at(
            "largest angle to tangency at which an edge is misjudged, degrees",
            measured,
            // No rounding of f32 in the decoders adds more than a fiftieth.
            Bound::AtMost(1.02 * predicted),
        );
        curves.push(curve(name, points, limit.predicted(predicted, formula)));
    }
    Ok(Finding {
        parameter: Axis::logarithmic("angle of a face to tangency", "degrees"),
        error: Axis::linear("edges misjudged", "%"),
        curves,
        pictures: vec![(
            "Faces around the contour of a ball, 60° of it from left to right, from 1° behind (above) to 1° in front: black \
             where they are judged to face the viewer. Normals in f32, in bytes, and octahedral in two bytes."
                .into(),
            beside(&[NormalFormat::F32, NormalFormat::Snorm8, NormalFormat::Oct8].map(judged)),
        )],
    })
}

/// Black where a face is judged to face the viewer: to the right around a ball's contour, down from 1° behind tangency to
/// 1° in front of it.
fn judged(format: NormalFormat) -> Image {
    const SIZE: (u32, u32) = (104, 100);
    let view = DVec3::new(0.35, 0.2, 0.9).normalize();
    let (across, along) = view.any_orthonormal_pair();
    let mut picture = Image::filled(SIZE.0, SIZE.1, [255; 4]);
    for y in 0..SIZE.1 {
        let (sin, cos) = (2.0 * (f64::from(y) + 0.5) / f64::from(SIZE.1) - 1.0).to_radians().sin_cos();
        for x in 0..SIZE.0 {
            let around = (60.0 * f64::from(x) / f64::from(SIZE.0)).to_radians();
            let normal = (across * around.cos() + along * around.sin()) * cos + view * sin;
            if format.quantised(normal.as_vec3()).dot(view.as_vec3()) > 0.0 {
                picture.set_pixel(x, y, [0, 0, 0, 255]);
            }
        }
    }
    picture
}

/// The number of sides of the can whose fins are torn.
const SIDES: u32 = 64;

fn torn_fins(executor: &Executor) -> Result<Finding, HarnessError> {
    let lengths = geometric(0.02, 2.0, 9);
    // Turned at random, so that normals do not fall on numbers of the format.
    let turned = Quat::from_euler(glam::EulerRot::YXZ, 0.7, 0.4, 1.1);
    let fins_of = |length: f64| {
        let mut can = embedded::cylinder(SIDES);
        for position in &mut can.positions {
            *position = turned * (*position * Vec3::new(1e-3, 0.5 * length as f32, 1e-3));
        }
        for normal in &mut can.normals {
            *normal = turned * *normal;
        }
        let found = edges::find(&can.positions, &can.faces, &can.face_polygon, &can.face_material, &Default::default());
        let fins = printed_fins(&can, &found);
        let is_side = |fin: &[PrintedFin]| fin[0].position.distance(fin[1].position) > 0.9 * length as f32;
        let sides = fins.vertices.chunks_exact(4).filter(|fin| is_side(fin)).flatten().copied().collect();
        PrintedFins { vertices: sides, indices: Vec::new() }
    };
    let mut random = Random(2);
    // Eyes at distance 1, within 30° of the plane across the can.
    let axis = (turned * Vec3::Y).as_dvec3();
    let eyes: Vec<DVec3> =
        std::iter::repeat_with(|| random.direction()).filter(|eye| eye.dot(axis).abs() < 0.5).take(1500).collect();
    let mut curves = Vec::new();
    for format in [NormalFormat::F32, NormalFormat::Snorm16, NormalFormat::Snorm8, NormalFormat::Oct8] {
        let mut points = Vec::new();
        for &length in &lengths {
            let fins = fins_of(length).quantised(format);
            let (mut drawn, mut torn) = (0u32, 0u32);
            for &eye in &eyes {
                let view = FinView {
                    clip_from_world: DMat4::IDENTITY,
                    eye,
                    thickness: 1.0,
                    depth: FinDepth::Eye,
                    reversed: false,
                };
                for fin in fins.vertices.chunks_exact(4) {
                    let one = PrintedFins { vertices: fin.to_vec(), indices: Vec::new() };
                    let triangles = fin_printed_triangles(&one, &view).len();
                    drawn += u32::from(triangles > 0);
                    torn += u32::from(triangles == 1);
                }
            }
            points.push((length, 100.0 * f64::from(torn) / f64::from(drawn.max(1))));
        }
        let (name, _, _) = format_error(format);
        let longest = points.last().map_or(0.0, |point| point.1);
        let what = "fins torn of those drawn, edges twice as long as their distance, %";
        // The two planes that bound the views in which a side's edge is a silhouette are each tilted along the edge by
        // the error of a normal's component: the views in between have half a fin.
        let mean_error = |steps: f64| 0.25 / steps;
        let turn_rad = std::f64::consts::TAU / f64::from(SIDES);
        let length = lengths[lengths.len() - 1];
        let torn = 100.0 * 2.0 * length * mean_error(127.0) / turn_rad;
        let formula = "2 · length · mean error of a component, a quarter step, over the turn from side to side";
        let limit = match format {
            NormalFormat::Snorm8 => limit(what, longest, Bound::AtMost(11.0)).predicted(torn, formula),
            NormalFormat::Oct8 => limit(what, longest, Bound::AtMost(15.5)),
            _ => limit(what, longest, Bound::AtMost(0.1)),
        };
        curves.push(curve(name, points, limit));
    }
    let (scene, camera) = (Setting::Cans.scene(), Setting::Cans.camera());
    let fins = |normals| {
        let lines = Lines::printed(PrintedLines { normals, width_px: 6.0, ..PrintedLines::default() });
        // The right side of the left can.
        let picture = drawn(executor, &scene, lines, View::new(camera, (480, 300)), 1.0)?;
        Ok::<_, HarnessError>(enlarged(&picture, [95, 45, 72, 195], 1))
    };
    let picture = beside(&[fins(NormalFormat::F32)?, fins(NormalFormat::Snorm8)?, fins(NormalFormat::Oct8)?]);
    Ok(Finding {
        parameter: Axis::logarithmic("length of an edge over its distance", ""),
        error: Axis::linear("fins torn of those drawn", "%"),
        curves,
        pictures: vec![(
            "The right side of a can of some 400 sides, drawn by printed fins of 6 px with normals in f32, in bytes, and \
             octahedral in two bytes: halves of fins are left of the line, and slanted ones appear beside it."
                .into(),
            picture,
        )],
    })
}

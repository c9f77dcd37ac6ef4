//! Faces in one plane that overlap.

use super::super::setup::{colored, curve, frame, front, limit, lit, side_by_side, worst};
use super::super::{Axis, Finding, Sweep};
use crate::check::Limit as Bound;
use crate::error::HarnessError;
use crate::executor::{Executor, Picture};
use crate::picture::Image;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::shade::lambert::Lambert;
use crate::view::View;
use glam::{DQuat, DVec2, DVec3};
use npr_mesh::Model;

pub(super) const SWEEP: Sweep = Sweep {
    name: "coincident-faces",
    technique: "surfaces",
    what: "Where two faces lie in one plane, rounding must not decide which of them is seen: the one turned to the eye is, \
           and of two that are, the later in the file.",
    needs_adapter: false,
    run: measure,
};

pub(super) const ON_DEVICE: Sweep = Sweep {
    name: "coincident-faces-executors",
    technique: "surfaces",
    what: "Executors that round differently must show the same of two faces in one plane.",
    needs_adapter: true,
    run: on_device,
};

const FORMULA: &str = "faces are cut to equal triangles, of which one is left on each side";
const TILTS_DEG: [f64; 9] = [0.0, 5.0, 12.0, 20.0, 31.0, 42.0, 53.0, 64.0, 75.0];
const SIZE: u32 = 104;

/// Two overlapping faces.
#[derive(Clone, Copy, PartialEq)]
enum Overlap {
    /// The same square, cut along the same diagonal.
    SameDiagonal,
    /// The same square, cut along the other one.
    OtherDiagonal,
    /// A smaller square within a square.
    Mark,
    /// The same square with its back to the eye.
    BackToBack,
}

const OVERLAPS: [(&str, Overlap); 4] = [
    ("cut along the same diagonal", Overlap::SameDiagonal),
    ("cut along the other diagonal", Overlap::OtherDiagonal),
    ("a mark on a sheet", Overlap::Mark),
    ("back to back", Overlap::BackToBack),
];

/// A red square, turned about an oblique axis, and what lies on it in blue. The corners are rounded to f32.
fn model(overlap: Overlap, tilt_deg: f64) -> Model {
    let turned = DQuat::from_axis_angle(DVec3::new(0.6, 0.8, 0.0), tilt_deg.to_radians()) * DQuat::from_rotation_z(0.3);
    let corners = [DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0), DVec2::new(1.0, 1.0), DVec2::new(-1.0, 1.0)];
    let on_plane = |at: DVec2| (turned * at.extend(0.0) + DVec3::new(0.01, 0.02, 0.3)).as_vec3();
    let size = if overlap == Overlap::Mark { 0.7 } else { 1.0 };
    let positions = corners.into_iter().chain(corners.map(|at| at * size)).map(on_plane).collect();
    let second = match overlap {
        Overlap::SameDiagonal | Overlap::Mark => [[4, 5, 6], [4, 6, 7]],
        Overlap::OtherDiagonal => [[5, 6, 7], [5, 7, 4]],
        Overlap::BackToBack => [[4, 6, 5], [4, 7, 6]],
    };
    Model {
        positions,
        normals: vec![(turned * DVec3::Z).as_vec3(); 8],
        faces: [[0, 1, 2], [0, 2, 3]].into_iter().chain(second).collect(),
        face_material: vec![0, 0, 1, 1],
        materials: vec![colored(1.0, 0.0, 0.0), colored(0.0, 0.0, 1.0)],
        ..Model::default()
    }
}

fn scene(overlap: Overlap, tilt_deg: f64) -> Scene {
    Scene::new(model(overlap, tilt_deg))
}

/// The numbers of red and of blue pixels, among those that both faces cover.
fn counts(image: &Image, overlap: Overlap, tilt_deg: f64) -> Result<(f64, f64), HarnessError> {
    // Where the second face is seen without the first.
    let mut alone = model(overlap, tilt_deg);
    alone.faces.drain(..2);
    alone.face_material.drain(..2);
    let covered = frame(&Scene::new(alone), &lit(flat(), DVec3::Z), view())?;
    let pixels = image.rgba8.chunks_exact(4).zip(&covered.depth).filter(|(_, depth)| **depth > 0.0);
    Ok(pixels.fold(
        (0.0, 0.0),
        |(red, blue), (pixel, _)| {
            if pixel[0] > pixel[2] { (red + 1.0, blue) } else { (red, blue + 1.0) }
        },
    ))
}

/// The colours of the materials, whatever the light.
fn flat() -> Shade {
    Shade::Lambert(Lambert { ambient: 1.0 })
}

fn view() -> View {
    View::new(front(2.9), (SIZE, SIZE))
}

fn measure(_: &Executor) -> Result<Finding, HarnessError> {
    let (mut curves, mut images) = (Vec::new(), Vec::new());
    for (name, overlap) in OVERLAPS {
        let mut points = Vec::new();
        let shown_deg = match overlap {
            Overlap::SameDiagonal => f64::NAN,
            Overlap::OtherDiagonal => 0.0,
            Overlap::Mark | Overlap::BackToBack => 42.0,
        };
        for tilt_deg in TILTS_DEG {
            let image = frame(&scene(overlap, tilt_deg), &lit(flat(), DVec3::Z), view())?.image();
            let (red, blue) = counts(&image, overlap, tilt_deg)?;
            // The red square is turned to the eye, or else the blue one is the later.
            let wrong = if overlap == Overlap::BackToBack { blue } else { red };
            points.push((tilt_deg, wrong / (red + blue)));
            if tilt_deg == shown_deg {
                images.push(image);
            }
        }
        let measured = worst(&points);
        let what = "largest share of the pixels that show the other of two faces in one plane";
        curves.push(curve(name, points, limit(what, measured, Some((0.0, FORMULA)), Bound::AtMost(0.0))));
    }
    Ok(Finding {
        parameter: Axis::linear("tilt", "degrees"),
        error: Axis::linear("share of the pixels that show the other face", ""),
        curves,
        pictures: vec![(
            "a square on another: cut along the other diagonal; a mark, tilted by 42°; back to back, tilted by 42°"
                .into(),
            side_by_side(&images),
        )],
    })
}

fn on_device(executor: &Executor) -> Result<Finding, HarnessError> {
    let style = lit(flat(), DVec3::Z);
    let (mut curves, mut images) = (Vec::new(), Vec::new());
    for (name, overlap) in OVERLAPS {
        let mut points = Vec::new();
        for tilt_deg in [0.0, 20.0, 42.0, 64.0] {
            let scene = scene(overlap, tilt_deg);
            let on_cpu = frame(&scene, &style, view())?.image();
            let on_device = executor.render(&Picture::new(&scene, &style, view()), &|_| {})?;
            let pixels = on_cpu.rgba8.chunks_exact(4).zip(on_device.rgba8.chunks_exact(4));
            // Red against blue: pixels at the border, where one of the two shows paper, do not count.
            let differ = |(a, b): &(&[u8], &[u8])| a[1] < 128 && b[1] < 128 && a[0].abs_diff(b[0]) > 128;
            let (red, blue) = counts(&on_cpu, overlap, tilt_deg)?;
            points.push((tilt_deg, pixels.filter(differ).count() as f64 / (red + blue)));
            if tilt_deg == 42.0 && overlap == Overlap::OtherDiagonal {
                images = vec![on_cpu, on_device];
            }
        }
        let measured = worst(&points);
        let what = "largest share of the pixels in which the executors show different faces";
        curves.push(curve(name, points, limit(what, measured, Some((0.0, FORMULA)), Bound::AtMost(0.0))));
    }
    Ok(Finding {
        parameter: Axis::linear("tilt", "degrees"),
        error: Axis::linear("share of the pixels that differ between executors", ""),
        curves,
        pictures: vec![("cut along the other diagonal: on the CPU, on a device".into(), side_by_side(&images))],
    })
}

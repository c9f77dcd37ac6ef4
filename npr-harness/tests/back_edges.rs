//! Edges between two back faces of a solid are hidden however near to the contour they are.
#![allow(clippy::print_stdout)]

mod common;

use common::{device, rendered};
use glam::{DVec2, Mat4, Vec3};
use npr_harness::camera::{Camera, Framing};
use npr_harness::executor::Executor;
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::shade::Shade;
use npr_harness::style::{Lines, Style, style};
use npr_harness::truth::lines::{TrueSegment, darkness, true_lines};
use npr_harness::view::View;
use npr_mesh::{AlphaMode, Material, embedded};
use npr_outline::line_style::{LineStyle, widths_px};

const SIZE: (u32, u32) = (200, 150);

fn executors() -> Vec<Executor> {
    device().into_iter().chain([Executor::Cpu { why: None }]).collect()
}

fn edges() -> Style {
    let lines = Lines::edges(LineStyle { width_px: widths_px(1.5, 1.5, 1.5, 0.0), ink: [0.0, 0.0, 0.0, 1.0] });
    Style { paper: Vec3::ONE, shade: Shade::Paper, shadow: None, lines, ..style("lines").expect("a style") }
}

fn plate(half_thickness: f32, material: Material) -> Scene {
    Scene::new(embedded::placed(embedded::cube(), Mat4::from_scale(Vec3::new(2.0, 1.5, half_thickness)), material))
}

fn camera(scene: &Scene, yaw_deg: f64, pitch_deg: f64) -> Camera {
    let framing = Framing {
        yaw_rad: f64::to_radians(yaw_deg),
        pitch_rad: f64::to_radians(pitch_deg),
        fov_y_rad: Some(f64::to_radians(70.0)),
        ..Framing::default()
    };
    Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing)
}

/// The ink across a line, px, at columns or rows along it, without its ends.
fn ink_across(dark: &[f64], [from, to]: [DVec2; 2]) -> Vec<f64> {
    let (steep, span) = ((to - from).y.abs() > (to - from).x.abs(), to - from);
    let (start, end, per, cos) = match steep {
        true => (from.y.min(to.y), from.y.max(to.y), span.x / span.y, span.y.abs() / span.length()),
        false => (from.x.min(to.x), from.x.max(to.x), span.y / span.x, span.x.abs() / span.length()),
    };
    let at = |along: i64, across: i64| {
        let (x, y) = if steep { (across, along) } else { (along, across) };
        let inside = x >= 0 && y >= 0 && x < i64::from(SIZE.0) && y < i64::from(SIZE.1);
        if inside { dark[(y * i64::from(SIZE.0) + x) as usize] } else { 0.0 }
    };
    let (first, offset) = if steep { (from.y, from.x) } else { (from.x, from.y) };
    ((start + 9.0).ceil() as i64..(end - 9.0) as i64)
        .map(|along| {
            let center = (offset + (along as f64 + 0.5 - first) * per).floor() as i64;
            (center - 6..=center + 6).map(|across| at(along, across)).sum::<f64>() * cos
        })
        .collect()
}

/// A plate so thin that its sides are a fraction of a pixel: each line of its rim is as wide along its whole length as the
/// lines that are really there, whatever is behind it.
#[test]
fn the_rim_of_a_thin_plate_is_not_dotted_by_the_lines_behind_it() {
    for half_thickness in [0.02, 0.01, 0.002] {
        for (yaw_deg, pitch_deg) in [(35.0, 20.0), (35.0, -20.0), (-35.0, 20.0), (160.0, 10.0)] {
            let scene = plate(half_thickness, Material::default());
            let camera = camera(&scene, yaw_deg, pitch_deg);
            let truth = true_lines(&scene, &camera, SIZE, 0.5);
            // Lines beside which no other is seen.
            let middle = |segment: &TrueSegment| segment.ends_px[0].midpoint(segment.ends_px[1]);
            let is_single = |segment: &&TrueSegment| {
                truth.segments.iter().filter(|other| middle(other).distance(middle(segment)) < 12.0).count() == 1
            };
            let singles: Vec<_> = truth.segments.iter().filter(is_single).collect();
            for executor in executors() {
                let image = rendered(&executor, &scene, &edges(), &camera, SIZE);
                let dark = darkness(&image);
                for segment in &singles {
                    for ink in ink_across(&dark, segment.ends_px) {
                        assert!(
                            (ink - 1.5).abs() < 0.2,
                            "{} {half_thickness} {yaw_deg}: {ink} px at {:?}",
                            executor.describe(),
                            segment.ends_px
                        );
                    }
                }
            }
            assert!(singles.len() >= 2, "{half_thickness} {yaw_deg}: {}", singles.len());
        }
    }
}

/// A cube shows nine of its twelve edges. What is open, see-through or seen from inside may show all of them.
#[test]
fn only_edges_of_front_faces_are_lines_of_a_closed_opaque_solid() {
    let count = |scene: &Scene, camera: &Camera| {
        let capabilities = Executor::Cpu { why: None }.capabilities();
        let plan = Plan::new(scene, &edges(), &View::new(*camera, SIZE), &capabilities).expect("a plan");
        plan.lines(scene).1.iter().sum::<usize>()
    };
    let cube = plate(1.0, Material::default());
    let outside = camera(&cube, 35.0, 20.0);
    assert_eq!(count(&cube, &outside), 9);
    let inside = Camera { eye: glam::DVec3::new(0.2, 0.1, 0.0), near: 1e-3, ..outside };
    assert_eq!(count(&cube, &inside), 12);
    let base_color = glam::Vec4::new(1.0, 1.0, 1.0, 0.3);
    let glass = plate(1.0, Material { alpha_mode: AlphaMode::Blend, base_color, ..Material::default() });
    assert_eq!(count(&glass, &outside), 12);
    let mut open = embedded::cube();
    open.faces.truncate(10);
    open.face_polygon.truncate(10);
    open.face_material.truncate(10);
    assert_eq!(count(&Scene::new(open), &outside), 12);
}

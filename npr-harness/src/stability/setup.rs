//! What several sweeps share: views, small meshes, pictures on the CPU, and where a curve crosses a value.

use super::{Curve, Limit};
use crate::camera::{Camera, Projection};
use crate::capabilities::Capabilities;
use crate::check::Limit as Bound;
use crate::cpu::{self, CpuFrame, CpuOptions};
use crate::error::HarnessError;
use crate::lights::{LightFrame, StyleLight};
use crate::picture::Image;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::style::{Lines, Style, style};
use crate::truth::shadows::States;
use crate::view::View;
use glam::{DVec2, DVec3, Vec3, Vec4};
use npr_imagespace::shadow::ShadowState;
use npr_mesh::{Material, Model};
use npr_toon::source::Light;

/// A parallel view along −Z of `height` world units around the origin.
pub(super) fn front(height: f64) -> Camera {
    let projection = Projection::Orthographic { height, far: 20.0 };
    Camera { eye: DVec3::Z * 10.0, target: DVec3::ZERO, up: DVec3::Y, projection, near: 0.1 }
}

/// A white style without lines, with a directional light from a direction in the model's axes.
pub(super) fn lit(shade: Shade, to_light: DVec3) -> Style {
    let light = Light::directional(to_light.as_vec3());
    Style {
        paper: Vec3::ONE,
        shade,
        lights: vec![StyleLight { light, frame: LightFrame::World }],
        lines: Lines::NONE,
        ..style("toon").expect("a style of this crate")
    }
}

/// Renders with the CPU executor, whatever memory it takes.
pub(super) fn frame(scene: &Scene, style: &Style, view: View) -> Result<CpuFrame, HarnessError> {
    frame_at(scene, style, view, DVec2::ZERO)
}

/// As [`frame`], with samples that are offset from the pixel centres.
pub(super) fn frame_at(scene: &Scene, style: &Style, view: View, shift_px: DVec2) -> Result<CpuFrame, HarnessError> {
    let plan = Plan::new(scene, style, &view, &Capabilities::RAY_CASTER)?;
    Ok(cpu::render(scene, &plan, &CpuOptions { shift_px, ..CpuOptions::default() }, &|_| {}))
}

/// The red component of each pixel: the tone of what is gray.
pub(super) fn tones(frame: &CpuFrame) -> Vec<f64> {
    frame.color.iter().map(|color| color.x).collect()
}

/// A material of one colour.
pub(super) fn colored(red: f32, green: f32, blue: f32) -> Material {
    Material { base_color: Vec4::new(red, green, blue, 1.0), ..Material::default() }
}

/// A model of flat faces in one white material, each with its own corners and its own normal.
pub(super) fn faceted(triangles: &[[DVec3; 3]]) -> Model {
    let mut model = Model { materials: vec![colored(1.0, 1.0, 1.0)], ..Model::default() };
    for (number, &[a, b, c]) in (0u32..).zip(triangles) {
        model.positions.extend([a, b, c].map(DVec3::as_vec3));
        model.normals.extend([(b - a).cross(c - a).normalize_or_zero().as_vec3(); 3]);
        model.faces.push([3 * number, 3 * number + 1, 3 * number + 2]);
    }
    model.face_material = vec![0; model.faces.len()];
    model
}

/// A model in white.
pub(super) fn whitened(model: Model) -> Model {
    Model { materials: vec![colored(1.0, 1.0, 1.0)], face_material: vec![0; model.faces.len()], ..model }
}

/// A curve, of points by ascending parameter.
pub(super) fn curve(name: &str, points: Vec<(f64, f64)>, limit: Limit) -> Curve {
    Curve { name: name.into(), points, limit }
}

/// A limit that lies in the method and is an error, with the value that a formula predicts.
pub(super) fn limit(what: &str, measured: f64, predicted: Option<(f64, &str)>, bound: Bound) -> Limit {
    let predicted = predicted.map(|(value, formula)| (value, formula.to_owned()));
    Limit { what: what.into(), measured, is_of_parameter: false, predicted, bound, to_be_mended: None }
}

/// The same for a value of the parameter.
pub(super) fn limit_at(what: &str, measured: f64, predicted: Option<(f64, &str)>, bound: Bound) -> Limit {
    Limit { is_of_parameter: true, ..limit(what, measured, predicted, bound) }
}

/// The parameter from which on the error stays at most `most`: between the last point above it and the next,
/// interpolated on logarithmic scales; the first parameter if no point is above, infinite if the last one is.
pub(super) fn stays_within(points: &[(f64, f64)], most: f64) -> f64 {
    let Some(last) = points.iter().rposition(|point| point.1 > most) else {
        return points.first().map_or(f64::INFINITY, |point| point.0);
    };
    points.get(last + 1).map_or(f64::INFINITY, |&next| crossing(points[last], next, most))
}

/// The parameter at which the error first exceeds `most`, likewise; infinite if it never does.
pub(super) fn first_over(points: &[(f64, f64)], most: f64) -> f64 {
    match points.iter().position(|point| point.1 > most) {
        None => f64::INFINITY,
        Some(0) => points[0].0,
        Some(first) => crossing(points[first - 1], points[first], most),
    }
}

/// Where the error is `at` between two points, by its logarithm where both errors are positive.
fn crossing(a: (f64, f64), b: (f64, f64), at: f64) -> f64 {
    if a.0 > 0.0 && b.0 > 0.0 && a.1 > 0.0 && b.1 > 0.0 {
        let share = (at / a.1).ln() / (b.1 / a.1).ln();
        return a.0 * (b.0 / a.0).powf(share);
    }
    a.0 + (b.0 - a.0) * (at - a.1) / (b.1 - a.1)
}

/// The largest error.
pub(super) fn worst(points: &[(f64, f64)]) -> f64 {
    points.iter().fold(0.0, |worst, point| worst.max(point.1))
}

/// Pictures beside each other, with a black line between them.
pub(super) fn side_by_side(images: &[Image]) -> Image {
    const BETWEEN: u32 = 2;
    let width = images.iter().map(|image| image.width + BETWEEN).sum::<u32>().saturating_sub(BETWEEN);
    let height = images.iter().map(|image| image.height).max().unwrap_or(0);
    let mut rgba8 = [0, 0, 0, 255].repeat(width as usize * height as usize);
    let mut left = 0;
    for image in images {
        for y in 0..image.height {
            let from = &image.rgba8[(y * image.width * 4) as usize..][..image.width as usize * 4];
            rgba8[((y * width + left) * 4) as usize..][..from.len()].copy_from_slice(from);
        }
        left += image.width + BETWEEN;
    }
    Image::new(width, height, rgba8).expect("four bytes a pixel")
}

/// A part of a picture, each pixel as a square of `factor`² pixels.
pub(super) fn magnified(image: &Image, (left, top): (u32, u32), (width, height): (u32, u32), factor: u32) -> Image {
    let pixel = |x: u32, y: u32| {
        let at = ((top + y / factor) * image.width + left + x / factor) as usize * 4;
        &image.rgba8[at..at + 4]
    };
    let (columns, rows) = (width * factor, height * factor);
    let rgba8 = (0..rows).flat_map(|y| (0..columns).flat_map(move |x| pixel(x, y).to_vec())).collect();
    Image::new(columns, rows, rgba8).expect("four bytes a pixel")
}

/// A part of the shadow states of a picture: light gray where light falls, dark gray in cast shadow, and in between where a
/// surface is turned away from the light.
pub(super) fn states_image(states: &States, (left, top): (u32, u32), (width, height): (u32, u32)) -> Image {
    let gray = |state: Option<ShadowState>| match state {
        None => 255,
        Some(ShadowState::Lit) => 205,
        Some(ShadowState::BackFacing) => 140,
        Some(ShadowState::Cast) => 70,
    };
    let pixel = |x: u32, y: u32| gray(states.states[((top + y) * states.size.0 + left + x) as usize]);
    let rgba8 = (0..height).flat_map(|y| (0..width).flat_map(move |x| [pixel(x, y), pixel(x, y), pixel(x, y), 255]));
    Image::new(width, height, rgba8.collect()).expect("four bytes a pixel")
}

/// The number of a seeded sequence at an index, 0..1: [`Random`] from there on.
pub(super) fn uniform(seed: u64, index: u64) -> f64 {
    Random(seed.wrapping_add(index.wrapping_mul(Random::STEP))).unit()
}

/// A generator of uniform numbers, seeded: SplitMix64 (Steele, Lea & Flood 2014).
pub(super) struct Random(pub(super) u64);

impl Random {
    /// The difference of successive states: 2⁶⁴ over the golden ratio, odd.
    pub(super) const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

    /// 64 random bits.
    pub(super) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(Self::STEP);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    /// 0..1.
    pub(super) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A direction, evenly distributed over the sphere.
    pub(super) fn direction(&mut self) -> DVec3 {
        let z = 2.0 * self.unit() - 1.0;
        let around = std::f64::consts::TAU * self.unit();
        DVec2::from_angle(around).extend(0.0) * (1.0 - z * z).max(0.0).sqrt() + DVec3::Z * z
    }
}

//! Black lines on white paper for sweeps: rendered, measured, and put beside each other.

use super::Limit;
pub(super) use super::setup::{Random, curve, worst};
use crate::camera::{Camera, Projection};
use crate::check::{Limit as Bound, one_px_style};
use crate::error::HarnessError;
use crate::executor::{Executor, Picture};
use crate::picture::Image;
use crate::scene::Scene;
use crate::style::Lines;
use crate::truth::lines::darkness;
use crate::view::View;
use glam::{DVec2, DVec3, Vec3};
use npr_mesh::{Material, Model};
use npr_outline::line_style::LineStyle;

/// White, opaque.
const PAPER: [u8; 4] = [255; 4];

/// Silhouettes, boundaries and creases of one width in black.
pub(super) fn black_edges(width_px: f32) -> Lines {
    Lines::edges(LineStyle { width_px: [width_px, width_px, width_px, 0.0, 0.0], ink: [0.0, 0.0, 0.0, 1.0] })
}

/// A picture of lines on unpainted surfaces; edges that turn by more than `crease_angle_rad` are creases.
pub(super) fn drawn(
    executor: &Executor,
    scene: &Scene,
    lines: Lines,
    view: View,
    crease_angle_rad: f32,
) -> Result<Image, HarnessError> {
    let style = crate::style::Style { crease_angle_rad, ..one_px_style(lines) };
    executor.render(&Picture::new(scene, &style, view), &|_| {})
}

/// The ink per pixel, 0..=1, of [`drawn`] with creases from 45°.
pub(super) fn ink(executor: &Executor, scene: &Scene, lines: Lines, view: View) -> Result<Vec<f64>, HarnessError> {
    Ok(darkness(&drawn(executor, scene, lines, view, std::f32::consts::FRAC_PI_4)?))
}

/// A camera at the origin that looks down −z.
pub(super) fn ahead(fov_y_rad: f64, near: f64) -> Camera {
    let projection = Projection::Perspective { fov_y_rad };
    Camera { eye: DVec3::ZERO, target: DVec3::NEG_Z, up: DVec3::Y, projection, near }
}

/// A camera that looks down −z at the origin in parallel rays; the picture is `height` world units high.
pub(super) fn parallel(height: f64) -> Camera {
    let projection = Projection::Orthographic { height, far: 200.0 };
    Camera { eye: DVec3::Z * 100.0, target: DVec3::ZERO, up: DVec3::Y, projection, near: 0.1 }
}

/// A flat convex polygon of four corners, open, with a flat normal.
pub(super) fn plate(corners: [DVec3; 4]) -> Model {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize().as_vec3();
    Model {
        positions: corners.map(|corner| corner.as_vec3()).to_vec(),
        normals: vec![normal; 4],
        faces: vec![[0, 1, 2], [0, 2, 3]],
        face_polygon: vec![0, 0],
        face_material: vec![0, 0],
        materials: vec![Material::default()],
        ..Model::default()
    }
}

/// A model whose faces share no vertices and have flat normals.
pub(super) fn faceted(positions: &[Vec3], faces: &[[u32; 3]]) -> Model {
    let mut model = Model { materials: vec![Material::default()], ..Model::default() };
    for face in faces {
        let [a, b, c] = face.map(|v| positions[v as usize]);
        let first = model.positions.len() as u32;
        model.positions.extend([a, b, c]);
        model.normals.extend([(b - a).cross(c - a).normalize_or_zero(); 3]);
        model.faces.push([first, first + 1, first + 2]);
        model.face_material.push(0);
    }
    model
}

/// Pictures beside each other, 4 px apart, on white.
pub(super) fn beside(pictures: &[Image]) -> Image {
    const GAP_PX: u32 = 4;
    let width = pictures.iter().map(|picture| picture.width + GAP_PX).sum::<u32>().saturating_sub(GAP_PX);
    let height = pictures.iter().map(|picture| picture.height).max().unwrap_or(0);
    let mut joined = Image::filled(width, height, PAPER);
    let mut left = 0;
    for picture in pictures {
        for y in 0..picture.height {
            for x in 0..picture.width {
                joined.set_pixel(left + x, y, picture.pixel(x, y));
            }
        }
        left += picture.width + GAP_PX;
    }
    joined
}

/// A part of a picture, each pixel a square of `times` pixels.
pub(super) fn enlarged(picture: &Image, [left, top, width, height]: [u32; 4], times: u32) -> Image {
    let mut large = Image::filled(width * times, height * times, PAPER);
    for y in 0..height * times {
        for x in 0..width * times {
            large.set_pixel(x, y, picture.pixel(left + x / times, top + y / times));
        }
    }
    large
}

/// A picture of ink, 0 on paper and 255 on a line.
pub(super) fn picture_of(ink: &[u8], width: u32) -> Image {
    let height = ink.len() as u32 / width;
    let rgba8 = ink.iter().flat_map(|&ink| [255 - ink, 255 - ink, 255 - ink, 255]).collect();
    Image::new(width, height, rgba8).expect("four bytes a pixel")
}

/// The ink along a line from `from`, `length_px` in the unit direction `along`, sampled every quarter of a px.
pub(super) fn ink_along(ink: &[f64], width: u32, from: DVec2, along: DVec2, length_px: f64) -> f64 {
    const STEP_PX: f64 = 0.25;
    let height = ink.len() as u32 / width;
    let at = |point: DVec2| {
        let is_inside = point.cmpge(DVec2::ZERO).all() && point.x < f64::from(width) && point.y < f64::from(height);
        if is_inside { ink[point.y as usize * width as usize + point.x as usize] } else { 0.0 }
    };
    let steps = (length_px / STEP_PX) as u32;
    (0..steps).map(|step| at(from + along * ((f64::from(step) + 0.5) * STEP_PX))).sum::<f64>() * STEP_PX
}

/// The largest parameter at which the error is above `level`; the least positive number if it never is.
pub(super) fn last_above(points: &[(f64, f64)], level: f64) -> f64 {
    points.iter().rev().find(|point| point.1 > level).map_or(f64::MIN_POSITIVE, |point| point.0)
}

/// The parameter at which the error first crosses `level`, interpolated between the points; the last parameter if it
/// never does.
pub(super) fn crossing(points: &[(f64, f64)], level: f64) -> f64 {
    for pair in points.windows(2) {
        let [(x0, y0), (x1, y1)] = [pair[0], pair[1]];
        if (y0 <= level) != (y1 <= level) {
            return x0 + (x1 - x0) * (level - y0) / (y1 - y0);
        }
    }
    points.last().map_or(0.0, |point| point.0)
}

/// A limit without a prediction that lies in the method, and is an error.
pub(super) fn limit(what: &str, measured: f64, bound: Bound) -> Limit {
    Limit { what: what.into(), measured, is_of_parameter: false, predicted: None, bound, to_be_mended: None }
}

/// The same for a value of the parameter.
pub(super) fn limit_at(what: &str, measured: f64, bound: Bound) -> Limit {
    Limit { is_of_parameter: true, ..limit(what, measured, bound) }
}

/// `count` numbers from `from` to `to` in equal ratios.
pub(super) fn geometric(from: f64, to: f64, count: u32) -> Vec<f64> {
    let ratio = (to / from).powf(1.0 / f64::from(count - 1));
    (0..count).map(|i| from * ratio.powi(i as i32)).collect()
}

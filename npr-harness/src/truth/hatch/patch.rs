//! The mean tone of a flat square.
//!
//! The square has a side of 2 and four tiles of the map along it. The pixels within its middle three by three tiles are
//! measured, so that every stroke of the map counts equally. Only if the square is oblique to the mapping planes, where
//! tiles are cut off, does the mean depend on the choice of strokes.
//!
//! At large distances the square has a few hundred pixels, and it is random which of them lie on strokes. Therefore
//! several pictures, shifted by fractions of a pixel, can be averaged.

use super::{asked, hatched};
use crate::camera::{Camera, Framing};
use crate::capabilities::Capabilities;
use crate::cpu::{CpuOptions, FrameContext};
use crate::error::HarnessError;
use crate::hatch::HatchShade;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::view::View;
use glam::{DVec2, DVec3, Vec2};
use npr_mesh::{Material, Model};
use npr_toon::normal::NormalUse;
use std::f64::consts::SQRT_2;

/// Distances, relative to that at which the square fits the picture.
pub const DISTANCES: [f64; 5] = [1.0, 1.5, 2.0, 4.0, 8.0];
/// Tilts.
pub const TILTS_DEG: [f64; 3] = [0.0, 45.0, 70.0];
/// The map's side for four tiles along the square, in halves of its diagonal.
pub const TILE: f64 = SQRT_2 / 4.0;
/// The map's side with which texture coordinates lie halfway between two scales, of four tiles and of eight.
pub const TILE_BETWEEN: f64 = 0.25;

/// The object that is rotated to tilt the square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tilted {
    /// The camera: one mapping plane is parallel to the square.
    Camera,
    /// The square, about the y axis: two mapping planes share it.
    Square,
}

/// A view of a square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchView {
    /// The object that is rotated.
    pub tilted: Tilted,
    /// The tilt.
    pub tilt_deg: f64,
    /// [`Framing::distance`].
    pub distance: f64,
}

/// All combinations of [`DISTANCES`], [`TILTS_DEG`] and [`Tilted`].
pub fn views() -> Vec<PatchView> {
    let mut views = Vec::new();
    for tilted in [Tilted::Camera, Tilted::Square] {
        for tilt_deg in TILTS_DEG.into_iter().filter(|&tilt| tilt > 0.0 || tilted == Tilted::Camera) {
            views.extend(DISTANCES.map(|distance| PatchView { tilted, tilt_deg, distance }));
        }
    }
    views
}

/// The tone of a square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchTone {
    /// N·L.
    pub light: f64,
    /// The range of correct tones, see [`asked`].
    pub asked: [f64; 2],
    /// The mean of the pixels of all pictures.
    pub shown: f64,
    /// The number of pixels in all pictures.
    pub pixels: usize,
    /// The number of pictures.
    pub pictures: u32,
}

impl PatchTone {
    /// The error of the tone, positive if it is too light.
    pub fn error(&self) -> f64 {
        self.shown - self.shown.clamp(self.asked[0], self.asked[1])
    }
}

fn square(right: DVec3, up: DVec3) -> Model {
    let corners = [DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0), DVec2::new(1.0, 1.0), DVec2::new(-1.0, 1.0)];
    Model {
        positions: corners.map(|at| (right * at.x + up * at.y).as_vec3()).to_vec(),
        normals: vec![right.cross(up).as_vec3(); 4],
        uvs: corners.map(|at| Vec2::new(at.x as f32 * 0.5 + 0.5, 0.5 - at.y as f32 * 0.5)).to_vec(),
        faces: vec![[0, 1, 2], [0, 2, 3]],
        face_material: vec![0; 2],
        materials: vec![Material::default()],
        ..Model::default()
    }
}

/// The square's tone for the given values of N·L, 0..=1, in pictures of `size` × `size` px. One picture is rendered, or
/// up to 256 if needed for about `least` pixels.
///
/// # Errors
/// An error if a number of the shade is out of range.
pub fn patch_tones(
    shade: &HatchShade,
    view: PatchView,
    lights: &[f64],
    size: u32,
    least: usize,
) -> Result<Vec<PatchTone>, HarnessError> {
    let tilt = view.tilt_deg.to_radians();
    let (right, yaw_rad) = match view.tilted {
        Tilted::Camera => (DVec3::X, tilt),
        Tilted::Square => (DVec3::new(tilt.cos(), 0.0, -tilt.sin()), 0.0),
    };
    let (up, normal) = (DVec3::Y, right.cross(DVec3::Y));
    let scene = Scene::new(square(right, up));
    let framing = Framing { yaw_rad, pitch_rad: 0.0, distance: view.distance, ..Framing::default() };
    let camera = Camera::framed(scene.corners(), 1.0, &framing);
    let measured = |&light: &f64| {
        let style = hatched(shade, NormalUse::PerPixel, normal * light + up * (1.0 - light * light).max(0.0).sqrt());
        let plan = Plan::new(&scene, &style, &View::new(camera, (size, size)), &Capabilities::RAY_CASTER)?;
        let mut context = FrameContext::new(&scene, &plan, &CpuOptions::default());
        let (mut sum, mut pixels) = (0.0, 0usize);
        let [left, top, width, height] = camera.area(scene.bounds().expect("it has faces"), (size, size), 1);
        let of_one = f64::from(width * height) * 0.75 * 0.75;
        let along = (least as f64 / of_one).sqrt().ceil().clamp(1.0, 16.0) as u32;
        // Pictures shifted by fractions of a pixel form one picture of a higher resolution.
        for y in top * along..(top + height) * along {
            for x in left * along..(left + width) * along {
                let point_px = (DVec2::new(f64::from(x), f64::from(y)) + 0.5) / f64::from(along);
                let Some((at, color)) = context.seen_at(point_px) else { continue };
                if at.dot(right).abs() < 0.75 && at.dot(up).abs() < 0.75 {
                    sum += color.x;
                    pixels += 1;
                }
            }
        }
        Ok(PatchTone {
            light,
            asked: asked(shade, light),
            shown: sum / pixels.max(1) as f64,
            pixels,
            pictures: along * along,
        })
    };
    lights.iter().map(measured).collect()
}

//! The tone of spheres, block by block.
//!
//! A block of 32 × 32 px contains few random strokes, so its tone has an error even if the mean of all blocks is
//! correct. Maps drawn from different seeds have different strokes there: the deviation between them is the noise, and
//! the error of their mean is the bias.

use super::{asked, hatched};
use crate::camera::{Camera, Framing};
use crate::capabilities::Capabilities;
use crate::cpu::{self, CpuOptions};
use crate::error::HarnessError;
use crate::hatch::HatchShade;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::view::View;
use glam::{DVec2, DVec3};
use npr_mesh::embedded;
use npr_toon::normal::NormalUse;

/// The side of a block, px.
pub const BLOCK: u32 = 32;
/// Segments around the axis.
pub const SEGMENTS: [u32; 3] = [12, 24, 96];

/// Errors of the tones of blocks, relative to the exact sphere, on a scale from 0 (black) to 1 (white).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereError {
    /// The number of blocks entirely within the sphere.
    pub blocks: usize,
    /// For single pictures: root mean square over blocks and seeds.
    pub rms: f64,
    /// The largest error.
    pub worst: f64,
    /// For the mean of all seeds' pictures: root mean square over blocks.
    pub mean_rms: f64,
    /// The largest error.
    pub mean_worst: f64,
    /// Standard deviation of a block between seeds, root mean square over blocks; 0 for a single seed.
    pub noise: f64,
    /// Mean error of all pictures, positive if too light.
    pub bias: f64,
}

impl SphereError {
    /// [`SphereError::mean_rms`] after subtracting the noise of this number of seeds.
    pub fn bias_rms(&self, seeds: usize) -> f64 {
        (self.mean_rms.powi(2) - self.noise.powi(2) / seeds.max(1) as f64).max(0.0).sqrt()
    }
}

/// The normal where the ray through a pixel intersects the sphere of radius 1 around the origin.
fn normal(camera: &Camera, point_px: DVec2, size_px: DVec2) -> Option<DVec3> {
    let (origin, direction) = camera.ray(point_px, size_px);
    let (a, b, c) = (direction.length_squared(), origin.dot(direction), origin.length_squared() - 1.0);
    let under_root = b * b - a * c;
    (under_root >= 0.0).then(|| origin + direction * ((-b - under_root.sqrt()) / a))
}

/// The error of a sphere with a number of segments, hatched with several maps that differ only in their seed.
///
/// # Errors
/// An error if a number of a shade is out of range.
pub fn sphere_error(
    shades: &[HatchShade],
    segments: u32,
    normals: NormalUse,
    (width, height): (u32, u32),
) -> Result<SphereError, HarnessError> {
    let scene = Scene::new(embedded::sphere(segments));
    let size_px = DVec2::new(f64::from(width), f64::from(height));
    let framing = Framing { yaw_rad: 0.5, pitch_rad: 0.3, ..Framing::default() };
    // Framed for the finest sphere, so that the sphere is the same in all pictures.
    let round = embedded::sphere(128);
    let camera = Camera::framed(round.positions.iter().copied(), size_px.x / size_px.y, &framing);
    let to_light = DVec3::new(-0.35, 0.55, 0.75).normalize();
    let mut frames = Vec::new();
    for shade in shades {
        let style = hatched(shade, normals, to_light);
        let plan = Plan::new(&scene, &style, &View::new(camera, (width, height)), &Capabilities::RAY_CASTER)?;
        frames.push(cpu::render(&scene, &plan, &CpuOptions::default(), &|_| {}));
    }
    let seeds = frames.len() as f64;
    let (mut single, mut mean, mut variance, mut bias) = (0.0, 0.0, 0.0, 0.0);
    let (mut worst, mut mean_worst, mut blocks) = (0.0f64, 0.0f64, 0usize);
    for block in 0..(width / BLOCK) * (height / BLOCK) {
        let (left, top) = (block % (width / BLOCK) * BLOCK, block / (width / BLOCK) * BLOCK);
        let pixels = || (0..BLOCK * BLOCK).map(move |i| (left + i % BLOCK, top + i / BLOCK));
        let at = |(x, y): (u32, u32)| (y * width + x) as usize;
        let light = |(x, y): (u32, u32)| {
            normal(&camera, DVec2::new(f64::from(x), f64::from(y)) + 0.5, size_px).map(|n| n.dot(to_light))
        };
        let Some(lights) = pixels().map(light).collect::<Option<Vec<_>>>() else { continue };
        if pixels().any(|pixel| frames.iter().any(|frame| frame.depth[at(pixel)] == 0.0)) {
            continue;
        }
        let count = f64::from(BLOCK * BLOCK);
        let errors: Vec<f64> = frames
            .iter()
            .zip(shades)
            .map(|(frame, shade)| {
                let shown = pixels().map(|pixel| frame.color[at(pixel)].x).sum::<f64>() / count;
                let ends = [0, 1].map(|end| lights.iter().map(|&l| asked(shade, l)[end]).sum::<f64>() / count);
                shown - shown.clamp(ends[0], ends[1])
            })
            .collect();
        let of_all = errors.iter().sum::<f64>() / seeds;
        blocks += 1;
        bias += of_all;
        mean += of_all * of_all;
        single += errors.iter().map(|e| e * e).sum::<f64>() / seeds;
        variance += errors.iter().map(|e| (e - of_all).powi(2)).sum::<f64>() / (seeds - 1.0).max(1.0);
        worst = errors.iter().fold(worst, |worst, e| worst.max(e.abs()));
        mean_worst = mean_worst.max(of_all.abs());
    }
    let n = blocks.max(1) as f64;
    Ok(SphereError {
        blocks,
        rms: (single / n).sqrt(),
        worst,
        mean_rms: (mean / n).sqrt(),
        mean_worst,
        noise: (variance / n).sqrt(),
        bias: bias / n,
    })
}

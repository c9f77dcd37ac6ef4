//! The errors of lighting computed for faces, at vertices or from interpolated normals, on the teapot from coarse to fine
//! tessellations.

use crate::camera::{Camera, Framing};
use crate::capabilities::Capabilities;
use crate::cpu::{self, CpuFrame, CpuOptions};
use crate::error::HarnessError;
use crate::lights::StyleLight;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::shade::Shade;
use crate::shade::ramp::{RampShade, RampSource};
use crate::style::{Style, style};
use crate::view::View;
use glam::{DVec4, Vec3, Vec4};
use npr_gooch::Gooch;
use npr_mesh::{Material, embedded};
use npr_toon::Bands;
use npr_toon::normal::NormalUse;
use npr_toon::ramp::{Ramp, RampBlend, RampStop};
use npr_toon::source::Light;

/// The segments per patch of the teapot, which has 32 patches.
pub const SEGMENTS: [u32; 5] = [2, 4, 8, 16, 32];
/// The ways to use normals: those that light faces as wholes or in pieces, then those that light vertices and pixels, each
/// from the least light values to the most.
pub const USES: [NormalUse; 6] = [
    NormalUse::PerFace,
    NormalUse::PerSubdividedFace(2),
    NormalUse::PerSubdividedFace(8),
    NormalUse::PerVertex,
    NormalUse::Interpolated,
    NormalUse::PerPixel,
];

/// The segments of the reference; more do not change the printed numbers.
const TRUE_SEGMENTS: u32 = 96;
const TRUE_SAMPLES: u32 = 8;
/// Points whose distances from the eye differ by more than this fraction belong to different surfaces.
const SAME_DISTANCE: f64 = 0.02;
/// Where N·L changes by more than this between neighbouring pixels, two parts of the teapot intersect or a surface
/// curves away; such pixels are excluded, because their errors do not come from normals.
const SMOOTH_STEP: f64 = 0.15;

/// The error of one way to shade the teapot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalUseError {
    /// Segments per patch.
    pub segments: u32,
    /// How normals are used.
    pub normals: NormalUse,
    /// Root mean square error for bands and for Gooch's tones, relative to a component's range of 1, over the pixels
    /// where both pictures show the same surface and no crease is near.
    pub rmse: [f64; 2],
    /// The largest error for each.
    pub worst: [f64; 2],
}

/// Measures all [`SEGMENTS`] and [`USES`] against 64 samples per pixel of a teapot with 96 segments per patch and
/// normals at pixels. The light is near, because for a distant light N·L of interpolated normals equals interpolated
/// N·L of the vertices.
///
/// # Errors
/// None in practice.
pub fn normal_use_errors(size: (u32, u32)) -> Result<Vec<NormalUseError>, HarnessError> {
    let of = |segments, color| {
        let material = Material { base_color: color, ..Default::default() };
        Scene::new(embedded::placed(embedded::teapot(segments), glam::Mat4::IDENTITY, material))
    };
    let gray = Vec4::new(0.7, 0.7, 0.7, 1.0);
    let (fine, white) = (of(TRUE_SEGMENTS, gray), of(TRUE_SEGMENTS, Vec4::ONE));
    let framing = Framing { yaw_rad: 30f64.to_radians(), pitch_rad: 25f64.to_radians(), ..Framing::default() };
    let camera = Camera::framed(fine.corners(), f64::from(size.0) / f64::from(size.1), &framing);
    let lamp = StyleLight { light: Light::positional(Vec3::new(-0.9, 1.2, 1.1)), ..StyleLight::KEY };
    let shades = [Shade::Toon(Bands::default()), Shade::Gooch(Gooch::default())];
    let drawn = |scene: &Scene, shade: &Shade, normals, samples| {
        let toon = style("toon").expect("a style of this crate");
        let style = Style { shade: shade.clone(), normals, lights: vec![lamp], ..toon };
        let plan = Plan::new(scene, &style, &View { camera, size, samples }, &Capabilities::RAY_CASTER)?;
        Ok::<_, HarnessError>(cpu::render(scene, &plan, &CpuOptions::default(), &|_| {}))
    };
    let truths = [
        drawn(&fine, &shades[0], NormalUse::PerPixel, TRUE_SAMPLES)?,
        drawn(&fine, &shades[1], NormalUse::PerPixel, TRUE_SAMPLES)?,
    ];
    // One sample per pixel, which gives the surface at the pixel's centre, with N·L as its colour.
    let light = [(-1.0, Vec3::ZERO), (1.0, Vec3::splat(0.5))].map(|(at, color)| RampStop { at, color });
    let ramp = RampSource::Stops(Ramp { stops: light.to_vec(), blend: RampBlend::Smooth });
    let surface = drawn(&white, &Shade::Ramp(RampShade { ramp, half_lambert: None }), NormalUse::PerPixel, 1)?;
    let mut errors = Vec::new();
    for segments in SEGMENTS {
        let coarse = of(segments, gray);
        for normals in USES {
            let mut error = NormalUseError { segments, normals, rmse: [0.0; 2], worst: [0.0; 2] };
            for (which, (shade, truth)) in shades.iter().zip(&truths).enumerate() {
                let frame = drawn(&coarse, shade, normals, 1)?;
                (error.rmse[which], error.worst[which]) = compared(&frame, &surface, &truth.color);
            }
            errors.push(error);
        }
    }
    Ok(errors)
}

/// Root mean square and largest difference over the pixels whose neighbourhood shows the same surface in both.
fn compared(frame: &CpuFrame, surface: &CpuFrame, truth: &[DVec4]) -> (f64, f64) {
    let width = frame.width as usize;
    let (mut sum, mut count, mut worst) = (0.0, 0usize, 0.0f64);
    let is_same = |pixel: usize| {
        let (a, b) = (frame.depth[pixel], surface.depth[pixel]);
        // The depth buffer holds about near / distance.
        a > 0.0 && b > 0.0 && (a / b - 1.0).abs() < SAME_DISTANCE
    };
    let light = |pixel: usize| 4.0 * surface.color[pixel].x;
    for y in 1..frame.height as usize - 1 {
        for x in 1..width - 1 {
            let around = (0..9).map(|i| (y + i / 3 - 1) * width + x + i % 3 - 1);
            let pixel = y * width + x;
            let is_smooth = |beside: usize| (light(pixel) - light(beside)).abs() < SMOOTH_STEP;
            if around.into_iter().all(|beside| is_same(beside) && is_smooth(beside)) {
                let difference = (frame.color[pixel] - truth[pixel]).truncate().abs();
                sum += difference.length_squared() / 3.0;
                worst = worst.max(difference.max_element());
                count += 1;
            }
        }
    }
    ((sum / count.max(1) as f64).sqrt(), worst)
}

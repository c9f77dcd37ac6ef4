//! Stability of strokes on a surface while the camera moves.
//!
//! Every surface pixel of the second picture is compared with the first picture at the point where the same surface
//! point appears there. That point lies between pixels. To avoid resampling the first picture, the point is shaded as
//! if a pixel were centred there.

use super::hatched;
use crate::camera::{Camera, Framing};
use crate::capabilities::Capabilities;
use crate::cpu::{CpuOptions, FrameContext};
use crate::error::HarnessError;
use crate::hatch::HatchShade;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::style::Style;
use crate::view::View;
use glam::{DVec2, DVec3, DVec4, Vec2};
use npr_mesh::Model;
use npr_toon::normal::NormalUse;

/// The motion of the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// A rotation around the model by 1°.
    Turn,
    /// A zoom by 1 %.
    Zoom,
}

/// All motions.
pub const MOTIONS: [Motion; 2] = [Motion::Turn, Motion::Zoom];

/// The difference of two pictures at the same points of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stability {
    /// The number of pixels compared.
    pub pixels: usize,
    /// Mean |difference|, of 255.
    pub mean: f64,
    /// Mean signed difference, of 255: the change of tone.
    pub tone: f64,
}

/// The inputs of a picture.
#[derive(Clone, Copy)]
pub struct Picture<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The style.
    pub style: &'a Style,
    /// The camera.
    pub camera: &'a Camera,
}

/// The cameras before and after a motion that starts at `before`. The bounding sphere of the scene fits a picture of
/// `aspect`.
pub fn cameras(scene: &Scene, before: &Framing, motion: Motion, aspect: f64) -> [Camera; 2] {
    let before = *before;
    let after = match motion {
        Motion::Turn => Framing { yaw_rad: before.yaw_rad + 1f64.to_radians(), ..before },
        Motion::Zoom => Framing { distance: before.distance / 1.01, ..before },
    };
    // A sphere fits at the same distance from any side, a model does not.
    let (middle, radius) = (scene.middle(), scene.radius());
    let ball = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let ball = ball.map(|axis| (middle + axis * radius).as_vec3());
    let first = Camera::framed(ball.into_iter(), aspect, &Framing { distance: 1.0, ..before });
    let distance = first.eye.distance(middle);
    [before, after].map(|framing| {
        let (yaw, pitch) = (framing.yaw_rad, framing.pitch_rad);
        let back = DVec3::new(yaw.sin() * pitch.cos(), pitch.sin(), yaw.cos() * pitch.cos());
        let eye = middle + back * (distance * framing.distance);
        Camera { eye, target: middle, up: DVec3::Y, ..first }
    })
}

/// The projection of a point, px; undefined for points behind the eye.
fn projected(camera: &Camera, at: DVec3, size_px: DVec2) -> DVec2 {
    let clip: DVec4 = camera.clip_from_world(size_px.x / size_px.y) * at.extend(1.0);
    (DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * size_px
}

/// Compares two pictures of `size` px whose scenes have the same surface. Points that are not visible in the first one
/// are ignored.
///
/// # Errors
/// An error if a number of a style is out of range.
pub fn stability(before: Picture<'_>, after: Picture<'_>, size: (u32, u32)) -> Result<Stability, HarnessError> {
    let size_px = DVec2::new(f64::from(size.0), f64::from(size.1));
    let plan = |of: Picture<'_>| Plan::new(of.scene, of.style, &View::new(*of.camera, size), &Capabilities::RAY_CASTER);
    let (plan_before, plan_after) = (plan(before)?, plan(after)?);
    let options = CpuOptions::default();
    let mut first = FrameContext::new(before.scene, &plan_before, &options);
    let mut second = FrameContext::new(after.scene, &plan_after, &options);
    let near = before.scene.radius() * 1e-6;
    let (mut pixels, mut sum, mut signed) = (0usize, 0.0, 0.0);
    for y in 0..size.1 {
        for x in 0..size.0 {
            let Some((at, now)) = second.seen_at(DVec2::new(f64::from(x), f64::from(y)) + 0.5) else { continue };
            let point_px = projected(before.camera, at, size_px);
            if !(point_px.cmpge(DVec2::ZERO).all() && point_px.cmplt(size_px).all()) {
                continue;
            }
            let Some((there, then)) = first.seen_at(point_px) else { continue };
            if there.distance(at) > near {
                continue;
            }
            pixels += 1;
            sum += (now - then).abs().element_sum() / 3.0;
            signed += (now - then).element_sum() / 3.0;
        }
    }
    let n = pixels.max(1) as f64 / 255.0;
    Ok(Stability { pixels, mean: sum / n, tone: signed / n })
}

/// The direction to the light for this measurement, from above and in front, independent of the camera.
pub const TO_LIGHT: DVec3 = DVec3::new(0.1, 0.7, 0.7);

/// The stability of a hatching on a scene while a camera moves.
///
/// # Errors
/// An error if a number of the shade is out of range.
pub fn hatch_stability(
    scene: &Scene,
    shade: &HatchShade,
    from: &Framing,
    motion: Motion,
    size: (u32, u32),
) -> Result<Stability, HarnessError> {
    let style = hatched(shade, NormalUse::PerPixel, TO_LIGHT);
    let [before, after] = cameras(scene, from, motion, f64::from(size.0) / f64::from(size.1));
    let of = |camera| Picture { scene, style: &style, camera };
    stability(of(&before), of(&after), size)
}

/// A model whose texture coordinates are the screen positions of its vertices, one unit per 128 px, so that strokes are
/// fixed to the picture instead of the surface; for comparison.
pub fn on_the_picture(model: &Model, camera: &Camera, (width, height): (u32, u32)) -> Model {
    let size_px = DVec2::new(f64::from(width), f64::from(height));
    let uv = |at: &glam::Vec3| (projected(camera, at.as_dvec3(), size_px) / 128.0).as_vec2();
    Model { uvs: model.positions.iter().map(uv).collect(), ..model.clone() }
}

/// A model whose texture coordinates are offset.
pub fn with_moved_uvs(model: &Model, by: Vec2) -> Model {
    Model { uvs: model.uvs.iter().map(|&uv| uv + by).collect(), ..model.clone() }
}

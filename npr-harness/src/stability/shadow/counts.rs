//! Counting shadow volumes along rays, in f64: what a stencil buffer does, without its rounding.

use super::super::setup::{front, states_image};
use crate::camera::Camera;
use crate::capabilities::Capabilities;
use crate::cpu::{self, CpuOptions, PrimaryHits};
use crate::error::HarnessError;
use crate::lights::{LightFrame, StyleLight};
use crate::picture::Image;
use crate::plan::Plan;
use crate::scene::Scene;
use crate::shadow::ShadowStyle;
use crate::style::{Style, style};
#[cfg(feature = "gpu")]
use crate::truth::shadows::ShadowShot;
use crate::truth::shadows::States;
use crate::view::View;
use glam::{DVec3, DVec4, Vec4, Vec4Swizzles};
use npr_imagespace::shadow::ShadowState;
use npr_mesh::Model;
use npr_outline::shadow_volume::{outline_in_shadow, outline_swept};
use npr_toon::source::{Light, LightKind};

/// A point of a surface that is turned to the light.
#[derive(Clone, Copy)]
struct Receiver {
    pixel: usize,
    /// Scene space.
    at: DVec3,
    /// Whether an occluder lies on the ray to the light.
    in_shadow: bool,
}

/// What a picture shows.
pub(super) struct Receivers {
    eye: DVec3,
    size: (u32, u32),
    /// The points that are turned to the light, and whether rays find them in shadow.
    points: Vec<Receiver>,
    /// The pixels of surfaces that are turned away from it.
    away: Vec<usize>,
}

/// What a picture of `size` px shows.
pub(super) fn receivers(
    scene: &Scene,
    camera: Camera,
    size: (u32, u32),
    light: DVec4,
) -> Result<Receivers, HarnessError> {
    let shadow_lines = style("shadow-lines").expect("a style of this crate");
    let shadow = Some(ShadowStyle { terminator: 0.0, ..ShadowStyle::default() });
    let style = Style { lights: vec![style_light(light)], shadow, ..shadow_lines };
    let view = View::new(camera, size);
    let plan = Plan::new(scene, &style, &view, &Capabilities::RAY_CASTER)?;
    let seen = cpu::seen(&PrimaryHits::new(scene, view), &plan, &CpuOptions::default());
    let (mut points, mut away) = (Vec::new(), Vec::new());
    for (pixel, seen) in seen.into_iter().enumerate() {
        match seen {
            Some(seen) if seen.shadow.state == ShadowState::BackFacing => away.push(pixel),
            Some(seen) => {
                points.push(Receiver { pixel, at: seen.at, in_shadow: seen.shadow.state == ShadowState::Cast });
            }
            None => {}
        }
    }
    Ok(Receivers { eye: camera.eye, size, points, away })
}

/// The light of a style that is this point or direction.
pub(super) fn style_light(light: DVec4) -> StyleLight {
    let of = light.truncate().as_vec3();
    let place = match light.w {
        0.0 => LightKind::Directional { to_light: of },
        _ => LightKind::Positional { position: of },
    };
    StyleLight { light: Light { place, ..StyleLight::KEY.light }, frame: LightFrame::World }
}

/// The triangles that bound volumes.
pub(super) struct Volumes {
    /// Three homogeneous corners and the factor with which the triangle counts.
    triangles: Vec<([DVec4; 3], i32)>,
}

/// Which triangles are counted along a ray from the eye.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Count {
    /// Those in front of the surface (Heidmann 1991).
    DepthPass,
    /// Those behind it, to infinity (Everitt & Kilgard 2002).
    DepthFail,
}

impl Volumes {
    /// Of corners whose positions with w = 0 are swept away from the light; the first `towards` corners are wound
    /// counter-clockwise seen from outside, and the others count with the opposite sign.
    pub(super) fn new(corners: &[[f32; 4]], towards: usize, light: DVec4) -> Self {
        let homogeneous = |corner: [f32; 4]| {
            let corner = Vec4::from(corner);
            let position = corner.xyz().as_dvec3();
            if corner.w == 0.0 { outline_swept(position, light) } else { position.extend(1.0) }
        };
        let triangle = |(number, corners): (usize, &[[f32; 4]])| {
            let factor = if 3 * number < towards { 1 } else { -1 };
            ([corners[0], corners[1], corners[2]].map(homogeneous), factor)
        };
        Self { triangles: corners.chunks_exact(3).enumerate().map(triangle).collect() }
    }

    /// Whether the count of volumes around a point is that of a shadow, for an eye that sees it.
    fn in_shadow(&self, eye: DVec3, at: DVec3, count: Count) -> bool {
        /// The part of the distance within which a triangle lies on the surface itself: a cap, which begins behind it.
        const ON_SURFACE: f64 = 1e-7;
        let direction = at - eye;
        let mut volumes = 0;
        for (corners, factor) in &self.triangles {
            let [a, b, c] = corners.map(|corner| corner.truncate() - eye * corner.w);
            // The weights of the corners where the ray meets the triangle's plane, times its volume.
            let weights = DVec3::new(b.cross(c).dot(direction), c.cross(a).dot(direction), a.cross(b).dot(direction));
            let is_front = weights.cmplt(DVec3::ZERO).all();
            if !is_front && !weights.cmpgt(DVec3::ZERO).all() {
                continue;
            }
            let w = weights.dot(DVec3::new(corners[0].w, corners[1].w, corners[2].w));
            let volume = a.dot(b.cross(c));
            // Infinite where all corners are at infinity.
            let t = if w == 0.0 { volume.signum() * weights.x.signum() * f64::INFINITY } else { volume / w };
            let counts = match count {
                Count::DepthPass => t > 0.0 && t < 1.0 - ON_SURFACE,
                Count::DepthFail => t >= 1.0 - ON_SURFACE,
            };
            if counts {
                volumes += factor * if is_front == (count == Count::DepthPass) { 1 } else { -1 };
            }
        }
        outline_in_shadow(volumes as u8)
    }
}

impl Receivers {
    /// The share of the points for which the count is wrong.
    pub(super) fn wrong_share(&self, volumes: &Volumes, count: Count) -> f64 {
        let is_wrong = |point: &&Receiver| volumes.in_shadow(self.eye, point.at, count) != point.in_shadow;
        self.points.iter().filter(is_wrong).count() as f64 / self.points.len() as f64
    }

    /// Light in light gray, what the count finds in shadow in dark gray, and what is turned away in between.
    pub(super) fn picture(&self, volumes: &Volumes, count: Count) -> Image {
        let mut states = vec![None; self.size.0 as usize * self.size.1 as usize];
        for &pixel in &self.away {
            states[pixel] = Some(ShadowState::BackFacing);
        }
        for point in &self.points {
            let in_shadow = volumes.in_shadow(self.eye, point.at, count);
            states[point.pixel] = Some(if in_shadow { ShadowState::Cast } else { ShadowState::Lit });
        }
        states_image(&States { size: self.size, states }, (0, 0), self.size)
    }
}

/// A shot of a camera with a light.
#[cfg(feature = "gpu")]
pub(super) fn shot(name: &'static str, camera: Camera, light: DVec4) -> ShadowShot {
    ShadowShot { name, light: style_light(light), camera }
}

/// A perspective view.
pub(super) fn looking(eye: DVec3, target: DVec3, fov_y_deg: f64) -> Camera {
    let projection = crate::camera::Projection::Perspective { fov_y_rad: fov_y_deg.to_radians() };
    Camera { eye, target, projection, near: 0.01, ..front(1.0) }
}

/// A model and the ground at y = 0 around it, a rectangle of two triangles.
pub(super) fn on_ground(caster: &Model, half_size: f64) -> Scene {
    let [l, r] = [-half_size, half_size];
    let corners = [DVec3::new(l, 0.0, r), DVec3::new(r, 0.0, r), DVec3::new(r, 0.0, l), DVec3::new(l, 0.0, l)];
    let [a, b, c, d] = corners;
    let mut model = caster.clone();
    model.append(&super::super::setup::faceted(&[[a, b, c], [a, c, d]]));
    Scene::new(model)
}

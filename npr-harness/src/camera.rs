//! Cameras, their rays and their matrices.

use glam::{DMat4, DVec2, DVec3, DVec4, Vec3};
use npr_outline::fin_printed::{FinDepth, FinView};
use npr_outline::segment::LineView;

/// The projection of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Perspective projection.
    Perspective {
        /// The vertical field of view.
        fov_y_rad: f64,
    },
    /// Parallel projection.
    Orthographic {
        /// The height of the view volume, world units.
        height: f64,
        /// Eye depth of the far plane, world units, which ends the range of the depth buffer.
        far: f64,
    },
}

/// A camera: right-handed, looking from `eye` to `target`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World space.
    pub eye: DVec3,
    /// World space; must differ from the eye.
    pub target: DVec3,
    /// The approximate up direction; must not be parallel to the viewing direction.
    pub up: DVec3,
    /// Perspective or parallel.
    pub projection: Projection,
    /// Eye depth of the near plane, world units, above 0.
    pub near: f64,
}

/// The direction from which a model is viewed, and its size in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Framing {
    /// The angle around the model to the right, from +Z.
    pub yaw_rad: f64,
    /// The angle above the horizon, −π/2..=π/2.
    pub pitch_rad: f64,
    /// 1 fits the whole model; 2 doubles the distance, or in a parallel view halves the size.
    pub distance: f64,
    /// The vertical field of view, or `None` for a parallel view.
    pub fov_y_rad: Option<f64>,
    /// The angle by which the camera is turned clockwise about its viewing direction, so that the model leans to the left.
    /// Lights in the viewer's frame turn with it.
    pub roll_rad: f64,
    /// The point in the middle of the picture, in the space of the points that are framed
    /// ([`Scene::place_here`](crate::scene::Scene::place_here) takes a point of the file there); `None` for the middle of
    /// what is framed. The distance is still such that everything fits.
    pub target: Option<DVec3>,
}

impl Default for Framing {
    fn default() -> Self {
        Self {
            yaw_rad: 30f64.to_radians(),
            pitch_rad: 20f64.to_radians(),
            distance: 1.0,
            fov_y_rad: Some(35f64.to_radians()),
            roll_rad: 0.0,
            target: None,
        }
    }
}

/// Generates rays through points of a picture; see [`Camera::rays`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureRays {
    eye: DVec3,
    /// From the picture's centre to its right border, at eye depth 1 in perspective.
    right: DVec3,
    up: DVec3,
    forwards: DVec3,
    size_px: DVec2,
    is_parallel: bool,
}

impl PictureRays {
    /// The ray through a point, as [`Camera::ray`].
    pub fn through(&self, point_px: DVec2) -> (DVec3, DVec3) {
        let ndc = DVec2::new(2.0 * point_px.x / self.size_px.x - 1.0, 1.0 - 2.0 * point_px.y / self.size_px.y);
        let aside = self.right * ndc.x + self.up * ndc.y;
        if self.is_parallel { (self.eye + aside, self.forwards) } else { (self.eye, aside + self.forwards) }
    }
}

/// The fraction of the picture's width or height that a fitted model occupies.
const FILL: f64 = 0.9;

/// The upper bound of a framed view's near plane, relative to the depth of the nearest point.
const NEAR: f64 = 0.1;

impl Camera {
    /// Creates a camera that fits all `points` into the picture, with a margin.
    ///
    /// - `points`: at least one; world space, of a scene [`Scene::framed_corners`](crate::scene::Scene::framed_corners).
    /// - `aspect`: width over height.
    pub fn framed(points: impl Iterator<Item = Vec3> + Clone, aspect: f64, framing: &Framing) -> Self {
        let (yaw, pitch) = (framing.yaw_rad, framing.pitch_rad);
        let back = DVec3::new(yaw.sin() * pitch.cos(), pitch.sin(), yaw.cos() * pitch.cos());
        // In a view straight up or down, the picture's up direction points away from the viewer's feet.
        let level = DVec3::new(-yaw.sin() * pitch.sin(), pitch.cos(), -yaw.cos() * pitch.sin());
        let up = match framing.roll_rad {
            0.0 => level,
            roll => level * roll.cos() + level.cross(back) * roll.sin(),
        };
        let right = up.cross(back);
        let in_view = |p: Vec3| {
            let p = p.as_dvec3();
            DVec3::new(p.dot(right), p.dot(up), p.dot(back))
        };
        let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = points.clone().map(in_view).fold(empty, |(l, h), p| (l.min(p), h.max(p)));
        let center_of = |v: DVec3| right * v.x + up * v.y + back * v.z;
        let (middle, center) = match framing.target {
            None => ((low + high) / 2.0, center_of((low + high) / 2.0)),
            Some(target) => (DVec3::new(target.dot(right), target.dot(up), target.dot(back)), target),
        };
        let size = match (high - low).max_element() {
            // All points coincide. Any distance works that is large enough to separate the eye from them despite
            // rounding.
            0.0 => middle.length().max(1.0),
            size => size,
        };
        match framing.fov_y_rad {
            Some(fov_y_rad) => {
                let tan = DVec2::new(aspect, 1.0) * (fov_y_rad / 2.0).tan() * FILL;
                // For each point the distance from the centre at which it just fits.
                let fitting = points.map(in_view).fold(0.0f64, |distance, p| {
                    let p = p - middle;
                    distance.max(p.z + (p.x.abs() / tan.x).max(p.y.abs() / tan.y))
                });
                let distance = fitting.max(size * 1e-3) * framing.distance;
                // As far away as is safe, because OpenGL's depths are multiples of 2⁻²⁴ at any distance. The factor is
                // a power of two, so that depths are rounded the same on other APIs.
                let (least, nearest) = (distance * 1e-3, distance - (high.z - middle.z));
                let octaves = (NEAR * nearest / least).max(1.0).log2().floor();
                Self {
                    eye: center + back * distance,
                    target: center,
                    up,
                    projection: Projection::Perspective { fov_y_rad },
                    near: least * octaves.exp2(),
                }
            }
            None => {
                let extent = match framing.target {
                    None => high - low,
                    Some(_) => 2.0 * (high - middle).max(middle - low),
                };
                let height = extent.y.max(extent.x / aspect).max(size * 1e-3) / FILL * framing.distance;
                // A target may be in front of everything, or behind it.
                let depth = 2.0 * size.max(extent.z);
                Self {
                    eye: center + back * depth,
                    target: center,
                    up,
                    projection: Projection::Orthographic { height, far: 2.0 * depth },
                    near: depth * 1e-3,
                }
            }
        }
    }

    /// Right, up, and back (towards the viewer): unit vectors of view space in world space.
    pub fn axes(&self) -> [DVec3; 3] {
        let back = (self.eye - self.target).normalize();
        let right = self.up.cross(back).normalize();
        [right, back.cross(right), back]
    }

    /// The eye as a homogeneous point: its position with w = 1, or in a parallel view the direction to it with w = 0.
    pub fn homogeneous_eye(&self) -> DVec4 {
        match self.projection {
            Projection::Perspective { .. } => self.eye.extend(1.0),
            Projection::Orthographic { .. } => self.axes()[2].extend(0.0),
        }
    }

    /// Half the width and height of the view: at eye depth 1 in perspective, at any depth in a parallel view.
    fn half_extent(&self, aspect: f64) -> DVec2 {
        let half_height = match self.projection {
            Projection::Perspective { fov_y_rad } => (fov_y_rad / 2.0).tan(),
            Projection::Orthographic { height, .. } => height / 2.0,
        };
        DVec2::new(aspect, 1.0) * half_height
    }

    /// The matrix to clip space with reversed depth: 1 at the near plane; in perspective 0 at infinity, else 0 at the
    /// far plane.
    pub fn clip_from_world(&self, aspect: f64) -> DMat4 {
        let [right, up, back] = self.axes();
        let view_from_world = DMat4::from_cols(
            DVec4::new(right.x, up.x, back.x, 0.0),
            DVec4::new(right.y, up.y, back.y, 0.0),
            DVec4::new(right.z, up.z, back.z, 0.0),
            DVec4::new(-right.dot(self.eye), -up.dot(self.eye), -back.dot(self.eye), 1.0),
        );
        let half = self.half_extent(aspect);
        let clip_from_view = match self.projection {
            Projection::Perspective { .. } => DMat4::from_cols(
                DVec4::new(1.0 / half.x, 0.0, 0.0, 0.0),
                DVec4::new(0.0, 1.0 / half.y, 0.0, 0.0),
                DVec4::new(0.0, 0.0, 0.0, -1.0),
                DVec4::new(0.0, 0.0, self.near, 0.0),
            ),
            Projection::Orthographic { far, .. } => DMat4::from_cols(
                DVec4::new(1.0 / half.x, 0.0, 0.0, 0.0),
                DVec4::new(0.0, 1.0 / half.y, 0.0, 0.0),
                DVec4::new(0.0, 0.0, 1.0 / (far - self.near), 0.0),
                DVec4::new(0.0, 0.0, far / (far - self.near), 1.0),
            ),
        };
        clip_from_view * view_from_world
    }

    /// The depth buffer's value at an eye depth; 0 at infinity.
    pub fn buffer_depth(&self, eye_depth: f64) -> f64 {
        match self.projection {
            Projection::Perspective { .. } => self.near / eye_depth,
            Projection::Orthographic { far, .. } => ((far - eye_depth) / (far - self.near)).max(0.0),
        }
    }

    /// The ray through a point of the picture: its origin, and its direction, scaled so that t is eye depth. Use
    /// [`Self::rays`] for many points of one picture.
    pub fn ray(&self, point_px: DVec2, size_px: DVec2) -> (DVec3, DVec3) {
        self.rays(size_px).through(point_px)
    }

    /// The rays through a picture's points.
    pub fn rays(&self, size_px: DVec2) -> PictureRays {
        let [right, up, back] = self.axes();
        let half = self.half_extent(size_px.x / size_px.y);
        let is_parallel = matches!(self.projection, Projection::Orthographic { .. });
        PictureRays { eye: self.eye, right: right * half.x, up: up * half.y, forwards: -back, size_px, is_parallel }
    }

    /// The range of eye depth in which rays may hit.
    pub(crate) fn depth_range(&self) -> (f64, f64) {
        match self.projection {
            Projection::Perspective { .. } => (self.near, f64::INFINITY),
            Projection::Orthographic { far, .. } => (self.near, far),
        }
    }

    /// The bounding rectangle of a box in the picture, enlarged by `around_px`: left, top, width and height. The whole
    /// picture if a part of the box is nearer than the near plane.
    pub fn area(&self, (low, high): (Vec3, Vec3), (width, height): (u32, u32), around_px: u32) -> [u32; 4] {
        let size_px = DVec2::new(width.into(), height.into());
        let clip_from_world = self.clip_from_world(size_px.x / size_px.y);
        let mut bounds = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in 0..8u8 {
            let end = |bit: u8| if corner & bit == 0 { low } else { high };
            let corner = Vec3::new(end(1).x, end(2).y, end(4).z).as_dvec3();
            let clip = clip_from_world * corner.extend(1.0);
            if clip.z > clip.w {
                return [0, 0, width, height];
            }
            let point = (DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * size_px;
            bounds = (bounds.0.min(point), bounds.1.max(point));
        }
        let around = f64::from(around_px);
        let from = (bounds.0 - around).floor().clamp(DVec2::ZERO, size_px).as_uvec2();
        let to = (bounds.1 + around).ceil().clamp(DVec2::ZERO, size_px).as_uvec2();
        [from.x, from.y, to.x - from.x, to.y - from.y]
    }

    /// Transforms a world-space plane to picture space: the result is positive at (x px, y px, depth buffer's value, 1)
    /// where n · p + d is positive.
    pub fn plane_px(&self, plane: DVec4, size_px: DVec2) -> DVec4 {
        let in_clip = self.clip_from_world(size_px.x / size_px.y).inverse().transpose() * plane;
        // Clip space over w from px: x' = 2 x / width - 1, y' = 1 - 2 y / height.
        let along = DVec2::new(in_clip.x, -in_clip.y) * 2.0 / size_px;
        DVec4::new(along.x, along.y, in_clip.z, in_clip.w - in_clip.x + in_clip.y)
    }

    /// The view parameters for npr-outline.
    pub fn line_view(&self, size_px: DVec2) -> LineView {
        let px = 2.0 * self.half_extent(size_px.x / size_px.y).y / size_px.y;
        let depth_per_px = match self.projection {
            Projection::Perspective { .. } => DVec2::new(px, 0.0),
            Projection::Orthographic { far, .. } => DVec2::new(0.0, px / (far - self.near)),
        };
        LineView { clip_from_world: self.clip_from_world(size_px.x / size_px.y), viewport_px: size_px, depth_per_px }
    }

    /// The view parameters for the printed fins: `width_px` wide where the depth is w. `bounds` is the model's bounding
    /// box.
    ///
    /// The printed depth needs a far plane, which this camera does not have. It is placed 1 % behind the farthest
    /// corner of the box, where it uses the precision of a depth buffer of 2002 best. In a parallel view, for which the
    /// listing has no eye, the eye is placed so far away that all viewing directions are parallel to within a
    /// millionth, and the depth is w = 1, so fins are `width_px` wide everywhere.
    pub(crate) fn fin_view(&self, size_px: DVec2, width_px: f64, bounds: (Vec3, Vec3)) -> FinView {
        let aspect = size_px.x / size_px.y;
        let back = self.axes()[2];
        // The corner of the box that is farthest from the viewer.
        let farthest = DVec3::select(back.cmpgt(DVec3::ZERO), bounds.0.as_dvec3(), bounds.1.as_dvec3());
        let far = (1.01 * (self.eye - farthest).dot(back)).max(2.0 * self.near);
        let (eye, depth) = match self.projection {
            Projection::Perspective { .. } => (self.eye, FinDepth::Printed { near: self.near, far }),
            Projection::Orthographic { far, .. } => (self.eye + back * (far * 1e6), FinDepth::Eye),
        };
        FinView {
            clip_from_world: self.clip_from_world(aspect),
            eye,
            thickness: width_px * 2.0 * self.half_extent(aspect).y / size_px.y,
            depth,
            reversed: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn cameras() -> [Camera; 2] {
        let corners = (0..8u8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32));
        [Some(0.6), None].map(|fov_y_rad| {
            Camera::framed(
                corners.clone(),
                1.5,
                &Framing { fov_y_rad, yaw_rad: 0.7, pitch_rad: 0.4, ..Framing::default() },
            )
        })
    }

    #[test]
    fn a_ray_and_the_matrix_agree_on_where_a_pixel_looks() {
        let size = DVec2::new(300.0, 200.0);
        for camera in cameras() {
            let pixel = DVec2::new(71.3, 150.9);
            let (origin, direction) = camera.ray(pixel, size);
            let depth = 3.7;
            let clip = camera.clip_from_world(1.5) * (origin + direction * depth).extend(1.0);
            let (on_screen, buffer) = npr_outline::segment::outline_screen(clip, size);
            assert!(on_screen.distance(pixel) < 1e-9, "{on_screen} is not {pixel}");
            assert_relative_eq!(buffer, camera.buffer_depth(depth), epsilon = 1e-12);
        }
    }

    #[test]
    fn a_plane_has_the_same_side_in_px() {
        let size = DVec2::new(300.0, 200.0);
        let plane = DVec4::new(0.3, -0.8, 0.5, 0.1);
        for camera in cameras() {
            let in_px = camera.plane_px(plane, size);
            let mut sides = [0; 2];
            for i in 0..60u8 {
                let pixel = DVec2::new(f64::from(i % 10) * 30.0, f64::from(i / 10) * 33.0);
                let depth = 0.5 + f64::from(i % 7);
                let (origin, direction) = camera.ray(pixel, size);
                let side = plane.dot((origin + direction * depth).extend(1.0)) > 0.0;
                let on_screen = pixel.extend(camera.buffer_depth(depth)).extend(1.0);
                assert_eq!(in_px.dot(on_screen) > 0.0, side, "{pixel} at {depth}");
                sides[usize::from(side)] += 1;
            }
            assert!(sides.iter().all(|&count| count > 5), "{sides:?}");
        }
    }

    #[test]
    fn depth_is_one_at_the_near_plane_and_falls() {
        for camera in cameras() {
            assert_relative_eq!(camera.buffer_depth(camera.near), 1.0, epsilon = 1e-12);
            assert!(camera.buffer_depth(2.0) > camera.buffer_depth(2.1));
        }
    }

    #[test]
    fn a_px_of_depth_is_a_px_of_size() {
        let size = DVec2::new(300.0, 200.0);
        for camera in cameras() {
            let view = camera.line_view(size);
            let depth = 2.5;
            // A step of one px's width at this depth, taken along the view.
            let (origin, direction) = camera.ray(size / 2.0, size);
            let (beside, other) = camera.ray(size / 2.0 + DVec2::X, size);
            let px = (origin + direction * depth).distance(beside + other * depth);
            let slope = camera.buffer_depth(depth) - camera.buffer_depth(depth + px);
            let buffer = camera.buffer_depth(depth);
            assert_relative_eq!(slope, buffer * view.depth_per_px.x + view.depth_per_px.y, max_relative = 0.01);
        }
    }

    #[test]
    fn a_printed_fin_is_as_wide_as_asked() {
        let size = DVec2::new(300.0, 200.0);
        let box_ = (Vec3::ZERO, Vec3::ONE);
        for camera in cameras() {
            let view = camera.fin_view(size, 3.0, box_);
            let depth = 2.5;
            let (origin, direction) = camera.ray(size / 2.0, size);
            let right = camera.axes()[0];
            let w = (view.clip_from_world * (origin + direction * depth).extend(1.0)).w;
            let displaced = right * (view.thickness * npr_outline::fin_printed::fin_printed_depth(w, FinDepth::Eye));
            let [from, to] = [DVec3::ZERO, displaced].map(|aside| {
                let clip = view.clip_from_world * (origin + direction * depth + aside).extend(1.0);
                npr_outline::segment::outline_screen(clip, size).0
            });
            assert_relative_eq!(from.distance(to), 3.0, epsilon = 1e-9);
            if let FinDepth::Printed { near, far } = view.depth {
                let farthest = (0..8u8)
                    .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)))
                    .map(|corner| (camera.eye - corner).dot(camera.axes()[2]))
                    .fold(0.0, f64::max);
                assert_relative_eq!(far, 1.01 * farthest, epsilon = 1e-9);
                assert_eq!(near, camera.near);
            }
        }
    }

    #[test]
    fn points_at_one_place_have_a_camera_before_them() {
        for place in [Vec3::ZERO, Vec3::splat(1e-40), Vec3::new(3.0, 4e7, -1e30)] {
            for fov_y_rad in [Some(0.6), None] {
                let camera = Camera::framed([place; 3].into_iter(), 1.5, &Framing { fov_y_rad, ..Framing::default() });
                assert!(camera.axes().iter().all(|axis| axis.is_normalized()), "{place}: {:?}", camera.axes());
                assert!(camera.near > 0.0 && camera.clip_from_world(1.5).is_finite(), "{place}: {camera:?}");
                let view = camera.line_view(DVec2::new(150.0, 100.0));
                assert!(view.depth_per_px.is_finite(), "{place}: {view:?}");
            }
        }
    }

    #[test]
    fn a_framed_model_fills_the_picture_and_does_not_leave_it() {
        for camera in cameras() {
            let mut widest = 0.0f64;
            for i in 0..8u8 {
                let corner = DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
                let clip = camera.clip_from_world(1.5) * corner.extend(1.0);
                widest = widest.max((clip.truncate() / clip.w).truncate().abs().max_element());
            }
            assert!((0.8..=0.901).contains(&widest), "{widest}");
        }
    }
}

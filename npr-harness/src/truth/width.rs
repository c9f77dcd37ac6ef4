//! The width of a drawn line, measured across it.

use crate::camera::Camera;
use crate::scene::Scene;
use crate::view::size_px;
use glam::{DVec2, DVec3, Vec3};
use npr_mesh::Model;

/// A triangle whose base lies across the view of a camera at the origin that looks along −z, and the base's ends, px.
///
/// - `distance`: the distance of the base, world units;
/// - `tilt_deg`: the angle by which the triangle is turned about its base, away from facing the camera.
pub fn base_of_triangle(distance: f64, tilt_deg: f64, camera: &Camera, size: (u32, u32)) -> (Scene, [DVec2; 2]) {
    let (sin, cos) = tilt_deg.to_radians().sin_cos();
    // Nearly level, so that the base crosses rows of pixels. The other sides end far from its middle.
    let [left, right] = [DVec3::new(-0.3, -0.13, -1.0), DVec3::new(0.3, -0.09, -1.0)];
    let top = DVec3::new(0.0, -0.11 + 1.5 * cos, -1.0 - 1.5 * sin);
    let corners = [left, right, top].map(|corner| corner * distance);
    let clip_from_world = camera.clip_from_world(f64::from(size.0) / f64::from(size.1));
    let ends = [corners[0], corners[1]]
        .map(|end| npr_outline::segment::outline_screen(clip_from_world * end.extend(1.0), size_px(size)).0);
    (Scene::new(triangle(corners.map(|corner| corner.as_vec3()))), ends)
}

/// A triangle of a default material.
pub fn triangle(corners: [Vec3; 3]) -> Model {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
    Model {
        positions: corners.to_vec(),
        normals: vec![normal; 3],
        faces: vec![[0, 1, 2]],
        face_material: vec![0],
        materials: vec![Default::default()],
        ..Default::default()
    }
}

/// The width of a line, px: the mean, over the columns of the middle third, of the darkness across it.
///
/// - `darkness`: per pixel, in rows of `width`, 0..=1;
/// - `ends`: of the line, px, more level than upright, the left one first;
/// - `asked_px`: the width asked for, which bounds the distance in which darkness counts.
pub fn width_in_the_middle(darkness: &[f64], width: u32, [from, to]: [DVec2; 2], asked_px: f64) -> f64 {
    let along = to - from;
    let (first, end) = ((from.x + along.x / 3.0) as u32, (to.x - along.x / 3.0) as u32);
    let reach = 2.0 * asked_px + 4.0;
    let mut sum = 0.0;
    for x in first..end {
        let middle = from.y + along.y * (f64::from(x) + 0.5 - from.x) / along.x;
        for y in (middle - reach) as u32..=(middle + reach) as u32 {
            sum += darkness[(y * width + x) as usize];
        }
    }
    sum / f64::from(end - first) * along.x / along.length()
}

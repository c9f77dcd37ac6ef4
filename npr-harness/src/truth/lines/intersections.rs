//! Intersection curves of surfaces, which are lines but not edges of the model.
//!
//! The intersection of two triangles is a segment of the line in which their planes intersect: T. Möller, "A Fast
//! Triangle-Triangle Intersection Test", 1997. Candidates are found by a sweep along the model's longest axis.

use super::{NO_EDGE, TrueLines, TrueSegment, Visibility};
use crate::camera::Camera;
use crate::scene::Scene;
use glam::DVec3;
use npr_outline::LineKind;

/// The number of faces above which a model is not searched, to limit the time.
pub const MOST_FACES_INTERSECTED: usize = 250_000;

/// A segment of an intersection curve, world space.
struct Intersection {
    ends: [DVec3; 2],
    faces: [u32; 2],
}

/// The visible intersection curves of faces whose visible sides meet at an angle of more than `least_angle_rad`.
///
/// Empty for models with more than [`MOST_FACES_INTERSECTED`] faces.
pub fn true_intersections(scene: &Scene, camera: &Camera, size: (u32, u32), least_angle_rad: f64) -> TrueLines {
    let visibility = Visibility::new(scene, camera, size);
    let eye = camera.homogeneous_eye();
    let is_sharp = |intersection: &Intersection| {
        let [a, b] = intersection.faces.map(|face| {
            let [a, b, c] = corners(scene, face);
            let normal = (b - a).cross(c - a);
            if normal.dot(eye.truncate() - a * eye.w) < 0.0 { -normal } else { normal }
        });
        a.cross(b).length().atan2(a.dot(b)) > least_angle_rad
    };
    let seen = |intersection: &Intersection| {
        let own = |face: u32| intersection.faces.iter().any(|&of| visibility.same_polygon(of, face));
        visibility.seen_pieces(intersection.ends, |point| visibility.sees_past(point, own))
    };
    let pieces = intersections(scene).into_iter().filter(is_sharp).flat_map(|intersection| seen(&intersection));
    let segments = pieces.map(|ends_px| TrueSegment { ends_px, kind: LineKind::Crease, edge: NO_EDGE }).collect();
    TrueLines { segments, size_px: size }
}

fn corners(scene: &Scene, face: u32) -> [DVec3; 3] {
    scene.single().model().faces[face as usize].map(|v| scene.single().model().positions[v as usize].as_dvec3())
}

fn intersections(scene: &Scene) -> Vec<Intersection> {
    let model = scene.single().model();
    let Some((low, high)) = model.bounds() else { return Vec::new() };
    if model.faces.len() > MOST_FACES_INTERSECTED {
        return Vec::new();
    }
    let extent = (high - low).to_array();
    let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
    let boxes: Vec<(DVec3, DVec3)> = (0..model.faces.len() as u32)
        .map(|face| {
            let [a, b, c] = corners(scene, face);
            (a.min(b).min(c), a.max(b).max(c))
        })
        .collect();
    let mut order: Vec<u32> = (0..model.faces.len() as u32).collect();
    order.sort_by(|&a, &b| boxes[a as usize].0[axis].total_cmp(&boxes[b as usize].0[axis]));
    let places = |face: u32| model.faces[face as usize].map(|v| scene.single().edges().representative[v as usize]);
    let (mut active, mut found): (Vec<u32>, _) = (Vec::new(), Vec::new());
    for face in order {
        let (low, high) = boxes[face as usize];
        active.retain(|&other| boxes[other as usize].1[axis] >= low[axis]);
        for &other in &active {
            let (other_low, other_high) = boxes[other as usize];
            let apart = other_low.cmpgt(high).any() || low.cmpgt(other_high).any();
            if apart || places(face).iter().any(|place| places(other).contains(place)) {
                continue;
            }
            if let Some(ends) = crossing(corners(scene, face), corners(scene, other)) {
                found.push(Intersection { ends, faces: [face, other] });
            }
        }
        active.push(face);
    }
    found
}

/// The intersection segment of two triangles; `None` if they only touch or are coplanar.
fn crossing(first: [DVec3; 3], second: [DVec3; 3]) -> Option<[DVec3; 2]> {
    let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
    let (n1, n2) = (normal(first), normal(second));
    let direction = n1.cross(n2);
    let of_first = cut(first, n2, second[0], direction)?;
    let of_second = cut(second, n1, first[0], direction)?;
    let from = if of_first[0].0 > of_second[0].0 { of_first[0] } else { of_second[0] };
    let to = if of_first[1].0 < of_second[1].0 { of_first[1] } else { of_second[1] };
    (from.0 < to.0).then_some([from.1, to.1])
}

/// The two points where a plane cuts the sides of a triangle, each with its coordinate along `direction`, in order.
fn cut(triangle: [DVec3; 3], normal: DVec3, on_plane: DVec3, direction: DVec3) -> Option<[(f64, DVec3); 2]> {
    let heights = triangle.map(|corner| normal.dot(corner - on_plane));
    let mut points = [(0.0, DVec3::ZERO); 2];
    let mut count = 0;
    for i in 0..3 {
        let (a, b) = (i, (i + 1) % 3);
        if (heights[a] < 0.0) != (heights[b] < 0.0) && count < 2 {
            let point = triangle[a].lerp(triangle[b], heights[a] / (heights[a] - heights[b]));
            points[count] = (direction.dot(point), point);
            count += 1;
        }
    }
    if points[0].0 > points[1].0 {
        points.swap(0, 1);
    }
    (count == 2).then_some(points)
}

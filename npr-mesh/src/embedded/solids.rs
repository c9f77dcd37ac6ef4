//! Simple solids, and their transformation.

use std::f64::consts::TAU;

use glam::{DVec3, Mat3, Mat4, Vec3};

use crate::{Material, Model};

/// The cube from -1 to 1: six square polygons with flat normals.
pub fn cube() -> Model {
    let mut shape = Shape::default();
    for normal in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z] {
        // Two axes that form a right-handed system with the normal.
        let right = DVec3::new(normal.z, normal.x, normal.y);
        let up = normal.cross(right);
        let corners = [-right - up, right - up, right + up, up - right];
        shape.facet(&corners.map(|corner| normal + corner), normal);
    }
    shape.finish()
}

/// The unit sphere around the origin with `segments` (at least 3) meridians, half as many bands (at least 2), and one
/// vertex at each pole.
pub fn sphere(segments: u32) -> Model {
    let segments = segments.max(3);
    let bands = (segments / 2).max(2);
    let mut shape = Shape::default();
    let south = shape.vertex(DVec3::NEG_Y, DVec3::NEG_Y);
    let north = shape.vertex(DVec3::Y, DVec3::Y);
    let mut below = vec![south; segments as usize];
    for ring in 1..=bands {
        let latitude = TAU * (f64::from(ring) / f64::from(bands) - 0.5) / 2.0;
        let above: Vec<_> = (0..segments)
            .map(|i| {
                if ring == bands {
                    return north;
                }
                let p = around(i, segments) * latitude.cos() + DVec3::Y * latitude.sin();
                shape.vertex(p, p)
            })
            .collect();
        shape.band(&below, &above);
        below = above;
    }
    shape.finish()
}

/// The cylinder of radius 1 around the Y axis from y = -1 to 1, with `segments` (at least 3) flat sides with smooth
/// normals, and hard edges at the caps.
pub fn cylinder(segments: u32) -> Model {
    let segments = segments.max(3);
    let mut shape = Shape::default();
    let circle: Vec<_> = (0..segments).map(|i| around(i, segments)).collect();
    let mut ring = |y: f64| circle.iter().map(|&p| shape.vertex(p + DVec3::Y * y, p)).collect::<Vec<_>>();
    let (below, above) = (ring(-1.0), ring(1.0));
    shape.quads(&below, &above);
    shape.cap(segments, 1.0, DVec3::Y);
    shape.cap(segments, 1.0, DVec3::NEG_Y);
    shape.finish()
}

/// The cone around the Y axis with a base of radius 1 at y = -1 and its apex at y = 1; `segments` as in [`cylinder`].
/// Each side has its own apex vertex with the normal at the middle of the side.
pub fn cone(segments: u32) -> Model {
    let segments = segments.max(3);
    let mut shape = Shape::default();
    // Perpendicular to the slope, which falls by 2 over a distance of 1.
    let slanted = |outwards: DVec3| (2.0 * outwards + DVec3::Y).normalize();
    let base: Vec<_> =
        (0..segments).map(|i| around(i, segments)).map(|p| shape.vertex(p - DVec3::Y, slanted(p))).collect();
    for i in 0..segments {
        let tip = shape.vertex(DVec3::Y, slanted(around(2 * i + 1, 2 * segments)));
        shape.polygon(&[base[i as usize], base[(i + 1) as usize % base.len()], tip]);
    }
    shape.cap(segments, 1.0, DVec3::NEG_Y);
    shape.finish()
}

/// The torus around the Y axis: `major` is the radius of the tube's centre line, `minor` the radius of the tube, with
/// `around_axis` and `around_tube` segments (at least 3 of each).
pub fn torus(major: f32, minor: f32, around_axis: u32, around_tube: u32) -> Model {
    let (around_axis, around_tube) = (around_axis.max(3), around_tube.max(3));
    let (major, minor) = (f64::from(major), f64::from(minor));
    let mut shape = Shape::default();
    let rings: Vec<Vec<_>> = (0..around_tube)
        .map(|j| {
            let tube = angle(j, around_tube);
            (0..around_axis)
                .map(|i| {
                    let outwards = around(i, around_axis);
                    let normal = outwards * tube.cos() + DVec3::Y * tube.sin();
                    shape.vertex(outwards * major + normal * minor, normal)
                })
                .collect()
        })
        .collect();
    for j in 0..rings.len() {
        shape.band(&rings[j], &rings[(j + 1) % rings.len()]);
    }
    shape.finish()
}

/// A disc of radius `half_size` at y = 0 with the normal +Y: one polygon of 128 corners.
pub fn ground(half_size: f32) -> Model {
    let mut shape = Shape::default();
    shape.cap(128, f64::from(half_size), DVec3::Y);
    // The cap of a unit cylinder is at y = 1.
    shape.model.positions.iter_mut().for_each(|p| p.y = 0.0);
    shape.finish()
}

/// `model` transformed by an affine `transform`, with `material` as its only material and without textures. A
/// mirroring transform also reverses the winding of faces, so that they still face outwards.
pub fn placed(model: Model, transform: Mat4, material: Material) -> Model {
    let mut model = model;
    let linear = Mat3::from_mat4(transform);
    let mirrored = linear.determinant() < 0.0;
    // The cofactor matrix transforms normals like the inverse transpose, but exists for every matrix.
    let cofactors = Mat3::from_cols(
        linear.y_axis.cross(linear.z_axis),
        linear.z_axis.cross(linear.x_axis),
        linear.x_axis.cross(linear.y_axis),
    ) * if mirrored { -1.0 } else { 1.0 };
    for position in &mut model.positions {
        *position = transform.transform_point3(*position);
    }
    for normal in &mut model.normals {
        *normal = (cofactors * *normal).normalize_or(*normal);
    }
    if mirrored {
        model.faces.iter_mut().for_each(|face| face.swap(1, 2));
    }
    model.face_material.fill(0);
    model.materials = vec![Material { texture: None, ..material }];
    model.textures.clear();
    model
}

/// Step `i` of `n` around a circle; step n is bitwise equal to step 0.
fn angle(i: u32, n: u32) -> f64 {
    TAU * f64::from(i % n) / f64::from(n)
}

/// On the unit circle around the Y axis, counter-clockwise seen from above.
fn around(i: u32, n: u32) -> DVec3 {
    let (sin, cos) = angle(i, n).sin_cos();
    DVec3::new(cos, 0.0, -sin)
}

/// A model under construction.
#[derive(Default)]
struct Shape {
    model: Model,
    polygons: u32,
}

impl Shape {
    fn vertex(&mut self, position: DVec3, normal: DVec3) -> u32 {
        self.model.positions.push(position.as_vec3() + Vec3::ZERO);
        self.model.normals.push(normal.as_vec3());
        self.model.positions.len() as u32 - 1
    }

    /// A flat convex polygon, cut into a fan.
    fn polygon(&mut self, corners: &[u32]) {
        for pair in corners[1..].windows(2) {
            self.model.faces.push([corners[0], pair[0], pair[1]]);
            self.model.face_polygon.push(self.polygons);
        }
        self.polygons += 1;
    }

    /// A polygon with its own vertices and a flat normal.
    fn facet(&mut self, corners: &[DVec3], normal: DVec3) {
        let corners: Vec<_> = corners.iter().map(|&corner| self.vertex(corner, normal)).collect();
        self.polygon(&corners);
    }

    /// A cylinder's end: a disc of `radius`, 1 along `normal`, which is ±Y.
    fn cap(&mut self, segments: u32, radius: f64, normal: DVec3) {
        let centre = self.vertex(normal, normal);
        let rim: Vec<_> = (0..segments)
            .map(|i| {
                let i = if normal.y > 0.0 { i } else { segments - i };
                self.vertex(around(i, segments) * radius + normal, normal)
            })
            .collect();
        // A fan around a vertex in the centre, since a fan from the rim would consist of slivers.
        for (i, &corner) in rim.iter().enumerate() {
            self.model.faces.push([centre, corner, rim[(i + 1) % rim.len()]]);
            self.model.face_polygon.push(self.polygons);
        }
        self.polygons += 1;
    }

    /// Flat quads between two closed rings of equal length, `above` on the left of the way along `below`.
    fn quads(&mut self, below: &[u32], above: &[u32]) {
        for i in 0..below.len() {
            let next = (i + 1) % below.len();
            self.polygon(&[below[i], below[next], above[next], above[i]]);
        }
    }

    /// Like [`Shape::quads`], for curved surfaces: every triangle is a polygon of its own. Where one of the rings is
    /// a single point, each quad is reduced to one triangle.
    fn band(&mut self, below: &[u32], above: &[u32]) {
        for i in 0..below.len() {
            let next = (i + 1) % below.len();
            if below[i] != below[next] {
                self.polygon(&[below[i], below[next], above[next]]);
            }
            if above[i] != above[next] {
                self.polygon(&[below[i], above[next], above[i]]);
            }
        }
    }

    fn finish(self) -> Model {
        let mut model = self.model;
        if self.polygons as usize == model.faces.len() {
            model.face_polygon.clear();
        }
        model.face_material = vec![0; model.faces.len()];
        model.materials = vec![Material::default()];
        model
    }
}

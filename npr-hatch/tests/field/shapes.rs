//! Surfaces with known principal directions, with regular and irregular tessellations.

use glam::{DVec3, Vec3};
use npr_hatch::field::{FieldOptions, LineTensor, direction_field};
use oorandom::Rand32;

#[derive(Clone, Default)]
pub struct Mesh {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub faces: Vec<[u32; 3]>,
    pub representative: Vec<u32>,
    /// Per vertex the parameters of its point.
    pub parameters: Vec<[f64; 2]>,
}

/// The tessellation of a parameter rectangle.
#[derive(Clone, Copy)]
pub struct Cut {
    pub cells: [u32; 2],
    /// Whether the last column is identified with the first, and the last row with the first.
    pub closed: [bool; 2],
    /// The random displacement of vertices in cells; if not zero, diagonals have random directions.
    pub stray: f64,
}

impl Mesh {
    /// A mesh from a function that maps parameters in 0..=1 to points and normals.
    pub fn patch(cut: Cut, at: impl Fn(f64, f64) -> (DVec3, DVec3)) -> Self {
        let [across, along] = cut.cells;
        let counts = [across + u32::from(!cut.closed[0]), along + u32::from(!cut.closed[1])];
        let mut random = Rand32::new(7);
        let mut mesh = Self::default();
        for j in 0..counts[1] {
            for i in 0..counts[0] {
                let [u, v] = [(i, 0), (j, 1)].map(|(k, axis)| {
                    let inside = cut.closed[axis] || (k > 0 && k < cut.cells[axis]);
                    let stray = (f64::from(random.rand_float()) * 2.0 - 1.0) * cut.stray;
                    (f64::from(k) + if inside { stray } else { 0.0 }) / f64::from(cut.cells[axis])
                });
                let (position, normal) = at(u, v);
                mesh.positions.push(position.as_vec3());
                mesh.normals.push(normal.normalize_or_zero().as_vec3());
                mesh.parameters.push([u, v]);
            }
        }
        for j in 0..along {
            for i in 0..across {
                let vertex = |i: u32, j: u32| i % counts[0] + j % counts[1] * counts[0];
                let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
                let other = cut.stray > 0.0 && random.rand_u32() & 1 == 1;
                mesh.faces.extend(if other { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] });
            }
        }
        mesh.representative = (0..mesh.positions.len() as u32).collect();
        mesh
    }

    pub fn field(&self, options: &FieldOptions) -> Vec<LineTensor> {
        let field = direction_field(&self.positions, &self.normals, &self.faces, &self.representative, options);
        field.unwrap()
    }

    /// The maximum and the mean angle in degrees between a field and the exact directions. Vertices with `None` are
    /// excluded.
    pub fn errors(&self, field: &[LineTensor], exact: impl Fn(usize) -> Option<DVec3>) -> [f64; 2] {
        let angles = field.iter().enumerate().filter_map(|(i, tensor)| Some(degrees(tensor.direction(), exact(i)?)));
        let (largest, sum, count) = angles.fold((0.0, 0.0, 0), |(m, s, n), a| (f64::max(m, a), s + a, n + 1));
        assert!(count > 0);
        [largest, sum / f64::from(count)]
    }

    /// The mesh with three separate vertices per face, which keep their normals.
    pub fn apart(&self) -> Self {
        let corners: Vec<u32> = self.faces.iter().flatten().copied().collect();
        let mut first = vec![None; self.positions.len()];
        Self {
            positions: corners.iter().map(|&v| self.positions[v as usize]).collect(),
            normals: corners.iter().map(|&v| self.normals[v as usize]).collect(),
            parameters: corners.iter().map(|&v| self.parameters[v as usize]).collect(),
            faces: (0..self.faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect(),
            representative: (0..).zip(&corners).map(|(i, &v)| *first[v as usize].get_or_insert(i)).collect(),
        }
    }

    /// The mesh with three separate vertices per face, which have the normal of the face.
    pub fn faceted(&self) -> Self {
        let mut mesh = self.apart();
        for face in &mesh.faces {
            let [a, b, c] = face.map(|v| mesh.positions[v as usize]);
            face.iter().for_each(|&v| mesh.normals[v as usize] = (b - a).cross(c - a).normalize());
        }
        mesh
    }

    /// Appends another mesh without merging vertices.
    pub fn append(&mut self, other: &Self) {
        let first = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        self.normals.extend(&other.normals);
        self.parameters.extend(&other.parameters);
        self.faces.extend(other.faces.iter().map(|face| face.map(|v| v + first)));
        self.representative.extend(other.representative.iter().map(|v| v + first));
    }

    pub fn map(&self, position: impl Fn(Vec3) -> Vec3, normal: impl Fn(Vec3) -> Vec3) -> Self {
        let mut mesh = self.clone();
        mesh.positions.iter_mut().for_each(|p| *p = position(*p));
        mesh.normals.iter_mut().for_each(|n| *n = normal(*n));
        mesh
    }
}

/// The angle between two undirected lines in degrees.
pub fn degrees(a: Vec3, b: DVec3) -> f64 {
    let (a, b) = (a.as_dvec3(), b.normalize());
    f64::atan2(a.cross(b).length(), a.dot(b).abs()).to_degrees()
}

/// The direction around the z axis.
pub fn around(turns: f64) -> DVec3 {
    let (sin, cos) = (turns * std::f64::consts::TAU).sin_cos();
    DVec3::new(cos, sin, 0.0)
}

/// An open cylinder of radius 1 around z from -1 to 1.
pub fn cylinder(cells: [u32; 2], stray: f64) -> Mesh {
    Mesh::patch(Cut { cells, closed: [true, false], stray }, |u, v| (around(u) + DVec3::Z * (2.0 * v - 1.0), around(u)))
}

/// A torus around z; the first parameter is the angle around the axis, the second around the tube.
pub fn torus(major: f64, minor: f64, cells: [u32; 2], stray: f64) -> Mesh {
    Mesh::patch(Cut { cells, closed: [true, true], stray }, |u, v| {
        let tube = around(v);
        let normal = around(u) * tube.x + DVec3::Z * tube.y;
        (around(u) * major + normal * minor, normal)
    })
}

/// The direction around the tube of [`torus`].
pub fn around_tube([u, v]: [f64; 2]) -> DVec3 {
    let ahead = around(v + 0.25);
    around(u) * ahead.x + DVec3::Z * ahead.y
}

/// An ellipsoid with semi-axes along x, y and z; the first parameter is the longitude. Each pole consists of many
/// vertices at one position.
pub fn ellipsoid(axes: DVec3, cells: [u32; 2], stray: f64) -> Mesh {
    let mut mesh = Mesh::patch(Cut { cells, closed: [true, false], stray }, |u, v| {
        let latitude = around((v - 0.5) / 2.0);
        let unit = around(u) * latitude.x + DVec3::Z * latitude.y;
        (axes * unit, unit / axes)
    });
    let row = cells[0] as usize;
    let last = mesh.positions.len() - row;
    for (pole, first) in [(axes.z * DVec3::NEG_Z, 0), (axes.z * DVec3::Z, last)] {
        mesh.positions[first..first + row].fill(pole.as_vec3());
        mesh.normals[first..first + row].fill(pole.as_vec3().normalize());
        mesh.representative[first..first + row].fill(first as u32);
    }
    mesh
}

/// Both principal curvatures at a point of an ellipsoid with these semi-axes, the larger first, and the direction of
/// the larger.
pub fn ellipsoid_curvature(axes: DVec3, point: DVec3) -> ([f64; 2], DVec3) {
    // For the level set F = Σ (x / a)² the shape operator is the Hessian divided by the length of the gradient,
    // restricted to the tangent plane.
    let hessian = 2.0 / (axes * axes);
    let gradient = hessian * point;
    let (u, v) = gradient.normalize().any_orthonormal_pair();
    let form = |a: DVec3, b: DVec3| a.dot(hessian * b) / gradient.length();
    let (mean, half, mixed) = ((form(u, u) + form(v, v)) / 2.0, (form(u, u) - form(v, v)) / 2.0, form(u, v));
    let apart = half.hypot(mixed);
    let angle = mixed.atan2(half) / 2.0;
    ([mean + apart, mean - apart], u * angle.cos() + v * angle.sin())
}

//! The normals for the curvature fit: the given normals, or means of face normals where these are missing or flat.

use glam::{DVec3, Vec3};

use super::surface::{Face, Surface};

/// A face is a facet if the squared distances between its corner normals are below this.
const FLAT: f64 = 1e-6;
/// The cosine of 50°. Facets that meet at a smaller angle are treated as one smooth surface, such as the sides of an
/// octagonal prism (45°), but not those of a hexagonal prism (60°).
const SMOOTH_COS: f64 = 0.642_787_609_686_539_3;
/// At nodes with more faces all faces are used regardless of the angle, to bound the quadratic number of comparisons.
const MAX_COMPARED: usize = 64;

/// Per face of the surface three unit normals.
pub(super) fn corner_normals(
    surface: &Surface,
    positions: &[Vec3],
    normals: &[Vec3],
    faces: &[[u32; 3]],
) -> Vec<[DVec3; 3]> {
    let mut corners: Vec<[DVec3; 3]> =
        surface.faces.iter().map(|face| faces[face.given as usize].map(|v| unit(normals[v as usize]))).collect();
    // In a component of facets only, the normals are those of the faces and contain no curvature.
    let mut faceted = vec![true; surface.size.len()];
    for (face, corners) in surface.faces.iter().zip(&corners) {
        let flat = corners.iter().all(|n| n.distance_squared(corners[0]) < FLAT);
        faceted[surface.part[face.nodes[0] as usize] as usize] &= flat;
    }
    let is_faceted = |face: &Face| faceted[surface.part[face.nodes[0] as usize] as usize];
    let missing = |face: &Face, corners: &[DVec3; 3]| is_faceted(face) || corners.contains(&DVec3::ZERO);
    if !surface.faces.iter().zip(&corners).any(|(face, corners)| missing(face, corners)) {
        return corners;
    }
    let around = Around::new(surface, positions, faces);
    for (face, corners) in surface.faces.iter().zip(&mut corners) {
        let faceted = is_faceted(face);
        for (corner, &node) in corners.iter_mut().zip(&face.nodes) {
            if faceted || *corner == DVec3::ZERO {
                *corner = around.mean(node, face.normal);
            }
        }
    }
    corners
}

/// A unit vector; zero if the input is zero or not finite.
pub(super) fn unit(normal: Vec3) -> DVec3 {
    let unit = normal.as_dvec3().normalize_or_zero();
    if unit.is_finite() { unit } else { DVec3::ZERO }
}

/// The faces around each node: their normals, and their weights at that corner.
struct Around {
    /// Per node the start of its range in `faces`, followed by the end of the last range.
    offsets: Vec<u32>,
    faces: Vec<(DVec3, f64)>,
    /// Per node the weighted sum of all normals.
    sums: Vec<DVec3>,
}

impl Around {
    fn new(surface: &Surface, positions: &[Vec3], faces: &[[u32; 3]]) -> Self {
        let mut offsets = vec![0_u32; surface.nodes() + 1];
        for node in surface.faces.iter().flat_map(|face| face.nodes) {
            offsets[node as usize + 1] += 1;
        }
        for node in 0..surface.nodes() {
            offsets[node + 1] += offsets[node];
        }
        let mut next = offsets.clone();
        let mut list = vec![(DVec3::ZERO, 0.0); surface.faces.len() * 3];
        let mut sums = vec![DVec3::ZERO; surface.nodes()];
        for face in &surface.faces {
            let corners = faces[face.given as usize].map(|v| positions[v as usize].as_dvec3());
            let size = surface.size_at(face);
            for (k, node) in face.nodes.into_iter().enumerate() {
                let [to, fro] = [1, 2].map(|step| ((corners[(k + step) % 3] - corners[k]) / size).length_squared());
                // The weights of Max 1999, which are exact for triangles inscribed in a sphere.
                let weight = face.area / (size * size) / (to * fro);
                let weight = if weight.is_finite() { weight } else { 0.0 };
                list[next[node as usize] as usize] = (face.normal, weight);
                next[node as usize] += 1;
                sums[node as usize] += face.normal * weight;
            }
        }
        Self { offsets, faces: list, sums }
    }

    /// The mean normal of the faces at a node that form a smooth surface with the face of this normal.
    fn mean(&self, node: u32, normal: DVec3) -> DVec3 {
        let node = node as usize;
        let faces = &self.faces[self.offsets[node] as usize..self.offsets[node + 1] as usize];
        let sum = if faces.len() > MAX_COMPARED {
            self.sums[node]
        } else {
            faces.iter().filter(|(n, _)| n.dot(normal) > SMOOTH_COS).map(|&(n, weight)| n * weight).sum()
        };
        sum.normalize_or(normal)
    }
}

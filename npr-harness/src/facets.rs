//! Faces that are lit as wholes: their centroids and their own normals.

use crate::scene::Mesh;
use glam::{DVec3, Vec3};
use npr_mesh::Model;
use npr_mesh::edges::{face_normals, triangle_normal};
use std::convert::Infallible;
use std::sync::Arc;

/// Where and with which normal a face is lit, in mesh space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// The centroid of the polygon that the face is part of, or of the face where the model has no polygons.
    pub centroid: Vec3,
    /// The unit normal, on the side from which the corners appear counterclockwise. Where the polygon has no area it is that
    /// of the face, and zero where that has none.
    pub normal: Vec3,
}

/// The cache key of a mesh's facets.
#[derive(PartialEq)]
struct FacetsKey;

/// The facets of all faces of a mesh.
pub(crate) fn facets(mesh: &Mesh) -> Arc<Vec<Facet>> {
    let Ok(facets) = mesh.derived().get(FacetsKey, || Ok::<_, Infallible>(facets_of(mesh.model())));
    facets
}

fn facets_of(model: &Model) -> Vec<Facet> {
    let Model { positions, faces, face_polygon, .. } = model;
    let normals = face_normals(positions, faces, face_polygon);
    let mut facets = Vec::with_capacity(faces.len());
    // The faces of a polygon follow each other.
    let is_same = |a: &usize, b: &usize| face_polygon.get(*a).is_some_and(|polygon| face_polygon[*b] == *polygon);
    let numbers: Vec<usize> = (0..faces.len()).collect();
    for polygon in numbers.chunk_by(is_same) {
        let centroid = centroid(positions, &faces[polygon[0]..=polygon[polygon.len() - 1]]);
        for &face in polygon {
            let normal = match normals[face] {
                Vec3::ZERO => triangle_normal(positions, &faces[face]),
                normal => normal,
            };
            facets.push(Facet { centroid, normal });
        }
    }
    facets
}

/// The centroid of the area of some faces, or the mean of their corners if they have no area.
fn centroid(positions: &[Vec3], faces: &[[u32; 3]]) -> Vec3 {
    let corners = |face: &[u32; 3]| face.map(|vertex| positions[vertex as usize].as_dvec3());
    let (mut weighted, mut area, mut sum) = (DVec3::ZERO, 0.0, DVec3::ZERO);
    for [a, b, c] in faces.iter().map(corners) {
        let (middle, twice) = ((a + b + c) / 3.0, (b - a).cross(c - a).length());
        weighted += middle * twice;
        area += twice;
        sum += middle;
    }
    let mean = if area > 0.0 { weighted / area } else { sum / faces.len() as f64 };
    mean.as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of two triangles, a triangle, and a polygon without area.
    fn model(face_polygon: Vec<u32>) -> Model {
        let at = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [2, 0, 3], [4, 0, 0], [0, 0, 5], [0, 0, 7]];
        Model {
            positions: at.map(|[x, y, z]| Vec3::new(x as f32, y as f32, z as f32)).to_vec(),
            faces: vec![[0, 1, 2], [0, 2, 3], [1, 5, 4], [0, 6, 7]],
            face_polygon,
            ..Model::default()
        }
    }

    #[test]
    fn a_polygon_is_lit_as_one() {
        let facets = facets_of(&model(vec![0, 0, 1, 2]));
        assert_eq!(facets[0], Facet { centroid: Vec3::new(1.0, 1.0, 0.0), normal: Vec3::Z });
        assert_eq!(facets[1], facets[0]);
        assert_eq!(facets[2], Facet { centroid: Vec3::new(8.0 / 3.0, 0.0, 1.0), normal: Vec3::NEG_Y });
        assert_eq!(facets[3], Facet { centroid: Vec3::new(0.0, 0.0, 4.0), normal: Vec3::ZERO });
    }

    #[test]
    fn without_polygons_each_triangle_is_lit_by_itself() {
        let facets = facets_of(&model(Vec::new()));
        assert_eq!(facets.len(), 4);
        assert!(facets[0].centroid.abs_diff_eq(Vec3::new(4.0 / 3.0, 2.0 / 3.0, 0.0), 1e-6));
        assert!(facets[1].centroid.abs_diff_eq(Vec3::new(2.0 / 3.0, 4.0 / 3.0, 0.0), 1e-6));
    }
}

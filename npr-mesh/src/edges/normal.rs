//! Normals of flat faces.

use glam::{DVec3, Vec3};

/// Unit normals of all faces, computed in f64 because an f32 cross product loses the direction of thin triangles.
/// Faces of a polygon get the normalised sum of their area vectors, which is the polygon's Newell normal for any
/// triangulation.
pub fn face_normals(positions: &[Vec3], faces: &[[u32; 3]], face_polygon: &[u32]) -> Vec<Vec3> {
    if face_polygon.is_empty() {
        return triangle_normals(positions, faces);
    }
    let mut normals = Vec::with_capacity(faces.len());
    for polygon in chunks_of_equal(face_polygon) {
        let area = faces[polygon.clone()].iter().map(|face| area_vector(positions, face)).sum();
        normals.resize(polygon.end, unit_or_zero(area));
    }
    normals
}

/// The unit normal of a single face, computed in f64; zero if the area is zero.
pub fn triangle_normal(positions: &[Vec3], face: &[u32; 3]) -> Vec3 {
    unit_or_zero(area_vector(positions, face))
}

/// Processes blocks, first all area vectors and then all normalisations, so that they are pipelined. On a million
/// faces this takes two thirds of the time of processing one face after another.
fn triangle_normals(positions: &[Vec3], faces: &[[u32; 3]]) -> Vec<Vec3> {
    const BLOCK: usize = 64;
    let mut areas = [DVec3::ZERO; BLOCK];
    let mut normals = Vec::with_capacity(faces.len());
    for block in faces.chunks(BLOCK) {
        let areas = &mut areas[..block.len()];
        for (area, face) in areas.iter_mut().zip(block) {
            *area = area_vector(positions, face);
        }
        let mut all_in_range = true;
        normals.extend(areas.iter().map(|area| {
            let squared = area.length_squared();
            all_in_range &= (f64::MIN_POSITIVE..=f64::MAX).contains(&squared);
            (*area * (1.0 / squared.sqrt())).as_vec3()
        }));
        if !all_in_range {
            normals.truncate(normals.len() - block.len());
            normals.extend(areas.iter().map(|&area| unit_or_zero(area)));
        }
    }
    normals
}

fn unit_or_zero(area: DVec3) -> Vec3 {
    let squared = area.length_squared();
    if (f64::MIN_POSITIVE..=f64::MAX).contains(&squared) {
        return (area * (1.0 / squared.sqrt())).as_vec3();
    }
    // Squares of area vectors under 1e-77 or over 1e77 leave the range of f64, so the vector is scaled first.
    let largest = area.abs().max_element();
    if largest > 0.0 && largest.is_finite() { (area / largest).normalize().as_vec3() } else { Vec3::ZERO }
}

/// Ranges of equal adjacent values.
fn chunks_of_equal(values: &[u32]) -> impl Iterator<Item = std::ops::Range<usize>> {
    let mut start = 0;
    values.chunk_by(|a, b| a == b).map(move |chunk| {
        let range = start..start + chunk.len();
        start = range.end;
        range
    })
}

/// The normal of the face with twice its area as length.
#[inline]
fn area_vector(positions: &[Vec3], &[a, b, c]: &[u32; 3]) -> DVec3 {
    let a = positions[a as usize].as_dvec3();
    (positions[b as usize].as_dvec3() - a).cross(positions[c as usize].as_dvec3() - a)
}

/// Whether the corners of the face are collinear. Differences and products of f32 values are exact in f64 unless
/// their magnitudes differ by a factor of 2²⁹, so the decision is exact for usual meshes.
pub fn has_zero_area(positions: &[Vec3], face: &[u32; 3]) -> bool {
    area_vector(positions, face) == DVec3::ZERO
}

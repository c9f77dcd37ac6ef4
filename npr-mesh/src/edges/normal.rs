//! Normals of flat faces.

use glam::{DVec3, Vec3};

/// Unit normals, computed in f64: of thin triangles an f32 cross product keeps no direction. A polygon's faces get
/// the sum of their areas' vectors, which is the polygon's Newell normal however it was cut.
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

/// The unit normal of one face by itself, computed in f64; zero where its area is zero.
pub fn triangle_normal(positions: &[Vec3], face: &[u32; 3]) -> Vec3 {
    unit_or_zero(area_vector(positions, face))
}

/// In blocks: all vectors first, then all lengths, so that no square root waits for the next face's corners. On a
/// million faces this takes two thirds of the time of one face after the other.
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
    // Squares of f32 lengths under 1e-77 or over 1e77 leave the range of f64: scale first.
    let largest = area.abs().max_element();
    if largest > 0.0 && largest.is_finite() { (area / largest).normalize().as_vec3() } else { Vec3::ZERO }
}

/// Ranges of equal values that stand next to each other.
fn chunks_of_equal(values: &[u32]) -> impl Iterator<Item = std::ops::Range<usize>> {
    let mut start = 0;
    values.chunk_by(|a, b| a == b).map(move |chunk| {
        let range = start..start + chunk.len();
        start = range.end;
        range
    })
}

/// Twice the face's area, along its normal.
#[inline]
fn area_vector(positions: &[Vec3], &[a, b, c]: &[u32; 3]) -> DVec3 {
    let a = positions[a as usize].as_dvec3();
    (positions[b as usize].as_dvec3() - a).cross(positions[c as usize].as_dvec3() - a)
}

/// Whether the corners lie on one line. Differences and products of f32 values are exact in f64 unless their
/// magnitudes are 2²⁹ apart, so this is decided exactly for anything like a mesh.
pub fn has_zero_area(positions: &[Vec3], face: &[u32; 3]) -> bool {
    area_vector(positions, face) == DVec3::ZERO
}

//! Curvature at nodes, by least squares in each face (Rusinkiewicz 2004).

use glam::{DMat3, DVec3, Vec2};

use super::{
    diffuse::Value,
    surface::{Face, Surface},
    tangent::{Tangent, carry},
};

/// The minimum ratio of height to longest edge of faces that are used.
const MIN_ASPECT: f64 = 1e-6;

/// Per node its curvature times the size of its component: the mean curvature as the scalar, and half the difference of the
/// principal curvatures as the weight of the line along the larger.
///
/// `corners` are the positions and the unit normals at the corners of each face.
pub(super) fn curvature(
    surface: &Surface,
    tangents: &[Tangent],
    corners: impl Iterator<Item = ([DVec3; 3], [DVec3; 3])>,
) -> Vec<Value> {
    let mut sums = vec![(Value::default(), 0.0_f32); tangents.len()];
    for (face, (positions, normals)) in surface.faces.iter().zip(corners) {
        let size = surface.size_at(face);
        let Some((u, form)) = second_form(face, &positions.map(|p| p - positions[0]), &normals) else { continue };
        let [mean, along, across] =
            [(form.x + form.z) / 2.0, (form.x - form.z) / 2.0, form.y].map(|k| (k * size) as f32);
        let weight = (face.area / (size * size)) as f32;
        let (u, normal) = (u.as_vec3(), face.normal.as_vec3());
        for node in face.nodes {
            let tangent = &tangents[node as usize];
            // The second fundamental form of a face with opposite winding is mirrored.
            let side = if tangent.normal.dot(normal) < 0.0 { -1.0 } else { 1.0 };
            let Some(turn) = tangent.line(carry(u, normal * side, tangent.normal)).try_normalize() else { continue };
            let value = Value { scalar: mean, line: Vec2::new(along, across * side).rotate(turn) };
            if value.is_finite() {
                let (sum, total) = &mut sums[node as usize];
                *sum = sum.plus(value.scaled(weight));
                *total += weight;
            }
        }
    }
    sums.into_iter().map(|(sum, total)| if total > 0.0 { sum.scaled(1.0 / total) } else { Value::default() }).collect()
}

/// The direction u of the longest edge of a face, and its second fundamental form (uu, uv, vv): the least-squares solution
/// that maps each edge to the difference of the normals at its ends.
fn second_form(face: &Face, positions: &[DVec3; 3], normals: &[DVec3; 3]) -> Option<(DVec3, DVec3)> {
    let edges = [0, 1, 2].map(|k| (positions[(k + 1) % 3] - positions[k], normals[(k + 1) % 3] - normals[k]));
    let (longest, _) = edges.into_iter().max_by(|(a, _), (b, _)| a.length_squared().total_cmp(&b.length_squared()))?;
    let length = longest.length();
    if 2.0 * face.area < MIN_ASPECT * length * length {
        return None;
    }
    let u = longest / length;
    let v = face.normal.cross(u);
    let (mut matrix, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for (edge, change) in edges {
        // In units of the longest edge.
        let (x, y) = (edge.dot(u) / length, edge.dot(v) / length);
        let (p, q) = (change.dot(u), change.dot(v));
        matrix += DMat3::from_cols(
            DVec3::new(x * x, x * y, 0.0),
            DVec3::new(x * y, x * x + y * y, x * y),
            DVec3::new(0.0, x * y, y * y),
        );
        right += DVec3::new(x * p, x * q + y * p, y * q);
    }
    let form = matrix.inverse() * right / length;
    form.is_finite().then_some((u, form))
}

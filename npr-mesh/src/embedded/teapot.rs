//! The Utah teapot from its Bézier patches.

use std::collections::HashMap;

use glam::DVec3;

use crate::{Material, Model};

// M. Newell's control points (1975; Crow, "The Origins of the Teapot", IEEE CG&A 7(1), 1987), Z up, reduced to what
// symmetry leaves. Four rows are a patch, and its last row is the first of the next patch.

/// Rim, body and bottom, from the rim's inner edge outwards and down: radius, the radius times what makes a quarter
/// circle of it (0.56), height. A row stands for (r, 0), (r, -t), (t, -r), (0, -r) at that height.
const BODY: [[f64; 3]; 13] = [
    [1.4, 0.784, 2.4],
    [1.3375, 0.749, 2.53125],
    [1.4375, 0.805, 2.53125],
    [1.5, 0.84, 2.4],
    [1.75, 0.98, 1.875],
    [2.0, 1.12, 1.35],
    [2.0, 1.12, 0.9],
    [2.0, 1.12, 0.45],
    [1.5, 0.84, 0.225],
    [1.5, 0.84, 0.15],
    [1.5, 0.84, 0.075],
    [1.425, 0.798, 0.0],
    [0.0, 0.0, 0.0],
];

/// The lid with its knob, from the top down, as [`BODY`].
const LID: [[f64; 3]; 7] = [
    [0.0, 0.0, 3.15],
    [0.8, 0.45, 3.15],
    [0.0, 0.0, 2.85],
    [0.2, 0.112, 2.7],
    [0.4, 0.224, 2.55],
    [1.3, 0.728, 2.55],
    [1.3, 0.728, 2.4],
];

/// The handle from its upper end to its lower: x and z on the inner side, x and z on the outer side, half the width.
/// A row stands for the points inner, inner and outer moved to -y by the half width, outer.
const HANDLE: [[f64; 5]; 7] = [
    [-1.6, 2.025, -1.5, 2.25, 0.3],
    [-2.3, 2.025, -2.5, 2.25, 0.3],
    [-2.7, 2.025, -3.0, 2.25, 0.3],
    [-2.7, 1.8, -3.0, 1.8, 0.3],
    [-2.7, 1.575, -3.0, 1.35, 0.3],
    [-2.5, 1.125, -2.65, 0.9375, 0.3],
    [-2.0, 0.9, -1.9, 0.6, 0.3],
];

/// The spout from the body to its tip, upper and lower side, as [`HANDLE`].
const SPOUT: [[f64; 5]; 7] = [
    [1.7, 1.425, 1.7, 0.6, 0.66],
    [2.6, 1.425, 3.1, 0.825, 0.66],
    [2.3, 2.1, 2.4, 2.025, 0.25],
    [2.7, 2.4, 3.3, 2.4, 0.25],
    [2.8, 2.475, 3.525, 2.49375, 0.25],
    [2.9, 2.475, 3.45, 2.5125, 0.15],
    [2.8, 2.4, 3.2, 2.4, 0.15],
];

type Patch = [[DVec3; 4]; 4];

/// The Utah teapot: 32 bicubic patches, each tessellated into `segments_per_patch` squared quads of two triangles.
/// Values below 2 count as 2, since one quad per patch would flatten handle and spout.
///
/// It stands on y = 0 around the Y axis in Newell's original size, 3.15 high, with the spout towards +X. Normals are
/// those of the Bézier surface. The four parts (body, lid, handle, spout) are closed surfaces except for six
/// openings: the rim, the lower edge of the lid, and both ends of handle and spout, which extend into the body.
pub fn teapot(segments_per_patch: u32) -> Model {
    let segments = segments_per_patch.max(2);
    let mut model = Model { materials: vec![Material::default()], ..Model::default() };
    let quarters = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    let halves = [[1.0, 1.0], [1.0, -1.0]];
    let ring = |[r, t, z]: [f64; 3]| [[r, 0.0], [r, -t], [t, -r], [0.0, -r]].map(|[x, y]| DVec3::new(x, y, z));
    let half_ring = |[x0, z0, x1, z1, width]: [f64; 5]| {
        [[x0, 0.0, z0], [x0, -width, z0], [x1, -width, z1], [x1, 0.0, z1]].map(DVec3::from_array)
    };
    add_part(&mut model, &BODY.map(ring), &quarters, segments);
    add_part(&mut model, &LID.map(ring), &quarters, segments);
    add_part(&mut model, &HANDLE.map(half_ring), &halves, segments);
    add_part(&mut model, &SPOUT.map(half_ring), &halves, segments);
    model.face_material = vec![0; model.faces.len()];
    model
}

/// Adds the patches of one part, once for each of `mirrors`, the factors of x and y. Patches of a part join smoothly,
/// so vertices at one position are merged; parts share no vertices.
fn add_part(model: &mut Model, rows: &[[DVec3; 4]], mirrors: &[[f64; 2]], segments: u32) {
    let mut at_position = HashMap::new();
    for first_row in (0..rows.len() - 1).step_by(3) {
        let patch: Patch = std::array::from_fn(|i| rows[first_row + i]);
        for &[mirror_x, mirror_y] in mirrors {
            let mirror = DVec3::new(mirror_x, mirror_y, 1.0);
            let mut grid = Vec::with_capacity((segments as usize + 1).pow(2));
            for row in 0..=segments {
                for column in 0..=segments {
                    let (u, v) = (f64::from(column) / f64::from(segments), f64::from(row) / f64::from(segments));
                    let (position, normal) = surface(&patch, u, v);
                    // Y up. Negation is exact and -0 becomes 0, so that border vertices of two patches, which lie in
                    // the mirror plane or have the same control points, are bitwise equal.
                    let position = y_up(position * mirror);
                    let key = position.as_vec3().to_array().map(f32::to_bits);
                    grid.push(*at_position.entry(key).or_insert_with(|| {
                        model.positions.push(position.as_vec3());
                        model.normals.push(y_up(normal * mirror).as_vec3());
                        model.positions.len() as u32 - 1
                    }));
                }
            }
            let at = |row: u32, column: u32| grid[(row * (segments + 1) + column) as usize];
            for row in 0..segments {
                for column in 0..segments {
                    let quad = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
                    let [a, b, c, d] =
                        if mirror_x * mirror_y > 0.0 { quad } else { [quad[0], quad[3], quad[2], quad[1]] };
                    for face in [[a, b, c], [a, c, d]] {
                        // At the poles a side of the quad is one point.
                        if face[0] != face[1] && face[1] != face[2] && face[2] != face[0] {
                            model.faces.push(face);
                        }
                    }
                }
            }
        }
    }
}

fn y_up(p: DVec3) -> DVec3 {
    DVec3::new(p.x, p.z, -p.y) + DVec3::ZERO
}

/// Position and outward unit normal at (u, v): u runs along the rows, v from row to row.
fn surface(patch: &Patch, u: f64, v: f64) -> (DVec3, DVec3) {
    let (bu, bv) = (bernstein(u), bernstein(v));
    let (du, dv) = (bernstein_derivative(u), bernstein_derivative(v));
    let sum = |u_weights: [f64; 4], v_weights: [f64; 4]| {
        let along = |row: &[DVec3; 4]| row.iter().zip(u_weights).map(|(&p, w)| p * w).sum::<DVec3>();
        patch.iter().zip(v_weights).map(|(row, w)| along(row) * w).sum::<DVec3>()
    };
    let mut along_u = sum(du, bv);
    // Where a row is one point, at v = 0 or 1, nothing changes along u. Next to it the derivative is that times the way
    // to the pole, so its direction tends to that of the mixed derivative.
    if along_u.length_squared() < 1e-20 {
        along_u = sum(du, dv) * if v < 0.5 { 1.0 } else { -1.0 };
    }
    (sum(bu, bv), along_u.cross(sum(bu, dv)).normalize())
}

/// At 0 and 1 exactly (1, 0, 0, 0) and (0, 0, 0, 1).
fn bernstein(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * t * s * s, 3.0 * t * t * s, t * t * t]
}

fn bernstein_derivative(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t]
}

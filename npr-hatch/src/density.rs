//! The texel density of texture coordinates, and its compensation.
//!
//! Hatching mapped by a model's own texture coordinates is coarse where these are stretched and dense where they are
//! compressed. [`octaves`] computes, per vertex, the power of two by which to multiply them so that a tile of the texture
//! has the same size everywhere. A shader blends the two integer octaves next to the interpolated value.
//!
//! ```
//! use glam::{Vec2, Vec3};
//! use npr_hatch::density::octaves;
//!
//! // A square of 2 by 2 with one tile over it.
//! let uvs = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
//! let positions = uvs.map(|uv| Vec3::new(uv.x, uv.y, 0.0) * 2.0);
//! let found = octaves(&positions, &uvs, &[[0, 1, 2], [0, 2, 3]], &[0, 1, 2, 3], 0.25)?;
//! assert_eq!(found, [3.0; 4]); // 8 tiles of length 0.25 in a length of 2
//! # Ok::<(), npr_hatch::HatchError>(())
//! ```

use std::ops::RangeInclusive;

use glam::{DVec2, DVec3, Vec2, Vec3};

use crate::{
    HatchError,
    field::{check_indices, check_lengths},
};

/// The range to which octaves are clamped.
pub const OCTAVES: RangeInclusive<f32> = -8.0..=16.0;

/// The number of smoothing steps, each of which averages a value with the mean of its neighbours.
const SWEEPS: u32 = 3;
/// The maximum number of edges over which values are propagated to vertices without a value.
const RINGS: u32 = 32;

/// Per vertex the octave: log2 of the number of tiles per unit of the texture coordinates, so that `uv * octave.exp2()`
/// advances by 1 per `tile_length` of the surface, on average over both directions.
///
/// - `positions`, `uvs`: per vertex. `faces`: three vertices each.
/// - `representative`: per vertex, a common vertex for all vertices at its position. Vertices with one representative and
///   equal texture coordinates are treated as one; at a texture seam each side has its own density.
/// - `tile_length`: in units of the positions, above 0.
///
/// The octave of a face is log2(√(area / area of its texture coordinates) / `tile_length`). That of a vertex is the mean
/// over its faces weighted by area, smoothed by three steps of averaging with its neighbours. Faces with zero area in space
/// or in texture coordinates, or with non-finite numbers, are ignored. A vertex without other faces has the mean of its
/// neighbours, propagated over up to 32 edges, or else the median of all vertices; if all faces are ignored the result is
/// 0. The result is finite and within [`OCTAVES`].
///
/// Errors: slices of different lengths, indices out of range, a tile length that is not finite or not above 0.
pub fn octaves(
    positions: &[Vec3],
    uvs: &[Vec2],
    faces: &[[u32; 3]],
    representative: &[u32],
    tile_length: f32,
) -> Result<Vec<f32>, HatchError> {
    check_lengths(positions.len(), &[("uvs", uvs.len()), ("representative", representative.len())])?;
    check_indices(positions.len(), faces, representative)?;
    if !(f32::MIN_POSITIVE..=f32::MAX).contains(&tile_length) {
        let (low, high) = (f32::MIN_POSITIVE, f32::MAX);
        return Err(HatchError::Range { name: "tile_length", value: tile_length, low, high });
    }
    let (node_of, nodes) = nodes(uvs, representative);
    let mut sums = vec![Sum::default(); nodes];
    for face in faces {
        if let Some((octave, area)) = of_face(positions, uvs, face) {
            for &vertex in face {
                sums[node_of[vertex as usize] as usize].add(octave - libm::log2(f64::from(tile_length)), area);
            }
        }
    }
    let mut values: Vec<Option<f64>> = sums.iter().map(Sum::mean).collect();
    let mut known: Vec<f64> = values.iter().copied().flatten().collect();
    if known.is_empty() {
        return Ok(vec![0.0; positions.len()]);
    }
    let middle = (known.len() - 1) / 2;
    let median = *known.select_nth_unstable_by(middle, f64::total_cmp).1;
    let faces: Vec<_> = faces.iter().map(|face| face.map(|v| node_of[v as usize])).collect();
    fill(&mut values, &faces);
    let mut values: Vec<f64> = values.into_iter().map(|value| value.unwrap_or(median)).collect();
    for _ in 0..SWEEPS {
        let mut sums = vec![Sum::default(); nodes];
        for (at, from) in neighbours(&faces) {
            sums[at].add(values[from], 1.0);
        }
        for (value, sum) in values.iter_mut().zip(&sums) {
            *value = (*value + sum.mean().unwrap_or(*value)) / 2.0;
        }
    }
    Ok(node_of.iter().map(|&node| (values[node as usize] as f32).clamp(*OCTAVES.start(), *OCTAVES.end())).collect())
}

#[derive(Clone, Copy, Default)]
struct Sum {
    value: f64,
    weight: f64,
}

impl Sum {
    fn add(&mut self, value: f64, weight: f64) {
        self.value += value * weight;
        self.weight += weight;
    }

    fn mean(&self) -> Option<f64> {
        (self.weight > 0.0).then(|| self.value / self.weight)
    }
}

/// Merges vertices with equal position and texture coordinates: the node of each vertex, and the number of nodes.
fn nodes(uvs: &[Vec2], representative: &[u32]) -> (Vec<u32>, usize) {
    // Adding zero turns -0 into 0.
    let key = |&vertex: &u32| {
        let uv = uvs[vertex as usize] + 0.0;
        (representative[vertex as usize], uv.x.to_bits(), uv.y.to_bits())
    };
    let mut order: Vec<u32> = (0..uvs.len() as u32).collect();
    order.sort_unstable_by_key(key);
    let mut node_of = vec![0; uvs.len()];
    let mut nodes = 0;
    for same in order.chunk_by(|a, b| key(a) == key(b)) {
        for &vertex in same {
            node_of[vertex as usize] = nodes;
        }
        nodes += 1;
    }
    (node_of, nodes as usize)
}

/// log2 of the length per unit of the texture coordinates, and twice the area.
fn of_face(positions: &[Vec3], uvs: &[Vec2], face: &[u32; 3]) -> Option<(f64, f64)> {
    let [a, b, c]: [DVec3; 3] = face.map(|v| positions[v as usize].as_dvec3());
    let [d, e, f]: [DVec2; 3] = face.map(|v| uvs[v as usize].as_dvec2());
    let area = (b - a).cross(c - a).length();
    let in_texture = (e - d).perp_dot(f - d).abs();
    let octave = (libm::log2(area) - libm::log2(in_texture)) / 2.0;
    octave.is_finite().then_some((octave, area))
}

/// All ordered pairs of corners of each face.
fn neighbours(faces: &[[u32; 3]]) -> impl Iterator<Item = (usize, usize)> {
    let of = |[a, b, c]: [usize; 3]| [(a, b), (b, a), (b, c), (c, b), (c, a), (a, c)];
    faces.iter().flat_map(move |face| of(face.map(|node| node as usize)))
}

/// Sets nodes without a value to the mean of their neighbours, one ring of neighbours after another.
fn fill(values: &mut [Option<f64>], faces: &[[u32; 3]]) {
    // Only faces with a corner without a value are relevant.
    let lacking = |values: &[Option<f64>], face: &[u32; 3]| face.iter().any(|&node| values[node as usize].is_none());
    let mut faces: Vec<_> = faces.iter().copied().filter(|face| lacking(values, face)).collect();
    for _ in 0..RINGS {
        if faces.is_empty() {
            return;
        }
        let mut sums = vec![Sum::default(); values.len()];
        for (at, from) in neighbours(&faces) {
            if let Some(value) = values[from] {
                sums[at].add(value, 1.0);
            }
        }
        for (value, sum) in values.iter_mut().zip(&sums) {
            *value = value.or(sum.mean());
        }
        faces.retain(|face| lacking(values, face));
    }
}

//! Welding of vertices that only rounding separates.

use super::{join_nearest, weld_by_table, weld_exact};
use glam::{DVec3, Vec3};

/// The number of units in the last place (of the largest coordinate) by which rounding separates two positions that
/// are meant to be equal.
///
/// Common points of two quarters of a tube, each turned into its place by quaternions or matrices in f32, were at most
/// 6.1 units apart in 24 000 trials, and in 99 of 100 at most 3.1.
pub const ROUNDING_ULPS: f32 = 8.0;

/// Whatever the coordinates are, no distance over this share of the mesh's extent is attributed to rounding: a quarter of
/// a pixel of a picture of 1000 px. A model of the size 1 at 5 000 000, where positions in f32 are 0.5 apart, remains
/// as it is.
const LARGEST_SHARE: f32 = 1.0 / 4096.0;

/// The distances that rounding of a mesh's coordinates accounts for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rounding {
    /// For the mesh as a whole, from its largest coordinate.
    pub tolerance: f32,
    /// The largest tolerance.
    most: f32,
    /// The faces that may have no area, ascending: all for which [`Rounding::has_no_area`], and few others.
    pub thin: Vec<u32>,
}

impl Rounding {
    /// Considers only vertices that faces use.
    ///
    /// Processes blocks, first all loads and then all arithmetic, which the compiler vectorises.
    pub fn new(positions: &[Vec3], faces: &[[u32; 3]]) -> Self {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        let mut thin = Vec::new();
        let mut corners = [[[0f32; BLOCK]; 3]; 3];
        for (number, block) in faces.chunks(BLOCK).enumerate() {
            for (i, face) in block.iter().enumerate() {
                for (corner, &vertex) in corners.iter_mut().zip(face) {
                    let Vec3 { x, y, z } = positions[vertex as usize];
                    (corner[0][i], corner[1][i], corner[2][i]) = (x, y, z);
                }
            }
            // A last, shorter block is followed by faces of the block before it, or by zeros.
            let (lower, upper, is_high) = bounds_and_heights(&corners);
            let count = block.len();
            for (low, lower) in low.iter_mut().zip(&lower) {
                *low = lower[..count].iter().fold(*low, |a, &b| if b < a { b } else { a });
            }
            for (high, upper) in high.iter_mut().zip(&upper) {
                *high = upper[..count].iter().fold(*high, |a, &b| if b > a { b } else { a });
            }
            if is_high[..count] != [true; BLOCK][..count] {
                let first = (number * BLOCK) as u32;
                thin.extend((first..).zip(&is_high[..count]).filter(|(_, high)| !**high).map(|(face, _)| face));
            }
        }
        let (low, high) = (Vec3::from(low), Vec3::from(high));
        if !(low.is_finite() && high.is_finite()) {
            // Without faces, or with infinite positions.
            return Self { tolerance: 0.0, most: 0.0, thin };
        }
        // Halves, since the difference of the ends may exceed the range.
        let most = (high * 0.5 - low * 0.5).max_element() * (2.0 * LARGEST_SHARE);
        Self { tolerance: (low.abs().max(high.abs()).max_element() * UNIT).min(most), most, thin }
    }

    /// The tolerance for a face from its largest coordinate.
    pub fn of(&self, magnitude: f32) -> f32 {
        (magnitude * UNIT).min(self.most)
    }

    /// Whether a triangle is no higher above its longest side than rounding of its own coordinates accounts for.
    ///
    /// The tolerance of a small face among large ones is that of its own coordinates, since these may be precise.
    pub fn has_no_area(&self, corners: [Vec3; 3]) -> bool {
        let magnitude = corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f32::max);
        let tolerance = f64::from(self.of(magnitude));
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        let (ab, ac) = (b - a, c - a);
        let longest_squared = ab.length_squared().max(ac.length_squared()).max(b.distance_squared(c));
        ab.cross(ac).length() <= tolerance * longest_squared.sqrt()
    }
}

const UNIT: f32 = ROUNDING_ULPS * f32::EPSILON;

/// Faces that are processed together.
const BLOCK: usize = 64;

type Block<T> = [T; BLOCK];

/// Of triangles, given by corner and axis: the lower and the upper ends of their boxes by axis, and whether each surely has
/// an area by [`Rounding::has_no_area`]. In f32 and with twice the tolerance; what overflows or is no number has none.
#[inline]
#[allow(clippy::needless_range_loop, reason = "loops over several arrays at once, which the compiler vectorises")]
fn bounds_and_heights([a, b, c]: &[[Block<f32>; 3]; 3]) -> ([Block<f32>; 3], [Block<f32>; 3], Block<bool>) {
    let least = |x: f32, y: f32| if x < y { x } else { y };
    let most = |x: f32, y: f32| if x > y { x } else { y };
    let (mut lower, mut upper) = ([[0.0; BLOCK]; 3], [[0.0; BLOCK]; 3]);
    for axis in 0..3 {
        for i in 0..BLOCK {
            lower[axis][i] = least(least(a[axis][i], b[axis][i]), c[axis][i]);
            upper[axis][i] = most(most(a[axis][i], b[axis][i]), c[axis][i]);
        }
    }
    let mut is_high = [false; BLOCK];
    for i in 0..BLOCK {
        let from_a = |of: &[Block<f32>; 3]| [of[0][i] - a[0][i], of[1][i] - a[1][i], of[2][i] - a[2][i]];
        let (ab, ac) = (from_a(b), from_a(c));
        let bc = [ac[0] - ab[0], ac[1] - ab[1], ac[2] - ab[2]];
        let squared = |of: [f32; 3]| of[0] * of[0] + of[1] * of[1] + of[2] * of[2];
        let area = [ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2], ab[0] * ac[1] - ab[1] * ac[0]];
        let largest = |axis: usize| most(upper[axis][i], -lower[axis][i]);
        let tolerance = 2.0 * UNIT * most(most(largest(0), largest(1)), largest(2));
        let longest_squared = most(most(squared(ab), squared(ac)), squared(bc));
        is_high[i] = squared(area) > tolerance * tolerance * longest_squared;
    }
    (lower, upper, is_high)
}

/// The distance up to which rounding may separate two positions of a mesh that are meant to be equal:
/// [`ROUNDING_ULPS`] units in the last place of the largest coordinate, and at most 1/4096 of the mesh's extent.
///
/// Only vertices that faces use count. 0 without faces, or if a position is infinite.
pub fn rounding_tolerance(positions: &[Vec3], faces: &[[u32; 3]]) -> f32 {
    Rounding::new(positions, faces).tolerance
}

/// Per vertex a representative that only rounding separates from it, within [`rounding_tolerance`], as by
/// [`weld_within`](super::weld_within).
///
/// Vertices that a face with an area keeps apart remain apart, so that nothing that is drawn with more precision than
/// the rest of the mesh vanishes. An area is one that rounding of the face's own coordinates does not account for.
///
/// On meshes in which few vertices are that near, the time is linear.
pub fn weld_rounding(positions: &[Vec3], faces: &[[u32; 3]]) -> Vec<u32> {
    weld_by(positions, faces, &Rounding::new(positions, faces))
}

pub(crate) fn weld_by(positions: &[Vec3], faces: &[[u32; 3]], rounding: &Rounding) -> Vec<u32> {
    if rounding.tolerance <= 0.0 {
        return weld_exact(positions);
    }
    // Usually few vertices have a neighbour, also at an equal position; if many have, equal ones are joined first.
    let all = 0..positions.len() as u32;
    let most = positions.len() / 8;
    let (exact, suspects) = match with_neighbours(positions, all.clone(), rounding.tolerance, most) {
        Some(suspects) => {
            let mut exact: Vec<u32> = all.collect();
            weld_by_table(positions, suspects.iter().copied(), &mut exact);
            (exact, suspects)
        }
        None => {
            let exact = weld_exact(positions);
            let unique =
                || all.clone().zip(&exact).filter(|&(vertex, &first)| vertex == first).map(|(vertex, _)| vertex);
            let suspects = with_neighbours(positions, unique(), rounding.tolerance, usize::MAX).unwrap_or_default();
            (exact, suspects)
        }
    };
    if suspects.is_empty() {
        return exact;
    }
    let mut welded = exact.clone();
    let unique = suspects.iter().copied().filter(|&vertex| exact[vertex as usize] == vertex);
    if !join_nearest(positions, unique, rounding.tolerance, &mut welded) {
        return exact;
    }
    for (vertex, &first) in exact.iter().enumerate() {
        welded[vertex] = welded[first as usize];
    }
    keep_faces(positions, faces, rounding, &exact, &mut welded);
    welded
}

/// Parts what was joined where a face with an area has two corners among it.
fn keep_faces(positions: &[Vec3], faces: &[[u32; 3]], rounding: &Rounding, exact: &[u32], welded: &mut [u32]) {
    let mut parted: Vec<bool> = Vec::new();
    for face in faces {
        let [a, b, c] = face.map(|vertex| vertex as usize);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let is_joined = welded[from] == welded[to] && exact[from] != exact[to];
            if is_joined && !rounding.has_no_area(face.map(|vertex| positions[vertex as usize])) {
                parted.resize(exact.len(), false);
                parted[welded[from] as usize] = true;
            }
        }
    }
    if !parted.is_empty() {
        for (joined, &exact) in welded.iter_mut().zip(exact) {
            if parted[*joined as usize] {
                *joined = exact;
            }
        }
    }
}

/// The side of a cell in tolerances.
const CELL: f32 = 64.0;

/// Of these vertices those, ascending, that may have another within the tolerance: those that have one in their cell of a
/// grid, or in an adjacent cell whose border is within the tolerance. `None` if these may be more than `most`.
///
/// A bit set over hash values of cells finds candidates, as in [`weld_exact`]; only these are sorted by their cell.
fn with_neighbours(
    positions: &[Vec3],
    vertices: impl Iterator<Item = u32> + Clone,
    tolerance: f32,
    most: usize,
) -> Option<Vec<u32>> {
    let per_side = 1.0 / (CELL * tolerance);
    if !per_side.is_finite() {
        return Some(vertices.collect());
    }
    let bits = (16 * positions.len()).next_power_of_two().max(64);
    let shift = 64 - bits.trailing_zeros();
    let place = |hash: u64| {
        let bit = hash >> shift;
        ((bit / 64) as usize, 1u64 << (bit % 64))
    };
    let mut met = vec![0u64; bits / 64];
    let mut met_twice = Vec::new();
    for vertex in vertices.clone() {
        visit_cells(positions[vertex as usize] * per_side, |hash| {
            let (word, bit) = place(hash);
            if met[word] & bit != 0 {
                met_twice.push((word, bit));
            }
            met[word] |= bit;
        });
        // A quarter of the bits is met twice by chance.
        if met_twice.len() / 3 > most {
            return None;
        }
    }
    if met_twice.is_empty() {
        return Some(Vec::new());
    }
    let mut shared = met;
    shared.fill(0);
    for (word, bit) in met_twice {
        shared[word] |= bit;
    }
    let mut in_shared = Vec::new();
    for vertex in vertices.clone() {
        visit_cells(positions[vertex as usize] * per_side, |hash| {
            let (word, bit) = place(hash);
            if shared[word] & bit != 0 {
                in_shared.push((hash, vertex));
            }
        });
    }
    in_shared.sort_unstable();
    let mut found = Vec::new();
    for cell in in_shared.chunk_by(|a, b| a.0 == b.0).filter(|cell| cell.len() > 1) {
        // In small groups the distances decide.
        if let [(_, a), (_, b)] = cell {
            let [a, b] = [a, b].map(|&vertex| positions[vertex as usize].as_dvec3());
            if !is_within(a, b, tolerance) {
                continue;
            }
        }
        found.extend(cell.iter().map(|&(_, vertex)| vertex));
    }
    found.sort_unstable();
    found.dedup();
    Some(found)
}

/// Visits the hash values of the cell of a point, whose coordinates are in units of cells, and of the adjacent cells whose
/// border is within the tolerance. Cells are centred at whole numbers.
#[inline(always)]
fn visit_cells(at: Vec3, mut visit: impl FnMut(u64)) {
    // The tolerance, and the rounding of coordinates in units of cells: there are at most 2^15 cells along each axis.
    const MARGIN: f32 = 1.0 / CELL + 1.0 / 256.0;
    // After the addition the last bits of an f32 are the nearest whole number, up to 2^22.
    const WHOLE: Vec3 = Vec3::splat(12_582_912.0);
    let cell = |at: Vec3| (at + WHOLE).to_array().map(f32::to_bits);
    let off_centre = at - ((at + WHOLE) - WHOLE);
    if off_centre.abs().max_element() < 0.5 - MARGIN {
        return visit(super::hash(cell(at)));
    }
    let (low, high) = (cell(at - MARGIN), cell(at + MARGIN));
    for corner in 0..8 {
        let takes = |axis: usize| corner >> axis & 1 == 1;
        if (0..3).all(|axis| !takes(axis) || low[axis] != high[axis]) {
            visit(super::hash([0, 1, 2].map(|axis| if takes(axis) { high[axis] } else { low[axis] })));
        }
    }
}

fn is_within(a: DVec3, b: DVec3, tolerance: f32) -> bool {
    let tolerance = f64::from(tolerance);
    a.distance_squared(b) <= tolerance * tolerance
}

#[cfg(test)]
mod tests;

//! Finds vertices at equal positions.
//!
//! Files split vertices at seams of texture coordinates and normals, and exporters may write a point several times.
//! An edge search without welding would find spurious boundaries there.

mod rounding;

pub use rounding::{ROUNDING_ULPS, rounding_tolerance, weld_rounding};
pub(crate) use rounding::{Rounding, weld_by};

use glam::Vec3;

/// Which vertices are one vertex for edges and computed normals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Weld {
    /// Those at exactly equal positions: [`weld_exact`].
    Exact,
    /// Those that only rounding separates: [`weld_rounding`].
    #[default]
    Rounding,
    /// Those within a distance, in units of the positions: [`weld_within`]. What is thinner collapses.
    Within(f32),
}

impl Weld {
    /// Per vertex a representative, the lowest-numbered of those that are one vertex.
    ///
    /// # Panics
    /// If a face refers to a vertex that does not exist.
    pub fn representatives(self, positions: &[Vec3], faces: &[[u32; 3]]) -> Vec<u32> {
        match self {
            Self::Exact => weld_exact(positions),
            Self::Rounding => weld_rounding(positions, faces),
            Self::Within(tolerance) => weld_within(positions, tolerance),
        }
    }
}

/// Per vertex the lowest-numbered vertex at exactly the same position.
///
/// Positions are compared by value, so −0.0 equals 0.0. A NaN equals only a NaN with the same bits.
///
/// Most vertices usually have unique positions. A bit set over hash values finds candidates for duplicates without
/// comparing positions; only vertices that share a bit enter a hash table. On half a million vertices with a thousand
/// duplicates this takes half the time of entering all vertices. Memory: at most 8 bytes per vertex in addition to
/// the result, or 24 bytes with many duplicates. The expected time is linear.
pub fn weld_exact(positions: &[Vec3]) -> Vec<u32> {
    let mut representative: Vec<u32> = (0..positions.len() as u32).collect();
    // At least eight bits per vertex.
    let bits = (8 * positions.len()).next_power_of_two().max(64);
    let shift = 64 - bits.trailing_zeros();
    let bit_of = |position: &Vec3| {
        let bit = hash(value_bits(*position)) >> shift;
        ((bit / 64) as usize, 1u64 << (bit % 64))
    };
    let mut met = vec![0u64; bits / 64];
    let mut met_twice = Vec::new();
    for position in positions {
        let (word, bit) = bit_of(position);
        if met[word] & bit != 0 {
            met_twice.push((word, bit));
            if met_twice.len() > positions.len() / 8 {
                weld_by_table(positions, 0..positions.len() as u32, &mut representative);
                return representative;
            }
        }
        met[word] |= bit;
    }
    if met_twice.is_empty() {
        return representative;
    }
    let mut shared = met;
    shared.fill(0);
    for (word, bit) in met_twice {
        shared[word] |= bit;
    }
    let sharing = (0u32..).zip(positions).filter_map(|(vertex, position)| {
        let (word, bit) = bit_of(position);
        (shared[word] & bit != 0).then_some(vertex)
    });
    let sharing: Vec<u32> = sharing.collect();
    weld_by_table(positions, sharing.iter().copied(), &mut representative);
    representative
}

/// Finds the representatives of these vertices, given in ascending order, among themselves.
///
/// A hash table with open addressing.
fn weld_by_table(positions: &[Vec3], vertices: impl ExactSizeIterator<Item = u32>, representative: &mut [u32]) {
    const EMPTY: u32 = u32::MAX;
    // The table is at most two thirds full.
    let slots = (vertices.len() + vertices.len() / 2).next_power_of_two().max(2);
    let shift = 64 - slots.trailing_zeros();
    let mask = slots - 1;
    let mut table = vec![EMPTY; slots];
    for vertex in vertices {
        let key = value_bits(positions[vertex as usize]);
        let mut slot = (hash(key) >> shift) as usize;
        representative[vertex as usize] = loop {
            let occupant = table[slot];
            if occupant == EMPTY {
                table[slot] = vertex;
                break vertex;
            }
            if value_bits(positions[occupant as usize]) == key {
                break occupant;
            }
            slot = (slot + 1) & mask;
        };
    }
}

/// Per vertex a representative within `tolerance`.
///
/// Vertices are processed in order. A vertex joins the nearest representative within `tolerance`, the lowest-numbered
/// of equally near ones, or else becomes a representative. Two vertices with one representative can be up to twice
/// the tolerance apart. The result depends on nothing but the positions and their order. A tolerance that is 0,
/// negative or NaN is [`weld_exact`].
///
/// The time is linear as long as only a few representatives share a cube with a side of `tolerance`.
pub fn weld_within(positions: &[Vec3], tolerance: f32) -> Vec<u32> {
    if tolerance.is_nan() || tolerance <= 0.0 {
        return weld_exact(positions);
    }
    let exact = weld_exact(positions);
    let mut representative = exact.clone();
    let unique = (0u32..).zip(&exact).filter(|&(vertex, &first)| vertex == first).map(|(vertex, _)| vertex);
    join_nearest(positions, unique, tolerance, &mut representative);
    for (vertex, &first) in exact.iter().enumerate() {
        representative[vertex] = representative[first as usize];
    }
    representative
}

/// Assigns these vertices, given in ascending order and at distinct positions, their representatives among themselves.
/// Returns whether any were joined.
fn join_nearest(
    positions: &[Vec3],
    vertices: impl Iterator<Item = u32>,
    tolerance: f32,
    representative: &mut [u32],
) -> bool {
    let tolerance = f64::from(tolerance);
    let mut any = false;
    let mut cells: std::collections::HashMap<[i64; 3], Vec<u32>> = std::collections::HashMap::new();
    for vertex in vertices {
        let position = positions[vertex as usize].as_dvec3();
        let cell = (position / tolerance).floor().to_array().map(|c| c as i64);
        let mut nearest = (tolerance * tolerance, vertex);
        for step in 0..27i64 {
            let neighbour = [
                cell[0].saturating_add(step % 3 - 1),
                cell[1].saturating_add(step / 3 % 3 - 1),
                cell[2].saturating_add(step / 9 - 1),
            ];
            for &other in cells.get(&neighbour).map_or(&[][..], Vec::as_slice) {
                let distance_squared = positions[other as usize].as_dvec3().distance_squared(position);
                if distance_squared < nearest.0 || (distance_squared == nearest.0 && other < nearest.1) {
                    nearest = (distance_squared, other);
                }
            }
        }
        if nearest.1 == vertex {
            cells.entry(cell).or_default().push(vertex);
        }
        any |= nearest.1 != vertex;
        representative[vertex as usize] = nearest.1;
    }
    any
}

/// The bits of a position with −0.0 replaced by 0.0.
fn value_bits(position: Vec3) -> [u32; 3] {
    (position + Vec3::ZERO).to_array().map(f32::to_bits)
}

/// A multiplicative hash; its upper bits are well distributed.
fn hash([x, y, z]: [u32; 3]) -> u64 {
    const ODD: u64 = 0x9e37_79b9_7f4a_7c15;
    let first = (u64::from(x) | u64::from(y) << 32).wrapping_mul(ODD);
    (first ^ (first >> 32) ^ u64::from(z)).wrapping_mul(ODD)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_zeros_are_one_place() {
        assert_eq!(weld_exact(&[Vec3::ZERO, Vec3::new(-0.0, 0.0, -0.0), Vec3::X]), [0, 0, 2]);
    }

    #[test]
    fn nothing_is_welded_by_chance() {
        let positions: Vec<Vec3> =
            (0..40_000u32).map(|i| Vec3::new((i % 200) as f32, (i / 200) as f32, (i % 7) as f32)).collect();
        assert!(weld_exact(&positions).iter().enumerate().all(|(i, &r)| i as u32 == r));
    }

    #[test]
    fn a_tolerance_joins_across_cell_borders_and_no_further() {
        let positions = [0.0, 0.99, 1.01, 2.5].map(|x| Vec3::new(x, 0.0, 0.0));
        assert_eq!(weld_within(&positions, 1.0), [0, 0, 2, 3]);
        assert_eq!(weld_within(&positions, 0.05), [0, 1, 1, 3]);
        assert_eq!(weld_within(&positions, 0.0), [0, 1, 2, 3]);
    }

    #[test]
    fn a_tolerance_joins_across_every_border_of_a_cell_from_both_sides() {
        // One vertex on each side of a corner that eight cells share, in the middle of the grid and at 0.
        for corner in [Vec3::ZERO, Vec3::ONE, Vec3::new(-3.0, 2.0, 5.0)] {
            for step in 0..27 {
                let side = Vec3::new((step % 3) as f32, (step / 3 % 3) as f32, (step / 9) as f32) - 1.0;
                let (here, there) = (corner - side * 0.125, corner + side * 0.125);
                assert_eq!(weld_within(&[here, there], 1.0), [0, 0], "{here} {there}");
            }
        }
    }

    #[test]
    fn a_distance_equal_to_the_tolerance_is_within_it() {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z] {
            assert_eq!(weld_within(&[Vec3::ZERO, axis], 1.0), [0, 0], "{axis}");
            assert_eq!(weld_within(&[Vec3::ZERO, axis * 1.0f32.next_up()], 1.0), [0, 1], "{axis}");
        }
        // A right triangle with the sides 3, 4 and 5.
        assert_eq!(weld_within(&[Vec3::ZERO, Vec3::new(0.0, -3.0, 4.0)], 5.0), [0, 0]);
        assert_eq!(weld_within(&[Vec3::ZERO, Vec3::new(0.0, -3.0, 4.0)], 5.0f32.next_down()), [0, 1]);
    }

    #[test]
    fn the_nearest_representative_wins_and_of_two_equally_near_ones_the_lower() {
        let weld_along = |axis: Vec3, at: [f32; 3]| weld_within(&at.map(|x| axis * x), 1.0);
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            // Half-way between two representatives in two cells, in either order.
            assert_eq!(weld_along(axis, [0.0, 1.5, 0.75]), [0, 1, 0], "{axis}");
            assert_eq!(weld_along(axis, [1.5, 0.0, 0.75]), [0, 1, 0], "{axis}");
            assert_eq!(weld_along(axis, [0.0, 1.5, 1.0]), [0, 1, 1], "{axis}");
            assert_eq!(weld_along(axis, [1.5, 0.0, 0.5]), [0, 1, 1], "{axis}");
        }
    }

    #[test]
    fn no_vertices_weld_to_none() {
        assert!(weld_exact(&[]).is_empty());
    }
}

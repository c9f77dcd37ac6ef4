//! Vertices at one place, found.
//!
//! Files split vertices at seams of texture coordinates and normals, and exporters write one point several
//! times; an edge search that takes such vertices for different ones finds boundaries where there are none.

use glam::Vec3;

/// For each vertex the lowest-numbered vertex at exactly the same position.
///
/// Positions are compared by value, so −0.0 and 0.0 are one place. A NaN equals itself bit for bit only.
///
/// Open addressing in a table of at most twice the next power of two above `positions.len()` words; expected time is
/// linear.
pub fn weld_exact(positions: &[Vec3]) -> Vec<u32> {
    const EMPTY: u32 = u32::MAX;
    // The table is at most two thirds full.
    let slots = (positions.len() + positions.len() / 2).next_power_of_two().max(2);
    let shift = 64 - slots.trailing_zeros();
    let mask = slots - 1;
    let mut table = vec![EMPTY; slots];
    let mut representative = Vec::with_capacity(positions.len());
    for (vertex, &position) in positions.iter().enumerate() {
        let key = value_bits(position);
        let mut slot = (hash(key) >> shift) as usize;
        let found = loop {
            let occupant = table[slot];
            if occupant == EMPTY {
                table[slot] = vertex as u32;
                break vertex as u32;
            }
            if value_bits(positions[occupant as usize]) == key {
                break occupant;
            }
            slot = (slot + 1) & mask;
        };
        representative.push(found);
    }
    representative
}

/// For each vertex a representative within `tolerance`, the lowest-numbered one that was met.
///
/// A vertex joins the nearest representative within `tolerance` of itself, or becomes one; two vertices joined
/// to one representative can be up to twice the tolerance apart. The result depends on the order of the vertices
/// and on nothing else. A tolerance of 0 (or one that is not a positive number) is [`weld_exact`].
///
/// Time is linear while no more than a handful of representatives share a cube with sides of `tolerance`.
pub fn weld_within(positions: &[Vec3], tolerance: f32) -> Vec<u32> {
    if tolerance.is_nan() || tolerance <= 0.0 {
        return weld_exact(positions);
    }
    let tolerance = f64::from(tolerance);
    let exact = weld_exact(positions);
    let mut cells: std::collections::HashMap<[i64; 3], Vec<u32>> = std::collections::HashMap::new();
    let mut representative: Vec<u32> = Vec::with_capacity(positions.len());
    for (vertex, &twin) in exact.iter().enumerate() {
        if twin as usize != vertex {
            representative.push(representative[twin as usize]);
            continue;
        }
        let position = positions[vertex].as_dvec3();
        let cell = (position / tolerance).floor().to_array().map(|c| c as i64);
        let mut nearest = (tolerance * tolerance, vertex as u32);
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
        if nearest.1 as usize == vertex {
            cells.entry(cell).or_default().push(vertex as u32);
        }
        representative.push(nearest.1);
    }
    representative
}

/// The position's bits with −0.0 turned into 0.0.
fn value_bits(position: Vec3) -> [u32; 3] {
    (position + Vec3::ZERO).to_array().map(f32::to_bits)
}

/// A multiplicative hash whose upper bits are good.
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
    fn no_vertices_weld_to_none() {
        assert!(weld_exact(&[]).is_empty());
    }
}

//! Hashes of faces by the positions of their corners.

use glam::Vec3;

/// The hash of a face's corners, invariant under cyclic permutation, with all bits used.
pub fn hash(corners: &[Vec3; 3]) -> u64 {
    const ODD: u64 = 0x9e37_79b9_7f4a_7c15;
    let of_corner = |corner: &Vec3| {
        let [x, y, z] = corner.to_array().map(|at| u64::from(at.to_bits()));
        let first = (x | y << 32).wrapping_mul(ODD);
        (first ^ (first >> 32) ^ z).wrapping_mul(ODD)
    };
    corners.iter().map(of_corner).fold(0, u64::wrapping_add)
}

/// 32 bits of the hash: its upper half in round 0, in other rounds a remix that is independent of it.
pub fn mixed(hash: u64, round: u32) -> u32 {
    match round {
        0 => (hash >> 32) as u32,
        // The mixing of SplitMix64 (Steele, Lea & Flood 2014).
        _ => {
            let z = (hash ^ (hash >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            ((z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb) >> 32) as u32
        }
    }
}

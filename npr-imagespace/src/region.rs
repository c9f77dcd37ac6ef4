//! Region numbers: what the region filter draws borders between. 0 is background, so numbers start at 1.
//!
//! Regions can be materials, meshes, smoothly connected patches, colours of a texture, and combinations of these.
//! Numbers are of 32 bits here; [`crate::format::texel`] folds them to the bits of a packed texel.

use crate::ImageSpaceError;
use std::collections::HashMap;

/// The region number of a material or mesh index: the index plus 1.
pub fn region_of_index(index: u32) -> u32 {
    index.wrapping_add(1).max(1)
}

/// The regions of faces that are connected by smooth edges, numbered in the order of their first faces.
///
/// - `faces`: the number of faces;
/// - `smooth_pairs`: pairs of faces that share an edge over which the surface is smooth. The caller decides that, by
///   the dihedral angle, by equal normals on both sides, or by material.
///
/// The borders of these patches are exactly the creases, which interpolated smooth normals do not show.
///
/// # Errors
/// [`ImageSpaceError::Face`].
pub fn region_of_patches(faces: usize, smooth_pairs: &[[u32; 2]]) -> Result<Vec<u32>, ImageSpaceError> {
    let mut parent: Vec<u32> = (0..faces as u32).collect();
    fn root(parent: &mut [u32], mut face: u32) -> u32 {
        while parent[face as usize] != face {
            // Path halving keeps the chains short.
            parent[face as usize] = parent[parent[face as usize] as usize];
            face = parent[face as usize];
        }
        face
    }
    for &[a, b] in smooth_pairs {
        if let Some(&face) = [a, b].iter().find(|&&face| face as usize >= faces) {
            return Err(ImageSpaceError::Face { face, faces });
        }
        let (a, b) = (root(&mut parent, a), root(&mut parent, b));
        // The lower face stays the root, which makes the numbers independent of the pairs' order.
        parent[a.max(b) as usize] = a.min(b);
    }
    let mut regions = vec![0; faces];
    let mut count = 0;
    for face in 0..faces {
        let first = root(&mut parent, face as u32) as usize;
        if first == face {
            count += 1;
            regions[face] = count;
        } else {
            regions[face] = regions[first];
        }
    }
    Ok(regions)
}

/// A number for pairs of numbers, such as mesh and patch: equal pairs have equal ones, counted from 1 by first
/// appearance. A pair with a 0 in it is background and stays 0.
pub fn region_of_pairs(pairs: impl IntoIterator<Item = [u32; 2]>) -> Vec<u32> {
    let mut known = HashMap::new();
    pairs
        .into_iter()
        .map(|pair| {
            let next = known.len() as u32 + 1;
            if pair.contains(&0) { 0 } else { *known.entry(pair).or_insert(next) }
        })
        .collect()
}

/// The region number of a texture's colour: the colour as a 24-bit number, plus 1; alpha is ignored. The texture must
/// be sampled without filtering, since a mixture of two regions' colours is a third region.
pub fn ink_region_of_color(rgb: [u8; 3]) -> u32 {
    u32::from_le_bytes([rgb[0], rgb[1], rgb[2], 0]) + 1
}

/// A hash of two region numbers, 1..2^24; 0 where either is 0. For pairs that are not known beforehand, such as a patch
/// and a texture's colour. Two different pairs have the same number with a probability of about 2^−24.
pub fn ink_region_pair(a: u32, b: u32) -> u32 {
    if a == 0 || b == 0 {
        return 0;
    }
    // Fibonacci hashing: the upper bits of a product with 2^32 over the golden ratio.
    let mixed = (a.wrapping_mul(0x9e37_79b1) ^ b).wrapping_mul(0x85eb_ca6b);
    1 + (mixed >> 8) % 0x00ff_ffff
}

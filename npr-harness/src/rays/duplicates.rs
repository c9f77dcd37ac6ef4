//! Duplicate faces: faces with the same corners and winding are represented by one triangle, because a ray that hits
//! one would have to be tested against all.
//!
//! Most faces have no duplicate, which a bit per hash value shows: only faces that share a bit, and those of them that
//! share another bit by a second hash, are entered into a table.

use super::boxes::Boxes;
use super::hash::{hash, mixed};
use super::triangle::Duplicate;
use glam::Vec3;
use std::collections::HashMap;

/// The number of bits per face.
const BITS: usize = 16;

/// Merges the boxes of faces whose corners are a cyclic permutation of each other; the first box remains. Returns the
/// groups, each in ascending order of faces. Clears the hashes.
pub fn join(positions: &[Vec3], faces: &[[u32; 3]], boxes: &mut Boxes) -> Vec<Vec<Duplicate>> {
    let mut places = sharing(&std::mem::take(&mut boxes.hashes));
    if places.is_empty() {
        return Vec::new();
    }
    let corners = |place: u32| faces[boxes.faces[place as usize] as usize].map(|vertex| positions[vertex as usize]);
    let second: Vec<u32> = places.iter().map(|&place| mixed(hash(&corners(place)), 1)).collect();
    places = sharing(&second).into_iter().map(|at| places[at as usize]).collect();
    // Per set of corners: the position of the first face, and its group, if any.
    let mut known: HashMap<[[u32; 3]; 3], (u32, Option<usize>)> = HashMap::new();
    let mut groups: Vec<Vec<Duplicate>> = Vec::new();
    let mut joined = Vec::new();
    for place in places {
        let own = corners(place);
        let mut key = own.map(|corner| corner.to_array().map(f32::to_bits));
        let lowest = (0..3).min_by_key(|&corner| key[corner]).unwrap_or(0);
        key.rotate_left(lowest);
        let (first, group) = known.entry(key).or_insert((place, None));
        if *first == place {
            continue;
        }
        let group = *group.get_or_insert_with(|| {
            groups.push(vec![Duplicate { face: boxes.faces[*first as usize], first: 0 }]);
            groups.len() - 1
        });
        let of_first = corners(*first);
        let turned = (0..3).find(|&corner| of_first[corner].to_array() == own[0].to_array()).unwrap_or(0);
        groups[group].push(Duplicate { face: boxes.faces[place as usize], first: turned });
        joined.push(place);
    }
    let mut joined = joined.into_iter().peekable();
    let mut kept = 0;
    for place in 0..boxes.boxes.len() {
        if joined.next_if_eq(&(place as u32)).is_none() {
            boxes.boxes[kept] = boxes.boxes[place];
            boxes.faces[kept] = boxes.faces[place];
            kept += 1;
        }
    }
    boxes.boxes.truncate(kept);
    boxes.faces.truncate(kept);
    groups
}

/// The positions, ascending, of all hashes that may occur more than once.
fn sharing(hashes: &[u32]) -> Vec<u32> {
    let bits = (BITS * hashes.len()).next_power_of_two().clamp(64, 1 << 32);
    let shift = 32 - bits.trailing_zeros();
    let bit_of = |hash: u32| {
        let bit = u64::from(hash) >> shift;
        ((bit / 64) as usize, 1u64 << (bit % 64))
    };
    let mut met = vec![0u64; bits / 64];
    let mut met_twice = Vec::new();
    for &hash in hashes {
        let (word, bit) = bit_of(hash);
        if met[word] & bit != 0 {
            met_twice.push(hash);
        }
        met[word] |= bit;
    }
    if met_twice.is_empty() {
        return Vec::new();
    }
    met.fill(0);
    for hash in met_twice {
        let (word, bit) = bit_of(hash);
        met[word] |= bit;
    }
    let is_shared = |hash: u32| {
        let (word, bit) = bit_of(hash);
        met[word] & bit != 0
    };
    (0u32..).zip(hashes).filter(|(_, hash)| is_shared(**hash)).map(|(place, _)| place).collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::{Random, icosphere};
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn of_faces_with_the_same_corners_the_first_stays() {
        let (mut positions, mut faces) = icosphere(4);
        let (own, shift) = (faces.len(), positions.len() as u32);
        positions.extend(positions.clone());
        let mut random = Random(21);
        for _ in 0..2_000 {
            // Half of the faces use other vertices at the same positions; a third have the opposite winding.
            let [a, b, c] = faces[random.bits() as usize % own].map(|v| v + shift * (random.bits() % 2) as u32);
            let mut face = if random.bits().is_multiple_of(3) { [a, c, b] } else { [a, b, c] };
            face.rotate_left(random.bits() as usize % 3);
            faces.push(face);
        }
        let corners = |face: u32| faces[face as usize].map(|v| positions[v as usize].to_array().map(f32::to_bits));
        let mut expected: BTreeMap<[[u32; 3]; 3], Vec<u32>> = BTreeMap::new();
        for face in 0..faces.len() as u32 {
            let [a, b, c] = corners(face);
            expected.entry([[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap()).or_default().push(face);
        }
        let mut stay: Vec<u32> = expected.values().map(|same| same[0]).collect();
        stay.sort_unstable();
        let mut groups: Vec<Vec<u32>> = expected.into_values().filter(|same| same.len() > 1).collect();
        groups.sort_unstable();

        let mut boxes = Boxes::new(&positions, &faces);
        let mut found = join(&positions, &faces, &mut boxes);
        assert!(boxes.faces == stay && boxes.boxes.len() == stay.len());
        found.sort_unstable_by_key(|group| group[0].face);
        let numbers: Vec<Vec<u32>> = found.iter().map(|group| group.iter().map(|one| one.face).collect()).collect();
        assert_eq!(numbers, groups);
        for group in found {
            for one in &group {
                assert_eq!(corners(one.face)[0], corners(group[0].face)[one.first]);
            }
        }
    }
}

//! Finds the faces whose plane may be that of another face.
//!
//! Every face enters cells of the space of planes (unit normal and distance, either winding). Only faces that share a
//! cell can lie in one plane. A bit per hash value of a cell shows which do, in linear time; some faces that share none
//! are reported too.
//!
//! The plane of a triangle is the less certain the smaller it is. Most are certain enough for small cells, which
//! neighbours on a curved surface do not share. The others, if there are any, are compared with all by large cells.

use glam::DVec3;

/// Small and large cells per unit of a normal's components, and of distance relative to the model's size.
const CELLS: [f64; 2] = [256.0, 32.0];

/// The share of a cell by which a plane may be wrong.
const MARGIN: f64 = 0.125;

/// The least component that decides about the sign of a normal; one of them is above 0.57.
const DECIDING: f64 = 0.1;

/// The plane of a face.
#[derive(Clone, Copy)]
pub(super) struct Plane {
    /// Unit length.
    pub normal: DVec3,
    /// The distance from the model's centre, relative to its size.
    pub distance: f64,
    /// The largest error of the normal, radians, which is also that of the distance.
    pub error: f64,
}

/// The faces, ascending, whose plane may be that of another. A face without a plane is none of them, nor is one whose
/// plane is less certain than large cells allow.
pub(super) fn shared(planes: &[Option<Plane>]) -> Vec<u32> {
    let is_within =
        |face: &u32, cells: f64| planes[*face as usize].is_some_and(|plane| 2.0 * plane.error <= MARGIN / cells);
    let all: Vec<u32> = (0..planes.len() as u32).filter(|face| is_within(face, CELLS[1])).collect();
    let (certain, uncertain): (Vec<u32>, Vec<u32>) = all.iter().partition(|face| is_within(face, CELLS[0]));
    // The second pass, with another hash, drops most of those that shared a bit by chance.
    let [first, second] = [0x9e37_79b9_7f4a_7c15, 0xd1b5_4a32_d192_ed03];
    let mut found = meeting(planes, &certain, &certain, CELLS[0], first);
    found = meeting(planes, &found, &found, CELLS[0], second);
    if !uncertain.is_empty() {
        for (faces, others) in [(&uncertain, &all), (&certain, &uncertain)] {
            let met = meeting(planes, faces, others, CELLS[1], first);
            found.extend(meeting(planes, &met, others, CELLS[1], second));
        }
        found.sort_unstable();
        found.dedup();
    }
    found
}

/// The `faces` that share a bit with a face of `others` that is not themselves. Either all of them are among the others,
/// or none is.
fn meeting(planes: &[Option<Plane>], faces: &[u32], others: &[u32], cells: f64, seed: u64) -> Vec<u32> {
    // 32 bits per face, of which it sets 2.4 on average.
    let bits = (32 * others.len()).next_power_of_two().max(64);
    let shift = 64 - bits.trailing_zeros();
    let each = |face: u32, visit: &mut dyn FnMut(usize, u64)| {
        cells_of(planes[face as usize].as_ref(), cells, |cell| {
            let at = hash(cell, seed) >> shift;
            visit((at / 64) as usize, 1u64 << (at % 64));
        });
    };
    let (mut met, mut met_twice) = (vec![0u64; bits / 64], vec![0u64; bits / 64]);
    for &face in others {
        each(face, &mut |word, bit| {
            met_twice[word] |= met[word] & bit;
            met[word] |= bit;
        });
    }
    let are_among = faces.first().is_some_and(|face| others.binary_search(face).is_ok());
    let table = if are_among { &met_twice } else { &met };
    let is_met = |&face: &u32| {
        let mut found = false;
        each(face, &mut |word, bit| found |= table[word] & bit != 0);
        found
    };
    faces.iter().copied().filter(is_met).collect()
}

/// The cells that a plane touches, with the margin, in either winding where rounding may decide about the sign.
fn cells_of(plane: Option<&Plane>, cells: f64, mut visit: impl FnMut([i32; 4])) {
    let Some(&Plane { normal, distance, .. }) = plane else { return };
    let slack = 2.0 * MARGIN / cells;
    let decides = |at_least: f64| normal.to_array().into_iter().find(|x| x.abs() > at_least).unwrap_or(1.0);
    let (sign, other) = (decides(DECIDING - slack).signum(), decides(DECIDING + slack).signum());
    let mut enter = |sign: f64| {
        let q = [normal.x, normal.y, normal.z, distance].map(|x| sign * x * cells);
        let low = q.map(|x| (x - MARGIN).floor() as i32);
        let high = q.map(|x| (x + MARGIN).floor() as i32);
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    for d in low[3]..=high[3] {
                        visit([x, y, z, d]);
                    }
                }
            }
        }
    };
    enter(sign);
    if other != sign {
        enter(other);
    }
}

fn hash([x, y, z, d]: [i32; 4], seed: u64) -> u64 {
    let pack = |low: i32, high: i32| u64::from(low as u32) | u64::from(high as u32) << 32;
    let first = pack(x, y).wrapping_mul(seed);
    let second = (first ^ (first >> 29) ^ pack(z, d)).wrapping_mul(seed);
    (second ^ (second >> 32)).wrapping_mul(seed)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plane, and one that is turned and moved by the sum of their errors.
    fn pair(i: u32, errors: [f64; 2]) -> [Plane; 2] {
        let (a, b) = (f64::from(i) * 0.37, f64::from(i) * 0.011);
        let normal = DVec3::new(a.cos() * b.sin(), a.sin() * b.sin(), b.cos());
        let step = errors[0] + errors[1];
        let moved = (normal + step * normal.any_orthonormal_vector()).normalize();
        let distance = (a * 7.0).sin();
        [
            Plane { normal, distance, error: errors[0] },
            Plane { normal: moved, distance: distance + step, error: errors[1] },
        ]
    }

    #[test]
    fn planes_within_their_errors_of_each_other_are_found_in_either_winding() {
        let most = CELLS.map(|cells| 0.5 * MARGIN / cells);
        for i in 0..2000 {
            for errors in [[most[0], most[0]], [most[0], most[1]], [most[1], most[1]], [0.0, most[1]]] {
                let [one, other] = pair(i, errors);
                for sign in [1.0, -1.0] {
                    let other = Plane { normal: other.normal * sign, distance: other.distance * sign, ..other };
                    assert_eq!(shared(&[Some(one), None, Some(other)]), [0, 2], "{i} {errors:?} {sign}");
                }
            }
        }
    }

    #[test]
    fn few_of_many_different_planes_are_reported() {
        let plane = |i: u32| {
            let (a, b) = (f64::from(i) * 2.399_963, f64::from(i).mul_add(2.0 / 20_000.0, -1.0));
            let r = (1.0 - b * b).max(0.0).sqrt();
            let normal = DVec3::new(a.cos() * r, a.sin() * r, b);
            Some(Plane { normal, distance: f64::from(i % 997) / 997.0, error: 1e-5 })
        };
        let planes: Vec<Option<Plane>> = (0..20_000).map(plane).collect();
        assert!(shared(&planes).len() < 1000, "{}", shared(&planes).len());
    }
}

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
    let small = Cells::new(planes, &certain, CELLS[0]);
    // The second pass, with another hash, drops most of those that shared a bit by chance.
    let every: Vec<u32> = (0..certain.len() as u32).collect();
    let met = small.met_twice(&every, SEEDS[0]);
    let met = small.met_twice(&met, SEEDS[1]);
    let mut found: Vec<u32> = met.iter().map(|&at| certain[at as usize]).collect();
    if !uncertain.is_empty() {
        let of_all = Cells::new(planes, &all, CELLS[1]);
        let is_uncertain: Vec<bool> = all.iter().map(|face| !is_within(face, CELLS[0])).collect();
        found.extend(of_all.meeting(&is_uncertain).map(|at| all[at]));
        found.sort_unstable();
        found.dedup();
    }
    found
}

/// Multipliers of hashes.
const SEEDS: [u64; 2] = [0x9e37_79b9_7f4a_7c15, 0xd1b5_4a32_d192_ed03];

/// The cells of some faces: 24 bytes per face on average.
struct Cells {
    /// Per face the end of its cells.
    ends: Vec<u32>,
    cells: Vec<u64>,
}

impl Cells {
    fn new(planes: &[Option<Plane>], faces: &[u32], cells: f64) -> Self {
        let mut made = Self { ends: Vec::with_capacity(faces.len()), cells: Vec::with_capacity(3 * faces.len()) };
        for &face in faces {
            if let Some(plane) = &planes[face as usize] {
                cells_of(plane, cells, |cell| made.cells.push(cell));
            }
            made.ends.push(made.cells.len() as u32);
        }
        made
    }

    fn of(&self, at: usize) -> &[u64] {
        let start = at.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.cells[start as usize..self.ends[at] as usize]
    }

    /// Those of the given faces, by their positions, that share a bit with another of them.
    fn met_twice(&self, given: &[u32], seed: u64) -> Vec<u32> {
        let mut bits = Bits::new(given.len(), seed);
        for &at in given {
            self.of(at as usize).iter().for_each(|&cell| bits.enter(cell));
        }
        given.iter().copied().filter(|&at| self.of(at as usize).iter().any(|&cell| bits.has_twice(cell))).collect()
    }

    /// The positions of the faces that share a bit with an uncertain face other than themselves.
    fn meeting<'a>(&'a self, is_uncertain: &'a [bool]) -> impl Iterator<Item = usize> + 'a {
        let count = self.ends.len();
        let [mut of_all, mut of_uncertain] = [Bits::new(count, SEEDS[0]), Bits::new(count, SEEDS[0])];
        for (at, &is_uncertain) in is_uncertain.iter().enumerate() {
            self.of(at).iter().for_each(|&cell| of_all.enter(cell));
            if is_uncertain {
                self.of(at).iter().for_each(|&cell| of_uncertain.enter(cell));
            }
        }
        (0..count).filter(move |&at| match is_uncertain[at] {
            true => self.of(at).iter().any(|&cell| of_all.has_twice(cell)),
            false => self.of(at).iter().any(|&cell| of_uncertain.has(cell)),
        })
    }
}

/// 32 bits per face, of which a face sets 2.4 on average, for what was entered once and for what was entered again.
struct Bits {
    once: Vec<u64>,
    twice: Vec<u64>,
    shift: u32,
    seed: u64,
}

impl Bits {
    fn new(faces: usize, seed: u64) -> Self {
        let bits = (32 * faces).next_power_of_two().max(64);
        let zeros = vec![0; bits / 64];
        Self { once: zeros.clone(), twice: zeros, shift: 64 - bits.trailing_zeros(), seed }
    }

    fn place(&self, cell: u64) -> (usize, u64) {
        let at = (cell ^ cell >> 32).wrapping_mul(self.seed) >> self.shift;
        ((at / 64) as usize, 1 << (at % 64))
    }

    fn enter(&mut self, cell: u64) {
        let (word, bit) = self.place(cell);
        self.twice[word] |= self.once[word] & bit;
        self.once[word] |= bit;
    }

    fn has(&self, cell: u64) -> bool {
        let (word, bit) = self.place(cell);
        self.once[word] & bit != 0
    }

    fn has_twice(&self, cell: u64) -> bool {
        let (word, bit) = self.place(cell);
        self.twice[word] & bit != 0
    }
}

/// Calls `visit` with a hash of each cell that a plane touches, with the margin: in either winding where rounding may
/// decide about the sign.
#[inline]
fn cells_of(plane: &Plane, cells: f64, mut visit: impl FnMut(u64)) {
    let Plane { normal, distance, .. } = *plane;
    let slack = 2.0 * MARGIN / cells;
    let decides = |at_least: f64| normal.to_array().into_iter().find(|x| x.abs() > at_least).unwrap_or(1.0);
    let (sign, other) = (decides(DECIDING - slack).signum(), decides(DECIDING + slack).signum());
    let mut enter = |sign: f64| {
        // In eighths of a cell, which are the margin, and from below the least so that truncation rounds down.
        let eighths =
            [normal.x, normal.y, normal.z, distance].map(|x| ((sign * x + 4.0) * (cells * EIGHTHS)) as i32 as u32);
        let mut sum = 0u64;
        let mut steps = [0u64; 4];
        let mut count = 0;
        for (eighth, factor) in eighths.into_iter().zip(FACTORS) {
            sum = sum.wrapping_add(u64::from(eighth / EIGHTHS as u32).wrapping_mul(factor));
            let step = match eighth % EIGHTHS as u32 {
                0 => factor.wrapping_neg(),
                7 => factor,
                _ => continue,
            };
            steps[count] = step;
            count += 1;
        }
        for set in 0..1u32 << count {
            let steps = steps.iter().enumerate().filter(|(i, _)| set >> i & 1 != 0);
            visit(steps.fold(sum, |sum, (_, step)| sum.wrapping_add(*step)));
        }
    };
    enter(sign);
    if other != sign {
        enter(other);
    }
}

/// The reciprocal of [`MARGIN`].
const EIGHTHS: f64 = 1.0 / MARGIN;

/// Odd multipliers, of which sums make a hash linear in the cell's coordinates.
const FACTORS: [u64; 4] = [0x9e37_79b9_7f4a_7c15, 0xd1b5_4a32_d192_ed03, 0xaef1_7502_108e_f2d9, 0xf135_7aea_2e62_a9c5];

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

//! The bounding boxes of the faces that a ray can hit.

use super::hash::{hash, mixed};
use super::threads;
use super::triangle::PADDING;
use glam::{DVec3, Vec3, Vec3A};
use npr_mesh::edges::has_zero_area;
use obvhs::aabb::Aabb;

/// Boxes in the hierarchy's units, (position − centre) / half_size, which is within −1..1, and padded.
#[derive(Default)]
pub struct Boxes {
    pub boxes: Vec<Aabb>,
    /// Per box: its face, ascending.
    pub faces: Vec<u32>,
    /// Per box: [`mixed`] of the [`hash`] of its face's corners.
    pub hashes: Vec<u32>,
    pub center: DVec3,
    pub half_size: f64,
}

impl Boxes {
    /// The boxes of all faces, except those of zero area and those with a corner that is not finite.
    pub fn new(positions: &[Vec3], faces: &[[u32; 3]]) -> Self {
        Self::by(positions, faces, threads::count(faces.len()))
    }

    /// As [`Boxes::new`], on a number of threads.
    pub fn by(positions: &[Vec3], faces: &[[u32; 3]], threads: usize) -> Self {
        let count = faces.len();
        let mut boxes: Vec<Aabb> = bytemuck::zeroed_vec(count);
        let (mut numbers, mut hashes) = (vec![0; count], vec![0; count]);
        let piece = count.div_ceil(threads).max(1);
        let pieces = boxes.chunks_mut(piece).zip(numbers.chunks_mut(piece).zip(hashes.chunks_mut(piece)));
        let pieces = (0..).step_by(piece).zip(faces.chunks(piece)).zip(pieces);
        let found = threads::each(pieces, |((first, faces), (boxes, (numbers, hashes)))| {
            let (mut found, mut bounds) = (0, Aabb::INVALID);
            for (number, face) in (first..).zip(faces) {
                let corners = face.map(|vertex| positions[vertex as usize]);
                if !corners.iter().all(|corner| corner.is_finite()) || has_zero_area(positions, face) {
                    continue;
                }
                let [a, b, c] = corners.map(Vec3A::from);
                boxes[found] = Aabb { min: a.min(b).min(c), max: a.max(b).max(c) };
                bounds = bounds.union(&boxes[found]);
                numbers[found] = number;
                hashes[found] = mixed(hash(&corners), 0);
                found += 1;
            }
            (found, bounds)
        });
        // Concatenates the pieces.
        let mut end = 0;
        for (first, (found, _)) in (0..).step_by(piece).zip(&found) {
            if first != end {
                boxes.copy_within(first..first + found, end);
                numbers.copy_within(first..first + found, end);
                hashes.copy_within(first..first + found, end);
            }
            end += found;
        }
        boxes.truncate(end);
        numbers.truncate(end);
        hashes.truncate(end);
        if boxes.is_empty() {
            return Self { half_size: 1.0, ..Self::default() };
        }
        let bounds = found.iter().fold(Aabb::INVALID, |all, (_, bounds)| all.union(bounds));
        let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let center = (low + high) / 2.0;
        let half_size = (high - low).max_element() / 2.0;
        let scale = half_size.recip();
        threads::each(boxes.chunks_mut(piece), |boxes| {
            for one in boxes {
                one.min = ((one.min.as_dvec3() - center) * scale - PADDING).as_vec3a();
                one.max = ((one.max.as_dvec3() - center) * scale + PADDING).as_vec3a();
            }
        });
        Self { boxes, faces: numbers, hashes, center, half_size }
    }
}

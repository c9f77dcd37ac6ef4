//! Fits a cost to measured times.

use crate::budget::{Amounts, Cost};

/// A measured time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub(super) amounts: Amounts,
    /// Below 0 where what was measured is lost in noise.
    pub(super) ms: f64,
}

/// The cost without negative parts that has the least sum of squared errors, relative to the times: by trying every set of
/// parts, of which there are seven (Lawson & Hanson 1974, "Solving Least Squares Problems", chapter 23, has the general
/// case).
pub(super) fn cost(points: &[Point]) -> Cost {
    let largest = points.iter().fold(0.0f64, |largest, point| largest.max(point.ms));
    // Errors below a hundredth of the largest time do not matter.
    let weight = |point: &Point| 1.0 / point.ms.abs().max(0.01 * largest).max(f64::MIN_POSITIVE);
    let columns = |Amounts { samples, faces }: Amounts| [1.0, 1e-6 * samples, 1e-6 * faces];
    let error = |parts: [f64; 3]| -> f64 {
        let of = |point: &Point| {
            let fitted: f64 = columns(point.amounts).iter().zip(parts).map(|(amount, part)| amount * part).sum();
            ((fitted - point.ms) * weight(point)).powi(2)
        };
        points.iter().map(of).sum()
    };
    let mut best = ([0.0; 3], error([0.0; 3]));
    for set in 1u32..8 {
        let used: Vec<usize> = (0..3).filter(|part| set >> part & 1 == 1).collect();
        let Some(found) = least_squares(points, &used, columns, weight) else { continue };
        if found.iter().all(|part| *part >= 0.0) && error(found) < best.1 {
            best = (found, error(found));
        }
    }
    let [fixed_ms, sample_ns, face_ns] = best.0;
    Cost { fixed_ms, sample_ns, face_ns }
}

/// The parts that solve the normal equations of some columns; `None` if they are dependent.
fn least_squares(
    points: &[Point],
    used: &[usize],
    columns: impl Fn(Amounts) -> [f64; 3],
    weight: impl Fn(&Point) -> f64,
) -> Option<[f64; 3]> {
    let count = used.len();
    // An augmented matrix of the normal equations.
    let mut rows = vec![vec![0.0; count + 1]; count];
    for point in points {
        let (columns, weight) = (columns(point.amounts), weight(point).powi(2));
        for (row, &i) in rows.iter_mut().zip(used) {
            for (value, &j) in row.iter_mut().zip(used) {
                *value += weight * columns[i] * columns[j];
            }
            row[count] += weight * columns[i] * point.ms;
        }
    }
    for at in 0..count {
        let pivot = (at..count).max_by(|&a, &b| rows[a][at].abs().total_cmp(&rows[b][at].abs()))?;
        rows.swap(at, pivot);
        let scale = rows[at][at];
        if scale.abs() < 1e-12 {
            return None;
        }
        rows[at].iter_mut().for_each(|value| *value /= scale);
        let reduced = rows[at].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(other, _)| *other != at) {
            let factor = row[at];
            row.iter_mut().zip(&reduced).for_each(|(value, reduced)| *value -= factor * reduced);
        }
    }
    let mut parts = [0.0; 3];
    used.iter().zip(&rows).for_each(|(&part, row)| parts[part] = row[count]);
    Some(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(samples: f64, faces: f64, ms: f64) -> Point {
        Point { amounts: Amounts { samples, faces }, ms }
    }

    #[test]
    fn a_linear_cost_is_found_again() {
        let cost_of = |samples, faces| 0.5 + 1e-6 * (20.0 * samples + 300.0 * faces);
        let places = [(4e4, 1e2), (1.6e5, 1e2), (4e4, 2e4), (1.6e5, 2e4)];
        let points = places.map(|(samples, faces)| point(samples, faces, cost_of(samples, faces)));
        let found = cost(&points);
        approx::assert_relative_eq!(found.fixed_ms, 0.5, max_relative = 1e-6);
        approx::assert_relative_eq!(found.sample_ns, 20.0, max_relative = 1e-6);
        approx::assert_relative_eq!(found.face_ns, 300.0, max_relative = 1e-6);
    }

    #[test]
    fn no_part_is_negative() {
        // Cheaper with more faces, which can only be noise.
        let points = [point(1e5, 1e2, 2.0), point(4e5, 1e2, 8.0), point(1e5, 1e5, 1.9), point(4e5, 1e5, 7.8)];
        let found = cost(&points);
        assert_eq!(found.face_ns, 0.0);
        assert!((found.sample_ns - 20.0).abs() < 1.0 && found.fixed_ms >= 0.0, "{found:?}");
    }

    #[test]
    fn noise_around_zero_costs_nothing() {
        let points = [point(1e5, 1e2, -0.1), point(4e5, 1e2, -0.2), point(1e5, 1e5, -0.05), point(4e5, 1e5, -0.1)];
        assert_eq!(cost(&points), Cost::default());
    }
}

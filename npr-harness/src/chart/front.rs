//! The Pareto front of a chart, and the variants that others dominate.

use super::table::Point;

/// A point that another one dominates.
#[derive(Clone, Debug, PartialEq)]
pub struct Dominated {
    /// Its index.
    pub point: usize,
    /// The index of the fastest point that is no less accurate.
    pub by: usize,
    /// Whether their times differ by more than their spreads overlap.
    pub clearly: bool,
}

/// The relative difference below which errors count as equal, because executors round differently.
const SAME: f64 = 1e-3;

/// The indices of the points that no other point dominates, by ascending time. A point dominates another one if neither
/// its time nor its error is larger, and one of them is smaller; errors that differ by rounding alone are the same. Points
/// without a finite error, and those that serve comparison alone, are on no front and dominate nothing.
pub fn front(points: &[Point]) -> Vec<usize> {
    let is_candidate = |point: &Point| point.error().is_finite() && !point.historical;
    let mut front: Vec<usize> =
        (0..points.len()).filter(|&at| is_candidate(&points[at]) && dominating(points, at).is_none()).collect();
    front.sort_by(|&a, &b| points[a].relative.median.total_cmp(&points[b].relative.median));
    front
}

/// The points that another one dominates, in their order.
pub fn dominated(points: &[Point]) -> Vec<Dominated> {
    let of = |at: usize| {
        let by = dominating(points, at)?;
        Some(Dominated { point: at, by, clearly: points[by].relative.high < points[at].relative.low })
    };
    (0..points.len()).filter_map(of).collect()
}

/// The fastest of the points that dominate one.
fn dominating(points: &[Point], at: usize) -> Option<usize> {
    let (time, error) = (points[at].relative.median, points[at].error());
    let dominates = |other: &usize| {
        let (other_time, other_error) = (points[*other].relative.median, points[*other].error());
        let (least, most) = (error * (1.0 - SAME), error * (1.0 + SAME));
        !points[*other].historical
            && other_time <= time
            && other_error <= most
            && (other_time < time || other_error < least)
    };
    let by_time = |a: &usize, b: &usize| points[*a].relative.median.total_cmp(&points[*b].relative.median);
    (0..points.len()).filter(dominates).min_by(by_time)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::Spread;

    fn point(time: f64, error: f64) -> Point {
        Point {
            variant: format!("{time} {error}"),
            historical: false,
            executor: String::new(),
            errors: vec![("error".into(), error)],
            relative: Spread { median: time, low: 0.9 * time, high: 1.1 * time },
            bytes: 0,
            scenes: 1,
        }
    }

    #[test]
    fn the_front_is_what_nothing_beats_in_both() {
        let points = [point(1.0, 0.5), point(2.0, 0.1), point(2.1, 0.2), point(4.0, 0.0), point(5.0, 0.5)];
        assert_eq!(front(&points), [0, 1, 3]);
        let found = dominated(&points);
        assert_eq!(found.iter().map(|d| (d.point, d.by)).collect::<Vec<_>>(), [(2, 1), (4, 0)]);
        assert_eq!(found.iter().map(|d| d.clearly).collect::<Vec<_>>(), [false, true]);
    }

    #[test]
    fn equal_points_do_not_dominate_each_other() {
        let points = [point(1.0, 0.5), point(1.0, 0.5)];
        assert_eq!(front(&points), [0, 1]);
        assert_eq!(dominated(&points), []);
    }

    #[test]
    fn rounding_puts_nothing_on_the_front_and_what_is_historical_dominates_nothing() {
        let old = Point { historical: true, ..point(0.5, 0.5) };
        let points = [old, point(1.0, 0.5), point(2.0, 0.499_99), point(3.0, 0.4)];
        assert_eq!(front(&points), [1, 3]);
        assert_eq!(dominated(&points).iter().map(|d| (d.point, d.by)).collect::<Vec<_>>(), [(2, 1)]);
    }

    #[test]
    fn what_has_no_error_is_on_no_front() {
        assert_eq!(front(&[point(1.0, f64::NAN), point(2.0, 1.0)]), [1]);
    }
}

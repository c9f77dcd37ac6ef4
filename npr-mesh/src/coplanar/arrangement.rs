//! Cuts overlapping triangles of one plane into pieces, so that any two pieces are the same triangle or do not overlap.

use super::box_tree::BoxTree;
use super::overlap::Projection;
use glam::{DVec2, DVec3};
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};
use std::collections::HashMap;

/// The pieces of some triangles.
#[derive(Default)]
pub(super) struct Pieces {
    /// The points that are not corners of the triangles.
    pub added: Vec<DVec3>,
    pub pieces: Vec<Piece>,
}

/// A piece: a triangle, and those of the given triangles that it is a part of.
pub(super) struct Piece {
    /// Counter-clockwise seen against the normal of the plane. Numbers below that of the given points are points; the
    /// others are those of [`Pieces::added`].
    pub corners: [u32; 3],
    /// Ascending.
    pub of: Vec<u32>,
}

/// Cuts triangles by each other's sides.
///
/// - `points`: in one plane up to `rounding`, and no two within it.
/// - `triangles`: three points each, in any winding.
/// - `budget`: the number of crossings of sides that may still be computed; reduced by those that are.
///
/// The sides become a planar graph: a side that passes a point within `rounding` is led through it, and sides that cross
/// get a common point. A constrained Delaunay triangulation (L. P. Chew 1989) of the graph has each piece whole inside or
/// outside of each triangle. `None` if the budget does not suffice, or if the triangulation fails.
pub(super) fn arrange(
    points: &[DVec3],
    triangles: &[[u32; 3]],
    along: Projection,
    rounding: f64,
    budget: &mut usize,
) -> Option<Pieces> {
    let mut flat: Vec<DVec2> = points.iter().map(|&point| along.project(point)).collect();
    let mut sides: Vec<[u32; 2]> = (triangles.iter())
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .filter(|[a, b]| a != b)
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    sides.sort_unstable();
    sides.dedup();
    add_crossings(&mut flat, &sides, rounding, budget)?;
    let mut constraints = through_points(&flat, &sides, rounding);
    constraints.sort_unstable();
    constraints.dedup();

    let given = points.len();
    let (center, scale) = frame(&flat);
    let mut cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let mut handles = Vec::with_capacity(flat.len());
    // Per vertex of the triangulation: the point, if it is one of ours.
    let mut point_of: HashMap<usize, u32> = HashMap::new();
    for (number, &at) in (0u32..).zip(&flat) {
        // spade rejects tiny numbers that are not zero.
        let [x, y] = ((at - center) * scale).to_array().map(|x| if x.abs() < 1e-30 { 0.0 } else { x });
        let handle = cdt.insert(Point2::new(x, y)).ok()?;
        point_of.entry(handle.index()).or_insert(number);
        handles.push(handle);
    }
    for [a, b] in constraints {
        let [a, b] = [a, b].map(|point| handles[point as usize]);
        if a != b {
            // Sides that were led through points may cross others by less than the rounding.
            cdt.add_constraint_and_split(a, b, |at| at);
        }
    }
    for number in 0..cdt.num_vertices() {
        point_of.entry(number).or_insert_with(|| {
            let at = cdt.vertex(FixedVertexHandle::from_index(number)).position();
            flat.push(DVec2::new(at.x, at.y) / scale + center);
            flat.len() as u32 - 1
        });
    }

    let tree = BoxTree::new(triangles.iter().map(|triangle| box_around(triangle.map(|point| flat[point as usize]))));
    let mut pieces = Vec::new();
    for face in cdt.inner_faces() {
        let corners = face.vertices().map(|vertex| point_of[&vertex.index()]);
        let [a, b, c] = corners.map(|point| flat[point as usize]);
        let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a)).sqrt();
        // Between a side and the points that it is led through, there is nothing but rounding, and no certain normal.
        if (b - a).perp_dot(c - a).abs() <= 4.0 * rounding * longest {
            continue;
        }
        let middle = (a + b + c) / 3.0;
        let mut of = Vec::new();
        tree.touching([middle.extend(0.0); 2], |triangle| {
            if contains(triangles[triangle as usize].map(|point| flat[point as usize]), middle) {
                of.push(triangle);
            }
        });
        of.sort_unstable();
        if !of.is_empty() {
            pieces.push(Piece { corners, of });
        }
    }
    let added = flat[given..].iter().map(|&at| along.lift(at, points[0])).collect();
    Some(Pieces { added, pieces })
}

/// Adds the points in which two sides cross, unless a point is there.
fn add_crossings(flat: &mut Vec<DVec2>, sides: &[[u32; 2]], rounding: f64, budget: &mut usize) -> Option<()> {
    let ends = |side: &[u32; 2], flat: &[DVec2]| side.map(|point| flat[point as usize]);
    let boxes: Vec<_> = sides.iter().map(|side| box_of(ends(side, flat), 0.0)).collect();
    let tree = BoxTree::new(boxes.iter().copied());
    let mut found: Vec<DVec2> = Vec::new();
    for (number, side) in sides.iter().enumerate() {
        let [a, b] = ends(side, flat);
        let mut is_within = true;
        tree.touching(boxes[number], |other| {
            let other = other as usize;
            if other <= number || !is_within || side.iter().any(|end| sides[other].contains(end)) {
                return;
            }
            let [c, d] = ends(&sides[other], flat);
            if let Some(at) = crossing([a, b], [c, d], rounding) {
                is_within = *budget > 0;
                *budget = budget.saturating_sub(1);
                found.push(at);
            }
        });
        if !is_within {
            return None;
        }
    }
    // Crossings within rounding of each other, or of a point, are one.
    let mut cells: HashMap<[i64; 2], Vec<u32>> = HashMap::new();
    let cell = |at: DVec2| (at / (2.0 * rounding)).floor().to_array().map(|x| x as i64);
    for (number, &at) in (0u32..).zip(flat.iter()) {
        cells.entry(cell(at)).or_default().push(number);
    }
    for at in found {
        let [x, y] = cell(at);
        let around = (0..9).map(|i| [x.saturating_add(i % 3 - 1), y.saturating_add(i / 3 - 1)]);
        let is_there = around
            .filter_map(|cell| cells.get(&cell))
            .flatten()
            .any(|&other| flat[other as usize].distance(at) <= 2.0 * rounding);
        if !is_there {
            cells.entry([x, y]).or_default().push(flat.len() as u32);
            flat.push(at);
        }
    }
    Some(())
}

/// The point in which two segments cross, if neither has an end within `rounding` of the other.
fn crossing([a, b]: [DVec2; 2], [c, d]: [DVec2; 2], rounding: f64) -> Option<DVec2> {
    let (ab, cd) = (b - a, d - c);
    let from = |start: DVec2, along: DVec2, to: DVec2| along.perp_dot(to - start) / along.length();
    let (c_off, d_off) = (from(a, ab, c), from(a, ab, d));
    let (a_off, b_off) = (from(c, cd, a), from(c, cd, b));
    let apart = |x: f64, y: f64| x.abs() > rounding && y.abs() > rounding && (x < 0.0) != (y < 0.0);
    (apart(c_off, d_off) && apart(a_off, b_off)).then(|| c + cd * (c_off / (c_off - d_off)))
}

/// Leads each side through the points within `2 * rounding` of it, in their order.
fn through_points(flat: &[DVec2], sides: &[[u32; 2]], rounding: f64) -> Vec<[u32; 2]> {
    let tree = BoxTree::new(flat.iter().map(|at| [at.extend(0.0); 2]));
    let mut pieces = Vec::with_capacity(sides.len());
    let mut on: Vec<(f64, u32)> = Vec::new();
    for &[from, to] in sides {
        let [a, b] = [from, to].map(|point| flat[point as usize]);
        let unit = (b - a).normalize_or_zero();
        let length = (b - a).length();
        on.clear();
        tree.touching(box_of([a, b], 2.0 * rounding), |point| {
            let off = flat[point as usize] - a;
            let along = unit.dot(off);
            if point != from
                && point != to
                && 0.0 < along
                && along < length
                && unit.perp_dot(off).abs() <= 2.0 * rounding
            {
                on.push((along, point));
            }
        });
        on.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut last = from;
        for next in on.iter().map(|&(_, point)| point).chain([to]) {
            pieces.push([last.min(next), last.max(next)]);
            last = next;
        }
    }
    pieces
}

fn contains([a, b, c]: [DVec2; 3], point: DVec2) -> bool {
    let side = |from: DVec2, to: DVec2| (to - from).perp_dot(point - from);
    let [u, v, w] = [side(a, b), side(b, c), side(c, a)];
    (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0)
}

fn box_of([a, b]: [DVec2; 2], slack: f64) -> [DVec3; 2] {
    [(a.min(b) - slack).extend(0.0), (a.max(b) + slack).extend(0.0)]
}

fn box_around([a, b, c]: [DVec2; 3]) -> [DVec3; 2] {
    [a.min(b).min(c).extend(0.0), a.max(b).max(c).extend(0.0)]
}

/// The centre of the points' box, and a power of two that brings them to about −1 to 1.
fn frame(flat: &[DVec2]) -> (DVec2, f64) {
    let (low, high) =
        flat.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), &at| (low.min(at), high.max(at)));
    let half = 0.5 * (high - low).max_element();
    (low.midpoint(high), if half > 0.0 { 2f64.powi(-(half.log2().ceil() as i32)) } else { 1.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: [DVec2; 3]) -> f64 {
        0.5 * (corners[1] - corners[0]).perp_dot(corners[2] - corners[0])
    }

    /// The pieces' corners in the plane z = 0, and what they are of.
    fn pieces(points: &[DVec2], triangles: &[[u32; 3]]) -> Vec<([DVec2; 3], Vec<u32>)> {
        let lifted: Vec<DVec3> = points.iter().map(|at| at.extend(0.0)).collect();
        let found =
            arrange(&lifted, triangles, Projection::new(DVec3::Z), 1e-7, &mut 10_000).expect("within the budget");
        let at = |point: u32| {
            let point = point as usize;
            lifted.get(point).copied().unwrap_or_else(|| found.added[point - lifted.len()]).truncate()
        };
        found.pieces.iter().map(|piece| (piece.corners.map(at), piece.of.clone())).collect()
    }

    #[test]
    fn the_other_diagonal_cuts_a_square_into_four() {
        let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        let found = pieces(&square, &[[0, 1, 2], [0, 2, 3], [1, 2, 3], [1, 3, 0]]);
        assert_eq!(found.len(), 4);
        for (corners, of) in found {
            assert_eq!(area(corners), 0.25);
            assert_eq!(of.len(), 2, "one of each cut: {of:?}");
            assert!(of[0] < 2 && of[1] >= 2);
        }
    }

    #[test]
    fn pieces_cover_each_triangle_exactly() {
        let mut bits = 7u64;
        let mut random = || {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (bits >> 40) as f64 / (1u64 << 24) as f64
        };
        for _ in 0..20 {
            let points: Vec<DVec2> = (0..24).map(|_| DVec2::new(random(), random())).collect();
            let triangles: Vec<[u32; 3]> = (0..8).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            let found = pieces(&points, &triangles);
            for (number, triangle) in (0u32..).zip(&triangles) {
                let whole = area(triangle.map(|point| points[point as usize])).abs();
                let parts = found.iter().filter(|(_, of)| of.contains(&number)).map(|(corners, _)| area(*corners));
                assert!((parts.sum::<f64>() - whole).abs() < 1e-6, "{number}");
            }
        }
    }

    #[test]
    fn a_side_is_led_through_a_point_that_it_passes_within_rounding() {
        // The second triangle's corner is on the first one's longest side up to 5e-8.
        let points = [(0.0, 0.0), (2.0, 0.0), (0.0, 2.0), (1.00000005, 1.0), (2.0, 2.0), (1.5, 0.6)];
        let points = points.map(|(x, y)| DVec2::new(x, y));
        let found = pieces(&points, &[[0, 1, 2], [3, 4, 5]]);
        assert!(found.iter().all(|(corners, _)| area(*corners) > 1e-3), "{found:?}");
    }

    #[test]
    fn a_budget_that_does_not_suffice_ends_the_work() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let triangles = [[0, 1, 2], [0, 2, 3], [1, 2, 3], [1, 3, 0]];
        let along = Projection::new(DVec3::Z);
        assert!(arrange(&square, &triangles, along, 1e-7, &mut 0).is_none());
        assert!(arrange(&square, &triangles, along, 1e-7, &mut 1).is_some());
    }
}

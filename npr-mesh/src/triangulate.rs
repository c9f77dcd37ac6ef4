//! Triangulation of polygons.
//!
//! A polygon of n corners always becomes n − 2 triangles, for any shape, so that face counts do not depend on
//! geometry. The triangles have the winding of the polygon. Planar decisions are made in the best-fit plane, that of
//! Newell's normal (I. Sutherland, R. Sproull, R. Schumacker, "A Characterization of Ten Hidden-Surface Algorithms",
//! 1974, credit it to M. Newell), computed in f64.
//!
//! | corners | method | time |
//! | --- | --- | --- |
//! | 3 | the triangle itself | constant |
//! | 4 | the diagonal inside the quad; of two, the shorter, or the first if equal | constant |
//! | 5 and more, convex | every other corner is cut off repeatedly | O(n) |
//! | 5 and more, not convex | constrained Delaunay (L. P. Chew, "Constrained Delaunay Triangulations", 1989) | O(n log n) |
//! | if that fails | ear clipping (G. Meisters, "Polygons Have Ears", 1975), bounded | O(n²), less than a second |
//!
//! A hole that is connected to the outline by an edge in both directions (a keyhole) is handled correctly. Ear
//! clipping handles outlines that intersect or touch themselves and have no correct triangulation. A polygon without
//! area, or with a corner that is not finite, becomes a fan.

use glam::{DVec2, DVec3, Vec3};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

/// The triangles of a polygon as indices into `corners`: [`triangulate_into`] with a new array.
pub fn triangulate(corners: &[Vec3]) -> Vec<[u32; 3]> {
    let mut triangles = Vec::with_capacity(corners.len().saturating_sub(2));
    triangulate_into(corners, &mut triangles);
    triangles
}

/// Replaces `triangles` by those of a polygon, as indices into `corners`.
///
/// There are `corners.len() - 2` triangles, none for fewer than 3 corners. Triangles and quads do not allocate if
/// `triangles` has a capacity of two.
pub fn triangulate_into(corners: &[Vec3], triangles: &mut Vec<[u32; 3]>) {
    triangulate_within(corners, triangles, &mut { EAR_TESTS });
}

/// [`triangulate_into`] with a shared budget of ear tests for many polygons.
pub(crate) fn triangulate_within(corners: &[Vec3], triangles: &mut Vec<[u32; 3]>, ear_tests: &mut usize) {
    triangles.clear();
    match *corners {
        [] | [_] | [_, _] => {}
        [_, _, _] => triangles.push([0, 1, 2]),
        [a, b, c, d] => triangles.extend(quad([a, b, c, d])),
        _ => polygon(corners, triangles, ear_tests),
    }
    debug_assert_eq!(triangles.len(), corners.len().saturating_sub(2));
}

fn quad(corners: [Vec3; 4]) -> [[u32; 3]; 2] {
    const FIRST: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
    const SECOND: [[u32; 3]; 2] = [[0, 1, 3], [1, 2, 3]];
    // Fourth powers of f32 coordinates neither overflow nor underflow in f64.
    let p = corners.map(|c| c.as_dvec3());
    // Newell's normal of a quad is the cross product of its diagonals.
    let diagonals = [p[2] - p[0], p[3] - p[1]];
    let normal = diagonals[0].cross(diagonals[1]);
    let smaller_area = |split: [[u32; 3]; 2]| {
        let areas = split.map(|t| {
            let [a, b, c] = t.map(|i| p[i as usize]);
            (b - a).cross(c - a).dot(normal)
        });
        areas[0].min(areas[1])
    };
    let (first, second) = (smaller_area(FIRST), smaller_area(SECOND));
    let second_is_better = if first > 0.0 && second > 0.0 {
        diagonals[1].length_squared() < diagonals[0].length_squared()
    } else {
        second > first
    };
    if second_is_better { SECOND } else { FIRST }
}

fn polygon(corners: &[Vec3], triangles: &mut Vec<[u32; 3]>, ear_tests: &mut usize) {
    let Some(flat) = project(corners) else {
        triangles.extend((1..corners.len() as u32 - 1).map(|i| [0, i, i + 1]));
        return;
    };
    let kept = without_spikes(&flat, triangles);
    let first = triangles.len();
    let mut rest = Vec::with_capacity(kept.len().saturating_sub(2));
    match kept.len() {
        0..3 => {}
        n if n == flat.len() => simple(corners, &flat, &mut rest, ear_tests),
        _ => {
            let corners: Vec<_> = kept.iter().map(|&i| corners[i as usize]).collect();
            let flat: Vec<_> = kept.iter().map(|&i| flat[i as usize]).collect();
            simple(&corners, &flat, &mut rest, ear_tests);
        }
    }
    triangles.extend(rest.iter().map(|t| t.map(|i| kept[i as usize])));
    debug_assert_eq!(triangles.len() - first, kept.len() - 2);
}

fn simple(corners: &[Vec3], flat: &[DVec2], triangles: &mut Vec<[u32; 3]>, ear_tests: &mut usize) {
    if is_strictly_convex(flat) {
        halve(flat.len(), triangles);
    } else if !delaunay(corners, flat, triangles) {
        triangles.clear();
        let mut of_this = EAR_TESTS.min(*ear_tests);
        *ear_tests -= of_this;
        clip_ears(flat, triangles, &mut of_this);
        *ear_tests += of_this;
    }
}

/// The corners without spikes: corners that repeat a neighbour, or where the outline reverses its direction. A
/// triangle of zero area is added for each removed corner. At least two corners remain.
fn without_spikes(flat: &[DVec2], triangles: &mut Vec<[u32; 3]>) -> Vec<u32> {
    let is_spike = |a: u32, b: u32, c: u32| {
        let [a, b, c] = [a, b, c].map(|i| flat[i as usize]);
        a == b || b == c || (turn(a, b, c) == 0.0 && (a - b).dot(c - b) > 0.0)
    };
    let mut kept: Vec<u32> = Vec::with_capacity(flat.len());
    for corner in 0..flat.len() as u32 {
        kept.push(corner);
        while let [.., a, b, c] = kept[..]
            && is_spike(a, b, c)
        {
            triangles.push([a, b, c]);
            kept.pop();
            *kept.last_mut().unwrap_or(&mut 0) = c;
        }
    }
    // The same across the end of the outline.
    let mut begin = 0;
    while let [first, second, .., last] = kept[begin..] {
        let before_last = kept[kept.len() - 2];
        if is_spike(before_last, last, first) {
            triangles.push([before_last, last, first]);
            kept.pop();
        } else if is_spike(last, first, second) {
            triangles.push([last, first, second]);
            begin += 1;
        } else {
            break;
        }
    }
    kept.drain(..begin);
    kept
}

/// The corners in the best-fit plane in counter-clockwise order, scaled so that the larger side of their bounding box
/// is −1 to 1. `None` if there is no area or if a corner is not finite.
fn project(corners: &[Vec3]) -> Option<Vec<DVec2>> {
    let (low, high) = corners
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), c| (low.min(c.as_dvec3()), high.max(c.as_dvec3())));
    let half_extent = (high - low).max_element() * 0.5;
    // `min` and `max` ignore NaN, so it is checked separately.
    if !(half_extent > 0.0 && half_extent.is_finite()) || corners.iter().any(|c| !c.is_finite()) {
        return None;
    }
    let middle = (low + high) * 0.5;
    let scaled = |c: &Vec3| (c.as_dvec3() - middle) / half_extent;
    let mut normal = DVec3::ZERO;
    let mut before = scaled(&corners[corners.len() - 1]);
    for corner in corners {
        let p = scaled(corner);
        normal += before.cross(p);
        before = p;
    }
    // Below this bound the area consists of rounding errors.
    if normal.length() <= 1e-15 * corners.len() as f64 {
        return None;
    }
    let normal = normal.normalize();
    let (u, v) = normal.any_orthonormal_pair();
    Some(
        corners
            .iter()
            .map(|c| {
                let p = scaled(c);
                // spade rejects tiny non-zero numbers.
                let flush = |x: f64| if x.abs() < 1e-30 { 0.0 } else { x };
                DVec2::new(flush(p.dot(u)), flush(p.dot(v)))
            })
            .collect(),
    )
}

/// Twice the signed area of a triangle.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

fn is_strictly_convex(flat: &[DVec2]) -> bool {
    let n = flat.len();
    let mut direction_changes = 0;
    for i in 0..n {
        let (a, b, c) = (flat[i], flat[(i + 1) % n], flat[(i + 2) % n]);
        if turn(a, b, c) <= 1e-14 {
            return false;
        }
        // An outline that only turns left is convex if it turns once in total, and then changes its horizontal
        // direction twice.
        direction_changes += usize::from((b.x > a.x) != (c.x > b.x));
    }
    direction_changes == 2
}

/// Cuts off corners 1, 3, 5, …, and then repeatedly every other remaining corner.
fn halve(n: usize, triangles: &mut Vec<[u32; 3]>) {
    let mut step = 1;
    while step < n {
        for i in (0..n - step).step_by(2 * step) {
            let third = i + 2 * step;
            if third < n {
                triangles.push([i as u32, (i + step) as u32, third as u32]);
            } else if i > 0 {
                triangles.push([i as u32, (i + step) as u32, 0]);
            }
        }
        step *= 2;
    }
}

/// The number of times the outline traverses an edge from its lower to its higher vertex minus the number of times it
/// traverses it back.
type Runs = i32;

/// Computes a constrained Delaunay triangulation into `triangles`. Returns whether it has the expected number of
/// triangles.
fn delaunay(corners: &[Vec3], flat: &[DVec2], triangles: &mut Vec<[u32; 3]>) -> bool {
    let n = flat.len();
    // Corners at one position become one vertex, represented by the first of them.
    let mut order: Vec<u32> = (0..n as u32).collect();
    order.sort_unstable_by(|&a, &b| {
        let (p, q) = (flat[a as usize], flat[b as usize]);
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(a.cmp(&b))
    });
    let mut vertex_of = vec![0u32; n];
    let mut corner_of: Vec<u32> = Vec::with_capacity(n);
    let mut vertices: Vec<Point2<f64>> = Vec::with_capacity(n);
    for &i in &order {
        let p = flat[i as usize];
        let repeated = vertices.last().is_some_and(|last| last.x == p.x && last.y == p.y);
        if repeated {
            // The positions coincide only in the projection.
            if corners[corner_of[corner_of.len() - 1] as usize] != corners[i as usize] {
                return false;
            }
        } else {
            vertices.push(Point2::new(p.x, p.y));
            corner_of.push(i);
        }
        vertex_of[i as usize] = corner_of.len() as u32 - 1;
    }
    if vertices.len() < 3 {
        return false;
    }
    let mut edges: Vec<[usize; 2]> = (0..n)
        .map(|i| [vertex_of[i] as usize, vertex_of[(i + 1) % n] as usize])
        .filter(|[from, to]| from != to)
        .map(|[from, to]| [from.min(to), from.max(to)])
        .collect();
    edges.sort_unstable();
    edges.dedup();

    let vertex_count = vertices.len();
    let edge_count = edges.len();
    let mut conflicts = 0;
    let Ok(mut cdt) =
        ConstrainedDelaunayTriangulation::<Point2<f64>, (), Runs>::try_bulk_load_cdt(vertices, edges, |_| {
            conflicts += 1
        })
    else {
        return false;
    };
    // Other numbers mean that the outline intersects itself or passes through one of its corners.
    if conflicts > 0 || cdt.num_vertices() != vertex_count || cdt.num_constraints() != edge_count {
        return false;
    }
    for i in 0..n {
        let (from, to) = (vertex_of[i] as usize, vertex_of[(i + 1) % n] as usize);
        if from == to {
            continue;
        }
        let handle = spade::handles::FixedVertexHandle::from_index;
        let Some(edge) = cdt.get_edge_from_neighbors(handle(from), handle(to)).map(|e| e.as_undirected().fix()) else {
            return false;
        };
        *cdt.undirected_edge_data_mut(edge).data_mut() += if from < to { 1 } else { -1 };
    }

    // Winding numbers are propagated from the outer face inwards. To the left of an edge that the outline traverses
    // the number is one higher than to its right.
    let mut winding: Vec<Option<Runs>> = vec![None; cdt.num_all_faces()];
    let mut open = vec![cdt.outer_face().fix()];
    winding[open[0].index()] = Some(0);
    type Edge<'a> = spade::handles::DirectedEdgeHandle<'a, Point2<f64>, (), spade::CdtEdge<Runs>, ()>;
    let mut cross = |edge: Edge<'_>, open: &mut Vec<_>| {
        let beyond = edge.rev().face().fix();
        if winding[beyond.index()].is_none() {
            let along = *edge.as_undirected().data().data();
            let runs = if edge.from().index() < edge.to().index() { along } else { -along };
            winding[beyond.index()] = winding[edge.face().index()].map(|here| here - runs);
            open.push(beyond);
        }
    };
    for edge in cdt.convex_hull() {
        let edge = if edge.face().is_outer() { edge } else { edge.rev() };
        cross(edge, &mut open);
    }
    while let Some(face) = open.pop() {
        if let Some(inner) = cdt.face(face).as_inner() {
            for edge in inner.adjacent_edges() {
                cross(edge, &mut open);
            }
        }
    }
    for face in cdt.inner_faces() {
        if winding[face.index()].is_some_and(|w| w > 0) {
            triangles.push(face.vertices().map(|v| corner_of[v.index()]));
        }
    }
    triangles.len() == n - 2
}

/// The maximum number of corners that are tested against ears, for a time of some tenths of a second.
const EAR_TESTS: usize = 20_000_000;

/// The maximum for all polygons of a file, for a time of some seconds.
#[cfg(any(feature = "obj", feature = "ply"))]
pub(crate) const EAR_TESTS_OF_A_FILE: usize = 10 * EAR_TESTS;

/// Cuts off corners until three are left: an ear if there is one, else a corner without area, else the next convex
/// corner, else any corner.
fn clip_ears(flat: &[DVec2], triangles: &mut Vec<[u32; 3]>, tests_left: &mut usize) {
    let n = flat.len();
    let mut next: Vec<u32> = (1..n as u32).chain([0]).collect();
    let mut before: Vec<u32> = [n as u32 - 1].into_iter().chain(0..n as u32 - 1).collect();
    let mut left = n;
    let mut corner = 0u32;
    let mut looked_at = 0;
    // The best corner if there is no ear, with its rank: 2 without area, 1 convex, 0 any.
    let mut spare = (0, corner);
    while left > 3 {
        let (a, c) = (before[corner as usize], next[corner as usize]);
        let area = turn(flat[a as usize], flat[corner as usize], flat[c as usize]);
        let is_ear = area > 0.0 && is_empty(flat, &next, [a, corner, c], tests_left);
        let rank = if area == 0.0 { 2 } else { u8::from(area > 0.0) };
        if looked_at == 0 || rank > spare.0 {
            spare = (rank, corner);
        }
        looked_at += 1;
        let cut = if is_ear {
            corner
        } else if looked_at >= left || *tests_left == 0 {
            spare.1
        } else {
            corner = c;
            continue;
        };
        let (a, c) = (before[cut as usize], next[cut as usize]);
        triangles.push([a, cut, c]);
        next[a as usize] = c;
        before[c as usize] = a;
        left -= 1;
        looked_at = 0;
        // Continuing behind the removed corner avoids a fan of triangles around one corner.
        corner = next[c as usize];
    }
    triangles.push([before[corner as usize], corner, next[corner as usize]]);
}

/// Whether no other corner is inside a counter-clockwise ear or on its border, except at the ear's own corners.
fn is_empty(flat: &[DVec2], next: &[u32], ear: [u32; 3], tests_left: &mut usize) -> bool {
    let [a, b, c] = ear.map(|i| flat[i as usize]);
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let mut i = next[ear[2] as usize];
    while i != ear[0] {
        // The budget is exhausted: it does not count as an ear.
        if *tests_left == 0 {
            return false;
        }
        *tests_left -= 1;
        let p = flat[i as usize];
        let in_box = p.cmpge(low).all() && p.cmple(high).all();
        if in_box && p != a && p != b && p != c && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0
        {
            return false;
        }
        i = next[i as usize];
    }
    true
}

#[cfg(test)]
mod tests;

//! Unions of boxes, and prisms on boxes, as boolean operations leave them. The true lines are known by construction.

use super::union::{CELLS, Cells, Cut, is_full, union};
use super::*;
use glam::{IVec3, Mat3};
use std::collections::BTreeSet;

fn boxes() -> impl Strategy<Value = Vec<Cells>> {
    let corner = || [0..CELLS, 0..CELLS, 0..CELLS];
    prop::collection::vec((corner(), corner()), 1..6)
}

/// The unit edges of the grid at which the surface of the union is not flat: those with one or three full cells around, or
/// with two that touch in nothing but the edge.
fn true_lines(boxes: &[Cells]) -> BTreeSet<([i32; 3], usize)> {
    let mut lines = BTreeSet::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for x in 0..=CELLS {
            for y in 0..=CELLS {
                for z in 0..=CELLS {
                    let at = IVec3::new(x, y, z);
                    let full = |a: i32, b: i32| {
                        let mut cell = at;
                        cell[u] -= a;
                        cell[v] -= b;
                        is_full(boxes, cell)
                    };
                    let around = [full(0, 0), full(1, 0), full(1, 1), full(0, 1)];
                    let count = around.iter().filter(|full| **full).count();
                    if count == 1 || count == 3 || (count == 2 && around[0] == around[2]) {
                        lines.insert((at.to_array(), axis));
                    }
                }
            }
        }
    }
    lines
}

/// The unit edges that the drawn edges of a mesh of whole numbers consist of.
fn drawn_units(places: &[Vec3], found: &Edges) -> BTreeSet<([i32; 3], usize)> {
    let mut units = BTreeSet::new();
    for edge in drawn(found) {
        let [a, b] = edge.ends.map(|vertex| places[vertex as usize].as_ivec3());
        let axis = (b - a).abs().to_array().iter().position(|&x| x > 0).unwrap();
        let start = a.min(b);
        for step in 0..(b - a).abs().max_element() {
            let mut at = start;
            at[axis] += step;
            units.insert((at.to_array(), axis));
        }
    }
    units
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn unions_of_boxes_have_the_lines_of_their_shape(
        boxes in boxes(),
        widen: bool,
        turn in rotation(),
        offset in (-3f32..3.0, -3f32..3.0, -3f32..3.0),
    ) {
        let (positions, polygons) = union(&boxes, if widen { Cut::Wide } else { Cut::High });
        let exact = Mesh { positions, polygons };
        let expected = true_lines(&boxes);
        // Turned in f32, each face in one of two ways.
        let matrix = Mat3::from_quat(turn);
        let mut turned = exact.turned(|p| turn * (p - Vec3::splat(2.5)) + Vec3::from(offset));
        for face in (0..exact.polygons.len()).step_by(2) {
            for &vertex in &exact.polygons[face] {
                turned.positions[vertex as usize] =
                    matrix * (exact.positions[vertex as usize] - Vec3::splat(2.5)) + Vec3::from(offset);
            }
        }
        for mesh in [&exact, &turned] {
            for found in [mesh.edges(), mesh.edges_of_triangles()] {
                let units = drawn_units(&exact.positions, &found);
                let hits = units.intersection(&expected).count() as f64;
                let drawn = units.len() as f64;
                let (precision, recall) = (hits / drawn.max(1.0), hits / expected.len() as f64);
                let f1 = 2.0 * precision * recall / (precision + recall);
                prop_assert!(f1 >= 0.99, "{f1}: {drawn} drawn, {hits} of {}", expected.len());
                prop_assert_eq!(recall, 1.0);
            }
        }
    }
}

/// A prism with `sides` sides on the top of a box. The top has a hole for it, and each side of the prism is cut into as
/// many quads as `pieces` says, so that these meet the top at T-junctions.
fn prism_on_box(sides: u32, pieces: &[u32]) -> (Mesh, f64) {
    let mut mesh = Mesh::default();
    let square = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let ring = |step: f64| {
        let (sin, cos) = (std::f64::consts::TAU * step / f64::from(sides)).sin_cos();
        [cos, sin]
    };
    let mut add = |[x, z]: [f64; 2], y: f64| {
        mesh.positions.push(DVec3::new(x, y, -z).as_vec3());
        mesh.positions.len() as u32 - 1
    };
    let low = square.map(|at| add(at, -1.0));
    let high = square.map(|at| add(at, 0.0));
    let hole: Vec<u32> = (0..sides).map(|step| add(ring(f64::from(step)), 0.0)).collect();
    let top: Vec<u32> = (0..sides).map(|step| add(ring(f64::from(step)), 1.5)).collect();
    let mut polygons = vec![low.iter().rev().copied().collect::<Vec<_>>(), top.clone()];
    for side in 0..4usize {
        let next = (side + 1) % 4;
        polygons.push(vec![low[side], low[next], high[next], high[side]]);
    }
    // The top of the box: triangles between the square and the hole, each corner of the hole at the nearest corner.
    let nearest = |step: u32| {
        let [x, z] = ring(f64::from(step));
        (0..4usize).min_by(|&a, &b| {
            let distance = |corner: usize| (square[corner][0] - x).hypot(square[corner][1] - z);
            distance(a).total_cmp(&distance(b))
        })
    };
    for step in 0..sides {
        let next = (step + 1) % sides;
        let (from, to) = (nearest(step).unwrap_or(0), nearest(next).unwrap_or(0));
        let [a, b] = [hole[step as usize], hole[next as usize]];
        polygons.push(vec![high[from], b, a]);
        let mut corner = from;
        while corner != to {
            let after = (corner + 1) % 4;
            polygons.push(vec![high[corner], high[after], b]);
            corner = after;
        }
    }
    for step in 0..sides {
        let count = pieces[step as usize % pieces.len()];
        let next = (step + 1) % sides;
        let mut row = |ends: [u32; 2], y: f64| -> Vec<u32> {
            let [from, to] = [ring(f64::from(step)), ring(f64::from(next))];
            let inner = (1..count).map(|piece| {
                let t = f64::from(piece) / f64::from(count);
                add([from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])], y)
            });
            let inner: Vec<u32> = inner.collect();
            [&[ends[0]], &inner[..], &[ends[1]]].concat()
        };
        let below = row([hole[step as usize], hole[next as usize]], 0.0);
        let above = row([top[step as usize], top[next as usize]], 1.5);
        for piece in 0..count as usize {
            polygons.push(vec![below[piece], below[piece + 1], above[piece + 1], above[piece]]);
        }
    }
    mesh.polygons = polygons;
    let chord = 2.0 * (std::f64::consts::PI / f64::from(sides)).sin();
    let upright = if sides < 12 { f64::from(sides) * 1.5 } else { 0.0 };
    (mesh, 8.0 * 4.0 + 4.0 + 2.0 * f64::from(sides) * chord + upright)
}

proptest! {
    #[test]
    fn a_prism_on_a_box_has_the_lines_of_its_shape(
        sides in prop::sample::select(vec![8u32, 10, 16, 24]),
        pieces in prop::collection::vec(1u32..6, 1..5),
        turn in rotation(),
    ) {
        let (exact, expected) = prism_on_box(sides, &pieces);
        for mesh in [exact.clone(), exact.turned(|p| turn * p)] {
            for found in [mesh.edges(), mesh.edges_of_triangles()] {
                let length = drawn_length(&mesh, &found);
                prop_assert!((length - expected).abs() < 1e-4 * expected, "{length} {expected}");
                prop_assert_eq!(count(&found, EdgeKind::Boundary) + count(&found, EdgeKind::NonManifold), 0);
                prop_assert!(!found.edges.iter().any(Edge::wound_oppositely));
            }
        }
    }
}

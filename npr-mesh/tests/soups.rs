//! Properties of random triangles and polygons.

use glam::{DVec3, Vec3};
use npr_mesh::edges::{self, EdgeKind, EdgeOptions, Edges, NO_FACE};
use npr_mesh::triangulate::triangulate;
use npr_mesh::{Model, normals, weld};
use proptest::prelude::*;
use std::collections::BTreeMap;

/// Corners on a coarse lattice often coincide or are collinear; others rarely.
fn positions() -> impl Strategy<Value = Vec<Vec3>> {
    let lattice = (-2i8..3, -2i8..3, -1i8..2).prop_map(|(x, y, z)| Vec3::new(x.into(), y.into(), z.into()));
    let anywhere = (-1f32..1.0, -1f32..1.0, -1f32..1.0).prop_map(Vec3::from);
    let exponent = -36i32..36;
    let scaled = |strategy: BoxedStrategy<Vec3>, exponent: std::ops::Range<i32>| {
        (prop::collection::vec(strategy, 3..16), exponent)
            .prop_map(|(points, exponent)| points.iter().map(|p| *p * 10f32.powi(exponent)).collect::<Vec<_>>())
    };
    prop_oneof![scaled(lattice.boxed(), exponent.clone()), scaled(anywhere.boxed(), exponent)]
}

/// Faces over these corners, some duplicated, reversed or with a repeated corner, and some in one polygon.
fn soup() -> impl Strategy<Value = Model> {
    (positions(), prop::collection::vec((0u32..99, 0u32..99, 0u32..99, any::<bool>()), 1..60)).prop_map(
        |(positions, corners)| {
            let count = positions.len() as u32;
            let faces: Vec<[u32; 3]> = corners.iter().map(|(a, b, c, _)| [a % count, b % count, c % count]).collect();
            let mut polygon = 0;
            let face_polygon = corners
                .iter()
                .map(|(_, _, _, next)| {
                    polygon += u32::from(*next);
                    polygon
                })
                .collect();
            Model {
                normals: vec![Vec3::ZERO; positions.len()],
                face_material: vec![0; faces.len()],
                materials: vec![Default::default()],
                positions,
                faces,
                face_polygon,
                ..Model::default()
            }
        },
    )
}

fn find(model: &Model, polygons: bool, skip_redundant: bool) -> Edges {
    let face_polygon = if polygons { &model.face_polygon[..] } else { &[] };
    let options = EdgeOptions { skip_redundant, ..EdgeOptions::of_file() };
    edges::find(&model.positions, &model.faces, face_polygon, &model.face_material, &options)
}

/// Per edge its ends in ascending order and all its faces.
fn listed(found: &Edges) -> Vec<([u32; 2], Vec<u32>)> {
    let mut all: Vec<([u32; 2], Vec<u32>)> = found
        .edges
        .iter()
        .map(|edge| {
            let [a, b] = edge.ends;
            ([a.min(b), a.max(b)], edge.faces().into_iter().filter(|&f| f != NO_FACE).collect())
        })
        .collect();
    for &(edge, face) in &found.further_faces {
        all[edge as usize].1.push(face);
    }
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn each_side_of_each_face_belongs_to_exactly_one_edge(model in soup()) {
        let found = find(&model, false, false);
        let mut sides = BTreeMap::<([u32; 2], u32), usize>::new();
        for (number, face) in (0u32..).zip(&model.faces) {
            let [a, b, c] = face.map(|v| found.representative[v as usize]);
            for (from, to) in [(a, b), (b, c), (c, a)] {
                if from != to {
                    *sides.entry(([from.min(to), from.max(to)], number)).or_default() += 1;
                }
            }
        }
        let listed = listed(&found);
        let mut ends: Vec<[u32; 2]> = listed.iter().map(|(ends, _)| *ends).collect();
        ends.sort_unstable();
        prop_assert!(ends.windows(2).all(|pair| pair[0] != pair[1]), "an edge is there twice");
        for ((ends, faces), edge) in listed.iter().zip(&found.edges) {
            for &face in faces {
                let left = sides.get_mut(&(*ends, face));
                prop_assert!(left.is_some(), "{ends:?} of face {face}");
                let left = left.unwrap();
                prop_assert!(*left > 0);
                *left -= 1;
            }
            let kind = match faces.len() {
                1 => EdgeKind::Boundary,
                2 => EdgeKind::TwoFace,
                _ => EdgeKind::NonManifold,
            };
            prop_assert_eq!(edge.kind(), kind);
            if let Some(angle) = found.dihedral_rad(edge) {
                prop_assert!((0.0..=std::f32::consts::PI).contains(&angle));
                prop_assert_eq!(kind, EdgeKind::TwoFace);
            }
        }
        prop_assert!(sides.values().all(|left| *left == 0), "a side without an edge");
    }

    #[test]
    fn diagonals_and_redundant_faces_only_take_away(model in soup()) {
        let all = find(&model, false, false);
        let known: BTreeMap<[u32; 2], Vec<u32>> = listed(&all).into_iter().collect();
        for (polygons, skip) in [(true, false), (false, true), (true, true)] {
            let found = find(&model, polygons, skip);
            for (ends, faces) in listed(&found) {
                let all = known.get(&ends);
                prop_assert!(all.is_some());
                prop_assert!(faces.iter().all(|face| all.unwrap().contains(face)));
                prop_assert!(!skip || faces.iter().all(|&f| found.skipped.get(f as usize) != Some(&true)));
            }
            prop_assert!(found.face_normals.iter().all(|n| *n == Vec3::ZERO || (n.length() - 1.0).abs() < 1e-5));
        }
    }

    #[test]
    fn what_is_found_is_found_again(model in soup()) {
        prop_assert_eq!(find(&model, true, true), find(&model, true, true));
    }

    #[test]
    fn normals_are_unit_and_nothing_else_changes(model in soup(), crease in 0f32..3.2) {
        let mut filled = model.clone();
        normals::fill_missing(&mut filled, crease);
        let mut again = model.clone();
        normals::fill_missing(&mut again, crease);
        prop_assert_eq!(&filled, &again);
        prop_assert_eq!(filled.normals.len(), filled.positions.len());
        for normal in &filled.normals {
            prop_assert!((normal.length() - 1.0).abs() < 1e-5, "{normal}");
        }
        for (before, after) in model.faces.iter().zip(&filled.faces) {
            prop_assert_eq!(
                before.map(|v| model.positions[v as usize]), after.map(|v| filled.positions[v as usize])
            );
        }
    }

    #[test]
    fn welding_joins_what_is_equal_and_nothing_else(positions in positions()) {
        let stands_for = weld::weld_exact(&positions);
        for (a, &ra) in stands_for.iter().enumerate() {
            let first = positions.iter().position(|p| *p == positions[a]);
            prop_assert_eq!(first, Some(ra as usize));
        }
    }

    #[test]
    fn polygons_of_any_corners_have_all_triangles(corners in positions()) {
        let triangles = triangulate(&corners);
        prop_assert_eq!(triangles.len(), corners.len() - 2);
        prop_assert_eq!(&triangles, &triangulate(&corners));
        // Sides on the outline are traversed once more in the direction of the outline than against it, all others
        // equally often.
        let mut runs = BTreeMap::<[u32; 2], i64>::new();
        let mut run = |from: u32, to: u32, times: i64| {
            if from != to {
                let sign = if from < to { 1 } else { -1 };
                *runs.entry([from.min(to), from.max(to)]).or_default() += sign * times;
            }
        };
        for &[a, b, c] in &triangles {
            prop_assert!([a, b, c].iter().all(|&i| (i as usize) < corners.len()));
            run(a, b, 1);
            run(b, c, 1);
            run(c, a, 1);
        }
        let place: Vec<u32> = weld::weld_exact(&corners);
        let n = corners.len();
        for i in 0..n {
            run(i as u32, ((i + 1) % n) as u32, -1);
        }
        // By position, since a repeated corner may be either of its indices.
        let mut by_place = BTreeMap::<[u32; 2], i64>::new();
        for ([from, to], times) in runs {
            let (from, to) = (place[from as usize], place[to as usize]);
            if from != to {
                let sign = if from < to { 1 } else { -1 };
                *by_place.entry([from.min(to), from.max(to)]).or_default() += sign * times;
            }
        }
        prop_assert!(by_place.values().all(|times| *times == 0), "{by_place:?}");
    }

    #[test]
    fn star_shaped_polygons_keep_their_area(
        radii in prop::collection::vec(0.1f64..1.0, 3..60),
        exponent in -34i32..34,
        tilt in -1.5f64..1.5,
    ) {
        let n = radii.len() as f64;
        let corner = |(i, r): (usize, &f64)| {
            let angle = std::f64::consts::TAU * i as f64 / n;
            let flat = DVec3::new(angle.cos(), angle.sin(), 0.0) * *r;
            (glam::DMat3::from_rotation_x(tilt) * flat * 10f64.powi(exponent)).as_vec3()
        };
        let corners: Vec<Vec3> = radii.iter().enumerate().map(corner).collect();
        let vector = |a: Vec3, b: Vec3, c: Vec3| (b.as_dvec3() - a.as_dvec3()).cross(c.as_dvec3() - a.as_dvec3());
        let whole: DVec3 = (1..corners.len() - 1).map(|i| vector(corners[0], corners[i], corners[i + 1])).sum();
        let of = |t: &[u32; 3]| vector(corners[t[0] as usize], corners[t[1] as usize], corners[t[2] as usize]);
        let parts: f64 = triangulate(&corners).iter().map(|t| of(t).length()).sum();
        prop_assert!((parts - whole.length()).abs() <= 1e-5 * whole.length(), "{parts} {}", whole.length());
    }
}

//! T-junctions.

use super::*;

/// Quads between two rows of points along X at these places, one at a height of 0 and the other above or below.
fn row(mesh: &mut Mesh, at: &[f32], aside: Vec3) {
    let first = mesh.positions.len() as u32;
    for &x in at {
        mesh.positions.extend([Vec3::X * x, Vec3::X * x + aside]);
    }
    let is_turned = aside.y > 0.0;
    for column in 0..at.len() as u32 - 1 {
        let mut quad = [0, 2, 3, 1].map(|corner| first + 2 * column + corner).to_vec();
        if !is_turned {
            quad.reverse();
        }
        mesh.polygons.push(quad);
    }
}

/// Rows of quads on both sides of the X axis.
fn rows(below: &[f32], above: &[f32], aside: Vec3) -> Mesh {
    let mut mesh = Mesh::default();
    row(&mut mesh, below, -Vec3::Y);
    row(&mut mesh, above, aside);
    mesh
}

/// The edges on the X axis, by kind: their numbers.
fn on_axis(mesh: &Mesh, found: &Edges) -> [usize; 3] {
    let is_on = |vertex: u32| mesh.positions[vertex as usize].yz() == glam::Vec2::ZERO;
    let of = |kind| found.edges.iter().filter(|edge| edge.kind() == kind && edge.ends.map(is_on) == [true; 2]).count();
    [of(EdgeKind::Boundary), of(EdgeKind::TwoFace), of(EdgeKind::NonManifold)]
}

use glam::Vec3Swizzles;

#[test]
fn a_flat_rectangle_with_a_t_junction_has_its_outline() {
    let mesh = Mesh::new(
        &[
            [-1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [-1.0, 1.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 0.5, 0.0],
            [0.0, 0.5, 0.0],
            [1.0, 1.0, 0.0],
        ],
        &[&[0, 1, 2, 3], &[1, 4, 5, 6], &[6, 5, 7, 2]],
    );
    for mesh in [mesh.clone(), mesh.split()] {
        for found in [mesh.edges(), mesh.edges_of_triangles()] {
            assert!((drawn_length(&mesh, &found) - 6.0).abs() < 1e-9);
            assert_eq!(count(&found, EdgeKind::NonManifold), 0);
        }
        let found = mesh.edges();
        // The long side is two pieces, and one edge is between the other two quads.
        assert_eq!((count(&found, EdgeKind::TwoFace), count(&found, EdgeKind::Boundary)), (3, 7));
    }
}

#[test]
fn pieces_end_where_either_side_has_a_vertex() {
    let thirds = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
    let flat = rows(&[0.0, 1.0], &thirds, Vec3::Y);
    assert_eq!(on_axis(&flat, &flat.edges()), [0, 3, 0]);
    let both = rows(&[0.0, 0.5, 1.0], &thirds, Vec3::Y);
    assert_eq!(on_axis(&both, &both.edges()), [0, 4, 0]);
    assert!((drawn_length(&both, &both.edges()) - 6.0).abs() < 1e-6);
    // Neither side covers the other: pieces that only one has remain boundaries.
    let shifted = rows(&[0.0, 1.0], &[0.25, 1.5], Vec3::Y);
    assert_eq!(on_axis(&shifted, &shifted.edges()), [2, 1, 0]);
    // Two vertices of one side within the other: one boundary between them where the first side has a gap.
    let mut gap = rows(&[0.0, 1.0], &[0.0, 0.25], Vec3::Y);
    row(&mut gap, &[0.75, 1.0], Vec3::Y);
    assert_eq!(on_axis(&gap, &gap.edges()), [1, 2, 0]);
}

#[test]
fn a_crease_with_a_t_junction_is_a_crease() {
    let bent = rows(&[0.0, 1.0], &[0.0, 0.4, 1.0], Vec3::Z);
    let found = bent.edges();
    assert_eq!(on_axis(&bent, &found), [0, 2, 0]);
    for edge in found.edges.iter().filter(|edge| edge.kind() == EdgeKind::TwoFace) {
        let [a, b] = edge.ends.map(|vertex| bent.positions[vertex as usize]);
        if a.x != b.x {
            assert!((found.dihedral_rad(edge).unwrap() - std::f32::consts::FRAC_PI_2).abs() < 1e-6);
        }
    }
}

#[test]
fn windings_are_respected() {
    // The faces above are wound the other way.
    let mut mesh = rows(&[0.0, 1.0], &[0.0, 0.5, 1.0], Vec3::Y);
    mesh.polygons[1..].iter_mut().for_each(|polygon| polygon.reverse());
    let found = mesh.edges();
    assert_eq!(on_axis(&mesh, &found), [0, 2, 0]);
    assert_eq!(found.edges.iter().filter(|edge| edge.wound_oppositely()).count(), 2);
    assert!((drawn_length(&mesh, &found) - 6.0).abs() < 1e-6);
}

#[test]
fn a_long_side_meets_many_short_ones() {
    for count in [100u16, 10_000] {
        let steps: Vec<f32> = (0..=count).map(|step| f32::from(step) / f32::from(count)).collect();
        let mesh = rows(&[0.0, 1.0], &steps, Vec3::Y);
        let start = std::time::Instant::now();
        assert_eq!(on_axis(&mesh, &mesh.edges()), [0, count.into(), 0]);
        assert!(start.elapsed().as_secs() < 5, "took {:?}", start.elapsed());
    }
}

#[test]
fn junctions_may_be_nested() {
    // Each row has twice the faces of the one below.
    let mut mesh = Mesh::default();
    for level in 0..5u32 {
        let steps: Vec<f32> = (0..=1u32 << level).map(|step| step as f32 / (1 << level) as f32).collect();
        let first = mesh.positions.len();
        row(&mut mesh, &steps, Vec3::Y);
        mesh.positions[first..].iter_mut().for_each(|p| p.y += level as f32);
    }
    assert!((drawn_length(&mesh, &mesh.edges()) - 12.0).abs() < 1e-6);
}

#[test]
fn three_sheets_on_one_line_are_non_manifold() {
    let mut mesh = rows(&[0.0, 1.0], &[0.0, 0.5, 1.0], Vec3::Y);
    row(&mut mesh, &[0.0, 0.25, 1.0], Vec3::Z);
    let found = mesh.edges();
    assert_eq!(on_axis(&mesh, &found), [0, 0, 3]);
    assert_eq!(found.further_faces.len(), 3);
}

#[test]
fn a_side_along_an_edge_of_two_faces_makes_it_non_manifold() {
    // The quads above and below have their vertices in common; a sheet stands on two of their edges.
    let mut mesh = rows(&[0.0, 0.5, 1.0], &[0.0, 0.5, 1.0], Vec3::Y);
    row(&mut mesh, &[0.0, 1.0], Vec3::Z);
    // What makes the middle an end of a boundary: a sheet over one half.
    row(&mut mesh, &[0.0, 0.5], -Vec3::Z);
    assert_eq!(on_axis(&mesh, &mesh.edges()), [0, 0, 2]);
}

#[test]
fn sides_that_are_apart_are_not_shared() {
    for gap in [1e-5f32, 1e-3] {
        let mut mesh = rows(&[0.0, 1.0], &[0.0, 0.5, 1.0], Vec3::Y);
        mesh.positions[4..].iter_mut().for_each(|p| p.z += gap);
        assert_eq!(count(&mesh.edges(), EdgeKind::Boundary), 4 + 6);
    }
    // Sides that cross, and sides that meet in a point of one of them.
    let cross = Mesh::new(
        &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
        &[&[0, 1, 2], &[3, 4, 5]],
    );
    assert_eq!(count(&cross.edges(), EdgeKind::Boundary), 6);
    let point = Mesh::new(
        &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0]],
        &[&[0, 1, 2], &[3, 4, 5]],
    );
    assert_eq!(count(&point.edges(), EdgeKind::Boundary), 6);
}

#[test]
fn a_hundred_thousand_boundaries_take_no_quadratic_time() {
    // Cards in random places, and as many on one plane with their sides on common lines.
    let mut random = 1u64;
    let mut next = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 40) as f32 / (1u64 << 24) as f32
    };
    let mut cards = Mesh::default();
    for number in 0..25_000u32 {
        let middle = Vec3::new(next(), next(), next());
        let [a, b] = [0, 1].map(|_| Vec3::new(next() - 0.5, next() - 0.5, next() - 0.5) * 0.01);
        cards.positions.extend([middle - a - b, middle + a - b, middle + a + b, middle - a + b]);
        cards.polygons.push([0, 1, 2, 3].map(|corner| 4 * number + corner).to_vec());
    }
    let mut tiles = Mesh::default();
    for number in 0..25_000u32 {
        let place = Vec3::new((number % 158) as f32, (number / 158) as f32, 0.0) * 1.5;
        tiles.positions.extend([Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y].map(|p| place + p));
        tiles.polygons.push([0, 1, 2, 3].map(|corner| 4 * number + corner).to_vec());
    }
    for mesh in [cards, tiles] {
        let start = std::time::Instant::now();
        let found = mesh.edges();
        assert!(start.elapsed().as_secs_f64() < 3.0, "took {:?}", start.elapsed());
        assert_eq!(count(&found, EdgeKind::Boundary), 100_000);
    }
}

#[test]
fn sides_that_cover_each_other_too_often_are_left_alone() {
    // Sheets around one line, each longer than the one before on both sides: quadratically many pieces.
    let mut mesh = Mesh::default();
    for number in 1..3000u16 {
        let (sin, cos) = (f32::from(number) * 1e-3).sin_cos();
        row(&mut mesh, &[-f32::from(number), f32::from(number)], Vec3::new(0.0, cos, sin));
    }
    let start = std::time::Instant::now();
    let found = mesh.edges();
    assert!(start.elapsed().as_secs() < 5, "took {:?}", start.elapsed());
    assert_eq!(count(&found, EdgeKind::Boundary), 4 * 2999);
}

#[test]
fn the_side_of_a_face_is_found_for_a_part_of_it() {
    let mesh = rows(&[0.0, 1.0], &[0.0, 0.5, 1.0], Vec3::Y);
    let found = mesh.edges();
    let faces = mesh.triangles().0;
    for edge in found.edges.iter().filter(|edge| edge.kind() == EdgeKind::TwoFace) {
        for (face, forwards) in edge.faces().into_iter().zip([true, edge.wound_oppositely()]) {
            let corners = faces[face as usize].map(|v| found.representative[v as usize]);
            let (side, along) = edges::side_of(&mesh.positions, corners, edge.ends);
            let [start, end] = [corners[side], corners[(side + 1) % 3]].map(|v| mesh.positions[v as usize]);
            assert_eq!(along, forwards);
            let ends = edge.ends.map(|v| mesh.positions[v as usize]);
            let direction = (end - start).normalize();
            assert!(ends.iter().all(|p| (*p - start).cross(direction).length() < 1e-6), "{edge:?} {corners:?}");
        }
    }
}

proptest! {
    /// A row of quads, turned in f32, whose seam with another row has vertices at other places.
    #[test]
    fn turned_seams_are_shared(
        turn in rotation(),
        below in prop::collection::btree_set(1u32..997, 0..12),
        above in prop::collection::btree_set(1u32..997, 0..12),
        angle in 0f32..3.0,
        size in prop::sample::select(vec![1e-20f32, 1e-3, 1.0, 1e3, 1e20]),
        offset in (-3f32..3.0, -3f32..3.0, -3f32..3.0),
    ) {
        let places = |inner: &std::collections::BTreeSet<u32>| {
            [0].into_iter().chain(inner.iter().copied()).chain([997]).map(|step| step as f32 / 997.0).collect::<Vec<_>>()
        };
        let mesh = rows(&places(&below), &places(&above), Vec3::new(0.0, angle.cos(), angle.sin()));
        let mesh = mesh.turned(|p| (turn * p + Vec3::from(offset)) * size);
        let found = mesh.edges();
        let pieces = below.union(&above).count() + 1;
        prop_assert_eq!(count(&found, EdgeKind::TwoFace), pieces + below.len() + above.len());
        prop_assert_eq!(count(&found, EdgeKind::NonManifold), 0);
        prop_assert_eq!(count(&found, EdgeKind::Boundary), 4 + below.len() + above.len() + 2);
    }
}

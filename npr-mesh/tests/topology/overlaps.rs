//! Faces that overlap, faces without area, and edges of many faces.

use super::*;

/// A square and its neighbour, and whatever else `polygons` has.
fn two_squares(polygons: &[&[u32]]) -> Mesh {
    let positions =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0]];
    Mesh::new(&positions, polygons)
}

#[test]
fn squares_that_are_there_twice_have_their_outline() {
    let cases: [&[&[u32]]; 6] = [
        &[&[0, 1, 2, 3], &[3, 2, 1, 0], &[1, 4, 5, 2], &[2, 5, 4, 1]],
        &[&[0, 1, 2, 3], &[1, 2, 3, 0], &[1, 4, 5, 2], &[2, 5, 4, 1]],
        // The triangles of one diagonal and those of the other.
        &[&[0, 1, 2], &[0, 2, 3], &[0, 1, 3], &[1, 2, 3], &[1, 4, 5, 2]],
        &[&[0, 1, 2], &[0, 2, 3], &[3, 1, 0], &[3, 2, 1], &[1, 4, 5, 2]],
        &[&[0, 1, 2, 3], &[2, 1, 0], &[3, 2, 0], &[1, 4, 5, 2]],
        // Only one of them is there twice, in all windings.
        &[&[0, 1, 2, 3], &[1, 4, 5, 2], &[1, 2, 5, 4], &[4, 5, 2, 1], &[4, 1, 2, 5]],
    ];
    for polygons in cases {
        let mesh = two_squares(polygons);
        for order in 0..polygons.len() {
            let mut mesh = mesh.clone();
            mesh.polygons.rotate_left(order);
            for mesh in [mesh.clone(), mesh.split()] {
                for found in [mesh.edges(), mesh.edges_of_triangles()] {
                    let length = drawn_length(&mesh, &found);
                    assert!((length - 6.0).abs() < 1e-6, "{:?}: {length}", mesh.polygons);
                    assert_eq!(count(&found, EdgeKind::NonManifold), 0, "{:?}", mesh.polygons);
                }
            }
        }
    }
}

#[test]
fn a_square_that_is_there_twice_has_its_outline_beside_a_t_junction_too() {
    let mut mesh = two_squares(&[&[0, 1, 2, 3], &[3, 2, 1, 0]]);
    mesh.positions.extend([Vec3::new(1.0, 0.5, 0.0), Vec3::new(2.0, 0.5, 0.0)]);
    mesh.polygons.extend([vec![1, 4, 7, 6], vec![6, 7, 5, 2]]);
    for found in [mesh.edges(), mesh.edges_of_triangles()] {
        assert!((drawn_length(&mesh, &found) - 6.0).abs() < 1e-6);
    }
}

#[test]
fn a_mark_that_ends_at_the_border_of_its_sheet_is_no_crease_there() {
    let mut mesh = two_squares(&[&[0, 1, 2, 3]]);
    let first = mesh.positions.len() as u32;
    mesh.positions.extend([[0.25, 0.0], [0.75, 0.0], [0.75, 0.5], [0.25, 0.5]].map(|[x, y]| Vec3::new(x, y, 0.0)));
    mesh.polygons.push((first..first + 4).collect());
    let found = mesh.edges();
    assert_eq!(count(&found, EdgeKind::Boundary), found.edges.len());
    // The outline, and the three sides of the mark within the sheet.
    assert!((drawn_length(&mesh, &found) - 5.5).abs() < 1e-6);
    assert_eq!(found.overlaps.len(), 1);
}

/// A cube of quads, with more faces.
fn cube(more: &[&[u32]], vertices: &[[f32; 3]]) -> Mesh {
    let corners = [
        [-0.5, -0.5, -0.5],
        [0.5, -0.5, -0.5],
        [0.5, 0.5, -0.5],
        [-0.5, 0.5, -0.5],
        [-0.5, -0.5, 0.5],
        [0.5, -0.5, 0.5],
        [0.5, 0.5, 0.5],
        [-0.5, 0.5, 0.5],
    ];
    let sides: [&[u32]; 6] = [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];
    Mesh::new(&[&corners, vertices].concat(), &[&sides, more].concat())
}

#[test]
fn faces_without_area_have_no_edges() {
    let cases = [
        cube(&[&[2, 6, 2]], &[]),
        cube(&[&[8, 9, 10]], &[[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0]]),
        // Not on a line in f32.
        cube(&[&[8, 9, 10]], &[[0.1, 0.1, 0.3], [0.2, 0.2, 0.6], [0.3, 0.3, 0.9]]),
        cube(&[&[8, 9, 10, 11]], &[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]]),
        // Between two faces, with a vertex of neither.
        cube(&[&[2, 8, 6]], &[[0.5, 0.5, 0.1]]),
    ];
    for mesh in cases {
        for turn in [Quat::IDENTITY, Quat::from_euler(glam::EulerRot::XYZ, 1.0, 2.0, 3.0)] {
            let mesh = mesh.turned(exactly(turn));
            let found = mesh.edges();
            assert_eq!((found.edges.len(), count(&found, EdgeKind::TwoFace)), (12, 12), "{:?}", mesh.polygons.last());
            assert!((drawn_length(&mesh, &found) - 12.0).abs() < 1e-5);
            assert!(found.skipped.contains(&true));
            // In a file they count.
            let (faces, polygons) = mesh.triangles();
            let of_file = edges::find(&mesh.positions, &faces, &polygons, &[], &EdgeOptions::of_file());
            assert!(of_file.edges.len() > 12 || count(&of_file, EdgeKind::NonManifold) == 1);
        }
    }
}

#[test]
fn a_sliver_that_repairs_a_t_junction_parts_nothing() {
    // Two squares, of which one has a vertex in the middle of the common side, and a face without area between.
    let mut mesh = two_squares(&[&[0, 1, 2, 3]]);
    mesh.positions.push(Vec3::new(1.0, 0.5, 0.0));
    mesh.polygons.extend([vec![1, 4, 6], vec![4, 5, 6], vec![5, 2, 6], vec![1, 6, 2]]);
    for turn in [Quat::IDENTITY, Quat::from_euler(glam::EulerRot::XYZ, 1.0, 2.0, 3.0)] {
        let mesh = mesh.turned(exactly(turn));
        for found in [mesh.edges(), mesh.edges_of_triangles()] {
            assert!((drawn_length(&mesh, &found) - 6.0).abs() < 1e-5);
        }
    }
}

#[test]
fn thin_faces_with_an_area_are_kept() {
    for height in [2e-6f32, 1e-5, 1e-3] {
        let thin = Mesh::new(&[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, height, 0.0]], &[&[0, 1, 2]]);
        assert_eq!(count(&thin.edges(), EdgeKind::Boundary), 3, "{height}");
    }
    // One of a large mesh that is small, in coordinates that are precise.
    let detail = Mesh::new(
        &[[-1e3, 0.0, 0.0], [1e3, 0.0, 0.0], [0.0, 1e3, 0.0], [0.0, 0.0, 1.0], [1e-4, 0.0, 1.0], [0.0, 1e-4, 1.0]],
        &[&[0, 1, 2], &[3, 4, 5]],
    );
    assert_eq!(count(&detail.edges(), EdgeKind::Boundary), 6);
}

#[test]
fn three_faces_at_an_edge_are_the_same_in_any_order() {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1.0, 0.0], [-0.5, 1.0, 0.0], [0.5, 0.5, 0.8]];
    let faces: [&[u32]; 3] = [&[0, 1, 2], &[0, 2, 3], &[0, 4, 2]];
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let mesh = Mesh::new(&positions, &order.map(|number| faces[number]));
        let found = mesh.edges();
        let [edge] = found.edges.iter().filter(|edge| edge.kind() == EdgeKind::NonManifold).collect::<Vec<_>>()[..]
        else {
            panic!("one edge has three faces")
        };
        // The flat faces are outside of the third.
        let mut outer = edge.faces().map(|face| order[face as usize]);
        outer.sort_unstable();
        assert_eq!((outer, edge.is_surrounded()), ([0, 1], false));
    }
}

#[test]
fn an_edge_with_faces_on_all_sides_is_surrounded() {
    let positions = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-0.5, 0.9, 0.0], [-0.5, -0.9, 0.0]];
    let three = Mesh::new(&positions, &[&[0, 1, 2], &[0, 1, 3], &[0, 1, 4]]);
    let is_surrounded = |mesh: &Mesh| mesh.edges().edges.iter().any(Edge::is_surrounded);
    assert!(is_surrounded(&three));
    let mut beside = three.clone();
    beside.positions[2] = Vec3::new(-1.0, 0.0, 0.0);
    assert!(!is_surrounded(&beside));
    // The face in the middle is no outer one.
    let found = beside.edges();
    let edge = found.edges.iter().find(|edge| edge.kind() == EdgeKind::NonManifold).unwrap();
    assert_eq!((edge.faces(), &found.further_faces[..]), ([1, 2], &[(0, 0)][..]));
}

#[test]
fn faces_without_area_leave_computed_normals_alone() {
    /// More polygons, and the vertices that they need.
    type Case<'a> = (&'a [&'a [u32]], &'a [[f32; 3]]);
    let line = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0]];
    let cases: [Case; 8] = [
        (&[&[2, 6, 2]], &[]),
        (&[&[6, 2, 2]], &[]),
        (&[&[2, 6, 2, 6]], &[]),
        (&[&[2, 6, 2], &[6, 2, 6], &[2, 2, 6]], &[]),
        (&[&[8, 9, 10]], &line),
        (&[&[2, 8, 6]], &[[0.5, 0.5, 0.1]]),
        (&[&[6, 8, 2]], &[[0.5, 0.5, 0.1]]),
        (&[&[8, 8, 8]], &[[0.5, 0.5, 0.5]]),
    ];
    for (more, vertices) in cases {
        for first in [false, true] {
            let clean = cube(&[], &[]);
            let mut mesh = cube(more, vertices);
            if first {
                mesh.polygons.rotate_right(more.len());
            }
            let normals_of = |mesh: &Mesh| {
                let (faces, face_polygon) = mesh.triangles();
                let mut model =
                    npr_mesh::Model { positions: mesh.positions.clone(), faces, face_polygon, ..Default::default() };
                npr_mesh::normals::fill_missing(&mut model, 45f32.to_radians());
                let corner = |&v: &u32| (model.positions[v as usize], model.normals[v as usize]);
                model.faces.iter().map(|face| face.each_ref().map(corner)).collect::<Vec<_>>()
            };
            let skipped = if first { normals_of(&mesh).len() - 12 } else { 0 };
            let found = normals_of(&mesh);
            assert_eq!(found[skipped..skipped + 12], normals_of(&clean)[..], "{more:?} {first}");
        }
    }
}

#[test]
fn duplicates_leave_computed_normals_alone() {
    // A round cap, of which some faces are there twice.
    let sphere = npr_mesh::embedded::sphere(12);
    let half = sphere.faces.len() / 2;
    for quads in [false, true] {
        let face_polygon: Vec<u32> = (0..half as u32).map(|face| if quads { face / 2 } else { face }).collect();
        let normals_of = |more: &[[u32; 3]], polygons: &[u32]| {
            let mut model = npr_mesh::Model {
                positions: sphere.positions.clone(),
                faces: [&sphere.faces[..half], more].concat(),
                face_polygon: [&face_polygon[..], polygons].concat(),
                ..Default::default()
            };
            npr_mesh::normals::fill_missing(&mut model, 45f32.to_radians());
            let corner = |&v: &u32| (model.positions[v as usize], model.normals[v as usize]);
            model.faces.iter().map(|face| face.each_ref().map(corner)).collect::<Vec<_>>()
        };
        let clean = normals_of(&[], &[]);
        let [a, b] = [sphere.faces[40], sphere.faces[41]];
        for more in [[a, b], [[a[1], a[2], a[0]], [b[2], b[0], b[1]]], [[a[2], a[1], a[0]], [b[1], b[0], b[2]]]] {
            let found = normals_of(&more, &[9999, if quads { 9999 } else { 10_000 }]);
            for (found, clean) in found.iter().flatten().zip(clean.iter().flatten()) {
                assert_eq!(found.0, clean.0);
                assert!(found.1.distance(clean.1) < 1e-6, "{quads} {more:?}: {} {}", found.1, clean.1);
            }
        }
    }
}

use super::*;
use proptest::prelude::*;

fn find_all(positions: &[Vec3], faces: &[[u32; 3]]) -> Edges {
    find(positions, faces, &[], &[], &EdgeOptions::of_file())
}

fn find_drawn(positions: &[Vec3], faces: &[[u32; 3]]) -> Edges {
    find(positions, faces, &[], &[], &EdgeOptions::default())
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

fn count(edges: &Edges, kind: EdgeKind) -> usize {
    edges.edges.iter().filter(|edge| edge.kind() == kind).count()
}

fn creases(edges: &Edges, degrees: f32) -> usize {
    edges.edges.iter().filter_map(|edge| edges.dihedral_rad(edge)).filter(|&angle| angle > degrees.to_radians()).count()
}

/// Corners numbered by the bits of x, y and z; faces are counter-clockwise from outside.
fn cube() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let positions = (0..8u32).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32)).collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    (positions, quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

#[test]
fn a_cube_has_twelve_creases_of_a_right_angle() {
    let (positions, faces) = cube();
    let edges = find_all(&positions, &faces);
    assert_eq!(edges.edges.len(), 18);
    assert_eq!(count(&edges, EdgeKind::TwoFace), 18);
    assert_eq!(creases(&edges, 89.99), 12);
    assert_eq!(creases(&edges, 90.01), 0);
}

#[test]
fn the_diagonals_of_a_cube_of_quads_are_no_edges() {
    let (positions, faces) = cube();
    let polygons: Vec<u32> = (0..12).map(|face| face / 2).collect();
    let edges = find(&positions, &faces, &polygons, &[], &EdgeOptions::default());
    assert_eq!(edges.edges.len(), 12);
    assert_eq!(creases(&edges, 89.99), 12);
}

#[test]
fn a_warped_quad_has_one_normal() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.4), Vec3::Y];
    let edges = find(&positions, &[[0, 1, 2], [0, 2, 3]], &[7, 7], &[], &EdgeOptions::default());
    assert_eq!(edges.edges.len(), 4);
    assert_eq!(edges.face_normals[0], edges.face_normals[1]);
    assert_eq!(count(&edges, EdgeKind::Boundary), 4);
}

#[test]
fn the_diagonals_of_a_polygon_are_folds_where_it_is_warped() {
    let lifted = |z: f32| [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, z), Vec3::Y];
    let folds = |positions: &[Vec3], faces: &[[u32; 3]], fold_rad: f32| {
        let polygons = vec![3; faces.len()];
        let options = EdgeOptions { fold_rad, ..Default::default() };
        let found = find(positions, faces, &polygons, &[], &options);
        assert_eq!(count(&found, EdgeKind::Boundary), found.edges.len());
        found.folds.iter().map(|fold| (sorted(fold.ends), fold.faces())).collect::<Vec<_>>()
    };
    let quad = [[0, 1, 3], [1, 2, 3]];
    // With the corner raised by z the normals are Z and (-z, -z, 1).
    let turn_rad = |z: f32| (z * 2f32.sqrt()).atan();
    for z in [0.01, 0.03, 0.4, 20.0] {
        assert_eq!(folds(&lifted(z), &quad, 1.01 * turn_rad(z)), [], "{z}");
        assert_eq!(folds(&lifted(z), &quad, 0.99 * turn_rad(z)), [([1, 3], [0, 1])], "{z}");
    }
    assert_eq!(folds(&lifted(0.0), &quad, 0.0), []);
    // All diagonals of a folded polygon, including flat ones.
    let five = [lifted(0.4).as_slice(), &[Vec3::new(-1.0, 0.5, 0.0)]].concat();
    let faces = [[0, 1, 3], [1, 2, 3], [3, 4, 0]];
    assert_eq!(folds(&five, &faces, FOLD_RAD), [([0, 3], [0, 2]), ([1, 3], [0, 1])]);
}

#[test]
fn a_flat_outline_that_crosses_itself_has_no_folds() {
    // A bow tie: the second triangle faces the other way.
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(0.8, 0.9, 0.0)];
    let found = find(&positions, &[[0, 1, 2], [0, 2, 3]], &[0, 0], &[], &EdgeOptions::default());
    let back = |face: &[u32; 3]| triangle_normal(&positions, face).z;
    assert_eq!((back(&[0, 1, 2]), back(&[0, 2, 3])), (1.0, -1.0));
    assert_eq!(found.folds, []);
}

#[test]
fn a_diagonal_that_two_polygons_share_is_no_line() {
    // A roof of two quads over the corners 0 and 2, both cut along 0-2.
    let positions = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y, Vec3::new(0.0, 1.0, 1.0)];
    let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 2], [0, 2, 4]];
    for skip_redundant in [false, true] {
        let options = if skip_redundant { EdgeOptions::default() } else { EdgeOptions::of_file() };
        let edges = find(&positions, &faces, &[0, 0, 1, 1], &[], &options);
        assert_eq!(edges.edges.iter().filter(|edge| sorted(edge.ends) == [0, 2]).count(), 0);
        assert_eq!(count(&edges, EdgeKind::NonManifold), 0);
        assert_eq!(edges.edges.len(), 6);
    }
}

#[test]
fn split_vertices_make_no_boundary() {
    let (positions, faces) = cube();
    let split: Vec<Vec3> = faces.iter().flatten().map(|&v| positions[v as usize]).collect();
    let separate: Vec<[u32; 3]> = (0..12).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
    let edges = find_all(&split, &separate);
    assert_eq!((edges.edges.len(), count(&edges, EdgeKind::Boundary)), (18, 0));
}

#[test]
fn a_face_that_is_turned_round_makes_no_crease() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)];
    let alike = find_all(&positions, &[[0, 1, 2], [1, 3, 2]]);
    let turned = find_all(&positions, &[[0, 1, 2], [1, 2, 3]]);
    for edges in [&alike, &turned] {
        assert_eq!(creases(edges, 1.0), 0);
        assert_eq!(edges.edges.iter().filter_map(|edge| edges.dihedral_rad(edge)).count(), 1);
    }
    assert_eq!(alike.edges.iter().filter(|edge| edge.wound_oppositely()).count(), 0);
    assert_eq!(turned.edges.iter().filter(|edge| edge.wound_oppositely()).count(), 1);
    assert!(alike.warnings().is_empty());
    assert_eq!(turned.warnings(), ["1 edges have faces of opposite winding: they are not creases"]);
}

#[test]
fn three_sheets_at_one_edge_are_non_manifold_and_all_are_listed() {
    let positions = [Vec3::ZERO, Vec3::Z, Vec3::X, Vec3::Y, -Vec3::X];
    let edges = find_all(&positions, &[[0, 1, 2], [0, 1, 3], [0, 1, 4]]);
    assert_eq!(count(&edges, EdgeKind::NonManifold), 1);
    assert_eq!(edges.further_faces, [(0, 2)]);
    assert_eq!(edges.edges[0].faces(), [0, 1]);
    assert_eq!(edges.dihedral_rad(&edges.edges[0]), None);
}

#[test]
fn a_duplicate_face_is_counted_but_not_drawn() {
    let (positions, mut faces) = cube();
    faces.push([faces[3][2], faces[3][1], faces[3][0]]);
    faces.push(faces[5]);
    assert_eq!(count(&find_all(&positions, &faces), EdgeKind::NonManifold), 6);
    let drawn = find_drawn(&positions, &faces);
    assert_eq!(count(&drawn, EdgeKind::TwoFace), 18);
    assert_eq!(drawn.skipped.iter().filter(|&&s| s).count(), 2);
    assert!(matches!(&drawn.warnings()[..], [one] if one.starts_with("2 faces are duplicates")));
    assert!(drawn.skipped[12] && drawn.skipped[13]);
}

#[test]
fn a_lone_face_and_its_back_are_one_sheet() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let drawn = find_drawn(&positions, &[[0, 1, 2], [2, 1, 0]]);
    assert_eq!(count(&drawn, EdgeKind::Boundary), 3);
}

#[test]
fn a_collapsed_face_does_not_part_its_neighbours() {
    let (positions, mut faces) = cube();
    faces.push([0, 4, 4]);
    let drawn = find_drawn(&positions, &faces);
    assert_eq!((drawn.edges.len(), count(&drawn, EdgeKind::TwoFace)), (18, 18));
}

#[test]
fn a_face_of_zero_area_makes_no_crease() {
    // A sliver with collinear corners between two faces at a right angle.
    let positions = [Vec3::ZERO, Vec3::X, Vec3::X * 0.5, Vec3::Y, Vec3::Z];
    let edges = find_all(&positions, &[[0, 1, 3], [1, 0, 2], [0, 2, 4], [2, 1, 4]]);
    assert_eq!(edges.face_normals[1], Vec3::ZERO);
    assert_eq!(creases(&edges, 1.0), 0);
    assert!(has_zero_area(&positions, &[1, 0, 2]));
}

#[test]
fn a_right_angle_is_not_mistaken_for_a_missing_normal() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let edges = find_all(&positions, &[[0, 1, 2], [1, 0, 3]]);
    assert_eq!(edges.cos_dihedral(&edges.edges[0]), Some(0.0));
    assert_eq!(creases(&edges, 89.0), 1);
}

#[test]
fn materials_part_where_they_differ() {
    let (positions, faces) = cube();
    let materials: Vec<u32> = (0..12).map(|face| u32::from(face >= 10)).collect();
    let edges = find(&positions, &faces, &[], &materials, &EdgeOptions::default());
    assert_eq!(edges.edges.iter().filter(|edge| edge.joins_two_materials()).count(), 4);
}

#[test]
fn many_polygons_at_one_edge_take_no_quadratic_time() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
    let squares = 100_000u32;
    let faces: Vec<[u32; 3]> = (0..squares).flat_map(|_| [[0, 1, 2], [0, 2, 3]]).collect();
    let polygons: Vec<u32> = (0..squares).flat_map(|polygon| [polygon; 2]).collect();
    let start = std::time::Instant::now();
    let options = EdgeOptions { merge_overlaps: false, ..EdgeOptions::default() };
    let edges = find(&positions, &faces, &polygons, &[], &options);
    let drawn = find(&positions, &faces, &polygons, &[], &EdgeOptions::default());
    assert!(start.elapsed().as_secs() < 10, "took {:?}", start.elapsed());
    assert_eq!((drawn.edges.len(), count(&drawn, EdgeKind::Boundary)), (4, 4));
    // Four sides of as many squares; the diagonals form pairs within their polygons.
    assert_eq!((edges.edges.len(), squares as usize), (4, edges.further_faces.len() / 4 + 2));
    assert_eq!(count(&edges, EdgeKind::NonManifold), 4);
}

#[test]
fn a_fan_around_one_vertex_is_found_in_linear_time() {
    // The hub is the lower end of half of all edges, so a search per vertex would be quadratic.
    let rim = 300_000u32;
    let mut positions = vec![Vec3::Y];
    positions.extend((0..rim).map(|i| {
        let angle = f64::from(i) / f64::from(rim) * std::f64::consts::TAU;
        Vec3::new(angle.cos() as f32, 0.0, angle.sin() as f32)
    }));
    let faces: Vec<[u32; 3]> = (0..rim).map(|i| [0, 1 + (i + 1) % rim, 1 + i]).collect();
    // Every other face first, so that there are as many separate patches at the hub as faces.
    let alternating: Vec<[u32; 3]> = faces.iter().step_by(2).chain(faces[1..].iter().step_by(2)).copied().collect();
    for faces in [faces, alternating] {
        let start = std::time::Instant::now();
        let edges = find_all(&positions, &faces);
        assert!(start.elapsed().as_secs() < 5, "took {:?}", start.elapsed());
        assert_eq!(edges.edges.len(), 2 * rim as usize);
        assert_eq!(count(&edges, EdgeKind::TwoFace), rim as usize);
    }
}

#[test]
fn an_edge_of_four_faces_is_one_edge_though_each_two_of_them_fit() {
    // Two tents over one ridge, one completed before the other begins, each with both directions of the ridge.
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
    let edges = find_all(&positions, &[[0, 1, 2], [1, 0, 3], [0, 1, 4], [1, 0, 5]]);
    assert_eq!(edges.edges.len(), 9);
    assert_eq!(count(&edges, EdgeKind::NonManifold), 1);
    assert_eq!(edges.further_faces, [(0, 2), (0, 3)]);
}

#[test]
fn edges_begun_twice_are_found_at_vertices_with_many() {
    // Many upper ends, with the duplicates far apart.
    let mut positions = vec![Vec3::ZERO];
    positions.extend((0..40).map(|i| Vec3::new((0.1 * i as f32).cos(), (0.1 * i as f32).sin(), 0.0)));
    positions.extend([Vec3::Z, -Vec3::Z]);
    let mut faces: Vec<[u32; 3]> = (1..40).map(|i| [0, i, i + 1]).collect();
    faces.extend([[0, 5, 41], [5, 0, 42]]);
    let edges = find_all(&positions, &faces);
    assert_eq!(count(&edges, EdgeKind::NonManifold), 1);
    assert_eq!(edges.edges.len(), 40 + 39 + 4);
}

#[test]
fn triangles_of_any_size_have_unit_normals() {
    for scale in [1e-30f32, 1.0, 1e30] {
        let positions = [Vec3::ZERO, Vec3::X * scale, Vec3::Y * scale];
        assert_eq!(face_normals(&positions, &[[0, 1, 2]], &[]), [Vec3::Z]);
    }
}

#[test]
fn no_faces_have_no_edges() {
    assert!(find_drawn(&[Vec3::X], &[]).edges.is_empty());
}

proptest! {
    /// Compared with a map filled in the obvious way, on random faces over few vertices, so that every irregularity
    /// occurs.
    #[test]
    fn any_soup_gives_the_edges_of_a_plain_map(
        faces in prop::collection::vec([0u32..12, 0u32..12, 0u32..12], 0..60)
    ) {
        let positions: Vec<Vec3> = (0..12u32).map(|i| {
            // Two pairs of vertices share positions.
            let i = if i >= 10 { i - 10 } else { i };
            Vec3::new((i * 7 % 5) as f32, (i * i % 11) as f32, i as f32)
        }).collect();
        let edges = find_all(&positions, &faces);
        let mut expected = std::collections::BTreeMap::<[u32; 2], Vec<(u32, bool)>>::new();
        for (number, face) in faces.iter().enumerate() {
            let welded = face.map(|v| if v >= 10 { v - 10 } else { v });
            for corner in 0..3 {
                let (a, b) = (welded[corner], welded[(corner + 1) % 3]);
                if a != b {
                    expected.entry([a.min(b), a.max(b)]).or_default().push((number as u32, a < b));
                }
            }
        }
        prop_assert_eq!(edges.edges.len(), expected.len());
        for (number, edge) in edges.edges.iter().enumerate() {
            let mut of_edge: Vec<u32> = edge.faces().into_iter().filter(|&f| f != NO_FACE).collect();
            of_edge.extend(edges.further_faces.iter().filter(|f| f.0 as usize == number).map(|f| f.1));
            let kind = match of_edge.len() {
                1 => EdgeKind::Boundary,
                2 => EdgeKind::TwoFace,
                _ => EdgeKind::NonManifold,
            };
            prop_assert_eq!(edge.kind(), kind);
            let theirs = &expected[&sorted(edge.ends)];
            let runs = |face: u32, up: bool| theirs.contains(&(face, up));
            let up = edge.ends[0] < edge.ends[1];
            prop_assert!(runs(of_edge[0], up));
            if of_edge.len() > 1 {
                prop_assert!(runs(of_edge[1], up == edge.wound_oppositely()));
            }
            of_edge.sort_unstable();
            let theirs: Vec<u32> = theirs.iter().map(|&(face, _)| face).collect();
            prop_assert_eq!(of_edge, theirs);
        }
    }

    /// The order of faces affects only the order of edges.
    #[test]
    fn kinds_do_not_depend_on_the_order_of_faces(
        faces in prop::collection::vec([0u32..9, 0u32..9, 0u32..9], 1..40),
        turn in 0usize..40
    ) {
        let positions: Vec<Vec3> = (0..9u32).map(|i| Vec3::new((i * 7 % 5) as f32, (i * i % 11) as f32, i as f32)).collect();
        let mut turned = faces.clone();
        turned.rotate_left(turn % faces.len());
        let summary = |faces: &[[u32; 3]]| {
            let mut kinds: Vec<([u32; 2], String)> = find_drawn(&positions, faces)
                .edges.iter().map(|edge| (sorted(edge.ends), format!("{:?}", edge.kind()))).collect();
            kinds.sort();
            kinds
        };
        prop_assert_eq!(summary(&faces), summary(&turned));
    }
}

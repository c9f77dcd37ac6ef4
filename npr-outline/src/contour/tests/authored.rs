//! Lines and edges of the file.

use super::{contours_of, point, sorted};
use crate::contour::{ContourEdges, ContourOptions, LineKind};
use glam::{DVec3, Vec3, dvec3};
use npr_mesh::SideVisibility::{self, Hard, Hidden, RepeatedHard, Silhouette, Unstated};
use npr_mesh::{Model, embedded};

/// The lines that are of a kind for an eye, by their ends.
fn found(contours: &ContourEdges, eye: DVec3, kind: LineKind) -> Vec<[u32; 2]> {
    let (mut lines, local) = (Vec::new(), contours.local_eye(point(eye)));
    contours.scan(point(eye), &mut lines);
    let of_kind = lines.iter().filter(|&&line| contours.kind(line as usize, local) == Some(kind));
    let mut ends: Vec<_> = of_kind.map(|&line| sorted(contours.edges[line as usize].ends)).collect();
    ends.sort_unstable();
    ends
}

/// A square across the origin that looks along +Z, and lines: its diagonal, one of its borders, one that hangs above it,
/// one without length, and the border again in the other direction.
fn square() -> Model {
    let at = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    Model {
        positions: vec![
            at(-1., -1., 0.),
            at(1., -1., 0.),
            at(1., 1., 0.),
            at(-1., 1., 0.),
            at(0., 0., 1.),
            at(1., 0., 1.),
        ],
        normals: vec![Vec3::Z; 6],
        faces: vec![[0, 1, 2], [0, 2, 3]],
        lines: vec![[2, 0], [0, 1], [4, 5], [5, 5], [1, 0]],
        ..Model::default()
    }
}

#[test]
fn lines_of_the_file_are_lines_for_every_eye_and_never_anything_else() {
    let contours = contours_of(&square(), &ContourOptions::default());
    for eye in [dvec3(0., 0., 5.), dvec3(0., 0., -5.), dvec3(9., 0., 0.), dvec3(3., 4., 0.5)] {
        assert_eq!(found(&contours, eye, LineKind::Authored), [[0, 1], [0, 1], [0, 2], [4, 5]]);
        assert_eq!(found(&contours, eye, LineKind::Boundary), [[0, 1], [0, 3], [1, 2], [2, 3]]);
        assert_eq!(found(&contours, eye, LineKind::Silhouette), [[0u32; 2]; 0]);
    }
    // A line along an edge has its faces, one in the air has none.
    let normals = |ends: [u32; 2]| {
        let is_it = |edge: &usize| {
            contours.edges[*edge].own_kind() == LineKind::Authored && sorted(contours.edges[*edge].ends) == ends
        };
        contours.normals((0..contours.edges.len()).find(is_it).unwrap())
    };
    assert_eq!(normals([0, 2]), [Vec3::Z, Vec3::Z]);
    assert_eq!(normals([0, 1]), [Vec3::Z, Vec3::ZERO]);
    assert_eq!(normals([4, 5]), [Vec3::ZERO; 2]);
    assert_eq!(contours.planes.len(), 3, "one plane for all lines without faces");
}

#[test]
fn lines_of_the_file_are_an_option_and_cost_nothing_without_them() {
    let without = contours_of(&square(), &ContourOptions { authored: false, ..ContourOptions::default() });
    let bare = contours_of(&Model { lines: Vec::new(), ..square() }, &ContourOptions::default());
    assert_eq!((&without.edges, without.always), (&bare.edges, bare.always));
    assert_eq!((without.planes.len(), without.edges.len()), (2, 4));
    // A line along an edge of two faces needs no plane of its own.
    let along = contours_of(&Model { lines: vec![[0, 2]], ..square() }, &ContourOptions::default());
    assert_eq!((along.planes.len(), along.edges.len(), along.always), (2, 5, 5));
}

#[test]
fn lines_need_no_faces() {
    let model = Model { faces: Vec::new(), ..square() };
    let contours = contours_of(&model, &ContourOptions::default());
    assert_eq!((contours.planes.len(), contours.edges.len(), contours.always), (1, 4, 4));
    assert_eq!(found(&contours, DVec3::Z, LineKind::Authored).len(), 4);
}

#[test]
fn the_edges_of_the_file_are_the_lines() {
    let cube = embedded::cube();
    let all = ContourOptions::default();
    let silhouettes_of_cube = found(&contours_of(&cube, &all), dvec3(3., 4., 5.), LineKind::Silhouette);
    let stated = |visibility: SideVisibility, options: ContourOptions| {
        // As a file without polygons has it.
        let (positions, faces) = (cube.positions.clone(), cube.faces.clone());
        let side_visibility = vec![[visibility; 3]; faces.len()];
        let contours = contours_of(
            &Model { positions, normals: cube.normals.clone(), faces, side_visibility, ..Model::default() },
            &options,
        );
        LineKind::ALL.map(|kind| found(&contours, dvec3(3., 4., 5.), kind).len())
    };
    // Twelve edges, of which six are silhouettes, and six diagonals.
    assert_eq!(silhouettes_of_cube.len(), 6);
    assert_eq!(stated(Unstated, all), [6, 0, 6, 0, 0]);
    assert_eq!(stated(Hidden, all), [0; 5]);
    assert_eq!(stated(Silhouette, all), [6, 0, 0, 0, 0]);
    assert_eq!(stated(Hard, all), [6, 0, 12, 0, 0]);
    assert_eq!(stated(RepeatedHard, all), [6, 0, 12, 0, 0]);
    for visibility in [Hidden, Silhouette, Hard] {
        let own = ContourOptions { file_edges: false, ..all };
        assert_eq!(stated(visibility, own), [6, 0, 6, 0, 0], "{visibility:?}");
        let no_creases = ContourOptions { creases: false, ..all };
        assert_eq!(stated(visibility, no_creases), [if visibility == Hidden { 0 } else { 6 }, 0, 0, 0, 0]);
    }
}

#[test]
fn a_side_that_says_nothing_leaves_an_edge_to_its_angle() {
    let mut model = square();
    model.lines.clear();
    model.positions[3] = Vec3::new(-1., 1., 2.);
    let creases = |sides: [[SideVisibility; 3]; 2]| {
        let model = Model { side_visibility: sides.to_vec(), ..model.clone() };
        let contours = contours_of(&model, &ContourOptions { crease_angle_rad: 0.1, ..ContourOptions::default() });
        let of = |kind| contours.edges.iter().filter(|edge| edge.own_kind() == kind).count();
        (of(LineKind::Crease), of(LineKind::Boundary))
    };
    // The diagonal is the third side of the first face and the first of the second.
    let [h, s, n, u] = [Hard, Silhouette, Hidden, Unstated];
    assert_eq!(creases([[u, u, u], [u, u, u]]), (1, 4));
    assert_eq!(creases([[u, u, n], [u, u, u]]), (1, 4));
    assert_eq!(creases([[u, u, n], [n, u, u]]), (0, 4));
    assert_eq!(creases([[n, n, n], [s, h, n]]), (0, 1));
    assert_eq!(creases([[n, n, h], [RepeatedHard, h, s]]), (1, 2));
}

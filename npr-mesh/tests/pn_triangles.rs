//! Curved PN triangles: closed meshes remain closed, flat faces remain flat, and the result is close to the surface
//! that the normals describe.

use std::collections::HashSet;

use glam::{DVec3, Quat, Vec2, Vec3, Vec4};
use npr_mesh::edges::{self, EdgeKind, EdgeOptions, Edges, MOST_FACES};
use npr_mesh::embedded::{cone, cube, cylinder, scene, sphere, teapot, torus};
use npr_mesh::pn_triangles::{TessellateError, tessellate};
use npr_mesh::subdivide::subdivide_midpoint;
use npr_mesh::{Material, Model};
use proptest::prelude::*;

fn model(positions: Vec<Vec3>, normals: Vec<Vec3>, faces: Vec<[u32; 3]>) -> Model {
    let (face_material, materials) = (vec![0; faces.len()], vec![Material::default()]);
    Model { positions, normals, faces, face_material, materials, ..Model::default() }
}

/// A subdivided mesh on the unit sphere with the sphere's normals.
fn icosahedron(times: u32) -> Model {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut positions = Vec::new();
    for (short, long) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        for axis in 0..3 {
            let mut corner = DVec3::ZERO;
            (corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (short, long);
            positions.push(corner.normalize().as_vec3());
        }
    }
    let mut faces = Vec::new();
    for [a, b, c] in (0..12 * 12 * 12).map(|i| [i / 144, i / 12 % 12, i % 12]) {
        let [p, q, r] = [a, b, c].map(|v| positions[v as usize]);
        // Edges have the length 1.05, other pairs at least 1.7.
        let near = [p.distance(q), q.distance(r), r.distance(p)].into_iter().all(|d| d > 0.0 && d < 1.1);
        if a < b && a < c && near && (q - p).cross(r - p).dot(p) > 0.0 {
            faces.push([a, b, c]);
        }
    }
    assert_eq!(faces.len(), 20);
    let mut mesh = model(positions.clone(), positions, faces);
    for _ in 0..times {
        mesh = subdivide_midpoint(&mesh);
        mesh.positions.iter_mut().for_each(|p| *p = p.as_dvec3().normalize().as_vec3());
        mesh.normals.clone_from(&mesh.positions);
    }
    mesh
}

/// A mesh inscribed in the unit sphere with the sphere's normals.
fn octahedron() -> Model {
    let ends = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
    let faces = vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    model(ends.to_vec(), ends.to_vec(), faces)
}

fn find(model: &Model) -> Edges {
    let options = EdgeOptions::of_file();
    edges::find(&model.positions, &model.faces, &model.face_polygon, &[], &options)
}

fn count(model: &Model, kind: EdgeKind) -> usize {
    find(model).edges.iter().filter(|edge| edge.kind() == kind).count()
}

/// The number of edges with a dihedral angle above 30°.
fn creases(model: &Model) -> Vec<[Vec3; 2]> {
    let found = find(model);
    let sharp = found.edges.iter().filter(|edge| found.dihedral_rad(edge) > Some(30.1_f32.to_radians()));
    sharp.map(|edge| edge.ends.map(|v| model.positions[v as usize])).collect()
}

/// The model with separate vertices for each face.
fn split(model: &Model) -> Model {
    let corners = || model.faces.iter().flatten().map(|&v| v as usize);
    Model {
        positions: corners().map(|v| model.positions[v]).collect(),
        normals: corners().map(|v| model.normals[v]).collect(),
        faces: (0..model.faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect(),
        ..model.clone()
    }
}

/// The distinct positions by their bits, except for the sign of zero.
fn places(model: &Model) -> HashSet<[u32; 3]> {
    model.positions.iter().map(|p| (*p + Vec3::ZERO).to_array().map(f32::to_bits)).collect()
}

/// The maximum distance from the unit sphere, and the maximum angle between a normal and that of the sphere in
/// degrees.
fn sphere_errors(model: &Model) -> (f64, f64) {
    let errors = model.positions.iter().zip(&model.normals).map(|(p, n)| {
        let p = p.as_dvec3();
        ((p.length() - 1.0).abs(), p.angle_between(n.as_dvec3()).to_degrees())
    });
    errors.fold((0.0, 0.0), |(d, a), (distance, angle)| (distance.max(d), angle.max(a)))
}

#[test]
fn a_cube_of_hard_normals_stays_closed_and_a_cube() {
    for turn in [Quat::IDENTITY, Quat::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, 1.1)] {
        let mut cube = cube();
        for vector in cube.positions.iter_mut().chain(&mut cube.normals) {
            *vector = turn * *vector;
        }
        for segments in [2, 3, 7] {
            let fine = tessellate(&cube, segments).unwrap();
            assert_eq!(count(&fine, EdgeKind::TwoFace), 18 * (segments * segments) as usize);
            assert_eq!(find(&fine).edges.len(), 18 * (segments * segments) as usize);
            assert_eq!(creases(&fine).len(), 12 * segments as usize);
            for (v, (position, normal)) in fine.positions.iter().zip(&fine.normals).enumerate() {
                let distance = turn.inverse().mul_vec3(*position).abs().max_element();
                assert!((distance - 1.0).abs() < 1e-6, "vertex {v}: {distance}");
                assert!((position.dot(*normal) - 1.0).abs() < 1e-6);
                if turn == Quat::IDENTITY {
                    assert_eq!((distance, position.dot(*normal)), (1.0, 1.0));
                }
            }
        }
    }
}

#[test]
fn points_on_a_sphere_s_icosahedra_come_near_it_to_fourth_order_and_normals_to_third() {
    let (flat, _) = sphere_errors(&subdivide_midpoint(&icosahedron(0)));
    assert!(flat > 0.14);
    let errors = [0, 1, 2, 3].map(|times| sphere_errors(&tessellate(&icosahedron(times), 16).unwrap()));
    let expected = [(5.85e-2, 1.05), (6.31e-3, 0.184), (4.67e-4, 0.0255), (3.06e-5, 0.0033)];
    for ((distance, angle), (most, widest)) in errors.into_iter().zip(expected) {
        assert!(distance < most && distance > 0.98 * most, "{distance} {most}");
        assert!(angle < widest && angle > 0.98 * widest, "{angle} {widest}");
    }
    assert!(errors[2].0 / errors[3].0 > 15.0 && errors[2].1 / errors[3].1 > 7.5);
}

#[test]
fn the_patch_is_that_of_the_paper() {
    // By hand: b210 = (2 P1 + P2 - w12 N1) / 3 and so on, b111 = E + (E - V) / 2; all barycentric weights are 1/3 at
    // the centre.
    let p = [DVec3::new(0.0, 0.0, 0.0), DVec3::new(3.0, 0.0, 0.5), DVec3::new(0.5, 2.0, -0.5)];
    let n = [DVec3::new(-0.4, -0.2, 1.0), DVec3::new(0.5, 0.1, 1.0), DVec3::new(0.0, 0.6, 1.0)].map(DVec3::normalize);
    let face = model(p.map(DVec3::as_vec3).to_vec(), n.map(DVec3::as_vec3).to_vec(), vec![[0, 1, 2]]);
    let b = |i: usize, j: usize| (2.0 * p[i] + p[j] - (p[j] - p[i]).dot(n[i]) * n[i]) / 3.0;
    let edge_points = [b(0, 1), b(1, 0), b(1, 2), b(2, 1), b(2, 0), b(0, 2)];
    let (e, v) = (edge_points.into_iter().sum::<DVec3>() / 6.0, (p[0] + p[1] + p[2]) / 3.0);
    let centre = e + (e - v) / 2.0;
    let middle = (p[0] + p[1] + p[2] + 3.0 * 6.0 * e + 6.0 * centre) / 27.0;
    let third = (8.0 * p[0] + 12.0 * b(0, 1) + 6.0 * b(1, 0) + p[1]) / 27.0;
    let fine = tessellate(&face, 3).unwrap();
    assert_eq!(fine.positions.len(), 10);
    assert!(fine.positions[3].as_dvec3().distance(third) < 1e-6, "{} {third}", fine.positions[3]);
    assert!(fine.positions[9].as_dvec3().distance(middle) < 1e-6, "{} {middle}", fine.positions[9]);
    // n110 is the reflected sum of the normals.
    let mirrored = |i: usize, j: usize| {
        let (chord, sum) = (p[j] - p[i], n[i] + n[j]);
        (sum - 2.0 * chord.dot(sum) / chord.length_squared() * chord).normalize()
    };
    let normal = (n[0] + n[1] + n[2] + 2.0 * (mirrored(0, 1) + mirrored(1, 2) + mirrored(2, 0))).normalize();
    assert!(fine.normals[9].as_dvec3().distance(normal) < 1e-6);
    let normal = (4.0 * n[0] + n[1] + 4.0 * mirrored(0, 1)).normalize();
    assert!(fine.normals[3].as_dvec3().distance(normal) < 1e-6);
}

#[test]
fn old_vertices_keep_their_numbers_and_bits_and_the_new_ones_follow_face_by_face() {
    let mut tent = model(
        vec![Vec3::ZERO, Vec3::X, Vec3::ONE, Vec3::Y],
        [[-0.3, 0.0, 1.0], [0.3, 0.0, 1.0], [0.0, 0.3, 1.0], [0.0, 0.0, 2.0]].map(Vec3::from).to_vec(),
        vec![[0, 1, 2], [0, 2, 3]],
    );
    tent.uvs = vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    tent.colors = vec![Vec4::new(0.1, 0.7, 0.3, 1.0); 4];
    tent.face_polygon = vec![4, 4];
    tent.face_material = vec![0, 1];
    tent.materials.push(Material::default());
    let fine = tessellate(&tent, 3).unwrap();
    assert_eq!((fine.positions[..4].to_vec(), fine.normals[..4].to_vec()), (tent.positions.clone(), tent.normals));
    // Two new vertices on each of 0-1, 1-2, 0-2 and one inside; two on each of 2-3, 0-3 and one inside.
    assert_eq!(fine.faces[..3], [[0, 4, 8], [4, 5, 10], [4, 10, 8]]);
    assert_eq!(fine.faces[3..9], [[8, 10, 9], [5, 1, 6], [5, 6, 10], [10, 6, 7], [10, 7, 9], [9, 7, 2]]);
    assert_eq!(fine.faces[9..12], [[0, 8, 13], [8, 9, 15], [8, 15, 13]]);
    assert_eq!((fine.positions.len(), fine.normals.len(), fine.uvs.len(), fine.colors.len()), (16, 16, 16, 16));
    assert_eq!(fine.face_material, [[0; 9], [1; 9]].concat());
    assert!(fine.uvs[10].abs_diff_eq(Vec2::new(2.0, 1.0) / 3.0, 1e-6) && fine.uvs[4].abs_diff_eq(Vec2::X / 3.0, 1e-6));
    assert!(fine.colors.iter().all(|&color| color == tent.colors[0]));
    assert!(fine.face_polygon.is_empty());
}

#[test]
fn a_contour_finds_edges_within_a_patch_and_a_former_diagonal_is_one() {
    // A distant view of an octahedron: the contour runs through its patches along their new edges.
    let mut octahedron = octahedron();
    octahedron.face_polygon = vec![0, 0, 1, 1, 2, 2, 3, 3];
    let fine = tessellate(&octahedron, 8).unwrap();
    let (found, eye) = (find(&fine), Vec3::new(1.0, 2.0, 3.0).normalize());
    let seen = |face: u32| found.face_normals[face as usize].dot(eye) > 0.0;
    let contour = found.edges.iter().map(|edge| edge.faces()).filter(|&[a, b]| seen(a) != seen(b));
    assert!(contour.filter(|[a, b]| a / 64 == b / 64).count() > 10);
    assert_eq!(found.edges.len(), 12 * 64);
}

#[test]
fn patches_meet_at_less_and_less_of_an_angle() {
    let expected = [(octahedron(), 46.6), (icosahedron(0), 16.4), (icosahedron(1), 2.91), (icosahedron(2), 0.563)];
    for (base, most) in expected {
        let found = find(&tessellate(&base, 64).unwrap());
        let widest = found.edges.iter().filter_map(|edge| found.dihedral_rad(edge)).fold(0.0, f32::max).to_degrees();
        assert!(widest < most && widest > 0.98 * most, "{widest} {most}");
    }
}

#[test]
fn a_cylinder_s_rims_become_round_and_its_lids_stay_flat() {
    let fine = tessellate(&cylinder(12), 4).unwrap();
    let rims = creases(&fine);
    assert_eq!(rims.len(), 2 * 12 * 4);
    let radius = rims.iter().flatten().map(|p| {
        assert_eq!(p.y.abs(), 1.0);
        p.x.hypot(p.z)
    });
    let (least, most) = radius.fold((2.0_f32, 0.0_f32), |(least, most), r| (least.min(r), most.max(r)));
    // The middle of the chord is at cos 15°; on the cubic it is at cos 15° (1 + sin² 15° / 2).
    assert!((least - 0.998_28).abs() < 1e-5 && (most - 1.0).abs() < 1e-6, "{least} {most}");
    assert_eq!(count(&fine, EdgeKind::TwoFace), find(&fine).edges.len());
}

#[test]
fn a_crease_runs_along_both_sides_tangent_planes_and_a_slight_difference_does_not_bend_it_sideways() {
    // The edge from 0 to 1, with a face on either side that has its own normals.
    let chord = Vec3::new(2.0, 0.3, 0.0);
    let edge = |left: Vec3, right: Vec3| {
        let corners = [Vec3::ZERO, chord, Vec3::new(1.0, -2.0, 0.0), chord, Vec3::ZERO, Vec3::new(1.0, 2.0, 0.0)];
        let normals = [left, Vec3::Z, Vec3::Z, Vec3::Z, right, Vec3::Z].map(Vec3::normalize);
        let fine = tessellate(&model(corners.to_vec(), normals.to_vec(), vec![[0, 1, 2], [3, 4, 5]]), 1000).unwrap();
        (fine.positions[6] - corners[0]).normalize()
    };
    let (left, right) = (Vec3::new(-0.2, -0.5, 1.0), Vec3::new(-0.2, 0.5, 1.0));
    let tangent = left.cross(right).normalize();
    assert!(edge(left, right).distance(tangent * tangent.dot(chord).signum()) < 2e-3);
    assert_eq!(edge(left, right), edge(right, left));
    assert_eq!(edge(left, right), edge(-left, right), "a face turned over bends the edge alike");
    // Normals that differ by 8-bit quantisation.
    let (near, nearer) = (Vec3::new(0.004, 0.0, 1.0), Vec3::new(-0.004, 0.0, 1.0));
    assert!(edge(near, nearer).distance(chord.normalize()) < 2e-3);
    assert!(edge(near, -nearer).distance(chord.normalize()) < 2e-3);
    assert_eq!(edge(-near, near), edge(near, near));
}

#[test]
fn seams_meet_to_the_last_bit() {
    for whole in [icosahedron(1), torus(2.0, 0.7, 8, 6), teapot(4)] {
        let mut parts = split(&whole);
        parts.uvs = (0..parts.positions.len()).map(|v| Vec2::splat(v as f32)).collect();
        // Half of the zeros are negative, which denotes the same positions.
        for position in parts.positions.iter_mut().step_by(2) {
            *position = position.map(|x| if x == 0.0 { -0.0 } else { x });
        }
        let (whole, parts) = (tessellate(&whole, 5).unwrap(), tessellate(&parts, 5).unwrap());
        assert_eq!(find(&whole).edges.len(), find(&parts).edges.len());
        assert_eq!(count(&whole, EdgeKind::Boundary), count(&parts, EdgeKind::Boundary));
        assert_eq!(places(&whole), places(&parts));
    }
}

#[test]
fn embedded_models_keep_their_boundaries_and_get_no_creases_that_they_had_not() {
    for (name, base) in [("cone", cone(12)), ("cylinder", cylinder(24)), ("sphere", sphere(16)), ("scene", scene())] {
        for segments in [2, 5] {
            let fine = tessellate(&base, segments).unwrap();
            let boundaries = |model| count(model, EdgeKind::Boundary);
            assert_eq!(fine.faces.len(), base.faces.len() * (segments * segments) as usize);
            assert_eq!(boundaries(&fine), boundaries(&base) * segments as usize, "{name}");
            assert_eq!(count(&fine, EdgeKind::NonManifold), 0, "{name}");
            assert!(creases(&fine).len() <= creases(&base).len() * segments as usize, "{name}");
            assert!(fine.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-6));
            for (f, face) in fine.faces.iter().enumerate() {
                let [a, b, c] = face.map(|v| fine.positions[v as usize].as_dvec3());
                let normal: DVec3 = face.iter().map(|&v| fine.normals[v as usize].as_dvec3()).sum();
                assert!((b - a).cross(c - a).dot(normal) > 0.0, "{name}: face {f} is turned over");
            }
        }
    }
}

#[test]
fn faces_without_area_and_normals_without_direction_bend_nothing() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X * 2.0, Vec3::X, Vec3::ZERO];
    let blank = [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY, Vec3::ZERO, Vec3::ZERO, Vec3::ZERO].to_vec();
    let faces = vec![[0, 1, 2], [0, 1, 3], [1, 4, 2], [0, 5, 0], [2, 2, 2]];
    let fine = tessellate(&model(positions.clone(), blank, faces.clone()), 4).unwrap();
    assert!(fine.positions.iter().all(|p| p.is_finite() && p.z == 0.0));
    assert!(fine.normals[6..].iter().all(|&normal| normal == Vec3::ZERO));
    assert!(fine.positions[6].abs_diff_eq(Vec3::X * 0.25, 1e-7));

    // One corner without a normal: the edge is straight at that end, and new normals come from the others.
    let mut one = model(positions[..3].to_vec(), vec![Vec3::new(0.6, 0.0, 0.8), Vec3::ZERO, Vec3::Z], vec![[0, 1, 2]]);
    let fine = tessellate(&one, 4).unwrap();
    assert!(fine.normals.iter().skip(3).all(|normal| (normal.length() - 1.0).abs() < 1e-6));
    assert!(fine.positions[3].z < -0.05 && fine.positions[5].z < 0.0);
    // Opposite normals, whose sum is zero at the middle of the edge.
    one.normals = vec![Vec3::Z, -Vec3::Z, Vec3::Z];
    let fine = tessellate(&one, 4).unwrap();
    assert!(fine.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-6));
}

#[test]
fn many_faces_at_one_edge_take_no_quadratic_time() {
    let rim = |i: u32| Vec3::new((i as f32).cos(), 0.5, (i as f32).sin());
    let positions: Vec<_> = [Vec3::ZERO, Vec3::Y].into_iter().chain((0..100_000).map(rim)).collect();
    let faces = (2..positions.len() as u32).map(|v| [0, 1, v]).collect();
    let start = std::time::Instant::now();
    let fine = tessellate(&model(positions.clone(), positions, faces), 2).unwrap();
    assert_eq!(fine.faces.len(), 400_000);
    assert!(start.elapsed().as_secs() < 5, "took {:?}", start.elapsed());
}

#[test]
fn one_segment_changes_nothing_and_none_or_too_many_are_errors() {
    assert_eq!(tessellate(&cube(), 1), Ok(cube()));
    assert_eq!(tessellate(&Model::default(), 7), Ok(Model::default()));
    assert_eq!(tessellate(&cube(), 0), Err(TessellateError::NoSegments));
    let too_large = |count| TessellateError::TooLarge { what: "faces", count, limit: MOST_FACES as u64 };
    assert_eq!(tessellate(&cube(), 9460), Err(too_large(12 * 9460 * 9460)));
    assert_eq!(tessellate(&cube(), u32::MAX), Err(too_large(u64::MAX)));
    assert_eq!(too_large(7 << 30).to_string(), "7516192768 faces, more than the limit of 1073741823");
}

proptest! {
    #[test]
    fn what_is_closed_stays_closed_whatever_its_normals(
        which in 0..4usize,
        segments in 2..6u32,
        apart: bool,
        shifts in prop::collection::vec(prop::array::uniform3(-1.0..1.0f32), 64),
    ) {
        let mut base = vec![cube(), icosahedron(0), torus(1.0, 0.4, 5, 4), cone(7)].swap_remove(which);
        if apart {
            base = split(&base);
        }
        for (normal, shift) in base.normals.iter_mut().zip(shifts.iter().cycle()) {
            *normal = (*normal + Vec3::from(*shift)).normalize_or_zero();
        }
        let fine = tessellate(&base, segments).unwrap();
        let edges = find(&fine).edges.len();
        prop_assert_eq!(edges, fine.faces.len() * 3 / 2);
        prop_assert_eq!(count(&fine, EdgeKind::TwoFace), edges);
        prop_assert!(fine.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-5));
    }
}

#[test]
fn parts_of_a_side_are_what_the_side_is_and_edges_within_a_patch_are_silhouettes() {
    use npr_mesh::SideVisibility::{Hard, Hidden, RepeatedHard, Silhouette};
    let cube = cube();
    let hard = Model { side_visibility: vec![[Hard, Hard, Hard]; cube.faces.len()], ..cube.clone() };
    for segments in [2, 3, 5] {
        let n = segments as usize;
        let fine = tessellate(&hard, segments).expect("few faces");
        let found = edges::find(&fine.positions, &fine.faces, &fine.face_polygon, &[], &Default::default());
        let classes = npr_mesh::edge_visibility(&fine, &found);
        let count = |class| classes.iter().filter(|of_edge| **of_edge == class).count();
        // Eighteen edges with diagonals; within each of twelve faces there are three lines of each length below n.
        assert_eq!((count(Hard), count(Silhouette)), (18 * n, 12 * 3 * n * (n - 1) / 2));
        assert_eq!(count(Hidden), 0);
        assert!(found.edges.iter().all(|edge| edge.kind() == EdgeKind::TwoFace));
    }
    // Of one face, in the order of its strips.
    let mut face = cube;
    face.faces.truncate(1);
    face.face_polygon.clear();
    face.face_material.truncate(1);
    face.face_mesh.truncate(1);
    face.side_visibility = vec![[Hard, RepeatedHard, Hidden]];
    let [h, r, n, s] = [Hard, RepeatedHard, Hidden, Silhouette];
    let fine = tessellate(&face, 2).expect("few faces");
    assert_eq!(fine.side_visibility, [[h, s, n], [h, r, s], [n; 3], [s, r, n]]);
    face.side_visibility.clear();
    assert!(tessellate(&face, 2).expect("few faces").side_visibility.is_empty());
}

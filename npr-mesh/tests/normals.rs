//! Computation of missing normals.

use glam::{Vec2, Vec3, Vec4};
use npr_mesh::Model;
use npr_mesh::normals::fill_missing;

const CREASE: f32 = std::f32::consts::FRAC_PI_4;

fn model(positions: &[Vec3], faces: &[[u32; 3]]) -> Model {
    Model {
        positions: positions.to_vec(),
        normals: vec![Vec3::ZERO; positions.len()],
        faces: faces.to_vec(),
        face_material: vec![0; faces.len()],
        materials: vec![Default::default()],
        ..Model::default()
    }
}

fn filled(mut model: Model) -> Model {
    let (faces, vertices) = (model.faces.clone(), model.positions.len());
    let before: Vec<_> = faces.iter().flatten().map(|&v| model.positions[v as usize]).collect();
    fill_missing(&mut model, CREASE);
    assert_eq!(model.normals.len(), model.positions.len());
    assert!(model.positions.len() >= vertices);
    for normal in &model.normals {
        assert!((normal.length() - 1.0).abs() < 1e-6, "{normal}");
    }
    let after: Vec<_> = model.faces.iter().flatten().map(|&v| model.positions[v as usize]).collect();
    assert_eq!(before, after, "faces stay where they were");
    model
}

fn face_normal(model: &Model, face: usize) -> Vec3 {
    let [a, b, c] = model.faces[face].map(|v| model.positions[v as usize].as_dvec3());
    (b - a).cross(c - a).normalize().as_vec3()
}

fn cube(scale: f32) -> Model {
    let positions: Vec<_> =
        (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * scale).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces: Vec<_> = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    model(&positions, &faces)
}

#[test]
fn a_cube_gets_24_normals_at_any_scale() {
    for scale in [1e-38, 1e-30, 1.0, 1e30, 1e38] {
        let cube = filled(cube(scale));
        assert_eq!(cube.positions.len(), 24);
        for (f, face) in cube.faces.iter().enumerate() {
            for &v in face {
                assert!(cube.normals[v as usize].distance(face_normal(&cube, f)) < 1e-6);
            }
        }
    }
}

#[test]
fn a_cube_at_a_wide_crease_angle_is_smooth_and_its_triangulation_leaves_no_trace() {
    let mut cube = cube(1.0);
    fill_missing(&mut cube, 2.0);
    assert_eq!(cube.positions.len(), 8);
    for (p, n) in cube.positions.iter().zip(&cube.normals) {
        assert!(n.distance((*p - 0.5).normalize()) < 1e-6, "{n} at {p}");
    }
}

#[test]
fn splitting_copies_what_goes_with_a_vertex() {
    let mut cube = cube(1.0);
    cube.uvs = (0..8).map(|i| Vec2::splat(i as f32)).collect();
    cube.colors = (0..8).map(|i| Vec4::splat(i as f32)).collect();
    let cube = filled(cube);
    assert_eq!((cube.uvs.len(), cube.colors.len()), (24, 24));
    for (v, p) in cube.positions.iter().enumerate() {
        let i = p.x + 2.0 * p.y + 4.0 * p.z;
        assert_eq!((cube.uvs[v].x, cube.colors[v].x), (i, i));
    }
}

/// A sphere of `rows` by `2 * rows` quads, each with its own vertices.
fn sphere(rows: u32) -> Model {
    let at = |row: u32, column: u32| {
        let (polar, azimuth) = (
            std::f64::consts::PI * f64::from(row) / f64::from(rows),
            std::f64::consts::PI * f64::from(column % (2 * rows)) / f64::from(rows),
        );
        let ring = if row == 0 || row == rows { 0.0 } else { polar.sin() };
        glam::DVec3::new(ring * azimuth.sin(), polar.cos(), ring * azimuth.cos()).as_vec3()
    };
    let mut positions = Vec::new();
    let mut faces = Vec::new();
    for row in 0..rows {
        for column in 0..2 * rows {
            let first = positions.len() as u32;
            positions.extend([at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)]);
            faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }
    model(&positions, &faces)
}

#[test]
fn a_fine_sphere_has_nearly_its_own_normals_with_every_vertex_apart() {
    let sphere = sphere(64);
    let vertices = sphere.positions.len();
    let sphere = filled(sphere);
    assert_eq!(sphere.positions.len(), vertices, "nothing to split on a smooth surface");
    let worst = sphere.positions.iter().zip(&sphere.normals).map(|(p, n)| p.distance(*n)).fold(0.0, f32::max);
    assert!(worst < 2e-3, "{worst}");
}

#[test]
fn equal_positions_share_one_normal_whatever_the_sign_of_zero() {
    let positions = [
        Vec3::new(0.0, 0.0, 0.0),
        Vec3::new(1.0, 0.0, 0.1),
        Vec3::new(0.0, 1.0, 0.0),
        Vec3::new(-0.0, 0.0, -0.0),
        Vec3::new(-0.0, 1.0, -0.0),
        Vec3::new(-1.0, 0.0, 0.1),
    ];
    let tent = filled(model(&positions, &[[0, 1, 2], [3, 4, 5]]));
    assert_eq!(tent.positions.len(), 6);
    assert_eq!(tent.normals[0], tent.normals[3]);
    assert_eq!(tent.normals[2], tent.normals[4]);
    assert!(tent.normals[0].x.abs() < 1e-6);
}

/// A fold along the z axis that is flat at z = 0 and sharp at z = 4, as on a part with a fading crease.
fn wedge() -> Model {
    let mut positions = Vec::new();
    let mut faces = Vec::new();
    for i in 0..5 {
        let (z, height) = (i as f32, 0.5 * i as f32);
        positions.extend([Vec3::new(-1.0, -height, z), Vec3::new(0.0, 0.0, z), Vec3::new(1.0, -height, z)]);
        if i > 0 {
            let n = 3 * i as u32;
            faces.extend([[n - 3, n, n - 2], [n, n + 1, n - 2], [n - 2, n + 1, n - 1], [n + 1, n + 2, n - 1]]);
        }
    }
    model(&positions, &faces)
}

#[test]
fn a_crease_that_fades_splits_only_where_it_is_sharp() {
    let wedge = filled(wedge());
    let at = |z: f32| {
        let mut normals: Vec<Vec3> = Vec::new();
        for &v in wedge.faces.iter().flatten() {
            let n = wedge.normals[v as usize];
            if wedge.positions[v as usize] == Vec3::new(0.0, 0.0, z) && !normals.contains(&n) {
                normals.push(n);
            }
        }
        normals
    };
    assert_eq!(at(0.0).len(), 1, "{:?}", at(0.0));
    assert_eq!(at(4.0).len(), 2, "{:?}", at(4.0));
    assert!(at(4.0).iter().all(|n| n.x.abs() > 0.5));
    assert!(at(0.0)[0].y > 0.9);
}

#[test]
fn a_face_turned_over_gets_the_surface_s_normal_on_its_own_side() {
    let mut grid = model(
        &(0..9)
            .map(|i| Vec3::new((i % 3) as f32, 0.1 * (i % 3 == 1) as u32 as f32, (i / 3) as f32))
            .collect::<Vec<_>>(),
        &[],
    );
    for row in 0..2u32 {
        for column in 0..2u32 {
            let n = 3 * row + column;
            grid.faces.extend([[n, n + 3, n + 4], [n, n + 4, n + 1]]);
        }
    }
    grid.face_material = vec![0; 8];
    let straight = filled(grid.clone());
    for turned in 0..8 {
        let mut grid = grid.clone();
        grid.faces[turned].swap(1, 2);
        let grid = filled(grid);
        for (f, face) in grid.faces.iter().enumerate() {
            for &v in face {
                let there = grid.positions[v as usize];
                let expected = straight.normals[straight.positions.iter().position(|p| *p == there).unwrap()];
                let expected = if f == turned { -expected } else { expected };
                assert!(grid.normals[v as usize].distance(expected) < 1e-6, "{turned} {f}");
            }
        }
    }
}

#[test]
fn a_face_without_area_changes_nothing_and_keeps_no_faces_apart() {
    // Two quads that meet along x = 1. The side of the right one has a vertex in its middle, and a face of zero area
    // fills the gap.
    let positions = [
        Vec3::new(0.0, 0.0, 0.0),
        Vec3::new(1.0, 0.0, 0.0),
        Vec3::new(1.0, 2.0, 0.0),
        Vec3::new(0.0, 2.0, 0.0),
        Vec3::new(1.0, 1.0, 0.0),
        Vec3::new(2.0, 1.0, 0.2),
    ];
    let faces = [[0, 1, 2], [0, 2, 3], [1, 5, 4], [4, 5, 2], [1, 4, 2]];
    let mesh = filled(model(&positions, &faces));
    assert_eq!(mesh.positions.len(), 6);
    assert!(mesh.normals[1].x < -0.01 && mesh.normals[1].z > 0.9, "{}", mesh.normals[1]);
    assert!(mesh.normals[4].z > 0.9);

    // Only faces of zero area, one of them degenerated to a point.
    let flat = filled(model(&[Vec3::ZERO, Vec3::X, Vec3::X * 2.0], &[[0, 1, 2], [0, 0, 0], [1, 1, 2]]));
    assert_eq!(flat.positions.len(), 3);
}

#[test]
fn given_normals_stay_and_are_made_unit() {
    let mut cube = cube(1.0);
    cube.normals = vec![Vec3::new(0.0, 3e20, 4e20); 8];
    cube.normals[1] = Vec3::new(1e-40, 0.0, 0.0);
    cube.normals[7] = Vec3::new(f32::NAN, 0.0, 0.0);
    let cube = filled(cube);
    assert!(cube.normals[0].distance(Vec3::new(0.0, 0.6, 0.8)) < 1e-6);
    assert_eq!(cube.normals[1], Vec3::X);
    assert_eq!(cube.positions.len(), 10, "the one without is split in three");
}

#[test]
fn unit_normals_are_kept_bit_for_bit() {
    // Unit vectors up to f32 rounding: normalising these again would change the last bit of many.
    let normals: Vec<Vec3> = (0..1000)
        .map(|i| {
            let (sin, cos) = (2.4 * i as f32).sin_cos();
            Vec3::new(cos, sin, 0.002 * i as f32 - 1.0).normalize()
        })
        .collect();
    let mut mesh = model(&vec![Vec3::ZERO; normals.len()], &[]);
    mesh.normals = normals.clone();
    let bits = |normals: &[Vec3]| normals.iter().map(|n| n.to_array().map(f32::to_bits)).collect::<Vec<_>>();
    assert_eq!(bits(&filled(mesh).normals), bits(&normals));
}

#[test]
fn a_normal_is_missing_only_if_it_is_zero_or_not_finite() {
    // Every given normal is normalised, whatever its length; every missing one at a vertex without faces is +Y.
    let tiny = f32::from_bits(1);
    let cases = [
        (Vec3::new(tiny, 0.0, 0.0), Vec3::X),
        (Vec3::new(0.0, 0.0, -f32::MAX), Vec3::NEG_Z),
        (Vec3::new(0.0, -0.999, 0.0), Vec3::NEG_Y),
        (Vec3::new(1.001, 0.0, 0.0), Vec3::X),
        (Vec3::new(0.0, 3.0, -4.0), Vec3::new(0.0, 0.6, -0.8)),
        (Vec3::ZERO, Vec3::Y),
        (Vec3::new(-0.0, 0.0, -0.0), Vec3::Y),
        (Vec3::new(1.0, f32::INFINITY, 0.0), Vec3::Y),
        (Vec3::new(1.0, 0.0, f32::NEG_INFINITY), Vec3::Y),
        (Vec3::new(1.0, f32::NAN, 0.0), Vec3::Y),
    ];
    let mut mesh = model(&[Vec3::ZERO; 10], &[]);
    mesh.normals = cases.iter().map(|case| case.0).collect();
    let mesh = filled(mesh);
    for ((given, expected), normal) in cases.into_iter().zip(mesh.normals) {
        assert!(normal.distance(expected) < 1e-7, "{given}: {normal}");
    }
}

#[test]
fn unused_vertices_and_short_arrays_end_up_unit() {
    let mut mesh = model(&[Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE], &[[0, 1, 2]]);
    mesh.normals.clear();
    let mesh = filled(mesh);
    assert_eq!(mesh.normals[0], Vec3::Z);
    assert_eq!(filled(Model::default()), Model::default());
}

#[test]
fn triangles_of_one_polygon_are_never_parted() {
    // A quad that is folded by more than the crease angle along its diagonal.
    let positions = [Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0), Vec3::new(2.0, 0.0, 0.0), Vec3::new(1.0, 1.5, 1.0)];
    let mut quad = model(&positions, &[[0, 1, 2], [0, 2, 3]]);
    assert!(filled(quad.clone()).positions.len() > 4);
    quad.face_polygon = vec![0, 0];
    assert_eq!(filled(quad).positions.len(), 4);
}

#[test]
fn every_corner_of_a_polygon_has_the_polygon_s_normal_and_not_its_triangle_s() {
    // Disjoint non-planar pentagons, triangles and quads: 120 faces, more than one block.
    let corners =
        [(0.0, 0.0, 0.0), (2.0, 0.0, 0.5), (3.0, 1.0, 0.0), (1.0, 3.0, 1.0), (0.0, 2.0, 0.25)].map(Vec3::from);
    let (mut polygons, mut positions, mut faces) = (Vec::new(), Vec::new(), Vec::new());
    let mut face_polygon = Vec::new();
    for polygon in 0..60u32 {
        let (first, count) = (positions.len() as u32, 3 + polygon as usize % 3);
        let moved = Vec3::new(8.0 * polygon as f32, 0.0, 0.0);
        positions.extend(corners[..count].iter().map(|&corner| corner + moved));
        faces.extend((1..count as u32 - 1).map(|i| [first, first + i, first + i + 1]));
        face_polygon.resize(faces.len(), polygon);
        polygons.push(first as usize..positions.len());
    }
    let mut mesh = model(&positions, &faces);
    assert_eq!(mesh.faces.len(), 120);
    mesh.face_polygon = face_polygon;
    let mesh = filled(mesh);
    assert_eq!(mesh.positions, positions, "nothing is split");
    for polygon in polygons {
        // Newell's normal: the sum of the cross products of successive corners.
        let at = |i: usize| (positions[polygon.start + i % polygon.len()] - positions[polygon.start]).as_dvec3();
        let newell: glam::DVec3 = (0..polygon.len()).map(|i| at(i).cross(at(i + 1))).sum();
        for vertex in polygon {
            let normal = mesh.normals[vertex];
            assert!(normal.distance(newell.normalize().as_vec3()) < 1e-6, "{vertex}: {normal}");
        }
    }
}

#[test]
fn many_faces_at_one_position_and_at_one_edge_take_no_quadratic_time() {
    let n = 100_000u32;
    // A sharply pleated fan around one position, and a book whose pages share their spine.
    let rim: Vec<_> = (0..=n)
        .map(|i| {
            let angle = std::f32::consts::TAU * i as f32 / n as f32;
            Vec3::new(angle.cos(), (i % 2) as f32, angle.sin())
        })
        .collect();
    let positions: Vec<_> = [Vec3::ZERO, Vec3::Y].into_iter().chain(rim).collect();
    let fan: Vec<_> = (0..n).map(|i| [0, 2 + i + 1, 2 + i]).collect();
    let book: Vec<_> = (0..n).map(|i| [0, 1, 2 + i]).collect();
    filled(model(&positions, &fan));
    filled(model(&positions, &book));
}

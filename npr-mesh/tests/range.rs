//! Models of any scale and far from the origin give the same results as at scale 1.

use glam::{DVec3, Vec3};
use npr_mesh::edges::{self, EdgeOptions};
use npr_mesh::triangulate::triangulate;
use npr_mesh::{Model, embedded, normals, pn_triangles, subdivide, weld};

const SIZES: [f32; 8] = [1e-36, 1e-30, 1e-20, 1e-10, 1e10, 1e20, 1e30, 1e36];

/// The model without normals, scaled by a power of two near `size`, which is exact.
fn scaled(model: &Model, size: f32) -> Model {
    let factor = 2f32.powi(size.log2().round() as i32);
    Model {
        positions: model.positions.iter().map(|&p| p * factor).collect(),
        normals: vec![Vec3::ZERO; model.positions.len()],
        ..model.clone()
    }
}

fn models() -> [Model; 3] {
    [embedded::cube(), embedded::teapot(4), embedded::scene()]
}

#[test]
fn normals_are_those_at_size_1() {
    for model in models() {
        let mut at_1 = scaled(&model, 1.0);
        normals::fill_missing(&mut at_1, 0.8);
        for size in SIZES {
            let mut here = scaled(&model, size);
            normals::fill_missing(&mut here, 0.8);
            assert_eq!(here.faces, at_1.faces, "{size}");
            // Coordinates that are rounding errors of zero underflow at the small end.
            for (a, b) in here.normals.iter().zip(&at_1.normals) {
                assert!(a.distance(*b) < 1e-5, "{size}: {a} {b}");
            }
        }
    }
}

#[test]
fn edges_are_those_at_size_1() {
    let options = EdgeOptions::default();
    let find = |model: &Model| edges::find(&model.positions, &model.faces, &model.face_polygon, &[], &options);
    for model in models() {
        let at_1 = find(&model);
        for size in SIZES {
            let here = find(&scaled(&model, size));
            assert_eq!(here.edges, at_1.edges, "{size}");
            for (a, b) in here.face_normals.iter().zip(&at_1.face_normals) {
                assert!(a.distance(*b) < 1e-6, "{size}: {a} {b}");
            }
        }
    }
}

#[test]
fn welding_within_a_tolerance_is_that_at_size_1() {
    let model = embedded::teapot(4);
    let at_1 = weld::weld_within(&model.positions, 0.125);
    assert!(at_1.iter().enumerate().any(|(vertex, &stands_for)| vertex as u32 != stands_for));
    for size in SIZES {
        let factor = 2f32.powi(size.log2().round() as i32);
        let positions: Vec<Vec3> = model.positions.iter().map(|&p| p * factor).collect();
        assert_eq!(weld::weld_within(&positions, 0.125 * factor), at_1, "{size}");
    }
}

#[test]
fn polygons_are_cut_as_at_size_1() {
    let outline = |n: usize| -> Vec<Vec3> {
        let radius = |i: usize| 1.0 + 0.5 * (i * 7 % 5) as f64;
        let at = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
        (0..n).map(|i| (DVec3::new(at(i).cos(), at(i).sin(), 0.3 * at(i).cos()) * radius(i)).as_vec3()).collect()
    };
    for n in [4, 5, 6, 17, 200] {
        let corners = outline(n);
        let at_1 = triangulate(&corners);
        for size in SIZES {
            let factor = 2f32.powi(size.log2().round() as i32);
            let here: Vec<Vec3> = corners.iter().map(|&c| c * factor).collect();
            assert_eq!(triangulate(&here), at_1, "{n} corners, {size}");
        }
    }
}

#[test]
fn finer_meshes_stay_finite() {
    for size in SIZES {
        let mut model = scaled(&embedded::teapot(2), size);
        normals::fill_missing(&mut model, 0.8);
        for fine in [subdivide::subdivide_midpoint(&model), pn_triangles::tessellate(&model, 3).unwrap()] {
            assert!(fine.positions.iter().all(|p| p.is_finite()), "{size}");
            assert!(fine.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4), "{size}");
            let (low, high) = fine.bounds().unwrap();
            let (coarse_low, coarse_high) = model.bounds().unwrap();
            let extent = (coarse_high - coarse_low).max_element();
            assert!(((high - low).max_element() / extent - 1.0).abs() < 0.2, "{size}");
        }
    }
}

#[test]
fn a_small_model_far_from_the_origin_keeps_its_shape() {
    // At 1e7 positions are integers.
    let mut model = embedded::cube();
    let offset = Vec3::new(1e7, -1e7, 1e7);
    for position in &mut model.positions {
        *position = (*position * 8.0).round() + offset;
    }
    model.normals.fill(Vec3::ZERO);
    normals::fill_missing(&mut model, 0.5);
    for face in &model.faces {
        let corners = face.map(|v| model.positions[v as usize].as_dvec3());
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize().as_vec3();
        for &v in face {
            assert!(model.normals[v as usize].distance(normal) < 1e-6);
        }
    }
    let options = EdgeOptions::default();
    let found = edges::find(&model.positions, &model.faces, &model.face_polygon, &[], &options);
    let creases = found.edges.iter().filter(|e| found.dihedral_rad(e).is_some_and(|angle| angle > 1.5)).count();
    assert_eq!(creases, 12);
}

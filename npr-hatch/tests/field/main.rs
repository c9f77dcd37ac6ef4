//! Direction fields on surfaces with known principal directions, and on invalid meshes.

mod shapes;

use glam::{DVec3, Quat, Vec3};
use npr_hatch::HatchError;
use npr_hatch::field::{FieldOptions, LineTensor, PrincipalDirection, direction_field};
use oorandom::Rand32;
use proptest::prelude::*;
use shapes::*;

fn largest_difference(a: &[LineTensor], b: &[LineTensor]) -> f32 {
    assert_eq!(a.len(), b.len());
    let six = |t: &LineTensor| t.diagonal.into_iter().chain(t.others).collect::<Vec<_>>();
    let pairs = a.iter().flat_map(six).zip(b.iter().flat_map(six));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

fn around_axis(mesh: &Mesh) -> impl Fn(usize) -> Option<DVec3> {
    |i| Some(DVec3::Z.cross(mesh.normals[i].as_dvec3()))
}

fn projected_fallback(mesh: &Mesh, i: usize) -> DVec3 {
    FieldOptions::default().fallback.reject_from(mesh.normals[i]).as_dvec3()
}

#[test]
fn a_cylinder_has_strokes_around() {
    for (cells, stray) in [([12, 1], 0.0), ([12, 4], 0.3), ([64, 16], 0.0), ([64, 16], 0.3), ([200, 90], 0.4)] {
        let mesh = cylinder(cells, stray);
        // Randomly triangulated facets are slanted, and so are their tangent directions; their mean is compared.
        let faceted = mesh.faceted();
        let [largest, mean] = faceted.errors(&faceted.field(&FieldOptions::default()), around_axis(&faceted));
        assert!(mean < 2.0 && (largest < 2.0 || stray > 0.0), "{cells:?}, {stray}, facets: {largest}, {mean}");
        let [largest, _] = mesh.errors(&mesh.field(&FieldOptions::default()), around_axis(&mesh));
        assert!(largest < 2.0, "{cells:?}, {stray}: {largest}");
        let least = FieldOptions { principal: PrincipalDirection::Smaller, ..FieldOptions::default() };
        let [largest, _] = mesh.errors(&mesh.field(&least), |_| Some(DVec3::Z));
        assert!(largest < 2.0, "{cells:?}, {stray}, along: {largest}");
    }
}

/// The field is equal for inward normals and for any winding.
#[test]
fn normals_and_windings_may_point_inwards() {
    let mesh = cylinder([64, 16], 0.3);
    let inwards = mesh.map(|p| p, |n| -n);
    let mut mixed = mesh.clone();
    mixed.faces.iter_mut().step_by(3).for_each(|face| face.swap(0, 1));
    for mesh in [inwards, mixed] {
        let [largest, _] = mesh.errors(&mesh.field(&FieldOptions::default()), around_axis(&mesh));
        assert!(largest < 2.0, "{largest}");
    }
}

/// The tip is excluded where the smoothing length is no longer much shorter than the circumference.
#[test]
fn a_cone_has_strokes_around() {
    for (cells, stray) in [([24, 8], 0.0), ([64, 32], 0.0), ([64, 32], 0.3)] {
        let mesh = Mesh::patch(Cut { cells, closed: [true, false], stray }, |u, v| {
            (around(u) * (1.0 - 0.8 * v) + DVec3::Z * 2.0 * v, around(u) * 2.0 + DVec3::Z * 0.8)
        });
        let [largest, _] = mesh.errors(&mesh.field(&FieldOptions::default()), around_axis(&mesh));
        assert!(largest < 2.0, "{cells:?}, {stray}: {largest}");
    }
}

#[test]
fn a_thin_torus_has_strokes_around_its_tube() {
    for (cells, stray) in [([48, 16], 0.0), ([96, 32], 0.3)] {
        let mesh = torus(2.0, 0.5, cells, stray);
        for (mesh, limit) in [(&mesh, 2.0), (&mesh.faceted(), 5.0)] {
            let exact = |i: usize| Some(around_tube(mesh.parameters[i]).reject_from(mesh.normals[i].as_dvec3()));
            let [largest, _] = mesh.errors(&mesh.field(&FieldOptions::default()), exact);
            assert!(largest < limit, "{cells:?}, {stray}: {largest}");
        }
    }
}

/// On the inner side of a thick torus the curvature around its axis is larger from cos t = -major / (2 minor) on,
/// where the mean curvature is 0.
#[test]
fn a_thick_torus_has_both() {
    let (major, minor) = (1.0, 0.7);
    let mesh = torus(major, minor, [160, 112], 0.2);
    let field = mesh.field(&FieldOptions::default());
    let change = (-major / (2.0 * minor)).acos() / std::f64::consts::TAU;
    let from_inside = |i: usize| (mesh.parameters[i][1].rem_euclid(1.0) - 0.5).abs();
    let margin = 20.0 / 360.0;
    let outside = |i: usize| (from_inside(i) > 0.5 - change + margin).then(|| around_tube(mesh.parameters[i]));
    let inside = |i: usize| (from_inside(i) < 0.5 - change - margin).then(|| around(mesh.parameters[i][0] + 0.25));
    let (outside, inside) = (mesh.errors(&field, outside), mesh.errors(&field, inside));
    assert!(outside[0] < 5.0 && inside[0] < 5.0, "{outside:?}, {inside:?}");
}

#[test]
fn an_ellipsoid_has_its_lines_of_curvature() {
    let axes = DVec3::new(1.5, 1.0, 0.7);
    for (cells, stray) in [([64, 32], 0.0), ([128, 64], 0.25)] {
        let mesh = ellipsoid(axes, cells, stray);
        let exact = |i: usize| {
            let ([more, less], direction) = ellipsoid_curvature(axes, mesh.positions[i].as_dvec3());
            (less < 0.7 * more).then_some(direction)
        };
        let errors = mesh.errors(&mesh.field(&FieldOptions::default()), exact);
        assert!(errors[0] < 5.0 && errors[1] < 1.5, "{cells:?}, {stray}: {errors:?}");
    }
}

/// Positions are perturbed by 1 % of the tube's radius along each axis, normals by 1 % of their length.
#[test]
fn noise_of_a_percent_is_borne() {
    let mut random = Rand32::new(3);
    let mesh = torus(2.0, 0.5, [96, 32], 0.2);
    let mut noise = |size: f32| Vec3::from_array([(); 3].map(|()| (random.rand_float() * 2.0 - 1.0) * size));
    let mut noisy = mesh.clone();
    noisy.positions.iter_mut().for_each(|p| *p += noise(0.005));
    noisy.normals.iter_mut().for_each(|n| *n = (*n + noise(0.01)).normalize());
    let exact = |i: usize| Some(around_tube(mesh.parameters[i]));
    let [_, mean] = noisy.errors(&noisy.field(&FieldOptions::default()), exact);
    assert!(mean < 3.0, "{mean}");
    // Without smoothing the error is large.
    let rough = FieldOptions { smoothing: 0.0, ..FieldOptions::default() };
    let [_, without] = noisy.errors(&noisy.field(&rough), exact);
    assert!(without > mean, "{without}");
}

/// Bumps with a curvature above that of their cylinder but smaller than the smoothing length.
#[test]
fn bumps_are_no_form() {
    let (waves, height) = (44.0, 0.0008);
    let bend = height * f64::powi(waves, 2);
    assert!(bend > 1.5, "{bend}");
    let mesh = Mesh::patch(Cut { cells: [300, 96], closed: [true, false], stray: 0.0 }, |u, v| {
        let (a, z) = (u * std::f64::consts::TAU, 2.0 * v - 1.0);
        let ((sin_a, cos_a), (sin_z, cos_z)) = ((waves * a).sin_cos(), (waves * z).sin_cos());
        let radius = 1.0 + height * sin_a * sin_z;
        let [by_a, by_z] = [cos_a * sin_z, sin_a * cos_z].map(|wave| height * waves * wave);
        let ahead = around(u + 0.25);
        (around(u) * radius + DVec3::Z * z, around(u) - ahead * (by_a / radius) - DVec3::Z * by_z)
    });
    let [_, mean] = mesh.errors(&mesh.field(&FieldOptions::default()), around_axis(&mesh));
    assert!(mean < 4.0, "{mean}");
}

#[test]
fn a_plane_and_a_cube_have_the_fallback() {
    let cut = Cut { cells: [9, 5], closed: [false; 2], stray: 0.3 };
    let plane = Mesh::patch(cut, |u, v| (DVec3::new(u, 0.0, -v), DVec3::Y));
    let mut cube = Mesh::default();
    for normal in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]) {
        let right = DVec3::new(normal.z, normal.x, normal.y);
        let cut = Cut { cells: [3; 2], closed: [false; 2], stray: 0.0 };
        let up = normal.cross(right);
        cube.append(&Mesh::patch(cut, |u, v| (normal + right * (2.0 * u - 1.0) + up * (2.0 * v - 1.0), normal)));
    }
    let same = |a: &Vec3| cube.positions.iter().position(|b| a.distance(*b) < 1e-6).unwrap() as u32;
    cube.representative = cube.positions.iter().map(same).collect();
    for mesh in [plane, cube] {
        let [largest, _] = mesh.errors(&mesh.field(&FieldOptions::default()), |i| Some(projected_fallback(&mesh, i)));
        assert!(largest < 0.1, "{largest}");
    }
}

/// Except at its poles and at those of the fallback.
#[test]
fn a_sphere_has_the_fallback() {
    for (cells, stray) in [([64, 32], 0.0), ([128, 64], 0.2)] {
        let mesh = ellipsoid(DVec3::ONE, cells, stray);
        let exact = |i: usize| {
            let fallback = projected_fallback(&mesh, i);
            (mesh.positions[i].z.abs() < 0.95 && fallback.length() > 0.3).then_some(fallback)
        };
        let [largest, _] = mesh.errors(&mesh.field(&FieldOptions::default()), exact);
        assert!(largest < 10.0, "{cells:?}: {largest}");
    }
}

/// A stadium-shaped outline extruded along z: two half cylinders connected by two plates.
fn stadium(cells: [u32; 2], straight: f64) -> Mesh {
    let arc = std::f64::consts::PI;
    let total = 2.0 * (arc + straight);
    Mesh::patch(Cut { cells, closed: [true, false], stray: 0.0 }, |u, v| {
        let along = (u * total).rem_euclid(total);
        let (half, along) = if along < total / 2.0 { (1.0, along) } else { (-1.0, along - total / 2.0) };
        let turned = around((along - straight).max(0.0) / arc / 2.0 - 0.25);
        let x = along.min(straight) - straight / 2.0;
        ((turned + DVec3::X * x + DVec3::Z * 0.0) * half + DVec3::Z * (4.0 * v), turned * half)
    })
}

#[test]
fn flat_parts_take_on_their_neighbours_direction() {
    for cells in [[160, 40], [40, 10]] {
        let mesh = stadium(cells, 2.0);
        let exact = |i: usize| Some(DVec3::Z.cross(mesh.normals[i].as_dvec3()));
        let [largest, _] = mesh.errors(&mesh.field(&FieldOptions::default()), exact);
        assert!(largest < 3.0, "{largest}");
    }
    // Far from the cylinders, the fallback.
    let far = FieldOptions { smoothing: 0.002, ..FieldOptions::default() };
    let mesh = stadium([200, 40], 3.0);
    let middle = |i: usize| (mesh.positions[i].x.abs() < 0.2).then(|| projected_fallback(&mesh, i));
    let [largest, _] = mesh.errors(&mesh.field(&far), middle);
    assert!(largest < 3.0, "{largest}");
}

/// The transition to the fallback on a plate does not depend on the tessellation.
#[test]
fn the_tessellation_has_little_part_in_it() {
    let options = FieldOptions { smoothing: 0.008, ..FieldOptions::default() };
    let [coarse, fine] = [[60, 12], [240, 48]].map(|cells| stadium(cells, 6.0));
    let [coarse_field, fine_field] = [&coarse, &fine].map(|mesh| mesh.field(&options));
    let [largest, mean] = coarse.errors(&coarse_field, |i| {
        let (i, row) = (i as u32 % 60 * 4, i as u32 / 60 * 4);
        Some(fine_field[(row * 240 + i) as usize].direction().as_dvec3())
    });
    assert!(largest < 10.0 && mean < 2.0, "{largest}, {mean}");
    let [turned, _] = fine.errors(&fine_field, |i| Some(DVec3::Z.cross(fine.normals[i].as_dvec3())));
    assert!(turned > 20.0, "there is nothing to compare: {turned}");
}

#[test]
fn seams_do_not_tear() {
    let mesh = torus(1.0, 0.6, [48, 32], 0.25);
    let (welded, apart) = (mesh.field(&FieldOptions::default()), mesh.apart());
    let expected: Vec<_> = mesh.faces.iter().flatten().map(|&v| welded[v as usize]).collect();
    let difference = largest_difference(&expected, &apart.field(&FieldOptions::default()));
    assert!(difference < 1e-4, "{difference}");
}

#[test]
fn turning_and_scaling_the_model_turns_the_field() {
    let mesh = torus(2.0, 0.5, [48, 24], 0.2);
    let field = mesh.field(&FieldOptions::default());
    let turn = Quat::from_axis_angle(Vec3::new(1.0, 2.0, -0.5).normalize(), 1.1);
    let turned = mesh.map(|p| turn * p, |n| turn * n).field(&FieldOptions::default());
    let expected: Vec<_> = field.iter().map(|t| LineTensor::from_direction(turn * t.direction())).collect();
    assert!(largest_difference(&expected, &turned) < 1e-3, "{}", largest_difference(&expected, &turned));
    for scale in [1e-30, 1e-3, 1e6, 1e30] {
        let scaled = mesh.map(|p| p * scale, |n| n * 3.0).field(&FieldOptions::default());
        assert!(largest_difference(&field, &scaled) < 1e-3, "{scale}: {}", largest_difference(&field, &scaled));
    }
}

#[test]
fn missing_normals_are_made_up_for() {
    let mesh = torus(2.0, 0.5, [96, 48], 0.0);
    for missing in [Vec3::ZERO, Vec3::NAN, Vec3::splat(f32::INFINITY)] {
        let mesh = mesh.map(|p| p, |_| missing);
        let [largest, _] =
            mesh.errors(&mesh.field(&FieldOptions::default()), |i| Some(around_tube(mesh.parameters[i])));
        assert!(largest < 5.0, "{missing}: {largest}");
    }
}

#[test]
fn what_is_not_finite_does_not_spread() {
    let mesh = torus(2.0, 0.5, [48, 24], 0.0);
    let mut broken = mesh.clone();
    (broken.positions[100], broken.positions[500]) = (Vec3::NAN, Vec3::splat(f32::INFINITY));
    broken.normals[800] = Vec3::NAN;
    let field = broken.field(&FieldOptions::default());
    check_all(&broken, &field);
    let exact = |i: usize| (![100, 500].contains(&i)).then(|| around_tube(mesh.parameters[i]));
    let [largest, _] = broken.errors(&field, exact);
    assert!(largest < 3.0, "{largest}");
}

/// Two disconnected components do not affect each other.
#[test]
fn parts_are_fields_of_their_own() {
    let (small, mut both) = (torus(2.0, 0.5, [48, 24], 0.2), torus(2.0, 0.5, [48, 24], 0.2));
    both.append(&small.map(|p| p * 0.01, |n| n));
    let (alone, together) = (small.field(&FieldOptions::default()), both.field(&FieldOptions::default()));
    for part in together.chunks(alone.len()) {
        assert!(largest_difference(&alone, part) < 0.02, "{}", largest_difference(&alone, part));
    }
}

#[test]
fn nothing_is_no_error() {
    let none = direction_field(&[], &[], &[], &[], &FieldOptions::default()).unwrap();
    assert!(none.is_empty());
    // Without faces, and with a face of zero area.
    let positions = [Vec3::ZERO, Vec3::X, Vec3::X * 2.0, Vec3::NAN];
    let normals = [Vec3::Y, Vec3::ZERO, FieldOptions::default().fallback, Vec3::NAN];
    for faces in [&[][..], &[[0, 1, 2], [1, 1, 1], [0, 1, 3]]] {
        let field = direction_field(&positions, &normals, faces, &[0, 1, 2, 3], &FieldOptions::default()).unwrap();
        let fallback = FieldOptions::default().fallback;
        assert!(degrees(field[0].direction(), fallback.reject_from(Vec3::Y).as_dvec3()) < 0.1);
        assert!(degrees(field[1].direction(), fallback.as_dvec3()) < 0.1);
        assert!(field[2].direction().dot(normals[2]).abs() < 1e-5);
        assert!(degrees(field[3].direction(), fallback.as_dvec3()) < 0.1);
    }
}

#[test]
fn what_is_refused() {
    let (p, options) = ([Vec3::ZERO; 3], FieldOptions::default());
    let field = |n: usize, faces: &[[u32; 3]], r: &[u32], o: &FieldOptions| {
        direction_field(&p, &vec![Vec3::Y; n], faces, r, o).unwrap_err()
    };
    let error = field(2, &[], &[0, 1, 2], &options);
    assert!(matches!(error, HatchError::PerVertex { name: "normals", found: 2, vertices: 3 }), "{error}");
    let error = field(3, &[], &[0], &options);
    assert!(matches!(error, HatchError::PerVertex { name: "representative", found: 1, vertices: 3 }), "{error}");
    let error = field(3, &[[0, 1, 2], [0, 3, 2]], &[0, 1, 2], &options);
    assert!(matches!(error, HatchError::NoVertex { name: "faces", index: 1, vertex: 3, vertices: 3 }), "{error}");
    let error = field(3, &[], &[0, 1, u32::MAX], &options);
    assert!(matches!(error, HatchError::NoVertex { name: "representative", index: 2, .. }), "{error}");
    for smoothing in [-0.1, 1.1, f32::NAN] {
        let error = field(3, &[], &[0, 1, 2], &FieldOptions { smoothing, ..options });
        assert!(matches!(error, HatchError::Range { name: "smoothing", .. }), "{error}");
    }
    for fallback in [Vec3::ZERO, Vec3::NAN, Vec3::splat(f32::INFINITY)] {
        let error = field(3, &[], &[0, 1, 2], &FieldOptions { fallback, ..options });
        assert!(matches!(error, HatchError::Direction { .. }), "{error}");
    }
}

/// Finite, of trace 1 and rank 1, and tangent where there is a tangent plane.
fn check_all(mesh: &Mesh, field: &[LineTensor]) {
    assert_eq!(field.len(), mesh.positions.len());
    for (tensor, normal) in field.iter().zip(&mesh.normals) {
        let trace: f32 = tensor.diagonal.iter().sum();
        assert!((trace - 1.0).abs() < 1e-4 && tensor.others.iter().all(|x| x.is_finite()), "{tensor:?}");
        let direction = tensor.direction();
        assert!(largest_difference(&[*tensor], &[LineTensor::from_direction(direction)]) < 1e-4, "{tensor:?}");
        if let Some(normal) = normal.as_dvec3().try_normalize().filter(|n| n.is_finite()) {
            assert!(direction.as_dvec3().dot(normal).abs() < 1e-4, "{direction}, {normal}");
        }
    }
}

/// A coordinate, sometimes an extreme or invalid one.
fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        12 => -1.0_f32..1.0,
        4 => (-2..=2).prop_map(|x| x as f32),
        1 => prop::sample::select(vec![f32::NAN, f32::INFINITY, f32::MAX, f32::MIN_POSITIVE, -0.0, 1e-40, 1e20]),
    ]
}

fn vectors(count: usize) -> impl Strategy<Value = Vec<Vec3>> {
    prop::collection::vec([number(), number(), number()].prop_map(Vec3::from_array), count)
}

proptest! {
    #[test]
    fn any_soup_gives_tensors(
        (positions, normals, representative, faces, smoothing) in (1_usize..40).prop_flat_map(|n| {
            let index = || 0..n as u32;
            let faces = prop::collection::vec([index(), index(), index()], 0..60);
            (vectors(n), vectors(n), prop::collection::vec(index(), n), faces, 0.0_f32..=1.0)
        })
    ) {
        let mesh = Mesh { positions, normals, faces, representative, parameters: Vec::new() };
        let options = FieldOptions { smoothing, ..FieldOptions::default() };
        let field = mesh.field(&options);
        check_all(&mesh, &field);
        prop_assert_eq!(&field, &mesh.field(&options));
    }

    #[test]
    fn a_blend_has_the_direction_of_most(angle in 0.0_f32..6.3, apart in 0.1_f32..1.4, share in 0.55_f32..1.0) {
        // Two lines in a plane: the principal eigenvector of their blend is at the angle of the blended doubled
        // angles.
        let turn = Quat::from_axis_angle(Vec3::new(2.0, -1.0, 1.0).normalize(), angle);
        let line = |angle: f32| turn * Vec3::new(angle.cos(), angle.sin(), 0.0);
        let [a, b] = [line(0.0), line(apart)].map(LineTensor::from_direction);
        let blend = |a: [f32; 3], b: [f32; 3]| std::array::from_fn(|i| a[i] * share + b[i] * (1.0 - share));
        let blended = LineTensor { diagonal: blend(a.diagonal, b.diagonal), others: blend(a.others, b.others) };
        let doubled = f32::atan2((1.0 - share) * (2.0 * apart).sin(), share + (1.0 - share) * (2.0 * apart).cos());
        prop_assert!(degrees(blended.direction(), line(doubled / 2.0).as_dvec3()) < 0.1);
    }
}

#[test]
fn no_tensor_no_direction() {
    let tensor = |x: f32| LineTensor { diagonal: [x; 3], others: [0.0; 3] };
    assert_eq!(tensor(0.0).direction(), Vec3::ZERO);
    assert_eq!(tensor(f32::NAN).direction(), Vec3::ZERO);
    assert!((tensor(0.3).direction().length() - 1.0).abs() < 1e-6);
}

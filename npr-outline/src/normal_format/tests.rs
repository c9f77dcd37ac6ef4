#![allow(clippy::print_stdout)]

use super::*;
use npr_mesh::edges::{EdgeOptions, find};
use npr_mesh::embedded;

#[test]
fn round_trips_stay_within_the_formats_precision() {
    // Half a step in each number, over the shortest chord: snorm8 sqrt(3)/2/127 = 0.39°, its octahedral twin somewhat
    // more, since its grid is stretched by up to sqrt(3) and more towards the folds.
    for (format, bound_deg) in [
        (NormalFormat::F32, 1e-4),
        (NormalFormat::Snorm16, 0.00155),
        (NormalFormat::Snorm8, 0.4),
        (NormalFormat::Oct16, 0.0026),
        (NormalFormat::Oct8, 0.66),
    ] {
        let mut worst = 0.0f64;
        for direction in fibonacci_sphere(100_000) {
            let normal = direction.as_vec3().normalize();
            let back = format.quantised(normal).as_dvec3();
            let normal = normal.as_dvec3();
            worst = worst.max(normal.cross(back).length().atan2(normal.dot(back)).to_degrees());
        }
        println!("{format:?}: at most {worst:.6} degrees off");
        assert!(worst < bound_deg, "{format:?}: {worst}");
    }
}

#[test]
fn known_values() {
    let bytes = |format: NormalFormat, normal| {
        let mut bytes = Vec::new();
        format.encode(normal, &mut bytes);
        assert_eq!(bytes.len(), format.bytes_per_normal());
        bytes
    };
    assert_eq!(bytes(NormalFormat::Snorm8, Vec3::NEG_Y), [0, 0x81, 0, 0]);
    assert_eq!(bytes(NormalFormat::Snorm16, Vec3::X), [0xff, 0x7f, 0, 0, 0, 0, 0, 0]);
    assert_eq!(bytes(NormalFormat::Oct8, Vec3::Z), [0, 0]);
    assert_eq!(bytes(NormalFormat::Oct8, Vec3::X), [127, 0]);
    assert_eq!(bytes(NormalFormat::Oct8, Vec3::NEG_Z), [127, 127]);
    assert_eq!(bytes(NormalFormat::Oct16, Vec3::NEG_X), [0x01, 0x80, 0, 0]);
    assert_eq!(bytes(NormalFormat::F32, Vec3::X)[..4], 1f32.to_le_bytes());
    assert_eq!(NormalFormat::ALL.map(NormalFormat::bytes_per_fin), [192, 160, 128, 128, 112]);
}

#[test]
fn axes_and_zero_are_kept_exactly() {
    for format in NormalFormat::ALL {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::ZERO] {
            assert_eq!(format.quantised(axis), axis, "{format:?}");
            assert_eq!(format.quantised(-axis), -axis, "{format:?}");
        }
        // Directions about -z, where the corner for zero lies, are none of them zero.
        for direction in fibonacci_sphere(1000) {
            let near = Vec3::new(0.01 * direction.x as f32, 0.01 * direction.y as f32, -1.0).normalize();
            assert!(format.quantised(near).dot(near) > 0.99, "{format:?}");
        }
    }
}

#[test]
fn fewer_bits_misclassify_more_edges() {
    let models = [
        ("sphere", embedded::sphere(64)),
        ("torus", embedded::torus(1.0, 0.4, 64, 32)),
        ("teapot", embedded::teapot(8)),
        ("cylinder", embedded::cylinder(64)),
    ];
    for (name, model) in models {
        let edges =
            find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &EdgeOptions::default());
        let shares = NormalFormat::ALL.map(|format| misclassified_share(&model, &edges, format, 200));
        let planes = misclassified_share_of_planes(&model, &edges, 200).unwrap();
        println!("{name}: planes {planes:.1e}, {:?} {:?}", NormalFormat::ALL, shares.map(|s| format!("{s:.1e}")));
        let [f32, snorm16, snorm8, oct16, oct8] = shares;
        assert!(planes < 1e-5 && f32 < 1e-5, "{name}");
        assert!(snorm16 < 1e-3 && oct16 < 1e-3, "{name}");
        assert!(snorm8 > snorm16 && oct8 > oct16 && snorm8 < 0.05 && oct8 < 0.05, "{name}");
    }
}

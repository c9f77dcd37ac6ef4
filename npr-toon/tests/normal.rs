//! Light that is constant over faces and over pieces of faces.

mod device;

use approx::assert_abs_diff_eq;
use glam::DVec3;
use npr_toon::ToonError;
use npr_toon::normal::{MAX_DIVISIONS, NormalUse, toon_n_dot_l_across, toon_piece_centroid};

/// Points on a regular grid within a triangle, as barycentric coordinates.
fn points(count: u32) -> impl Iterator<Item = DVec3> {
    let place = move |i: u32, j: u32| {
        let (y, z) = ((f64::from(i) + 0.3) / f64::from(count), (f64::from(j) + 0.4) / f64::from(count));
        DVec3::new(1.0 - y - z, y, z)
    };
    (0..count).flat_map(move |i| (0..count - i).map(move |j| place(i, j))).filter(|weights| weights.x > 0.0)
}

#[test]
fn pieces_are_equal_parts_of_a_face() {
    for divisions in [1, 2, 3, 5, 8] {
        let mut pieces: Vec<(DVec3, usize)> = Vec::new();
        let mut count = 0;
        for weights in points(400) {
            let centroid = toon_piece_centroid(weights, divisions);
            assert_abs_diff_eq!(centroid.element_sum(), 1.0, epsilon = 1e-12);
            // No corner of a piece is farther from its centroid than two thirds of the piece's height.
            let farthest = (weights - centroid).abs().max_element() * f64::from(divisions);
            assert!(farthest <= 2.0 / 3.0 + 1e-9, "{weights}: {farthest}");
            // The centroid is a point of its own piece.
            assert!(toon_piece_centroid(centroid, divisions).abs_diff_eq(centroid, 1e-12));
            count += 1;
            match pieces.iter_mut().find(|piece| piece.0.abs_diff_eq(centroid, 1e-9)) {
                Some(piece) => piece.1 += 1,
                None => pieces.push((centroid, 1)),
            }
        }
        assert_eq!(pieces.len(), (divisions * divisions) as usize);
        // Of equal area: each contains its share of the points, up to those along its border.
        let share = f64::from(count) / f64::from(divisions * divisions);
        for (centroid, points) in pieces {
            assert!((points as f64 / share - 1.0).abs() < 0.06, "{divisions}, {centroid}: {points} of {share}");
        }
    }
}

#[test]
fn points_beside_a_face_belong_to_a_piece_of_it() {
    for weights in [[1.2, -0.1, -0.1], [-0.2, 0.6, 0.6], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]] {
        for divisions in [1, 3, MAX_DIVISIONS] {
            let centroid = toon_piece_centroid(DVec3::from_array(weights), divisions);
            assert!(centroid.min_element() > 0.0, "{weights:?}, {divisions}: {centroid}");
            // In the piece at the corner or side next to the point.
            let clamped = DVec3::from_array(weights).clamp(DVec3::ZERO, DVec3::ONE);
            assert!((centroid - clamped).abs().max_element() < 0.3 + 1.0 / f64::from(divisions), "{centroid}");
        }
    }
}

#[test]
fn a_face_has_one_light_and_pieces_approach_that_of_pixels() {
    let corners = [DVec3::new(-1.0, 0.0, 0.3), DVec3::new(1.0, 0.2, 0.0), DVec3::new(0.1, 1.5, -0.2)];
    let face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    // A point light, so that the pixels' vectors are those to the light; directions are then interpolated within a part in
    // a million of the truth.
    let light = DVec3::new(2000.0, 1000.0, 3000.0);
    let to_lights = corners.map(|corner| light - corner);
    let normals = [DVec3::new(-0.6, 0.0, 0.8), DVec3::new(0.6, 0.1, 0.9), DVec3::new(0.0, 0.7, 0.6)];
    let across = |normal_use, at: DVec3| toon_n_dot_l_across(normal_use, face, normals, to_lights, at.to_array());
    let centroid = corners.iter().sum::<DVec3>() / 3.0;
    let of_face = face.normalize().dot((light - centroid).normalize());
    let mut errors = Vec::new();
    for divisions in [1, 2, 4, 8, 16, MAX_DIVISIONS] {
        let error = |at| {
            assert_abs_diff_eq!(across(NormalUse::PerFace, at), of_face, epsilon = 1e-12);
            (across(NormalUse::PerSubdividedFace(divisions), at) - across(NormalUse::PerPixel, at)).abs()
        };
        errors.push(points(60).map(error).fold(0.0, f64::max));
    }
    // Halved with each doubling, since N·L is nearly linear within a piece.
    assert!(errors.windows(2).all(|pair| pair[1] < 0.7 * pair[0]), "{errors:?}");
    assert!(errors[5] < errors[0] / 30.0, "{errors:?}");
    // One division is the mean of the corners' normals.
    let mean = normals.iter().map(|normal| normal.normalize()).sum::<DVec3>();
    let one = mean.normalize().dot((light - centroid).normalize());
    assert_abs_diff_eq!(across(NormalUse::PerSubdividedFace(1), DVec3::X), one, epsilon = 1e-12);
}

#[test]
fn divisions_have_a_range() {
    assert_eq!(NormalUse::PerSubdividedFace(MAX_DIVISIONS).validate(), Ok(()));
    for divisions in [0, 65] {
        let error = ToonError::Divisions { divisions, max: 64 };
        assert_eq!(NormalUse::PerSubdividedFace(divisions).validate(), Err(error));
    }
}

#[test]
fn pieces_are_the_same_on_a_device() {
    let inputs: Vec<[f32; 4]> = [1u32, 2, 3, 4, 7, 64]
        .into_iter()
        .flat_map(|divisions| points(41).map(move |at| at.extend(f64::from(divisions)).as_vec4().to_array()))
        .collect();
    let expression = "vec4<f32>(toon_piece_centroid(a.xyz, u32(a.w)), 1.0)";
    let Some(outputs) = device::evaluate(npr_toon::WGSL, expression, &inputs) else { return };
    let mut apart = 0;
    for (&[x, y, z, divisions], output) in inputs.iter().zip(outputs) {
        let at = DVec3::new(x.into(), y.into(), z.into());
        let expected = toon_piece_centroid(at, divisions as u32);
        let actual = DVec3::new(output[0].into(), output[1].into(), output[2].into());
        if !actual.abs_diff_eq(expected, 1e-6) {
            // Next to a border between pieces, where rounding decides.
            apart += 1;
            assert!((actual - expected).abs().max_element() < 1.0 / f64::from(divisions), "{at}: {actual}, {expected}");
        }
    }
    assert!(apart * 200 < inputs.len(), "{apart} of {}", inputs.len());
}

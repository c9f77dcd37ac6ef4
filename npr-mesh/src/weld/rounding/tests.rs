use super::*;
use crate::weld::weld_within;
use glam::{Mat3, Quat};
use proptest::prelude::*;

/// Faces that use all vertices, without a face that has an area.
fn used(count: usize) -> Vec<[u32; 3]> {
    (0..count as u32).map(|vertex| [vertex; 3]).collect()
}

/// The largest distance, in units in the last place of the largest coordinate, of points that two patches have in common:
/// quarters of a tube of radius 1 that `turn` turns by right angles.
fn largest_gap_ulps(turn: impl Fn(Vec3, u32) -> Vec3, height: f32) -> f32 {
    let (mut gap, mut magnitude) = (0f32, 0f32);
    for quarter in 0..4 {
        for z in [-height, 0.3 * height, height] {
            let a = turn(Vec3::new(0.0, 1.0, z), quarter);
            let b = turn(Vec3::new(-1.0, 0.0, z), quarter + 1);
            gap = gap.max(a.distance(b));
            magnitude = magnitude.max(a.abs().max_element());
        }
    }
    gap / (magnitude * f32::EPSILON)
}

#[test]
fn what_is_near_by_rounding_is_one_vertex() {
    let tau = std::f64::consts::TAU;
    let seam = [(0.0f64, 1.0f64), (tau.sin(), tau.cos()), (0.0, -1.0)];
    let seam = seam.map(|(x, z)| Vec3::new(x as f32, 1.0, z as f32));
    assert_ne!(seam[0], seam[1]);
    assert_eq!(weld_rounding(&seam, &used(3)), [0, 0, 2]);
    let apart = [Vec3::ONE, Vec3::ONE * 1.00001, -Vec3::ONE];
    assert_eq!(weld_rounding(&apart, &used(3)), [0, 1, 2]);
    assert!(weld_rounding(&[], &[]).is_empty());
    assert_eq!(weld_rounding(&[Vec3::X; 3], &used(3)), [0, 0, 0]);
    assert_eq!(rounding_tolerance(&[Vec3::X; 3], &used(3)), 0.0);
    assert_eq!(rounding_tolerance(&[Vec3::X, Vec3::Y], &used(2)), 8.0 * f32::EPSILON);
}

#[test]
fn vertices_without_faces_do_not_raise_the_tolerance() {
    let positions =
        [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1e-5, 0.0), Vec3::splat(1e9), Vec3::NAN, Vec3::INFINITY];
    let faces = [[0, 1, 2], [0, 3, 2]];
    assert_eq!(rounding_tolerance(&positions, &faces), 8.0 * f32::EPSILON);
    assert_eq!(weld_rounding(&positions, &faces), [0, 1, 2, 3, 4, 5, 6]);
}

#[test]
fn far_from_the_origin_nothing_collapses() {
    // A box whose corners are two units in the last place apart, and one of which the coordinates are precise.
    for (offset, size) in [(8_388_608.0f32, 1.0f32), (500_000.0, 1.0), (1000.0, 1.0), (0.0, 1.0)] {
        let positions: Vec<Vec3> = (0..8u32)
            .map(|i| Vec3::splat(offset) + Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * size)
            .collect();
        let faces = [[0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5], [0, 1, 5], [0, 5, 4]];
        let welded = weld_rounding(&positions, &faces);
        assert!(welded.iter().enumerate().all(|(vertex, &first)| vertex as u32 == first), "{offset}: {welded:?}");
    }
}

#[test]
fn a_precise_detail_of_a_large_mesh_remains() {
    // A sheet of 2 km, and at its origin a triangle of a tenth of a millimetre, below the tolerance of the sheet.
    let sheet = [Vec3::new(-1000.0, 0.0, 0.0), Vec3::new(1000.0, 0.0, 0.0), Vec3::new(0.0, 1000.0, 0.0)];
    let detail = [Vec3::ZERO, Vec3::X * 1e-4, Vec3::Y * 1e-4];
    let positions = [sheet, detail].concat();
    let faces = [[0, 1, 2], [3, 4, 5]];
    assert!(rounding_tolerance(&positions, &faces) > 1.5e-4);
    assert_eq!(weld_rounding(&positions, &faces), [0, 1, 2, 3, 4, 5]);
    assert_eq!(weld_within(&positions, rounding_tolerance(&positions, &faces)), [0, 1, 2, 3, 3, 3]);
}

#[test]
fn a_sliver_within_rounding_collapses() {
    let eps = f32::EPSILON;
    let positions = [Vec3::X, Vec3::new(1.0, 2.0 * eps, 0.0), Vec3::Y, -Vec3::X];
    assert_eq!(weld_rounding(&positions, &[[0, 1, 2], [0, 2, 3]]), [0, 0, 2, 3]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn turned_patches_meet_within_the_tolerance(
        axis in (-1f32..1.0, -1f32..1.0, -1f32..1.0),
        angle in -4f32..4.0,
        height in 0.01f32..100.0,
        offset in (-3f32..3.0, -3f32..3.0, -3f32..3.0),
    ) {
        let axis = Vec3::from(axis).try_normalize().unwrap_or(Vec3::X);
        let quarter = |n: u32| -(n as f32) * std::f32::consts::FRAC_PI_2;
        let whole = Quat::from_axis_angle(axis, angle);
        let by_quaternion = |p: Vec3, n: u32| (whole * Quat::from_rotation_z(quarter(n))) * p;
        let by_two = |p: Vec3, n: u32| whole * (Quat::from_rotation_z(quarter(n)) * p);
        let by_matrix = |p: Vec3, n: u32| Mat3::from_quat(whole) * Mat3::from_rotation_z(quarter(n)) * p;
        let moved = |p: Vec3, n: u32| by_two(p, n) + Vec3::from(offset);
        let turns: [&dyn Fn(Vec3, u32) -> Vec3; 4] = [&by_quaternion, &by_two, &by_matrix, &moved];
        for turn in turns {
            let gap = largest_gap_ulps(turn, height);
            prop_assert!(gap < ROUNDING_ULPS, "{gap}");
        }
    }

    /// The faster search finds what the plain one finds.
    #[test]
    fn the_result_is_that_of_the_plain_search(
        places in prop::collection::vec((-3i32..4, -3i32..4, -3i32..4), 1..60),
        steps in prop::collection::vec((-9i32..10, -9i32..10, -9i32..10), 60),
        scale in prop::sample::select(vec![1e-38f32, 1e-30, 0.1, 1.0, 3.0, 1e30]),
    ) {
        // Near the corners of a coarse lattice, in steps of a third of the tolerance.
        let corners = [Vec3::splat(-3.0), Vec3::splat(3.0)];
        let positions: Vec<Vec3> = places
            .iter()
            .zip(&steps)
            .map(|(&(x, y, z), &(i, j, k))| {
                let place = Vec3::new(x as f32, y as f32, z as f32);
                place + Vec3::new(i as f32, j as f32, k as f32) * (8.0 * f32::EPSILON)
            })
            .chain(corners)
            .map(|p| p * scale)
            .collect();
        let faces = used(positions.len());
        let tolerance = rounding_tolerance(&positions, &faces);
        prop_assert_eq!(weld_rounding(&positions, &faces), weld_within(&positions, tolerance));
    }
}

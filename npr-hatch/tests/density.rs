//! Texel density on surfaces where it is known.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};
use npr_hatch::HatchError;
use npr_hatch::density::{OCTAVES, octaves};
use proptest::prelude::*;

/// A grid of cells over 0..=1 in both directions. Positions and texture coordinates are functions of the parameters.
fn grid(cells: u32, at: impl Fn(f32, f32) -> (Vec3, Vec2)) -> (Vec<Vec3>, Vec<Vec2>, Vec<[u32; 3]>, Vec<u32>) {
    let row = cells + 1;
    let share = |k: u32| k as f32 / cells as f32;
    let (positions, uvs): (Vec<_>, Vec<_>) = (0..row * row).map(|k| at(share(k % row), share(k / row))).unzip();
    let corner = |k: u32| k / cells * row + k % cells;
    let of_cell = |a: u32| [[a, a + 1, a + row + 1], [a, a + row + 1, a + row]];
    let faces = (0..cells * cells).map(corner).flat_map(of_cell).collect();
    (positions, uvs, faces, (0..row * row).collect())
}

#[test]
fn an_even_plane_has_one_value() {
    // A square of 6 by 6 with 2 tiles of the coordinates per side: 3 units of length per unit of the coordinates,
    // which is 12 tiles of 0.25.
    let (positions, uvs, faces, alone) =
        grid(8, |s, t| (Vec3::new(6.0 * s, 6.0 * t, 1.0), Vec2::new(2.0 * s, 2.0 * t)));
    let found = octaves(&positions, &uvs, &faces, &alone, 0.25).unwrap();
    let expected = 12_f32.log2();
    assert!(found.iter().all(|octave| (octave - expected).abs() < 1e-5), "{found:?}");
    // Mirrored coordinates have the same density.
    let mirrored: Vec<_> = uvs.iter().map(|uv| Vec2::new(-uv.x, uv.y)).collect();
    assert_eq!(octaves(&positions, &mirrored, &faces, &alone, 0.25).unwrap(), found);
    // The density is by area: a factor of four along one axis is one octave.
    let stretched: Vec<_> = positions.iter().map(|p| Vec3::new(4.0 * p.x, p.y, p.z)).collect();
    let stretched = octaves(&stretched, &uvs, &faces, &alone, 0.25).unwrap();
    assert!(stretched.iter().all(|octave| (octave - expected - 1.0).abs() < 1e-5));
}

#[test]
fn where_density_doubles_so_does_the_octave_in_between() {
    // On the right half a unit of the coordinates is half as long along both axes.
    let fold = |x: f32| if x > 0.5 { 2.0 * x - 0.5 } else { x };
    let (positions, uvs, faces, alone) = grid(32, |s, t| {
        let height = if s > 0.5 { 2.0 * t } else { t };
        (Vec3::new(s, t, 0.0), Vec2::new(fold(s), height))
    });
    let found = octaves(&positions, &uvs, &faces, &alone, 1.0).unwrap();
    // Except for the skewed faces in the column next to the middle.
    for (octave, position) in found.iter().zip(&positions) {
        if position.x < 0.35 {
            assert!(octave.abs() < 1e-5, "{position}: {octave}");
        } else if position.x > 0.7 {
            assert!((octave + 1.0).abs() < 1e-5, "{position}: {octave}");
        }
    }
    // In between it decreases in small steps.
    let row = &found[16 * 33..17 * 33];
    assert!(row.windows(2).all(|pair| pair[1] <= pair[0] + 1e-5), "{row:?}");
    assert!(row.windows(2).all(|pair| pair[1] > pair[0] - 0.5), "{row:?}");
}

/// A sphere of radius r with longitude and latitude over 0..=1: a unit of the coordinates is √(2π r · π r · cos
/// latitude).
#[test]
fn a_sphere_has_the_value_of_its_latitude() {
    let radius = 3.0;
    let (positions, uvs, faces, alone) = grid(64, |s, t| {
        let ((sin, cos), (up, out)) = ((s * TAU).sin_cos(), ((t - 0.5) * PI).sin_cos());
        (Vec3::new(out * cos, up, -out * sin) * radius, Vec2::new(s, t))
    });
    let found = octaves(&positions, &uvs, &faces, &alone, 0.5).unwrap();
    for (octave, uv) in found.iter().zip(&uvs) {
        let latitude = (uv.y - 0.5) * PI;
        if latitude.abs() < 60_f32.to_radians() {
            let expected = ((2.0 * latitude.cos()).sqrt() * PI * radius / 0.5).log2();
            // Vertices at the ends of the seam have more faces of one row than of the other, so the error is up to
            // the difference between rows.
            let limit = if uv.x == 0.0 || uv.x == 1.0 { 0.06 } else { 0.02 };
            assert!((octave - expected).abs() < limit, "{uv}: {octave}, {expected}");
        }
    }
    assert!(found.iter().all(|octave| octave.is_finite()));
}

/// Vertices with one representative and equal coordinates are merged; vertices with different coordinates belong to
/// separate islands.
#[test]
fn islands() {
    let (positions, uvs, faces, alone) = grid(6, |s, t| (Vec3::new(s * s, t, 0.0) * 3.0, Vec2::new(s, t)));
    let welded = octaves(&positions, &uvs, &faces, &alone, 0.1).unwrap();
    let corners: Vec<u32> = faces.iter().flatten().copied().collect();
    let of_corners: Vec<_> = corners.iter().map(|&v| positions[v as usize]).collect();
    let apart: Vec<_> = (0..faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
    let first: Vec<_> = corners.iter().map(|v| corners.iter().position(|w| v == w).unwrap() as u32).collect();
    let same: Vec<_> = corners.iter().map(|&v| uvs[v as usize]).collect();
    let found = octaves(&of_corners, &same, &apart, &first, 0.1).unwrap();
    for (&v, octave) in corners.iter().zip(&found) {
        assert!((octave - welded[v as usize]).abs() < 1e-5);
    }
    // Each face is an island with exactly its own value, although all faces touch.
    let shifted: Vec<_> = same.iter().zip(0..).map(|(uv, i)| *uv + Vec2::splat((i / 3) as f32 * 2.0)).collect();
    let found = octaves(&of_corners, &shifted, &apart, &first, 0.1).unwrap();
    for (octaves, face) in found.chunks(3).zip(&faces) {
        let [a, b, c] = face.map(|v| positions[v as usize]);
        let expected = (((b - a).cross(c - a).length() * 36.0).sqrt() / 0.1).log2();
        assert!(octaves.iter().all(|octave| (octave - expected).abs() < 1e-3), "{octaves:?}, {expected}");
    }
}

#[test]
fn without_area_there_is_no_density() {
    let (positions, uvs, faces, alone) = grid(4, |s, t| (Vec3::new(s, t, 0.0), Vec2::new(s, t)));
    assert!(octaves(&positions, &vec![Vec2::ZERO; uvs.len()], &faces, &alone, 0.5).unwrap().iter().all(|o| *o == 0.0));
    assert!(octaves(&vec![Vec3::X; uvs.len()], &uvs, &faces, &alone, 0.5).unwrap().iter().all(|o| *o == 0.0));
    assert!(octaves(&[], &[], &[], &[], 0.5).unwrap().is_empty());
    // Faces on the right are degenerate and adopt the value of the left. A vertex without faces has the median.
    let mut squeezed: Vec<_> = uvs.iter().map(|uv| Vec2::new(uv.x.min(0.5), uv.y)).collect();
    let (mut positions, mut alone) = (positions, alone);
    positions.push(Vec3::NAN);
    squeezed.push(Vec2::NAN);
    alone.push(25);
    let found = octaves(&positions, &squeezed, &faces, &alone, 0.5).unwrap();
    assert!(found.iter().all(|octave| (octave - 1.0).abs() < 1e-6), "{found:?}");
}

/// Vertices without a density adopt that of their neighbours, not the median of the model.
#[test]
fn values_spread() {
    let (mut positions, mut uvs, mut faces, _) = grid(8, |s, t| (Vec3::new(s, t, 0.0), Vec2::new(s.min(0.5), t)));
    let first = positions.len() as u32;
    let (more, coordinates, others, _) = grid(20, |s, t| (Vec3::new(s, t, 9.0), Vec2::new(s, t) / 8.0));
    positions.extend(more);
    uvs.extend(coordinates);
    faces.extend(others.iter().map(|face| face.map(|v| v + first)));
    let alone: Vec<_> = (0..positions.len() as u32).collect();
    let found = octaves(&positions, &uvs, &faces, &alone, 1.0).unwrap();
    let (one, other) = found.split_at(first as usize);
    assert!(one.iter().all(|octave| octave.abs() < 1e-5), "{one:?}");
    assert!(other.iter().all(|octave| (octave - 3.0).abs() < 1e-5), "{other:?}");
}

#[test]
fn what_is_refused() {
    let (p, uv) = ([Vec3::ZERO; 3], [Vec2::ZERO; 3]);
    let error = octaves(&p, &uv[..2], &[], &[0, 1, 2], 1.0).unwrap_err();
    assert!(matches!(error, HatchError::PerVertex { name: "uvs", found: 2, vertices: 3 }), "{error}");
    let error = octaves(&p, &uv, &[], &[0, 1, 2, 2], 1.0).unwrap_err();
    assert!(matches!(error, HatchError::PerVertex { name: "representative", found: 4, vertices: 3 }), "{error}");
    let error = octaves(&p, &uv, &[[0, 1, 9]], &[0, 1, 2], 1.0).unwrap_err();
    assert!(matches!(error, HatchError::NoVertex { name: "faces", index: 0, vertex: 9, vertices: 3 }), "{error}");
    for tile_length in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let error = octaves(&p, &uv, &[], &[0, 1, 2], tile_length).unwrap_err();
        assert!(matches!(error, HatchError::Range { name: "tile_length", .. }), "{error}");
    }
}

fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        8 => -1.0_f32..1.0,
        1 => prop::sample::select(vec![f32::NAN, f32::INFINITY, f32::MAX, f32::MIN_POSITIVE, -0.0, 1e-40, 1e20]),
    ]
}

proptest! {
    #[test]
    fn any_soup_gives_octaves_in_range(
        (positions, uvs, representative, faces, tile_length) in (1_usize..30).prop_flat_map(|n| {
            let index = || 0..n as u32;
            (
                prop::collection::vec([number(), number(), number()].prop_map(Vec3::from_array), n),
                prop::collection::vec([number(), number()].prop_map(Vec2::from_array), n),
                prop::collection::vec(index(), n),
                prop::collection::vec([index(), index(), index()], 0..40),
                prop::sample::select(vec![f32::MIN_POSITIVE, 1e-3, 1.0, f32::MAX]),
            )
        })
    ) {
        let found = octaves(&positions, &uvs, &faces, &representative, tile_length).unwrap();
        prop_assert_eq!(found.len(), positions.len());
        prop_assert!(found.iter().all(|octave| OCTAVES.contains(octave)), "{:?}", found);
    }
}

//! Tests of the tone and the stability of hatching.
//!
//! `cargo test --release -p npr-harness --test hatch_truth -- --ignored --nocapture` prints the tables.
#![allow(clippy::print_stdout)]

use glam::{DVec3, Vec2};
use npr_harness::camera::{Camera, Framing, Projection};
use npr_harness::capabilities::Capabilities;
use npr_harness::cpu::{self, CpuOptions};
use npr_harness::hatch::{HatchEncoding, HatchMap, HatchMapping, HatchShade, HatchTransfer};
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::truth::hatch::patch::{PatchTone, PatchView, TILE, TILE_BETWEEN, patch_tones, views};
use npr_harness::truth::hatch::sphere::{SEGMENTS, SphereError, sphere_error};
use npr_harness::truth::hatch::stability::{
    MOTIONS, Motion, Picture, Stability, TO_LIGHT, cameras, hatch_stability, on_the_picture, stability, with_moved_uvs,
};
use npr_harness::truth::hatch::{ENCODINGS, LINEAR, LISTING_4, LIT, MAPPINGS, black, hatched, strokes, torus_with_uvs};
use npr_harness::view::View;
use npr_mesh::embedded;
use npr_toon::normal::NormalUse;

/// The largest error of a flat patch's tone.
const MOST_TONE: f64 = 0.02;
/// The largest mean difference between frames, of 255.
const MOST_CHANGE: f64 = 4.0;
/// The map's side, in halves of the model's diagonal, except for patches.
const SIDE: f64 = 0.5;

fn steps(count: u32) -> Vec<f64> {
    (0..=count).map(|i| f64::from(i) / f64::from(count)).collect()
}

/// The largest error over all lights, per view.
fn worst(found: &[PatchTone]) -> PatchTone {
    *found.iter().max_by(|a, b| a.error().abs().total_cmp(&b.error().abs())).expect("there are lights")
}

type EachPatch<'a> = dyn FnMut(&str, PatchView, PatchTone) + 'a;

/// The largest error of each view for all encodings and mappings, and for coordinates between two scales, under
/// transfers with their own lights. `size` returns the picture's size for a distance.
fn patches(transfers: &[(HatchTransfer, Vec<f64>)], size: fn(f64) -> u32, least: usize, each: &mut EachPatch<'_>) {
    let map = strokes(1);
    for encoding in ENCODINGS {
        let mapped = MAPPINGS.map(|mapping| (mapping, TILE, ""));
        for (mapping, tile, between) in
            mapped.into_iter().chain([(HatchMapping::Coordinates, TILE_BETWEEN, " between")])
        {
            for (transfer, lights) in transfers {
                let shade = black(&map, encoding, mapping, *transfer, tile);
                let name = format!("{encoding:?} {mapping:?}{between} {transfer:?}");
                for view in views() {
                    let found =
                        patch_tones(&shade, view, lights, size(view.distance), least).expect("the shade is valid");
                    each(&name, view, worst(&found));
                }
            }
        }
    }
}

#[test]
#[ignore = "prints tables: minutes"]
fn table_of_patches() {
    for least in [4000, 1] {
        let mut rows: Vec<(String, PatchView, PatchTone)> = Vec::new();
        let transfers = [(LINEAR, steps(7)), (LISTING_4, steps(7))];
        patches(&transfers, |_| 400, least, &mut |name, view, tone| rows.push((name.to_owned(), view, tone)));
        println!("of at least {least} pixels:");
        for same in rows.chunk_by(|a, b| a.0 == b.0) {
            let row = same.iter().max_by(|a, b| a.2.error().abs().total_cmp(&b.2.error().abs())).expect("a chunk");
            let far: Vec<_> = same.iter().filter(|row| row.2.error().abs() > MOST_TONE).collect();
            println!("{}: {:+.4}, {:?}, {:?}; over 2 %: {far:.4?}", row.0, row.2.error(), row.1, row.2);
        }
    }
}

#[test]
fn flat_patches_have_the_tone_that_is_asked_for() {
    let mut held = 0;
    let transfers = [(LINEAR, [0.0, 2.0, 3.0, 5.0, 7.0].map(|i| i / 7.0).to_vec()), (LISTING_4, vec![0.0, 3.0 / 7.0])];
    // At large distances a tile has few pixels: 11 along its side in the larger picture.
    let size = |distance| if distance < 3.0 { 200 } else { 400 };
    patches(&transfers, size, 1500, &mut |name, view, tone| {
        assert!(tone.pixels > 500, "{name} {view:?}: {tone:?}");
        assert!(tone.error().abs() <= MOST_TONE, "{name} {view:?}: {tone:?}");
        held += 1;
    });
    // Both transfers and encodings, four mappings, 25 views.
    assert_eq!(held, 2 * 2 * 4 * 25);
}

/// Except for the noise of strokes, blocks have the correct tone on a fine mesh; on a coarse mesh they are more
/// accurate with light at pixels.
#[test]
fn spheres_have_the_tone_that_is_asked_for() {
    let maps: Vec<_> = (1..=2).map(strokes).collect();
    for encoding in ENCODINGS {
        let of = |segments, normals| sphere(&maps, encoding, HatchMapping::Form, segments, normals);
        let fine = of(96, NormalUse::PerPixel);
        assert!(fine.blocks > 50 && fine.bias.abs() <= 0.01, "{encoding:?}: {fine:?}");
        // The mean of two maps has the noise of one divided by √2, and the same bias.
        assert!(fine.mean_rms <= 1.25 * fine.noise / 2f64.sqrt() + 0.005, "{encoding:?}: {fine:?}");
        let [vertex, pixel] = [NormalUse::PerVertex, NormalUse::PerPixel].map(|normals| of(12, normals));
        assert!(vertex.mean_rms > pixel.mean_rms, "{encoding:?}: {vertex:?} {pixel:?}");
        assert!(vertex.bias < -0.01, "light at vertices cuts corners: {encoding:?}: {vertex:?}");
    }
}

fn sphere(
    maps: &[HatchMap],
    encoding: HatchEncoding,
    mapping: HatchMapping,
    segments: u32,
    normals: NormalUse,
) -> SphereError {
    let shades: Vec<_> = maps.iter().map(|map| black(map, encoding, mapping, LINEAR, SIDE)).collect();
    sphere_error(&shades, segments, normals, (640, 360)).expect("the shades are valid")
}

/// The number of ink borders per px along the rows and columns of a square that faces the eye.
fn borders(encoding: HatchEncoding, texel_px: f32, samples: u32) -> f64 {
    const SIDE_PX: u32 = 240;
    let shade = HatchShade { texel_px, ..black(&strokes(1), encoding, HatchMapping::Planes, LIT, SIDE) };
    let scene = Scene::new(embedded::cube());
    let projection = Projection::Orthographic { height: 1.5, far: 20.0 };
    let camera = Camera { eye: DVec3::Z * 5.0, target: DVec3::ZERO, up: DVec3::Y, projection, near: 0.1 };
    let style = hatched(&shade, NormalUse::PerPixel, DVec3::new(3f64.sqrt(), 0.0, 1.0));
    let view = View { samples, ..View::new(camera, (SIDE_PX, SIDE_PX)) };
    let plan = Plan::new(&scene, &style, &view, &Capabilities::RAY_CASTER).expect("a good style");
    let frame = cpu::render(&scene, &plan, &CpuOptions::default(), &|_| {});
    let is_ink = |x: u32, y: u32| frame.color[(y * SIDE_PX + x) as usize].x < 0.5;
    let mut count = 0;
    for y in 1..SIDE_PX {
        for x in 1..SIDE_PX {
            count += u32::from(is_ink(x, y) != is_ink(x - 1, y)) + u32::from(is_ink(x, y) != is_ink(x, y - 1));
        }
    }
    f64::from(count) / f64::from(SIDE_PX).powi(2)
}

#[test]
fn strokes_are_as_wide_as_their_texels_however_many_samples_there_are() {
    for encoding in ENCODINGS {
        let [one, double, sampled] = [(1.0, 1), (2.0, 1), (1.0, 2)].map(|(px, n)| borders(encoding, px, n));
        println!("{encoding:?}: {one:.4} borders a px; of texels of 2 px {double:.4}; of 2 x 2 samples {sampled:.4}");
        assert!((0.4..0.6).contains(&(double / one)), "{encoding:?}: {one}, twice as wide {double}");
        assert!((0.8..1.25).contains(&(sampled / one)), "{encoding:?}: {one}, of several samples {sampled}");
    }
}

#[test]
#[ignore = "prints tables: minutes"]
fn table_of_spheres() {
    let maps: Vec<_> = (1..=4).map(strokes).collect();
    for mapping in [HatchMapping::Planes, HatchMapping::Form] {
        for encoding in ENCODINGS {
            for normals in [NormalUse::PerVertex, NormalUse::PerPixel] {
                for segments in SEGMENTS {
                    let found = sphere(&maps, encoding, mapping, segments, normals);
                    println!(
                        "{mapping:?} {encoding:?} {normals:?} {segments}: without noise {:.4}, {found:.4?}",
                        found.bias_rms(4)
                    );
                }
            }
        }
    }
}

fn scenes() -> [(&'static str, Scene, Vec<HatchMapping>); 3] {
    let others = vec![HatchMapping::Planes, HatchMapping::Form];
    [
        ("torus", Scene::new(torus_with_uvs(96, 48)), MAPPINGS.to_vec()),
        ("sphere", Scene::new(embedded::sphere(64)), others.clone()),
        ("scene", Scene::new(embedded::scene()), others),
    ]
}

/// Front and side views, near and far, with the eye raised by 20°.
fn framings() -> [Framing; 3] {
    [(0.0, 1.0), (30.0, 1.0), (75.0, 2.0)].map(|(yaw_deg, distance)| Framing {
        yaw_rad: f64::to_radians(yaw_deg),
        distance,
        ..Framing::default()
    })
}

type EachStability<'a> = dyn FnMut(&str, HatchMapping, HatchEncoding, Motion, Stability) + 'a;

fn stabilities(framings: &[Framing], size: (u32, u32), each: &mut EachStability<'_>) {
    let map = strokes(1);
    for (name, scene, mappings) in scenes() {
        for mapping in mappings {
            for encoding in ENCODINGS {
                for motion in MOTIONS {
                    let shade = black(&map, encoding, mapping, LIT, SIDE);
                    for framing in framings {
                        let found = hatch_stability(&scene, &shade, framing, motion, size).expect("a valid shade");
                        each(name, mapping, encoding, motion, found);
                    }
                }
            }
        }
    }
}

/// Strokes that are fixed to the picture, and strokes shifted by a texel.
fn unstable(encoding: HatchEncoding, motion: Motion, size: (u32, u32)) -> [Stability; 2] {
    let model = torus_with_uvs(96, 48);
    let shade = black(&strokes(1), encoding, HatchMapping::Coordinates, LIT, SIDE);
    let style = hatched(&shade, NormalUse::PerPixel, TO_LIGHT);
    let still = Scene::new(model.clone());
    let [before, after] = cameras(&still, &Framing::default(), motion, f64::from(size.0) / f64::from(size.1));
    let compared = |first: &Scene, second: &Scene| {
        let of = |scene, camera| Picture { scene, style: &style, camera };
        stability(of(first, &before), of(second, &after), size).expect("the shade is valid")
    };
    let [first, second] = [&before, &after].map(|camera| Scene::new(on_the_picture(&model, camera, size)));
    // One texel of the finest level.
    let moved = Scene::new(with_moved_uvs(&model, Vec2::new(0.0, 1.0 / 256.0)));
    [compared(&first, &second), compared(&still, &moved)]
}

#[test]
#[ignore = "prints tables: minutes"]
fn table_of_stability() {
    let mut worst: Vec<(String, f64)> = Vec::new();
    stabilities(&framings(), (640, 360), &mut |name, mapping, encoding, motion, found| {
        println!("{name} {mapping:?} {encoding:?} {motion:?}: {found:.3?}");
        let key = format!("{mapping:?} {encoding:?} {motion:?}");
        match worst.iter_mut().find(|row| row.0 == key) {
            Some(row) => row.1 = row.1.max(found.mean),
            None => worst.push((key, found.mean)),
        }
    });
    for (key, mean) in worst {
        println!("largest of all models, {key}: {mean:.3}");
    }
    for encoding in ENCODINGS {
        for motion in MOTIONS {
            let [on_the_picture, moved] = unstable(encoding, motion, (640, 360));
            println!("{encoding:?} {motion:?} on the picture: {on_the_picture:.3?}");
            println!("{encoding:?} {motion:?} moved by a texel: {moved:.3?}");
        }
    }
}

#[test]
fn strokes_stay_where_they_are() {
    let mut cases = 0;
    stabilities(&[Framing::default()], (240, 135), &mut |name, mapping, encoding, motion, found| {
        let case = format!("{name} {mapping:?} {encoding:?} {motion:?}: {found:?}");
        assert!(found.pixels > 1000, "{case}");
        assert!(found.mean <= MOST_CHANGE, "{case}");
        assert!(found.tone.abs() <= 1.0, "{case}");
        // Pictures of different sizes have different mip levels, so no difference at all would mean that nothing was
        // compared.
        assert!(found.mean > 0.05, "{case}");
        cases += 1;
    });
    assert_eq!(cases, (3 + 2 + 2) * 4);
}

#[test]
fn strokes_that_do_not_stay_are_found_out() {
    for encoding in ENCODINGS {
        for motion in MOTIONS {
            let found = unstable(encoding, motion, (240, 135));
            for found in found {
                assert!(found.mean > 2.0 * MOST_CHANGE, "{encoding:?} {motion:?}: {found:?}");
            }
        }
    }
}

//! Whether hatching has the tone that is asked for, and stays where it is.
//!
//! `cargo test --release -p npr-harness --test hatch_truth -- --ignored --nocapture` prints the tables.
#![allow(clippy::print_stdout)]

use glam::Vec2;
use npr_harness::hatch_truth::patch::{PatchTone, PatchView, TILE, patch_tones, views};
use npr_harness::hatch_truth::sphere::{SEGMENTS, SphereError, sphere_error};
use npr_harness::hatch_truth::stability::{
    MOTIONS, Motion, Picture, Stability, TO_LIGHT, cameras, hatch_stability, on_the_picture, stability, with_moved_uvs,
};
use npr_harness::hatch_truth::{ENCODINGS, LINEAR, LISTING_4, MAPPINGS, black, hatched, strokes, torus_with_uvs};
use npr_harness::scene::Scene;
use npr_harness::style::{HatchEncoding, HatchMap, HatchMapping};
use npr_mesh::embedded;
use npr_toon::normal::NormalUse;

/// Of a flat patch's tone.
const MOST_TONE: f64 = 0.02;
/// Of 255, from one frame to the next.
const MOST_CHANGE: f64 = 4.0;
/// The map's side, in halves of the model's diagonal, in all but patches.
const SIDE: f64 = 0.5;

fn steps(count: u32) -> Vec<f64> {
    (0..=count).map(|i| f64::from(i) / f64::from(count)).collect()
}

/// The largest error over lights, view by view.
fn worst(found: &[PatchTone]) -> PatchTone {
    *found.iter().max_by(|a, b| a.error().abs().total_cmp(&b.error().abs())).expect("there are lights")
}

fn patches(map: &HatchMap, lights: &[f64], size: u32, each: &mut dyn FnMut(&str, PatchView, &[PatchTone])) {
    for encoding in ENCODINGS {
        for mapping in MAPPINGS {
            for transfer in [LINEAR, LISTING_4] {
                let shade = black(map, encoding, mapping, transfer, TILE);
                let name = format!("{encoding:?} {mapping:?} {transfer:?}");
                for view in views() {
                    each(&name, view, &patch_tones(&shade, view, lights, size).expect("the shade is valid"));
                }
            }
        }
    }
}

#[test]
#[ignore = "prints tables: minutes"]
fn table_of_patches() {
    let mut rows: Vec<(String, PatchView, PatchTone)> = Vec::new();
    patches(&strokes(1), &steps(14), 400, &mut |name, view, found| {
        let worst = worst(found);
        println!("{name}, {view:?}: {:+.4} at {:.3} ({} px)", worst.error(), worst.light, worst.pixels);
        rows.push((name.to_owned(), view, worst));
    });
    rows.sort_by(|a, b| a.0.cmp(&b.0).then(b.2.error().abs().total_cmp(&a.2.error().abs())));
    println!("largest:");
    for (at, row) in rows.iter().enumerate() {
        if at == 0 || rows[at - 1].0 != row.0 {
            let far = rows.iter().filter(|other| other.0 == row.0 && other.2.error().abs() > MOST_TONE).count();
            println!("{}: {:+.4} at {:.3}, {:?}; over 2 %: {far} views", row.0, row.2.error(), row.2.light, row.1);
        }
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

fn stabilities(size: (u32, u32), each: &mut dyn FnMut(&str, HatchMapping, HatchEncoding, Motion, Stability)) {
    let map = strokes(1);
    for (name, scene, mappings) in scenes() {
        for mapping in mappings {
            for encoding in ENCODINGS {
                for motion in MOTIONS {
                    let shade = black(&map, encoding, mapping, LINEAR, SIDE);
                    let found = hatch_stability(&scene, &shade, motion, size).expect("the shade is valid");
                    each(name, mapping, encoding, motion, found);
                }
            }
        }
    }
}

/// Strokes that lie on the picture, and strokes that are moved by a texel.
fn unstable(encoding: HatchEncoding, motion: Motion, size: (u32, u32)) -> [Stability; 2] {
    let model = torus_with_uvs(96, 48);
    let shade = black(&strokes(1), encoding, HatchMapping::Coordinates, LINEAR, SIDE);
    let style = hatched(&shade, NormalUse::PerPixel, TO_LIGHT);
    let still = Scene::new(model.clone());
    let [before, after] = cameras(&still, motion, f64::from(size.0) / f64::from(size.1));
    let compared = |first: &Scene, second: &Scene| {
        let of = |scene, camera| Picture { scene, style: &style, camera };
        stability(of(first, &before), of(second, &after), size).expect("the shade is valid")
    };
    let [first, second] = [&before, &after].map(|camera| Scene::new(on_the_picture(&model, camera, size)));
    // A texel of the finest level.
    let moved = Scene::new(with_moved_uvs(&model, Vec2::new(0.0, 1.0 / 256.0)));
    [compared(&first, &second), compared(&still, &moved)]
}

#[test]
#[ignore = "prints tables: minutes"]
fn table_of_stability() {
    stabilities((640, 360), &mut |name, mapping, encoding, motion, found| {
        println!("{name} {mapping:?} {encoding:?} {motion:?}: {found:.3?}");
    });
    for encoding in ENCODINGS {
        for motion in MOTIONS {
            let [on_the_picture, moved] = unstable(encoding, motion, (640, 360));
            println!("{encoding:?} {motion:?} on the picture: {on_the_picture:.3?}");
            println!("{encoding:?} {motion:?} moved by a texel: {moved:.3?}");
        }
    }
}

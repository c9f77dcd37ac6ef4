//! Accuracy of antialiased borders and per-pixel normals against supersampled references.
#![allow(clippy::print_stdout)]

mod common;

use common::shared_models;
use npr_harness::camera::{Camera, Framing};
use npr_harness::scene::Scene;
use npr_harness::truth::bands::{BandAccuracy, band_accuracy, white};
use npr_harness::truth::normal_use::{SEGMENTS, USES, normal_use_errors};
use npr_mesh::{Model, embedded};
use npr_toon::Bands;
use npr_toon::normal::NormalUse;

/// Relative to the hard borders' error and flicker.
const MOST_ERROR: f64 = 0.25;
const MOST_FLICKER: f64 = 1.0 / 3.0;

fn measured(name: &str, model: &Model, size: (u32, u32), samples: u32) -> [BandAccuracy; 2] {
    let scene = Scene::new(white(model));
    let framing = Framing { yaw_rad: 30f64.to_radians(), pitch_rad: 20f64.to_radians(), ..Framing::default() };
    let camera = Camera::framed(scene.corners(), f64::from(size.0) / f64::from(size.1), &framing);
    let found = band_accuracy(&scene, &camera, size, &Bands::default(), samples).expect("the bands are valid");
    for (place, found) in ["away from silhouettes", "and from creases"].into_iter().zip(&found) {
        println!(
            "{name}, {place}, {samples} samples: {} pixels, of the hard ones': error {:.3}, flicker {:.3}, change {:.3}; {found:?}",
            found.pixels,
            found.rmse_ratio(),
            found.excess_ratio(),
            found.change_ratio()
        );
    }
    found
}

#[test]
fn antialiased_borders_err_and_flicker_less_than_hard_ones() {
    for (name, model) in [("sphere", embedded::sphere(64)), ("torus", embedded::torus(1.0, 0.4, 96, 48))] {
        let [found, _] = measured(name, &model, (150, 100), 1);
        assert!(found.pixels > 10_000 && found.rmse[0] > 0.02, "{name}: {found:?}");
        assert!(found.rmse_ratio() < MOST_ERROR, "{name}: {found:?}");
        assert!(found.excess_ratio() < MOST_FLICKER, "{name}: {found:?}");
        // The sum of a border's changes does not depend on how it is drawn.
        assert!((found.change_ratio() - 1.0).abs() < 0.05, "{name}: {found:?}");
        assert!((found.change[2] / found.change[0] - 1.0).abs() < 0.05, "{name}: {found:?}");
    }
}

#[test]
fn borders_on_real_models() {
    let Some(folder) = shared_models() else { return };
    let load = |file: &str| npr_mesh::load(&folder.join(file), &Default::default()).expect("it loads").into_model();
    let [found, _] = measured("spot", &load("spot.obj"), (240, 135), 1);
    assert!(found.rmse_ratio() < MOST_ERROR && found.excess_ratio() < MOST_FLICKER, "{found:?}");
    // Where parts of the model intersect, one tone ends at another without a band border to smooth.
    let teapot = load("teapot.obj");
    let [_, found] = measured("teapot", &teapot, (240, 135), 1);
    assert!(found.rmse_ratio() < MOST_ERROR && found.excess_ratio() < MOST_FLICKER, "{found:?}");
    // Supersampling also smooths those, and curvature within a pixel.
    for (name, model) in [("teapot", teapot), ("bunny", load("stanford-bunny.obj"))] {
        let [found, _] = measured(name, &model, (160, 90), 2);
        assert!(found.rmse_ratio() < MOST_ERROR && found.excess_ratio() < MOST_FLICKER, "{name}: {found:?}");
    }
}

/// Prints a table of docs/accuracy.md.
#[test]
#[ignore = "a table: minutes, and 3 GB of memory"]
fn table_of_borders() {
    let Some(folder) = shared_models() else { return };
    for name in ["stanford-bunny.obj", "teapot.obj", "spot.obj"] {
        let model = npr_mesh::load(&folder.join(name), &Default::default()).expect("it loads").into_model();
        for samples in [1, 2] {
            measured(name, &model, (640, 360), samples);
        }
    }
}

#[test]
fn unit_normals_err_least_and_all_err_less_on_finer_meshes() {
    let errors = normal_use_errors((240, 135)).expect("pictures");
    for error in &errors {
        println!("{error:?}");
    }
    assert_eq!(errors.len(), SEGMENTS.len() * USES.len());
    let of = |segments, normals| {
        errors.iter().find(|e| e.segments == segments && e.normals == normals).expect("it is measured").rmse
    };
    for shade in 0..2 {
        for normals in USES {
            let error = SEGMENTS.map(|segments| of(segments, normals)[shade]);
            assert!(error.is_sorted_by(|coarse, fine| fine < coarse), "{normals:?}: {error:?}");
        }
        for segments in [4, 8, 16] {
            let [face, halves, eighths, vertex, interpolated, pixel] = USES.map(|normals| of(segments, normals)[shade]);
            assert!(pixel < interpolated && interpolated < vertex, "{segments}: {vertex} {interpolated} {pixel}");
            assert!(eighths < halves && halves < face, "{segments}: {face} {halves} {eighths}");
            // Where tones are continuous, the error of a coarse shape hides what eighths add to it.
            assert!(pixel < eighths || shade == 1, "{segments}: {eighths} {pixel}");
        }
    }
    assert_eq!(USES[5], NormalUse::PerPixel);
}

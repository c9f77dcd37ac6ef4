//! Comparison of shadows on the GPU with shadow rays, and of shadow outlines with shadow borders.
#![cfg(feature = "gpu")]
#![allow(clippy::print_stdout)]

mod common;

use common::{device, planned, rendered, shared_models};
use glam::DVec2;
use npr_harness::check::SIZE as SIZE_OF_CHECK;
use npr_harness::cpu::{self, CpuOptions};
use npr_harness::executor::Executor;
use npr_harness::gallery::still_life_camera;
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::shadow::VolumeMethod;
use npr_harness::shadow::{ShadowLines, ShadowMethod};
use npr_harness::style::styles;
use npr_harness::truth::shadows::{
    ShadowShot, States, eye_is_in_shadow, farthest_px, line_accuracy, shots, states_on_device, true_borders,
};
use npr_imagespace::shadow::ShadowState;
use npr_mesh::{Model, embedded};

const SIZE: (u32, u32) = (320, 180);
/// The picture size of the tables, px.
const TABLE_SIZE: (u32, u32) = SIZE_OF_CHECK;
const WITHIN_PX: f64 = 1.5;

fn aspect() -> f64 {
    f64::from(SIZE.0) / f64::from(SIZE.1)
}

fn on_device(
    executor: &Executor,
    scene: &Scene,
    shot: &ShadowShot,
    method: ShadowMethod,
    volumes: Option<VolumeMethod>,
    size: (u32, u32),
) -> States {
    let Executor::Gpu(context) = executor else { panic!("a device") };
    states_on_device(context, scene, shot, method, volumes, size).expect("states")
}

/// Compares the states by volumes with rays for all shots of a model, and counts the pixels in each state.
fn assert_masks(executor: &Executor, name: &str, model: Model) {
    let scene = Scene::new(model);
    let mut cast = 0;
    for shot in shots(&scene, aspect()) {
        let reference = States::by_rays(&scene, &shot, SIZE, DVec2::ZERO).expect("a picture");
        let actual = on_device(executor, &scene, &shot, ShadowMethod::Volumes, None, SIZE);
        let mut found = actual.difference(&reference);
        found.farthest_px = farthest_px(&scene, &shot, &actual, &reference).expect("pictures");
        let inside = eye_is_in_shadow(&scene, &shot);
        println!(
            "{name:20} {:16} {:.5} % differ, farthest {:.1} px{}",
            shot.name,
            found.share * 100.0,
            found.farthest_px,
            if inside { ", the eye in shadow" } else { "" }
        );
        assert!(found.share <= 1e-3 && found.farthest_px <= 2.0, "{name} {}: {found:?}", shot.name);
        cast += reference.states.iter().filter(|&&state| state == Some(ShadowState::Cast)).count();
    }
    assert!(cast > 100, "{name}: {cast} pixels in a cast shadow say nothing");
}

#[test]
fn volumes_darken_what_rays_find_dark() {
    let Some(executor) = device() else { return };
    assert_masks(&executor, "built-in scene", embedded::scene());
}

#[test]
fn the_eye_stands_in_the_shadow_where_it_is_to() {
    let scene = Scene::new(embedded::scene());
    let shots = shots(&scene, aspect());
    assert_eq!(shots.len(), 8);
    let inside = shots.iter().filter(|shot| eye_is_in_shadow(&scene, shot));
    assert!(inside.count() >= 2);
}

#[test]
fn the_device_sorts_out_what_casts_as_the_scan_does() {
    let Some(executor) = device() else { return };
    let scene = Scene::new(embedded::scene());
    for shot in shots(&scene, aspect()).iter().take(5) {
        let [there, here] = [VolumeMethod::OnDevice, VolumeMethod::OnCpu]
            .map(|volumes| on_device(&executor, &scene, shot, ShadowMethod::Volumes, Some(volumes), SIZE));
        assert!(there == here, "{}", shot.name);
    }
}

/// Prints a table of docs/accuracy.md.
#[test]
#[ignore = "a table: minutes"]
fn table_of_masks_and_lines() {
    let Some(executor) = device() else { return };
    let wanted =
        ["stanford-bunny.obj", "teapot.obj", "fandisk.obj", "CesiumMilkTruck.glb", "suzanne.obj", "beetle-alt.obj"];
    let mut models = vec![("built-in scene".to_owned(), embedded::scene())];
    if let Some(folder) = shared_models() {
        let load = |name: &str| npr_mesh::load(&folder.join(name), &Default::default()).expect("it loads").into_model();
        models.extend(wanted.map(|name| (name.to_owned(), load(name))));
    }
    for (name, model) in models {
        let scene = Scene::new(model);
        for shot in shots(&scene, aspect()) {
            let reference = States::by_rays(&scene, &shot, TABLE_SIZE, DVec2::ZERO).expect("a picture");
            let actual = on_device(&executor, &scene, &shot, ShadowMethod::Volumes, None, TABLE_SIZE);
            let volumes = actual.difference(&reference);
            let farthest = farthest_px(&scene, &shot, &actual, &reference).expect("pictures");
            let style = shot.style(ShadowMethod::Volumes);
            let picture = rendered(&executor, &scene, &style, &shot.camera, TABLE_SIZE);
            let borders = true_borders(&scene, &shot, &style, TABLE_SIZE, 4).expect("borders");
            let lines = line_accuracy(&picture, &borders, WITHIN_PX);
            println!(
                "{name:22} {:16} volumes {:.4} %, {:.1} px, {:.1} away from contours{}; lines P {:.3} R {:.3} of {:?}",
                shot.name,
                volumes.share * 100.0,
                volumes.farthest_px,
                farthest,
                if eye_is_in_shadow(&scene, &shot) { ", eye in shadow" } else { "" },
                lines.precision,
                lines.recall,
                lines.counts,
            );
        }
    }
}

/// A ball lit from the side: half of it is back-facing, but there is no shadow line on it and nothing to cast a shadow
/// on.
#[test]
fn a_terminator_has_no_line() {
    let scene = Scene::new(embedded::sphere(48));
    for shot in shots(&scene, aspect()) {
        let style = shot.style(ShadowMethod::Volumes);
        let frame = cpu::render(&scene, &planned(&scene, &style, &shot.camera, SIZE), &CpuOptions::default(), &|_| {});
        let states = States::of_texels(&frame.texels, SIZE);
        let count = |state| states.states.iter().filter(|&&of| of == Some(state)).count();
        assert!(count(ShadowState::Lit) + count(ShadowState::BackFacing) > 5000, "{}", shot.name);
        assert_eq!(count(ShadowState::Cast), 0, "{}", shot.name);
        let found = line_accuracy(&frame.image(), &[], WITHIN_PX);
        assert_eq!(found.counts.0, 0, "{}: lines on a ball", shot.name);
    }
}

#[test]
fn outlines_lie_on_the_borders_of_shadows() {
    let scene = Scene::new(embedded::scene());
    for shot in shots(&scene, aspect()).iter().step_by(2).take(3) {
        let style = shot.style(ShadowMethod::Volumes);
        let plan = planned(&scene, &style, &shot.camera, SIZE);
        let picture = cpu::render(&scene, &plan, &CpuOptions::default(), &|_| {}).image();
        let borders = true_borders(&scene, shot, &style, SIZE, 3).expect("borders");
        let found = line_accuracy(&picture, &borders, WITHIN_PX);
        println!("{}: {found:?}", shot.name);
        assert!(found.precision >= 0.95 && found.recall >= 0.95 && found.counts.1 > 500, "{}: {found:?}", shot.name);
        // The comparison must fail for borders shifted by 3 px.
        let aside: Vec<DVec2> = borders.iter().map(|border| border + DVec2::new(3.0, 3.0)).collect();
        assert!(line_accuracy(&picture, &aside, WITHIN_PX).precision < 0.5, "{}", shot.name);
    }
}

#[test]
fn states_that_differ_are_told() {
    let size = (40, 30);
    let states = |border: u32, dot: Option<(u32, u32)>| {
        let state = |i: u32| {
            let lit = (i % size.0 < border) != (dot == Some((i % size.0, i / size.0)));
            Some(if lit { ShadowState::Lit } else { ShadowState::Cast })
        };
        States { size, states: (0..size.0 * size.1).map(state).collect() }
    };
    let reference = states(20, None);
    assert_eq!(reference.difference(&reference).share, 0.0);
    let moved = states(21, None).difference(&reference);
    assert!((moved.share - 1.0 / 40.0).abs() < 1e-12 && moved.farthest_px <= 1.0, "{moved:?}");
    let one = 1.0 / f64::from(size.0 * size.1);
    let acne = states(20, Some((5, 15))).difference(&reference);
    assert!((acne.acne - one).abs() < 1e-12 && acne.loose == 0.0 && acne.farthest_px >= 12.0, "{acne:?}");
    let loose = states(20, Some((35, 15))).difference(&reference);
    assert!((loose.loose - one).abs() < 1e-12 && loose.acne == 0.0, "{loose:?}");
}

/// Prints a table of docs/accuracy.md: the errors of shadow maps by their size, for pictures of 640 × 360 px.
#[test]
#[ignore = "a table: a minute"]
fn table_of_maps() {
    let Some(executor) = device() else { return };
    let mut models = vec![("built-in scene", embedded::scene())];
    if let Some(folder) = shared_models() {
        let load = |name: &str| npr_mesh::load(&folder.join(name), &Default::default()).expect("it loads").into_model();
        models.extend(["stanford-bunny.obj", "teapot.obj", "CesiumMilkTruck.glb"].map(|name| (name, load(name))));
    }
    for (name, model) in models {
        let scene = Scene::new(model);
        let shots = shots(&scene, aspect());
        let references: Vec<_> = shots
            .iter()
            .map(|shot| States::by_rays(&scene, shot, TABLE_SIZE, DVec2::ZERO).expect("a picture"))
            .collect();
        let methods = [512, 1024, 2048, 4096].map(|side| ShadowMethod::Map { side });
        for method in [ShadowMethod::Volumes].into_iter().chain(methods) {
            let (mut share, mut acne, mut loose) = (0.0, 0.0, 0.0);
            for (shot, reference) in shots.iter().zip(&references) {
                let found = on_device(&executor, &scene, shot, method, None, TABLE_SIZE).difference(reference);
                share += found.share / shots.len() as f64;
                acne += found.acne / shots.len() as f64;
                loose += found.loose / shots.len() as f64;
            }
            println!(
                "{name:22} {method:?}: {:.4} % differ, acne {:.4} %, loose {:.4} %",
                share * 100.0,
                acne * 100.0,
                loose * 100.0
            );
        }
    }
}

/// A frame without shadows has the same passes as if this crate did not support shadows.
#[test]
fn where_no_light_casts_no_pass_is_planned_for_shadows() {
    let scene = Scene::new(embedded::scene());
    let camera = still_life_camera();
    let mut casting = 0;
    for mut style in styles() {
        let of_shadows = |plan: &Plan| {
            let passes = plan.passes.iter().map(|reason| reason.pass);
            passes.filter(|pass| pass.contains("shadow") || pass.contains("before all")).count()
        };
        if style.shadow.is_some() {
            let plan = planned(&scene, &style, &camera, SIZE);
            assert!(plan.shadow.is_some() && of_shadows(&plan) > 0, "{}: {:?}", style.name, plan.passes);
            casting += 1;
            style.shadow = None;
            if let Some(ink) = &mut style.lines.image {
                ink.shadows = ShadowLines::None;
            }
        }
        let plan = planned(&scene, &style, &camera, SIZE);
        assert!(plan.shadow.is_none() && of_shadows(&plan) == 0, "{}: {:?}", style.name, plan.passes);
        if let (Some(image), Some(ink)) = (&plan.image, &style.lines.image) {
            assert_eq!(image.passes().count(), 1, "{}", style.name);
            assert_eq!(image.ink.shadows, ink.shadows);
        }
    }
    assert!(casting >= 4, "{casting} styles cast shadows");
}

//! Tests of times of frames on an adapter, and of the executors that there are.
#![cfg(feature = "gpu")]
#![allow(clippy::print_stdout)]

mod common;

use common::device;
use npr_harness::camera::{Camera, Framing};
use npr_harness::executor::Executor;
use npr_harness::gpu::GpuAdapter;
use npr_harness::measure::{FrameCase, Rounds, Samples, Timed, time_frames};
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::style::style;
use npr_harness::view::View;
use npr_mesh::embedded;
use std::collections::HashSet;

/// Times of the built-in scene in sizes of 480 × 270 px times each of `scales`.
fn timed(executor: &Executor, name: &str, scales: &[u32], rounds: &Rounds) -> Vec<Timed> {
    let scene = Scene::new(embedded::scene());
    let style = style(name).expect("a style of this crate");
    let camera = Camera::framed(scene.corners(), 16.0 / 9.0, &Framing::default());
    let plan = |scale: &u32| {
        let view = View::new(camera, (480 * scale, 270 * scale));
        Plan::new(&scene, &style, &view, &executor.capabilities()).expect("a good style")
    };
    let plans: Vec<Plan> = scales.iter().map(plan).collect();
    let cases: Vec<_> = plans.iter().map(|plan| FrameCase { scene: &scene, plan }).collect();
    time_frames(executor, &cases, rounds, &|_| {}).expect("the frames are drawn")
}

fn device_times(timed: &Timed) -> Option<&Samples> {
    if timed.device.is_none() {
        println!("skipped: no timestamps between passes");
    }
    timed.device.as_ref()
}

/// Device time is a part of wall time, and most of it, since frames of this size take longer than recording them.
#[test]
fn device_time_is_most_of_the_wall_time() {
    let Some(executor) = device() else { return };
    let Executor::Gpu(context) = &executor else { return };
    let rounds = Rounds { rounds: 7, frames_a_wait: Some(3), ..Rounds::default() };
    for timed in timed(&executor, "toon", &[2, 4], &rounds) {
        let Some(device) = device_times(&timed) else { return };
        let share = device.relative_to(&timed.wall);
        println!("{share:?} of {:?} ms", timed.wall.spread());
        assert!(share.high <= 1.0, "{share:?}");
        // On hardware, recording may take longer than the frame.
        assert!(!context.is_software() || share.median > 0.3, "{share:?}");
    }
}

#[test]
fn four_times_the_pixels_take_longer_on_the_device() {
    let Some(executor) = device() else { return };
    let timed = timed(&executor, "toon", &[2, 4, 2], &Rounds { rounds: 7, ..Rounds::default() });
    let ratio = |case: usize| Some(device_times(&timed[case])?.relative_to(device_times(&timed[0])?).median);
    let (Some(larger), Some(same)) = (ratio(1), ratio(2)) else { return };
    assert!(larger > 1.3, "{larger}");
    assert!((0.5..=2.0).contains(&same), "the same frame again takes {same} times as long");
}

/// Styles that find lines in different ways, in one call.
#[test]
fn cases_of_different_styles_share_a_renderer() {
    let Some(executor) = device() else { return };
    let scene = Scene::new(embedded::scene());
    let camera = Camera::framed(scene.corners(), 1.0, &Framing::default());
    let plan = |name, samples| {
        let view = View { samples, ..View::new(camera, (64, 64)) };
        Plan::new(&scene, &style(name).expect("a style"), &view, &executor.capabilities()).expect("a good style")
    };
    let plans =
        [plan("cartoon", 1), plan("ink-image", 1), plan("ink-thick", 2), plan("toon-shadow", 1), plan("hatch", 2)];
    let cases = plans.each_ref().map(|plan| FrameCase { scene: &scene, plan });
    let rounds = Rounds { rounds: 2, frames_a_wait: Some(2), ..Rounds::default() };
    let timed = time_frames(&executor, &cases, &rounds, &|_| {}).expect("the frames are drawn");
    assert_eq!(timed.len(), cases.len());
    assert!(timed.iter().all(|timed| timed.wall.times_ms().len() == 2));
}

#[test]
fn every_adapter_is_listed_once_and_the_preferred_one_first() {
    let Some(executor) = device() else { return };
    let adapters = GpuAdapter::all();
    let names: Vec<String> = adapters.iter().map(GpuAdapter::name).collect();
    println!("{names:?}");
    assert_eq!(names.first(), Some(&executor.name()));
    assert_eq!(GpuAdapter::find().expect("an adapter").name(), executor.name());
    assert_eq!(names.iter().collect::<HashSet<_>>().len(), names.len());
    assert!(adapters.is_sorted_by_key(GpuAdapter::is_software));
    let again: Vec<String> = GpuAdapter::all().iter().map(GpuAdapter::name).collect();
    assert_eq!(names, again);
    for adapter in &adapters {
        let opened = Executor::on_adapter(adapter).expect("it opens");
        assert_eq!(opened.name(), adapter.name());
        assert_eq!(opened.describe(), adapter.describe());
    }
    // NPR_GPU is not off, else there were no device.
    let all: Vec<String> = Executor::all().expect("they open").iter().map(Executor::name).collect();
    assert_eq!((all[0].as_str(), &all[1..]), ("cpu", &names[..]));
    assert!(all.iter().all(|name| name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-')));
}

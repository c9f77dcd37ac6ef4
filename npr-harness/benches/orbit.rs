//! Frames of an orbit by a GPU renderer with persistent resources, read back, compared with the CPU executor, in
//! interleaved rounds.
//!
//! `cargo bench -p npr-harness --bench orbit -- [--size WIDTHxHEIGHT] [--model FILE] [--rounds FRAMES] [STYLE …]`; by
//! default the built-in scene, `cartoon` and 60 frames. Each frame is planned, drawn and read back, so that only one is
//! in flight.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod common;

use npr_harness::camera::{Camera, Framing};
use npr_harness::capabilities::Capabilities;
use npr_harness::cpu::{self, CpuOptions};
use npr_harness::executor::Executor;
use npr_harness::gpu::GpuRenderer;
use npr_harness::measure::{Rounds, time_work};
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::style::style;
use npr_harness::view::View;
use std::hint::black_box;

/// The frames of a full orbit.
const ORBIT: usize = 60;

fn main() {
    let arguments = common::arguments(Rounds { rounds: ORBIT, ..Rounds::default() });
    let Some(executor) = common::on_adapter() else { return };
    let Executor::Gpu(context) = &executor else { return };
    let model = arguments.model.as_deref().map_or_else(npr_mesh::embedded::scene, common::load);
    let (scene, size) = (Scene::new(model), arguments.size);
    scene.build_rays();
    println!("{} faces, {} × {} px, {} frames", scene.face_count(), size.0, size.1, arguments.rounds.rounds);
    let names: Vec<&str> = arguments.rest.iter().map(String::as_str).collect();
    for name in if names.is_empty() { vec!["cartoon"] } else { names } {
        let style = style(name).expect("a style");
        let plan = |frame: usize, capabilities: &Capabilities| {
            let yaw_rad = frame as f64 / ORBIT as f64 * std::f64::consts::TAU;
            let framing = Framing { yaw_rad, ..Framing::default() };
            let camera = Camera::framed(scene.corners(), f64::from(size.0) / f64::from(size.1), &framing);
            Plan::new(&scene, &style, &View::new(camera, size), capabilities).expect("a good style")
        };
        let renderer = GpuRenderer::new(context);
        let first = plan(0, &context.capabilities);
        let uploaded = renderer.upload(&scene, &first).expect("it fits");
        let targets = renderer.targets(&first.view).expect("a size for every device");
        // Both executors draw the same frame in a round.
        let mut frames = 0..;
        let mut on_adapter = || {
            let plan = plan(frames.next().unwrap_or_default(), &context.capabilities);
            renderer.draw(&scene, &uploaded, &plan, &targets).expect("a frame");
            black_box(renderer.read(&targets).expect("a frame"));
        };
        let mut frames = 0..;
        let mut on_cpu = || {
            let plan = plan(frames.next().unwrap_or_default(), &Capabilities::RAY_CASTER);
            black_box(cpu::render(&scene, &plan, &CpuOptions::default(), &|_| {}).image());
        };
        let timed = time_work(&mut [&mut on_adapter, &mut on_cpu], &arguments.rounds);
        let [adapter_ms, cpu_ms] = [0, 1].map(|case| timed[case].spread().median);
        let ratio = timed[0].relative_to(&timed[1]);
        println!(
            "{name:16} adapter {adapter_ms:6.1} ms, CPU {cpu_ms:6.1} ms, ratio {:.2} ({:.2}–{:.2})",
            ratio.median, ratio.low, ratio.high
        );
    }
}

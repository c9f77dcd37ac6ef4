//! 60 frames of an orbit by a GPU renderer with persistent resources, compared with the CPU executor, in interleaved
//! rounds.
//!
//! `cargo bench -p npr-harness --bench orbit -- [MODEL] [STYLE …]`; by default the built-in scene and `cartoon`.
#![allow(clippy::print_stdout)]

use npr_harness::camera::{Camera, Framing};
use npr_harness::capabilities::Capabilities;
use npr_harness::cpu::{self, CpuOptions};
use npr_harness::gpu::{self, GpuRenderer};
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::style::style;
use npr_harness::view::View;
use std::time::Instant;

/// The size of the pictures, px.
const SIZE: (u32, u32) = (1280, 720);
const FRAMES: u32 = 60;

fn main() {
    // Cargo adds an argument of its own.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let context = match gpu::open() {
        Ok(context) => context,
        Err(error) => return println!("skipped: {error}"),
    };
    println!("on {}", context.describe());
    let model = match arguments.first() {
        Some(path) => npr_mesh::load(path.as_ref(), &Default::default()).expect("a model").into_model(),
        None => npr_mesh::embedded::scene(),
    };
    let scene = Scene::new(model);
    scene.build_rays();
    println!("{} faces, {} × {} px, {FRAMES} frames", scene.face_count(), SIZE.0, SIZE.1);
    let names: Vec<&str> = arguments.iter().skip(1).map(String::as_str).collect();
    for name in if names.is_empty() { vec!["cartoon"] } else { names } {
        let style = style(name).expect("a style");
        let camera = |frame: u32| {
            let yaw_rad = f64::from(frame) / f64::from(FRAMES) * std::f64::consts::TAU;
            let framing = Framing { yaw_rad, ..Framing::default() };
            Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &framing)
        };
        let cameras: Vec<Camera> = (0..FRAMES).map(camera).collect();
        let renderer = GpuRenderer::new(&context);
        let plan = |camera: &Camera, capabilities: &Capabilities| {
            Plan::new(&scene, &style, &View::new(*camera, SIZE), capabilities).expect("a good style")
        };
        let first = plan(&cameras[0], &context.capabilities);
        let uploaded = renderer.upload(&scene, &first).expect("it fits");
        let targets = renderer.targets(&first.view).expect("a size for every device");
        let (mut on_device, mut on_cpu) = (Vec::new(), Vec::new());
        for (frame, camera) in cameras.iter().enumerate() {
            let start = Instant::now();
            let on_adapter = plan(camera, &context.capabilities);
            renderer.draw(&scene, &uploaded, &on_adapter, &targets).expect("a frame");
            let image = renderer.read(&targets).expect("a frame");
            // The first frame compiles the pipelines.
            if frame > 0 {
                on_device.push(start.elapsed().as_secs_f64() * 1e3);
            }
            let start = Instant::now();
            let by_rays = plan(camera, &Capabilities::RAY_CASTER);
            let frame = cpu::render(&scene, &by_rays, &CpuOptions::default(), &|_| {}).image();
            on_cpu.push(start.elapsed().as_secs_f64() * 1e3);
            assert_eq!(image.rgba8.len(), frame.rgba8.len());
        }
        let median = |times: &mut Vec<f64>| {
            times.sort_by(f64::total_cmp);
            times[times.len() / 2]
        };
        let (device_ms, cpu_ms) = (median(&mut on_device), median(&mut on_cpu));
        println!("{name:16} adapter {device_ms:6.1} ms, CPU {cpu_ms:6.1} ms, ratio {:.2}", device_ms / cpu_ms);
    }
}

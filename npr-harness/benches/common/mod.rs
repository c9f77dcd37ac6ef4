//! Frames of several styles in turn, each timed against the first.

use npr_harness::camera::{Camera, Framing};
use npr_harness::gpu::{GpuContext, GpuRenderer};
use npr_harness::plan::{LineMethod, Plan};
use npr_harness::scene::Scene;
use npr_harness::style::Style;
use npr_mesh::Model;
use std::path::Path;
use std::time::Instant;

const SIZE: (u32, u32) = (1280, 720);
const ROUNDS: usize = 25;

/// The bunny if it is there, else the built-in scene, after `change`.
pub fn bunny(change: impl Fn(&mut Model)) -> (Scene, Camera) {
    let bunny = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/stanford-bunny.obj"));
    let (name, mut model) = if bunny.exists() {
        ("bunny", npr_mesh::load(bunny, &Default::default()).expect("the bunny loads").model)
    } else {
        ("built-in scene", npr_mesh::embedded::scene())
    };
    change(&mut model);
    let scene = Scene::new(model);
    let camera = Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &Framing::default());
    println!("{name}, {} faces, {} × {} px", scene.model.faces.len(), SIZE.0, SIZE.1);
    (scene, camera)
}

/// What is timed: its name, style, how its lines are made, and samples along each axis of a pixel.
pub type Case<'a> = (&'a str, Style, LineMethod, u32);

/// Prints minimum and median of interleaved rounds, and their ratios to those of the first case.
pub fn compare(context: &GpuContext, scene: &Scene, camera: &Camera, cases: &[Case<'_>]) {
    let renderer = GpuRenderer::new(context);
    let prepared: Vec<_> = cases
        .iter()
        .filter(|(_, _, method, _)| match method {
            LineMethod::OnDevice => context.capabilities.can_find_lines(),
            LineMethod::Auto | LineMethod::Rectangles => true,
        })
        .map(|(name, style, method, samples)| {
            let plan = Plan::new(scene, style, camera).expect("the styles are valid");
            let uploaded = renderer.upload(scene, &plan, *method).expect("the scene fits");
            let targets = renderer.targets_of_samples(SIZE.0, SIZE.1, *samples).expect("a size for every device");
            (name, style, plan, uploaded, targets)
        })
        .collect();
    let mut times = vec![Vec::new(); prepared.len()];
    for round in 0..=ROUNDS {
        for (times, (_, style, plan, uploaded, targets)) in times.iter_mut().zip(&prepared) {
            let start = Instant::now();
            renderer.draw(scene, uploaded, style, plan, camera, targets).expect("the frame is drawn");
            context.wait().expect("the frame is drawn");
            // The first round makes the pipelines.
            if round > 0 {
                times.push(start.elapsed().as_secs_f64() * 1e3);
            }
        }
    }
    let summary = |times: &mut Vec<f64>| {
        times.sort_by(f64::total_cmp);
        (times[0], times[times.len() / 2])
    };
    let (plain_min, plain_median) = summary(&mut times[0].clone());
    println!("{:36} {:>9} {:>9}   ratio to {}: min, median", "", "min ms", "median ms", cases[0].0);
    for (times, (name, ..)) in times.iter_mut().zip(&prepared) {
        let (min, median) = summary(times);
        println!("{name:36} {min:9.2} {median:9.2}   {:.3} {:.3}", min / plain_min, median / plain_median);
    }
}

//! Renders frames of several styles in turn, each timed relative to the first.

use npr_harness::camera::{Camera, Framing};
use npr_harness::gpu::{GpuContext, GpuRenderer};
use npr_harness::plan::Plan;
use npr_harness::scene::Scene;
use npr_harness::style::Style;
use npr_harness::view::View;
use npr_mesh::Model;
use std::path::Path;
use std::time::Instant;

const SIZE: (u32, u32) = (1280, 720);
const ROUNDS: usize = 25;

/// The bunny if it is there, else the built-in scene, after `change`.
pub fn bunny(change: impl Fn(&mut Model)) -> (Scene, Camera) {
    let bunny = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/stanford-bunny.obj"));
    let (name, mut model) = if bunny.exists() {
        ("bunny", npr_mesh::load(bunny, &Default::default()).expect("the bunny loads").into_model())
    } else {
        ("built-in scene", npr_mesh::embedded::scene())
    };
    change(&mut model);
    let scene = Scene::new(model);
    let camera = Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &Framing::default());
    println!("{name}, {} faces, {} × {} px", scene.face_count(), SIZE.0, SIZE.1);
    (scene, camera)
}

/// A timed case: its name, its style, and samples along each axis of a pixel. The methods are those that the plan
/// selects for the adapter's capabilities after `change`.
pub struct Case<'a> {
    pub name: &'a str,
    pub style: Style,
    pub samples: u32,
    pub change: fn(&mut Plan),
}

impl<'a> Case<'a> {
    /// A case with one sample per pixel and the plan's default methods.
    pub fn new(name: &'a str, style: Style) -> Self {
        Self { name, style, samples: 1, change: |_| {} }
    }
}

/// Prints minimum and median of interleaved rounds, and their ratios to those of the first case.
pub fn compare(context: &GpuContext, scene: &Scene, camera: &Camera, cases: &[Case<'_>]) {
    let renderer = GpuRenderer::new(context);
    let prepared: Vec<_> = cases
        .iter()
        .map(|Case { name, style, samples, change }| {
            let view = View { samples: *samples, ..View::new(*camera, SIZE) };
            let mut plan = Plan::new(scene, style, &view, &context.capabilities).expect("the styles are valid");
            change(&mut plan);
            let uploaded = renderer.upload(scene, &plan).expect("the scene fits");
            let targets = renderer.targets(&plan.view).expect("a size for every device");
            (name, plan, uploaded, targets)
        })
        .collect();
    let mut times = vec![Vec::new(); prepared.len()];
    for round in 0..=ROUNDS {
        for (times, (_, plan, uploaded, targets)) in times.iter_mut().zip(&prepared) {
            let start = Instant::now();
            renderer.draw(scene, uploaded, plan, targets).expect("the frame is drawn");
            context.wait().expect("the frame is drawn");
            // The first round creates the pipelines.
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
    println!("{:36} {:>9} {:>9}   ratio to {}: min, median", "", "min ms", "median ms", cases[0].name);
    for (times, (name, ..)) in times.iter_mut().zip(&prepared) {
        let (min, median) = summary(times);
        println!("{name:36} {min:9.2} {median:9.2}   {:.3} {:.3}", min / plain_min, median / plain_median);
    }
}

//! A frame's cost: plain Lambert, all other light, and lines, on one adapter, same targets, same culling.
//!
//! `cargo bench -p npr-harness --bench frame`. Minimum and median of interleaved rounds; read the ratios. The figures
//! that were measured stand in the README.
#![allow(clippy::print_stdout)]

use npr_harness::camera::{Camera, Framing};
use npr_harness::gpu::{GpuContext, GpuRenderer};
use npr_harness::image_ink::ImageInk;
use npr_harness::plan::{LineMethod, Plan};
use npr_harness::scene::Scene;
use npr_harness::style::{Lines, Shade, Style, style};
use npr_imagespace::format::texel::TexelLayout;
use npr_toon::normal::NormalUse;
use std::path::Path;
use std::time::Instant;

const SIZE: (u32, u32) = (1280, 720);
const ROUNDS: usize = 25;

fn main() {
    let context = match GpuContext::new() {
        Ok(context) => context,
        Err(error) => return println!("skipped: {error}"),
    };
    println!("on {}", context.describe());
    let bunny = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/stanford-bunny.obj"));
    let (name, model) = if bunny.exists() {
        ("bunny", npr_mesh::load(bunny, &Default::default()).expect("the bunny loads").model)
    } else {
        ("built-in scene", npr_mesh::embedded::scene())
    };
    let scene = Scene::new(model);
    let camera = Camera::framed(scene.corners(), f64::from(SIZE.0) / f64::from(SIZE.1), &Framing::default());
    println!("{name}, {} faces, {} × {} px", scene.model.faces.len(), SIZE.0, SIZE.1);
    let base = style("cartoon").expect("a style of this crate");
    let without_highlight = match &base.shade {
        Shade::Toon(bands) => Shade::Toon(npr_toon::Bands { highlight: None, ..bands.clone() }),
        other => other.clone(),
    };
    let lambert = Shade::Lambert { ambient: 0.25 };
    let found = |layout| Some(Lines::Image(ImageInk { layout, ..ImageInk::default() }));
    let light = |name: &str| Style { lines: None, ..style(name).expect("a style of this crate") };
    let cases: [(&str, Style, LineMethod); 16] = [
        ("Lambert", Style { shade: lambert.clone(), lines: None, ..base.clone() }, LineMethod::Rectangles),
        ("toon", Style { lines: None, ..base.clone() }, LineMethod::Rectangles),
        (
            "toon without highlight",
            Style { shade: without_highlight.clone(), lines: None, ..base.clone() },
            LineMethod::Rectangles,
        ),
        (
            "the same, normals as interpolated",
            Style { shade: without_highlight.clone(), normals: NormalUse::Interpolated, lines: None, ..base.clone() },
            LineMethod::Rectangles,
        ),
        (
            "the same, light per vertex",
            Style { shade: without_highlight.clone(), normals: NormalUse::PerVertex, lines: None, ..base.clone() },
            LineMethod::Rectangles,
        ),
        ("Gooch with a highlight", light("gooch"), LineMethod::Rectangles),
        ("smooth ramp of half-Lambert", light("wash"), LineMethod::Rectangles),
        ("two lights, one near, 2D ramp", light("two-lights"), LineMethod::Rectangles),
        ("toon + image lines", Style { lines: found(TexelLayout::Wide), ..base.clone() }, LineMethod::Rectangles),
        (
            "toon + image lines, narrow texels",
            Style { lines: found(TexelLayout::Narrow), ..base.clone() },
            LineMethod::Rectangles,
        ),
        (
            "the same without highlight",
            Style { shade: without_highlight, lines: found(TexelLayout::Narrow), ..base.clone() },
            LineMethod::Rectangles,
        ),
        ("Lambert + lines as strokes", Style { shade: lambert, ..base.clone() }, LineMethod::Strokes),
        ("toon + lines as strokes", base.clone(), LineMethod::Strokes),
        ("toon + lines as rectangles", base.clone(), LineMethod::Rectangles),
        ("toon + lines found on the device", base.clone(), LineMethod::OnDevice),
        (
            "toon + printed fins, all edges",
            Style { lines: style("printed-fins").and_then(|s| s.lines), ..base },
            LineMethod::Rectangles,
        ),
    ];
    let renderer = GpuRenderer::new(&context);
    let targets = renderer.targets(SIZE.0, SIZE.1).expect("the size is within every device's limits");
    let prepared: Vec<_> = cases
        .iter()
        .filter(|(.., method)| match method {
            LineMethod::OnDevice => context.can_find_lines,
            LineMethod::Strokes => context.can_stroke,
            LineMethod::Auto | LineMethod::Rectangles => true,
        })
        .map(|(name, style, method)| {
            let plan = Plan::new(&scene, style, &camera).expect("the styles are valid");
            let uploaded = renderer.upload(&scene, &plan, *method).expect("the scene fits");
            (name, style, plan, uploaded)
        })
        .collect();
    let mut times = vec![Vec::new(); prepared.len()];
    for round in 0..=ROUNDS {
        for (times, (_, style, plan, uploaded)) in times.iter_mut().zip(&prepared) {
            let start = Instant::now();
            renderer.draw(&scene, uploaded, style, plan, &camera, &targets).expect("the frame is drawn");
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
    println!("{:36} {:>9} {:>9}   ratio to Lambert: min, median", "", "min ms", "median ms");
    for (times, (name, ..)) in times.iter_mut().zip(&prepared) {
        let (min, median) = summary(times);
        println!("{name:36} {min:9.2} {median:9.2}   {:.3} {:.3}", min / plain_min, median / plain_median);
    }
}

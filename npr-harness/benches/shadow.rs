//! The cost of shadows: volumes and maps relative to the same frame without them, and shadow lines relative to lines of
//! objects alone.
//!
//! `cargo bench -p npr-harness --bench shadow -- [--size WIDTHxHEIGHT] [--model FILE] [--frames N] [--rounds N]`. Prints
//! times of interleaved rounds, and ratios, which are the meaningful numbers. docs/speed.md has measured figures.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod common;

use common::Case;
use npr_harness::image_lines::ImageInk;
use npr_harness::plan::Plan;
use npr_harness::shade::Shade;
use npr_harness::shade::lambert::Lambert;
use npr_harness::shadow::{ShadowLines, ShadowMethod, ShadowStyle, ShadowTechnique, VolumeMethod};
use npr_harness::style::{Lines, Style, style};

fn main() {
    let arguments = common::arguments(common::ROUNDS);
    let Some(executor) = common::on_adapter() else { return };
    let named = |name: &str| style(name).expect("a style of this crate");
    let plain = Style {
        shade: Shade::Lambert(Lambert { ambient: 0.25 }),
        lines: Lines::NONE,
        shadow: None,
        ..named("toon-shadow")
    };
    let shadowed = |method| Style { shadow: Some(ShadowStyle { method, ..ShadowStyle::default() }), ..plain.clone() };
    let map = |side| shadowed(ShadowMethod::Map { side });
    let lines = |shadows| Lines::image(ImageInk { shadows, ..ImageInk::default() });
    let objects = Style { lines: lines(ShadowLines::None), ..shadowed(ShadowMethod::Volumes) };
    let cases = [
        ("Lambert", plain.clone()),
        ("volumes", shadowed(ShadowMethod::Volumes)),
        ("map 512", map(512)),
        ("map 1024", map(1024)),
        ("map 2048", map(2048)),
        ("map 4096", map(4096)),
        ("image lines, no shadows", Style { lines: lines(ShadowLines::None), ..plain.clone() }),
        ("volumes, image lines of objects", objects),
        ("volumes, image lines of both", Style { lines: lines(ShadowLines::Lines), ..shadowed(ShadowMethod::Volumes) }),
        ("toon-shadow", named("toon-shadow")),
    ];
    let (scene, camera) = common::scene(&arguments, |_| {});
    let by_plan = cases.clone().map(|(name, style)| Case::new(name, style));
    common::compare(&executor, &scene, &camera, &arguments, &by_plan);
    // With the bounds of volumes found on the GPU, as on hardware.
    let change = |plan: &mut Plan| {
        if let Some(ShadowTechnique::Volumes { method, .. }) = plan.shadow.as_mut().map(|shadow| &mut shadow.technique)
        {
            *method = VolumeMethod::OnDevice;
        }
    };
    let on_device = Case { change, ..Case::new("volumes, bounds on the device", cases[1].1.clone()) };
    common::compare(&executor, &scene, &camera, &arguments, &[Case::new("Lambert", plain), on_device]);
}

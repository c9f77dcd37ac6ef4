//! What shadows cost: volumes and maps against the same frame without, and shadow lines against the objects' alone.
//!
//! `cargo bench -p npr-harness --bench shadow`. Minimum and median of interleaved rounds; read the ratios. The figures
//! that were measured stand in docs/speed.md.
#![allow(clippy::print_stdout)]

mod common;

use npr_harness::gpu::GpuContext;
use npr_harness::image_ink::ImageInk;
use npr_harness::plan::LineMethod;
use npr_harness::shadow::{ShadowLines, ShadowMethod, ShadowStyle};
use npr_harness::style::{Lines, Shade, Style, style};

fn main() {
    let context = match GpuContext::new() {
        Ok(context) => context,
        Err(error) => return println!("skipped: {error}"),
    };
    println!("on {}", context.describe());
    let named = |name: &str| style(name).expect("a style of this crate");
    let plain = Style { shade: Shade::Lambert { ambient: 0.25 }, lines: None, shadow: None, ..named("toon-shadow") };
    let shadowed = |method| Style { shadow: Some(ShadowStyle { method, ..ShadowStyle::default() }), ..plain.clone() };
    let map = |side| shadowed(ShadowMethod::Map { side });
    let lines = |shadows| Some(Lines::Image(ImageInk { shadows, ..ImageInk::default() }));
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
    let (scene, camera) = common::bunny(|_| {});
    let software = cases.clone().map(|(name, style)| (name, style, LineMethod::Auto, 1));
    common::compare(&context, &scene, &camera, &software);
    // With what casts sorted out by the device, as on hardware.
    let sorted = [
        ("Lambert", plain, LineMethod::Auto, 1),
        ("volumes, sorted out there", cases[1].1.clone(), LineMethod::OnDevice, 1),
    ];
    common::compare(&context, &scene, &camera, &sorted);
}

//! A frame's cost: plain Lambert, all other light, and lines, on one adapter, same targets, same culling.
//!
//! `cargo bench -p npr-harness --bench frame`. Minimum and median of interleaved rounds; read the ratios. The figures
//! that were measured stand in docs/speed.md.
#![allow(clippy::print_stdout)]

mod common;

use npr_harness::gpu::GpuContext;
use npr_harness::image_ink::ImageInk;
use npr_harness::plan::LineMethod;
use npr_harness::style::{Lines, Shade, Style, style};
use npr_imagespace::format::texel::TexelLayout;
use npr_toon::normal::NormalUse;

fn main() {
    let context = match GpuContext::new() {
        Ok(context) => context,
        Err(error) => return println!("skipped: {error}"),
    };
    println!("on {}", context.describe());
    let (scene, camera) = common::bunny(|_| {});
    let base = style("cartoon").expect("a style of this crate");
    let without_highlight = match &base.shade {
        Shade::Toon(bands) => Shade::Toon(npr_toon::Bands { highlight: None, ..bands.clone() }),
        other => other.clone(),
    };
    let lambert = Shade::Lambert { ambient: 0.25 };
    let found = |layout| Some(Lines::Image(ImageInk { layout, ..ImageInk::default() }));
    let light = |name: &str| Style { lines: None, ..style(name).expect("a style of this crate") };
    let mut cases: Vec<(&str, Style, LineMethod, u32)> = [
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
        ("Lambert + lines as rectangles", Style { shade: lambert, ..base.clone() }, LineMethod::Rectangles),
        ("toon + lines as rectangles", base.clone(), LineMethod::Rectangles),
        ("toon + lines found on the device", base.clone(), LineMethod::OnDevice),
        (
            "toon + printed fins, all edges",
            Style { lines: style("printed-fins").and_then(|s| s.lines), ..base.clone() },
            LineMethod::Rectangles,
        ),
    ]
    .map(|(name, style, method)| (name, style, method, 1))
    .into();
    let plain_toon = Style { lines: None, ..base.clone() };
    cases.push(("toon, 2 × 2 samples", plain_toon.clone(), LineMethod::Rectangles, 2));
    cases.push(("toon, 4 × 4 samples", plain_toon, LineMethod::Rectangles, 4));
    cases.push(("toon + lines as rectangles, 2 × 2 samples", base, LineMethod::Rectangles, 2));
    // What differs from 1 here is noise, and what the case before leaves behind in the caches.
    let mut again = cases[0].clone();
    again.0 = "Lambert again";
    cases.push(again);
    common::compare(&context, &scene, &camera, &cases);
}

//! The cost of a frame: Lambert, all other shades, and lines, on one adapter, with the same targets and culling.
//!
//! `cargo bench -p npr-harness --bench frame -- [--size WIDTHxHEIGHT] [--model FILE] [--frames N] [--rounds N]`. Prints
//! times of interleaved rounds, and ratios, which are the meaningful numbers. docs/speed.md has measured figures.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod common;

use common::Case;
use glam::Vec3;
use npr_harness::edge_lines::EdgeLineMethod;
use npr_harness::hull_lines::HullLines;
use npr_harness::image_lines::ImageInk;
use npr_harness::plan::Plan;
use npr_harness::shade::Shade;
use npr_harness::shade::lambert::Lambert;
use npr_harness::style::{Lines, Style, style};
use npr_imagespace::format::texel::TexelLayout;
use npr_outline::hull::HullNormals;
use npr_toon::normal::NormalUse;

fn main() {
    let arguments = common::arguments(common::ROUNDS);
    let Some(executor) = common::on_adapter() else { return };
    let (scene, camera) = common::scene(&arguments, |_| {});
    let base = style("cartoon").expect("a style of this crate");
    let without_highlight = match &base.shade {
        Shade::Toon(bands) => Shade::Toon(npr_toon::Bands { highlight: None, ..bands.clone() }),
        other => other.clone(),
    };
    let lambert = Shade::Lambert(Lambert { ambient: 0.25 });
    let found = |layout| Lines::image(ImageInk { layout, ..ImageInk::default() });
    let light = |name: &str| Style { lines: Lines::NONE, ..style(name).expect("a style of this crate") };
    let with = |shade: &Shade| Style { shade: shade.clone(), lines: Lines::NONE, ..base.clone() };
    let as_normals = |normals| Style { normals, ..with(&without_highlight) };
    let printed = style("printed-fins").expect("a style of this crate").lines;
    let hull = HullLines { width_px: 2.0, ink: Vec3::ZERO, normals: HullNormals::Welded };
    let mut cases: Vec<Case<'_>> = [
        ("Lambert", with(&lambert)),
        ("toon", with(&base.shade)),
        ("toon without highlight", with(&without_highlight)),
        ("the same, normals as interpolated", as_normals(NormalUse::Interpolated)),
        ("the same, light per vertex", as_normals(NormalUse::PerVertex)),
        ("Gooch with a highlight", light("gooch")),
        ("smooth ramp of half-Lambert", light("wash")),
        ("two lights, one near, 2D ramp", light("two-lights")),
        ("toon + image lines", Style { lines: found(TexelLayout::Bits64), ..base.clone() }),
        ("toon + image lines, 32-bit texels", Style { lines: found(TexelLayout::Bits32), ..base.clone() }),
        ("the same without highlight", Style { lines: found(TexelLayout::Bits32), ..with(&without_highlight) }),
        ("Lambert + edge lines", Style { shade: lambert, ..base.clone() }),
        ("toon + edge lines", base.clone()),
        ("toon + inverted hull", Style { lines: Lines::hull(hull), ..base.clone() }),
        ("toon + printed fins, all edges", Style { lines: printed, ..base.clone() }),
    ]
    .map(|(name, style)| Case::new(name, style))
    .into();
    if executor.capabilities().can_find_lines() {
        let change = |plan: &mut Plan| {
            if let Some(edges) = &mut plan.edge_lines {
                edges.method = EdgeLineMethod::OnDevice;
            }
        };
        cases.push(Case { change, ..Case::new("toon + edge lines found on the device", base.clone()) });
    }
    cases.push(Case { samples: 2, ..Case::new("toon, 2 × 2 samples", with(&base.shade)) });
    cases.push(Case { samples: 4, ..Case::new("toon, 4 × 4 samples", with(&base.shade)) });
    cases.push(Case { samples: 2, ..Case::new("toon + edge lines, 2 × 2 samples", base.clone()) });
    // A ratio other than 1 here is noise, and the effect of the previous case on the caches.
    cases.push(Case::new("Lambert again", cases[0].style.clone()));
    common::compare(&executor, &scene, &camera, &arguments, &cases);
}

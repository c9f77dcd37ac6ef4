//! The cost of strokes: encodings, mappings, and weights at vertices or pixels, relative to a plain Lambert pass.
//!
//! `cargo bench -p npr-harness --bench hatch -- [--size WIDTHxHEIGHT] [--model FILE] [--frames N] [--rounds N]`. Prints
//! times of interleaved rounds, and ratios, which are the meaningful numbers. docs/speed.md has measured figures.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod common;

use common::Case;
use npr_harness::hatch::{HatchEncoding, HatchMapping, HatchShade};
use npr_harness::shade::Shade;
use npr_harness::shade::lambert::Lambert;
use npr_harness::style::{Lines, Style, style};
use npr_toon::normal::NormalUse;

fn main() {
    let arguments = common::arguments(common::ROUNDS);
    let Some(executor) = common::on_adapter() else { return };
    let (scene, camera) = common::scene(&arguments, |model| {
        // The model has no texture coordinates.
        if model.uvs.is_empty() {
            model.uvs = model.positions.iter().map(|p| p.truncate()).collect();
        }
    });
    let base = Style { lines: Lines::NONE, ..style("hatch").expect("a style of this crate") };
    let Shade::Hatch(shade) = base.shade.clone() else { panic!("`hatch` hatches") };
    let hatched = |encoding, mapping, normals| Style {
        shade: Shade::Hatch(HatchShade { encoding, mapping, ..shade.clone() }),
        normals,
        ..base.clone()
    };
    let (six, thresholds) = (HatchEncoding::SixTones, HatchEncoding::Thresholds);
    let (pixel, vertex) = (NormalUse::PerPixel, NormalUse::PerVertex);
    let (coordinates, planes, form) = (HatchMapping::Coordinates, HatchMapping::Planes, HatchMapping::Form);
    let cases = [
        ("Lambert", Style { shade: Shade::Lambert(Lambert { ambient: 0.25 }), ..base.clone() }),
        ("six tones, coordinates", hatched(six, coordinates, pixel)),
        ("six tones at vertices, coordinates", hatched(six, coordinates, vertex)),
        ("six tones, planes", hatched(six, planes, pixel)),
        ("six tones at vertices, planes", hatched(six, planes, vertex)),
        ("six tones, form", hatched(six, form, pixel)),
        ("thresholds, coordinates", hatched(thresholds, coordinates, pixel)),
        ("thresholds, light at vertices", hatched(thresholds, coordinates, vertex)),
        ("thresholds, planes", hatched(thresholds, planes, pixel)),
        ("thresholds, form", hatched(thresholds, form, pixel)),
    ];
    let cases = cases.map(|(name, style)| Case::new(name, style));
    common::compare(&executor, &scene, &camera, &arguments, &cases);
}

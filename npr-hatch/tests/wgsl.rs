//! The WGSL is valid, and has the functions of the Rust side.

use naga::Module;
use npr_hatch::{LOOKUP_WGSL, WGSL};
use std::collections::BTreeSet;

fn validated(source: &str) -> Module {
    let module = naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    module
}

/// What begins with `hatch_` and is public in Rust.
fn rust_functions() -> BTreeSet<&'static str> {
    let sources = [
        include_str!("../src/weights.rs"),
        include_str!("../src/threshold.rs"),
        include_str!("../src/lookup.rs"),
        include_str!("../src/mapping.rs"),
    ];
    let after = sources.into_iter().flat_map(|source| source.split("pub fn ").skip(1));
    after.map(|text| text.split('(').next().unwrap()).filter(|name| name.starts_with("hatch_")).collect()
}

fn function_names(module: &Module) -> BTreeSet<&str> {
    module.functions.iter().map(|(_, function)| function.name.as_deref().unwrap()).collect()
}

fn type_names(module: &Module) -> BTreeSet<&str> {
    module.types.iter().filter_map(|(_, kind)| kind.name.as_deref()).collect()
}

/// The Rust functions that read maps, whose twins are in [`LOOKUP_WGSL`].
const LOOKUPS: [&str; 2] = ["hatch_ink", "hatch_texels"];

/// No bindings, entry points or overrides, and no constants: WGSL has no namespaces.
fn assert_library(module: &Module) {
    assert!(module.entry_points.is_empty() && module.global_variables.is_empty());
    assert!(module.overrides.is_empty() && module.constants.is_empty());
}

#[test]
fn is_a_library() {
    let module = validated(WGSL);
    assert_library(&module);
    let mut rust = rust_functions();
    for lookup in LOOKUPS {
        assert!(rust.remove(lookup), "{lookup}");
    }
    assert_eq!(function_names(&module), rust);
    let types = ["HatchFootprint", "HatchStep", "HatchTaps", "HatchWeights"];
    assert_eq!(type_names(&module), BTreeSet::from(types));
}

#[test]
fn lookups_are_a_library_behind_it() {
    let source = [WGSL, LOOKUP_WGSL].concat();
    let module = validated(&source);
    assert_library(&module);
    let (here, rust) = (function_names(&module), rust_functions());
    assert!(here.is_superset(&rust), "{:?}", rust.difference(&here));
    for part in here.difference(&rust) {
        assert!(LOOKUPS.iter().any(|whole| part.starts_with(&format!("{whole}_"))), "{part} is part of no function");
    }
    let types = ["HatchFootprint", "HatchStep", "HatchTaps", "HatchTexels", "HatchWeights"];
    assert_eq!(type_names(&module), BTreeSet::from(types));
}

#[test]
fn serves_a_fragment_shader() {
    let shader = "
        @group(0) @binding(0) var lighter: texture_2d<f32>;
        @group(0) @binding(1) var darker: texture_2d<f32>;
        @group(0) @binding(2) var trilinear: sampler;
        @fragment
        fn hatched(@location(0) n_dot_l: f32, @location(1) uv: vec2<f32>) -> @location(0) vec4<f32> {
            let weights = hatch_weights(hatch_level(7.0, n_dot_l));
            let light = textureSample(lighter, trilinear, uv).rgb;
            let tone = hatch_blend(light, textureSample(darker, trilinear, uv).rgb, weights);
            return vec4(hatch_color(tone, vec3(1.0), vec3(0.0)), 1.0);
        }
        @fragment
        fn fine(@location(0) n_dot_l: f32, @location(1) uv: vec2<f32>) -> @location(0) vec4<f32> {
            let ink = hatch_threshold(textureSample(lighter, trilinear, uv).r, n_dot_l, 0.05);
            return vec4(hatch_color(1.0 - ink, vec3(1.0), vec3(0.0)), 1.0);
        }";
    assert_eq!(validated(&format!("{WGSL}{shader}")).entry_points.len(), 2);
}

#[test]
fn lookups_serve_a_fragment_shader() {
    let shader = "
        @group(0) @binding(0) var lighter: texture_2d<f32>;
        @group(0) @binding(1) var darker: texture_2d<f32>;
        @group(0) @binding(2) var trilinear: sampler;
        @group(0) @binding(3) var thresholds: texture_2d<f32>;
        @group(0) @binding(4) var nearest: sampler;
        @fragment
        fn hatched(@location(0) tone: f32, @location(1) uv: vec2<f32>) -> @location(0) vec4<f32> {
            let footprint = hatch_footprint(dpdx(uv), dpdy(uv), 256.0, 8.0);
            let texels = hatch_texels(lighter, darker, trilinear, uv, footprint);
            return vec4(hatch_blend(texels.light, texels.dark, hatch_weights(7.0 * tone)));
        }
        @fragment
        fn fine(@location(0) tone: f32, @location(1) uv: vec2<f32>) -> @location(0) vec4<f32> {
            let footprint = hatch_footprint(dpdx(uv), dpdy(uv), 256.0, 8.0);
            return vec4(1.0 - hatch_ink(thresholds, nearest, uv, footprint, tone, 0.05));
        }";
    assert_eq!(validated(&[WGSL, LOOKUP_WGSL, shader].concat()).entry_points.len(), 2);
}

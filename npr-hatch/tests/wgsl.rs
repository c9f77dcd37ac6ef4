//! The WGSL is valid, and its signatures are those of the Rust functions.

#[path = "../../npr-toon/tests/signatures/mod.rs"]
mod signatures;

use naga::Module;
use npr_hatch::{LOOKUP_WGSL, WGSL};
use signatures::{Exceptions, Pair, differences};
use std::collections::BTreeSet;

fn validated(source: &str) -> Module {
    let module = naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    module
}

fn type_names(module: &Module) -> BTreeSet<&str> {
    module.types.iter().filter_map(|(_, kind)| kind.name.as_deref()).collect()
}

macro_rules! pairs {
    ($($stem:literal),*) => {
        [$(Pair {
            wgsl: include_str!(concat!("../src/", $stem, ".wgsl")),
            rust: include_str!(concat!("../src/", $stem, ".rs")),
        }),*]
    };
}

const EXCEPTIONS: Exceptions = Exceptions {
    wgsl_only: &[
        ("hatch_texels_at", "one sample of hatch_texels"),
        ("hatch_ink_at", "one sample of hatch_ink"),
        ("hatch_ink_of_level", "one level of hatch_ink"),
        ("hatch_ink_texel", "one texel of hatch_ink"),
    ],
    renamed: &[],
    types: &[],
    split: &[
        (
            "hatch_texels",
            "tam",
            &[("light", "texture"), ("dark", "texture"), ("trilinear", "sampler")],
            "a map of six tones is two textures",
        ),
        ("hatch_ink", "map", &[("map", "texture"), ("nearest", "sampler")], "WGSL reads textures through a sampler"),
    ],
    types_of: &[("hatch_texels", "tuple of 2", "HatchTexels", "WGSL has no tuples")],
};

/// The differences between the WGSL files, with one text replaced, and the Rust files.
fn differences_with(old: &str, new: &str) -> Vec<String> {
    let source = [WGSL, LOOKUP_WGSL].concat();
    let changed = source.replace(old, new);
    assert!(old == new || changed != source, "{old} is not there");
    let pairs = pairs!["weights", "threshold", "footprint", "mapping", "lookup"];
    differences(&validated(&changed), &pairs, &EXCEPTIONS)
}

#[test]
fn functions_have_the_signatures_of_the_rust_ones() {
    assert_eq!(differences_with("", ""), [""; 0]);
}

#[test]
fn a_different_signature_is_found() {
    let swapped = differences_with(
        "fn hatch_tone_in_shadow(tone: f32, darkest: f32",
        "fn hatch_tone_in_shadow(darkest: f32, tone: f32",
    );
    assert!(matches!(&swapped[..], [line] if line.starts_with("hatch_tone_in_shadow: ")), "{swapped:?}");
    let missing = differences_with("hatch_flat_weight", "hatch_level_flat");
    assert!(matches!(&missing[..], [line] if line.starts_with("hatch_level_flat: ")), "{missing:?}");
}

/// No bindings, entry points or overrides, and no constants: WGSL has no namespaces.
fn assert_library(module: &Module) {
    assert!(module.entry_points.is_empty() && module.global_variables.is_empty());
    assert!(module.overrides.is_empty() && module.constants.is_empty());
}

#[test]
fn is_a_library() {
    let module = validated(WGSL);
    assert_library(&module);
    for (_, function) in module.functions.iter() {
        let name = function.name.as_deref().unwrap();
        assert!(name.starts_with("hatch_"), "{name}");
    }
    let types = ["HatchFootprint", "HatchBlend", "HatchTaps", "HatchWeights"];
    assert_eq!(type_names(&module), BTreeSet::from(types));
}

#[test]
fn lookups_are_a_library_behind_it() {
    let source = [WGSL, LOOKUP_WGSL].concat();
    let module = validated(&source);
    assert_library(&module);
    let types = ["HatchFootprint", "HatchBlend", "HatchTaps", "HatchTexels", "HatchWeights"];
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

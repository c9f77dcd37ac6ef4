//! The WGSL is valid, and has the functions of the Rust side.

use naga::Module;
use npr_hatch::WGSL;

fn validated(source: &str) -> Module {
    let module = naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    module
}

#[test]
fn is_a_library() {
    let module = validated(WGSL);
    assert!(module.entry_points.is_empty() && module.global_variables.is_empty());
    assert!(module.overrides.is_empty() && module.constants.is_empty());
    let rust = concat!(include_str!("../src/weights.rs"), include_str!("../src/threshold.rs"));
    assert_eq!(module.functions.len(), rust.matches("pub fn hatch_").count());
    for (_, function) in module.functions.iter() {
        let name = function.name.as_deref().unwrap();
        assert!(name.starts_with("hatch_") && rust.contains(&format!("fn {name}(")), "{name}");
    }
    let named = module.types.iter().filter_map(|(_, kind)| kind.name.as_deref());
    assert_eq!(named.collect::<Vec<_>>(), ["HatchWeights"]);
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

//! The WGSL is valid, its signatures are those of the Rust functions, and the uniform has the layout that naga computes.

#[path = "../../npr-toon/tests/signatures/mod.rs"]
mod signatures;

use std::mem::{offset_of, size_of};

use naga::{Module, TypeInner};
use npr_gooch::{Gooch, GoochUniform, WGSL};
use signatures::{Exceptions, Pair, differences};

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
    assert!(module.entry_points.is_empty());
    assert!(module.global_variables.is_empty());
    assert!(module.overrides.is_empty());
    assert!(module.constants.is_empty());
    for (_, function) in module.functions.iter() {
        let name = function.name.as_deref().unwrap();
        assert!(name.starts_with("gooch_"), "{name}");
    }
    for (_, kind) in module.types.iter() {
        if let Some(name) = kind.name.as_deref() {
            assert!(name.starts_with("Gooch"), "{name}");
        }
    }
}

/// The differences between the WGSL file, with one text replaced, and the Rust file.
fn differences_with(old: &str, new: &str) -> Vec<String> {
    let exceptions = Exceptions {
        wgsl_only: &[("gooch_unit", "Rust calls DVec3::normalize_or_zero")],
        renamed: &[],
        types: &[("Gooch", "GoochModel", "the uniform of the style")],
        split: &[],
        types_of: &[],
    };
    let changed = WGSL.replace(old, new);
    assert!(old == new || changed != WGSL, "{old} is not there");
    let pair = Pair { wgsl: &changed, rust: include_str!("../src/shade.rs") };
    differences(&validated(&changed), &[pair], &exceptions)
}

#[test]
fn functions_have_the_signatures_of_the_rust_ones() {
    assert_eq!(differences_with("", ""), [""; 0]);
}

#[test]
fn a_different_signature_is_found() {
    let swapped = differences_with("n_dot_l: f32, r_dot_e: f32", "r_dot_e: f32, n_dot_l: f32");
    assert!(matches!(&swapped[..], [line] if line.starts_with("gooch_highlight: ")), "{swapped:?}");
    let missing = differences_with("gooch_weight", "gooch_warmth");
    assert!(matches!(&missing[..], [line] if line.starts_with("gooch_warmth: no Rust function")), "{missing:?}");
}

#[test]
fn uniform_has_the_layout_of_the_shader() {
    let module = validated(WGSL);
    let (_, model) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some("GoochModel")).unwrap();
    let TypeInner::Struct { members, span } = &model.inner else { panic!("not a struct") };
    let theirs = members.iter().map(|m| (m.name.as_deref().unwrap(), m.offset as usize));
    let theirs: Vec<_> = theirs.filter(|(name, _)| !name.starts_with("padding")).collect();
    let ours = [
        ("blue", offset_of!(GoochUniform, blue)),
        ("yellow", offset_of!(GoochUniform, yellow)),
        ("highlight", offset_of!(GoochUniform, highlight)),
        ("exponent", offset_of!(GoochUniform, exponent)),
    ];
    assert_eq!(theirs, ours);
    assert_eq!((*span as usize, size_of::<GoochUniform>()), (64, 64));
}

#[test]
fn serves_a_fragment_shader() {
    let shader = "
        @group(0) @binding(0) var<uniform> u_model: GoochModel;
        @group(0) @binding(1) var colors: texture_2d<f32>;
        @group(0) @binding(2) var bilinear: sampler;
        @fragment
        fn textured(
            @location(0) normal: vec3<f32>, @location(1) to_light: vec3<f32>, @location(2) to_eye: vec3<f32>,
            @location(3) uv: vec2<f32>,
        ) -> @location(0) vec4<f32> {
            let k_d = textureSample(colors, bilinear, uv).rgb;
            return vec4(gooch_shade(u_model, k_d, normal, to_light, to_eye), 1.0);
        }";
    assert_eq!(validated(&format!("{WGSL}{shader}")).entry_points.len(), 1);
}

#[test]
fn packs_the_model() {
    let uniform = GoochUniform::new(&Gooch::default()).unwrap();
    assert_eq!((uniform.blue, uniform.yellow), ([0.0, 0.0, 0.55, 0.25], [0.3, 0.3, 0.0, 0.5]));
    assert_eq!((uniform.highlight, uniform.exponent), ([1.0; 4], 32.0));
    // Listing 7 has beta in the cool tone and alpha in the warm tone.
    let uniform = GoochUniform::new(&Gooch::swapped_shares()).unwrap();
    assert_eq!((uniform.blue, uniform.yellow), ([0.0, 0.0, 0.4, 0.5], [0.5, 0.5, 0.0, 0.4]));
    assert_eq!(uniform.highlight[3], 0.0);
}

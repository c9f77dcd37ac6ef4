//! The WGSL is valid, and the uniform lies in memory as naga lays it out.

use std::mem::{offset_of, size_of};

use glam::Vec3;
use naga::{Module, TypeInner};
use npr_toon::ramp::TOON_STOPS_OVERRIDE;
use npr_toon::{Bands, MAX_BANDS, TOON_BANDS_OVERRIDE, ToonError, ToonUniform, WGSL};

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
    // Its overrides have defaults.
    let overrides: Vec<_> =
        module.overrides.iter().map(|(_, o)| (o.name.as_deref().unwrap(), o.init.is_some())).collect();
    assert_eq!(overrides, [(TOON_BANDS_OVERRIDE, true), (TOON_STOPS_OVERRIDE, true)]);
    for (_, function) in module.functions.iter() {
        let name = function.name.as_deref().unwrap();
        assert!(name.starts_with("toon_"), "{name}");
    }
    for (_, constant) in module.constants.iter() {
        let name = constant.name.as_deref().unwrap();
        assert!(name.starts_with("TOON_"), "{name}");
    }
}

#[test]
fn uniform_has_the_layout_of_the_shader() {
    let module = validated(WGSL);
    let (_, bands) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some("ToonBands")).unwrap();
    let TypeInner::Struct { members, span } = &bands.inner else { panic!("not a struct") };
    let theirs: Vec<_> = members.iter().map(|m| (m.name.as_deref().unwrap(), m.offset as usize)).collect();
    let ours = [
        ("bands", offset_of!(ToonUniform, bands)),
        ("highlight", offset_of!(ToonUniform, highlight)),
        ("count", offset_of!(ToonUniform, count)),
        ("highlight_strength", offset_of!(ToonUniform, highlight_strength)),
        ("highlight_lit_only", offset_of!(ToonUniform, highlight_lit_only)),
        ("antialias", offset_of!(ToonUniform, antialias)),
    ];
    assert_eq!(theirs, ours);
    assert_eq!(*span as usize, size_of::<ToonUniform>());
}

#[test]
fn serves_a_fragment_shader() {
    let shader = "
        @group(0) @binding(0) var<uniform> u_bands: ToonBands;
        @fragment
        fn by_value(@location(0) normal: vec3<f32>, @location(1) to_light: vec3<f32>, @location(2) to_eye: vec3<f32>)
            -> @location(0) vec4<f32>
        {
            let n_dot_l = toon_n_dot_l(normal, to_light);
            let n_dot_h = toon_n_dot_h(normal, to_light, to_eye);
            let color = toon_shade(
                u_bands, vec3(1.0), n_dot_l, toon_pixel_width(n_dot_l), n_dot_h, toon_pixel_width(n_dot_h));
            return vec4(color, 1.0);
        }
        @fragment
        fn directly(@location(0) normal: vec3<f32>, @location(1) to_light: vec3<f32>) -> @location(0) vec4<f32> {
            let n_dot_l = toon_n_dot_l(normal, to_light);
            let width = toon_pixel_width(n_dot_l);
            var tone = vec3<f32>(0.0);
            var share = 1.0;
            for (var i = 0u; i + 1u < u_bands.count; i++) {
                let above = toon_coverage(n_dot_l, u_bands.bands[i].w, width);
                tone += (share - above) * u_bands.bands[i].rgb;
                share = above;
            }
            return vec4(tone + share * u_bands.bands[u_bands.count - 1u].rgb, 1.0);
        }";
    assert_eq!(validated(&format!("{WGSL}{shader}")).entry_points.len(), 2);
}

#[test]
fn packs_bands() {
    let uniform = ToonUniform::new(&Bands::chapter_text()).unwrap();
    assert_eq!(uniform.bands[0], [0.2, 0.2, 0.2, 0.1]);
    assert_eq!(uniform.bands[1], [0.6, 0.6, 0.6, 1e4]);
    assert_eq!(uniform.highlight, [0.9, 0.9, 1.0, 0.8]);
    assert_eq!((uniform.count, uniform.highlight_strength), (2, 1.0));
    assert_eq!((uniform.highlight_lit_only, uniform.antialias), (0, 0));
    assert_eq!(ToonUniform::new(&Bands::hard_shading()).unwrap().highlight_strength, 0.0);
}

#[test]
fn refuses_what_does_not_fit() {
    let with = |count: usize| Bands {
        thresholds: (1..count).map(|i| i as f32 / count as f32).collect(),
        tones: vec![Vec3::ONE; count],
        ..Bands::listing_3()
    };
    assert!(ToonUniform::new(&with(MAX_BANDS)).is_ok());
    assert_eq!(ToonUniform::new(&with(9)), Err(ToonError::TooManyTones { tones: 9, max: 8 }));
    assert_eq!(ToonUniform::new(&with(0)), Err(ToonError::NoTones));
}

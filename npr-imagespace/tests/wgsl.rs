//! The WGSL is valid, its functions have the signatures of the Rust ones, and uniforms have the same memory layout.

#[path = "wgsl/twins.rs"]
mod twins;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Module, TypeInner};
use npr_imagespace::WGSL;
use npr_imagespace::artist::ARTIST_WGSL;
use npr_imagespace::composite::{COMPOSITE_WGSL, CompositeUniform};
use npr_imagespace::filter::FILTER_WGSL;
use npr_imagespace::filter::fused::FilterUniform;
use npr_imagespace::filter::inker::InkerUniform;
use npr_imagespace::filter::printed::PrintedUniform;
use npr_imagespace::filter::separate::SeparateUniform;
use npr_imagespace::format::FORMAT_WGSL;
use npr_imagespace::format::texel::DepthCode;
use npr_imagespace::morphology::MORPHOLOGY_WGSL;
use npr_imagespace::picture::PICTURE_WGSL;
use npr_imagespace::resample::RESAMPLE_WGSL;
use npr_imagespace::shadow::SHADOW_WGSL;
use std::mem::{offset_of, size_of};
use twins::{Except, Twins};

fn validated(source: &str) -> Module {
    let module = naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    Validator::new(ValidationFlags::all(), Capabilities::empty())
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
    for (_, function) in module.functions.iter() {
        let name = function.name.as_deref().unwrap();
        assert!(name.starts_with("ink_"), "{name}");
    }
    for (_, constant) in module.constants.iter() {
        let name = constant.name.as_deref().unwrap();
        assert!(name.starts_with("INK_"), "{name}");
    }
    for (_, kind) in module.types.iter() {
        if let Some(name) = kind.name.as_deref() {
            assert!(name.starts_with("Ink"), "{name}");
        }
    }
}

#[test]
fn the_parts_stand_alone_and_are_the_whole() {
    let parts = [
        PICTURE_WGSL,
        FORMAT_WGSL,
        SHADOW_WGSL,
        FILTER_WGSL,
        MORPHOLOGY_WGSL,
        COMPOSITE_WGSL,
        RESAMPLE_WGSL,
        ARTIST_WGSL,
    ];
    assert_eq!(parts.concat(), WGSL);
    for part in [PICTURE_WGSL, FORMAT_WGSL, SHADOW_WGSL, MORPHOLOGY_WGSL, COMPOSITE_WGSL, RESAMPLE_WGSL, ARTIST_WGSL] {
        validated(part);
    }
    validated(&[FORMAT_WGSL, SHADOW_WGSL, FILTER_WGSL].concat());
}

/// WGSL files of the library, whose Rust files have the same stems.
const LIBRARY: [&str; 21] = [
    "picture",
    "format",
    "format/printed",
    "format/depth",
    "format/normal",
    "format/texel",
    "region",
    "shadow",
    "filter",
    "filter/normal",
    "filter/depth",
    "filter/region",
    "filter/fused",
    "filter/inker",
    "filter/separate",
    "filter/printed",
    "morphology",
    "morphology/flood",
    "composite",
    "resample",
    "artist",
];

const TWINS: Twins<'_> = Twins {
    types: &[
        ("Composite", "InkComposite"),
        ("DepthCode", "InkDepthCode"),
        ("DepthPlain", "u32"),
        ("FilterUniform", "InkFilter"),
        ("Inker", "InkInker"),
        ("SeparateUniform", "InkSeparate"),
        ("Tap", "InkTap"),
    ],
    members: &[("AlphaTest", &[("less", "u32"), ("reference", "u32")])],
    exceptions: &[
        ("ink_any", Except::Missing, "any() of the four taps' booleans, as a number"),
        ("ink_bytes", Except::Missing, "Rust reads bytes, where a shader's texture yields floats"),
        ("ink_depth_decode", Except::Missing, "DepthFormat::decode, which is in f64 and has a case for each format"),
        ("ink_depth_fraction", Except::Missing, "DepthRange::fraction, which has the range as a type"),
        ("ink_depth_join2", Except::Missing, "Rust keeps codes as numbers and splits them for targets alone"),
        ("ink_depth_join4", Except::Missing, "Rust keeps codes as numbers and splits them for targets alone"),
        ("ink_taps_bends", Except::Missing, "both pairs side by side; ink_tap_bends is one"),
        ("ink_taps_depth_soft", Except::Missing, "four taps side by side; depth_soft is one"),
        ("ink_taps_depth_thresholds", Except::Missing, "four taps side by side; ink_tap_depth_threshold is one"),
        ("ink_taps_normals_differ", Except::Missing, "four taps side by side; ink_tap_normal_differs is one"),
        ("ink_taps_normals_soft", Except::Missing, "four taps side by side; ink_tap_normal_soft is one"),
        ("ink_taps_shadows_differ", Except::Missing, "four taps side by side; ink_tap_shadow_differs is one"),
        (
            "ink_shadow_background",
            Except::Parameters,
            "Rust takes the layout, WGSL the one number of it that is needed",
        ),
        ("ink_shadow_differs", Except::Types, "four taps side by side, one in Rust"),
        ("ink_shadow_region", Except::Parameters, "Rust takes the layout, WGSL the one number of it that is needed"),
        ("ink_oct_encode", Except::Types, "integers are in f32 in WGSL, where their arithmetic is exact and faster"),
        ("ink_oct_vector", Except::Types, "integers are in f32 in WGSL, where their arithmetic is exact and faster"),
        ("ink_oct_load", Except::Types, "integers are in f32 in WGSL, where their arithmetic is exact and faster"),
        ("ink_oct_decode", Except::Types, "integers are in f32 in WGSL, where their arithmetic is exact and faster"),
    ],
};

fn source(path: &str) -> String {
    let path = format!("{}/src/{path}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

#[test]
fn functions_have_the_signatures_of_the_rust_ones() {
    let module = validated(WGSL);
    let files: Vec<_> = LIBRARY.iter().map(|stem| source(&format!("{stem}.wgsl"))).collect();
    assert_eq!(files.iter().map(String::len).sum::<usize>(), WGSL.len(), "a file of the library is not compared");
    let differences: Vec<_> = (LIBRARY.iter().zip(&files))
        .flat_map(|(stem, wgsl)| TWINS.differences(&module, wgsl, &source(&format!("{stem}.rs"))))
        .collect();
    assert!(differences.is_empty(), "{}", differences.join("\n"));
    for (name, ..) in TWINS.exceptions {
        assert!(WGSL.contains(&format!("fn {name}(")), "an exception for {name}, which is not in the library");
    }
}

#[test]
fn signatures_that_differ_are_found() {
    let wgsl = "fn ink_a(x: f32, y: f32) -> f32 { return x - y; } fn ink_b(taps: vec4<f32>) -> u32 { return 1u; }";
    let module = validated(wgsl);
    let count = |rust: &str| TWINS.differences(&module, wgsl, rust).len();
    let right = "fn ink_a(x: f64, y: f32) -> f64 { x - y } fn ink_b(taps: [f64; 4]) -> u32 { 1 }";
    assert_eq!(count(right), 0);
    for (what, from, to) in [
        ("another order", "x: f64, y: f32", "y: f32, x: f64"),
        ("another name", "y: f32", "z: f32"),
        ("another type", "x: f64", "x: u32"),
        ("another number of elements", "[f64; 4]", "[f64; 3]"),
        ("another result", "-> u32", "-> i32"),
        ("another function", "ink_b", "ink_c"),
        ("one parameter more", "y: f32", "y: f32, z: f32"),
    ] {
        assert_eq!(count(&right.replace(from, to)), 1, "{what}");
    }
}

fn layout(name: &str) -> (Vec<(String, usize)>, usize) {
    let module = validated(WGSL);
    let (_, found) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)).unwrap();
    let TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no struct") };
    let members = members.iter().map(|m| (m.name.clone().unwrap(), m.offset as usize)).collect();
    (members, *span as usize)
}

macro_rules! assert_layout {
    ($wgsl:literal, $rust:ty, [$($field:ident),*]) => {{
        let (members, span) = layout($wgsl);
        let members: Vec<_> = members.into_iter().filter(|(name, _)| !name.starts_with("padding")).collect();
        assert_eq!(members, [$((stringify!($field).to_owned(), offset_of!($rust, $field))),*]);
        assert_eq!(span, size_of::<$rust>());
    }};
}

#[test]
fn uniforms_have_the_layout_of_the_shader() {
    assert_layout!("InkDepthCode", DepthCode, [scale, bias, most, parallel]);
    assert_layout!(
        "InkFilter",
        FilterUniform,
        [
            tests,
            normal_cos2,
            depth_slack,
            depth_base,
            depth_step,
            depth_shift,
            weight,
            normal_cos,
            softness,
            region_mask,
            shadow_bits
        ]
    );
    assert_layout!("InkInker", InkerUniform, [form, normal_cos, normal_fall, depth_delta, softness]);
    assert_layout!("InkPrinted", PrintedUniform, [normal_threshold, depth_threshold, depth_form, depth_codes]);
    assert_layout!(
        "InkSeparate",
        SeparateUniform,
        [
            normal_cos,
            normal_biased,
            softness,
            weight,
            depth_threshold,
            depth_scale,
            depth_bias,
            depth_clear,
            depth_is_buffer,
            parallel,
            plain_form
        ]
    );
    assert_layout!("InkComposite", CompositeUniform, [line, form, alpha_less, alpha_reference]);
}

const FULLSCREEN: &str = include_str!("../src/pass/fullscreen.wgsl");

/// The passes' own shaders, as they use them: after the library and the triangle.
const PASSES: [(&str, &[&str]); 6] = [
    (concat!(include_str!("../src/pass/taps.wgsl"), include_str!("../src/pass/fused.wgsl")), &["fs_fused"]),
    (concat!(include_str!("../src/pass/taps.wgsl"), include_str!("../src/pass/separate.wgsl")), &["fs_separate"]),
    (
        concat!(include_str!("../src/pass/taps.wgsl"), include_str!("../src/pass/printed.wgsl")),
        &["fs_printed", "fs_inker"],
    ),
    (include_str!("../src/pass/step.wgsl"), &["fs_step"]),
    (include_str!("../src/pass/disc.wgsl"), &["fs_bits", "fs_row", "fs_column", "fs_resolve"]),
    (include_str!("../src/pass/composite.wgsl"), &["fs_composite"]),
];

#[test]
fn passes_validate() {
    for (pass, entry_points) in PASSES {
        let module = validated(&[WGSL, FULLSCREEN, pass].concat());
        let found: Vec<_> = module.entry_points.iter().map(|entry| entry.name.as_str()).collect();
        assert_eq!(found[0], "vs_fullscreen");
        assert_eq!(found[1..], *entry_points);
    }
}

#[test]
fn serves_a_pass() {
    let shader = "
        @group(0) @binding(0) var<uniform> u_filter: InkFilter;
        @group(0) @binding(1) var<uniform> u_composite: InkComposite;
        @group(0) @binding(2) var g_buffer: texture_2d<u32>;
        @group(0) @binding(3) var painted: texture_2d<f32>;
        fn tap(at: vec2<i32>) -> InkTap {
            return ink_texel64_tap(textureLoad(g_buffer, at, 0).xy);
        }
        @fragment
        fn fs_lines(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
            let at = vec2<i32>(position.xy);
            let reach = ink_reach(vec2<u32>(at), textureDimensions(g_buffer), vec2<u32>(1u));
            let ink = ink_fused(
                u_filter, tap(at), tap(at + ink_tap(0u, INK_STEPS_DIAGONAL, reach)), tap(at + ink_tap(1u, INK_STEPS_DIAGONAL, reach)),
                tap(at + ink_tap(2u, INK_STEPS_DIAGONAL, reach)), tap(at + ink_tap(3u, INK_STEPS_DIAGONAL, reach)));
            let color = textureLoad(painted, at, 0);
            return vec4(ink_composite(color.rgb, ink, u_composite), color.a);
        }
        @group(1) @binding(0) var<uniform> u_code: InkDepthCode;
        @fragment
        fn fs_surface(@builtin(position) position: vec4<f32>, @location(0) normal: vec3<f32>) -> @location(0) vec2<u32> {
            return ink_texel64_pack(normal, 7u, 1.0 / position.w, u_code);
        }
        @group(2) @binding(0) var sites: texture_2d<u32>;
        @fragment
        fn fs_flood(@builtin(position) position: vec4<f32>) -> @location(0) u32 {
            let at = vec2<i32>(position.xy);
            let size = vec2<i32>(textureDimensions(sites));
            var best = textureLoad(sites, at, 0).x;
            for (var side = -1; side <= 1; side += 2) {
                let offset = vec2<i32>(4 * side, 0);
                let inside = all(at + offset >= vec2<i32>(0)) && all(at + offset < size);
                let site = textureLoad(sites, clamp(at + offset, vec2<i32>(0), size - 1), 0).x;
                best = ink_flood_take(best, select(INK_FLOOD_NONE, site, inside), offset);
            }
            return best;
        }";
    assert_eq!(validated(&format!("{WGSL}{shader}")).entry_points.len(), 3);
}

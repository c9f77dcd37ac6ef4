//! The WGSL is valid, its signatures are those of the Rust functions, and the uniforms have the layout that naga computes.

mod signatures;

use std::mem::{offset_of, size_of};

use glam::Vec3;
use naga::{Module, TypeInner};
use npr_toon::border::{MAX_BORDER, MIN_BORDER};
use npr_toon::painter::PainterUniform;
use npr_toon::ramp::{MAX_STOPS, Ramp, RampBlend, RampUniform, TOON_STOPS_OVERRIDE};
use npr_toon::table::{Corner, Ramp2d, Ramp2dUniform};
use npr_toon::{Bands, MAX_BANDS, MIN_SUM, MIN_WIDTH, TOON_BANDS_OVERRIDE, ToonError, ToonUniform, WGSL};
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
    // Every override must have a default value.
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
    for (_, kind) in module.types.iter() {
        if let Some(name) = kind.name.as_deref() {
            assert!(name.starts_with("Toon"), "{name}");
        }
    }
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
        ("toon_unit", "Rust calls DVec3::normalize_or_zero"),
        ("toon_step", "a single border for shaders without bands"),
        ("toon_pixel_width", "takes derivatives, which Rust does not have"),
        ("toon_pixel_border_width", "takes derivatives, which Rust does not have"),
    ],
    renamed: &[("toon_band", "toon_band", "Rust has a function of its own for width 0, toon_band_hard")],
    types: &[
        ("Bands", "ToonBands", "the uniform of the style"),
        ("Ramp", "ToonRamp", "the uniform of the style"),
        ("Ramp2d", "ToonRamp2d", "the uniform of the style"),
        ("Painter", "ToonPainter", "the uniform of the style"),
        ("LightKind", "vec4<f32>", "a direction with w 0, or a position with w 1"),
    ],
    split: &[
        (
            "toon_half_lambert",
            "parameters",
            &[("scale", "f32"), ("bias", "f32"), ("squared", "u32")],
            "the fields of HalfLambert, which has no uniform",
        ),
        (
            "toon_highlight",
            "bands",
            &[("threshold", "f32"), ("strength", "f32"), ("lit_only", "u32")],
            "the fields of Highlight that matter, so that shaders without ToonBands can call it",
        ),
    ],
    types_of: &[("toon_table_mix", "DVec3", "vec4<f32>", "textureLoad returns four components, and alpha is not read")],
};

/// The differences between the WGSL files, with one text replaced, and the Rust files.
fn differences_with(old: &str, new: &str) -> Vec<String> {
    let pairs =
        pairs!["light", "border", "half_lambert", "source", "ramp", "row", "table", "painter", "normal", "x_toon"];
    let changed = WGSL.replace(old, new);
    assert!(old == new || changed != WGSL, "{old} is not there");
    differences(&validated(&changed), &pairs, &EXCEPTIONS)
}

#[test]
fn functions_have_the_signatures_of_the_rust_ones() {
    assert_eq!(differences_with("", ""), [""; 0]);
}

#[test]
fn a_different_signature_is_found() {
    let swapped =
        differences_with("fn toon_width(along_x: f32, along_y: f32)", "fn toon_width(along_y: f32, along_x: f32)");
    assert!(matches!(&swapped[..], [line] if line.starts_with("toon_width: ")), "{swapped:?}");
    let missing = differences_with("toon_overbright", "toon_over_bright");
    assert!(matches!(&missing[..], [line] if line.starts_with("toon_over_bright: ")), "{missing:?}");
}

/// The members of a WGSL struct with their byte offsets, without padding, and its size in bytes.
fn layout(name: &str) -> (Vec<(String, usize)>, usize) {
    let module = validated(WGSL);
    let (_, found) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)).unwrap();
    let TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no struct") };
    let members = members.iter().map(|m| (m.name.clone().unwrap(), m.offset as usize));
    (members.filter(|(name, _)| !name.starts_with("padding")).collect(), *span as usize)
}

macro_rules! assert_layout {
    ($wgsl:literal, $rust:ty, [$($field:ident),*]) => {{
        let (members, span) = layout($wgsl);
        assert_eq!(members, [$((stringify!($field).to_owned(), offset_of!($rust, $field))),*]);
        assert_eq!(span, size_of::<$rust>());
    }};
}

#[test]
fn uniforms_have_the_layout_of_the_shader() {
    assert_layout!(
        "ToonBands",
        ToonUniform,
        [bands, highlight, count, highlight_strength, highlight_lit_only, antialias, absolute]
    );
    assert_layout!("ToonRamp", RampUniform, [stops, is_smooth]);
    assert_layout!("ToonRamp2d", Ramp2dUniform, [a, b, corner]);
    assert_layout!("ToonPainter", PainterUniform, [light_a, light_b, light_color, brightness]);
    let sizes = [size_of::<ToonUniform>(), size_of::<RampUniform>(), size_of::<Ramp2dUniform>()];
    assert_eq!((sizes, size_of::<PainterUniform>()), ([176, 144, 304], 64));
}

/// The constants of the WGSL are equal to those of the Rust files.
#[test]
fn constants_are_the_same() {
    for constant in [
        format!("const TOON_MAX_BANDS: u32 = {MAX_BANDS}u;"),
        format!("const TOON_MAX_STOPS: u32 = {MAX_STOPS}u;"),
        format!("const TOON_MIN_WIDTH: f32 = {MIN_WIDTH:e};"),
        format!("const TOON_MIN_SUM: f32 = {MIN_SUM:e};"),
        format!("const TOON_MIN_BORDER: f32 = {MIN_BORDER:e};"),
        format!("const TOON_MAX_BORDER: f32 = {MAX_BORDER};"),
    ] {
        assert!(WGSL.contains(&constant), "{constant}");
    }
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
fn serves_a_painter() {
    let shader = "
        @group(0) @binding(0) var<uniform> u_painter: ToonPainter;
        @group(0) @binding(1) var<uniform> u_ramps: ToonRamp2d;
        @group(0) @binding(2) var shades: texture_2d<f32>;
        @group(0) @binding(3) var<uniform> u_material: vec4<f32>;
        @fragment
        fn computed(@location(0) at: vec3<f32>, @location(1) normal: vec3<f32>) -> @location(0) vec4<f32> {
            let uv = toon_painter_uv(u_painter, at, normal);
            let widths = vec2(toon_pixel_border_width(uv.x), toon_pixel_border_width(uv.y));
            let shade = toon_ramp_2d(u_ramps, uv, widths);
            return toon_paint(u_painter, shade, toon_material(u_material, vec4(1.0)));
        }
        @fragment
        fn from_an_image(@location(0) at: vec3<f32>, @location(1) normal: vec3<f32>) -> @location(0) vec4<f32> {
            let uv = toon_painter_uv(u_painter, at, normal);
            let size = textureDimensions(shades);
            let across = toon_row_taps(toon_half_lambert(0.5, 0.5, 1u, uv.x), 0.0, 1.0, size.x);
            let down = toon_row_taps(uv.y, 0.0, 1.0, size.y);
            let shade = toon_table_mix(
                textureLoad(shades, vec2(across.left, down.left), 0),
                textureLoad(shades, vec2(across.right, down.left), 0),
                textureLoad(shades, vec2(across.left, down.right), 0),
                textureLoad(shades, vec2(across.right, down.right), 0),
                across.share, down.share);
            return toon_paint(u_painter, shade.rgb, u_material);
        }";
    assert_eq!(validated(&format!("{WGSL}{shader}")).entry_points.len(), 2);
}

#[test]
fn packs_ramps() {
    let ramps = Ramp2d {
        corner: Some(Corner { threshold: 0.9, color: Vec3::X }),
        ..Ramp2d::from_bands(&Bands::three_diffuse_bands()).unwrap()
    };
    let uniform = Ramp2dUniform::new(&ramps).unwrap();
    assert_eq!(uniform.a.stops[0], [0.2, 0.2, 0.2, -1.0]);
    assert_eq!(uniform.a.stops[2], [0.9, 0.9, 1.0, 0.8]);
    // Unused entries repeat the last colour.
    assert_eq!(uniform.b.stops[7], [0.9, 0.9, 1.0, 1e4]);
    assert_eq!((uniform.a.is_smooth, uniform.corner), (0, [1.0, 0.0, 0.0, 0.9]));
    let smooth = Ramp { blend: RampBlend::Smooth, ..ramps.a.clone() };
    assert_eq!(RampUniform::new(&smooth).unwrap().is_smooth, 1);
    assert_eq!(Ramp2dUniform::new(&Ramp2d { corner: None, ..ramps }).unwrap().corner[3], 1e4);
}

#[test]
fn packs_bands() {
    let uniform = ToonUniform::new(&Bands::diffuse_and_specular()).unwrap();
    assert_eq!(uniform.bands[0], [0.2, 0.2, 0.2, 0.1]);
    // Unused entries repeat the last tone.
    assert_eq!((uniform.bands[1], uniform.bands[7]), ([0.6, 0.6, 0.6, 1e4], [0.6, 0.6, 0.6, 1e4]));
    assert_eq!(uniform.highlight, [0.9, 0.9, 1.0, 0.8]);
    assert_eq!((uniform.count, uniform.highlight_strength), (2, 1.0));
    assert_eq!((uniform.highlight_lit_only, uniform.antialias, uniform.absolute), (0, 0, 0));
    let absolute = Bands { absolute: true, ..Bands::diffuse_and_specular() };
    assert_eq!(ToonUniform::new(&absolute).unwrap().absolute, 1);
    assert_eq!(ToonUniform::new(&Bands::hard_shading()).unwrap().highlight_strength, 0.0);
}

#[test]
fn refuses_what_does_not_fit() {
    let with = |count: usize| Bands {
        thresholds: (1..count).map(|i| i as f32 / count as f32).collect(),
        tones: vec![Vec3::ONE; count],
        ..Bands::three_diffuse_bands()
    };
    assert!(ToonUniform::new(&with(MAX_BANDS)).is_ok());
    assert_eq!(ToonUniform::new(&with(9)), Err(ToonError::TooManyTones { tones: 9, max: 8 }));
    assert_eq!(ToonUniform::new(&with(0)), Err(ToonError::NoTones));
}

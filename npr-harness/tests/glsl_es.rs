//! Tests that every shader for wgpu's GL backend translates to GLSL ES 3.00, the language of WebGL2.
//!
//! Rendering tests do not cover this, because Mesa's EGL offers desktop GL, which wgpu then uses. Compute shaders, and
//! the vertex shader that reads storage buffers, are replaced by other methods on WebGL2 and are not tested.
#![cfg(feature = "gpu")]

use naga::back::glsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{ShaderStage, TypeInner};
use npr_harness::gpu::surface_wgsl;
use npr_harness::style::{Style, styles};

const LINE: &str = include_str!("../../npr-outline/src/segment.wgsl");
const CONTOUR: &str = include_str!("../../npr-outline/src/contour.wgsl");
const LINE_INK: &str = include_str!("../../npr-outline/src/line_ink.wgsl");
const LINE_UNVEILED: &str = include_str!("../../npr-outline/src/line_unveiled.wgsl");
const LINE_VEILED: &str = include_str!("../../npr-outline/src/line_veiled.wgsl");
const LINE_PASS: &str = include_str!("../../npr-outline/src/line_pass.wgsl");
const NORMAL_FORMAT: &str = include_str!("../../npr-outline/src/normal_format.wgsl");
const FIN_PRINTED: &str = include_str!("../../npr-outline/src/fin_printed.wgsl");
const FIN_PASS: &str = include_str!("../../npr-outline/src/fin_pass.wgsl");
const HULL: &str = include_str!("../../npr-outline/src/hull.wgsl");
const HULL_PASS: &str = include_str!("../../npr-outline/src/hull_pass.wgsl");
const SHADOW_VOLUME: &str = include_str!("../../npr-outline/src/shadow_volume.wgsl");
const SHADOW_PASS: &str = include_str!("../../npr-outline/src/shadow_pass.wgsl");
const SHADOW_MASK: &str = include_str!("../../npr-outline/src/shadow_mask.wgsl");
const FULLSCREEN: &str = include_str!("../../npr-imagespace/src/pass/fullscreen.wgsl");
const TAPS: &str = include_str!("../../npr-imagespace/src/pass/taps.wgsl");
const DISC: &str = include_str!("../../npr-imagespace/src/pass/disc.wgsl");
const COMPOSITE: &str = include_str!("../../npr-imagespace/src/pass/composite.wgsl");
const PRINTED: &str = include_str!("../../npr-imagespace/src/pass/printed.wgsl");
const SEPARATE: &str = include_str!("../../npr-imagespace/src/pass/separate.wgsl");
const STEP: &str = include_str!("../../npr-imagespace/src/pass/step.wgsl");
const FUSED: &str = include_str!("../../npr-imagespace/src/pass/fused.wgsl");
const GBUFFER_TEXEL: &str = include_str!("../src/image_lines/gbuffer/texel.wgsl");
const GBUFFER_ENCODE: &str = include_str!("../src/image_lines/gbuffer/encode.wgsl");
const RESOLVE: &str = include_str!("../src/gpu/resolve.wgsl");
const SHADOW_MAP: &str = include_str!("../src/shadow/shadow_map.wgsl");

/// The value of an override constant without a default.
fn default_of(module: &naga::Module, constant: &naga::Override) -> f64 {
    let literal = |expression| match &module.global_expressions[expression] {
        naga::Expression::Constant(constant) => &module.global_expressions[module.constants[*constant].init],
        other => other,
    };
    match constant.init.map(literal) {
        Some(naga::Expression::Literal(naga::Literal::U32(value))) => f64::from(*value),
        Some(naga::Expression::Literal(naga::Literal::I32(value))) => f64::from(*value),
        Some(naga::Expression::Literal(naga::Literal::F32(value))) => f64::from(*value),
        _ => 0.0,
    }
}

/// Translates all entry points of a shader, with several values of each override constant: flags off and on; numbers at
/// their default and up to three higher values, or lower ones for counts, whose default is the maximum.
fn translate(name: &str, source: &str) -> Result<usize, String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|error| format!("{name}: {error}"))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|error| format!("{name}: {error}"))?;
    let options = glsl::Options {
        version: glsl::Version::Embedded { version: 300, is_webgl: true },
        writer_flags: glsl::WriterFlags::ADJUST_COORDINATE_SPACE,
        ..Default::default()
    };
    let mut translated = 0;
    for entry in &module.entry_points {
        assert!(entry.stage == ShaderStage::Vertex || entry.stage == ShaderStage::Fragment, "{name}: {}", entry.name);
        for value in 0..=3 {
            let constants = module.overrides.iter().map(|(_, constant)| {
                let is_flag = matches!(module.types[constant.ty].inner, TypeInner::Scalar(naga::Scalar::BOOL));
                let (default, step) = (default_of(&module, constant), f64::from(value));
                let value = match is_flag {
                    true => f64::from(value & 1),
                    false if default > 3.0 => default - step,
                    false => default + step,
                };
                (constant.name.clone().expect("constants have names"), value)
            });
            let constants = constants.collect();
            let at = Some((entry.stage, entry.name.as_str()));
            let (module, info) = naga::back::pipeline_constants::process_overrides(&module, &info, at, &constants)
                .map_err(|error| format!("{name}, {}: {error}", entry.name))?;
            let pipeline =
                glsl::PipelineOptions { shader_stage: entry.stage, entry_point: entry.name.clone(), multiview: None };
            let mut text = String::new();
            glsl::Writer::new(&mut text, &module, &info, &options, &pipeline, Default::default())
                .and_then(|mut writer| writer.write())
                .map_err(|error| format!("{name}, {} with {value}: {error}", entry.name))?;
            assert!(text.starts_with("#version 300 es"), "{text}");
            translated += 1;
        }
    }
    Ok(translated)
}

#[test]
fn every_shader_translates() {
    let ink = |source: &str| [npr_imagespace::WGSL, FULLSCREEN, source].concat();
    let shaders = vec![
        ("resolve", RESOLVE.into()),
        ("shadow map", SHADOW_MAP.into()),
        ("lines", [CONTOUR, LINE, LINE_INK, LINE_UNVEILED, LINE_PASS].concat()),
        ("lines behind see-through surfaces", [CONTOUR, LINE, LINE_INK, LINE_VEILED, LINE_PASS].concat()),
        ("printed fins", [NORMAL_FORMAT, FIN_PRINTED, FIN_PASS].concat()),
        ("inverted hulls", [HULL, HULL_PASS].concat()),
        ("shadow volumes", [SHADOW_VOLUME, SHADOW_PASS].concat()),
        ("shadow mask", SHADOW_MASK.into()),
        ("disc", ink(DISC)),
        ("composite", ink(COMPOSITE)),
        ("printed filters", ink(&[TAPS, PRINTED].concat())),
        ("separate filter", ink(&[TAPS, SEPARATE].concat())),
        ("step", ink(STEP)),
        ("fused filter", ink(&[TAPS, FUSED].concat())),
        ("G-buffer", [npr_imagespace::WGSL, GBUFFER_TEXEL, GBUFFER_ENCODE].concat()),
    ];
    let surface = |style: Style| (style.name, surface_wgsl(&style.shade).expect("good numbers"));
    let named = shaders.iter().map(|(name, source): &(&str, String)| (name.to_string(), source.clone()));
    let all: Vec<(String, String)> = named.chain(styles().into_iter().map(surface)).collect();
    let (mut translated, mut failed) = (0, Vec::new());
    for (name, source) in &all {
        match translate(name, source) {
            Ok(count) => translated += count,
            Err(error) => failed.push(error),
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    assert!(translated > 4 * 40, "{translated}");
}

/// Each shader contains a construct that has failed here, so the test above can fail.
#[test]
fn what_glsl_es_cannot_say_is_noticed() {
    let fragment = |declarations: &str, body: &str| {
        format!("{declarations}\n@fragment fn fs() -> @location(0) vec4<f32> {{ return vec4<f32>({body}); }}")
    };
    let depth = "@group(0) @binding(0) var depth: texture_depth_2d;";
    let two = "@group(0) @binding(0) var image: texture_2d<f32>;
        @group(0) @binding(1) var one: sampler;
        @group(0) @binding(2) var other: sampler;";
    let sampled = |name| format!("textureSampleLevel(image, {name}, vec2<f32>(0.5), 0.0).x");
    for (name, source) in [
        ("a load of a depth texture", fragment(depth, "textureLoad(depth, vec2<i32>(0), 0)")),
        ("two samplers of one texture", fragment(two, &[sampled("one"), sampled("other")].join(" + "))),
        (
            "a count of levels",
            fragment("@group(0) @binding(0) var image: texture_2d<f32>;", "f32(textureNumLevels(image))"),
        ),
    ] {
        assert!(translate(name, &source).is_err(), "{name} translates");
    }
}

//! Checks of npr-hatch: lookups in the textures of maps, as uploaded.

use crate::check::{Allowed, Check, Extra, Given, MODELS, compare_with};
use crate::random::Random;
use glam::{DVec2, DVec4, Vec2, Vec4};
use npr_harness::gpu::GpuContext;
use npr_hatch::lookup::{HatchFootprint, hatch_ink, hatch_texels};
use npr_hatch::upload::{TamChannels, hatch_sampler, hatch_threshold_sampler, upload_tam, upload_thresholds};
use npr_hatch::{Tam, TamParameters, Thresholds, draw, even_tones};
use std::sync::Arc;

/// The number of maps; models share them.
const MAPS: usize = 4;

/// Random thresholds, so that neighbours and levels are as different as possible, and those of strokes.
fn thresholds() -> Vec<Arc<Thresholds>> {
    let random = Random::new(10);
    let any = |side: u32| {
        let texel = || random.pick(&[0, 1, 65534, 65535, random.below(65536) as u16, random.below(65536) as u16]);
        let level = |level: u32| (0..(side >> level).pow(2)).map(|_| texel()).collect();
        Thresholds { side, levels: (0..=side.trailing_zeros()).map(level).collect() }
    };
    let parameters = TamParameters { side: 64, ..TamParameters::default() };
    let drawn = Thresholds::new(&draw(&parameters, None).expect("the defaults are valid"), &parameters, None);
    let maps: [_; MAPS] = [any(1), any(16), any(128), drawn].map(Arc::new);
    (0..MODELS).map(|number| maps[number % MAPS].clone()).collect()
}

/// The same for six nested tones.
fn tams() -> Vec<Arc<Tam>> {
    let random = Random::new(11);
    let any = |side: u32| {
        let mut images = vec![Vec::new(); 6 * (side.trailing_zeros() as usize + 1)];
        let levels = images.len() / 6;
        for level in 0..levels {
            for _ in 0..(side >> level).pow(2) {
                let mut texels = [(); 6].map(|()| random.pick(&[0, 255, random.below(256) as u8]));
                texels.sort_unstable();
                for (tone, &texel) in texels.iter().rev().enumerate() {
                    images[tone * levels + level].push(texel);
                }
            }
        }
        Tam { tones: even_tones(6), side, images }
    };
    let parameters = TamParameters { side: 64, ..TamParameters::default() };
    let drawn = draw(&parameters, None).expect("the defaults are valid").tam;
    let maps: [_; MAPS] = [any(8), any(16), any(128), drawn].map(Arc::new);
    (0..MODELS).map(|number| maps[number % MAPS].clone()).collect()
}

/// `a`: a position and a spread; the first two of `b`: a level from the finest to the coarsest, and a tone.
fn look(random: &Random, side: u32) -> [Vec4; 2] {
    let last = side.trailing_zeros() as f32;
    let whole = random.below(side.trailing_zeros() + 1) as f32;
    let level = random.pick(&[whole, 0.0, last, random.range(0.0, last), random.range(0.0, last)]);
    let spread = Vec2::new(random.range(-0.3, 0.3), random.range(-0.3, 0.3));
    let spread = random.pick(&[Vec2::ZERO, spread, spread * 0.1]);
    // Between thresholds, so that no hard threshold equals it.
    let between = (random.below(65535) as f32 + 0.5) / 65535.0;
    let near = random.below(400) as f32 / 65535.0;
    let tone = match random.below(16) {
        0 => random.pick(&[0.0, 1.0, -0.1, 1.1]),
        1 => random.pick(&[near, 1.0 - near]) + 0.5 / 65535.0,
        _ => between,
    };
    let at = Vec4::new(random.range(-3.0, 3.0), random.range(-3.0, 3.0), spread.x, spread.y);
    [at, Vec4::new(level, tone, 0.0, 0.0)]
}

fn inked(random: &Random, map: &Arc<Thresholds>) -> Given {
    let [at, mut asked] = look(random, map.side);
    asked.z = random.pick(&[1.0 / 64.0, 1.0 / 64.0, 1.0 / 64.0, 0.05, 0.0]);
    [at, asked, Vec4::ZERO, Vec4::ZERO]
}

fn uv(g: &Given) -> DVec2 {
    g[0].as_dvec4().truncate().truncate()
}

fn footprint(g: &Given) -> HatchFootprint {
    let [_, _, x, y] = g[0].as_dvec4().to_array();
    HatchFootprint { level: f64::from(g[1].x), spread: DVec2::new(x, y) }
}

fn ink(map: &Thresholds, g: &Given, footprint: HatchFootprint) -> DVec4 {
    DVec4::splat(hatch_ink(map, uv(g), footprint, f64::from(g[1].y), f64::from(g[1].z)))
}

/// For up to 128 texels: a sample's position, up to 3, is rounded by 2⁻²³, which is 2⁻¹⁶ texels, and again when half a
/// texel is subtracted; between texels of extreme ink the error is 3e-5 over both axes. A threshold has an error of
/// 2⁻²³, and the width of 1/64 tone makes that 64 times as large: 1e-5 more.
fn ink_bound(_: &Arc<Thresholds>, _: &Given) -> Allowed {
    Allowed::Within(1e-4)
}

const THRESHOLDS: &str = "
    @group(0) @binding(2) var map: texture_2d<f32>;
    @group(0) @binding(3) var nearest: sampler;
    fn ink(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
        return vec4(hatch_ink(map, nearest, a.xy, HatchFootprint(b.x, a.zw), b.y, b.z));
    }
    fn ink_at(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
        return vec4(hatch_ink_at(map, nearest, a.xy, b.x, hatch_soft_tone(b.y, b.z), b.z));
    }
    // The side is a power of two, so the product is exact.
    fn texel_of_level(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
        let level = i32(b.x);
        let side = textureDimensions(map).x >> u32(level);
        return vec4(hatch_ink_texel(map, nearest, vec2<u32>(fract(a.xy) * f32(side)), side, level));
    }
    fn ink_of_level(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
        return vec4(hatch_ink_of_level(map, nearest, a.xy, i32(b.x), hatch_soft_tone(b.y, b.z), b.z));
    }";

const INK: &[Check<Arc<Thresholds>>] = &[
    Check {
        name: "hatch_ink",
        wgsl: "ink(a, b)",
        given: inked,
        rust: |map, g| ink(map, g, footprint(g)),
        allowed: ink_bound,
    },
    Check {
        name: "hatch_ink_at",
        wgsl: "ink_at(a, b)",
        given: inked,
        rust: |map, g| ink(map, g, HatchFootprint { spread: DVec2::ZERO, ..footprint(g) }),
        allowed: ink_bound,
    },
    Check {
        name: "hatch_ink_of_level",
        wgsl: "ink_of_level(a, b)",
        given: inked,
        rust: |map, g| ink(map, g, HatchFootprint { level: footprint(g).level.floor(), spread: DVec2::ZERO }),
        allowed: ink_bound,
    },
    Check {
        name: "hatch_ink_texel",
        wgsl: "texel_of_level(a, b)",
        given: inked,
        rust: |map, g| {
            let level = g[1].x as usize;
            let side = map.side as usize >> level;
            let [x, y] = [g[0].x, g[0].y].map(|uv| ((uv - uv.floor()) * side as f32) as usize);
            DVec4::splat(f64::from(map.levels[level][y * side + x]) / 65535.0)
        },
        // Two 8-bit texels, each rounded to an f32.
        allowed: |_, _| Allowed::Within(3e-7),
    },
];

fn sampled(random: &Random, tam: &Arc<Tam>) -> Given {
    let [at, asked] = look(random, tam.side);
    [at, asked, Vec4::ZERO, Vec4::ZERO]
}

/// A sampler may quantize weights to 1/256, along both axes and between levels, texels may differ by the full range,
/// and the result is rounded: an 8-bit step for each.
fn texels_bound(_: &Arc<Tam>, _: &Given) -> Allowed {
    Allowed::Within(4.0 / 255.0)
}

/// Positions are rounded by 2⁻²⁴ of up to 128 texels of the largest map, times the full range between two texels, along
/// both axes: 1e-4. Rounding a texel below 1 to a half float adds up to 2⁻¹².
fn half_float_bound(_: &Arc<Tam>, _: &Given) -> Allowed {
    Allowed::Within(4e-4)
}

const TONES: &str = "
    @group(0) @binding(2) var light: texture_2d<f32>;
    @group(0) @binding(3) var dark: texture_2d<f32>;
    @group(0) @binding(4) var trilinear: sampler;
    fn texels(a: vec4<f32>, b: vec4<f32>) -> HatchTexels {
        return hatch_texels(light, dark, trilinear, a.xy, HatchFootprint(b.x, a.zw));
    }
    fn texels_at(a: vec4<f32>, b: vec4<f32>) -> HatchTexels {
        return hatch_texels_at(light, dark, trilinear, a.xy, b.x);
    }";

fn texel_checks(allowed: fn(&Arc<Tam>, &Given) -> Allowed) -> [Check<Arc<Tam>>; 3] {
    [
        Check {
            name: "hatch_texels, lighter",
            wgsl: "vec4(texels(a, b).light, 0.0)",
            given: sampled,
            rust: |tam, g| hatch_texels(tam, uv(g), footprint(g)).0.extend(0.0),
            allowed,
        },
        Check {
            name: "hatch_texels, darker",
            wgsl: "vec4(texels(a, b).dark, 0.0)",
            given: sampled,
            rust: |tam, g| hatch_texels(tam, uv(g), footprint(g)).1.extend(0.0),
            allowed,
        },
        Check {
            name: "hatch_texels_at, lighter",
            wgsl: "vec4(texels_at(a, b).light, 0.0)",
            given: sampled,
            rust: |tam, g| {
                hatch_texels(tam, uv(g), HatchFootprint { spread: DVec2::ZERO, ..footprint(g) }).0.extend(0.0)
            },
            allowed,
        },
    ]
}

pub fn calls() -> Vec<&'static str> {
    vec![THRESHOLDS, TONES]
}

fn library() -> String {
    [npr_hatch::WGSL, npr_hatch::LOOKUP_WGSL].concat()
}

fn texture(sample_type: wgpu::TextureSampleType) -> wgpu::BindingType {
    wgpu::BindingType::Texture { sample_type, view_dimension: wgpu::TextureViewDimension::D2, multisampled: false }
}

#[test]
fn ink_from_a_texture_is_its_reference() {
    let Some(gpu) = crate::device() else { return };
    let models = thresholds();
    let upload = |map: &Arc<Thresholds>| upload_thresholds(&gpu.device, &gpu.queue, map).expect("it fits");
    let views: Vec<_> = models[..MAPS].iter().map(|map| upload(map).create_view(&Default::default())).collect();
    let sampler = hatch_threshold_sampler(&gpu.device);
    let resources = |number: usize| {
        vec![wgpu::BindingResource::TextureView(&views[number % MAPS]), wgpu::BindingResource::Sampler(&sampler)]
    };
    let extra = Extra {
        declarations: THRESHOLDS.into(),
        layout: vec![
            texture(wgpu::TextureSampleType::Float { filterable: false }),
            wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
        ],
        resources: (0..MODELS).map(resources).collect(),
    };
    compare_with(&gpu, &library(), &extra, &[], &models, INK);
}

/// Hardware filters with an 8-bit fraction.
#[test]
fn texels_from_textures_are_their_reference() {
    let Some(gpu) = crate::device() else { return };
    compare_texels(&gpu, TamChannels::Bytes, texels_bound);
    compare_texels(&gpu, TamChannels::HalfFloats, if gpu.is_software() { half_float_bound } else { texels_bound });
}

fn compare_texels(gpu: &GpuContext, channels: TamChannels, allowed: fn(&Arc<Tam>, &Given) -> Allowed) {
    let models = tams();
    let upload = |tam: &Arc<Tam>| {
        let textures = upload_tam(&gpu.device, &gpu.queue, tam, channels).expect("it is valid, and fits");
        [textures.light, textures.dark].map(|texture| texture.create_view(&Default::default()))
    };
    let views: Vec<_> = models[..MAPS].iter().map(upload).collect();
    let sampler = hatch_sampler(&gpu.device);
    let resources = |number: usize| {
        let [light, dark] = &views[number % MAPS];
        let [light, dark] = [light, dark].map(wgpu::BindingResource::TextureView);
        vec![light, dark, wgpu::BindingResource::Sampler(&sampler)]
    };
    let float = texture(wgpu::TextureSampleType::Float { filterable: true });
    let extra = Extra {
        declarations: TONES.into(),
        layout: vec![float, float, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)],
        resources: (0..MODELS).map(resources).collect(),
    };
    compare_with(gpu, &library(), &extra, &[], &models, &texel_checks(allowed));
}

// Lookups in the textures of a map, which the caller binds and hands on; after hatch.wgsl. See the Rust functions of the
// same names.

// What two textures of three tones each have at a place; the sampler repeats, and filters texels and levels.
struct HatchTexels {
    light: vec3<f32>,
    dark: vec3<f32>,
}

fn hatch_texels_at(
    light: texture_2d<f32>, dark: texture_2d<f32>, trilinear: sampler, uv: vec2<f32>, level: f32,
) -> HatchTexels {
    // Levels are mixed here: samplers mix them in steps of 1/256 and may round what they have of each to 8 bits. (On
    // llvmpipe that takes 6 to 8 % of a frame more, and errs by 1.4 of 255 instead of 2.1.)
    let finer = floor(level);
    let share = level - finer;
    return HatchTexels(
        mix(
            textureSampleLevel(light, trilinear, uv, finer).rgb, textureSampleLevel(light, trilinear, uv, finer + 1.0).rgb,
            share,
        ),
        mix(
            textureSampleLevel(dark, trilinear, uv, finer).rgb, textureSampleLevel(dark, trilinear, uv, finer + 1.0).rgb,
            share,
        ),
    );
}

fn hatch_texels(
    light: texture_2d<f32>, dark: texture_2d<f32>, trilinear: sampler, uv: vec2<f32>, footprint: HatchFootprint,
) -> HatchTexels {
    // One loop, whether it runs once or four times: software adapters run through what they branch around.
    let samples = hatch_samples(footprint);
    var sum = HatchTexels(vec3<f32>(0.0), vec3<f32>(0.0));
    for (var i = 0; i < samples; i++) {
        let at = uv + footprint.spread * (-0.375 + 0.25 * f32(i));
        let one = hatch_texels_at(light, dark, trilinear, at, footprint.level);
        sum.light += one.light;
        sum.dark += one.dark;
    }
    return HatchTexels(sum.light / f32(samples), sum.dark / f32(samples));
}

// The same without a sampler: exact, where a sampler filters 8 bits in 8 bits. Software adapters are faster at it, too (0.82
// to 0.9 of a frame on llvmpipe); others are made to sample.
fn hatch_texels_of_level(light: texture_2d<f32>, dark: texture_2d<f32>, uv: vec2<f32>, level: i32) -> HatchTexels {
    let taps = hatch_taps(uv, textureDimensions(light).x >> u32(level));
    let b = vec2<u32>(taps.high.x, taps.low.y);
    let c = vec2<u32>(taps.low.x, taps.high.y);
    return HatchTexels(
        mix(
            mix(textureLoad(light, taps.low, level).rgb, textureLoad(light, b, level).rgb, taps.share.x),
            mix(textureLoad(light, c, level).rgb, textureLoad(light, taps.high, level).rgb, taps.share.x), taps.share.y,
        ),
        mix(
            mix(textureLoad(dark, taps.low, level).rgb, textureLoad(dark, b, level).rgb, taps.share.x),
            mix(textureLoad(dark, c, level).rgb, textureLoad(dark, taps.high, level).rgb, taps.share.x), taps.share.y,
        ),
    );
}

fn hatch_texels_loaded(
    light: texture_2d<f32>, dark: texture_2d<f32>, uv: vec2<f32>, footprint: HatchFootprint,
) -> HatchTexels {
    let finer = i32(floor(footprint.level));
    let coarser = min(finer + 1, i32(textureNumLevels(light)) - 1);
    let share = footprint.level - floor(footprint.level);
    let samples = hatch_samples(footprint);
    var sum = HatchTexels(vec3<f32>(0.0), vec3<f32>(0.0));
    for (var i = 0; i < samples; i++) {
        let at = uv + footprint.spread * (-0.375 + 0.25 * f32(i));
        let fine = hatch_texels_of_level(light, dark, at, finer);
        let coarse = hatch_texels_of_level(light, dark, at, coarser);
        sum.light += mix(fine.light, coarse.light, share);
        sum.dark += mix(fine.dark, coarse.dark, share);
    }
    return HatchTexels(sum.light / f32(samples), sum.dark / f32(samples));
}

// One level of a texture of thresholds, 16 bits unsigned, compared and then filtered.
fn hatch_ink_of_level(map: texture_2d<u32>, uv: vec2<f32>, level: i32, tone: f32, width: f32) -> f32 {
    // Not by `textureDimensions(map, level)`: Mesa's llvmpipe gives all pixels of a group the size of one's level.
    let taps = hatch_taps(uv, textureDimensions(map).x >> u32(level));
    let a = textureLoad(map, taps.low, level).x;
    let b = textureLoad(map, vec2<u32>(taps.high.x, taps.low.y), level).x;
    let c = textureLoad(map, vec2<u32>(taps.low.x, taps.high.y), level).x;
    let d = textureLoad(map, taps.high, level).x;
    let texels = vec4<f32>(vec4<u32>(a, b, c, d)) / 65535.0;
    let ink = vec4<f32>(
        hatch_threshold(texels.x, tone, width), hatch_threshold(texels.y, tone, width),
        hatch_threshold(texels.z, tone, width), hatch_threshold(texels.w, tone, width),
    );
    let rows = mix(ink.xz, ink.yw, taps.share.x);
    return mix(rows.x, rows.y, taps.share.y);
}

fn hatch_ink_at(map: texture_2d<u32>, uv: vec2<f32>, level: f32, tone: f32, width: f32) -> f32 {
    let finer = floor(level);
    let share = level - finer;
    let ink = hatch_ink_of_level(map, uv, i32(finer), tone, width);
    if share > 0.0 {
        return mix(ink, hatch_ink_of_level(map, uv, i32(finer) + 1, tone, width), share);
    }
    return ink;
}

fn hatch_ink(map: texture_2d<u32>, uv: vec2<f32>, footprint: HatchFootprint, tone: f32, width: f32) -> f32 {
    let softened = hatch_softened(tone, width);
    let samples = hatch_samples(footprint);
    var ink = 0.0;
    for (var i = 0; i < samples; i++) {
        let at = uv + footprint.spread * (-0.375 + 0.25 * f32(i));
        ink += hatch_ink_at(map, at, footprint.level, softened, width);
    }
    return ink / f32(samples);
}

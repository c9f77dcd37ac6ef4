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

// A threshold of a level with `side` texels along a side: 16 bits in two channels, the higher byte in red. Through a
// sampler that takes the nearest texel of the nearest level: what GLSL makes of `textureLoad` asks for the size of the
// level, and Mesa's llvmpipe answers all pixels of a group for one's level.
fn hatch_ink_texel(map: texture_2d<f32>, nearest: sampler, texel: vec2<u32>, side: u32, level: i32) -> f32 {
    let bytes = textureSampleLevel(map, nearest, (vec2<f32>(texel) + 0.5) / f32(side), f32(level)).xy;
    return (256.0 * bytes.x + bytes.y) / 257.0;
}

// One level of a texture of thresholds, compared and then filtered.
fn hatch_ink_of_level(
    map: texture_2d<f32>, nearest: sampler, uv: vec2<f32>, level: i32, tone: f32, width: f32,
) -> f32 {
    let side = textureDimensions(map).x >> u32(level);
    let taps = hatch_taps(uv, side);
    let texels = vec4<f32>(
        hatch_ink_texel(map, nearest, taps.low, side, level),
        hatch_ink_texel(map, nearest, vec2<u32>(taps.high.x, taps.low.y), side, level),
        hatch_ink_texel(map, nearest, vec2<u32>(taps.low.x, taps.high.y), side, level),
        hatch_ink_texel(map, nearest, taps.high, side, level),
    );
    let ink = vec4<f32>(
        hatch_threshold(texels.x, tone, width), hatch_threshold(texels.y, tone, width),
        hatch_threshold(texels.z, tone, width), hatch_threshold(texels.w, tone, width),
    );
    let rows = mix(ink.xz, ink.yw, taps.share.x);
    return mix(rows.x, rows.y, taps.share.y);
}

fn hatch_ink_at(map: texture_2d<f32>, nearest: sampler, uv: vec2<f32>, level: f32, tone: f32, width: f32) -> f32 {
    let finer = floor(level);
    let share = level - finer;
    let ink = hatch_ink_of_level(map, nearest, uv, i32(finer), tone, width);
    if share > 0.0 {
        return mix(ink, hatch_ink_of_level(map, nearest, uv, i32(finer) + 1, tone, width), share);
    }
    return ink;
}

fn hatch_ink(
    map: texture_2d<f32>, nearest: sampler, uv: vec2<f32>, footprint: HatchFootprint, tone: f32, width: f32,
) -> f32 {
    let softened = hatch_softened(tone, width);
    let samples = hatch_samples(footprint);
    var ink = 0.0;
    for (var i = 0; i < samples; i++) {
        let at = uv + footprint.spread * (-0.375 + 0.25 * f32(i));
        ink += hatch_ink_at(map, nearest, at, footprint.level, softened, width);
    }
    return ink / f32(samples);
}

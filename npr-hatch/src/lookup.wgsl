// Lookups in the textures of a map, which the caller binds and passes as arguments. The counterpart of `lookup.rs`. It
// needs the other files of the library.

// The tones of two textures with three channels each at one position.
struct HatchTexels {
    light: vec3<f32>,
    dark: vec3<f32>,
}

fn hatch_texels_at(
    light: texture_2d<f32>, dark: texture_2d<f32>, trilinear: sampler, uv: vec2<f32>, level: f32,
) -> HatchTexels {
    // Levels are blended in f32, since samplers quantise the weight to 1/256 and may round the value of each level to 8
    // bits. On llvmpipe the error is 1.4/255 instead of 2.1/255, for 6 to 8 % more time per frame.
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
    // One loop for both sample counts: software adapters execute both sides of a branch.
    let samples = hatch_samples(footprint);
    var sum = HatchTexels(vec3<f32>(0.0), vec3<f32>(0.0));
    for (var i = 0; i < samples; i++) {
        let sample_uv = uv + footprint.spread * (-0.375 + 0.25 * f32(i));
        let texels = hatch_texels_at(light, dark, trilinear, sample_uv, footprint.level);
        sum.light += texels.light;
        sum.dark += texels.dark;
    }
    return HatchTexels(sum.light / f32(samples), sum.dark / f32(samples));
}

// A threshold of a level with `side` × `side` texels: 16 bits in two channels, the higher byte in red. It is read through
// a sampler with nearest filtering: the GLSL translation of `textureLoad` queries the size of the level, for which Mesa's
// llvmpipe uses one pixel's level for a whole group of pixels.
fn hatch_ink_texel(map: texture_2d<f32>, nearest: sampler, texel: vec2<u32>, side: u32, level: i32) -> f32 {
    let bytes = textureSampleLevel(map, nearest, (vec2<f32>(texel) + 0.5) / f32(side), f32(level)).xy;
    return (256.0 * bytes.x + bytes.y) / 257.0;
}

// The ink of one level of a texture of thresholds, compared and then filtered.
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
    let softened = hatch_soft_tone(tone, width);
    let samples = hatch_samples(footprint);
    var ink = 0.0;
    for (var i = 0; i < samples; i++) {
        let sample_uv = uv + footprint.spread * (-0.375 + 0.25 * f32(i));
        ink += hatch_ink_at(map, nearest, sample_uv, footprint.level, softened, width);
    }
    return ink / f32(samples);
}

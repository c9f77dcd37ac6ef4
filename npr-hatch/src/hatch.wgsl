// Weights of six tones by light, their blend, thresholds, footprints and mappings. See the Rust functions of the same names.

struct HatchWeights {
    light: vec3<f32>,
    dark: vec3<f32>,
}

fn hatch_level(brightness: f32, n_dot_l: f32) -> f32 {
    return brightness * n_dot_l;
}

fn hatch_weights(level: f32) -> HatchWeights {
    let light = max(1.0 - abs(level - vec3(6.0, 5.0, 4.0)), vec3(0.0));
    var dark = max(1.0 - abs(level - vec3(3.0, 2.0, 1.0)), vec3(0.0));
    if level <= 1.0 {
        dark.z = 1.0;
    }
    return HatchWeights(light, dark);
}

fn hatch_blend(light: vec3<f32>, dark: vec3<f32>, weights: HatchWeights) -> f32 {
    let ink = saturate(dot(1.0 - light, weights.light)) + saturate(dot(1.0 - dark, weights.dark));
    return 1.0 - saturate(ink);
}

fn hatch_transfer(light: vec3<f32>, dark: vec3<f32>, level: f32) -> f32 {
    return hatch_blend(light, dark, hatch_weights(level));
}

fn hatch_linear(light: vec3<f32>, dark: vec3<f32>, tone: f32) -> f32 {
    let from_dark = saturate((tone - dark.zyx) / (vec3(dark.yx, light.z) - dark.zyx));
    let from_light = saturate((tone - light.zyx) / (vec3(light.yx, 1.0) - light.zyx));
    return 1.0 + dot(from_dark + from_light, vec3(1.0));
}

fn hatch_shadowed(tone: f32, darkest: f32, lit: f32) -> f32 {
    return tone * lit + min(tone, darkest) * (1.0 - lit);
}

fn hatch_color(tone: f32, paper: vec3<f32>, ink: vec3<f32>) -> vec3<f32> {
    return ink + (paper - ink) * tone;
}

fn hatch_threshold(texel: f32, tone: f32, width: f32) -> f32 {
    if width > 0.0 {
        return saturate((texel - tone) / width + 0.5);
    }
    return select(0.0, 1.0, texel > tone || tone <= 0.0);
}

fn hatch_softened(tone: f32, width: f32) -> f32 {
    let end = 0.5 * width;
    if tone <= 0.0 {
        return -width;
    }
    if tone >= 1.0 {
        return 1.0 + width;
    }
    if tone < end {
        return sqrt(2.0 * width * tone) - end;
    }
    if tone > 1.0 - end {
        return 1.0 + end - sqrt(2.0 * width * (1.0 - tone));
    }
    return tone;
}

struct HatchFootprint {
    level: f32,
    spread: vec2<f32>,
}

fn hatch_footprint(uv_dx: vec2<f32>, uv_dy: vec2<f32>, texels: f32, last_level: f32) -> HatchFootprint {
    let along_x = uv_dx * texels;
    let along_y = uv_dy * texels;
    let mean = 0.5 * (dot(along_x, along_x) + dot(along_y, along_y));
    let half = 0.5 * (along_x.x * along_x.x + along_y.x * along_y.x - along_x.y * along_x.y - along_y.y * along_y.y);
    let other = along_x.x * along_x.y + along_y.x * along_y.y;
    let apart = sqrt(half * half + other * other);
    let longer_squared = mean + apart;
    let area = abs(along_x.x * along_y.y - along_x.y * along_y.x);
    let ratio = clamp(longer_squared / max(area, 1e-30), 1.0, 16.0);
    let level = clamp(0.5 * log2(max(longer_squared / ratio, 1e-30)), 0.0, last_level);
    let longer = min(sqrt(ratio), sqrt(longer_squared) / exp2(level));
    let length_of = max(longer - sqrt(2.0), 0.0) * exp2(level) / texels;
    var axis = vec2<f32>(other, apart - half);
    if half >= 0.0 {
        axis = vec2<f32>(half + apart, other);
    }
    if length_of <= 0.0 {
        return HatchFootprint(level, vec2<f32>(0.0));
    }
    // Scaled first: squares of very long or very short axes are no f32.
    let scaled = axis / max(max(abs(axis.x), abs(axis.y)), 1e-30);
    return HatchFootprint(level, scaled * (length_of * inverseSqrt(max(dot(scaled, scaled), 1e-30))));
}

fn hatch_flat(level: f32, last_level: f32) -> f32 {
    return saturate(level - (last_level - 4.0));
}

fn hatch_samples(footprint: HatchFootprint) -> i32 {
    return select(4, 1, all(footprint.spread == vec2<f32>(0.0)));
}

struct HatchTaps {
    low: vec2<u32>,
    high: vec2<u32>,
    share: vec2<f32>,
}

fn hatch_taps(uv: vec2<f32>, side: u32) -> HatchTaps {
    let place = uv * f32(side) - 0.5;
    let corner = floor(place);
    let low = bitcast<vec2<u32>>(vec2<i32>(corner)) & vec2<u32>(side - 1u);
    return HatchTaps(low, (low + 1u) & vec2<u32>(side - 1u), place - corner);
}

fn hatch_plane_weights(normal: vec3<f32>) -> vec3<f32> {
    let above = max(abs(normal) - 0.4, vec3<f32>(0.0));
    let cubes = above * above * above;
    let sum = cubes.x + cubes.y + cubes.z;
    if sum > 0.0 {
        return cubes / sum;
    }
    return vec3<f32>(0.0, 0.0, 1.0);
}

fn hatch_plane(at: vec3<f32>, axis: u32) -> vec2<f32> {
    if axis == 0u {
        return at.zy;
    }
    if axis == 1u {
        return at.xz;
    }
    return at.xy;
}

fn hatch_doubled(diagonal: vec3<f32>, others: vec3<f32>, axis: u32) -> vec2<f32> {
    if axis == 0u {
        return vec2<f32>(diagonal.z - diagonal.y, 2.0 * others.z);
    }
    if axis == 1u {
        return vec2<f32>(diagonal.x - diagonal.z, 2.0 * others.y);
    }
    return vec2<f32>(diagonal.x - diagonal.y, 2.0 * others.x);
}

struct HatchStep {
    first: i32,
    share: f32,
}

fn hatch_turn(doubled: vec2<f32>) -> HatchStep {
    if all(doubled == vec2<f32>(0.0)) {
        return HatchStep(0, 0.0);
    }
    let turns = (atan2(doubled.y, doubled.x) / 6.283185307179586 + 1.0) * 12.0;
    let at = hatch_octave(turns);
    return HatchStep(at.first % 12, at.share);
}

fn hatch_octave(octave: f32) -> HatchStep {
    let whole = floor(octave);
    return HatchStep(i32(whole), saturate((octave - whole - 0.5) * 4.0 + 0.5));
}

fn hatch_turned(place: vec2<f32>, turn: i32) -> vec2<f32> {
    let angle = f32(turn) * 0.2617993877991494;
    let sine = sin(angle);
    let cosine = cos(angle);
    return vec2<f32>(cosine * place.x + sine * place.y, cosine * place.y - sine * place.x);
}

fn hatch_moved(number: i32) -> vec2<f32> {
    return fract(vec2<f32>(0.7548776662466928, 0.5698402909980533) * f32(number));
}

fn hatch_share(tone: f32, share: f32) -> f32 {
    if share < 1.0 {
        return pow(max(tone, 1e-6), share);
    }
    return tone;
}

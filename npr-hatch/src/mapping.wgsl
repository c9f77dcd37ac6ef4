// Texture coordinates by planes, directions and scales. The counterpart of `mapping.rs`.

fn hatch_plane_weights(normal: vec3<f32>) -> vec3<f32> {
    let above = max(abs(normal) - 0.4, vec3<f32>(0.0));
    let cubes = above * above * above;
    let sum = cubes.x + cubes.y + cubes.z;
    if sum > 0.0 {
        return cubes / sum;
    }
    return vec3<f32>(0.0, 0.0, 1.0);
}

fn hatch_plane(position: vec3<f32>, axis: u32) -> vec2<f32> {
    if axis == 0u {
        return position.zy;
    }
    if axis == 1u {
        return position.xz;
    }
    return position.xy;
}

fn hatch_doubled_angle(diagonal: vec3<f32>, others: vec3<f32>, axis: u32) -> vec2<f32> {
    if axis == 0u {
        return vec2<f32>(diagonal.z - diagonal.y, 2.0 * others.z);
    }
    if axis == 1u {
        return vec2<f32>(diagonal.x - diagonal.z, 2.0 * others.y);
    }
    return vec2<f32>(diagonal.x - diagonal.y, 2.0 * others.x);
}

struct HatchBlend {
    first: i32,
    share: f32,
}

fn hatch_direction_step(doubled: vec2<f32>) -> HatchBlend {
    if all(doubled == vec2<f32>(0.0)) {
        return HatchBlend(0, 0.0);
    }
    let turns = (atan2(doubled.y, doubled.x) / 6.283185307179586 + 1.0) * 12.0;
    let pair = hatch_octave(turns);
    // `turns` is within 6..=18; the direction after the last is the first.
    return HatchBlend(pair.first % 12, pair.share);
}

fn hatch_octave(octave: f32) -> HatchBlend {
    let whole = floor(octave);
    return HatchBlend(i32(whole), saturate((octave - whole - 0.5) * 4.0 + 0.5));
}

fn hatch_rotate(position: vec2<f32>, turn: i32) -> vec2<f32> {
    let angle = f32(turn) * 0.2617993877991494;
    let sine = sin(angle);
    let cosine = cos(angle);
    return vec2<f32>(cosine * position.x + sine * position.y, cosine * position.y - sine * position.x);
}

fn hatch_offset(number: i32) -> vec2<f32> {
    return fract(vec2<f32>(0.7548776662466928, 0.5698402909980533) * f32(number));
}

fn hatch_share_tone(tone: f32, share: f32) -> f32 {
    if share < 1.0 {
        return pow(max(tone, 1e-6), share);
    }
    return tone;
}

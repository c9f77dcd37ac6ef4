// The footprint of a pixel in a map. The counterpart of `footprint.rs`.

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
    let root = sqrt(half * half + other * other);
    let longer_squared = mean + root;
    let area = abs(along_x.x * along_y.y - along_x.y * along_y.x);
    let ratio = clamp(longer_squared / max(area, 1e-30), 1.0, 16.0);
    let level = clamp(0.5 * log2(max(longer_squared / ratio, 1e-30)), 0.0, last_level);
    let longer = min(sqrt(ratio), sqrt(longer_squared) / exp2(level));
    let length_of = max(longer - sqrt(2.0), 0.0) * exp2(level) / texels;
    var axis = vec2<f32>(other, root - half);
    if half >= 0.0 {
        axis = vec2<f32>(half + root, other);
    }
    if length_of <= 0.0 {
        return HatchFootprint(level, vec2<f32>(0.0));
    }
    // Scaled first, since the square of a very long or very short axis is out of the range of f32.
    let scaled = axis / max(max(abs(axis.x), abs(axis.y)), 1e-30);
    return HatchFootprint(level, scaled * (length_of * inverseSqrt(max(dot(scaled, scaled), 1e-30))));
}

fn hatch_flat_weight(level: f32, last_level: f32) -> f32 {
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
    let position = uv * f32(side) - 0.5;
    let corner = floor(position);
    let low = bitcast<vec2<u32>>(vec2<i32>(corner)) & vec2<u32>(side - 1u);
    return HatchTaps(low, (low + 1u) & vec2<u32>(side - 1u), position - corner);
}

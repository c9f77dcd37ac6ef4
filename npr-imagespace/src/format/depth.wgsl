// Linear eye-space depth. The twin of `depth.rs`. No bindings and no entry points.

// 0 at near, 1 at far, clamped. `near_far` is 0 < near < far.
fn ink_depth_fraction(depth: f32, near_far: vec2<f32>) -> f32 {
    return saturate((depth - near_far.x) / (near_far.y - near_far.x));
}

fn ink_depth_encode8(fraction: f32) -> u32 {
    return u32(fraction * 255.0 + 0.5);
}

fn ink_depth_encode16(fraction: f32) -> u32 {
    return u32(fraction * 65535.0 + 0.5);
}

// Without loss of an f32's precision. 1 would be 2^32 and becomes the largest code.
fn ink_depth_encode32(fraction: f32) -> u32 {
    return select(u32(min(fraction, 0.99999994) * 4294967296.0), 0xffffffffu, fraction >= 1.0);
}

// 16 bits over two channels of an 8-bit unorm target, the high byte first.
fn ink_depth_split2(code: u32) -> vec2<f32> {
    return vec2<f32>(vec2<u32>(code >> 8u, code & 255u)) / 255.0;
}

// 32 bits over four channels of an 8-bit unorm target, the high byte first.
fn ink_depth_split4(code: u32) -> vec4<f32> {
    return vec4<f32>((vec4<u32>(code) >> vec4<u32>(24u, 16u, 8u, 0u)) & vec4<u32>(255u)) / 255.0;
}

// The code that two channels hold.
fn ink_depth_join2(channels: vec2<f32>) -> u32 {
    let bytes = vec2<u32>(channels * 255.0 + 0.5);
    return (bytes.x << 8u) | bytes.y;
}

// The code that four channels hold.
fn ink_depth_join4(channels: vec4<f32>) -> u32 {
    let bytes = vec4<u32>(channels * 255.0 + 0.5);
    return (bytes.x << 24u) | (bytes.y << 16u) | (bytes.z << 8u) | bytes.w;
}

// Eye-space depth of a code: `most` is 255, 65535 or 4294967296 by its format.
fn ink_depth_decode(code: u32, most: f32, near_far: vec2<f32>) -> f32 {
    return near_far.x + f32(code) / most * (near_far.y - near_far.x);
}

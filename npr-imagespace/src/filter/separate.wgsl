// The filters over textures of normals, depth and regions. The twin of `separate.rs`. No bindings and no entry points.

struct InkSeparate {
    normal_cos: f32,
    // 1: stored as (n + 1) / 2.
    normal_biased: u32,
    // 0 for hard lines.
    softness: f32,
    // Ink of one tap across, where lines are soft.
    weight: f32,
    depth_threshold: f32,
    // For a depth buffer: 1/z, or z in a parallel view, is d * scale + bias; the clear value is background.
    depth_scale: f32,
    depth_bias: f32,
    depth_clear: f32,
    depth_is_buffer: u32,
    parallel: u32,
    // Of the INK_DEPTH_ forms.
    plain_form: u32,
    padding: u32,
}

// A normal of any length from a texel: of unit length, or zero for none.
fn ink_separate_normal(texel: vec3<f32>, biased: bool) -> vec3<f32> {
    let normal = select(texel, texel * 2.0 - 1.0, biased);
    let bits = bitcast<vec3<u32>>(normal) & vec3<u32>(0x7fffffffu);
    let longest = max(max(bits.x, bits.y), bits.z);
    // Compared as bits, since a compiler may assume that there is no NaN.
    if longest - 0x00800000u >= 0x7f000000u || (biased && all(texel == vec3<f32>(0.0))) {
        return vec3<f32>(0.0);
    }
    // Scaled so that the squared length does not overflow.
    let scaled = normal / bitcast<f32>(longest);
    return scaled * inverseSqrt(dot(scaled, scaled));
}

// Eye-space depth from a texel; 0 for background, which includes depths below 2^-126, whose reciprocal overflows.
fn ink_separate_depth(texel: f32, settings: InkSeparate) -> f32 {
    var depth = texel;
    if settings.depth_is_buffer != 0u {
        let v = texel * settings.depth_scale + settings.depth_bias;
        depth = select(select(1.0 / v, v, settings.parallel != 0u), 0.0, texel == settings.depth_clear);
    }
    return select(0.0, depth, bitcast<u32>(depth) - 0x00800000u < 0x7f000000u);
}

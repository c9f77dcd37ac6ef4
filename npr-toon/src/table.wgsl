// 2D ramps. The counterpart of `table.rs`.

struct ToonRamp2d {
    a: ToonRamp,
    b: ToonRamp,
    // rgb the colour of the corner, w its threshold, which is 10,000 without a corner.
    corner: vec4<f32>,
}

// The fraction of a pixel that is in the corner.
fn toon_corner(uv: vec2<f32>, widths: vec2<f32>, threshold: f32) -> f32 {
    let clamped = saturate(uv);
    let squared = max(dot(clamped, clamped), 1e-30);
    // Components above 1 are constant after clamping.
    let clamped_widths = select(vec2<f32>(0.0), widths, uv < vec2<f32>(1.0));
    return toon_coverage(sqrt(squared), threshold, dot(clamped, clamped_widths) * inverseSqrt(squared));
}

// The colour at the diffuse terms of two lights: the maximum of both ramps, or the colour of the corner.
fn toon_ramp_2d(ramps: ToonRamp2d, uv: vec2<f32>, widths: vec2<f32>) -> vec3<f32> {
    let color = max(toon_ramp(ramps.a, uv.x, widths.x), toon_ramp(ramps.b, uv.y, widths.y));
    return mix(color, ramps.corner.rgb, toon_corner(uv, widths, ramps.corner.w));
}

// Bilinear interpolation of four texels. share_u: the weight of the right texels, share_v: that of the lower ones.
fn toon_table_mix(
    upper_left: vec4<f32>,
    upper_right: vec4<f32>,
    lower_left: vec4<f32>,
    lower_right: vec4<f32>,
    share_u: f32,
    share_v: f32,
) -> vec4<f32> {
    return mix(mix(upper_left, upper_right, share_u), mix(lower_left, lower_right, share_u), share_v);
}

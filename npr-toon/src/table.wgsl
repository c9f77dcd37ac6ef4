// 2D ramps. The twin of `table.rs`.

struct ToonRamp2d {
    a: ToonRamp,
    b: ToonRamp,
    // rgb the corner's colour, w its threshold (far above 1: there is none).
    corner: vec4<f32>,
}

// The share of a pixel that is in the corner.
fn toon_corner(uv: vec2<f32>, widths: vec2<f32>, threshold: f32) -> f32 {
    let reach = saturate(uv);
    let squared = max(dot(reach, reach), 1e-30);
    // What is clamped does not change.
    let moving = select(vec2<f32>(0.0), widths, uv < vec2<f32>(1.0));
    return toon_coverage(sqrt(squared), threshold, dot(reach, moving) * inverseSqrt(squared));
}

// The shade at the reach of two lights: the lighter of their ramps', and in the corner its own.
fn toon_ramp_2d(ramps: ToonRamp2d, uv: vec2<f32>, widths: vec2<f32>) -> vec3<f32> {
    let shade = max(toon_ramp(ramps.a, uv.x, widths.x), toon_ramp(ramps.b, uv.y, widths.y));
    return mix(shade, ramps.corner.rgb, toon_corner(uv, widths, ramps.corner.w));
}

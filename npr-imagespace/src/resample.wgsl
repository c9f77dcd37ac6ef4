// Ink of another size than the picture's. The twin of `resample.rs`. No bindings and no entry points.

// The upper left of the 2 x 2 texels that a pixel's ink is interpolated from, which may lie outside by 1, and the
// weights of the right and the lower ones, 0..1. `scale` is texels of ink a pixel.
fn ink_resample_at(pixel: vec2<f32>, scale: vec2<f32>) -> vec4<f32> {
    let at = (pixel + 0.5) * scale - 0.5;
    let first = floor(at);
    return vec4<f32>(first, at - first);
}

// Of 2 x 2 texels: upper left, upper right, lower left, lower right.
fn ink_resample_mix(taps: vec4<f32>, weight: vec2<f32>) -> f32 {
    let rows = mix(taps.xz, taps.yw, weight.x);
    return mix(rows.x, rows.y, weight.y);
}

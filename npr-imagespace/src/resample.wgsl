// Ink of another size than the picture's. The twin of `resample.rs`. No bindings and no entry points.

// Where a pixel finds its ink: the upper left of 2 x 2 texels, which may lie outside by 1, and how far the pixel's
// centre is from that one's to the others', 0..1. `scale` is texels of ink for a pixel.
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

// Steps of dilation and erosion. The twin of `morphology.rs`. No bindings and no entry points.
// Ink is 1 on a line and 0 on paper. A tap outside the picture is 0 for a dilation and 1 for an erosion.

// Four diagonal taps: the pixel itself is not read. With the pixel as `centre`, a cross or, of two of these, a square.
fn ink_dilate4(taps: vec4<f32>) -> f32 {
    return max(max(taps.x, taps.y), max(taps.z, taps.w));
}

fn ink_erode4(taps: vec4<f32>) -> f32 {
    return min(min(taps.x, taps.y), min(taps.z, taps.w));
}

// The soft dilation of a pixel and its four neighbours along the axes.
fn ink_dilate_soft_cross(centre: f32, taps: vec4<f32>) -> f32 {
    return min(0.4 * (centre + dot(taps, vec4<f32>(1.0))), 1.0);
}

// The smoothed dilation of the four diagonal taps; threshold from 0.25, softest, to 1, hard.
fn ink_dilate_soft_diagonal(taps: vec4<f32>, threshold: f32) -> f32 {
    return min(threshold * dot(taps, vec4<f32>(1.0)), 1.0);
}

// As the listing computes it: two taps of the four.
fn ink_dilate_soft_diagonal_printed(taps: vec4<f32>, threshold: f32) -> f32 {
    return threshold * taps.x + threshold * taps.y;
}

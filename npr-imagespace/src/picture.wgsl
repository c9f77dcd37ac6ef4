// Borders and taps of a filter. The twin of `picture.rs`. No bindings and no entry points.

// The steps to taps 0 (xy) and 1 (zw): down right and down left; right and down. Taps 2 and 3 are opposite them.
const INK_STEPS_DIAGONAL = vec4<i32>(1, 1, -1, 1);
const INK_STEPS_CROSS = vec4<i32>(1, 0, 0, 1);

// Whether a filter at a pixel steps along x and y: 1, or 0 where a step to either side would leave the picture.
fn ink_reach(pixel: vec2<u32>, size_px: vec2<u32>, longest_px: vec2<u32>) -> vec2<i32> {
    return select(vec2<i32>(0), vec2<i32>(1), (pixel >= longest_px) & (pixel + longest_px < size_px));
}

// The step to tap 0..3.
fn ink_tap(tap: u32, steps: vec4<i32>, reach: vec2<i32>) -> vec2<i32> {
    return reach * select(1, -1, tap >= 2u) * select(steps.xy, steps.zw, (tap & 1u) != 0u);
}

// Borders and taps of a filter. The twin of `picture.rs`. No bindings and no entry points.

// How far a filter at a pixel steps along x and y: 1, or 0 where a step to either side would leave the picture.
fn ink_reach(pixel: vec2<u32>, size_px: vec2<u32>) -> vec2<i32> {
    return select(vec2<i32>(0), vec2<i32>(1), (pixel > vec2<u32>(0u)) & (pixel + 1u < size_px));
}

// The step to tap 0..3: down right, down left, up left, up right. Taps 0 and 2 are opposite, and 1 and 3.
fn ink_tap_diagonal(tap: u32, reach: vec2<i32>) -> vec2<i32> {
    return reach * vec2<i32>(select(-1, 1, tap == 0u || tap == 3u), select(-1, 1, tap < 2u));
}

// The step to tap 0..3: right, down, left, up.
fn ink_tap_cross(tap: u32, reach: vec2<i32>) -> vec2<i32> {
    let along = select(-1, 1, tap < 2u);
    return reach * select(vec2<i32>(along, 0), vec2<i32>(0, along), (tap & 1u) != 0u);
}

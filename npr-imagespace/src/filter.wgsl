// What the filters share. The twin of `filter.rs`. No bindings and no entry points. Ink is 1 on a line and 0 on paper.

// The soft form of `excess > 0`, which it is where `width` is 0.
fn ink_ramp(excess: f32, width: f32) -> f32 {
    if width > 0.0 {
        return saturate(excess / width + 0.5);
    }
    return select(0.0, 1.0, excess > 0.0);
}

// 1 where any of the four taps says so.
fn ink_any(taps: vec4<bool>) -> f32 {
    return select(0.0, 1.0, any(taps));
}

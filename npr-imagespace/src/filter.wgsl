// What the filters share. The twin of `filter.rs`. No bindings and no entry points. Ink is 1 on a line and 0 on paper.

// A ramp from 0 to 1 of the given width around `excess` = 0; where `width` is 0, the step `excess > 0`.
fn ink_ramp(excess: f32, width: f32) -> f32 {
    if width > 0.0 {
        return saturate(excess / width + 0.5);
    }
    return select(0.0, 1.0, excess > 0.0);
}

// 1 where any of the four is true, else 0.
fn ink_any(taps: vec4<bool>) -> f32 {
    return select(0.0, 1.0, any(taps));
}

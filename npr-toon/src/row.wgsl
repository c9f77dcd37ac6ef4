// Rows of ramp images: which texels to load. The counterpart of `row.rs`.

struct ToonTaps {
    left: u32,
    right: u32,
    // The weight of the right texel.
    share: f32,
}

// The index of the texel nearest to x in a row of count texels that covers start..end.
fn toon_row_nearest(x: f32, start: f32, end: f32, count: u32) -> u32 {
    let t = (x - start) / (end - start) * f32(count);
    return u32(clamp(floor(t), 0.0, f32(count) - 1.0));
}

// The texels that linear filtering blends at x.
fn toon_row_taps(x: f32, start: f32, end: f32, count: u32) -> ToonTaps {
    let last = f32(count) - 1.0;
    let s = clamp((x - start) / (end - start) * f32(count) - 0.5, 0.0, last);
    let left = floor(s);
    return ToonTaps(u32(left), u32(min(left + 1.0, last)), s - left);
}

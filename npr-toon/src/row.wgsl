// Ramps in images: which texels to load, and what to make of them. The twin of `row.rs` and `table.rs`.

struct ToonTaps {
    left: u32,
    right: u32,
    // What share of the colour is the right one's.
    share: f32,
}

// Which of count texels is nearest to x, if the row reaches from `start` to `end`.
fn toon_row_nearest(x: f32, start: f32, end: f32, count: u32) -> u32 {
    let t = (x - start) / (end - start) * f32(count);
    return u32(clamp(floor(t), 0.0, f32(count) - 1.0));
}

// Which of count texels linear filtering mixes at x.
fn toon_row_taps(x: f32, start: f32, end: f32, count: u32) -> ToonTaps {
    let last = f32(count) - 1.0;
    let s = clamp((x - start) / (end - start) * f32(count) - 0.5, 0.0, last);
    let left = floor(s);
    return ToonTaps(u32(left), u32(min(left + 1.0, last)), s - left);
}

// Four texels of an image: left and right of the upper row, left and right of the lower, by the shares of the right
// and of the lower ones.
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

// Widths of antialiased borders. The counterpart of `border.rs`.

// 2^-14.
const TOON_MIN_BORDER: f32 = 6.103515625e-5;
const TOON_MAX_BORDER: f32 = 0.5;

fn toon_border_width(along_x: f32, along_y: f32) -> f32 {
    return clamp(toon_width(along_x, along_y), TOON_MIN_BORDER, TOON_MAX_BORDER);
}

// The width of a border of the quantity x at this pixel. It takes derivatives: call it in fragment shaders, in uniform
// control flow.
fn toon_pixel_border_width(x: f32) -> f32 {
    return toon_border_width(dpdxFine(x), dpdyFine(x));
}

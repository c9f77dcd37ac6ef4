// Lines of a scene without see-through surfaces.

// The share of a line that see-through surfaces let through at a pixel, whose centre is `offset` px from the line.
fn ink_through(pixel: vec2<i32>, depth: f32, offset: f32, slopes: vec2<f32>, per_px: f32) -> f32 {
    return 1.0;
}

// The disc in passes that find the nearest line pixel of each pixel. The twin of `flood.rs`. No bindings and no entry
// points.
//
// A texel of r32uint holds the step to the nearest line pixel known so far. A pass reads texels at +-step, +-2 step ..
// +-fan step and takes the nearest; a tap outside the picture is INK_FLOOD_NONE.

const INK_FLOOD_NONE: u32 = 0u;

fn ink_flood_seed(is_line: bool) -> u32 {
    return select(INK_FLOOD_NONE, 0x80008000u, is_line);
}

fn ink_flood_vector(site: u32) -> vec2<i32> {
    return vec2<i32>(vec2<u32>(site & 0xffffu, site >> 16u)) - 0x8000;
}

fn ink_flood_distance2(site: u32) -> u32 {
    let vector = ink_flood_vector(site);
    return select(u32(vector.x * vector.x + vector.y * vector.y), 0xffffffffu, site == INK_FLOOD_NONE);
}

// The nearer of the line pixel of a texel, `best`, and that of the texel `offset` px away, `tap`.
fn ink_flood_take(best: u32, tap: u32, offset: vec2<i32>) -> u32 {
    let vector = ink_flood_vector(tap) + offset;
    let away = abs(vector);
    if tap == INK_FLOOD_NONE || max(away.x, away.y) > 0x7fff {
        return best;
    }
    if u32(vector.x * vector.x + vector.y * vector.y) >= ink_flood_distance2(best) {
        return best;
    }
    let packed = vec2<u32>(vector + 0x8000);
    return packed.x | (packed.y << 16u);
}

// Ink of a pixel that knows its nearest line pixel.
fn ink_flood_resolve(site: u32, radius_px: f32, antialias: bool) -> f32 {
    if site == INK_FLOOD_NONE {
        return 0.0;
    }
    let square = ink_flood_distance2(site);
    if antialias {
        return saturate(radius_px + 1.0 - sqrt(f32(square)));
    }
    return select(0.0, 1.0, square <= u32(floor(radius_px * radius_px)));
}

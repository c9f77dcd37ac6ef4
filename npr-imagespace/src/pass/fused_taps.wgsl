// The taps of the fused filter in a texture of packed texels. Appended to the library.

@group(0) @binding(2) var texels: texture_2d<u32>;

// Known when the pipeline is made: a software rasteriser runs through what it branches around.
override narrow: bool;
override cross_taps: bool;

fn tap_at(pixel: vec2<i32>) -> InkTap {
    let words = textureLoad(texels, pixel, 0).xy;
    if narrow {
        return ink_narrow_tap(words.x);
    }
    return ink_wide_tap(words);
}

fn tap_beside(pixel: vec2<i32>, tap: u32, reach: vec2<i32>) -> InkTap {
    if cross_taps {
        return tap_at(pixel + ink_tap_cross(tap, reach));
    }
    return tap_at(pixel + ink_tap_diagonal(tap, reach));
}

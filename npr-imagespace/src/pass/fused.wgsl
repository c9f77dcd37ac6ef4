// The fused filter over packed texels.

@group(0) @binding(1) var<uniform> what: InkFilter;
@group(0) @binding(2) var texels: texture_2d<u32>;

// Constants of the pipeline, since software rasterisers execute both sides of branches.
override narrow: bool;
override soft: bool;

fn tap_at(pixel: vec2<i32>) -> InkTap {
    let words = textureLoad(texels, pixel, 0).xy;
    if narrow {
        return ink_texel32_tap(words.x);
    }
    return ink_texel64_tap(words);
}

fn tap_beside(pixel: vec2<i32>, tap: u32, reach: vec2<i32>) -> InkTap {
    return tap_at(pixel + ink_tap(tap, steps(), reach));
}

@fragment
fn fs_fused(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(position.xy);
    let reach = ink_reach(vec2<u32>(pixel), textureDimensions(texels), longest_px());
    let centre = tap_at(pixel);
    let tap0 = tap_beside(pixel, 0u, reach);
    let tap1 = tap_beside(pixel, 1u, reach);
    let tap2 = tap_beside(pixel, 2u, reach);
    let tap3 = tap_beside(pixel, 3u, reach);
    if soft {
        return ink_premultiplied(ink_fused_soft(what, centre, tap0, tap1, tap2, tap3), how);
    }
    return ink_premultiplied(select(0.0, 1.0, ink_fused_hard(what, centre, tap0, tap1, tap2, tap3)), how);
}

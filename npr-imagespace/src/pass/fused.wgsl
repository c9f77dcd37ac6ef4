// The fused filter over packed texels. Appended to `fullscreen.wgsl` and `fused_taps.wgsl`.

@group(0) @binding(1) var<uniform> what: InkFilter;

// Known when the pipeline is made, as the others are.
override soft: bool;

@fragment
fn fs_fused(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(position.xy);
    let reach = ink_reach(vec2<u32>(pixel), textureDimensions(texels));
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

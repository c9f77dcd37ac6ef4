// A triangle over the target; the stencil test selects the pixels that are written.

@vertex
fn vs_shadow_mask(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fs_in_shadow() -> @location(0) u32 {
    return 1u;
}

@fragment
fn fs_lit() -> @location(0) u32 {
    return 0u;
}

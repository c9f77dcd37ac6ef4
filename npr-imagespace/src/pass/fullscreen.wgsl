// A triangle that covers the whole target, and how ink is written to it.

@group(0) @binding(0) var<uniform> how: InkComposite;

@vertex
fn vs_fullscreen(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

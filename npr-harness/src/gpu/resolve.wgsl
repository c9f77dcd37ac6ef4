// The mean of the samples of each pixel, in display space, where coverage is blended too. CPU version:
// `CpuFrame::resolved` in `cpu/frame.rs`.

// The number of samples along each axis of a pixel.
override resolve_samples: u32 = 1u;

@group(0) @binding(0) var fine: texture_2d<f32>;

@vertex
fn vs_resolve(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fs_resolve(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let first = vec2<u32>(position.xy) * resolve_samples;
    var sum = vec4<f32>(0.0);
    for (var y = 0u; y < resolve_samples; y++) {
        for (var x = 0u; x < resolve_samples; x++) {
            sum += textureLoad(fine, first + vec2<u32>(x, y), 0);
        }
    }
    return sum / f32(resolve_samples * resolve_samples);
}

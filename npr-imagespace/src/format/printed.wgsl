// The RGBA8 target of Card & Mitchell 2002. The twin of `printed.rs`. No bindings and no entry points.

// As an rgba8unorm target takes it; `depth` is 0..1 from near to far.
fn ink_printed_encode(normal: vec3<f32>, depth: f32) -> vec4<f32> {
    let surface = ink_is_surface(abs(depth)) || depth == 0.0;
    if !surface || !ink_is_surface(dot(normal, normal)) {
        return vec4<f32>(0.0);
    }
    return saturate(vec4<f32>(normal * 0.5 + 0.5, depth));
}

// The normal, and the depth 0..1.
fn ink_printed_decode(texel: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(texel.xyz * 2.0 - 1.0, texel.w);
}

// Decoders of face normals. The twin of `normal_format.rs`. No bindings and no entry points.
//
// Vertex fetch converts signed normalised integers to -1..=1. The first three components of a 4-tuple are the normal
// and need no decoding.

// The direction that a point of the unfolded octahedron stands for; zero for (-1, -1).
fn normal_oct_decode(code: vec2<f32>) -> vec3<f32> {
    if all(code == vec2<f32>(-1.0)) {
        return vec3<f32>(0.0);
    }
    let z = 1.0 - abs(code.x) - abs(code.y);
    let fold = max(-z, 0.0);
    let folded = code - select(vec2<f32>(-fold), vec2<f32>(fold), code >= vec2<f32>(0.0));
    return normalize(vec3<f32>(folded, z));
}

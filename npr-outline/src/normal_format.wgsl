// Decoders of face normals. The twin of `normal_format.rs`. No bindings and no entry points.
//
// Vertex fetch turns signed-normalised integers into -1..=1; of the 4-tuples the first three numbers are the normal,
// and nothing is left to do.

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

// A normal in two signed 16-bit numbers of a word, the first in the lower half.
fn normal_oct16_unpack(word: u32) -> vec3<f32> {
    return normal_oct_decode(unpack2x16snorm(word));
}

// A normal in two signed bytes of a word: its lower half, or with `second` its upper half.
fn normal_oct8_unpack(word: u32, second: bool) -> vec3<f32> {
    let four = unpack4x8snorm(word);
    return normal_oct_decode(select(four.xy, four.zw, second));
}

// A normal in three signed bytes of a word.
fn normal_snorm8_unpack(word: u32) -> vec3<f32> {
    return unpack4x8snorm(word).xyz;
}

// A normal in three signed 16-bit numbers of two words.
fn normal_snorm16_unpack(words: vec2<u32>) -> vec3<f32> {
    return vec3<f32>(unpack2x16snorm(words.x), unpack2x16snorm(words.y).x);
}

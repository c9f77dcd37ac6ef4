// Octahedral normals. The twin of `normal.rs`. No bindings and no entry points.
// Biased bytes are those of `ink_printed_encode`; half floats are converted by the target.

// The largest octahedral integers of 5, 8 and 16 bits.
const INK_OCT5_MAX: f32 = 15.0;
const INK_OCT8_MAX: f32 = 127.0;
const INK_OCT16_MAX: f32 = 32767.0;

// The octahedral numbers of a direction of any length as unsigned ones, 1 .. 2 most + 1; zeros for no normal.
fn ink_oct_encode(normal: vec3<f32>, most: f32) -> vec2<u32> {
    let sum = abs(normal.x) + abs(normal.y) + abs(normal.z);
    if !ink_is_surface(sum) {
        return vec2<u32>(0u);
    }
    let flat = normal.xy / sum;
    let folded = 1.0 - abs(flat.yx);
    let unfolded = select(flat, select(folded, -folded, flat < vec2<f32>(0.0)), normal.z < 0.0);
    return vec2<u32>(floor(unfolded * most + 0.5) + (most + 1.0));
}

// The direction of an octahedral code: integers with |x| + |y| + |z| = most. They are stored in f32, whose arithmetic
// on them is exact and faster than that on integers.
fn ink_oct_vector(code: vec2<f32>, most: f32) -> vec3<f32> {
    let z = most - abs(code.x) - abs(code.y);
    let folded = most - abs(code.yx);
    return vec3<f32>(select(code, select(folded, -folded, code < vec2<f32>(0.0)), z < 0.0), z);
}

// The reverse of `ink_oct_encode`, as a vector of integers; zero for no normal.
fn ink_oct_load(stored: vec2<u32>, most: f32) -> vec3<f32> {
    let vector = ink_oct_vector(vec2<f32>(stored) - (most + 1.0), most);
    return select(vector, vec3<f32>(0.0), stored.x == 0u);
}

// A normal of unit length, or zero.
fn ink_oct_decode(stored: vec2<u32>, most: f32) -> vec3<f32> {
    let vector = ink_oct_load(stored, most);
    return vector * inverseSqrt(max(dot(vector, vector), 1.0));
}

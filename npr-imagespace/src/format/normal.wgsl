// Octahedral normals. The twin of `normal.rs`. No bindings and no entry points.
// Biased bytes are those of `ink_printed_encode`; for half floats a target's own conversion serves.

// What octahedral numbers of 5, 8 and 16 bits run to.
const INK_OCT5_MOST: i32 = 15;
const INK_OCT8_MOST: i32 = 127;
const INK_OCT16_MOST: i32 = 32767;

// The octahedral numbers of a direction of any length as unsigned ones, 1 .. 2 most + 1; zeros for no normal.
fn ink_oct_encode(normal: vec3<f32>, most: i32) -> vec2<u32> {
    let sum = abs(normal.x) + abs(normal.y) + abs(normal.z);
    if !ink_is_surface(sum) {
        return vec2<u32>(0u);
    }
    let flat = normal.xy / sum;
    let folded = 1.0 - abs(flat.yx);
    let unfolded = select(flat, select(folded, -folded, flat < vec2<f32>(0.0)), normal.z < 0.0);
    return vec2<u32>(vec2<i32>(floor(unfolded * f32(most) + 0.5)) + most + 1);
}

// The direction of octahedral numbers as integers, |x| + |y| + |z| = most.
fn ink_oct_vector(code: vec2<i32>, most: i32) -> vec3<i32> {
    let z = most - abs(code.x) - abs(code.y);
    let folded = most - abs(code.yx);
    return vec3<i32>(select(code, select(folded, -folded, code < vec2<i32>(0)), z < 0), z);
}

// The reverse of `ink_oct_encode`, as a vector of integers; zero for no normal.
fn ink_oct_load(stored: vec2<u32>, most: i32) -> vec3<i32> {
    if stored.x == 0u {
        return vec3<i32>(0);
    }
    return ink_oct_vector(vec2<i32>(stored) - most - 1, most);
}

// A normal of unit length, or zero.
fn ink_oct_decode(stored: vec2<u32>, most: i32) -> vec3<f32> {
    let vector = vec3<f32>(ink_oct_load(stored, most));
    return vector * inverseSqrt(max(dot(vector, vector), 1.0));
}

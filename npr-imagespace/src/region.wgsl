// Region numbers. The twin of `region.rs`. No bindings and no entry points.

// The region number of a texture's colour, which must be sampled without filtering.
fn ink_region_of_color(rgb: vec3<f32>) -> u32 {
    let bytes = vec3<u32>(rgb * 255.0 + 0.5);
    return (bytes.x | (bytes.y << 8u) | (bytes.z << 16u)) + 1u;
}

// A hash of two region numbers, below 2^24; 0 where either is 0.
fn ink_region_pair(a: u32, b: u32) -> u32 {
    let mixed = ((a * 0x9e3779b1u) ^ b) * 0x85ebca6bu;
    return select(1u + (mixed >> 8u) % 0xffffffu, 0u, a == 0u || b == 0u);
}

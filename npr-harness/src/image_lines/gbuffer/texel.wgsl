// Unquantised texels. The twin of `texel.rs`. No bindings and no entry points.

const GBUFFER_REGION_MAX: u32 = 0x00ffffffu;
const GBUFFER_SHADOWED: u32 = 0x20000000u;
const GBUFFER_NORMAL: u32 = 0x40000000u;
const GBUFFER_BEHIND: u32 = 0x80000000u;

// A texel of a surface. The normal has any length; zero is none.
fn gbuffer_pack(normal: vec3<f32>, region: u32, depth: f32, shadowed: bool) -> vec4<u32> {
    let length2 = dot(normal, normal);
    let unit = normal * inverseSqrt(max(length2, 1e-37));
    var word = region;
    word |= select(0u, GBUFFER_SHADOWED, shadowed);
    word |= select(0u, GBUFFER_NORMAL, length2 > 0.0);
    word |= select(0u, GBUFFER_BEHIND, unit.z < 0.0);
    return vec4<u32>(bitcast<u32>(unit.x), bitcast<u32>(unit.y), word, bitcast<u32>(depth));
}

// The unit normal of a texel, zero for none.
fn gbuffer_normal(texel: vec4<u32>) -> vec3<f32> {
    let x = bitcast<f32>(texel.x);
    let y = bitcast<f32>(texel.y);
    let z = sqrt(max(1.0 - x * x - y * y, 0.0));
    let normal = vec3<f32>(x, y, select(z, -z, (texel.z & GBUFFER_BEHIND) != 0u));
    return select(vec3<f32>(0.0), normal, (texel.z & GBUFFER_NORMAL) != 0u);
}

// The colour that stands for a region, in bytes; white for background.
fn gbuffer_region_color(region: u32) -> vec3<u32> {
    let mixed = region * 0x9e3779b1u;
    let hash = (mixed ^ (mixed >> 15u)) * 0x85ebca6bu;
    let color = ((vec3<u32>(hash) >> vec3<u32>(26u, 20u, 14u)) & vec3<u32>(63u)) * 4u;
    return select(color, vec3<u32>(255u), region == 0u);
}

// The number of a region that is compared by the sum of its colour's channels, from 1.
fn gbuffer_region_sum(region: u32) -> u32 {
    let color = gbuffer_region_color(region);
    return color.x + color.y + color.z + 1u;
}

// Shadow states in the G-buffer. The twin of `shadow.rs`. No bindings and no entry points.

const INK_BACK_FACING: u32 = 0u;
const INK_LIT: u32 = 1u;
const INK_CAST: u32 = 2u;

// The largest region number beside a shadow state, in 32-bit and in 64-bit texels.
const INK_TEXEL32_SHADOWED_REGION_MAX: u32 = 63u;
const INK_TEXEL64_SHADOWED_REGION_MAX: u32 = 4194303u;

// A region with a state in the two bits above `most`. 0, background, stays 0.
fn ink_shadow_region(folded: u32, state: u32, most: u32) -> u32 {
    return select(folded | (state * (most + 1u)), 0u, folded == 0u);
}

// The number of background that catches shadows.
fn ink_shadow_background(state: u32, most: u32) -> u32 {
    return state * (most + 1u);
}

// For four pairs of states, masked by `bits` of a region number: whether one is lit and the other in a cast shadow.
fn ink_shadow_differs(a: vec4<u32>, b: vec4<u32>, bits: vec4<u32>) -> vec4<bool> {
    return (a | b) == bits;
}

// As printed: negated in shadow.
fn ink_shadow_normal(normal: vec3<f32>, in_shadow: bool) -> vec3<f32> {
    return select(normal, -normal, in_shadow);
}

fn ink_shadow_depth(depth: f32, in_shadow: bool) -> f32 {
    return select(depth, -depth, in_shadow);
}

// Normal, region and depth of a pixel packed into 32 or 64 bits. The twin of `texel.rs`. No bindings and no entry
// points.

struct InkDepthCode {
    // Codes per unit of v, which is 1/z, or z in a parallel view.
    scale: f32,
    // The code at v = 0.
    bias: f32,
    // The largest code.
    most: f32,
    // 1: v is z.
    parallel: u32,
}

// A decoded texel, as the filter compares it.
struct InkTap {
    // Integers with |x| + |y| + |z| = 15 in 32-bit texels and 127 in 64-bit ones; zero for no normal.
    normal: vec3<f32>,
    // 0 is background.
    region: u32,
    // Larger is nearer.
    depth: i32,
}

const INK_TEXEL32_REGION_MAX: u32 = 255u;
const INK_TEXEL64_REGION_MAX: u32 = 16777215u;

// The code of 1/z, or of z in a parallel view. In a fragment shader `position.w` is 1/z as the rasteriser has it.
fn ink_depth_code_of(v: f32, code: InkDepthCode) -> u32 {
    return u32(round(clamp(v * code.scale + code.bias, 0.0, code.most)));
}

fn ink_depth_code(depth: f32, code: InkDepthCode) -> u32 {
    return ink_depth_code_of(select(1.0 / depth, depth, code.parallel != 0u), code);
}

// 0, background, stays 0; others go to 1 .. most.
fn ink_fold_region(region: u32, most: u32) -> u32 {
    return select(1u + (region - 1u) % most, 0u, region == 0u);
}

// A surface as a 32-bit texel, for an r32uint target. The region is folded.
fn ink_texel32_bits(normal: vec3<f32>, folded: u32, depth_code: u32) -> u32 {
    let oct = ink_oct_encode(normal, INK_OCT5_MAX);
    return depth_code | (folded << 14u) | (oct.x << 22u) | (oct.y << 27u);
}

// A 32-bit texel, for an r32uint target. Region 0, and a depth that is not valid for a surface, give background.
fn ink_texel32_pack(normal: vec3<f32>, region: u32, depth: f32, code: InkDepthCode) -> u32 {
    if region == 0u || !ink_is_surface(depth) {
        return 0u;
    }
    return ink_texel32_bits(normal, ink_fold_region(region, INK_TEXEL32_REGION_MAX), ink_depth_code(depth, code));
}

fn ink_texel32_tap(word: u32) -> InkTap {
    let oct = vec2<u32>((word >> 22u) & 31u, word >> 27u);
    return InkTap(ink_oct_load(oct, INK_OCT5_MAX), (word >> 14u) & 255u, i32(word & 0x3fffu));
}

// A surface as a 64-bit texel, for an rg32uint target. The region is folded.
fn ink_texel64_bits(normal: vec3<f32>, folded: u32, depth_code: u32) -> vec2<u32> {
    let oct = ink_oct_encode(normal, INK_OCT8_MAX);
    return vec2<u32>(depth_code | (folded << 24u), oct.x | (oct.y << 8u) | ((folded >> 8u) << 16u));
}

// A 64-bit texel, for an rg32uint target. Region 0, and a depth that is not valid for a surface, give background.
fn ink_texel64_pack(normal: vec3<f32>, region: u32, depth: f32, code: InkDepthCode) -> vec2<u32> {
    if region == 0u || !ink_is_surface(depth) {
        return vec2<u32>(0u);
    }
    return ink_texel64_bits(normal, ink_fold_region(region, INK_TEXEL64_REGION_MAX), ink_depth_code(depth, code));
}

fn ink_texel64_tap(words: vec2<u32>) -> InkTap {
    let oct = vec2<u32>(words.y & 255u, (words.y >> 8u) & 255u);
    let region = (words.x >> 24u) | ((words.y >> 16u) << 8u);
    return InkTap(ink_oct_load(oct, INK_OCT8_MAX), region, i32(words.x & 0xffffffu));
}

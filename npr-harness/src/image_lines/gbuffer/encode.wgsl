// Encodes unquantised texels in the formats of a style's G-buffer, or shows them.

struct GBufferEncode {
    // The nearest and the farthest depth of the fixed-point formats.
    near_far: vec2<f32>,
    // 0 floats; 1 bytes; 2, 3 and 4 octahedral of 5, 8 and 16 bits; 5 half floats.
    normal_format: u32,
    // 0 one byte; 1 of 16 bits, in one or two channels; 2 of 32 bits; 3 half float; 4 float.
    depth_format: u32,
    // 1: background has the normal +z.
    plus_z: u32,
    // 1: depth is negated in shadow.
    negated_depth: u32,
    // 1: depth is a share of its range.
    plain: u32,
    // 1: regions are the sums of their colours' channels.
    region_sums: u32,
}

@group(0) @binding(0) var<uniform> encode: GBufferEncode;
@group(0) @binding(1) var texels: texture_2d<u32>;

@vertex
fn vs_encode(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

fn texel_at(position: vec4<f32>) -> vec4<u32> {
    return textureLoad(texels, vec2<i32>(position.xy), 0);
}

fn is_background(texel: vec4<u32>) -> bool {
    return all(texel == vec4<u32>(0u));
}

fn share(depth: f32) -> f32 {
    return (depth - encode.near_far.x) / (encode.near_far.y - encode.near_far.x);
}

// The nearest half float, ties to even; WebGPU leaves the rounding of `pack2x16float` open.
fn half(value: f32) -> f32 {
    let bits = bitcast<u32>(value);
    let magnitude = bits & 0x7fffffffu;
    // To a multiple of 2^13 in the last places of an f32; from 65520 on, infinity.
    let rounded = (magnitude + 0x0fffu + ((magnitude >> 13u) & 1u)) & 0xffffe000u;
    let large = select(rounded, 0x7f800000u, magnitude >= 0x477ff000u);
    // Below 2^-14 half floats are multiples of 2^-24.
    let small = bitcast<u32>(round(abs(value) * 16777216.0) * 5.9604644775390625e-8);
    return bitcast<f32>((bits & 0x80000000u) | select(large, small, magnitude < 0x38800000u));
}

// Eye depth as the target stores it, without its sign.
fn stored_depth(depth: f32) -> f32 {
    let fraction = ink_depth_fraction(depth, encode.near_far);
    if encode.depth_format == 0u {
        return ink_depth_decode(ink_depth_encode8(fraction), 255.0, encode.near_far);
    }
    if encode.depth_format == 1u {
        return ink_depth_decode(ink_depth_encode16(fraction), 65535.0, encode.near_far);
    }
    if encode.depth_format == 2u {
        return ink_depth_decode(ink_depth_encode32(fraction), 4294967296.0, encode.near_far);
    }
    if encode.depth_format == 3u {
        return half(depth);
    }
    return depth;
}

fn oct(normal: vec3<f32>, most: f32) -> vec3<f32> {
    return ink_oct_decode(ink_oct_encode(normal, most), most);
}

// A normal as its format holds it; zero stays zero.
fn stored_normal(normal: vec3<f32>) -> vec3<f32> {
    if all(normal == vec3<f32>(0.0)) || encode.normal_format == 0u {
        return normal;
    }
    if encode.normal_format == 1u {
        let bytes = floor(saturate(normal * 0.5 + 0.5) * 255.0 + 0.5);
        return bytes / 255.0 * 2.0 - 1.0;
    }
    if encode.normal_format == 2u {
        return oct(normal, INK_OCT5_MAX);
    }
    if encode.normal_format == 3u {
        return oct(normal, INK_OCT8_MAX);
    }
    if encode.normal_format == 4u {
        return oct(normal, INK_OCT16_MAX);
    }
    return vec3<f32>(half(normal.x), half(normal.y), half(normal.z));
}

fn is_negated(texel: vec4<u32>) -> bool {
    return encode.negated_depth != 0u && (texel.z & GBUFFER_SHADOWED) != 0u;
}

// The RGBA8 target of listing 8.
@fragment
fn fs_rgba8(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = texel_at(position);
    if is_background(texel) {
        // 128 of 255 twice, and 255 of 255 twice; or zeros.
        return select(vec4<f32>(0.0), vec4<f32>(128.0, 128.0, 255.0, 255.0) / 255.0, encode.plus_z != 0u);
    }
    return ink_printed_encode(gbuffer_normal(texel), saturate(share(bitcast<f32>(texel.w))));
}

struct Separate {
    @location(0) normal: vec4<f32>,
    @location(1) depth: f32,
    @location(2) region: u32,
}

// Targets of their own, decoded again: what the filters read is what the formats hold.
@fragment
fn fs_separate(@builtin(position) position: vec4<f32>) -> Separate {
    let texel = texel_at(position);
    var region = texel.z & GBUFFER_REGION_MAX;
    if encode.region_sums != 0u {
        region = gbuffer_region_sum(region);
    }
    if is_background(texel) {
        return Separate(
            vec4<f32>(0.0, 0.0, f32(encode.plus_z), 0.0), select(0.0, 1.0, encode.plain != 0u), region);
    }
    var depth = stored_depth(bitcast<f32>(texel.w));
    if encode.plain != 0u {
        depth = ink_shadow_depth(share(depth), is_negated(texel));
    }
    return Separate(vec4<f32>(stored_normal(gbuffer_normal(texel)), 0.0), depth, region);
}

@fragment
fn fs_show_normals(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = texel_at(position);
    if is_background(texel) {
        return vec4<f32>(select(vec3<f32>(0.0), vec3<f32>(128.0, 128.0, 255.0) / 255.0, encode.plus_z != 0u), 1.0);
    }
    let normal = stored_normal(gbuffer_normal(texel));
    return vec4<f32>(select(saturate(normal * 0.5 + 0.5), vec3<f32>(0.0), all(normal == vec3<f32>(0.0))), 1.0);
}

@fragment
fn fs_show_depth(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = texel_at(position);
    let stored = saturate(share(stored_depth(bitcast<f32>(texel.w))));
    let shown = select(select(stored, 0.0, is_negated(texel)), 1.0, is_background(texel));
    return vec4<f32>(vec3<f32>(shown), 1.0);
}

@fragment
fn fs_show_regions(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let color = gbuffer_region_color(texel_at(position).z & GBUFFER_REGION_MAX);
    return vec4<f32>(vec3<f32>(color) / 255.0, 1.0);
}

// The image that a ramp may be read from.

// 0: there is none, the ramp is computed; 1: nearest texels are read; 2: filtered ones.
override shade_image_filter: u32 = 0u;

@group(0) @binding(4) var shade_image: texture_2d<f32>;

fn shade_texel(x: u32, y: u32) -> vec4<f32> {
    return textureLoad(shade_image, vec2<u32>(x, y), 0);
}

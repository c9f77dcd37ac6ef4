// The ramp image.

// 0: no image, the ramp is computed; 1: nearest filtering; 2: linear filtering.
override shade_image_filter: u32 = 0u;

@group(0) @binding(4) var shade_image: texture_2d<f32>;

fn shade_texel(x: u32, y: u32) -> vec4<f32> {
    return textureLoad(shade_image, vec2<u32>(x, y), 0);
}

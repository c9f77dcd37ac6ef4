// Colours from a 1D ramp, indexed by light.

override shade_half_lambert: bool = false;

struct RampShade {
    ramp: ToonRamp,
    half_scale: f32,
    half_bias: f32,
    half_squared: u32,
    padding: u32,
    // The lookup coordinates at the two ends of the image row.
    row_ends: vec2<f32>,
    padding_b: vec2<u32>,
}

@group(0) @binding(1) var<uniform> shade: RampShade;

fn shade_of_ramp(x: f32, width: f32) -> vec3<f32> {
    let count = textureDimensions(shade_image).x;
    if shade_image_filter == 0u {
        return toon_ramp(shade.ramp, x, width);
    }
    if shade_image_filter == 1u {
        return shade_texel(toon_row_nearest(x, shade.row_ends.x, shade.row_ends.y, count), 0u).rgb;
    }
    let taps = toon_row_taps(x, shade.row_ends.x, shade.row_ends.y, count);
    return mix(shade_texel(taps.left, 0u).rgb, shade_texel(taps.right, 0u).rgb, taps.share);
}

// Requires uniform control flow.
fn shade_color(base: vec3<f32>, light_there: vec2<f32>, n: vec3<f32>, at: ShadowAt) -> vec3<f32> {
    var x = light_there.x;
    var dark = -abs(x);
    if shade_half_lambert {
        x = toon_half_lambert(shade.half_scale, shade.half_bias, shade.half_squared, x);
        dark = toon_half_lambert(shade.half_scale, shade.half_bias, shade.half_squared, dark);
    }
    let width = shadow_border_width(x, dark, at);
    return by_light_color(base) * shade_of_ramp(select(x, dark, surface_shadow != 0u && at.dark), width);
}

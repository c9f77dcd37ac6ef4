// Two lights, each mapped to an axis of a 2D ramp. The second coordinate is the diffuse term of the second light.

@group(0) @binding(1) var<uniform> shade: ToonRamp2d;

fn shade_diffuse(n_dot_l: f32) -> f32 {
    return by_brightness(n_dot_l);
}

fn shade_second(n: vec3<f32>, l: vec3<f32>, n_dot_l: f32, at: vec3<f32>, eye: vec3<f32>) -> f32 {
    return toon_diffuse(dot(n, to_second_light(at)), lights.brightness.y);
}

fn shade_second_vector(at: vec3<f32>, eye: vec3<f32>) -> vec3<f32> {
    return to_second_light(at);
}

fn shade_second_interpolated(n: vec3<f32>, l: vec3<f32>, n_dot_l: f32, second: vec3<f32>) -> f32 {
    return toon_diffuse(dot(n, second), lights.brightness.y);
}

fn shade_second_of_back(second: f32) -> f32 {
    return -second;
}

// Only the first light casts shadows.
fn shade_second_in_shadow(second: f32) -> f32 {
    return second;
}

fn shade_of_table(uv: vec2<f32>, widths: vec2<f32>) -> vec3<f32> {
    let count = textureDimensions(shade_image);
    if shade_image_filter == 0u {
        return toon_ramp_2d(shade, uv, widths);
    }
    if shade_image_filter == 1u {
        return shade_texel(toon_row_nearest(uv.x, 0.0, 1.0, count.x), toon_row_nearest(uv.y, 0.0, 1.0, count.y)).rgb;
    }
    let u = toon_row_taps(uv.x, 0.0, 1.0, count.x);
    let v = toon_row_taps(uv.y, 0.0, 1.0, count.y);
    return toon_table_mix(
        shade_texel(u.left, v.left), shade_texel(u.right, v.left), shade_texel(u.left, v.right),
        shade_texel(u.right, v.right), u.share, v.share,
    ).rgb;
}

// Requires uniform control flow.
fn shade_color(base: vec3<f32>, light_there: vec2<f32>, n: vec3<f32>, at: ShadowAt) -> vec3<f32> {
    let light = shadow_light(light_there, at);
    let of_first = shadow_border_width(light_there.x, -abs(light_there.x), at);
    let widths = vec2<f32>(of_first, shade_border_width(light_there.y));
    return toon_paint(lights, shade_of_table(light, widths), vec4<f32>(base, 1.0)).rgb;
}

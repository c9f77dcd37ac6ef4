// Gooch shading, from cool to warm. The second coordinate is R.E.

@group(0) @binding(1) var<uniform> shade: GoochModel;

fn shade_diffuse(n_dot_l: f32) -> f32 {
    return n_dot_l;
}

fn shade_second(n: vec3<f32>, l: vec3<f32>, n_dot_l: f32, at: vec3<f32>, eye: vec3<f32>) -> f32 {
    return gooch_r_dot_e_unit(n, l, toon_unit(eye));
}

fn shade_second_vector(at: vec3<f32>, eye: vec3<f32>) -> vec3<f32> {
    return toon_unit(eye);
}

fn shade_second_interpolated(n: vec3<f32>, l: vec3<f32>, n_dot_l: f32, second: vec3<f32>) -> f32 {
    return 2.0 * n_dot_l * dot(n, second) - dot(l, second);
}

// R.E does not depend on the sign of the normal.
fn shade_second_of_back(second: f32) -> f32 {
    return second;
}

fn shade_second_in_shadow(second: f32) -> f32 {
    return -1.0;
}

fn shade_color(base: vec3<f32>, light_there: vec2<f32>, n: vec3<f32>, at: ShadowAt) -> vec3<f32> {
    let light = shadow_light(light_there, at);
    return gooch_over(shade, gooch_tone(shade, base, light.x), gooch_highlight(shade, light.x, light.y));
}

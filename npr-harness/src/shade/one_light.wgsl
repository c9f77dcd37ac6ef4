// Functions for shades that use only the diffuse term.

fn shade_diffuse(n_dot_l: f32) -> f32 {
    return by_brightness(n_dot_l);
}

fn shade_second(n: vec3<f32>, l: vec3<f32>, n_dot_l: f32, at: vec3<f32>, eye: vec3<f32>) -> f32 {
    return 0.0;
}

fn shade_second_vector(at: vec3<f32>, eye: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(0.0);
}

fn shade_second_interpolated(n: vec3<f32>, l: vec3<f32>, n_dot_l: f32, second: vec3<f32>) -> f32 {
    return 0.0;
}

fn shade_second_of_back(second: f32) -> f32 {
    return 0.0;
}

fn shade_second_in_shadow(second: f32) -> f32 {
    return -1.0;
}

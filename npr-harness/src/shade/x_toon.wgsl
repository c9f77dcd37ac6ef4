// Bands that fade with depth or near the silhouette. The second coordinate is the level of detail.

// Whether the level of detail depends on depth, else on |N.V|.
override shade_by_depth: bool = true;

struct XToonShade {
    detailed: ToonRamp,
    abstracted: ToonRamp,
    // The plane (n, d) such that n.p + d is the eye depth of a point p.
    eye_depth: vec4<f32>,
    near: f32,
    far: f32,
    exponent: f32,
    padding: f32,
}

@group(0) @binding(1) var<uniform> shade: XToonShade;

fn shade_diffuse(n_dot_l: f32) -> f32 {
    return by_brightness(n_dot_l);
}

fn shade_second(n: vec3<f32>, l: vec3<f32>, n_dot_l: f32, at: vec3<f32>, eye: vec3<f32>) -> f32 {
    if shade_by_depth {
        return toon_depth_detail(dot(shade.eye_depth, vec4<f32>(at, 1.0)), shade.near, shade.far);
    }
    return toon_silhouette_detail(dot(n, toon_unit(eye)), shade.exponent);
}

fn shade_second_vector(at: vec3<f32>, eye: vec3<f32>) -> vec3<f32> {
    if shade_by_depth {
        return vec3<f32>(dot(shade.eye_depth, vec4<f32>(at, 1.0)), 0.0, 0.0);
    }
    return toon_unit(eye);
}

fn shade_second_interpolated(n: vec3<f32>, l: vec3<f32>, n_dot_l: f32, second: vec3<f32>) -> f32 {
    if shade_by_depth {
        return toon_depth_detail(second.x, shade.near, shade.far);
    }
    return toon_silhouette_detail(dot(n, second), shade.exponent);
}

// Neither depth nor |N.V| depends on the side.
fn shade_second_of_back(second: f32) -> f32 {
    return second;
}

fn shade_second_in_shadow(second: f32) -> f32 {
    return second;
}

// Requires uniform control flow.
fn shade_color(base: vec3<f32>, light_there: vec2<f32>, n: vec3<f32>, at: ShadowAt) -> vec3<f32> {
    let light = shadow_light(light_there, at);
    let width = shadow_border_width(light_there.x, -abs(light_there.x), at);
    return by_light_color(base) * toon_x_toon(shade.detailed, shade.abstracted, light.x, width, saturate(light.y));
}

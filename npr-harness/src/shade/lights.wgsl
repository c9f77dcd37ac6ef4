// The lights, and the lookup coordinates of a shade: the diffuse term and the shade's second coordinate.

// 0: normals are normalized at the pixel; 1: normals are used as interpolated; 2: light is computed at the vertices; 3: light
// is constant over faces or pieces of faces.
override surface_normals: u32 = 0u;
// Whether the lights are positional instead of directional.
override surface_first_positional: bool = false;
override surface_second_positional: bool = false;
// Whether the light's colour is not white or its brightness is not 1.
override surface_tinted: bool = true;

@group(0) @binding(3) var<uniform> lights: ToonPainter;

// The unit vector from a point to the first light.
fn to_first_light(at: vec3<f32>) -> vec3<f32> {
    if surface_first_positional {
        return toon_to_light(lights.light_a, at);
    }
    return lights.light_a.xyz;
}

fn to_second_light(at: vec3<f32>) -> vec3<f32> {
    if surface_second_positional {
        return toon_to_light(lights.light_b, at);
    }
    return lights.light_b.xyz;
}

// N.L of the first light times its brightness.
fn by_brightness(n_dot_l: f32) -> f32 {
    if surface_tinted {
        return toon_diffuse(n_dot_l, lights.brightness.x);
    }
    return n_dot_l;
}

// Multiplies a surface's colour by the colour of the light.
fn by_light_color(base: vec3<f32>) -> vec3<f32> {
    if surface_tinted {
        return base * lights.light_color.rgb;
    }
    return base;
}

// The lookup coordinates at a point. The normal has unit length, the vector to the eye any length.
fn light_at(n: vec3<f32>, at: vec3<f32>, eye: vec3<f32>) -> vec2<f32> {
    let l = to_first_light(at);
    let n_dot_l = dot(n, l);
    return vec2<f32>(shade_diffuse(n_dot_l), shade_second(n, l, n_dot_l, at, eye));
}

// The lookup coordinates, computed from interpolated vectors: the normal, the vector to the light, and the shade's
// second vector.
fn light_interpolated(n: vec3<f32>, l: vec3<f32>, second: vec3<f32>) -> vec2<f32> {
    let n_dot_l = toon_n_dot_l_interpolated(n, l);
    return vec2<f32>(shade_diffuse(n_dot_l), shade_second_interpolated(n, l, n_dot_l, second));
}

// The width of a band border for a lookup coordinate. Where light is constant over a face or a piece, what derivatives find
// at its edges is no change of light within it. Requires uniform control flow.
fn shade_border_width(x: f32) -> f32 {
    if surface_normals == 3u {
        return TOON_MIN_BORDER;
    }
    return toon_pixel_border_width(x);
}

// Converts light computed with the normal of the front to the back of the face.
fn light_of_back(light: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(-light.x, shade_second_of_back(light.y));
}

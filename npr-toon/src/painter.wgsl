// Two lights with one colour. The counterpart of `painter.rs`.

struct ToonPainter {
    // Per light: xyz the direction to it and w 0, or its position and w 1.
    light_a: vec4<f32>,
    light_b: vec4<f32>,
    // rgb the common colour of the lights, w the light scale.
    light_color: vec4<f32>,
    // Per light.
    brightness: vec2<f32>,
    padding: vec2<u32>,
}

// The diffuse term of a light, not clamped.
fn toon_diffuse(n_dot_l: f32, brightness: f32) -> f32 {
    return n_dot_l * brightness;
}

// The coordinates in the 2D ramp. They are not clamped, so that border widths can be taken from their derivatives.
fn toon_painter_uv(painter: ToonPainter, position: vec3<f32>, normal: vec3<f32>) -> vec2<f32> {
    let n = toon_unit(normal);
    return vec2<f32>(
        toon_diffuse(dot(n, toon_to_light(painter.light_a, position)), painter.brightness.x),
        toon_diffuse(dot(n, toon_to_light(painter.light_b, position)), painter.brightness.y),
    );
}

// The material's colour where its alpha is above 1/2, else the texture's.
fn toon_material(material: vec4<f32>, texel: vec4<f32>) -> vec4<f32> {
    return select(texel, material, material.a > 0.5);
}

fn toon_overbright(color: vec3<f32>, light_color: vec3<f32>, light_scale: f32) -> vec3<f32> {
    return saturate(color * (light_color * light_scale) * 2.0);
}

// The colour of the ramp times the material's colour times the common light colour.
fn toon_paint(painter: ToonPainter, shade: vec3<f32>, material: vec4<f32>) -> vec4<f32> {
    let light_color = painter.light_color;
    return vec4<f32>(toon_overbright(material.rgb * shade, light_color.rgb, light_color.w), material.a);
}

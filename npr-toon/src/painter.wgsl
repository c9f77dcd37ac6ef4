// Two lights, one colour. The twin of `painter.rs`.

struct ToonPainter {
    // xyz a direction and w 0, or a position and 1.
    place_a: vec4<f32>,
    place_b: vec4<f32>,
    // rgb the lights' one colour, w its scale.
    light_color: vec4<f32>,
    // Of the first and the second light.
    brightness: vec2<f32>,
    padding: vec2<u32>,
}

// How far a light reaches.
fn toon_reach(n_dot_l: f32, brightness: f32) -> f32 {
    return n_dot_l * brightness;
}

// Where in the 2D ramp a point is. Not clamped: take widths of it, then look it up.
fn toon_painter_uv(painter: ToonPainter, at: vec3<f32>, normal: vec3<f32>) -> vec2<f32> {
    let n = toon_unit(normal);
    return vec2<f32>(
        toon_reach(dot(n, toon_to_light(painter.place_a, at)), painter.brightness.x),
        toon_reach(dot(n, toon_to_light(painter.place_b, at)), painter.brightness.y),
    );
}

// The material's colour where its alpha is above 1/2, else the texture's.
fn toon_material(material: vec4<f32>, texel: vec4<f32>) -> vec4<f32> {
    return select(texel, material, material.a > 0.5);
}

fn toon_overbright(color: vec3<f32>, light_color: vec3<f32>, light_scale: f32) -> vec3<f32> {
    return saturate(color * (light_color * light_scale) * 2.0);
}

// The ramp's shade on the surface's own colour, under the lights' one colour.
fn toon_paint(painter: ToonPainter, shade: vec3<f32>, material: vec4<f32>) -> vec4<f32> {
    let light_color = painter.light_color;
    return vec4<f32>(toon_overbright(material.rgb * shade, light_color.rgb, light_color.w), material.a);
}

// Ambient and diffuse light.

// x: the fraction of the surface's colour where N.L is not above 0.
@group(0) @binding(1) var<uniform> shade: vec4<f32>;

fn shade_color(base: vec3<f32>, light_there: vec2<f32>, n: vec3<f32>, at: ShadowAt) -> vec3<f32> {
    let light = shadow_light(light_there, at);
    return by_light_color(base) * (shade.x + (1.0 - shade.x) * max(light.x, 0.0));
}

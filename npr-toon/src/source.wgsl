// Lights. The counterpart of `source.rs`.

// The unit vector from a position to a light; zero at the position of a point light. light: xyz the direction to it and
// w 0, or its position and w 1.
fn toon_to_light(light: vec4<f32>, position: vec3<f32>) -> vec3<f32> {
    return toon_unit(light.xyz - light.w * position);
}

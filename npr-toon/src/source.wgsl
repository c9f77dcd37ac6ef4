// Lights. The twin of `source.rs`.

// The unit vector from a point to a light. xyz: a direction to the light and w 0, or its position and w 1.
// Zero at the light's own position.
fn toon_to_light(place: vec4<f32>, at: vec3<f32>) -> vec3<f32> {
    return toon_unit(place.xyz - place.w * at);
}

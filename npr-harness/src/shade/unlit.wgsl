// Surfaces without shading.
//
// A shade defines `shade_color`, and includes `one_light.wgsl` or defines these functions itself:
//
// - shade_diffuse: the first lookup coordinate, from N.L;
// - shade_second: the second lookup coordinate, from the normal n, the direction l to the first light and n.l, all
//   normalized, the position and the vector to the eye, of any length (with directional light the position is unknown
//   and 0 is passed);
// - shade_second_vector: the vector that is interpolated between vertices for shade_second_interpolated;
// - shade_second_interpolated: the second coordinate, from interpolated vectors;
// - shade_second_of_back: the second coordinate on the back of a face, from that of the front;
// - shade_second_in_shadow: the second coordinate in a cast shadow, from the unshadowed one.

fn shade_color(base: vec3<f32>, light_there: vec2<f32>, n: vec3<f32>, at: ShadowAt) -> vec3<f32> {
    return base;
}

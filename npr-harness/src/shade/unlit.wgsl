// Surfaces as they are, without light.
//
// A shade has `shade_color`, and beside it either `one_light.wgsl` or its own functions of these names:
//
// - shade_diffuse: the first number that it is looked up with, of N.L;
// - shade_second: the second, of the normal n, the direction l to the first light and n.l, all of unit length, the
//   position and the vector to the eye, of any length (where light comes from far away the position is not known: 0);
// - shade_second_vector: what is interpolated between vertices for shade_second_interpolated;
// - shade_second_interpolated: the second number of vectors as they were interpolated;
// - shade_second_of_back: the second number on the back of a face, of the front's;
// - shade_second_in_shadow: the second number in a cast shadow, of the lit one.

fn shade_color(base: vec3<f32>, light_there: vec2<f32>, n: vec3<f32>, at: ShadowAt) -> vec3<f32> {
    return base;
}

// World-space normals as colours, negated in shadow: Card & Mitchell 2002, figure 10b.

fn shade_color(base: vec3<f32>, light_there: vec2<f32>, n: vec3<f32>, at: ShadowAt) -> vec3<f32> {
    return ink_shadow_normal(n, surface_shadow != 0u && at.negated) * 0.5 + 0.5;
}

// Strokes on surfaces whose light is constant over faces, or over pieces of faces. It follows `gpu/facets.wgsl`.

struct HatchedFacet {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) normal: vec3<f32>,
    // Texture coordinates, and the barycentric coordinates of the second and the third corner.
    @location(1) uv_weights: vec4<f32>,
    @location(2) color: vec4<f32>,
    @location(3) @interpolate(flat) region: u32,
    @location(4) @interpolate(flat) corners_a: vec4<f32>,
    @location(5) @interpolate(flat) corners_b: vec4<f32>,
    @location(6) @interpolate(flat) corners_c: vec4<f32>,
    @location(7) @interpolate(flat) corners_d: vec4<f32>,
    @location(8) @interpolate(flat) corners_e: vec4<f32>,
    // The stroke coordinates, and the octave.
    @location(9) at_octave: vec4<f32>,
    @location(10) diagonal: vec3<f32>,
    @location(11) others: vec3<f32>,
    @location(12) mesh_normal: vec3<f32>,
    // Of `artist_vertex`.
    @location(13) artist: vec3<f32>,
}

@vertex
fn vs_hatched_facet(
    @builtin(vertex_index) vertex: u32, @location(0) position: vec3<f32>, @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>, @location(3) color: vec4<f32>, @location(4) region: u32,
    @location(5) diagonal: vec3<f32>, @location(6) others: vec3<f32>, @location(7) octave: f32, instance: Instance,
) -> HatchedFacet {
    let world = placed_position(position, instance);
    let clip = view.clip_from_world * vec4<f32>(world, 1.0);
    let corners = facet_corners_of(vertex, instance).rows;
    return HatchedFacet(
        clip, placed_normal(normal, instance), vec4<f32>(uv, facet_weights(vertex)), color,
        placed_region(region, instance), corners[0], corners[1], corners[2], corners[3], corners[4],
        vec4<f32>(hatched_place(position, uv, instance), octave + instance.scale.y), diagonal, others, normal,
        artist_vertex(world, color, instance),
    );
}

fn hatched_facet_lit(in: HatchedFacet) -> LitSurface {
    let none = vec3<f32>(0.0);
    return LitSurface(in.position, in.normal, in.uv_weights.xy, in.color, in.region, none, none, in.artist);
}

// Requires uniform control flow.
fn hatched_facet_color(in: HatchedFacet, base: vec3<f32>, front: bool, at: ShadowAt) -> vec3<f32> {
    let rows = array<vec4<f32>, 5>(in.corners_a, in.corners_b, in.corners_c, in.corners_d, in.corners_e);
    let light = facet_light(FacetCorners(rows), in.uv_weights.zw, front);
    let none = vec3<f32>(0.0);
    let surface = HatchedSurface(
        in.position, in.normal, in.uv_weights.xy, in.color, in.region, none, none, in.at_octave.xyz, in.diagonal,
        in.others, in.at_octave.w, none, none, in.mesh_normal, in.artist,
    );
    return hatched_color(surface, base, light, front, at);
}

@fragment
fn fs_hatched_facet(in: HatchedFacet, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let lit = hatched_facet_lit(in);
    let base = lit_base(lit, lit_texel(lit));
    let color = hatched_facet_color(in, base.rgb, front, shadow_at(in.position, facing(in.normal, front)));
    if surface_looked_up && base.a < material.cutoff {
        discard;
    }
    clip_off(in.position);
    return vec4<f32>(color, surface_alpha(base.a));
}

@fragment
fn fs_hatched_facet_inked(in: HatchedFacet, @builtin(front_facing) front: bool) -> Inked {
    let lit = hatched_facet_lit(in);
    let texel = lit_texel(lit);
    let base = lit_base(lit, texel);
    let at = shadow_at(in.position, facing(in.normal, front));
    let color = hatched_facet_color(in, base.rgb, front, at);
    if surface_looked_up && base.a < material.cutoff {
        discard;
    }
    clip_off(in.position);
    return Inked(vec4<f32>(color, 1.0), lit_words(lit, texel, front, at));
}

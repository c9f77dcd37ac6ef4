// Surfaces whose light is constant over faces, or over pieces of faces. Every face has vertices of its own, so that the
// index of a vertex says which corner of which face it is.

// The number of pieces along each side of a face; 0 if faces are lit as wholes.
override surface_divisions: u32 = 0u;

// Pairs of a position and a normal, in mesh space: one per face, of the face as a whole, or one per corner.
@group(0) @binding(14) var facet_corners: texture_2d<f32>;

// The positions and normals of a face's corners in world space: positions in the first three rows, the normal of the third
// corner in their last column, the other two normals in the last rows. A face that is lit as a whole has one of each, in the
// places of the first corner.
struct FacetCorners {
    rows: array<vec4<f32>, 5>,
}

struct FacetSurface {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) normal: vec3<f32>,
    // Texture coordinates, and the barycentric coordinates of the second and the third corner.
    @location(1) uv_weights: vec4<f32>,
    @location(2) color: vec4<f32>,
    @location(3) @interpolate(flat) region: u32,
    // The rows of the corners. All vertices of a face have the same.
    @location(4) @interpolate(flat) corners_a: vec4<f32>,
    @location(5) @interpolate(flat) corners_b: vec4<f32>,
    @location(6) @interpolate(flat) corners_c: vec4<f32>,
    @location(7) @interpolate(flat) corners_d: vec4<f32>,
    @location(8) @interpolate(flat) corners_e: vec4<f32>,
    // Of `artist_vertex`.
    @location(9) artist: vec3<f32>,
}

fn facet_texel(index: u32) -> vec3<f32> {
    let width = textureDimensions(facet_corners).x;
    return textureLoad(facet_corners, vec2<u32>(index % width, index / width), 0).xyz;
}

fn facet_corners_of(vertex: u32, instance: Instance) -> FacetCorners {
    let face = vertex / 3u;
    var corners = FacetCorners();
    if surface_divisions == 0u {
        corners.rows[0] = vec4<f32>(placed_position(facet_texel(2u * face), instance), 0.0);
        corners.rows[3] = vec4<f32>(placed_normal(facet_texel(2u * face + 1u), instance), 0.0);
        return corners;
    }
    let first = 6u * face;
    let third = placed_normal(facet_texel(first + 5u), instance);
    corners.rows[0] = vec4<f32>(placed_position(facet_texel(first), instance), third.x);
    corners.rows[1] = vec4<f32>(placed_position(facet_texel(first + 2u), instance), third.y);
    corners.rows[2] = vec4<f32>(placed_position(facet_texel(first + 4u), instance), third.z);
    corners.rows[3] = vec4<f32>(placed_normal(facet_texel(first + 1u), instance), 0.0);
    corners.rows[4] = vec4<f32>(placed_normal(facet_texel(first + 3u), instance), 0.0);
    return corners;
}

// The barycentric coordinates of the second and the third corner at a vertex.
fn facet_weights(vertex: u32) -> vec2<f32> {
    return vec2<f32>(vec2<u32>(vertex % 3u) == vec2<u32>(1u, 2u));
}

// The lookup coordinates of the light of the face, or of the piece that contains a point.
fn facet_light(corners: FacetCorners, weights: vec2<f32>, front: bool) -> vec2<f32> {
    var at = corners.rows[0].xyz;
    var normal = corners.rows[3].xyz;
    if surface_divisions > 0u {
        let third = vec3<f32>(corners.rows[0].w, corners.rows[1].w, corners.rows[2].w);
        let centroid = toon_piece_centroid(vec3<f32>(1.0 - weights.x - weights.y, weights), surface_divisions);
        at = centroid.x * at + centroid.y * corners.rows[1].xyz + centroid.z * corners.rows[2].xyz;
        normal = centroid.x * normal + centroid.y * corners.rows[4].xyz + centroid.z * third;
    }
    return light_at(toon_unit(facing(normal, front)), at, view.eye.xyz - at * view.eye.w);
}

@vertex
fn vs_facet(
    @builtin(vertex_index) vertex: u32, @location(0) position: vec3<f32>, @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>, @location(3) color: vec4<f32>, @location(4) region: u32, instance: Instance,
) -> FacetSurface {
    let world = placed_position(position, instance);
    let clip = view.clip_from_world * vec4<f32>(world, 1.0);
    let uv_weights = vec4<f32>(uv, facet_weights(vertex));
    let corners = facet_corners_of(vertex, instance).rows;
    return FacetSurface(
        clip, placed_normal(normal, instance), uv_weights, color, placed_region(region, instance), corners[0], corners[1],
        corners[2], corners[3], corners[4], artist_vertex(world, color, instance),
    );
}

fn facet_lit(in: FacetSurface) -> LitSurface {
    let no_light = vec3<f32>(0.0);
    return LitSurface(in.position, in.normal, in.uv_weights.xy, in.color, in.region, no_light, no_light, in.artist);
}

// Requires uniform control flow.
fn facet_color(in: FacetSurface, base: vec3<f32>, front: bool, at: ShadowAt) -> vec3<f32> {
    let rows = array<vec4<f32>, 5>(in.corners_a, in.corners_b, in.corners_c, in.corners_d, in.corners_e);
    let light = facet_light(FacetCorners(rows), in.uv_weights.zw, front);
    return with_emission(shade_color(base, light, toon_unit(facing(in.normal, front)), at), in.uv_weights.xy);
}

@fragment
fn fs_facet(in: FacetSurface, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let lit = facet_lit(in);
    let base = lit_base(lit, lit_texel(lit));
    let color = facet_color(in, base.rgb, front, shadow_at(in.position, facing(in.normal, front)));
    if surface_looked_up && base.a < material.cutoff {
        discard;
    }
    clip_off(in.position);
    return vec4<f32>(color, surface_alpha(base.a));
}

@fragment
fn fs_facet_inked(in: FacetSurface, @builtin(front_facing) front: bool) -> Inked {
    let lit = facet_lit(in);
    let texel = lit_texel(lit);
    let base = lit_base(lit, texel);
    let at = shadow_at(in.position, facing(in.normal, front));
    let color = facet_color(in, base.rgb, front, at);
    if surface_looked_up && base.a < material.cutoff {
        discard;
    }
    clip_off(in.position);
    return Inked(vec4<f32>(color, 1.0), lit_words(lit, texel, front, at));
}

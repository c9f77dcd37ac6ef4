// Strokes on surfaces. The CPU version is `cpu.rs`.

const HATCH_BY_COORDINATES: u32 = 0u;
const HATCH_BY_PLANES: u32 = 1u;
const HATCH_BY_FORM: u32 = 2u;

override surface_hatch_mapping: u32 = HATCH_BY_COORDINATES;
// Whether the threshold map is sampled, else six tones.
override surface_hatch_thresholds: bool = false;
// Whether listing 4 maps the light to the tone, else the tone is linear in the light.
override surface_hatch_listing_4: bool = false;
// Whether strokes are drawn over the surface's unshaded colour, else over paper.
override surface_hatch_over_surface: bool = false;
// Whether the weights of six tones are computed at the vertices and interpolated.
override surface_hatch_at_vertices: bool = false;

struct SurfaceHatch {
    // The map's mean tones, the lightest first.
    light_tones: vec3<f32>,
    // The side of the map in texels, times the size of a texel in px: the scale of footprints.
    texels: f32,
    dark_tones: vec3<f32>,
    last_level: f32,
    ink: vec3<f32>,
    // The number of map repetitions per scene unit.
    tiles: f32,
    paper: vec3<f32>,
    // The brightness factor of listing 4.
    brightness: f32,
    ambient: f32,
    // The range of tones over which a texel turns to ink.
    width: f32,
    padding: vec2<u32>,
}

@group(0) @binding(5) var<uniform> hatch: SurfaceHatch;
@group(0) @binding(6) var hatch_light: texture_2d<f32>;
@group(0) @binding(7) var hatch_dark: texture_2d<f32>;
// Trilinear for six tones, nearest for thresholds. GLSL has one sampler per texture.
@group(0) @binding(8) var hatch_sampler: sampler;
@group(0) @binding(9) var hatch_map: texture_2d<f32>;

struct HatchedSurface {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) uv: vec2<f32>,
    @location(2) color: vec4<f32>,
    @location(3) @interpolate(flat) region: u32,
    @location(4) first: vec3<f32>,
    @location(5) second: vec3<f32>,
    // The stroke coordinates: a position, or texture coordinates.
    @location(6) at: vec3<f32>,
    // The field's direction.
    @location(7) diagonal: vec3<f32>,
    @location(8) others: vec3<f32>,
    @location(9) octave: f32,
    // The weights of listing 4, if they are computed at the vertices.
    @location(10) light_weights: vec3<f32>,
    @location(11) dark_weights: vec3<f32>,
    // The normal in mesh space, like the stroke coordinates.
    @location(12) mesh_normal: vec3<f32>,
    @location(13) artist: vec3<f32>,
}

// The inputs for hatching a pixel.
struct Hatching {
    at: vec3<f32>,
    at_dx: vec3<f32>,
    at_dy: vec3<f32>,
    normal: vec3<f32>,
    diagonal: vec3<f32>,
    others: vec3<f32>,
    octave: f32,
    tone: f32,
    weights: HatchWeights,
}

// The tone for a diffuse term.
fn hatched_tone(reach: f32) -> f32 {
    if surface_hatch_listing_4 {
        return hatch_transfer(hatch.light_tones, hatch.dark_tones, hatch_level(hatch.brightness, reach));
    }
    return hatch.ambient + (1.0 - hatch.ambient) * saturate(reach);
}

fn hatched_weights(tone: f32) -> HatchWeights {
    return hatch_weights(hatch_level_of_tone(hatch.light_tones, hatch.dark_tones, tone));
}

// The stroke coordinates of a vertex: its position in mesh space, so that strokes move with the mesh, or its texture
// coordinates.
fn hatched_place(position: vec3<f32>, uv: vec2<f32>, instance: Instance) -> vec3<f32> {
    if surface_hatch_mapping == HATCH_BY_COORDINATES {
        return vec3<f32>(uv, 0.0);
    }
    return position * instance.scale.x * hatch.tiles;
}

@vertex
fn vs_hatched(
    @location(0) position: vec3<f32>, @location(1) normal: vec3<f32>, @location(2) uv: vec2<f32>,
    @location(3) color: vec4<f32>, @location(4) region: u32, @location(5) diagonal: vec3<f32>,
    @location(6) others: vec3<f32>, @location(7) octave: f32, instance: Instance,
) -> HatchedSurface {
    let plain = lit_vertex(position, normal, instance);
    let at = hatched_place(position, uv, instance);
    var out = HatchedSurface(
        plain.position, plain.normal, uv, color, placed_region(region, instance), plain.first, plain.second, at,
        diagonal, others, octave + instance.scale.y, vec3<f32>(0.0), vec3<f32>(0.0), normal,
        artist_vertex(placed_position(position, instance), color, instance),
    );
    if surface_hatch_at_vertices {
        let weights = hatched_weights(hatched_tone(plain.first.x));
        out.light_weights = weights.light;
        out.dark_weights = weights.dark;
    }
    return out;
}

// The fraction of the ground that one hatching layer leaves uncovered.
fn hatched_once(uv: vec2<f32>, footprint: HatchFootprint, tone: f32, weights: HatchWeights) -> f32 {
    let flat = hatch_flat_weight(footprint.level, hatch.last_level);
    if surface_hatch_thresholds {
        return mix(1.0 - hatch_ink(hatch_map, hatch_sampler, uv, footprint, tone, hatch.width), tone, flat);
    }
    let texels = hatch_texels(hatch_light, hatch_dark, hatch_sampler, uv, footprint);
    let mean = hatch_blend(hatch.light_tones, hatch.dark_tones, weights);
    return mix(hatch_blend(texels.light, texels.dark, weights), mean, flat);
}

// The hatching layers of a pixel. They are collected first and then sampled in one loop, since software adapters
// execute every texture lookup even in branches that are not taken. With the list, a frame takes 0.4 to 0.7 of the time
// there.
struct Hatchings {
    count: u32,
    // Texture coordinates in the map, and spread.
    places: array<vec4<f32>, 6>,
    // Mip level and weight.
    shares: array<vec2<f32>, 6>,
}

fn hatched_list(list: ptr<function, Hatchings>, uv: vec2<f32>, footprint: HatchFootprint, share: f32) {
    if share > 0.0 {
        let last = (*list).count;
        (*list).places[last] = vec4<f32>(uv, footprint.spread);
        (*list).shares[last] = vec2<f32>(footprint.level, share);
        (*list).count = last + 1u;
    }
}

// Combines the uncovered fraction of a hatching layer of weight `share` with that of the layers before it.
fn hatched_share(before: f32, asked: Hatching, uv: vec2<f32>, footprint: HatchFootprint, share: f32) -> f32 {
    if surface_hatch_at_vertices {
        // Interpolated weights do not correspond to a single tone, so the layers are averaged.
        return before + share * hatched_once(uv, footprint, asked.tone, asked.weights);
    }
    let tone = hatch_share_tone(asked.tone, share);
    return before * hatched_once(uv, footprint, tone, hatched_weights(tone));
}

fn hatched_footprint(uv_dx: vec2<f32>, uv_dy: vec2<f32>) -> HatchFootprint {
    return hatch_footprint(uv_dx, uv_dy, hatch.texels, hatch.last_level);
}

fn hatched_by_coordinates(list: ptr<function, Hatchings>, asked: Hatching) {
    let step = hatch_octave(asked.octave);
    for (var i = 0; i < 2; i++) {
        let scale = exp2(f32(step.first + i));
        let footprint = hatched_footprint(asked.at_dx.xy * scale, asked.at_dy.xy * scale);
        hatched_list(list, asked.at.xy * scale, footprint, select(1.0 - step.share, step.share, i == 1));
    }
}

fn hatched_by_planes(list: ptr<function, Hatchings>, asked: Hatching) {
    let weights = hatch_plane_weights(asked.normal);
    for (var axis = 0u; axis < 3u; axis++) {
        let place = hatch_plane(asked.at, axis);
        let footprint = hatched_footprint(hatch_plane(asked.at_dx, axis), hatch_plane(asked.at_dy, axis));
        if surface_hatch_mapping == HATCH_BY_PLANES {
            hatched_list(list, place + hatch_offset(i32(axis)), footprint, weights[axis]);
            continue;
        }
        let step = hatch_direction_step(hatch_doubled_angle(asked.diagonal, asked.others, axis));
        for (var i = 0; i < 2; i++) {
            let turn = (step.first + i) % 12;
            let turned = HatchFootprint(footprint.level, hatch_rotate(footprint.spread, turn));
            let uv = hatch_rotate(place, turn) + hatch_offset(i32(axis) * 12 + turn);
            hatched_list(list, uv, turned, weights[axis] * select(1.0 - step.share, step.share, i == 1));
        }
    }
}

fn hatched(asked: Hatching) -> f32 {
    var list: Hatchings;
    if surface_hatch_mapping == HATCH_BY_COORDINATES {
        hatched_by_coordinates(&list, asked);
    } else {
        hatched_by_planes(&list, asked);
    }
    var paper = select(1.0, 0.0, surface_hatch_at_vertices);
    for (var i = 0u; i < list.count; i++) {
        let footprint = HatchFootprint(list.shares[i].x, list.places[i].zw);
        paper = hatched_share(paper, asked, list.places[i].xy, footprint, list.shares[i].y);
    }
    return paper;
}

// Requires uniform control flow.
fn hatched_color(in: HatchedSurface, base: vec3<f32>, light: vec2<f32>, front: bool, at: ShadowAt) -> vec3<f32> {
    let at_dx = dpdxFine(in.at);
    let at_dy = dpdyFine(in.at);
    var tone = hatched_tone(light.x);
    var in_shadow = false;
    if surface_shadow != 0u {
        in_shadow = at.dark;
        tone = hatch_tone_in_shadow(tone, hatched_tone(0.0), select(1.0, 0.0, in_shadow));
    }
    var weights = HatchWeights(in.light_weights, in.dark_weights);
    if surface_hatch_at_vertices && (!front || in_shadow) {
        // The weights were interpolated for the lit front face, so they are recomputed from the tone.
        weights = hatched_weights(tone);
    }
    let normal = toon_unit(in.mesh_normal);
    let paper = hatched(Hatching(in.at, at_dx, at_dy, normal, in.diagonal, in.others, in.octave, tone, weights));
    var ground = hatch.paper;
    if surface_hatch_over_surface {
        ground = base;
    }
    return with_emission(hatch_color(paper, ground, hatch.ink), in.uv);
}

fn hatched_lit(in: HatchedSurface) -> LitSurface {
    return LitSurface(in.position, in.normal, in.uv, in.color, in.region, in.first, in.second, in.artist);
}

@fragment
fn fs_hatched(in: HatchedSurface, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let lit = hatched_lit(in);
    let base = lit_base(lit, lit_texel(lit));
    let at = shadow_at(in.position, facing(in.normal, front));
    let color = hatched_color(in, base.rgb, light_of(without_lookups(lit), front), front, at);
    if surface_looked_up && base.a < material.cutoff {
        discard;
    }
    clip_off(in.position);
    return vec4<f32>(color, surface_alpha(base.a));
}

@fragment
fn fs_hatched_inked(in: HatchedSurface, @builtin(front_facing) front: bool) -> Inked {
    let lit = hatched_lit(in);
    let texel = lit_texel(lit);
    let base = lit_base(lit, texel);
    let at = shadow_at(in.position, facing(in.normal, front));
    let color = hatched_color(in, base.rgb, light_of(without_lookups(lit), front), front, at);
    if surface_looked_up && base.a < material.cutoff {
        discard;
    }
    clip_off(in.position);
    return Inked(vec4<f32>(color, 1.0), lit_words(lit, texel, front, at));
}

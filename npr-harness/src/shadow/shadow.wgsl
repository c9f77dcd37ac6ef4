// The shadow state of a fragment. The CPU version is `cpu.rs`.

// The source of shadows: 0 none, 1 the mask that shadow volumes produce, 2 a shadow map.
override surface_shadow: u32 = 0u;
// How image-space lines use shadows: 0 not at all, 1 shadow states next to regions, 2 negated normals.
override surface_shadow_lines: u32 = 0u;

struct SurfaceShadow {
    // The light: a point with w = 1, or the unit direction to it with w = 0.
    light: vec4<f32>,
    // The light in picture space: (x px, y px, depth, 1) times w.
    light_px: vec4<f32>,
    // Matrices from (x px, y px, depth, 1) to world space, and to texels and depth of the shadow map, both times w.
    world_from_px: mat4x4<f32>,
    map_from_px: mat4x4<f32>,
    // For lines, a surface faces the light where N.L is above this.
    terminator: f32,
    padding0: f32,
    padding1: f32,
    padding2: f32,
}

@group(0) @binding(10) var<uniform> shadow: SurfaceShadow;
@group(0) @binding(11) var shadow_mask: texture_2d<u32>;
// A depth texture, bound as float and read through a sampler, for GLSL ES 3.00: see `line_ink.wgsl` of npr-outline.
@group(0) @binding(12) var shadow_map: texture_2d<f32>;
@group(0) @binding(13) var shadow_nearest: sampler;

// Whether the visible side of a face is turned towards the light. Depth is linear in screen space, so its two
// derivatives define the face's plane, and the eye, (0, 0, 1, 0) in picture space, is in front of it. Requires uniform
// control flow.
fn shadow_faces_light(position: vec4<f32>) -> bool {
    let slope = vec2<f32>(dpdxFine(position.z), dpdyFine(position.z));
    let light = shadow.light_px;
    let above = light.z - position.z * light.w;
    return above - dot(slope, light.xy - position.xy * light.w) > 0.0;
}

fn shadow_to_light(position: vec4<f32>) -> vec3<f32> {
    if shadow.light.w == 0.0 {
        return shadow.light.xyz;
    }
    let at = shadow.world_from_px * vec4<f32>(position.xyz, 1.0);
    return toon_unit(shadow.light.xyz - at.xyz / at.w);
}

// Whether an occluder lies between the surface at a fragment and the light.
fn shadow_falls(position: vec4<f32>) -> bool {
    if surface_shadow == 1u {
        return textureLoad(shadow_mask, vec2<i32>(position.xy), 0).x != 0u;
    }
    let place = shadow.map_from_px * vec4<f32>(position.xyz, 1.0);
    let texel = vec2<i32>(floor(place.xy / place.w));
    // Depth is reversed: nearer to the light is greater. There are no casters outside the map.
    let size = vec2<i32>(textureDimensions(shadow_map));
    if any(texel < vec2<i32>(0)) || any(texel >= size) {
        return false;
    }
    let middle = (vec2<f32>(texel) + 0.5) / vec2<f32>(size);
    // The ground may be beyond the map's far plane, where nothing is not nearer to the light.
    return textureSampleLevel(shadow_map, shadow_nearest, middle, 0.0).x > max(place.z / place.w, 0.0);
}

// The shadow state of a fragment.
struct ShadowAt {
    // For shading: whether it is in a cast shadow.
    dark: bool,
    // For negated normals as printed: whether it is in a cast shadow or back-facing.
    negated: bool,
    // For lines: one of the INK_ states.
    state: u32,
}

const NO_SHADOW: ShadowAt = ShadowAt(false, false, INK_BACK_FACING);

// The normal has any length and is on the visible side. Requires uniform control flow.
fn shadow_at(position: vec4<f32>, normal: vec3<f32>) -> ShadowAt {
    if surface_shadow == 0u {
        return NO_SHADOW;
    }
    let faces = shadow_faces_light(position);
    let falls = shadow_falls(position);
    let n_dot_l = dot(toon_unit(normal), shadow_to_light(position));
    let state = select(INK_BACK_FACING, select(INK_LIT, INK_CAST, falls), faces && n_dot_l > shadow.terminator);
    return ShadowAt(faces && falls && n_dot_l > 0.0, !faces || falls, state);
}

// The lookup coordinates of the light, including shadow. In a cast shadow the diffuse term is negated if positive, as
// if the surface faced away from the light by the same angle.
fn shadow_light(light: vec2<f32>, at: ShadowAt) -> vec2<f32> {
    if surface_shadow == 0u || !at.dark {
        return light;
    }
    return vec2<f32>(-abs(light.x), shade_second_in_shadow(light.y));
}

// The width of a band border for a shade's input x; `dark` is the value of x in a cast shadow. Both are continuous
// where a shadow ends, so that the shadow border is not a band border. Requires uniform control flow.
fn shadow_border_width(x: f32, dark: f32, at: ShadowAt) -> f32 {
    let width = shade_border_width(x);
    if surface_shadow == 0u {
        return width;
    }
    return select(width, shade_border_width(dark), at.dark);
}

// The folded region with the shadow state, for image-space lines.
fn shadow_region(region: u32, at: ShadowAt, most: u32) -> u32 {
    if surface_shadow_lines == 1u {
        return ink_shadow_region(region, at.state, most);
    }
    return region;
}

// The normal for image-space lines.
fn shadow_normal(normal: vec3<f32>, at: ShadowAt) -> vec3<f32> {
    return ink_shadow_normal(normal, surface_shadow_lines == 2u && at.negated);
}

// Whether light falls on a fragment. The twin of `cpu.rs`.

// Where shadows come from: 0 nowhere, 1 the mask that volumes leave, 2 a map of depths.
override surface_shadow: u32 = 0u;
// What of them lines in the image see: 0 nothing, 1 states beside regions, 2 negated normals.
override surface_shadow_lines: u32 = 0u;

struct SurfaceShadow {
    // A point with w = 1, or the unit direction to it with w = 0.
    light: vec4<f32>,
    // The same as the picture has it: (x px, y px, depth, 1) times w.
    light_px: vec4<f32>,
    // Positions, and places in the map in texels with their depth there, both times w, of (x px, y px, depth, 1).
    world_from_px: mat4x4<f32>,
    map_from_px: mat4x4<f32>,
    // For lines a surface is turned towards the light where N.L is above this.
    terminator: f32,
    padding0: f32,
    padding1: f32,
    padding2: f32,
}

@group(0) @binding(10) var<uniform> shadow: SurfaceShadow;
@group(0) @binding(11) var shadow_mask: texture_2d<u32>;
// A depth buffer, bound as floats and read through a sampler, for GLSL ES 3.00: see `line_ink.wgsl` of npr-outline.
@group(0) @binding(12) var shadow_map: texture_2d<f32>;
@group(0) @binding(13) var shadow_nearest: sampler;

// Whether the side of a face that is seen is turned towards the light. Depth is linear on the screen, so two derivatives
// are the face's plane, and the eye, (0, 0, 1, 0) there, is in front of it. In uniform control flow.
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

// Whether something is between what the depth buffer has at a fragment and the light.
fn shadow_falls(position: vec4<f32>) -> bool {
    if surface_shadow == 1u {
        return textureLoad(shadow_mask, vec2<i32>(position.xy), 0).x != 0u;
    }
    let place = shadow.map_from_px * vec4<f32>(position.xyz, 1.0);
    let texel = vec2<i32>(floor(place.xy / place.w));
    // Reversed: what is nearer to the light is greater. Outside of the map is nothing that casts.
    let size = vec2<i32>(textureDimensions(shadow_map));
    if any(texel < vec2<i32>(0)) || any(texel >= size) {
        return false;
    }
    let middle = (vec2<f32>(texel) + 0.5) / vec2<f32>(size);
    return textureSampleLevel(shadow_map, shadow_nearest, middle, 0.0).x > place.z / place.w;
}

// What shadows make of a fragment.
struct ShadowAt {
    // For its light: in a cast shadow.
    dark: bool,
    // For printed normals: in any shadow, its own included.
    negated: bool,
    // For lines: of the INK_ states.
    state: u32,
}

const NO_SHADOW: ShadowAt = ShadowAt(false, false, INK_BACK_FACING);

// The normal is of any length, on the side that is seen. In uniform control flow.
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

// What light there is: in a cast shadow as if the surface were turned away from the light as far as it is turned towards
// it.
fn shadow_light(light: vec2<f32>, at: ShadowAt) -> vec2<f32> {
    if surface_shadow == 0u || !at.dark {
        return light;
    }
    return vec2<f32>(-abs(light.x), shade_second_in_shadow(light.y));
}

// The width of a border at a shade's input x, of which `dark` is what it is in a cast shadow. Both are continuous where a
// shadow ends, so that its border is no border of bands. In uniform control flow.
fn shadow_border_width(x: f32, dark: f32, at: ShadowAt) -> f32 {
    let width = toon_pixel_border_width(x);
    if surface_shadow == 0u {
        return width;
    }
    return select(width, toon_pixel_border_width(dark), at.dark);
}

// A region, folded, as lines in the image see it.
fn shadow_region(region: u32, at: ShadowAt, most: u32) -> u32 {
    if surface_shadow_lines == 1u {
        return ink_shadow_region(region, at.state, most);
    }
    return region;
}

// A normal as lines in the image see it.
fn shadow_normal(normal: vec3<f32>, at: ShadowAt) -> vec3<f32> {
    return ink_shadow_normal(normal, surface_shadow_lines == 2u && at.negated);
}

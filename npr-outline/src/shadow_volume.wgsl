// Shadow volumes from edges and faces. The twin of `shadow_volume.rs`. No bindings and no entry points.

const VOLUME_SECOND: u32 = 1u;
const VOLUME_SAME_DIRECTION: u32 = 2u;
const VOLUME_OPEN: u32 = 4u;
const VOLUME_SECOND_OPEN: u32 = 8u;

// 1 where a face faces the light, -1 where it faces away. The sum is in the order of `outline_facing`.
fn outline_light_side(plane: vec4<f32>, light: vec4<f32>) -> i32 {
    let facing = plane.x * light.x + plane.y * light.y + plane.z * light.z + plane.w * light.w;
    return select(-1, 1, facing >= 0.0);
}

// How a face casts: 1 facing the light, -1 facing away from it, 0 where it does not cast.
fn outline_casting(plane: vec4<f32>, open: bool, light: vec4<f32>) -> i32 {
    let side = outline_light_side(plane, light);
    return select(max(side, 0), side, open);
}

// The number of sweeps of an edge, -2 .. 2: from its first end to its second if positive.
fn outline_sweeps(flags: u32, plane0: vec4<f32>, plane1: vec4<f32>, light: vec4<f32>) -> i32 {
    var sweeps = outline_casting(plane0, (flags & VOLUME_OPEN) != 0u, light);
    if (flags & VOLUME_SECOND) != 0u {
        let second = outline_casting(plane1, (flags & VOLUME_SECOND_OPEN) != 0u, light);
        sweeps += select(-second, second, (flags & VOLUME_SAME_DIRECTION) != 0u);
    }
    return sweeps;
}

// Whether a stencil count means shadow.
fn outline_in_shadow(count: u32) -> bool {
    return count != 0u && count < 128u;
}

// Swept away from the light to infinity: a direction, w = 0.
fn outline_swept(point: vec3<f32>, light: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(point * light.w - light.xyz, 0.0);
}

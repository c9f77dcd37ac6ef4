// The inverted hull: vertices displaced outwards on the screen. The twin of `hull.rs`. No bindings and no entry points.

struct HullView {
    clip_from_world: mat4x4<f32>,
    // Normals to view space, up to their length.
    view_from_normal: mat3x3<f32>,
    // Width and height of the picture in px.
    viewport_px: vec2<f32>,
    // Depth-buffer units of one px along the view: depth * x + y.
    depth_per_px: vec2<f32>,
    ink: vec4<f32>,
    // How far the hull extends beyond the surface, px.
    width_px: f32,
    padding0: u32,
    padding1: u32,
    padding2: u32,
}

const HULL_LEAST_ASIDE: f32 = 0.01;
const HULL_BEHIND_WIDTHS: f32 = 1.5;
const HULL_BEHIND_PX: f32 = 0.5;

// The displacement of a vertex on the screen, px; y up.
fn hull_offset(normal: vec3<f32>, view: HullView) -> vec2<f32> {
    let turned = view.view_from_normal * normal;
    let squared = dot(turned, turned);
    if squared == 0.0 {
        return vec2<f32>(0.0);
    }
    let aside = turned.xy * inverseSqrt(squared);
    return aside * (view.width_px / max(length(aside), HULL_LEAST_ASIDE));
}

// A vertex of the hull in clip space, displaced.
fn hull_vertex(position: vec3<f32>, normal: vec3<f32>, view: HullView) -> vec4<f32> {
    let clip = view.clip_from_world * vec4<f32>(position, 1.0);
    let offset = hull_offset(normal, view) * (2.0 / view.viewport_px) * clip.w;
    let behind_px = HULL_BEHIND_WIDTHS * view.width_px + HULL_BEHIND_PX;
    // In perspective, depth is divided by distance; in a parallel view it is linear.
    let z = (clip.z - behind_px * view.depth_per_px.y * clip.w) / (1.0 + behind_px * view.depth_per_px.x);
    return vec4<f32>(clip.xy + offset, z, clip.w);
}

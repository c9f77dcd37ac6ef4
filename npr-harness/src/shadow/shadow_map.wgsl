// Draws the shadow map.

@group(0) @binding(0) var<uniform> clip_from_world: mat4x4<f32>;

@vertex
fn vs_shadow_map(
    @location(0) position: vec3<f32>, @location(8) row_x: vec4<f32>, @location(9) row_y: vec4<f32>,
    @location(10) row_z: vec4<f32>,
) -> @builtin(position) vec4<f32> {
    let point = vec4<f32>(position, 1.0);
    return clip_from_world * vec4<f32>(dot(row_x, point), dot(row_y, point), dot(row_z, point), 1.0);
}

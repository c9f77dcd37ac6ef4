// Entry points of the hull pass.

@group(0) @binding(0) var<uniform> view: HullView;

@vertex
fn vs_hull(@location(0) position: vec3<f32>, @location(1) normal: vec3<f32>) -> @builtin(position) vec4<f32> {
    return hull_vertex(position, normal, view);
}

@fragment
fn fs_hull() -> @location(0) vec4<f32> {
    return view.ink;
}

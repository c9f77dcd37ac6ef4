// Entry points of the fin pass.

@group(0) @binding(0) var<uniform> view: FinPrintedView;

// For normals of three components: floats, or the first three of a 4-tuple.
@vertex
fn vs_fin(
    @location(0) position: vec3<f32>,
    @location(1) smooth_normal: vec3<f32>,
    @location(2) n_face0: vec3<f32>,
    @location(3) n_face1: vec3<f32>,
) -> @builtin(position) vec4<f32> {
    return fin_printed_vertex(position, smooth_normal, n_face0, n_face1, view);
}

@vertex
fn vs_fin_oct(
    @location(0) position: vec3<f32>,
    @location(1) smooth_normal: vec3<f32>,
    @location(2) oct0: vec2<f32>,
    @location(3) oct1: vec2<f32>,
) -> @builtin(position) vec4<f32> {
    return fin_printed_vertex(position, smooth_normal, normal_oct_decode(oct0), normal_oct_decode(oct1), view);
}

@fragment
fn fs_fin() -> @location(0) vec4<f32> {
    return view.ink;
}

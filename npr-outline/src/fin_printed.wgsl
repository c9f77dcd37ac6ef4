// Fins as printed (Card & Mitchell 2002, listing 1). The twin of `fin_printed.rs`. No bindings and no entry points.

struct FinPrintedView {
    clip_from_world: mat4x4<f32>,
    eye: vec3<f32>,
    // Displacement over depth.
    thickness: f32,
    ink: vec4<f32>,
    near: f32,
    far: f32,
    // 1: depth is clip z of a Direct3D projection, as printed. 0: depth is w.
    as_printed: u32,
    // 1: displaced where the product is not below zero, as the text has it.
    reversed: u32,
}

// 1 where the product of the two dot products is below zero, as the listing's `slt` gives it.
fn fin_printed_flag(position: vec3<f32>, n_face0: vec3<f32>, n_face1: vec3<f32>, eye: vec3<f32>, reversed: bool) -> f32 {
    let view = normalize(position - eye);
    return select(0.0, 1.0, (dot(view, n_face0) * dot(view, n_face1) < 0.0) != reversed);
}

fn fin_printed_depth(w: f32, view: FinPrintedView) -> f32 {
    return select(w, view.far / (view.far - view.near) * (w - view.near), view.as_printed != 0u);
}

fn fin_printed_vertex(
    position: vec3<f32>, smooth_normal: vec3<f32>, n_face0: vec3<f32>, n_face1: vec3<f32>, view: FinPrintedView,
) -> vec4<f32> {
    let flag = fin_printed_flag(position, n_face0, n_face1, view.eye, view.reversed != 0u);
    let clip = view.clip_from_world * vec4<f32>(position, 1.0);
    let thickness = fin_printed_depth(clip.w, view) * view.thickness;
    return view.clip_from_world * vec4<f32>(position + smooth_normal * (thickness * flag), 1.0);
}

// Classifies edges as lines. The twin of `contour.rs`. No bindings and no entry points.

// Numbers of `LineKind`.
const OUTLINE_SILHOUETTE: u32 = 0u;
const OUTLINE_BOUNDARY: u32 = 1u;
const OUTLINE_AUTHORED: u32 = 4u;

// The signed distance of a homogeneous eye from a plane. The order of the sum is that of the Rust twin.
fn outline_facing(plane: vec4<f32>, eye: vec4<f32>) -> f32 {
    return plane.x * eye.x + plane.y * eye.y + plane.z * eye.z + plane.w * eye.w;
}

fn outline_is_silhouette(plane0: vec4<f32>, plane1: vec4<f32>, eye: vec4<f32>) -> bool {
    return (outline_facing(plane0, eye) >= 0.0) != (outline_facing(plane1, eye) >= 0.0);
}

// The kind of line that an edge is for this eye. `own`: its kind when it is not a silhouette.
fn outline_kind(own: u32, plane0: vec4<f32>, plane1: vec4<f32>, eye: vec4<f32>) -> u32 {
    let is_fixed = own == OUTLINE_BOUNDARY || own == OUTLINE_AUTHORED;
    if !is_fixed && outline_is_silhouette(plane0, plane1, eye) {
        return OUTLINE_SILHOUETTE;
    }
    return own;
}

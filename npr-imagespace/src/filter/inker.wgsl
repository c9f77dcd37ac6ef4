// The filter of four taps that compares opposite pixels. The twin of `inker.rs`. No bindings and no entry points.

const INK_INKER_PRINTED: u32 = 0u;
const INK_INKER_CORRECTED: u32 = 1u;
const INK_INKER_EXPLICIT: u32 = 2u;

struct InkInker {
    form: u32,
    normal_cos: f32,
    normal_fall: f32,
    depth_delta: f32,
    // 0 for hard lines.
    softness: f32,
    padding0: u32,
    padding1: u32,
    padding2: u32,
}

// 1 where both pairs of normals are similar, falling to 0.
fn ink_inker_similarity(
    inker: InkInker,
    normal0: vec3<f32>,
    normal1: vec3<f32>,
    normal2: vec3<f32>,
    normal3: vec3<f32>,
    depth0: f32,
) -> f32 {
    let threshold = inker.normal_cos - inker.normal_fall * depth0;
    let pairs = saturate(4.0 * (vec2<f32>(dot(normal0, normal2), dot(normal1, normal3)) - threshold));
    return saturate(4.0 * pairs.x * pairs.y);
}

// Ink of a pixel from its four taps: normals as decoded, depths 0..1.
fn ink_inker(
    inker: InkInker,
    normal0: vec3<f32>,
    normal1: vec3<f32>,
    normal2: vec3<f32>,
    normal3: vec3<f32>,
    depths: vec4<f32>,
) -> f32 {
    let unlike = 1.0 - ink_inker_similarity(inker, normal0, normal1, normal2, normal3, depths.x);
    let d = depths.xy - depths.zw;
    if inker.form == INK_INKER_PRINTED {
        return select(0.0, 1.0, unlike + (d.x * d.x + 0.25 + d.y) > 0.5);
    }
    if inker.form == INK_INKER_CORRECTED {
        return select(0.0, 1.0, unlike + (d.x * d.x + 0.25 + (d.y * d.y + 0.25)) > 0.5);
    }
    let limit = inker.depth_delta * inker.depth_delta;
    let excess = d.x * d.x + d.y * d.y - limit;
    if inker.softness > 0.0 {
        return max(min(2.0 * unlike, 1.0), ink_ramp(excess, inker.softness * limit));
    }
    return select(0.0, 1.0, unlike > 0.5 || excess > 0.0);
}

// X-Toon. The counterpart of `x_toon.rs`.

fn toon_depth_detail(depth: f32, near: f32, far: f32) -> f32 {
    return saturate(1.0 - log(max(depth, near) / near) / log(far / near));
}

fn toon_silhouette_detail(n_dot_v: f32, exponent: f32) -> f32 {
    return pow(saturate(abs(n_dot_v)), exponent);
}

fn toon_x_toon(detailed: ToonRamp, abstracted: ToonRamp, x: f32, width: f32, detail: f32) -> vec3<f32> {
    return mix(toon_ramp(abstracted, x, width), toon_ramp(detailed, x, width), detail);
}

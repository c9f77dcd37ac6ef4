// Borders of regions. The twin of `region.rs`. No bindings and no entry points.

fn ink_region(centre: u32, taps: vec4<u32>, soft: bool, weight: f32) -> f32 {
    let across = taps != vec4<u32>(centre);
    if soft {
        return min(weight * dot(select(vec4<f32>(0.0), vec4<f32>(1.0), across), vec4<f32>(1.0)), 1.0);
    }
    return ink_any(across);
}

// As printed, on colours: the signed differences added up.
fn ink_region_printed(
    centre: vec3<f32>,
    tap0: vec3<f32>,
    tap1: vec3<f32>,
    tap2: vec3<f32>,
    tap3: vec3<f32>,
    threshold: f32,
) -> f32 {
    let one = vec3<f32>(1.0);
    let sums = vec4<f32>(
        dot(centre - tap0, one),
        dot(centre - tap1, one),
        dot(centre - tap2, one),
        dot(centre - tap3, one),
    );
    return ink_any(abs(sums) >= vec4<f32>(threshold));
}

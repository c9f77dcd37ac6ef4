// Discontinuities of normals. The twin of `normal.rs`. No bindings and no entry points.

// How far a tap lies across a border of normals; zero vectors are no normal.
fn ink_normal_tap(centre: vec3<f32>, tap: vec3<f32>, cos: f32, softness: f32) -> f32 {
    let none = vec2<bool>(all(centre == vec3<f32>(0.0)), all(tap == vec3<f32>(0.0)));
    if any(none) {
        return select(1.0, 0.0, all(none));
    }
    return ink_ramp(cos - dot(centre, tap), softness);
}

fn ink_normal(
    centre: vec3<f32>,
    tap0: vec3<f32>,
    tap1: vec3<f32>,
    tap2: vec3<f32>,
    tap3: vec3<f32>,
    cos: f32,
    softness: f32,
    weight: f32,
) -> f32 {
    let across = vec4<f32>(
        ink_normal_tap(centre, tap0, cos, softness),
        ink_normal_tap(centre, tap1, cos, softness),
        ink_normal_tap(centre, tap2, cos, softness),
        ink_normal_tap(centre, tap3, cos, softness),
    );
    if softness > 0.0 {
        return min(weight * dot(across, vec4<f32>(1.0)), 1.0);
    }
    return max(max(across.x, across.y), max(across.z, across.w));
}

// As printed, hard, without a rule for the background.
fn ink_normal_printed(
    centre: vec3<f32>,
    tap0: vec3<f32>,
    tap1: vec3<f32>,
    tap2: vec3<f32>,
    tap3: vec3<f32>,
    cos: f32,
) -> f32 {
    let dots = vec4<f32>(dot(centre, tap0), dot(centre, tap1), dot(centre, tap2), dot(centre, tap3));
    return ink_any(dots < vec4<f32>(cos));
}

// The four channels of an 8-bit unorm texel as integers.
fn ink_bytes(texel: vec4<f32>) -> vec4<i32> {
    return vec4<i32>(texel * 255.0 + 0.5);
}

// 255^2 n.m of biased bytes, exactly.
fn ink_normal_bytes_dot(a: vec3<i32>, b: vec3<i32>) -> i32 {
    let u = 2 * a - 255;
    let v = 2 * b - 255;
    return u.x * v.x + u.y * v.y + u.z * v.z;
}

// Whether two normals of biased bytes differ; zeros are no normal. `threshold` is cos * 255^2, rounded up.
fn ink_normal_bytes_differ(a: vec3<i32>, b: vec3<i32>, threshold: i32) -> bool {
    let no_a = all(a == vec3<i32>(0));
    let no_b = all(b == vec3<i32>(0));
    if no_a || no_b {
        return no_a != no_b;
    }
    return ink_normal_bytes_dot(a, b) < threshold;
}

fn ink_normal_bytes_edge(
    centre: vec3<i32>,
    tap0: vec3<i32>,
    tap1: vec3<i32>,
    tap2: vec3<i32>,
    tap3: vec3<i32>,
    threshold: i32,
) -> bool {
    return ink_normal_bytes_differ(centre, tap0, threshold) || ink_normal_bytes_differ(centre, tap1, threshold)
        || ink_normal_bytes_differ(centre, tap2, threshold) || ink_normal_bytes_differ(centre, tap3, threshold);
}

// As printed: cleared pixels are compared like any other.
fn ink_normal_bytes_edge_printed(
    centre: vec3<i32>,
    tap0: vec3<i32>,
    tap1: vec3<i32>,
    tap2: vec3<i32>,
    tap3: vec3<i32>,
    threshold: i32,
) -> bool {
    let dots = vec4<i32>(
        ink_normal_bytes_dot(centre, tap0),
        ink_normal_bytes_dot(centre, tap1),
        ink_normal_bytes_dot(centre, tap2),
        ink_normal_bytes_dot(centre, tap3),
    );
    return any(dots < vec4<i32>(threshold));
}

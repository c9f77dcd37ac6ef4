// Discontinuities of depth. The twin of `depth.rs`. No bindings and no entry points.

// How four differences of depth are combined.
const INK_DEPTH_SUM: u32 = 0u;
const INK_DEPTH_SUM_PRINTED: u32 = 1u;
const INK_DEPTH_ANY: u32 = 2u;

fn ink_depth_plain(centre: f32, taps: vec4<f32>, form: u32, threshold: f32, softness: f32) -> f32 {
    let d = abs(centre - taps);
    var measure = max(max(d.x, d.y), max(d.z, d.w));
    if form == INK_DEPTH_SUM {
        measure = d.x + d.y + (d.z + d.w);
    } else if form == INK_DEPTH_SUM_PRINTED {
        measure = d.x + d.w;
    }
    if softness > 0.0 {
        return ink_ramp(measure - threshold, softness);
    }
    return select(0.0, 1.0, measure >= threshold);
}

// On codes of 16 bits or fewer; `threshold` in codes, rounded up.
fn ink_depth_plain_codes(centre: u32, taps: vec4<u32>, form: u32, threshold: u32) -> bool {
    return ink_depth_plain_measure(centre, taps, form) >= threshold;
}

// What the plain tests compare with their threshold, on codes of 16 bits or fewer.
fn ink_depth_plain_measure(centre: u32, taps: vec4<u32>, form: u32) -> u32 {
    let d = max(vec4<u32>(centre), taps) - min(vec4<u32>(centre), taps);
    if form == INK_DEPTH_SUM {
        return d.x + d.y + d.z + d.w;
    }
    if form == INK_DEPTH_SUM_PRINTED {
        return d.x + d.w;
    }
    return max(max(d.x, d.y), max(d.z, d.w));
}

// Ink of one pair of opposite taps, all three of them surfaces; v is 1/z, or z in a parallel view.
fn ink_depth_pair(a: f32, centre: f32, b: f32, step: f32, parallel: bool, softness: f32) -> f32 {
    let second_difference = abs((a - centre) - (centre - b));
    let threshold = step * select(max(max(a, centre), b), 1.0, parallel);
    return ink_ramp(second_difference - threshold, softness * threshold);
}

// The test of second differences, on eye-space depths.
fn ink_depth_bend(centre: f32, taps: vec4<f32>, step: f32, parallel: bool, softness: f32, weight: f32) -> f32 {
    let surface = ink_is_surface(centre);
    let surfaces =
        vec4<bool>(ink_is_surface(taps.x), ink_is_surface(taps.y), ink_is_surface(taps.z), ink_is_surface(taps.w));
    let outside = surfaces != vec4<bool>(surface);
    // Background is masked out below; 1 in its place keeps the arithmetic finite.
    let depths = select(vec4<f32>(1.0), taps, surfaces);
    let depth = select(1.0, centre, surface);
    let v = select(1.0 / depths, depths, vec4<bool>(parallel));
    let own = select(1.0 / depth, depth, parallel);
    var pairs = vec2<f32>(
        ink_depth_pair(v.x, own, v.z, step, parallel, softness),
        ink_depth_pair(v.y, own, v.w, step, parallel, softness),
    );
    pairs = select(vec2<f32>(0.0), pairs, vec2<bool>(surface) & surfaces.xy & surfaces.zw);
    if softness > 0.0 {
        let across = dot(select(vec4<f32>(0.0), vec4<f32>(1.0), outside), vec4<f32>(1.0));
        return min(weight * max(across, pairs.x + pairs.y), 1.0);
    }
    return select(max(pairs.x, pairs.y), 1.0, any(outside));
}

// Whether one tap differs by more than a share `step` of the distance.
fn ink_depth_step_tap(centre: f32, tap: f32, step: f32) -> bool {
    let surface = ink_is_surface(centre);
    if !surface || !ink_is_surface(tap) {
        return surface != ink_is_surface(tap);
    }
    let a = 1.0 / centre;
    let b = 1.0 / tap;
    return abs(a - b) > step * max(a, b);
}

// First differences with a share of the distance as the threshold.
fn ink_depth_step(centre: f32, taps: vec4<f32>, step: f32) -> bool {
    return ink_depth_step_tap(centre, taps.x, step) || ink_depth_step_tap(centre, taps.y, step)
        || ink_depth_step_tap(centre, taps.z, step) || ink_depth_step_tap(centre, taps.w, step);
}

// The soft form of one tap.
fn ink_depth_step_soft_tap(centre: f32, tap: f32, step: f32, softness: f32) -> f32 {
    let surface = ink_is_surface(centre);
    if !surface || !ink_is_surface(tap) {
        return select(0.0, 1.0, surface != ink_is_surface(tap));
    }
    let a = 1.0 / centre;
    let b = 1.0 / tap;
    let threshold = step * max(a, b);
    return ink_ramp(abs(a - b) - threshold, softness * threshold);
}

// The soft form of `ink_depth_step`.
fn ink_depth_step_soft(centre: f32, taps: vec4<f32>, step: f32, softness: f32, weight: f32) -> f32 {
    let across = vec4<f32>(
        ink_depth_step_soft_tap(centre, taps.x, step, softness),
        ink_depth_step_soft_tap(centre, taps.y, step, softness),
        ink_depth_step_soft_tap(centre, taps.z, step, softness),
        ink_depth_step_soft_tap(centre, taps.w, step, softness),
    );
    return min(weight * dot(across, vec4<f32>(1.0)), 1.0);
}

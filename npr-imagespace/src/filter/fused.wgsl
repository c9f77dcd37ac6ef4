// The three filters at once over packed texels, decided on integers. The twin of `fused.rs`. No bindings and no entry
// points.

struct InkFilter {
    // Of the INK_ASKED_ bits.
    asked: u32,
    // t^2 * 2^16.
    normal_cos2: u32,
    normal_shift: u32,
    // The threshold on depth codes: max(slack, base + step * code).
    depth_slack: u32,
    depth_base: u32,
    // * 2^16.
    depth_step: u32,
    depth_shift: u32,
    // Ink of one tap across, where lines are soft.
    weight: f32,
    normal_cos: f32,
    // 0 for hard lines.
    softness: f32,
    padding0: u32,
    padding1: u32,
}

const INK_ASKED_NORMAL: u32 = 1u;
const INK_ASKED_BEND: u32 = 2u;
const INK_ASKED_STEP: u32 = 4u;
const INK_ASKED_REGION: u32 = 8u;

fn ink_dot(a: vec3<i32>, b: vec3<i32>) -> i32 {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Whether two normals differ; zero is no normal.
fn ink_tap_normal_differs(what: InkFilter, a: vec3<i32>, b: vec3<i32>) -> bool {
    let aa = ink_dot(a, a);
    let bb = ink_dot(b, b);
    if aa == 0 || bb == 0 {
        return aa != bb;
    }
    let cos = ink_dot(a, b);
    let lengths2 = u32(aa * bb) >> what.normal_shift;
    return cos < 0 || (u32(cos * cos) << (16u - what.normal_shift)) < lengths2 * what.normal_cos2;
}

// The threshold on differences of depth codes of which `nearest` is the largest.
fn ink_tap_depth_threshold(what: InkFilter, nearest: i32) -> i32 {
    let growth = ((u32(nearest) >> what.depth_shift) * what.depth_step) >> (16u - what.depth_shift);
    return i32(max(what.depth_slack, what.depth_base + growth));
}

// By how much the plain depth test is exceeded, and its threshold.
fn ink_step_excess(what: InkFilter, a: i32, b: i32) -> vec2<i32> {
    let threshold = ink_tap_depth_threshold(what, max(a, b));
    return vec2<i32>(abs(a - b) - threshold, threshold);
}

// Whether a tap lies across a border.
fn ink_tap_across(what: InkFilter, centre: InkTap, tap: InkTap) -> bool {
    if centre.region == 0u || tap.region == 0u {
        return centre.region != tap.region;
    }
    if (what.asked & INK_ASKED_REGION) != 0u && centre.region != tap.region {
        return true;
    }
    if (what.asked & INK_ASKED_STEP) != 0u && ink_step_excess(what, centre.depth, tap.depth).x > 0 {
        return true;
    }
    return (what.asked & INK_ASKED_NORMAL) != 0u && ink_tap_normal_differs(what, centre.normal, tap.normal);
}

// By how much a pair's bend exceeds its threshold, and the threshold; negative beside the background.
fn ink_bend_excess(what: InkFilter, a: InkTap, centre: InkTap, b: InkTap) -> vec2<i32> {
    if (what.asked & INK_ASKED_BEND) == 0u || a.region == 0u || centre.region == 0u || b.region == 0u {
        return vec2<i32>(-0x40000000, 0);
    }
    let threshold = ink_tap_depth_threshold(what, max(max(a.depth, centre.depth), b.depth));
    return vec2<i32>(abs(a.depth - centre.depth - (centre.depth - b.depth)) - threshold, threshold);
}

// Whether the depth bends between opposite taps.
fn ink_tap_bends(what: InkFilter, a: InkTap, centre: InkTap, b: InkTap) -> bool {
    return ink_bend_excess(what, a, centre, b).x > 0;
}

// Whether a pixel is a line.
fn ink_fused_hard(
    what: InkFilter,
    centre: InkTap,
    tap0: InkTap,
    tap1: InkTap,
    tap2: InkTap,
    tap3: InkTap,
) -> bool {
    return ink_tap_across(what, centre, tap0) || ink_tap_across(what, centre, tap1)
        || ink_tap_across(what, centre, tap2) || ink_tap_across(what, centre, tap3)
        || ink_tap_bends(what, tap0, centre, tap2) || ink_tap_bends(what, tap1, centre, tap3);
}

// The soft form of `ink_tap_normal_differs`.
fn ink_tap_normal_soft(what: InkFilter, a: vec3<i32>, b: vec3<i32>) -> f32 {
    let aa = ink_dot(a, a);
    let bb = ink_dot(b, b);
    if aa == 0 || bb == 0 {
        return select(0.0, 1.0, aa != bb);
    }
    let cos = f32(ink_dot(a, b)) * inverseSqrt(f32(aa * bb));
    return ink_ramp(what.normal_cos - cos, what.softness);
}

// The soft form of an excess over a threshold.
fn ink_depth_soft(what: InkFilter, excess: vec2<i32>) -> f32 {
    return ink_ramp(f32(excess.x), what.softness * f32(excess.y));
}

// The soft form of `ink_tap_across`.
fn ink_tap_soft(what: InkFilter, centre: InkTap, tap: InkTap) -> f32 {
    if centre.region == 0u || tap.region == 0u {
        return select(0.0, 1.0, centre.region != tap.region);
    }
    if (what.asked & INK_ASKED_REGION) != 0u && centre.region != tap.region {
        return 1.0;
    }
    var ink = 0.0;
    if (what.asked & INK_ASKED_STEP) != 0u {
        ink = ink_depth_soft(what, ink_step_excess(what, centre.depth, tap.depth));
    }
    if (what.asked & INK_ASKED_NORMAL) != 0u {
        ink = max(ink, ink_tap_normal_soft(what, centre.normal, tap.normal));
    }
    return ink;
}

// Ink of a pixel, 0..1.
fn ink_fused_soft(
    what: InkFilter,
    centre: InkTap,
    tap0: InkTap,
    tap1: InkTap,
    tap2: InkTap,
    tap3: InkTap,
) -> f32 {
    let across = ink_tap_soft(what, centre, tap0) + ink_tap_soft(what, centre, tap1)
        + ink_tap_soft(what, centre, tap2) + ink_tap_soft(what, centre, tap3);
    let bends = ink_depth_soft(what, ink_bend_excess(what, tap0, centre, tap2))
        + ink_depth_soft(what, ink_bend_excess(what, tap1, centre, tap3));
    return min(what.weight * max(across, bends), 1.0);
}

// Ink of a pixel, 0..1, hard or soft as the filter says.
fn ink_fused(what: InkFilter, centre: InkTap, tap0: InkTap, tap1: InkTap, tap2: InkTap, tap3: InkTap) -> f32 {
    if what.softness > 0.0 {
        return ink_fused_soft(what, centre, tap0, tap1, tap2, tap3);
    }
    return select(0.0, 1.0, ink_fused_hard(what, centre, tap0, tap1, tap2, tap3));
}

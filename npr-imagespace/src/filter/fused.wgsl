// The three filters in one pass over packed texels, decided with integers. The twin of `fused.rs`. No bindings and no
// entry points.

struct InkFilter {
    // The enabled tests: a sum of INK_TEST_ bits.
    tests: u32,
    // The square of the normal threshold, a cosine.
    normal_cos2: f32,
    // The threshold on depth codes: max(slack, base + step * code).
    depth_slack: u32,
    depth_base: u32,
    // Times 2^16.
    depth_step: u32,
    depth_shift: u32,
    // Ink of one tap across, where lines are soft.
    weight: f32,
    normal_cos: f32,
    // 0 for hard lines.
    softness: f32,
    // The bits of a region that are its number, and those that are its shadow state.
    region_mask: u32,
    shadow_bits: u32,
    padding: u32,
}

const INK_TEST_NORMAL: u32 = 1u;
const INK_TEST_BEND: u32 = 2u;
const INK_TEST_STEP: u32 = 4u;
const INK_TEST_REGION: u32 = 8u;
const INK_TEST_SHADOW: u32 = 16u;
const INK_TEST_ALONE: u32 = 32u;

// The four taps are processed as vectors; the only branches are on uniform values.

// Which normals differ from the centre's; a zero vector is no normal. Dot products of integers are exact, and no sum
// follows the products, so that a compiler cannot contract them to a fused multiply-add with another rounding.
fn ink_taps_normals_differ(settings: InkFilter, centre: vec3<f32>, lengths2: vec4<f32>, dots: vec4<f32>) -> vec4<bool> {
    let own2 = dot(centre, centre);
    let none = (lengths2 == vec4<f32>(0.0)) != vec4<bool>(own2 == 0.0);
    return none | (dots < vec4<f32>(0.0)) | (dots * dots < (own2 * lengths2) * settings.normal_cos2);
}

// The thresholds on differences of depth codes of which `nearest` are the largest.
fn ink_taps_depth_thresholds(settings: InkFilter, nearest: vec4<i32>) -> vec4<i32> {
    let growth = ((vec4<u32>(nearest) >> vec4<u32>(settings.depth_shift)) * settings.depth_step)
        >> vec4<u32>(16u - settings.depth_shift);
    return vec4<i32>(max(vec4<u32>(settings.depth_slack), settings.depth_base + growth));
}

// |q0 - 2 q + q2| and |q1 - 2 q + q3|, and their thresholds.
fn ink_taps_bends(settings: InkFilter, centre: i32, depths: vec4<i32>) -> vec4<i32> {
    let nearest = max(max(depths.xy, depths.zw), vec2<i32>(centre));
    let second_differences = abs(depths.xy - centre - (centre - depths.zw));
    return vec4<i32>(second_differences, ink_taps_depth_thresholds(settings, nearest.xyxy).xy);
}

// Between which taps and the centre a border of shadows lies. Background that catches no shadows has no state.
fn ink_taps_shadows_differ(settings: InkFilter, centre: u32, regions: vec4<u32>) -> vec4<bool> {
    let bits = vec4<u32>(settings.shadow_bits);
    return ink_shadow_differs(vec4<u32>(centre) & bits, regions & bits, bits);
}

// Whether a pixel is a line.
fn ink_fused_hard(
    settings: InkFilter,
    centre: InkTap,
    tap0: InkTap,
    tap1: InkTap,
    tap2: InkTap,
    tap3: InkTap,
) -> bool {
    let words = vec4<u32>(tap0.region, tap1.region, tap2.region, tap3.region);
    let regions = words & vec4<u32>(settings.region_mask);
    let region = centre.region & settings.region_mask;
    let depths = vec4<i32>(tap0.depth, tap1.depth, tap2.depth, tap3.depth);
    let surface = vec4<bool>(region != 0u);
    let surfaces = regions != vec4<u32>(0u);
    var across = surfaces != surface;
    if (settings.tests & INK_TEST_REGION) != 0u {
        across = regions != vec4<u32>(region);
    }
    if (settings.tests & INK_TEST_STEP) != 0u {
        let thresholds = ink_taps_depth_thresholds(settings, max(depths, vec4<i32>(centre.depth)));
        across = across | (surfaces & surface & (abs(depths - centre.depth) > thresholds));
    }
    if (settings.tests & INK_TEST_NORMAL) != 0u {
        let own = centre.normal;
        let lengths2 = vec4<f32>(
            dot(tap0.normal, tap0.normal),
            dot(tap1.normal, tap1.normal),
            dot(tap2.normal, tap2.normal),
            dot(tap3.normal, tap3.normal),
        );
        let dots = vec4<f32>(dot(own, tap0.normal), dot(own, tap1.normal), dot(own, tap2.normal), dot(own, tap3.normal));
        across = across | (surfaces & surface & ink_taps_normals_differ(settings, own, lengths2, dots));
    }
    if (settings.tests & INK_TEST_BEND) != 0u {
        let second_differences = ink_taps_bends(settings, centre.depth, depths);
        let exceeds = surfaces.xy & surfaces.zw & surface.xy & (second_differences.xy > second_differences.zw);
        across = across | exceeds.xyxy;
    }
    if (settings.tests & INK_TEST_SHADOW) != 0u {
        let shadows = ink_taps_shadows_differ(settings, centre.region, words);
        if (settings.tests & INK_TEST_ALONE) != 0u {
            return any(shadows) && !any(across);
        }
        across = across | shadows;
    }
    return any(across);
}

// The soft form of a difference above a threshold, both in codes. The transition begins no lower than the effect of
// rounding, which is all that a plane has; a threshold that is the effect of rounding is hard.
fn ink_taps_depth_soft(settings: InkFilter, differences: vec4<i32>, thresholds: vec4<i32>) -> vec4<f32> {
    let excess = vec4<f32>(differences - thresholds);
    let widest = 2.0 * vec4<f32>(thresholds - vec4<i32>(i32(settings.depth_slack)));
    let width = min(settings.softness * vec4<f32>(thresholds), widest);
    let soft = saturate(excess / max(width, vec4<f32>(1e-6)) + 0.5);
    return select(step(vec4<f32>(0.5), excess), soft, width > vec4<f32>(0.0));
}

// The soft form of normals that differ.
fn ink_taps_normals_soft(settings: InkFilter, centre: vec3<f32>, lengths2: vec4<f32>, dots: vec4<f32>) -> vec4<f32> {
    let own2 = dot(centre, centre);
    let products = own2 * lengths2;
    let cosines = dots * inverseSqrt(max(products, vec4<f32>(1.0)));
    let ink = saturate((settings.normal_cos - cosines) / settings.softness + 0.5);
    let none = select(vec4<f32>(0.0), vec4<f32>(1.0), (lengths2 == vec4<f32>(0.0)) != vec4<bool>(own2 == 0.0));
    return select(ink, none, products == vec4<f32>(0.0));
}

// Ink of a pixel, 0..1; the softness is above 0.
fn ink_fused_soft(
    settings: InkFilter,
    centre: InkTap,
    tap0: InkTap,
    tap1: InkTap,
    tap2: InkTap,
    tap3: InkTap,
) -> f32 {
    let words = vec4<u32>(tap0.region, tap1.region, tap2.region, tap3.region);
    let regions = words & vec4<u32>(settings.region_mask);
    let region = centre.region & settings.region_mask;
    let depths = vec4<i32>(tap0.depth, tap1.depth, tap2.depth, tap3.depth);
    let surface = vec4<bool>(region != 0u);
    let surfaces = regions != vec4<u32>(0u);
    let paper = vec4<f32>(0.0);
    var ink = paper;
    if (settings.tests & INK_TEST_STEP) != 0u {
        let thresholds = ink_taps_depth_thresholds(settings, max(depths, vec4<i32>(centre.depth)));
        ink = ink_taps_depth_soft(settings, abs(depths - centre.depth), thresholds);
    }
    if (settings.tests & INK_TEST_NORMAL) != 0u {
        let own = centre.normal;
        let lengths2 = vec4<f32>(
            dot(tap0.normal, tap0.normal),
            dot(tap1.normal, tap1.normal),
            dot(tap2.normal, tap2.normal),
            dot(tap3.normal, tap3.normal),
        );
        let dots = vec4<f32>(dot(own, tap0.normal), dot(own, tap1.normal), dot(own, tap2.normal), dot(own, tap3.normal));
        ink = max(ink, ink_taps_normals_soft(settings, own, lengths2, dots));
    }
    ink = select(paper, ink, surfaces & surface);
    var across = surfaces != surface;
    if (settings.tests & INK_TEST_REGION) != 0u {
        across = regions != vec4<u32>(region);
    }
    var shadows = paper;
    if (settings.tests & INK_TEST_SHADOW) != 0u {
        shadows = select(paper, vec4<f32>(1.0), ink_taps_shadows_differ(settings, centre.region, words));
        if (settings.tests & INK_TEST_ALONE) == 0u {
            ink = max(ink, shadows);
        }
    }
    ink = select(ink, vec4<f32>(1.0), across);
    var pairs = vec2<f32>(0.0);
    if (settings.tests & INK_TEST_BEND) != 0u {
        let second_differences = ink_taps_bends(settings, centre.depth, depths);
        pairs = ink_taps_depth_soft(settings, second_differences.xyxy, second_differences.zwzw).xy;
        pairs = select(vec2<f32>(0.0), pairs, surfaces.xy & surfaces.zw & surface.xy);
    }
    let line = min(settings.weight * max(ink.x + ink.y + (ink.z + ink.w), pairs.x + pairs.y), 1.0);
    if (settings.tests & INK_TEST_ALONE) != 0u {
        return min(settings.weight * (shadows.x + shadows.y + (shadows.z + shadows.w)), 1.0) * (1.0 - line);
    }
    return line;
}

// Ink of a pixel, 0..1, hard or soft as the filter says.
fn ink_fused(settings: InkFilter, centre: InkTap, tap0: InkTap, tap1: InkTap, tap2: InkTap, tap3: InkTap) -> f32 {
    if settings.softness > 0.0 {
        return ink_fused_soft(settings, centre, tap0, tap1, tap2, tap3);
    }
    return select(0.0, 1.0, ink_fused_hard(settings, centre, tap0, tap1, tap2, tap3));
}

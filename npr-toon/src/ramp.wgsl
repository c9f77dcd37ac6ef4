// 1D ramps. The counterpart of `ramp.rs`.

const TOON_MAX_STOPS: u32 = 8u;
// The number of stops that toon_ramp reads; see toon_bands.
override toon_stops: u32 = TOON_MAX_STOPS;

struct ToonRamp {
    // rgb the colour, w the position. Unused entries repeat the last colour at position 10,000.
    stops: array<vec4<f32>, TOON_MAX_STOPS>,
    // 1: linear interpolation, 0: steps.
    is_smooth: u32,
    padding_a: u32,
    padding_b: u32,
    padding_c: u32,
}

// The colour of the ramp at x. width: the change of x across the pixel, over which steps are antialiased.
fn toon_ramp(ramp: ToonRamp, x: f32, width: f32) -> vec3<f32> {
    var color = vec3<f32>(0.0);
    // The total weight of this stop and all later stops; 1 for the first.
    var share = 1.0;
    for (var i = 0u; i + 1u < toon_stops; i++) {
        let here = ramp.stops[i];
        let next = ramp.stops[i + 1u].w;
        let along = saturate((x - here.w) / max(next - here.w, 1e-30));
        let above = select(toon_coverage(x, next, width), along, ramp.is_smooth != 0u);
        color += (share - above) * here.rgb;
        share = above;
    }
    return color + share * ramp.stops[toon_stops - 1u].rgb;
}

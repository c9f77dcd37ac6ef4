// 1D ramps. The twin of `ramp.rs`.

const TOON_MAX_STOPS: u32 = 8u;
// How many stops toon_ramp reads; see toon_bands.
override toon_stops: u32 = TOON_MAX_STOPS;

struct ToonRamp {
    // rgb the colour, w the position; those not in use repeat the last colour, far above 1.
    stops: array<vec4<f32>, TOON_MAX_STOPS>,
    // 1: from one to the next, 0: steps.
    is_smooth: u32,
    padding_a: u32,
    padding_b: u32,
    padding_c: u32,
}

// The ramp's colour at x; a step is antialiased over a change of x by width.
fn toon_ramp(ramp: ToonRamp, x: f32, width: f32) -> vec3<f32> {
    var color = vec3<f32>(0.0);
    // How much of the colour is this stop's or a later one's; all of it at the first.
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

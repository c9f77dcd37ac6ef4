// Banded light. No bindings, no entry points; the names and meanings are those of the crate npr-toon.
// Colours are display-referred. Vectors may be in any one space.

const TOON_MAX_BANDS: u32 = 8u;
// How many bands toon_band reads; those that are not in use cost time and nothing else. Set it to the number in use
// when the pipeline is made: the loop's length is then known and the compiler unrolls it.
override toon_bands: u32 = TOON_MAX_BANDS;
// Below this change across a pixel a border is hard: 2^-23.
const TOON_MIN_WIDTH: f32 = 1.1920928955078125e-7;
// The least length of a sum of two unit vectors that has a direction.
const TOON_MIN_SUM: f32 = 1e-6;

struct ToonBands {
    // From dark to light: rgb the tone, w the N.L where the next band begins (far above 1 in the last).
    bands: array<vec4<f32>, TOON_MAX_BANDS>,
    // rgb the highlight's colour, w its threshold on N.H.
    highlight: vec4<f32>,
    // 1 .. TOON_MAX_BANDS.
    count: u32,
    // 0: no highlight.
    highlight_strength: f32,
    // 1: no highlight at N.L < 0.
    highlight_lit_only: u32,
    // 1: borders are antialiased.
    antialias: u32,
}

// Unit length; a zero vector stays zero. f32 has no squares of others: what is shorter than 1e-15 stays too short, and
// what is longer than 1e19 becomes zero.
fn toon_unit(v: vec3<f32>) -> vec3<f32> {
    return v * inverseSqrt(max(dot(v, v), 1e-30));
}

fn toon_n_dot_l(normal: vec3<f32>, to_light: vec3<f32>) -> f32 {
    return dot(toon_unit(normal), toon_unit(to_light));
}

fn toon_n_dot_l_interpolated(normal: vec3<f32>, to_light: vec3<f32>) -> f32 {
    return dot(normal, to_light);
}

// Zero where the light is opposite the eye: what is left of the sum there are roundings.
fn toon_half(to_light: vec3<f32>, to_eye: vec3<f32>) -> vec3<f32> {
    let sum = toon_unit(to_light) + toon_unit(to_eye);
    return select(vec3<f32>(0.0), toon_unit(sum), dot(sum, sum) > TOON_MIN_SUM * TOON_MIN_SUM);
}

fn toon_n_dot_h(normal: vec3<f32>, to_light: vec3<f32>, to_eye: vec3<f32>) -> f32 {
    return dot(toon_unit(normal), toon_half(to_light, to_eye));
}

// N.H of unit vectors, without making H: |L + E| is sqrt(2 + 2 L.E). 0 where L is opposite E.
fn toon_n_dot_h_of(n_dot_l: f32, n_dot_e: f32, l_dot_e: f32) -> f32 {
    let squared = 2.0 + 2.0 * l_dot_e;
    return select(0.0, (n_dot_l + n_dot_e) * inverseSqrt(max(squared, 1e-30)), squared > 0.0);
}

fn toon_n_dot_h_interpolated(normal: vec3<f32>, half_vector: vec3<f32>) -> f32 {
    return dot(normal, half_vector);
}

fn toon_width(along_x: f32, along_y: f32) -> f32 {
    return length(vec2<f32>(along_x, along_y));
}

// The change of x across this pixel. Fragment shaders only, and in uniform control flow: call it before any
// branch, loop or discard that differs between pixels.
fn toon_pixel_width(x: f32) -> f32 {
    return toon_width(dpdxFine(x), dpdyFine(x));
}

// The share of the pixel where x is at least the threshold. All but the comparison's one multiplication and addition
// depends on the width alone, so a compiler does it once for all borders. (Without a ramp, 1e-30 below counts as at.)
fn toon_coverage(x: f32, threshold: f32, width: f32) -> f32 {
    let ramp = width > TOON_MIN_WIDTH;
    let slope = select(1e30, 1.0 / max(width, TOON_MIN_WIDTH), ramp);
    return saturate((x - threshold) * slope + select(1.0, 0.5, ramp));
}

// One border: the tone below, the tone above, or their mean by the share of the pixel that each covers.
fn toon_step(below: vec3<f32>, above: vec3<f32>, threshold: f32, n_dot_l: f32, width: f32) -> vec3<f32> {
    return mix(below, above, toon_coverage(n_dot_l, threshold, width));
}

// All borders: each tone by the share of the pixel that its band covers. Width 0 is the hard form.
fn toon_band(bands: ToonBands, n_dot_l: f32, width: f32) -> vec3<f32> {
    var tone = vec3<f32>(0.0);
    // The share of the pixel at or above the band's lower border; all of it for the darkest.
    var share = 1.0;
    for (var i = 0u; i + 1u < toon_bands; i++) {
        let above = toon_coverage(n_dot_l, bands.bands[i].w, width);
        tone += (share - above) * bands.bands[i].rgb;
        share = above;
    }
    return tone + share * bands.bands[toon_bands - 1u].rgb;
}

// How opaque the highlight is.
fn toon_highlight(
    threshold: f32,
    strength: f32,
    lit_only: u32,
    n_dot_l: f32,
    nl_width: f32,
    n_dot_h: f32,
    nh_width: f32,
) -> f32 {
    let lit = select(1.0, toon_coverage(n_dot_l, 0.0, nl_width), lit_only != 0u);
    return strength * lit * toon_coverage(n_dot_h, threshold, nh_width);
}

// The surface's colour times its band's tone, under the highlight.
fn toon_shade(
    bands: ToonBands,
    base_color: vec3<f32>,
    n_dot_l: f32,
    nl_width: f32,
    n_dot_h: f32,
    nh_width: f32,
) -> vec3<f32> {
    let nl_ramp = select(0.0, nl_width, bands.antialias != 0u);
    let nh_ramp = select(0.0, nh_width, bands.antialias != 0u);
    let color = base_color * toon_band(bands, n_dot_l, nl_ramp);
    let opacity = toon_highlight(
        bands.highlight.w,
        bands.highlight_strength,
        bands.highlight_lit_only,
        n_dot_l,
        nl_ramp,
        n_dot_h,
        nh_ramp,
    );
    return mix(color, bands.highlight.rgb, opacity);
}

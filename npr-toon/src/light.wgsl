// Bands of N.L with a highlight. The counterpart of `light.rs`. No bindings, no entry points.
// Colours are display-referred. All vectors of a call must be in the same space.

const TOON_MAX_BANDS: u32 = 8u;
// The number of bands that toon_band reads. Unused bands only cost time. Set it to the number in use when the pipeline is
// created, so that the compiler can unroll the loop.
override toon_bands: u32 = TOON_MAX_BANDS;
// The width up to which a border is treated as hard: 2^-23.
const TOON_MIN_WIDTH: f32 = 1.1920928955078125e-7;
// The minimum length of the sum of two unit vectors that is normalised to a half vector.
const TOON_MIN_SUM: f32 = 1e-6;

struct ToonBands {
    // From dark to light: rgb the tone, w the N.L at which the next band begins, which is 10,000 in the last band.
    bands: array<vec4<f32>, TOON_MAX_BANDS>,
    // rgb the highlight's colour, w its threshold on N.H.
    highlight: vec4<f32>,
    // 1..TOON_MAX_BANDS.
    count: u32,
    // The opacity of the highlight; 0 without a highlight.
    highlight_strength: f32,
    // 1: no highlight at N.L < 0.
    highlight_lit_only: u32,
    // 1: borders are antialiased.
    antialias: u32,
    // 1: tones replace the surface's colour; 0: they are factors on it.
    absolute: u32,
    padding0: u32,
    padding1: u32,
    padding2: u32,
}

// A unit vector; a zero vector stays zero. The squared length must be a normal f32: vectors shorter than 1e-15 do not
// reach unit length, vectors longer than 1e19 become zero.
fn toon_unit(v: vec3<f32>) -> vec3<f32> {
    return v * inverseSqrt(max(dot(v, v), 1e-30));
}

fn toon_n_dot_l(normal: vec3<f32>, to_light: vec3<f32>) -> f32 {
    return dot(toon_unit(normal), toon_unit(to_light));
}

fn toon_n_dot_l_interpolated(normal: vec3<f32>, to_light: vec3<f32>) -> f32 {
    return dot(normal, to_light);
}

// Zero where the light is opposite to the eye, since the sum then consists of rounding errors.
fn toon_half(to_light: vec3<f32>, to_eye: vec3<f32>) -> vec3<f32> {
    let sum = toon_unit(to_light) + toon_unit(to_eye);
    return select(vec3<f32>(0.0), toon_unit(sum), dot(sum, sum) > TOON_MIN_SUM * TOON_MIN_SUM);
}

fn toon_n_dot_h(normal: vec3<f32>, to_light: vec3<f32>, to_eye: vec3<f32>) -> f32 {
    return dot(toon_unit(normal), toon_half(to_light, to_eye));
}

// N.H of unit vectors from their dot products: |L + E| is sqrt(2 + 2 L.E). 0 where L is opposite to E.
fn toon_n_dot_h_from_dots(n_dot_l: f32, n_dot_e: f32, l_dot_e: f32) -> f32 {
    let squared = 2.0 + 2.0 * l_dot_e;
    return select(0.0, (n_dot_l + n_dot_e) * inverseSqrt(max(squared, 1e-30)), squared > 0.0);
}

fn toon_n_dot_h_interpolated(normal: vec3<f32>, half_vector: vec3<f32>) -> f32 {
    return dot(normal, half_vector);
}

fn toon_width(along_x: f32, along_y: f32) -> f32 {
    return length(vec2<f32>(along_x, along_y));
}

// The change of x across this pixel. It takes derivatives: call it in fragment shaders, in uniform control flow.
fn toon_pixel_width(x: f32) -> f32 {
    return toon_width(dpdxFine(x), dpdyFine(x));
}

// The fraction of the pixel where x is at least the threshold. Slope and offset depend on the width alone, so that a
// compiler can share them between borders. For a hard border, values less than 1e-30 below the threshold count as equal.
fn toon_coverage(x: f32, threshold: f32, width: f32) -> f32 {
    let ramp = width > TOON_MIN_WIDTH;
    let slope = select(1e30, 1.0 / max(width, TOON_MIN_WIDTH), ramp);
    return saturate((x - threshold) * slope + select(1.0, 0.5, ramp));
}

// The mean of the tones below and above one border, weighted by the fraction of the pixel that each covers.
fn toon_step(below: vec3<f32>, above: vec3<f32>, threshold: f32, n_dot_l: f32, width: f32) -> vec3<f32> {
    return mix(below, above, toon_coverage(n_dot_l, threshold, width));
}

// The mean of all tones, weighted by the fraction of the pixel that each band covers. Width 0 gives hard borders.
fn toon_band(bands: ToonBands, n_dot_l: f32, width: f32) -> vec3<f32> {
    var tone = vec3<f32>(0.0);
    // The fraction of the pixel at or above the band's lower threshold; 1 for the darkest band.
    var share = 1.0;
    for (var i = 0u; i + 1u < toon_bands; i++) {
        let above = toon_coverage(n_dot_l, bands.bands[i].w, width);
        tone += (share - above) * bands.bands[i].rgb;
        share = above;
    }
    return tone + share * bands.bands[toon_bands - 1u].rgb;
}

// The opacity of the highlight.
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

// The surface's colour times the tone of its band, or the tone alone, covered by the highlight.
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
    let factor = select(base_color, vec3<f32>(1.0), bands.absolute != 0u);
    let color = factor * toon_band(bands, n_dot_l, nl_ramp);
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

// Cool-to-warm lighting. The counterpart of `shade.rs`. No bindings, no entry points.
// Colours are display-referred. Vectors point away from the surface, and all vectors of a call must be in the same space.

struct GoochModel {
    // rgb k_blue, w the share of the object's colour in the cool tone.
    blue: vec4<f32>,
    // rgb k_yellow, w the share of the object's colour in the warm tone.
    yellow: vec4<f32>,
    // rgb the highlight's colour, w its strength; 0 without a highlight.
    highlight: vec4<f32>,
    exponent: f32,
    padding_a: u32,
    padding_b: u32,
    padding_c: u32,
}

// A unit vector; a zero vector stays zero. The squared length must be a normal f32: vectors shorter than 1e-15 do not
// reach unit length, vectors longer than 1e19 become zero.
fn gooch_unit(v: vec3<f32>) -> vec3<f32> {
    return v * inverseSqrt(max(dot(v, v), 1e-30));
}

fn gooch_n_dot_l(normal: vec3<f32>, to_light: vec3<f32>) -> f32 {
    return dot(gooch_unit(normal), gooch_unit(to_light));
}

// The weight of the warm tone, 0..1.
fn gooch_weight(n_dot_l: f32) -> f32 {
    return saturate((1.0 + n_dot_l) * 0.5);
}

fn gooch_cool(model: GoochModel, k_d: vec3<f32>) -> vec3<f32> {
    return saturate(model.blue.rgb + model.blue.w * k_d);
}

fn gooch_warm(model: GoochModel, k_d: vec3<f32>) -> vec3<f32> {
    return saturate(model.yellow.rgb + model.yellow.w * k_d);
}

// The colour without highlight. k_d: the object's colour, from its material or its texture.
fn gooch_tone(model: GoochModel, k_d: vec3<f32>, n_dot_l: f32) -> vec3<f32> {
    return mix(gooch_cool(model, k_d), gooch_warm(model, k_d), gooch_weight(n_dot_l));
}

// The cosine between the reflected light direction R and the direction to the eye, of unit or zero vectors, as
// (|R|^2 + |E|^2 - |R - E|^2) / 2. Near the centre of the highlight |R - E|^2 is small and so is its rounding error.
// |R| = |L| and |E| are 1 or 0, so rounding their squares removes the error of the normalisation, which a large exponent
// would amplify: (1 - 1e-7)^1e6 is 0.9.
fn gooch_r_dot_e_unit(n: vec3<f32>, l: vec3<f32>, e: vec3<f32>) -> f32 {
    let difference = 2.0 * dot(n, l) * n - l - e;
    return 0.5 * (round(dot(l, l)) + round(dot(e, e)) - dot(difference, difference));
}

// The same for vectors of any length.
fn gooch_r_dot_e(normal: vec3<f32>, to_light: vec3<f32>, to_eye: vec3<f32>) -> f32 {
    return gooch_r_dot_e_unit(gooch_unit(normal), gooch_unit(to_light), gooch_unit(to_eye));
}

// The opacity of the highlight.
fn gooch_highlight(model: GoochModel, n_dot_l: f32, r_dot_e: f32) -> f32 {
    // pow(0, x) differs between compilers, so its base is kept above 0.
    let opacity = model.highlight.w * pow(clamp(r_dot_e, 1e-30, 1.0), model.exponent);
    return select(0.0, opacity, n_dot_l > 0.0 && r_dot_e > 0.0);
}

fn gooch_over(model: GoochModel, tone: vec3<f32>, opacity: f32) -> vec3<f32> {
    return mix(tone, model.highlight.rgb, opacity);
}

// The colour of a point.
fn gooch_shade(
    model: GoochModel,
    k_d: vec3<f32>,
    normal: vec3<f32>,
    to_light: vec3<f32>,
    to_eye: vec3<f32>,
) -> vec3<f32> {
    let n_dot_l = gooch_n_dot_l(normal, to_light);
    let opacity = gooch_highlight(model, n_dot_l, gooch_r_dot_e(normal, to_light, to_eye));
    return gooch_over(model, gooch_tone(model, k_d, n_dot_l), opacity);
}

// What light makes of a surface's own colour. The twin of `cpu/shade.rs`; before `surface.wgsl`, after the libraries of
// npr-toon and npr-gooch.

const SHADE_LAMBERT: u32 = 0u;
const SHADE_TOON: u32 = 1u;
const SHADE_RAMP: u32 = 2u;
const SHADE_PAINTER: u32 = 3u;
const SHADE_GOOCH: u32 = 4u;
const SHADE_NORMALS: u32 = 5u;

// What of the shades there is, known when the pipeline is made: a software rasteriser runs through what it branches
// around.
override surface_shade: u32 = SHADE_LAMBERT;
// 0 brought to unit length at the pixel, 1 as interpolated, 2 light at the vertices.
override surface_normals: u32 = 0u;
// Whether the lights' places are positions.
override surface_first_positional: bool = false;
override surface_second_positional: bool = false;
// Whether the bands have a highlight.
override surface_highlight: bool = true;
// Whether the light has another colour than white, or another brightness than 1.
override surface_tinted: bool = true;
// Ramps: 0 computed, 1 from an image's nearest texels, 2 from an image, filtered.
override surface_ramp_image: u32 = 0u;
override surface_half_lambert: bool = false;

// Numbers of the shade.
struct SurfaceShade {
    // What Lambert leaves where no light falls.
    ambient: f32,
    half_scale: f32,
    half_bias: f32,
    half_squared: u32,
    // What the ends of a ramp's row stand for.
    row_ends: vec2<f32>,
    padding: vec2<u32>,
}

@group(0) @binding(1) var<uniform> toon: ToonBands;
@group(0) @binding(3) var<uniform> lights: ToonPainter;
@group(0) @binding(4) var<uniform> shade: SurfaceShade;
@group(0) @binding(5) var<uniform> ramps: ToonRamp2d;
@group(0) @binding(6) var<uniform> gooch: GoochModel;
@group(0) @binding(7) var ramp_image: texture_2d<f32>;

// From a point to the first light: a unit vector.
fn to_first_light(at: vec3<f32>) -> vec3<f32> {
    if surface_first_positional {
        return toon_to_light(lights.place_a, at);
    }
    return lights.place_a.xyz;
}

fn to_second_light(at: vec3<f32>) -> vec3<f32> {
    if surface_second_positional {
        return toon_to_light(lights.place_b, at);
    }
    return lights.place_b.xyz;
}

fn reach_of_first(n_dot_l: f32) -> f32 {
    if surface_tinted {
        return toon_reach(n_dot_l, lights.brightness.x);
    }
    return n_dot_l;
}

// What a shade is looked up with at a point: how far the light reaches, and beside it N.H; the reach of two lights; for
// Gooch N.L and R.E. The normal is of unit length, the vector to the eye of any.
fn light_at(n: vec3<f32>, at: vec3<f32>, eye: vec3<f32>) -> vec2<f32> {
    let l = to_first_light(at);
    let n_dot_l = dot(n, l);
    if surface_shade == SHADE_PAINTER {
        return vec2<f32>(reach_of_first(n_dot_l), toon_reach(dot(n, to_second_light(at)), lights.brightness.y));
    }
    if surface_shade == SHADE_GOOCH {
        return vec2<f32>(n_dot_l, gooch_r_dot_e_of(n, l, toon_unit(eye)));
    }
    if surface_shade == SHADE_TOON && surface_highlight {
        let e = toon_unit(eye);
        return vec2<f32>(reach_of_first(n_dot_l), toon_n_dot_h_of(n_dot_l, dot(n, e), dot(l, e)));
    }
    return vec2<f32>(reach_of_first(n_dot_l), 0.0);
}

// Of what is interpolated beside the normal: the second vector, a unit vector at each vertex.
fn second_at(at: vec3<f32>, eye: vec3<f32>) -> vec3<f32> {
    if surface_shade == SHADE_PAINTER {
        return to_second_light(at);
    }
    if surface_shade == SHADE_GOOCH {
        return toon_unit(eye);
    }
    return toon_half(to_first_light(at), eye);
}

// The same as light_at, of vectors as they were interpolated.
fn light_interpolated(n: vec3<f32>, l: vec3<f32>, second: vec3<f32>) -> vec2<f32> {
    let n_dot_l = toon_n_dot_l_interpolated(n, l);
    if surface_shade == SHADE_PAINTER {
        return vec2<f32>(reach_of_first(n_dot_l), toon_reach(dot(n, second), lights.brightness.y));
    }
    if surface_shade == SHADE_GOOCH {
        return vec2<f32>(n_dot_l, 2.0 * n_dot_l * dot(n, second) - dot(l, second));
    }
    return vec2<f32>(reach_of_first(n_dot_l), toon_n_dot_h_interpolated(n, second));
}

// Light that was computed with the normal of the front, on the back. R.E does not know the normal's sign.
fn light_of_back(light: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(-light.x, select(-light.y, light.y, surface_shade == SHADE_GOOCH));
}

fn ramp_texel(x: u32, y: u32) -> vec4<f32> {
    return textureLoad(ramp_image, vec2<u32>(x, y), 0);
}

fn shade_of_ramp(x: f32, width: f32) -> vec3<f32> {
    let count = textureDimensions(ramp_image).x;
    if surface_ramp_image == 0u {
        return toon_ramp(ramps.a, x, width);
    }
    if surface_ramp_image == 1u {
        return ramp_texel(toon_row_nearest(x, shade.row_ends.x, shade.row_ends.y, count), 0u).rgb;
    }
    let taps = toon_row_taps(x, shade.row_ends.x, shade.row_ends.y, count);
    return mix(ramp_texel(taps.left, 0u).rgb, ramp_texel(taps.right, 0u).rgb, taps.share);
}

fn shade_of_table(uv: vec2<f32>, widths: vec2<f32>) -> vec3<f32> {
    let count = textureDimensions(ramp_image);
    if surface_ramp_image == 0u {
        return toon_ramp_2d(ramps, uv, widths);
    }
    if surface_ramp_image == 1u {
        return ramp_texel(toon_row_nearest(uv.x, 0.0, 1.0, count.x), toon_row_nearest(uv.y, 0.0, 1.0, count.y)).rgb;
    }
    let u = toon_row_taps(uv.x, 0.0, 1.0, count.x);
    let v = toon_row_taps(uv.y, 0.0, 1.0, count.y);
    return toon_table_mix(
        ramp_texel(u.left, v.left), ramp_texel(u.right, v.left), ramp_texel(u.left, v.right), ramp_texel(u.right, v.right),
        u.share, v.share,
    ).rgb;
}

fn lambert(base: vec3<f32>, reach: f32) -> vec3<f32> {
    return base * (shade.ambient + (1.0 - shade.ambient) * max(reach, 0.0));
}

// `toon_shade`, with the highlight left out when the pipeline is made.
fn banded(base: vec3<f32>, light_there: vec2<f32>, at: ShadowAt) -> vec3<f32> {
    let light = shadow_light(light_there, at);
    var widths = vec2<f32>(0.0);
    if toon.antialias != 0u {
        widths.x = shadow_border_width(light_there.x, -abs(light_there.x), at);
        if surface_highlight {
            widths.y = toon_pixel_border_width(light_there.y);
        }
    }
    let color = base * toon_band(toon, light.x, widths.x);
    if !surface_highlight {
        return color;
    }
    let opacity = toon_highlight(
        toon.highlight.w, toon.highlight_strength, toon.highlight_lit_only, light.x, widths.x, light.y, widths.y,
    );
    return mix(color, toon.highlight.rgb, opacity);
}

// A surface's own colour under the light, under the shadow that falls on it. In uniform control flow.
fn shaded(base: vec3<f32>, light_there: vec2<f32>, at: ShadowAt) -> vec3<f32> {
    let light = shadow_light(light_there, at);
    if surface_shade == SHADE_PAINTER {
        let of_first = shadow_border_width(light_there.x, -abs(light_there.x), at);
        let widths = vec2<f32>(of_first, toon_pixel_border_width(light_there.y));
        return toon_paint(lights, shade_of_table(light, widths), vec4<f32>(base, 1.0)).rgb;
    }
    if surface_shade == SHADE_GOOCH {
        return gooch_over(gooch, gooch_tone(gooch, base, light.x), gooch_highlight(gooch, light.x, light.y));
    }
    var tinted = base;
    if surface_tinted {
        tinted *= lights.light_color.rgb;
    }
    if surface_shade == SHADE_TOON {
        return banded(tinted, light_there, at);
    }
    if surface_shade == SHADE_RAMP {
        var x = light_there.x;
        var dark = -abs(x);
        if surface_half_lambert {
            x = toon_half_lambert(shade.half_scale, shade.half_bias, shade.half_squared, x);
            dark = toon_half_lambert(shade.half_scale, shade.half_bias, shade.half_squared, dark);
        }
        let width = shadow_border_width(x, dark, at);
        return tinted * shade_of_ramp(select(x, dark, surface_shadow != 0u && at.dark), width);
    }
    return lambert(tinted, light.x);
}

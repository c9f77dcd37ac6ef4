// Bands of light. The second coordinate is N.H.

// Whether there is a highlight.
override shade_highlight: bool = true;

// Whether tones replace the colours of surface and light.
override shade_absolute: bool = false;

@group(0) @binding(1) var<uniform> shade: ToonBands;

fn shade_diffuse(n_dot_l: f32) -> f32 {
    return by_brightness(n_dot_l);
}

fn shade_second(n: vec3<f32>, l: vec3<f32>, n_dot_l: f32, at: vec3<f32>, eye: vec3<f32>) -> f32 {
    if !shade_highlight {
        return 0.0;
    }
    let e = toon_unit(eye);
    return toon_n_dot_h_from_dots(n_dot_l, dot(n, e), dot(l, e));
}

fn shade_second_vector(at: vec3<f32>, eye: vec3<f32>) -> vec3<f32> {
    return toon_half(to_first_light(at), eye);
}

fn shade_second_interpolated(n: vec3<f32>, l: vec3<f32>, n_dot_l: f32, second: vec3<f32>) -> f32 {
    return toon_n_dot_h_interpolated(n, second);
}

fn shade_second_of_back(second: f32) -> f32 {
    return -second;
}

fn shade_second_in_shadow(second: f32) -> f32 {
    return -1.0;
}

// `toon_shade` of npr-toon, with the highlight disabled by an override constant if there is none. Requires uniform
// control flow.
fn shade_color(base: vec3<f32>, light_there: vec2<f32>, n: vec3<f32>, at: ShadowAt) -> vec3<f32> {
    let light = shadow_light(light_there, at);
    var widths = vec2<f32>(0.0);
    if shade.antialias != 0u {
        widths.x = shadow_border_width(light_there.x, -abs(light_there.x), at);
        if shade_highlight {
            widths.y = shade_border_width(light_there.y);
        }
    }
    var color = toon_band(shade, light.x, widths.x);
    if !shade_absolute {
        color *= by_light_color(base);
    }
    if !shade_highlight {
        return color;
    }
    let opacity = toon_highlight(
        shade.highlight.w, shade.highlight_strength, shade.highlight_lit_only, light.x, widths.x, light.y, widths.y,
    );
    return mix(color, shade.highlight.rgb, opacity);
}

// The geometry pass. Appended to npr-toon's library.

struct SurfaceView {
    clip_from_world: mat4x4<f32>,
    // xyz: from what the picture's corner shows towards the eye, and how that changes along x and y, per px. Of any
    // length.
    to_eye: vec4<f32>,
    to_eye_dx: vec4<f32>,
    to_eye_dy: vec4<f32>,
    // xyz: unit vector to the light; w: what Lambert leaves where no light falls.
    to_light: vec4<f32>,
}

struct SurfaceMaterial {
    // Plain surfaces: display-referred; textured ones: linear.
    base_color: vec4<f32>,
    // Texels of the texture's largest level, its number of levels - 1, and the least alpha that is kept.
    texture_size: vec2<f32>,
    last_level: f32,
    cutoff: f32,
}

// Whether the bands have a highlight. Known when the pipeline is made, since a software rasteriser runs through what it
// branches around.
override surface_highlight: bool = true;

@group(0) @binding(0) var<uniform> view: SurfaceView;
@group(0) @binding(1) var<uniform> toon: ToonBands;
@group(1) @binding(0) var<uniform> material: SurfaceMaterial;
@group(1) @binding(1) var base_texture: texture_2d<f32>;
@group(1) @binding(2) var base_sampler: sampler;

struct Surface {
    @builtin(position) position: vec4<f32>,
    @location(0) normal: vec3<f32>,
}

struct TexturedSurface {
    @builtin(position) position: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) uv: vec2<f32>,
    @location(2) color: vec4<f32>,
}

fn to_eye(position_px: vec2<f32>) -> vec3<f32> {
    return view.to_eye.xyz + view.to_eye_dx.xyz * position_px.x + view.to_eye_dy.xyz * position_px.y;
}

@vertex
fn vs_depth(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> {
    return view.clip_from_world * vec4<f32>(position, 1.0);
}

@vertex
fn vs_plain(@location(0) position: vec3<f32>, @location(1) normal: vec3<f32>) -> Surface {
    return Surface(view.clip_from_world * vec4<f32>(position, 1.0), normal);
}

@vertex
fn vs_textured(
    @location(0) position: vec3<f32>, @location(1) normal: vec3<f32>, @location(2) uv: vec2<f32>,
    @location(3) color: vec4<f32>,
) -> TexturedSurface {
    return TexturedSurface(view.clip_from_world * vec4<f32>(position, 1.0), normal, uv, color);
}

fn encode_srgb(linear: vec3<f32>) -> vec3<f32> {
    let c = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    return select(1.055 * pow(c, vec3<f32>(1.0 / 2.4)) - 0.055, c * 12.92, c <= vec3<f32>(0.0031308));
}

// Linear colour and alpha. In uniform control flow.
fn base_color(uv: vec2<f32>, color: vec4<f32>) -> vec4<f32> {
    let along_x = dpdxFine(uv) * material.texture_size;
    let along_y = dpdyFine(uv) * material.texture_size;
    let longest = max(max(dot(along_x, along_x), dot(along_y, along_y)), 1e-30);
    let level = clamp(0.5 * log2(longest), 0.0, material.last_level);
    return material.base_color * color * textureSampleLevel(base_texture, base_sampler, uv, level);
}

fn lambert(base: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let ambient = view.to_light.w;
    return base * (ambient + (1.0 - ambient) * max(dot(toon_unit(normal), view.to_light.xyz), 0.0));
}

// `toon_shade`, with the highlight left out when the pipeline is made. In uniform control flow.
fn banded(base: vec3<f32>, normal: vec3<f32>, eye: vec3<f32>) -> vec3<f32> {
    let n = toon_unit(normal);
    let n_dot_l = dot(n, view.to_light.xyz);
    var nl_width = 0.0;
    if toon.antialias != 0u {
        nl_width = toon_pixel_width(n_dot_l);
    }
    let color = base * toon_band(toon, n_dot_l, nl_width);
    if !surface_highlight {
        return color;
    }
    let e = toon_unit(eye);
    let n_dot_h = toon_n_dot_h_of(n_dot_l, dot(n, e), dot(view.to_light.xyz, e));
    var nh_width = 0.0;
    if toon.antialias != 0u {
        nh_width = toon_pixel_width(n_dot_h);
    }
    let opacity = toon_highlight(
        toon.highlight.w, toon.highlight_strength, toon.highlight_lit_only, n_dot_l, nl_width, n_dot_h, nh_width,
    );
    return mix(color, toon.highlight.rgb, opacity);
}

fn facing(normal: vec3<f32>, front: bool) -> vec3<f32> {
    return select(-normal, normal, front);
}

@fragment
fn fs_lambert(in: Surface, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return vec4<f32>(lambert(material.base_color.rgb, facing(in.normal, front)), material.base_color.a);
}

@fragment
fn fs_toon(in: Surface, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return vec4<f32>(banded(material.base_color.rgb, facing(in.normal, front), to_eye(in.position.xy)), material.base_color.a);
}

@fragment
fn fs_lambert_textured(in: TexturedSurface, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let base = base_color(in.uv, in.color);
    if base.a < material.cutoff {
        discard;
    }
    return vec4<f32>(lambert(encode_srgb(base.rgb), facing(in.normal, front)), base.a);
}

@fragment
fn fs_toon_textured(in: TexturedSurface, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let base = base_color(in.uv, in.color);
    let shaded = banded(encode_srgb(base.rgb), facing(in.normal, front), to_eye(in.position.xy));
    if base.a < material.cutoff {
        discard;
    }
    return vec4<f32>(shaded, base.a);
}

@fragment
fn fs_cut_out(in: TexturedSurface) {
    if base_color(in.uv, in.color).a < material.cutoff {
        discard;
    }
}

@fragment
fn fs_nothing() {
}

// The filters over textures of normals, depth and regions.

@group(0) @binding(1) var<uniform> what: InkSeparate;
@group(0) @binding(2) var normals: texture_2d<f32>;
@group(0) @binding(3) var depths: texture_2d<f32>;
@group(0) @binding(4) var regions: texture_2d<u32>;
// For `depths`, which may be a depth buffer: GLSL cannot load its texels, and in GLSL ES 3.00 it is complete only with
// a sampler that does not filter.
@group(0) @binding(5) var nearest: sampler;

// Constants of the pipeline, since software rasterisers execute both sides of branches. Tests that are not enabled have
// a texture of one texel, which is not read.
override with_normal: bool;
override with_region: bool;
// The test of depth; 0 for none.
override depth_test: u32;
override soft: bool;

const BEND: u32 = 1u;
const STEP: u32 = 2u;
const PLAIN: u32 = 3u;

fn size_px() -> vec2<u32> {
    if with_normal {
        return textureDimensions(normals);
    }
    if depth_test != 0u {
        return textureDimensions(depths);
    }
    return textureDimensions(regions);
}

fn normal_at(at: vec2<i32>) -> vec3<f32> {
    return ink_separate_normal(textureLoad(normals, at, 0).xyz, what.normal_biased != 0u);
}

fn depth_at(at: vec2<i32>) -> f32 {
    let middle = (vec2<f32>(at) + 0.5) / vec2<f32>(textureDimensions(depths));
    let texel = textureSampleLevel(depths, nearest, middle, 0.0).x;
    if depth_test == PLAIN {
        return texel;
    }
    return ink_separate_depth(texel, what);
}

fn depth_ink(centre: f32, taps: vec4<f32>, softness: f32) -> f32 {
    if depth_test == BEND {
        return ink_depth_bend(centre, taps, what.depth_threshold, what.parallel != 0u, softness, what.weight);
    }
    if depth_test == PLAIN {
        return ink_depth_plain(
            centre, taps, what.plain_form, what.depth_threshold, softness * what.depth_threshold);
    }
    if soft {
        return ink_depth_step_soft(centre, taps, what.depth_threshold, softness, what.weight);
    }
    return select(0.0, 1.0, ink_depth_step(centre, taps, what.depth_threshold));
}

@fragment
fn fs_separate(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(position.xy);
    let reach = ink_reach(vec2<u32>(pixel), size_px(), longest_px());
    let at0 = pixel + ink_tap(0u, steps(), reach);
    let at1 = pixel + ink_tap(1u, steps(), reach);
    let at2 = pixel + ink_tap(2u, steps(), reach);
    let at3 = pixel + ink_tap(3u, steps(), reach);
    var softness = 0.0;
    if soft {
        softness = what.softness;
    }
    var ink = 0.0;
    if with_normal {
        ink = ink_normal(
            normal_at(pixel), normal_at(at0), normal_at(at1), normal_at(at2), normal_at(at3), what.normal_cos, softness,
            what.weight);
    }
    if depth_test != 0u {
        let taps = vec4<f32>(depth_at(at0), depth_at(at1), depth_at(at2), depth_at(at3));
        ink = max(ink, depth_ink(depth_at(pixel), taps, softness));
    }
    if with_region {
        let taps = vec4<u32>(
            textureLoad(regions, at0, 0).x,
            textureLoad(regions, at1, 0).x,
            textureLoad(regions, at2, 0).x,
            textureLoad(regions, at3, 0).x,
        );
        ink = max(ink, ink_region(textureLoad(regions, pixel, 0).x, taps, soft, what.weight));
    }
    return ink_premultiplied(ink, how);
}

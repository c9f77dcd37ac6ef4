// Lines behind see-through surfaces: their nearest four layers, each with depth, 0 without a surface, and alpha.

@group(1) @binding(3) var veil_depth_0: texture_2d<f32>;
@group(1) @binding(4) var veil_alpha_0: texture_2d<f32>;
@group(1) @binding(5) var veil_depth_1: texture_2d<f32>;
@group(1) @binding(6) var veil_alpha_1: texture_2d<f32>;
@group(1) @binding(7) var veil_depth_2: texture_2d<f32>;
@group(1) @binding(8) var veil_alpha_2: texture_2d<f32>;
@group(1) @binding(9) var veil_depth_3: texture_2d<f32>;
@group(1) @binding(10) var veil_alpha_3: texture_2d<f32>;

// The share of a line that see-through surfaces let through at a pixel, whose centre is `offset` px from the line.
fn ink_through(pixel: vec2<i32>, depth: f32, offset: f32, slopes: vec2<f32>, per_px: f32) -> f32 {
    let at = (vec2<f32>(pixel) + 0.5) / view.viewport_px;
    let depths = vec4<f32>(
        textureSampleLevel(veil_depth_0, nearest, at, 0.0).x,
        textureSampleLevel(veil_depth_1, nearest, at, 0.0).x,
        textureSampleLevel(veil_depth_2, nearest, at, 0.0).x,
        textureSampleLevel(veil_depth_3, nearest, at, 0.0).x,
    );
    let alphas = vec4<f32>(
        textureSampleLevel(veil_alpha_0, nearest, at, 0.0).x,
        textureSampleLevel(veil_alpha_1, nearest, at, 0.0).x,
        textureSampleLevel(veil_alpha_2, nearest, at, 0.0).x,
        textureSampleLevel(veil_alpha_3, nearest, at, 0.0).x,
    );
    return outline_through(depths, alphas, depth, offset, slopes, per_px);
}

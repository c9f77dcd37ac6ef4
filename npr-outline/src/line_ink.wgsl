// The coverage of a pixel by a line, and the colour that results.

@group(0) @binding(0) var<uniform> view: OutlineView;

// A depth buffer, bound as floats and read through a sampler: GLSL cannot load single texels of a depth texture, and in
// GLSL ES 3.00 such a texture is complete only with a sampler that does not filter.
@group(1) @binding(0) var scene_depth: texture_2d<f32>;
// The picture without lines.
@group(1) @binding(1) var painted: texture_2d<f32>;
// Without filtering, clamped to the edge.
@group(1) @binding(2) var nearest: sampler;

// The depth at a pixel; outside the picture that of the nearest border pixel.
fn ink_depth(pixel: vec2<i32>) -> f32 {
    return textureSampleLevel(scene_depth, nearest, (vec2<f32>(pixel) + 0.5) / view.viewport_px, 0.0).x;
}

// Whether the surface around a point of a line is in front of it by more than rounding and its curvature explain.
fn outline_plane_hides(quad: vec4<f32>, corner: vec2<f32>, on_line: vec2<f32>, depth: f32, per_px: f32) -> bool {
    if any(corner < vec2<f32>(0.0)) || any(corner > view.viewport_px - 2.0) {
        return false;
    }
    let within = on_line - 0.5 - corner;
    let at = vec2<i32>(corner);
    let before = outline_plane_in_front(quad, within, depth, per_px);
    if before <= 0.0 {
        return false;
    }
    let beyond = within > vec2<f32>(0.5);
    let row = select(quad.xy, quad.zw, beyond.y);
    let column = select(quad.xz, quad.yw, beyond.x);
    let near = at + vec2<i32>(beyond);
    let curvature_x = outline_second_difference(
        vec4<f32>(ink_depth(vec2<i32>(at.x - 1, near.y)), row, ink_depth(vec2<i32>(at.x + 2, near.y))),
    );
    let curvature_y = outline_second_difference(
        vec4<f32>(ink_depth(vec2<i32>(near.x, at.y - 1)), column, ink_depth(vec2<i32>(near.x, at.y + 2))),
    );
    return before > 2.0 * (curvature_x + curvature_y);
}

// The share of the pixel around a point that a line covers, 0 where the line is hidden.
fn ink_coverage(
    ends_px: vec4<f32>, depths_slopes: vec4<f32>, direction: vec2<f32>, width_px: f32, traits: u32, point_px: vec2<f32>,
) -> f32 {
    let fraction = outline_nearest(ends_px, point_px);
    let on_line = mix(ends_px.xy, ends_px.zw, fraction);
    let coverage = outline_coverage_at(on_line, direction, point_px, width_px);
    if coverage <= 0.0 {
        return 0.0;
    }
    let depth = mix(depths_slopes.x, depths_slopes.y, fraction);
    let per_px = depth * view.depth_per_px.x + view.depth_per_px.y;
    let corner = floor(on_line - 0.5);
    let at = vec2<i32>(corner);
    let quad = vec4<f32>(
        ink_depth(at), ink_depth(at + vec2<i32>(1, 0)), ink_depth(at + vec2<i32>(0, 1)), ink_depth(at + vec2<i32>(1, 1)),
    );
    let slopes = depths_slopes.zw;
    let offset = outline_cross(direction, corner + 0.5 - on_line);
    let offsets = vec4<f32>(offset, offset - direction.y, offset + direction.x, offset + direction.x - direction.y);
    let upper_left = outline_vote(quad.x, depth, offsets.x, slopes, per_px);
    let upper_right = outline_vote(quad.y, depth, offsets.y, slopes, per_px);
    let lower_left = outline_vote(quad.z, depth, offsets.z, slopes, per_px);
    let lower_right = outline_vote(quad.w, depth, offsets.w, slopes, per_px);
    let votes = vec2<bool>(false, (traits & OUTLINE_TRAIT_CUT_OUT) == 0u)
        | upper_left | upper_right | lower_left | lower_right;
    if !all(votes) || outline_plane_hides(quad, corner, on_line, depth, per_px) {
        return 0.0;
    }
    let sees = vec4<bool>(upper_left.x, upper_right.x, lower_left.x, lower_right.x);
    let through = vec4<f32>(
        ink_through(at, depth, offsets.x, slopes, per_px),
        ink_through(at + vec2<i32>(1, 0), depth, offsets.y, slopes, per_px),
        ink_through(at + vec2<i32>(0, 1), depth, offsets.z, slopes, per_px),
        ink_through(at + vec2<i32>(1, 1), depth, offsets.w, slopes, per_px),
    );
    let seen = select(vec4<f32>(0.0), through, sees);
    return coverage * max(max(seen.x, seen.y), max(seen.z, seen.w));
}

fn ink_over(below: vec4<f32>, coverage: f32) -> vec4<f32> {
    let opacity = view.ink.a * coverage;
    return vec4<f32>(mix(below.rgb, view.ink.rgb, opacity), opacity + below.a * (1.0 - opacity));
}

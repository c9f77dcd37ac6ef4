// A line's ink in a pixel, whoever asks; appended to `line.wgsl`.

@group(0) @binding(0) var<uniform> view: OutlineView;

@group(1) @binding(0) var scene_depth: texture_depth_2d;
// The picture without lines.
@group(1) @binding(1) var painted: texture_2d<f32>;

fn ink_depth(pixel: vec2<i32>) -> f32 {
    return textureLoad(scene_depth, clamp(pixel, vec2<i32>(0), vec2<i32>(view.viewport_px) - 1), 0);
}

// Whether the surface around a line's point is in front of it by more than rounding and its own bends explain.
fn outline_plane_hides(on_line: vec2<f32>, depth: f32, per_px: f32) -> bool {
    let corner = max(min(floor(on_line - 0.5), view.viewport_px - 2.0), vec2<f32>(0.0));
    let within = on_line - 0.5 - corner;
    let at = vec2<i32>(corner);
    let quad = vec4<f32>(
        ink_depth(at), ink_depth(at + vec2<i32>(1, 0)), ink_depth(at + vec2<i32>(0, 1)), ink_depth(at + vec2<i32>(1, 1)),
    );
    let before = outline_plane_before(quad, within, depth, per_px);
    if before <= 0.0 {
        return false;
    }
    let beyond = within > vec2<f32>(0.5);
    let row = select(quad.xy, quad.zw, beyond.y);
    let column = select(quad.xz, quad.yw, beyond.x);
    let near = at + vec2<i32>(beyond);
    let bend_x = outline_bend(
        vec4<f32>(ink_depth(vec2<i32>(at.x - 1, near.y)), row, ink_depth(vec2<i32>(at.x + 2, near.y))),
    );
    let bend_y = outline_bend(
        vec4<f32>(ink_depth(vec2<i32>(near.x, at.y - 1)), column, ink_depth(vec2<i32>(near.x, at.y + 2))),
    );
    return before > 2.0 * (bend_x + bend_y);
}

// How much of the pixel around a point a line covers; 0 where it is hidden.
fn ink_coverage(
    ends_px: vec4<f32>, depths_slopes: vec4<f32>, direction: vec2<f32>, width_px: f32, traits: u32, point_px: vec2<f32>,
) -> f32 {
    let fraction = outline_nearest(ends_px, point_px);
    let on_line = mix(ends_px.xy, ends_px.zw, fraction);
    let coverage = outline_coverage(on_line, direction, point_px, width_px);
    let depth = mix(depths_slopes.x, depths_slopes.y, fraction);
    let per_px = depth * view.depth_per_px.x + view.depth_per_px.y;
    let corner = floor(on_line - 0.5);
    let needs_surface = (traits & OUTLINE_TRAIT_CUT_OUT) != 0u;
    var votes = vec2<bool>(false, !needs_surface);
    // Up to the first pixel that decides, which is the first of all along most lines.
    for (var tap = 0; tap < 4 && coverage > 0.0 && !all(votes); tap++) {
        let pixel = corner + vec2<f32>(f32(tap & 1), f32(tap >> 1u));
        let scene = ink_depth(vec2<i32>(pixel));
        let offset = outline_cross(direction, pixel + 0.5 - on_line);
        votes = votes | outline_vote(scene, depth, offset, depths_slopes.zw, per_px);
    }
    if coverage <= 0.0 || !all(votes) || outline_plane_hides(on_line, depth, per_px) {
        return 0.0;
    }
    return coverage;
}

fn ink_over(below: vec4<f32>, coverage: f32) -> vec4<f32> {
    let opacity = view.ink.a * coverage;
    return vec4<f32>(mix(below.rgb, view.ink.rgb, opacity), opacity + below.a * (1.0 - opacity));
}

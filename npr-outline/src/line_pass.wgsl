// Entry points of the line pass.

struct LineVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) ends_px: vec4<f32>,
    @location(1) @interpolate(flat) depths_slopes: vec4<f32>,
    @location(2) @interpolate(flat) direction: vec2<f32>,
    @location(3) @interpolate(flat) width_px: f32,
    @location(4) @interpolate(flat) traits: u32,
}

fn line_vertex(
    corner: u32, end0: vec3<f32>, end1: vec3<f32>, normal0: vec3<f32>, normal1: vec3<f32>, kind: u32, traits: u32,
) -> LineVertex {
    var out: LineVertex;
    out.position = vec4<f32>(2.0, 2.0, 0.0, 1.0);
    out.width_px = view.authored_px;
    if kind != OUTLINE_AUTHORED {
        out.width_px = view.width_px[kind];
    }
    out.traits = traits;
    if out.width_px <= 0.0 {
        return out;
    }
    let segment = outline_project(end0, end1, normal0, normal1, out.width_px, view);
    if !segment.visible {
        return out;
    }
    out.ends_px = segment.ends_px;
    out.depths_slopes = vec4<f32>(segment.depths, segment.slopes);
    // A rectangle around the line and its round ends, with a margin for partly covered pixels.
    let reach = 0.5 * out.width_px + 0.75;
    let along = outline_direction(segment.ends_px);
    out.direction = along;
    let across = vec2<f32>(-along.y, along.x);
    let at_end = (corner & 1u) != 0u;
    let side = select(-reach, reach, (corner & 2u) != 0u);
    let point_px = select(segment.ends_px.xy - along * reach, segment.ends_px.zw + along * reach, at_end) + across * side;
    let ndc = vec2<f32>(2.0, -2.0) * point_px / view.viewport_px + vec2<f32>(-1.0, 1.0);
    out.position = vec4<f32>(ndc, 0.0, 1.0);
    return out;
}

// A line from an uploaded record of its own, found by a scan on the CPU.
@vertex
fn vs_record(
    @builtin(vertex_index) corner: u32,
    @location(0) end0: vec3<f32>,
    @location(1) kind_traits: u32,
    @location(2) end1: vec3<f32>,
    @location(3) normal0: vec3<f32>,
    @location(4) normal1: vec3<f32>,
) -> LineVertex {
    return line_vertex(corner, end0, end1, normal0, normal1, kind_traits & 7u, kind_traits);
}

struct Inked {
    @location(0) color: vec4<f32>,
    // Coverage as depth: the depth test keeps the line with the greatest coverage, in any order.
    @builtin(frag_depth) coverage: f32,
}

@fragment
fn fs_ink(in: LineVertex) -> Inked {
    let coverage = ink_coverage(in.ends_px, in.depths_slopes, in.direction, in.width_px, in.traits, in.position.xy);
    if coverage <= 0.0 {
        discard;
    }
    let below = textureLoad(painted, vec2<i32>(in.position.xy), 0);
    return Inked(ink_over(below, coverage), coverage);
}

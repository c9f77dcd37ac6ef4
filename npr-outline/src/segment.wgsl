// Lines on the screen: edges clipped, projected, with a width in px, and hidden where their centreline is hidden. The
// twin of `segment.rs`. No bindings and no entry points.

struct OutlineView {
    clip_from_world: mat4x4<f32>,
    // Width and height of the picture in px.
    viewport_px: vec2<f32>,
    // Depth-buffer units of one px along the view: depth * x + y.
    depth_per_px: vec2<f32>,
    // Width in px by kind: silhouette, boundary, crease, material border.
    width_px: vec4<f32>,
    ink: vec4<f32>,
    // The eye relative to the planes' origin: a point with w = 1 or a direction with w = 0.
    local_eye: vec4<f32>,
    // Edges, those of them that are lines for every eye, and the number of edges in a row of workgroups.
    edge_count: u32,
    always_count: u32,
    row_stride: u32,
    // Width in px of the lines that the file draws.
    authored_px: f32,
    // Not 0 if an edge is a line only where one of its faces is shown.
    single_sided: u32,
}

struct OutlineSegment {
    ends_px: vec4<f32>,
    depths: vec2<f32>,
    slopes: vec2<f32>,
    visible: bool,
}

const OUTLINE_MAX_SLOPE: f32 = 8.0;
const OUTLINE_EDGE_ON_SLOPE: f32 = 1024.0;
const OUTLINE_DEPTH_SLACK_PX: f32 = 0.5;
const OUTLINE_PLANE_SLACK_PX: f32 = 0.01;
const OUTLINE_PLANE_SLACK_PER_SLOPE: f32 = 0.0078125;
// In an edge's traits: its faces are cut out by alpha.
const OUTLINE_TRAIT_CUT_OUT: u32 = 512u;

// The part of a segment in front of the near plane and within the widened viewport, as fractions; the first is above
// the second where nothing is left.
fn outline_clip(end0: vec4<f32>, end1: vec4<f32>, viewport_px: vec2<f32>, margin_px: f32) -> vec2<f32> {
    let guard = vec2<f32>(1.0) + 2.0 * margin_px / viewport_px;
    var in_a = array<f32, 5>(
        end0.w - end0.z,
        guard.x * end0.w - end0.x,
        guard.x * end0.w + end0.x,
        guard.y * end0.w - end0.y,
        guard.y * end0.w + end0.y,
    );
    var in_b = array<f32, 5>(
        end1.w - end1.z,
        guard.x * end1.w - end1.x,
        guard.x * end1.w + end1.x,
        guard.y * end1.w - end1.y,
        guard.y * end1.w + end1.y,
    );
    var part = vec2<f32>(0.0, 1.0);
    for (var i = 0; i < 5; i++) {
        if in_a[i] < 0.0 && in_b[i] < 0.0 {
            return vec2<f32>(1.0, 0.0);
        }
        if in_a[i] < 0.0 {
            part.x = max(part.x, in_a[i] / (in_a[i] - in_b[i]));
        }
        if in_b[i] < 0.0 {
            part.y = min(part.y, in_a[i] / (in_a[i] - in_b[i]));
        }
    }
    return part;
}

// A clip-space point on the screen: px, and depth.
fn outline_screen(clip: vec4<f32>, viewport_px: vec2<f32>) -> vec3<f32> {
    let ndc = clip.xyz / clip.w;
    return vec3<f32>(vec2<f32>(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y) * viewport_px, ndc.z);
}

fn outline_direction(ends_px: vec4<f32>) -> vec2<f32> {
    let span = ends_px.zw - ends_px.xy;
    let squared = dot(span, span);
    if squared > 0.0 {
        return span * inverseSqrt(squared);
    }
    return vec2<f32>(1.0, 0.0);
}

fn outline_cross(a: vec2<f32>, b: vec2<f32>) -> f32 {
    return a.x * b.y - a.y * b.x;
}

// (offset, slope) of a face beside the line.
fn outline_face_slope(inward: vec3<f32>, middle: vec4<f32>, segment: OutlineSegment, view: OutlineView) -> vec2<f32> {
    let step = view.clip_from_world * vec4<f32>(inward, 0.0);
    let moved = (step.xyz * middle.w - middle.xyz * step.w) / (middle.w * middle.w);
    let moved_px = vec2<f32>(0.5 * moved.x, -0.5 * moved.y) * view.viewport_px;
    let direction = outline_direction(segment.ends_px);
    let span = length(segment.ends_px.zw - segment.ends_px.xy);
    let along = dot(moved_px, direction);
    let across = outline_cross(direction, moved_px);
    var depth_along = 0.0;
    if span > 0.0 {
        depth_along = (segment.depths.y - segment.depths.x) / span;
    }
    if across == 0.0 {
        return vec2<f32>(0.0);
    }
    return vec2<f32>(across, (moved.z - along * depth_along) / abs(across));
}

fn outline_project(
    end0: vec3<f32>, end1: vec3<f32>, normal0: vec3<f32>, normal1: vec3<f32>, width_px: f32, view: OutlineView,
) -> OutlineSegment {
    var segment: OutlineSegment;
    var a = view.clip_from_world * vec4<f32>(end0, 1.0);
    var b = view.clip_from_world * vec4<f32>(end1, 1.0);
    let part = outline_clip(a, b, view.viewport_px, 0.5 * width_px + 2.0);
    let span = b - a;
    b = a + span * part.y;
    a = a + span * part.x;
    segment.visible = part.x <= part.y && a.w > 0.0 && b.w > 0.0;
    if !segment.visible {
        return segment;
    }
    let s0 = outline_screen(a, view.viewport_px);
    let s1 = outline_screen(b, view.viewport_px);
    segment.ends_px = vec4<f32>(s0.xy, s1.xy);
    segment.depths = vec2<f32>(s0.z, s1.z);
    let middle = 0.5 * (a + b);
    let edge = end1 - end0;
    let first = outline_face_slope(cross(normal0, edge), middle, segment, view);
    let second = outline_face_slope(cross(normal1, -edge), middle, segment, view);
    let edge_on = OUTLINE_EDGE_ON_SLOPE
        * (0.5 * (segment.depths.x + segment.depths.y) * view.depth_per_px.x + view.depth_per_px.y);
    // Faces that are edge-on, and slopes that are NaN, count as 0.
    let slope0 = select(0.0, first.y, first.y < edge_on);
    let slope1 = select(0.0, second.y, second.y < edge_on);
    segment.slopes = vec2<f32>(
        max(0.0, max(select(slope0, 0.0, first.x < 0.0), select(slope1, 0.0, second.x < 0.0))),
        max(0.0, max(select(0.0, slope0, first.x < 0.0), select(0.0, slope1, second.x < 0.0))),
    );
    return segment;
}

// The nearest point of the centreline, as a fraction of the way.
fn outline_nearest(ends_px: vec4<f32>, point_px: vec2<f32>) -> f32 {
    let span = ends_px.zw - ends_px.xy;
    let squared = dot(span, span);
    if squared > 0.0 {
        return clamp(dot(point_px - ends_px.xy, span) / squared, 0.0, 1.0);
    }
    return 0.0;
}

// The share of a unit square around the origin on the near side of a straight border.
fn outline_half_plane(distance: f32, normal: vec2<f32>) -> f32 {
    let a = max(abs(normal.x), abs(normal.y));
    let b = min(abs(normal.x), abs(normal.y));
    let from_border = abs(distance);
    let left = max(0.5 * (a + b) - from_border, 0.0);
    let corner = 1.0 - 0.5 * left * left / max(a * b, 1e-20);
    let near = select(corner, 0.5 + from_border / a, from_border <= 0.5 * (a - b));
    return select(near, 1.0 - near, distance < 0.0);
}

// The area of the pixel's square between the two borders of a line.
fn outline_band(distance: f32, normal: vec2<f32>, width_px: f32) -> f32 {
    let half_width = 0.5 * width_px;
    let covered = outline_half_plane(half_width - distance, normal) + outline_half_plane(half_width + distance, normal) - 1.0;
    return clamp(covered, 0.0, 1.0);
}

// Exact beside the line; past its ends never more than a longer line would cover.
fn outline_coverage_at(on_line: vec2<f32>, direction: vec2<f32>, point_px: vec2<f32>, width_px: f32) -> f32 {
    let to_point = point_px - on_line;
    let distance = length(to_point);
    let beside = outline_band(abs(outline_cross(direction, to_point)), vec2<f32>(-direction.y, direction.x), width_px);
    if abs(dot(to_point, direction)) <= 1e-3 * distance || distance <= 1e-3 {
        return beside;
    }
    return min(beside, clamp(0.5 * width_px + 0.5 - distance, 0.0, 1.0));
}

// How far in front of a line, in depth-buffer units, its own faces may be at a pixel.
fn outline_allowed(offset: f32, slopes: vec2<f32>, per_px: f32) -> f32 {
    let slope = min(select(slopes.x, slopes.y, offset < 0.0), OUTLINE_MAX_SLOPE * per_px);
    return OUTLINE_DEPTH_SLACK_PX * per_px + slope * abs(offset);
}

// The share of a line that see-through surfaces in front of it let through at a pixel.
fn outline_through(
    depths: vec4<f32>, alphas: vec4<f32>, depth: f32, offset: f32, slopes: vec2<f32>, per_px: f32,
) -> f32 {
    let limit = depth + outline_allowed(offset, slopes, per_px);
    let through = select(vec4<f32>(1.0), 1.0 - alphas, depths > vec4<f32>(limit));
    return through.x * through.y * through.z * through.w;
}

// For one of the four pixels around a point of the centreline: whether its surface is not in front of the line, and
// whether it may be one of the edge's own faces.
fn outline_vote(scene_depth: f32, depth: f32, offset: f32, slopes: vec2<f32>, per_px: f32) -> vec2<bool> {
    let behind = scene_depth - depth;
    return vec2<bool>(behind <= outline_allowed(offset, slopes, per_px), abs(behind) <= (OUTLINE_DEPTH_SLACK_PX + OUTLINE_MAX_SLOPE) * per_px);
}

// How far in front of a point of a line, `within` px from the first pixel's centre, the plane through four pixels is,
// less the tolerance for rounding and for the deviation of the four from a plane.
fn outline_plane_in_front(quad: vec4<f32>, within: vec2<f32>, depth: f32, per_px: f32) -> f32 {
    let along_x = 0.5 * (quad.y - quad.x + quad.w - quad.z);
    let along_y = 0.5 * (quad.z - quad.x + quad.w - quad.y);
    let there = 0.25 * (quad.x + quad.y + quad.z + quad.w) + along_x * (within.x - 0.5) + along_y * (within.y - 0.5);
    let twist = abs(quad.x - quad.y - quad.z + quad.w);
    return there - depth - OUTLINE_PLANE_SLACK_PX * per_px
        - OUTLINE_PLANE_SLACK_PER_SLOPE * (abs(along_x) + abs(along_y)) - twist;
}

// The greater of the two second differences of four consecutive depths.
fn outline_second_difference(depths: vec4<f32>) -> f32 {
    return max(abs(depths.x - 2.0 * depths.y + depths.z), abs(depths.y - 2.0 * depths.z + depths.w));
}

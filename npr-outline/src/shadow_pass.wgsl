// Counts shadow volumes in a stencil buffer.

struct ShadowView {
    clip_from_world: mat4x4<f32>,
    // The rows of the matrix that places the mesh in the world.
    world_from_mesh: array<vec4<f32>, 3>,
    // In the space of the mesh: a point with w = 1, or the direction to the light with w = 0.
    light: vec4<f32>,
    // The light relative to the origin of the planes.
    local_light: vec4<f32>,
}

@group(0) @binding(0) var<uniform> view: ShadowView;

// Vertices of one sweep of an edge: a triangle to the one point at infinity, or two.
override sweep_vertices: u32 = 6u;
// 1: faces towards the light, -1: faces away from it.
override cap_turn: i32 = 1;

// A position that draws nothing: all corners of a triangle are here.
const NOWHERE: vec4<f32> = vec4<f32>(0.0, 0.0, 0.0, 1.0);

// The same arithmetic as for the scene's faces, so that a cap lies exactly on its face.
fn placed(point: vec4<f32>) -> Placed {
    let rows = view.world_from_mesh;
    let world = vec3<f32>(dot(rows[0], point), dot(rows[1], point), dot(rows[2], point));
    return Placed(view.clip_from_world * vec4<f32>(world, point.w));
}

struct Placed {
    @invariant @builtin(position) position: vec4<f32>,
}

@vertex
fn vs_side(
    @builtin(vertex_index) index: u32, @location(0) first: vec3<f32>, @location(1) flags: u32,
    @location(2) second: vec3<f32>, @location(3) plane0: vec4<f32>, @location(4) plane1: vec4<f32>,
) -> Placed {
    let sweeps = outline_sweeps(flags, plane0, plane1, view.local_light);
    if u32(abs(sweeps)) <= index / sweep_vertices {
        return Placed(NOWHERE);
    }
    let start = select(second, first, sweeps > 0);
    let end = select(first, second, sweeps > 0);
    var corner = vec4<f32>(end, 1.0);
    switch index % sweep_vertices {
        case 1u: { corner = vec4<f32>(start, 1.0); }
        case 2u, 4u: { corner = outline_swept(start, view.light); }
        case 5u: { corner = outline_swept(end, view.light); }
        default: {}
    }
    return placed(corner);
}

@vertex
fn vs_cap(
    @builtin(vertex_index) index: u32, @location(0) a: vec3<f32>, @location(1) flags: u32,
    @location(2) b: vec3<f32>, @location(3) c: vec3<f32>, @location(4) plane: vec4<f32>,
) -> Placed {
    if outline_casting(plane, (flags & VOLUME_OPEN) != 0u, view.local_light) != cap_turn {
        return Placed(NOWHERE);
    }
    // The near cap as wound, the far cap with the opposite winding.
    var corner = a;
    switch index {
        case 1u, 5u: { corner = b; }
        case 2u, 4u: { corner = c; }
        default: {}
    }
    if index > 2u {
        return placed(outline_swept(corner, view.light));
    }
    return placed(vec4<f32>(corner, 1.0));
}

// A corner of a triangle made on the CPU: a position with w = 1, or with w = 0 the position that is swept to infinity.
@vertex
fn vs_placed(@location(0) corner: vec4<f32>) -> Placed {
    if corner.w == 0.0 {
        return placed(outline_swept(corner.xyz, view.light));
    }
    return placed(vec4<f32>(corner.xyz, 1.0));
}

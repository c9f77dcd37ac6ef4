// Finds the edges that are lines, writes their numbers to a compact list in no order, and counts them in the arguments
// of the indirect draw call. The same edges as those of `ContourEdges::scan`.

@group(0) @binding(0) var<uniform> view: OutlineView;
@group(1) @binding(0) var<storage, read> planes: array<vec4<f32>>;
@group(1) @binding(1) var<storage, read> edges: array<vec4<u32>>;
@group(1) @binding(2) var<storage, read_write> lines: array<u32>;

struct DrawArguments {
    vertex_count: u32,
    instance_count: atomic<u32>,
    first_vertex: u32,
    first_instance: u32,
}
@group(1) @binding(3) var<storage, read_write> arguments: DrawArguments;

var<workgroup> found: atomic<u32>;
var<workgroup> base: u32;

@compute @workgroup_size(64)
fn compact(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let edge = id.y * view.row_stride + id.x;
    var is_line = edge < view.always_count;
    if !is_line && edge < view.edge_count {
        let record = edges[edge];
        let plane1 = edge_second_plane(planes[record.w & EDGE_FACE], record.w);
        is_line = outline_is_silhouette(planes[record.z & EDGE_FACE], plane1, view.local_eye);
    }
    if is_line && view.single_sided != 0u {
        let record = edges[edge];
        is_line = edge_is_shown(record.z, outline_facing(planes[record.z & EDGE_FACE], view.local_eye))
            || edge_is_shown(record.w, outline_facing(planes[record.w & EDGE_FACE], view.local_eye));
    }
    // One atomic addition to the global counter for each workgroup instead of one for each line.
    var slot = 0u;
    if is_line {
        slot = atomicAdd(&found, 1u);
    }
    workgroupBarrier();
    if local == 0u {
        base = atomicAdd(&arguments.instance_count, atomicLoad(&found));
    }
    workgroupBarrier();
    if is_line {
        lines[base + slot] = edge;
    }
}

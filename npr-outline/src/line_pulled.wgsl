// The vertex shader for lines that the compute pass found: it reads an edge's record by the edge's number.

@group(2) @binding(0) var<storage, read> planes: array<vec4<f32>>;
@group(2) @binding(1) var<storage, read> edges: array<vec4<u32>>;
@group(2) @binding(2) var<storage, read> positions: array<f32>;

fn position_of(vertex: u32) -> vec3<f32> {
    return vec3<f32>(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

@vertex
fn vs_pulled(@builtin(vertex_index) corner: u32, @location(0) edge: u32) -> LineVertex {
    let record = edges[edge];
    let plane0 = planes[record.z & EDGE_FACE];
    let plane1 = edge_second_plane(planes[record.w & EDGE_FACE], record.w);
    let own = edge_own_kind(record);
    let kind = outline_kind(own, plane0, plane1, view.local_eye);
    var normal1 = plane1.xyz;
    if own == OUTLINE_BOUNDARY {
        normal1 = vec3<f32>(0.0);
    }
    let traits = select(0u, OUTLINE_TRAIT_CUT_OUT, (record.w & EDGE_CUT_OUT) != 0u);
    return line_vertex(corner, position_of(record.x), position_of(record.y), plane0.xyz, normal1, kind, traits);
}

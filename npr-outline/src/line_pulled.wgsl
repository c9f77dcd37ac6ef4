// The vertex shader for lines that the compute pass found: it reads an edge's record by the edge's number.

@group(2) @binding(0) var<storage, read> planes: array<vec4<f32>>;
// Two vertices, traits, unused.
@group(2) @binding(1) var<storage, read> edges: array<vec4<u32>>;
@group(2) @binding(2) var<storage, read> positions: array<f32>;

fn position_of(vertex: u32) -> vec3<f32> {
    return vec3<f32>(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

@vertex
fn vs_pulled(@builtin(vertex_index) corner: u32, @location(0) edge: u32) -> LineVertex {
    let record = edges[edge];
    let plane0 = planes[2u * edge];
    let plane1 = planes[2u * edge + 1u];
    let kind = outline_kind(record.z, plane0, plane1, view.local_eye);
    var normal1 = plane1.xyz;
    if (record.z & 3u) == OUTLINE_BOUNDARY {
        normal1 = vec3<f32>(0.0);
    }
    return line_vertex(corner, position_of(record.x), position_of(record.y), plane0.xyz, normal1, kind, record.z);
}

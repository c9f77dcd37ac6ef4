// An edge as `ContourEdge` has it: two vertices, and two faces with flags above their 28 bits.

const EDGE_FACE: u32 = 0x0fffffffu;
// The face is not shown to an eye behind it; the plane of the face is opposite to its winding.
const EDGE_SINGLE_SIDED: u32 = 0x10000000u;
const EDGE_TURNED: u32 = 0x20000000u;
const EDGE_SECOND_NEGATED: u32 = 0x40000000u;
const EDGE_CUT_OUT: u32 = 0x80000000u;

// The plane of the second face, from that face's own.
fn edge_second_plane(plane: vec4<f32>, packed_second: u32) -> vec4<f32> {
    return select(plane, -plane, (packed_second & EDGE_SECOND_NEGATED) != 0u);
}

// The kind of line that the edge is when it is not a silhouette. Only a line of the file has the kind of a boundary whose
// second plane is not negated.
fn edge_own_kind(record: vec4<u32>) -> u32 {
    let own = record.z >> 30u;
    let is_authored = own == OUTLINE_BOUNDARY && (record.w & EDGE_SECOND_NEGATED) == 0u;
    return select(own, OUTLINE_AUTHORED, is_authored);
}

// Whether a face is shown to an eye that is on this side of its plane. `packed_face`: the face with its flags.
fn edge_is_shown(packed_face: u32, facing: f32) -> bool {
    let in_front = select(facing >= 0.0, facing <= 0.0, (packed_face & EDGE_TURNED) != 0u);
    return (packed_face & EDGE_SINGLE_SIDED) == 0u || in_front;
}

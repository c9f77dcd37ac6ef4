// Pieces of faces that are lit as wholes. The counterpart of `normal.rs`.

// The barycentric coordinates of the centroid of the piece of a triangle that contains a point. A triangle has divisions^2
// pieces. A point outside the triangle belongs to a piece next to it.
fn toon_piece_centroid(weights: vec3<f32>, divisions: u32) -> vec3<f32> {
    let count = f32(divisions);
    // Each cell of a grid along the second and the third coordinate is an upright and an inverted piece; the last cell of
    // each row has only the upright one.
    let scaled = weights.yz * count;
    let column = clamp(floor(scaled.x), 0.0, count - 1.0);
    let row = clamp(floor(scaled.y), 0.0, count - 1.0 - column);
    let inverted = (scaled.x - column) + (scaled.y - row) > 1.0 && column + row < count - 1.0;
    let centroid = (vec2<f32>(column, row) + select(1.0 / 3.0, 2.0 / 3.0, inverted)) / count;
    return vec3<f32>(1.0 - centroid.x - centroid.y, centroid);
}

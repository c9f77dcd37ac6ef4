// Directions that no visible surface can have. The twin of `artist.rs`. No bindings and no entry points.

// One of the four, with z along the view.
fn ink_artist_vector(index: u32) -> vec3<f32> {
    return vec3<f32>(select(-0.5, 0.5, (index & 1u) != 0u), select(-0.5, 0.5, (index & 2u) != 0u), 0.70710678);
}

// The index that a vertex colour means.
fn ink_artist_index(color: vec3<f32>) -> u32 {
    return select(0u, 1u, color.x >= 0.5) | select(0u, 2u, color.y >= 0.5);
}

// The index that a texture's colour means: alpha the column of the palette, red the row.
fn ink_artist_texel(color: vec4<f32>) -> u32 {
    return select(0u, 1u, color.a >= 0.5) | select(0u, 2u, color.r >= 0.5);
}

// One of the four for a point, in view space: the eye at the origin looks down -z.
fn ink_artist_direction(index: u32, eye_to_point: vec3<f32>) -> vec3<f32> {
    let vector = ink_artist_vector(index);
    let ahead = vec3<f32>(vector.xy, -vector.z);
    let length2 = dot(eye_to_point, eye_to_point);
    if length2 <= 0.0 || eye_to_point.z >= 0.0 {
        return ahead;
    }
    // The half-angle quaternion of the shortest rotation from -z to the point: its real part is z.
    let to = eye_to_point * inverseSqrt(length2);
    let turn = normalize(vec3<f32>(to.y, -to.x, 1.0 - to.z));
    let axis = vec3<f32>(turn.xy, 0.0);
    let half = cross(axis, ahead) * 2.0;
    return ahead + half * turn.z + cross(axis, half);
}

// Whether a pixel of an alpha-tested material is drawn.
fn ink_alpha_kept(alpha: f32, reference: f32) -> bool {
    return alpha >= reference;
}

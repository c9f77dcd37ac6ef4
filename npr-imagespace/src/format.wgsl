// What holds for all formats of a G-buffer. The twin of `format.rs`. No bindings and no entry points.

// Whether an eye-space depth is one that a surface can have: positive, finite and a number. Decided on the bits, since
// a compiler may assume that there is no NaN.
fn ink_is_surface(depth: f32) -> bool {
    return bitcast<u32>(depth) - 1u < 0x7f7fffffu;
}

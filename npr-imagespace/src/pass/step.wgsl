// One step of dilation or erosion, from ink to ink.

@group(0) @binding(1) var ink: texture_2d<f32>;

// Which form: the numbers of `Step::form`.
const HARD: u32 = 0u;
const SOFT_CROSS: u32 = 1u;
const SOFT_DIAGONAL: u32 = 2u;
const SOFT_DIAGONAL_PRINTED: u32 = 3u;

override form: u32;
override eroding: bool;
// Which neighbours: those on the diagonals, those along the axes, the pixel itself.
override diagonal: bool;
override cross_taps: bool;
override threshold: f32;

fn ink_at(pixel: vec2<i32>, size: vec2<i32>, offset: vec2<i32>) -> f32 {
    let at = clamp(pixel + offset, vec2<i32>(0), size - 1);
    let found = textureLoad(ink, at, 0).x;
    // A hard cross or square needs no border value: a clamped tap is another pixel of the kernel.
    if form == HARD && cross_taps {
        return found;
    }
    return select(select(0.0, 1.0, eroding), found, all(at == pixel + offset));
}

fn diagonal_taps(pixel: vec2<i32>, size: vec2<i32>) -> vec4<f32> {
    return vec4<f32>(
        ink_at(pixel, size, vec2<i32>(1, 1)),
        ink_at(pixel, size, vec2<i32>(-1, 1)),
        ink_at(pixel, size, vec2<i32>(-1, -1)),
        ink_at(pixel, size, vec2<i32>(1, -1)),
    );
}

fn axis_taps(pixel: vec2<i32>, size: vec2<i32>) -> vec4<f32> {
    return vec4<f32>(
        ink_at(pixel, size, vec2<i32>(1, 0)),
        ink_at(pixel, size, vec2<i32>(0, 1)),
        ink_at(pixel, size, vec2<i32>(-1, 0)),
        ink_at(pixel, size, vec2<i32>(0, -1)),
    );
}

fn hard(pixel: vec2<i32>, size: vec2<i32>) -> f32 {
    var taps = vec4<f32>(select(0.0, 1.0, eroding));
    var centre = taps.x;
    if diagonal {
        taps = diagonal_taps(pixel, size);
    }
    if cross_taps {
        centre = textureLoad(ink, pixel, 0).x;
        let beside = axis_taps(pixel, size);
        if diagonal {
            taps = select(max(taps, beside), min(taps, beside), eroding);
        } else {
            taps = beside;
        }
    }
    if eroding {
        return min(centre, ink_erode4(taps));
    }
    return max(centre, ink_dilate4(taps));
}

@fragment
fn fs_step(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(position.xy);
    let size = vec2<i32>(textureDimensions(ink));
    if form == SOFT_CROSS {
        let centre = textureLoad(ink, pixel, 0).x;
        return ink_premultiplied(ink_dilate_soft_cross(centre, axis_taps(pixel, size)), how);
    }
    if form == SOFT_DIAGONAL {
        return ink_premultiplied(ink_dilate_soft_diagonal(diagonal_taps(pixel, size), threshold), how);
    }
    if form == SOFT_DIAGONAL_PRINTED {
        return ink_premultiplied(saturate(ink_dilate_soft_diagonal_printed(diagonal_taps(pixel, size), threshold)), how);
    }
    return ink_premultiplied(hard(pixel, size), how);
}

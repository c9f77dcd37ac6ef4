// The hard fused filter by strips of four columns, from the top down. Appended to the library.

struct Strips {
    // Where pixels have all taps: left, top, right, bottom in px, the latter two exclusive.
    inner: vec4<i32>,
    // Where there may be lines: left, top, width, height in px.
    area: vec4<u32>,
    line: vec4<f32>,
}

@group(0) @binding(0) var<uniform> what: InkFilter;
@group(0) @binding(1) var<uniform> strips: Strips;
@group(0) @binding(2) var texels: texture_2d<u32>;
@group(0) @binding(3) var picture: texture_storage_2d<rgba8unorm, write>;

// Known when the pipeline is made: a software rasteriser runs through what it branches around.
override narrow: bool;
override cross_taps: bool;
override asks_normals: bool;
override asks_bends: bool;
override asks_steps: bool;
override asks_regions: bool;
override rows: i32;

// A tap, as pairs are compared: background is all zeros.
struct Texel {
    normal: vec3<f32>,
    length2: f32,
    // Different where two texels are across whatever their depths, and directions.
    key: u32,
    depth: i32,
    // On differences of depth of which this one's is the largest.
    threshold: i32,
}

struct Row {
    t0: Texel,
    t1: Texel,
    t2: Texel,
    t3: Texel,
    t4: Texel,
    t5: Texel,
}

struct PairInk {
    upper: vec4<bool>,
    lower: vec4<bool>,
}

fn tap_at(pixel: vec2<i32>) -> InkTap {
    let words = textureLoad(texels, pixel, 0).xy;
    if narrow {
        return ink_narrow_tap(words.x);
    }
    return ink_wide_tap(words);
}

fn texel_at(pixel: vec2<i32>) -> Texel {
    let tap = tap_at(pixel);
    let surface = tap.region != 0u;
    var texel: Texel;
    texel.key = select(0u, 1u, surface);
    if asks_regions {
        texel.key = tap.region;
    }
    if asks_normals {
        texel.normal = select(vec3<f32>(0.0), tap.normal, surface);
        texel.length2 = dot(texel.normal, texel.normal);
        texel.key |= select(0u, 0x80000000u, surface && texel.length2 == 0.0);
    }
    if asks_bends || asks_steps {
        texel.depth = select(0, tap.depth, surface);
        let growth = ((u32(texel.depth) >> what.depth_shift) * what.depth_step) >> (16u - what.depth_shift);
        texel.threshold = i32(max(what.depth_slack, what.depth_base + growth));
    }
    return texel;
}

fn row_at(columns: array<i32, 6>, y: i32) -> Row {
    return Row(
        texel_at(vec2<i32>(columns[0], y)),
        texel_at(vec2<i32>(columns[1], y)),
        texel_at(vec2<i32>(columns[2], y)),
        texel_at(vec2<i32>(columns[3], y)),
        texel_at(vec2<i32>(columns[4], y)),
        texel_at(vec2<i32>(columns[5], y)),
    );
}

fn across(a: Texel, b: Texel) -> bool {
    var is = a.key != b.key;
    if asks_steps {
        is = is | (abs(a.depth - b.depth) > max(a.threshold, b.threshold));
    }
    if asks_normals {
        let cos = dot(a.normal, b.normal);
        is = is | (cos * abs(cos) < (a.length2 * b.length2) * what.normal_cos2);
    }
    return is;
}

fn bends(a: Texel, centre: Texel, b: Texel) -> bool {
    if !asks_bends {
        return false;
    }
    return abs(a.depth - centre.depth - (centre.depth - b.depth)) > max(max(a.threshold, b.threshold), centre.threshold);
}

// Pairs between two rows.
fn pairs(upper: Row, lower: Row) -> PairInk {
    if cross_taps {
        let down = vec4<bool>(
            across(upper.t1, lower.t1), across(upper.t2, lower.t2), across(upper.t3, lower.t3), across(upper.t4, lower.t4)
        );
        return PairInk(down, down);
    }
    let right = vec4<bool>(
        across(upper.t0, lower.t1), across(upper.t1, lower.t2), across(upper.t2, lower.t3), across(upper.t3, lower.t4)
    );
    let right4 = across(upper.t4, lower.t5);
    let left = vec4<bool>(
        across(upper.t1, lower.t0), across(upper.t2, lower.t1), across(upper.t3, lower.t2), across(upper.t4, lower.t3)
    );
    let left4 = across(upper.t5, lower.t4);
    return PairInk(
        left | vec4<bool>(right.yzw, right4),
        right | vec4<bool>(left.yzw, left4),
    );
}

fn centres(above: Row, middle: Row, below: Row) -> vec4<bool> {
    if cross_taps {
        let right = vec4<bool>(
            across(middle.t0, middle.t1), across(middle.t1, middle.t2), across(middle.t2, middle.t3),
            across(middle.t3, middle.t4)
        );
        let right4 = across(middle.t4, middle.t5);
        return right | vec4<bool>(right.yzw, right4) | vec4<bool>(
            bends(above.t1, middle.t1, below.t1) | bends(middle.t0, middle.t1, middle.t2),
            bends(above.t2, middle.t2, below.t2) | bends(middle.t1, middle.t2, middle.t3),
            bends(above.t3, middle.t3, below.t3) | bends(middle.t2, middle.t3, middle.t4),
            bends(above.t4, middle.t4, below.t4) | bends(middle.t3, middle.t4, middle.t5),
        );
    }
    return vec4<bool>(
        bends(above.t0, middle.t1, below.t2) | bends(above.t2, middle.t1, below.t0),
        bends(above.t1, middle.t2, below.t3) | bends(above.t3, middle.t2, below.t1),
        bends(above.t2, middle.t3, below.t4) | bends(above.t4, middle.t3, below.t2),
        bends(above.t3, middle.t4, below.t5) | bends(above.t5, middle.t4, below.t3),
    );
}

@compute @workgroup_size(8)
fn fused_strips(@builtin(global_invocation_id) id: vec3<u32>) {
    let x = strips.inner.x + 4 * i32(id.x);
    let top = strips.inner.y + rows * i32(id.y);
    let bottom = min(top + rows, strips.inner.w);
    let last = strips.inner.z;
    if x >= last {
        return;
    }
    let columns = array<i32, 6>(x - 1, x, min(x + 1, last), min(x + 2, last), min(x + 3, last), min(x + 4, last));
    let inside = vec4<i32>(x, x + 1, x + 2, x + 3) < vec4<i32>(last);
    var above = row_at(columns, top - 1);
    var middle = row_at(columns, top);
    var before = pairs(above, middle).lower;
    for (var y = top; y < bottom; y++) {
        let below = row_at(columns, y + 1);
        let after = pairs(middle, below);
        let ink = (before | after.upper | centres(above, middle, below)) & inside;
        if ink.x {
            textureStore(picture, vec2<i32>(x, y), strips.line);
        }
        if ink.y {
            textureStore(picture, vec2<i32>(x + 1, y), strips.line);
        }
        if ink.z {
            textureStore(picture, vec2<i32>(x + 2, y), strips.line);
        }
        if ink.w {
            textureStore(picture, vec2<i32>(x + 3, y), strips.line);
        }
        before = after.lower;
        above = middle;
        middle = below;
    }
}

fn tap_beside(pixel: vec2<i32>, tap: u32, reach: vec2<i32>) -> InkTap {
    if cross_taps {
        return tap_at(pixel + ink_tap_cross(tap, reach));
    }
    return tap_at(pixel + ink_tap_diagonal(tap, reach));
}

// The pixels on the picture's border: first and last row, first and last column.
@compute @workgroup_size(64)
fn fused_border(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(texels);
    let side = id.y;
    var pixel = vec2<u32>(id.x, select(0u, size.y - 1u, side == 1u));
    if side > 1u {
        pixel = vec2<u32>(select(0u, size.x - 1u, side == 3u), id.x);
    }
    let from_area = pixel - strips.area.xy;
    if any(pixel >= size) || any(pixel < strips.area.xy) || any(from_area >= strips.area.zw) {
        return;
    }
    let at = vec2<i32>(pixel);
    let reach = ink_reach(pixel, size);
    let centre = tap_at(at);
    let tap0 = tap_beside(at, 0u, reach);
    let tap1 = tap_beside(at, 1u, reach);
    let tap2 = tap_beside(at, 2u, reach);
    let tap3 = tap_beside(at, 3u, reach);
    if ink_fused_hard(what, centre, tap0, tap1, tap2, tap3) {
        textureStore(picture, at, strips.line);
    }
}

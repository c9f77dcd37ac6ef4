// The disc in passes: line pixels to bits, the nearest along rows, the nearest along columns, ink.
//
// The cost is that of loads, so that a texel holds several horizontally adjacent pixels: 32 line pixels as bits of one
// number, and the steps of 4 pixels in four channels.

struct Pass {
    // Of the taps, in px.
    step: i32,
    // Taps to each side; of words, in the pass along the rows.
    fan: i32,
    // The largest distance along a row, px.
    row_reach: i32,
    // 1: the nearest paper is searched for.
    inverted: u32,
    radius_px: f32,
    antialias: u32,
    padding0: u32,
    padding1: u32,
}

@group(0) @binding(1) var<uniform> what: Pass;
// Each entry point reads one of these.
@group(0) @binding(2) var ink: texture_2d<f32>;
@group(0) @binding(2) var words: texture_2d<u32>;
@group(0) @binding(2) var sites: texture_2d<u32>;

@fragment
fn fs_bits(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    let at = vec2<i32>(position.xy);
    let first = 32 * at.x;
    let count = min(i32(textureDimensions(ink).x) - first, 32);
    var word = 0u;
    for (var i = 0; i < count; i++) {
        // 128 of 255 and more is a line.
        let is_line = textureLoad(ink, vec2<i32>(first + i, at.y), 0).x > 0.5;
        word |= select(0u, 1u << u32(i), is_line != (what.inverted != 0u));
    }
    return vec4<u32>(word, 0u, 0u, 0u);
}

// The positions of the highest and of the lowest bit that is set, from the exponent of a float; -127 for 0.
fn highest(word: vec4<u32>) -> vec4<i32> {
    // The bit below the highest is cleared so that the conversion cannot round up to the next power of two.
    return vec4<i32>(bitcast<vec4<u32>>(vec4<f32>(word & ~(word >> vec4<u32>(1u)))) >> vec4<u32>(23u)) - 127;
}

fn lowest(word: vec4<u32>) -> vec4<i32> {
    return vec4<i32>(bitcast<vec4<u32>>(vec4<f32>(word & (~word + 1u))) >> vec4<u32>(23u)) - 127;
}

const FAR: i32 = 0x100000;

@fragment
fn fs_row(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    let at = vec2<i32>(position.xy);
    let own = at.x >> 3u;
    let width = i32(textureDimensions(words).x);
    // The nearest to either side in the words around, from the farthest inwards, so that the last one found is nearest.
    var left = -FAR;
    var right = FAR;
    for (var away = what.fan; away > 0; away--) {
        let before = own - away;
        let after = own + away;
        let found = vec2<u32>(
            select(0u, textureLoad(words, vec2<i32>(max(before, 0), at.y), 0).x, before >= 0),
            select(0u, textureLoad(words, vec2<i32>(min(after, width - 1), at.y), 0).x, after < width),
        );
        left = select(left, 32 * before + highest(found.xxxx).x, found.x != 0u);
        right = select(right, 32 * after + lowest(found.yyyy).x, found.y != 0u);
    }
    // The nearest in the pixel's own word.
    let word = vec4<u32>(textureLoad(words, vec2<i32>(own, at.y), 0).x);
    let position_in_word = vec4<u32>(u32(at.x & 7) * 4u) + vec4<u32>(0u, 1u, 2u, 3u);
    let upward = vec4<u32>(0xffffffffu) << position_in_word;
    let behind = word & upward;
    let before = word & (~upward | (vec4<u32>(1u) << position_in_word));
    let pixel = vec4<i32>(position_in_word);
    let start = 32 * own;
    let ahead = select(right - start - pixel, lowest(behind) - pixel, behind != vec4<u32>(0u));
    let back = select(pixel - (left - start), pixel - highest(before), before != vec4<u32>(0u));
    let along = min(ahead, back);
    // The vertical step is 0. The sign of the horizontal step does not change any distance.
    let packed = vec4<u32>(along + 0x8000) | vec4<u32>(0x80000000u);
    return select(packed, vec4<u32>(INK_FLOOD_NONE), along > vec4<i32>(what.row_reach));
}

@fragment
fn fs_column(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    let at = vec2<i32>(position.xy);
    let height = i32(textureDimensions(sites).y);
    var best = textureLoad(sites, at, 0);
    let known = vec4<i32>(best & vec4<u32>(0xffffu)) - 0x8000;
    let high = vec4<i32>(best >> vec4<u32>(16u)) - 0x8000;
    var nearest = select(vec4<u32>(known * known + high * high), vec4<u32>(0xffffffffu), best == vec4<u32>(0u));
    // In the order of `ink_flood_take` on the CPU, since the first of equals is kept.
    for (var tap = -what.fan; tap <= what.fan; tap++) {
        let offset = tap * what.step;
        let y = at.y + offset;
        let found = textureLoad(sites, vec2<i32>(at.x, clamp(y, 0, height - 1)), 0);
        let across = vec4<i32>(found & vec4<u32>(0xffffu)) - 0x8000;
        let along = vec4<i32>(found >> vec4<u32>(16u)) - (0x8000 - offset);
        let square = vec4<u32>(across * across + along * along);
        // Steps within a texture always fit 16 bits.
        let nearer = (square < nearest) & (found != vec4<u32>(INK_FLOOD_NONE)) & vec4<bool>(y >= 0 && y < height);
        nearest = select(nearest, square, nearer);
        best = select(best, found + (u32(offset) << 16u), nearer);
    }
    return best;
}

@fragment
fn fs_resolve(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<i32>(position.xy);
    let four = textureLoad(sites, vec2<i32>(at.x >> 2u, at.y), 0);
    let two = select(four.xy, four.zw, (at.x & 2) != 0);
    let site = select(two.x, two.y, (at.x & 1) != 0);
    let found = ink_flood_resolve(site, what.radius_px, what.antialias != 0u);
    // The complement of the 8-bit value, as on the CPU: where the ink would be 128 of 255, its complement is 127.
    let complement = (255.0 - floor(found * 255.0 + 0.5)) / 255.0;
    return ink_premultiplied(select(found, complement, what.inverted != 0u), how);
}

// The disc in passes: lines to bits, bits to the nearest along the row, along the columns, to ink.
//
// What a texel costs is to fetch it, so that one holds many pixels side by side: of lines 32 in a word, of the steps to
// the nearest 4 in four.

struct Pass {
    // Of the taps, in px.
    step: i32,
    // Taps to each side; of words, in the pass along the rows.
    fan: i32,
    // As far as a row's nearest is known, in px.
    row_reach: i32,
    // 1: what is not a line is sought.
    inverted: u32,
    radius_px: f32,
    antialias: u32,
    padding0: u32,
    padding1: u32,
}

@group(0) @binding(1) var<uniform> what: Pass;
// Each pass reads one of these.
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

// The places of the highest and of the lowest bits that are set, by the exponent of a float. Of 0 they are -127.
fn highest(word: vec4<u32>) -> vec4<i32> {
    // Without the next bit nothing rounds up to a higher one.
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
    // The nearest to either side in the words around: from the farthest on, so that the last one found counts.
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
    // And in its own.
    let word = vec4<u32>(textureLoad(words, vec2<i32>(own, at.y), 0).x);
    let place = vec4<u32>(u32(at.x & 7) * 4u) + vec4<u32>(0u, 1u, 2u, 3u);
    let upward = vec4<u32>(0xffffffffu) << place;
    let behind = word & upward;
    let before = word & (~upward | (vec4<u32>(1u) << place));
    let pixel = vec4<i32>(place);
    let start = 32 * own;
    let ahead = select(right - start - pixel, lowest(behind) - pixel, behind != vec4<u32>(0u));
    let back = select(pixel - (left - start), pixel - highest(before), before != vec4<u32>(0u));
    let along = min(ahead, back);
    // A step of 0 up or down; which side does not matter to any distance.
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
        // No step within a texture is one that a texel cannot hold.
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
    // The complement of what would be stored: half a line is 128 of 255, and so is the half that is left of it 127.
    let complement = (255.0 - floor(found * 255.0 + 0.5)) / 255.0;
    return ink_premultiplied(select(found, complement, what.inverted != 0u), how);
}

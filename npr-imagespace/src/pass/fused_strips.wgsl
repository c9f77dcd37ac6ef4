// The hard fused filter by strips of four columns, from the top down; and apart from it on the picture's border.
// Appended to the library and `fused_taps.wgsl`.
//
// A software rasteriser runs eight invocations as one vector, and both sides of what they branch at. A loop goes on
// until the last of them leaves it, and where it is left from its head the rest of its body is run once more for
// nobody: so loops are left at their ends. What a loop carries over is copied at each turn: so a turn is four rows.

struct Strips {
    // Where all taps are in the picture: left, top, right, bottom in px, the latter two exclusive.
    inner: vec4<i32>,
    // Where there may be lines: left, top, width, height in px.
    area: vec4<u32>,
    line: vec4<f32>,
}

@group(0) @binding(0) var<uniform> what: InkFilter;
@group(0) @binding(1) var<uniform> strips: Strips;
@group(0) @binding(3) var picture: texture_storage_2d<rgba8unorm, write>;
@group(0) @binding(4) var nearest: sampler;

override asks_normals: bool;
override asks_bends: bool;
override asks_steps: bool;
override asks_regions: bool;
override asks_shadows: bool;
// Of a strip; a multiple of 4.
override rows: i32;

// Of a strip; two more are read.
const COLUMNS: i32 = 4;

// Four texels beside each other. Of background all is zero, so that no comparison need ask for it.
struct Texels {
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>,
    length2: vec4<f32>,
    // Where two keys differ there is ink whatever else the texels hold: the region, if asked for, else whether it is a
    // surface; and whether that has no normal, if asked for.
    key: vec4<u32>,
    depth: vec4<i32>,
    // On differences of depth codes of which this one is the largest. It never falls as the code grows, so that of
    // several thresholds the largest is that of the largest code.
    threshold: vec4<i32>,
    // The state of shadow, if asked for.
    shadow: vec4<u32>,
}

// Six columns, four and two; of the last four two are never looked at, nor worked out.
struct Row {
    a: Texels,
    b: Texels,
}

struct TwoRows {
    upper: Row,
    lower: Row,
}

// Texels of four pixels around a corner, as a gather has them: w and z are the upper two, x and y the lower two.
struct Corner {
    words0: vec4<u32>,
    words1: vec4<u32>,
}

// Which of the first five pairs of two rows are across: from the first on, and from the second on; or ink of the pairs
// between two rows.
struct Across {
    upper: vec4<bool>,
    lower: vec4<bool>,
}

const NO_NORMAL: u32 = 0x80000000u;

fn texels_of(words0: vec4<u32>, words1: vec4<u32>) -> Texels {
    var region = (words0 >> vec4<u32>(24u)) | ((words1 >> vec4<u32>(16u)) << vec4<u32>(8u));
    var depth = words0 & vec4<u32>(0xffffffu);
    var u = words1 & vec4<u32>(255u);
    var v = (words1 >> vec4<u32>(8u)) & vec4<u32>(255u);
    var most = INK_OCT8_MOST;
    if narrow {
        region = (words0 >> vec4<u32>(14u)) & vec4<u32>(255u);
        depth = words0 & vec4<u32>(0x3fffu);
        u = (words0 >> vec4<u32>(22u)) & vec4<u32>(31u);
        v = words0 >> vec4<u32>(27u);
        most = INK_OCT5_MOST;
    }
    let shadow = region & vec4<u32>(what.shadow_bits);
    region &= vec4<u32>(what.region_mask);
    let surface = region != vec4<u32>(0u);
    var four: Texels;
    four.key = select(vec4<u32>(0u), vec4<u32>(1u), surface);
    if asks_regions {
        four.key = region;
    }
    if asks_shadows {
        four.shadow = select(vec4<u32>(0u), shadow, surface);
    }
    if asks_normals {
        // As `ink_oct_load` and `ink_oct_vector`, where z < 0: sign(x) (most - |y|) = x - sign(x) |z|.
        let flat_x = vec4<f32>(vec4<i32>(u)) - (most + 1.0);
        let flat_y = vec4<f32>(vec4<i32>(v)) - (most + 1.0);
        let z = most - abs(flat_x) - abs(flat_y);
        let below = min(z, vec4<f32>(0.0));
        let is_normal = surface & (u != vec4<u32>(0u));
        four.x = select(vec4<f32>(0.0), flat_x + select(below, -below, flat_x < vec4<f32>(0.0)), is_normal);
        four.y = select(vec4<f32>(0.0), flat_y + select(below, -below, flat_y < vec4<f32>(0.0)), is_normal);
        four.z = select(vec4<f32>(0.0), z, is_normal);
        four.length2 = four.x * four.x + four.y * four.y + four.z * four.z;
        four.key |= select(vec4<u32>(0u), vec4<u32>(NO_NORMAL), surface & (u == vec4<u32>(0u)));
    }
    if asks_bends || asks_steps {
        four.depth = select(vec4<i32>(0), vec4<i32>(depth), surface);
        four.threshold = ink_taps_depth_thresholds(what, four.depth);
    }
    return four;
}

// A gather costs about what a load does, and brings a word of four texels. A corner is half a pixel from where rounding
// could make it another.
fn corner_at(corner: vec2<i32>, per_px: vec2<f32>) -> Corner {
    let at = vec2<f32>(corner) * per_px;
    var words: Corner;
    words.words0 = textureGather(0, texels, nearest, at);
    if !narrow {
        words.words1 = textureGather(1, texels, nearest, at);
    }
    return words;
}

fn upper_of(left: Corner, right: Corner) -> Texels {
    return texels_of(vec4<u32>(left.words0.wz, right.words0.wz), vec4<u32>(left.words1.wz, right.words1.wz));
}

fn lower_of(left: Corner, right: Corner) -> Texels {
    return texels_of(vec4<u32>(left.words0.xy, right.words0.xy), vec4<u32>(left.words1.xy, right.words1.xy));
}

// The rows above and below the corner's y; the second column begins at its x.
fn rows_at(corner: vec2<i32>, per_px: vec2<f32>) -> TwoRows {
    let a = corner_at(corner, per_px);
    let b = corner_at(corner + vec2<i32>(2, 0), per_px);
    let c = corner_at(corner + vec2<i32>(4, 0), per_px);
    return TwoRows(Row(upper_of(a, b), upper_of(c, c)), Row(lower_of(a, b), lower_of(c, c)));
}

// The four texels from the second on.
fn shifted_four(a: Texels, b: Texels) -> Texels {
    return Texels(
        vec4<f32>(a.x.yzw, b.x.x),
        vec4<f32>(a.y.yzw, b.y.x),
        vec4<f32>(a.z.yzw, b.z.x),
        vec4<f32>(a.length2.yzw, b.length2.x),
        vec4<u32>(a.key.yzw, b.key.x),
        vec4<i32>(a.depth.yzw, b.depth.x),
        vec4<i32>(a.threshold.yzw, b.threshold.x),
        vec4<u32>(a.shadow.yzw, b.shadow.x),
    );
}

// The row from its second column on.
fn shifted(row: Row) -> Row {
    return Row(shifted_four(row.a, row.b), shifted_four(row.b, row.b));
}

fn four_across(a: Texels, b: Texels) -> vec4<bool> {
    var is = a.key != b.key;
    if asks_shadows {
        is = is | ink_shadows_differ(a.shadow, b.shadow, vec4<u32>(what.shadow_bits));
    }
    if asks_steps {
        is = is | (abs(a.depth - b.depth) > max(a.threshold, b.threshold));
    }
    if asks_normals {
        // cos |cos| for cos^2: negative where cos is. Both sides are 0 for no normal, as they are for background.
        let cos = a.x * b.x + a.y * b.y + a.z * b.z;
        is = is | (cos * abs(cos) < (a.length2 * b.length2) * what.normal_cos2);
    }
    return is;
}

// Whether depth bends at the second to fifth column of a row between others.
fn bends(a: Texels, centre: Texels, b: Texels) -> vec4<bool> {
    if !asks_bends {
        return vec4<bool>(false);
    }
    // Where one of the three is background and another not, there is ink already.
    let bend = abs(a.depth - centre.depth - (centre.depth - b.depth));
    return bend > max(max(a.threshold, b.threshold), centre.threshold);
}

fn across(p: Row, q: Row) -> Across {
    let a = four_across(p.a, q.a);
    let b = four_across(p.b, q.b);
    return Across(a, vec4<bool>(a.yzw, b.x));
}

// Ink of the pairs between two rows.
fn between(upper: Row, lower: Row) -> Across {
    if cross_taps {
        let down = across(upper, lower).lower;
        return Across(down, down);
    }
    let falling = across(upper, shifted(lower));
    let rising = across(shifted(upper), lower);
    return Across(falling.lower | rising.upper, falling.upper | rising.lower);
}

// Ink of the pairs in a row, and of bends at it.
fn within(above: Row, row: Row, below: Row) -> vec4<bool> {
    let middle = shifted(row);
    if cross_taps {
        let beside = across(row, middle);
        let upright = bends(shifted(above).a, middle.a, shifted(below).a);
        return beside.upper | beside.lower | upright | bends(row.a, middle.a, shifted(middle).a);
    }
    return bends(above.a, middle.a, shifted(shifted(below)).a) | bends(shifted(shifted(above)).a, middle.a, below.a);
}

// A row's ink as four bits.
fn ink_bits(ink: vec4<bool>) -> u32 {
    let bits = select(vec4<u32>(0u), vec4<u32>(1u, 2u, 4u, 8u), ink);
    return bits.x | bits.y | bits.z | bits.w;
}

@compute @workgroup_size(8)
fn fused_strips(@builtin(global_invocation_id) id: vec3<u32>) {
    let x = strips.inner.x + COLUMNS * i32(id.x);
    var y = strips.inner.y + rows * i32(id.y);
    let bottom = min(y + rows, strips.inner.w);
    if x >= strips.inner.z {
        return;
    }
    // Four bits a row.
    let columns = (15u >> u32(max(x + COLUMNS - strips.inner.z, 0))) * 0x1111u;
    let per_px = 1.0 / vec2<f32>(textureDimensions(texels));
    let first = rows_at(vec2<i32>(x, y), per_px);
    var above = first.upper;
    var row = first.lower;
    var ink = between(above, row).lower;
    loop {
        let two = rows_at(vec2<i32>(x, y + 2), per_px);
        let four = rows_at(vec2<i32>(x, y + 4), per_px);
        let ink1 = between(row, two.upper);
        let ink2 = between(two.upper, two.lower);
        let ink3 = between(two.lower, four.upper);
        let ink4 = between(four.upper, four.lower);
        var mask = ink_bits(ink | ink1.upper | within(above, row, two.upper));
        mask |= ink_bits(ink1.lower | ink2.upper | within(row, two.upper, two.lower)) << 4u;
        mask |= ink_bits(ink2.lower | ink3.upper | within(two.upper, two.lower, four.upper)) << 8u;
        mask |= ink_bits(ink3.lower | ink4.upper | within(two.lower, four.upper, four.lower)) << 12u;
        mask &= columns & (0xffffu >> u32(4 * max(y + 4 - bottom, 0)));
        // A store is dear, even where no invocation has one: one a turn, and as many turns as the fullest mask has bits.
        loop {
            if mask != 0u {
                let bit = i32(firstTrailingBit(mask));
                textureStore(picture, vec2<i32>(x + (bit & 3), y + (bit >> 2u)), strips.line);
            }
            mask &= mask - 1u;
            if mask == 0u {
                break;
            }
        }
        above = four.upper;
        row = four.lower;
        ink = ink4.lower;
        y += 4;
        if y >= bottom {
            break;
        }
    }
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

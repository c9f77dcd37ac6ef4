// Lines drawn by compute shaders, no triangles; appended to `line.wgsl` and `line_ink.wgsl`.

// Lines as a scan on the CPU sends them, `LineRecord`: ends with the kind and traits between them, two normals.
@group(2) @binding(0) var<storage, read> records: array<u32>;
// Per pixel the bits of the greatest coverage; 0 between frames. Positive floats are in the order of their bits.
@group(2) @binding(1) var<storage, read_write> greatest: array<atomic<u32>>;
// Pixels with ink, each once, and then their new colours as four bytes.
@group(2) @binding(2) var<storage, read_write> inked: array<vec2<u32>>;
@group(2) @binding(3) var<storage, read_write> inked_count: atomic<u32>;

@group(3) @binding(0) var picture: texture_storage_2d<rgba8unorm, write>;

// So many invocations share a line: each takes every eighth column (of a steep line: row).
const SHARERS: u32 = 8u;
const RECORD_WORDS: u32 = 13u;

fn record_vector(word: u32) -> vec3<f32> {
    return vec3<f32>(bitcast<f32>(records[word]), bitcast<f32>(records[word + 1u]), bitcast<f32>(records[word + 2u]));
}

fn ink_pixel(pixel: vec2<i32>, coverage: f32) {
    let at = u32(pixel.y) * u32(view.viewport_px.x) + u32(pixel.x);
    if atomicMax(&greatest[at], bitcast<u32>(coverage)) == 0u {
        inked[atomicAdd(&inked_count, 1u)].x = at;
    }
}

@compute @workgroup_size(64)
fn stroke(@builtin(global_invocation_id) id: vec3<u32>) {
    let invocation = id.y * view.row_stride + id.x;
    let line = invocation / SHARERS;
    if line >= view.edge_count {
        return;
    }
    let word = line * RECORD_WORDS;
    let traits = records[word + 3u];
    let width_px = view.width_px[traits & 3u];
    if width_px <= 0.0 {
        return;
    }
    let segment = outline_project(
        record_vector(word), record_vector(word + 4u), record_vector(word + 7u), record_vector(word + 10u), width_px, view,
    );
    if !segment.visible {
        return;
    }
    let direction = outline_direction(segment.ends_px);
    let depths_slopes = vec4<f32>(segment.depths, segment.slopes);
    // Columns along the longer axis, and in each the pixels that the line's two borders leave a share of.
    let steep = abs(direction.y) > abs(direction.x);
    let ends = select(segment.ends_px, segment.ends_px.yxwz, steep);
    let size = select(view.viewport_px, view.viewport_px.yx, steep);
    let reach = 0.5 * width_px + 0.5;
    let half_height = 0.5 * (width_px + abs(direction.x) + abs(direction.y)) / max(abs(direction.x), abs(direction.y));
    let span = ends.z - ends.x;
    let first = i32(max(ceil(min(ends.x, ends.z) - reach - 0.5), 0.0));
    let last = i32(min(floor(max(ends.x, ends.z) + reach + 0.5), size.x));
    for (var column = first + i32(invocation % SHARERS); column < last; column += i32(SHARERS)) {
        var fraction = 0.0;
        if span != 0.0 {
            fraction = clamp((f32(column) + 0.5 - ends.x) / span, 0.0, 1.0);
        }
        let middle = mix(ends.y, ends.w, fraction);
        let low = i32(max(ceil(middle - half_height - 0.5), 0.0));
        let high = i32(min(floor(middle + half_height + 0.5), size.y));
        for (var row = low; row < high; row++) {
            let pixel = select(vec2<i32>(column, row), vec2<i32>(row, column), steep);
            let coverage =
                ink_coverage(segment.ends_px, depths_slopes, direction, width_px, traits, vec2<f32>(pixel) + 0.5);
            if coverage > 0.0 {
                ink_pixel(pixel, coverage);
            }
        }
    }
}

// Each listed pixel's new colour, from what it shows.
@compute @workgroup_size(64)
fn mix_ink(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let width = u32(view.viewport_px.x);
    let count = atomicLoad(&inked_count);
    for (var i = id.x; i < count; i += 64u * groups.x) {
        let at = inked[i].x;
        let coverage = bitcast<f32>(atomicExchange(&greatest[at], 0u));
        let below = textureLoad(painted, vec2<u32>(at % width, at / width), 0);
        inked[i].y = pack4x8unorm(ink_over(below, coverage));
    }
}

// A texture can't be read and written by one dispatch.
@compute @workgroup_size(64)
fn lay_ink(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let width = u32(view.viewport_px.x);
    let count = atomicLoad(&inked_count);
    for (var i = id.x; i < count; i += 64u * groups.x) {
        let at = inked[i].x;
        textureStore(picture, vec2<u32>(at % width, at / width), unpack4x8unorm(inked[i].y));
    }
}

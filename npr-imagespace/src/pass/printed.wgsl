// The filters and the inker of 2002 over an RGBA8 target.

@group(0) @binding(1) var<uniform> what: InkPrinted;
@group(0) @binding(1) var<uniform> inker: InkInker;
@group(0) @binding(2) var texels: texture_2d<f32>;

// Constants of the pipeline, since software rasterisers execute both sides of branches.
override with_normal: bool;
override printed_background: bool;
override with_depth: bool;
// Whether each test's lines are tested by the alpha of the co-issued reading.
override co_issued: bool;
override alpha_less: u32;
override alpha_reference: u32;

fn normals_differ(centre: vec3<i32>, tap0: vec3<i32>, tap1: vec3<i32>, tap2: vec3<i32>, tap3: vec3<i32>) -> bool {
    if printed_background {
        return ink_normal_bytes_edge_printed(centre, tap0, tap1, tap2, tap3, what.normal_threshold);
    }
    return ink_normal_bytes_edge(centre, tap0, tap1, tap2, tap3, what.normal_threshold);
}

@fragment
fn fs_printed(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(position.xy);
    let reach = ink_reach(vec2<u32>(pixel), textureDimensions(texels), longest_px());
    let centre = ink_bytes(textureLoad(texels, pixel, 0));
    let tap0 = ink_bytes(textureLoad(texels, pixel + ink_tap(0u, steps(), reach), 0));
    let tap1 = ink_bytes(textureLoad(texels, pixel + ink_tap(1u, steps(), reach), 0));
    let tap2 = ink_bytes(textureLoad(texels, pixel + ink_tap(2u, steps(), reach), 0));
    let tap3 = ink_bytes(textureLoad(texels, pixel + ink_tap(3u, steps(), reach), 0));
    var differs = false;
    var jumps = false;
    if with_normal {
        differs = normals_differ(centre.xyz, tap0.xyz, tap1.xyz, tap2.xyz, tap3.xyz);
        if co_issued {
            let alpha = select(255u, 0u, normals_differ(centre.xyz, tap0.xyz, tap1.xyz, tap2.xyz, tap2.xyz));
            differs = ink_printed_co_issued(differs, alpha, alpha_less, alpha_reference);
        }
    }
    if with_depth {
        let depths = vec4<u32>(vec4<i32>(tap0.w, tap1.w, tap2.w, tap3.w));
        jumps = ink_depth_plain_codes(u32(centre.w), depths, what.depth_form, what.depth_threshold);
        if co_issued {
            let sum = f32(ink_depth_plain_measure(u32(centre.w), depths, what.depth_form));
            let alpha = u32(clamp(sum - what.depth_codes + 0.5, 0.0, 255.0));
            jumps = ink_printed_co_issued(jumps, alpha, alpha_less, alpha_reference);
        }
    }
    return ink_premultiplied(select(0.0, 1.0, differs || jumps), how);
}

@fragment
fn fs_inker(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(position.xy);
    let reach = ink_reach(vec2<u32>(pixel), textureDimensions(texels), longest_px());
    let tap0 = textureLoad(texels, pixel + ink_tap(0u, steps(), reach), 0);
    let tap1 = textureLoad(texels, pixel + ink_tap(1u, steps(), reach), 0);
    let tap2 = textureLoad(texels, pixel + ink_tap(2u, steps(), reach), 0);
    let tap3 = textureLoad(texels, pixel + ink_tap(3u, steps(), reach), 0);
    return ink_premultiplied(ink_printed_inker(inker, tap0, tap1, tap2, tap3), how);
}

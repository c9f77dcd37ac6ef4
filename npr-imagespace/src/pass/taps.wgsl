// The taps of a filter's pipeline, as constants, since software rasterisers execute both sides of branches: the steps to
// taps 0 and 1.
override step0_x: i32;
override step0_y: i32;
override step1_x: i32;
override step1_y: i32;

fn steps() -> vec4<i32> {
    return vec4<i32>(step0_x, step0_y, step1_x, step1_y);
}

fn longest_px() -> vec2<u32> {
    let steps = abs(steps());
    return vec2<u32>(max(steps.xy, steps.zw));
}

// Compositing ink of any size over a picture.

@group(0) @binding(1) var<uniform> scale: vec4<f32>;
@group(0) @binding(2) var ink: texture_2d<f32>;

// Whether ink and picture are of one size.
override same_size: bool;

@fragment
fn fs_composite(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    if same_size {
        return ink_premultiplied(textureLoad(ink, vec2<i32>(position.xy), 0).x, how);
    }
    let found = ink_resample_at(floor(position.xy), scale.xy);
    let most = vec2<i32>(textureDimensions(ink)) - 1;
    let low = clamp(vec2<i32>(found.xy), vec2<i32>(0), most);
    let high = clamp(vec2<i32>(found.xy) + 1, vec2<i32>(0), most);
    let taps = vec4<f32>(
        textureLoad(ink, low, 0).x,
        textureLoad(ink, vec2<i32>(high.x, low.y), 0).x,
        textureLoad(ink, vec2<i32>(low.x, high.y), 0).x,
        textureLoad(ink, high, 0).x,
    );
    return ink_premultiplied(ink_resample_mix(taps, found.zw), how);
}

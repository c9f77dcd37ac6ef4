// Compositing ink over a picture. The twin of `composite.rs`. No bindings and no entry points. Colours are
// display-referred.

struct InkComposite {
    // rgb, and opacity.
    line: vec4<f32>,
    // Of the INK_COMPOSITE_ forms.
    form: u32,
    // 1: alpha less than the reference passes; 0: greater.
    alpha_less: u32,
    // 0..255.
    alpha_reference: u32,
    padding: u32,
}

const INK_COMPOSITE_MULTIPLY: u32 = 0u;
const INK_COMPOSITE_ALPHA_TESTED: u32 = 1u;
const INK_COMPOSITE_OVER: u32 = 2u;

fn ink_multiply(color: vec3<f32>, ink: f32) -> vec3<f32> {
    return color * (1.0 - ink);
}

// Whether the edge image's pixel, as 8 bits of alpha, passes.
fn ink_alpha_passes(ink: f32, less: u32, reference: u32) -> bool {
    let alpha = 255u - u32(saturate(ink) * 255.0 + 0.5);
    return select(alpha > reference, alpha < reference, less != 0u);
}

fn ink_alpha_tested(color: vec3<f32>, ink: f32, less: u32, reference: u32) -> vec3<f32> {
    return select(color, ink_multiply(color, ink), ink_alpha_passes(ink, less, reference));
}

fn ink_over(color: vec3<f32>, ink: f32, line: vec3<f32>, opacity: f32) -> vec3<f32> {
    return color + (line - color) * (opacity * ink);
}

// The colour of a pixel after compositing.
fn ink_composite(color: vec3<f32>, ink: f32, how: InkComposite) -> vec3<f32> {
    if how.form == INK_COMPOSITE_MULTIPLY {
        return ink_multiply(color, ink);
    }
    if how.form == INK_COMPOSITE_ALPHA_TESTED {
        return ink_alpha_tested(color, ink, how.alpha_less, how.alpha_reference);
    }
    return ink_over(color, ink, how.line.rgb, how.line.a);
}

// The premultiplied colour with which a blend unit has the same result: the line's colour times its opacity, and the
// opacity.
// c' = rgb + (1 - a) c.
fn ink_premultiplied(ink: f32, how: InkComposite) -> vec4<f32> {
    if how.form == INK_COMPOSITE_OVER {
        return vec4<f32>(how.line.rgb, 1.0) * (how.line.a * ink);
    }
    let kept = how.form == INK_COMPOSITE_MULTIPLY || ink_alpha_passes(ink, how.alpha_less, how.alpha_reference);
    return vec4<f32>(0.0, 0.0, 0.0, select(0.0, ink, kept));
}

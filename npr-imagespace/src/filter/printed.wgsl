// The filters of 2002 on bytes. The twin of `printed.rs`. No bindings and no entry points.

struct InkPrinted {
    // cos * 255^2, rounded up.
    normal_threshold: i32,
    // In codes of 8 bits.
    depth_threshold: u32,
    // Of the INK_DEPTH_ forms.
    depth_form: u32,
    // The threshold of depth in codes, unrounded.
    depth_codes: f32,
}

// Whether a line of an edge image passes an alpha test where its alpha, 0..255, is that of the co-issued reading. `less`
// and `reference` are those of the test.
fn ink_printed_co_issued(is_line: bool, alpha: u32, less: u32, reference: u32) -> bool {
    return is_line && select(alpha > reference, alpha < reference, less != 0u);
}

// The inker on texels as loaded: ink 0..1 of a pixel from its four taps.
fn ink_printed_inker(inker: InkInker, tap0: vec4<f32>, tap1: vec4<f32>, tap2: vec4<f32>, tap3: vec4<f32>) -> f32 {
    return ink_inker(
        inker,
        ink_printed_decode(tap0).xyz,
        ink_printed_decode(tap1).xyz,
        ink_printed_decode(tap2).xyz,
        ink_printed_decode(tap3).xyz,
        vec4<f32>(tap0.w, tap1.w, tap2.w, tap3.w),
    );
}

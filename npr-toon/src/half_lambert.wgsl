// Half-Lambert lighting. The counterpart of `half_lambert.rs`.

// squared: 1 or 0.
fn toon_half_lambert(scale: f32, bias: f32, squared: u32, n_dot_l: f32) -> f32 {
    let scaled = saturate(scale * n_dot_l + bias);
    return scaled * select(1.0, scaled, squared != 0u);
}

//! Half floats: IEEE 754 binary16. In WGSL `pack2x16float` and `unpack2x16float` do the same.

/// The half float nearest to `value`, ties to even; too large becomes infinite, NaN stays NaN.
pub fn ink_half_encode(value: f32) -> u16 {
    let bits = value.to_bits();
    let sign = (bits >> 16 & 0x8000) as u16;
    let magnitude = bits & 0x7fff_ffff;
    if magnitude > 0x7f80_0000 {
        return sign | 0x7e00;
    }
    // From 65520 on, halfway between the largest half float and 2^16, values round to infinity.
    if magnitude >= 0x477f_f000 {
        return sign | 0x7c00;
    }
    if magnitude < 0x3880_0000 {
        // Below 2^-14 half floats are spaced by 2^-24, the spacing of f32 around 1/2: adding 1/2 rounds to them.
        let rounded = f32::from_bits(magnitude) + 0.5;
        return sign | (rounded.to_bits() - 0.5f32.to_bits()) as u16;
    }
    let to_even = 0x0fff + (magnitude >> 13 & 1);
    sign | ((magnitude + to_even - 0x3800_0000) >> 13) as u16
}

/// The value of a half float, exactly.
pub fn ink_half_decode(half: u16) -> f32 {
    let sign = u32::from(half & 0x8000) << 16;
    let magnitude = u32::from(half & 0x7fff);
    let value = match magnitude {
        0..0x0400 => magnitude as f32 * 2f32.powi(-24),
        0x7c00.. => f32::from_bits(0x7f80_0000 | (magnitude & 0x03ff) << 13),
        _ => f32::from_bits((magnitude << 13) + 0x3800_0000),
    };
    f32::from_bits(value.to_bits() | sign)
}

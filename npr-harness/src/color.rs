//! Display-referred colour and light: the sRGB transfer function (IEC 61966-2-1), and bytes.

use glam::{DVec3, DVec4};

/// Converts an sRGB-encoded value, 0..=1, to linear light.
pub(crate) fn decode_srgb(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Converts linear light, 0..=1, to an sRGB-encoded value.
pub fn encode_srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// [`encode_srgb`] of red, green and blue, each clamped to 0..=1 first.
pub(crate) fn encode_rgb(linear: DVec3) -> DVec3 {
    DVec3::from_array(linear.to_array().map(|c| encode_srgb(c.clamp(0.0, 1.0))))
}

/// The byte nearest to a value in 0..=1, as an 8-bit unorm target stores it.
pub fn to_byte(value: f64) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// Converts a pixel to bytes.
pub fn to_bytes(rgba: DVec4) -> [u8; 4] {
    rgba.to_array().map(to_byte)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_decoding_and_encoding() {
        for byte in 0..=255u8 {
            assert_eq!(to_byte(encode_srgb(decode_srgb(f64::from(byte) / 255.0))), byte);
        }
    }
}

//! Colours of files.

use glam::Vec3;

/// Linear values of display-referred ones, 0..=1.
pub(super) fn linear_from_srgb(encoded: Vec3) -> Vec3 {
    let channel = |c: f32| {
        let c = f64::from(c.max(0.0));
        (if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }) as f32
    };
    Vec3::new(channel(encoded.x), channel(encoded.y), channel(encoded.z))
}

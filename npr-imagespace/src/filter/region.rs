//! Borders of regions: the texture-region filter of the slides of SIGGRAPH 2002, on numbers.
//!
//! Ink where r ≠ rᵢ for any of the four neighbours i.
//!
//! What was wrong in print: the slides keep regions as colours and threshold |Σ (c − cᵢ)|, the *signed* differences of
//! the channels added up, so that two colours with the same sum, such as red and green, look alike
//! ([`ink_region_printed`]). And `c1`, on which the filter depends, is not defined; (0, −1/4, 1/4, 1) of `c9` in its
//! place would give a constant white. What the code needs is (1, 0, −1, 1).

use glam::DVec3;

/// The slides' threshold on the sum of differences.
pub const SUM_OS: f32 = 0.01;

/// Ink where regions differ: 1, or with `soft` the share of a full line that the taps across amount to.
pub fn ink_region(centre: u32, taps: [u32; 4], soft: bool, weight: f64) -> f64 {
    let across = taps.iter().filter(|&&tap| tap != centre).count();
    if soft { (weight * across as f64).min(1.0) } else { f64::from(u8::from(across > 0)) }
}

/// As printed, on colours: |Σ (c − cᵢ)| ≥ t for any i.
pub fn ink_region_printed(centre: DVec3, taps: [DVec3; 4], threshold: f64) -> f64 {
    f64::from(u8::from(taps.iter().any(|&tap| (centre - tap).element_sum().abs() >= threshold)))
}

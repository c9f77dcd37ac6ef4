//! Borders of regions: the texture-region filter of the slides of SIGGRAPH 2002, on numbers.
//!
//! Ink where r ≠ rᵢ for any of the four neighbours i.
//!
//! Errors in print: the slides keep regions as colours and threshold |Σ (c − cᵢ)|, the *signed* differences of
//! the channels added up, so that two colours with the same sum, such as red and green, do not differ
//! ([`ink_region_printed`]). And `c1`, on which the filter depends, is not defined; (0, −1/4, 1/4, 1) of `c9` in its
//! place would give a constant white. What the code needs is (1, 0, −1, 1).

use glam::DVec3;

/// The slides' threshold on the sum of differences.
pub const REGION_SUM_OUTLINING_SKETCH: f32 = 0.01;

/// Ink where region numbers differ: 1, or with `soft` the number of differing taps times `weight`, at most 1.
pub fn ink_region(centre: u32, taps: [u32; 4], soft: bool, weight: f64) -> f64 {
    let across = taps.iter().filter(|&&tap| tap != centre).count();
    if soft { (weight * across as f64).min(1.0) } else { f64::from(u8::from(across > 0)) }
}

/// As printed, on colours: |Σ (c − cᵢ)| ≥ t for any i.
pub fn ink_region_printed(centre: DVec3, taps: [DVec3; 4], threshold: f64) -> f64 {
    f64::from(u8::from(taps.iter().any(|&tap| (centre - tap).element_sum().abs() >= threshold)))
}

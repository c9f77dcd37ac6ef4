//! Discontinuities of normals: Card & Mitchell 2002, listing 9, and the slides of SIGGRAPH 2002.
//!
//! Ink where n · nᵢ < t for any of the four neighbours i. The two sources differ in the threshold,
//! [`NORMAL_COS_CARD_MITCHELL`] and [`NORMAL_COS_OUTLINING_SKETCH`]; neither normalises the normals that it reads.
//!
//! On bytes the comparison is one of integers ([`ink_normal_bytes_edge`]): Σ (2a − 255)(2b − 255) < t · 255².
//!
//! Background has a vector that is no normal. It differs from every normal and not from itself, whatever the dot
//! products are; the printed form has no such rule ([`crate::format::printed`]).

use crate::ImageSpaceError;
use crate::filter::ink_ramp;
use glam::DVec3;

/// The chapter's threshold, 31.8°.
pub const NORMAL_COS_CARD_MITCHELL: f32 = 0.85;
/// The slides' threshold, 36.9°.
pub const NORMAL_COS_OUTLINING_SKETCH: f32 = 0.80;

/// Ink where the cosine between the normal and that of any neighbour is below `cos`. Zero vectors are no normal.
///
/// 1 where n · nᵢ < t for any i. With a `softness` s > 0: clamp(weight · Σ clamp((t − n · nᵢ) / s + ½, 0, 1), 0, 1).
pub fn ink_normal(centre: DVec3, taps: [DVec3; 4], cos: f64, softness: f64, weight: f64) -> f64 {
    let across = taps.map(|tap| ink_normal_tap(centre, tap, cos, softness));
    if softness > 0.0 {
        return (weight * across.iter().sum::<f64>()).min(1.0);
    }
    across.into_iter().fold(0.0, f64::max)
}

/// How far one tap lies across a border of normals, 0..=1.
fn ink_normal_tap(centre: DVec3, tap: DVec3, cos: f64, softness: f64) -> f64 {
    match (centre == DVec3::ZERO, tap == DVec3::ZERO) {
        (true, true) => 0.0,
        (false, false) => ink_ramp(cos - centre.dot(tap), softness),
        _ => 1.0,
    }
}

/// The largest softness with which a flat face has no ink: 2 (1 − t), rounded down.
///
/// The transition of [`ink_normal`] covers the cosines t ± s / 2, and neighbours on a flat face have the cosine 1.
pub fn normal_softness_max(cos: f32) -> f32 {
    let most = 2.0 * (1.0 - cos);
    // Below ½ the difference is rounded.
    if f64::from(most) > 2.0 * (1.0 - f64::from(cos)) { most.next_down() } else { most }
}

/// Refuses a softness that gives flat faces ink by the test of normals.
pub(crate) fn check_normal_softness(cos: f32, softness: f32) -> Result<(), ImageSpaceError> {
    let most = normal_softness_max(cos);
    if softness > most { Err(ImageSpaceError::NormalSoftness { softness, cos, most }) } else { Ok(()) }
}

/// As printed, hard, without a rule for the background: 1 where n · nᵢ < t for any i.
pub fn ink_normal_printed(centre: DVec3, taps: [DVec3; 4], cos: f64) -> f64 {
    f64::from(u8::from(taps.iter().any(|&tap| centre.dot(tap) < cos)))
}

/// t · 255², rounded up: the threshold of [`ink_normal_bytes_edge`].
pub fn normal_bytes_threshold(cos: f32) -> i32 {
    (f64::from(cos) * 65025.0).ceil() as i32
}

/// Whether two normals of biased bytes differ. What [`crate::format::printed::CLEAR`] has in rgb is no normal.
fn ink_normal_bytes_differ(a: [u8; 3], b: [u8; 3], threshold: i32) -> bool {
    let (no_a, no_b) = (a == [0; 3], b == [0; 3]);
    if no_a || no_b {
        return no_a != no_b;
    }
    ink_normal_bytes_dot(a, b) < threshold
}

/// 255² n · m, exactly.
pub fn ink_normal_bytes_dot(a: [u8; 3], b: [u8; 3]) -> i32 {
    a.iter().zip(b).map(|(&a, b)| (2 * i32::from(a) - 255) * (2 * i32::from(b) - 255)).sum()
}

/// Whether the normal differs from that of any neighbour, on biased bytes.
pub fn ink_normal_bytes_edge(centre: [u8; 3], taps: [[u8; 3]; 4], threshold: i32) -> bool {
    taps.iter().any(|&tap| ink_normal_bytes_differ(centre, tap, threshold))
}

/// As printed, on bytes: cleared pixels are compared like any other.
pub fn ink_normal_bytes_edge_printed(centre: [u8; 3], taps: [[u8; 3]; 4], threshold: i32) -> bool {
    taps.iter().any(|&tap| ink_normal_bytes_dot(centre, tap) < threshold)
}

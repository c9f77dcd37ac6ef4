//! Discontinuities of depth: Card & Mitchell 2002, listing 10, the slides of SIGGRAPH 2002, and a test that a slanted
//! plane passes.
//!
//! # Plain tests
//!
//! On depth u that runs from 0 at near to 1 at far, with the neighbours in the order of
//! [`crate::picture::Taps::Diagonal`]:
//!
//! - sum ([`DepthPlain::Sum`]): Σ |u − uᵢ| ≥ t, with t = 0.02 in the chapter. Error in print: the
//!   instructions that accumulate (`r0 = r1 + r2`, `r0 = r1 + r3`, `r0 = r1 + r4`) overwrite one another, so that
//!   only |u − u₀| + |u − u₃| counts ([`DepthPlain::SumPrinted`]);
//! - any ([`DepthPlain::Any`]): |u − uᵢ| ≥ t for any i, with t = 0.01 in the slides.
//!
//! On a plane seen at a grazing angle depth changes by more than that from pixel to pixel, and all of it becomes ink.
//!
//! # The second difference of depth
//!
//! On the screen the reciprocal of a plane's depth is linear, so that its second difference across opposite
//! neighbours, b = 1/z₋ − 2/z + 1/z₊, is 0 however steep the plane is. Ink where |b| > t · max(1/z₋, 1/z, 1/z₊) for
//! either pair: the depth jumps by more than a share t of the distance of the nearer side. In a parallel view z
//! itself is linear, and ink is where
//! |z₋ − 2z + z₊| > t, in units of depth. The alternative, to predict the neighbours' depth from the plane
//! through the centre with its normal, needs more precise normals than a G-buffer has: at 1° grazing an error of ½° in
//! the normal changes the slope by half. On planes 0.5° to 10° grazing with spheres on them (`tests/plane.rs`, 320 ×
//! 240 px, all with t = 0.01), false line pixels on the plane: second differences none, in f32, 24 or 14 bits;
//! prediction none with normals of 2 × 16 bits, 300 to 5000 with 2 × 8; plain 29,000 to 42,000, nearly all of it. None
//! loses an outline. A crease between two planes is ink as well where the slope changes by more than t of the distance
//! in a pixel.
//!
//! A depth that is not valid for a surface ([`ink_is_surface`]) is background, which differs from every surface. The
//! plain tests compare numbers only, and NaN is never ink.

use crate::ImageSpaceError;
use crate::filter::ink_ramp;
use crate::format::ink_is_surface;

/// The chapter's threshold, of [`DepthPlain::Sum`].
pub const DEPTH_SUM_CARD_MITCHELL: f32 = 0.02;
/// The slides' threshold, of [`DepthPlain::Any`].
pub const DEPTH_ANY_OUTLINING_SKETCH: f32 = 0.01;
/// The default threshold of [`ink_depth_bend`]: a jump of 1 % of the distance.
pub const BEND: f32 = 0.01;
/// The largest softness with which a face that does not bend has no ink: the transition covers the differences
/// T (1 ± s / 2), and begins at 0 with s = 2.
pub const DEPTH_SOFTNESS_MAX: f32 = 2.0;

/// Refuses a softness that gives flat faces ink by a test of depth.
pub(crate) fn check_depth_softness(softness: f32) -> Result<(), ImageSpaceError> {
    let most = DEPTH_SOFTNESS_MAX;
    if softness > most { Err(ImageSpaceError::DepthSoftness { softness, most }) } else { Ok(()) }
}

/// How four differences of depth are combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DepthPlain {
    /// The sum of the four.
    Sum,
    /// The sum of the first and the last, as listing 10 computes it.
    SumPrinted,
    /// The largest.
    Any,
}

impl DepthPlain {
    /// The combination that is compared with the threshold.
    fn measure<T: Copy + PartialOrd + std::ops::Add<Output = T>>(self, differences: [T; 4]) -> T {
        let [a, b, c, d] = differences;
        let max = |a: T, b: T| if b > a { b } else { a };
        match self {
            Self::Sum => a + b + (c + d),
            Self::SumPrinted => a + d,
            Self::Any => max(max(a, b), max(c, d)),
        }
    }
}

/// The plain tests on depths 0..=1: ink where the measure reaches the threshold. With a `softness` the ramp is that
/// of [`ink_ramp`] around it.
pub fn ink_depth_plain(centre: f64, taps: [f64; 4], form: DepthPlain, threshold: f64, softness: f64) -> f64 {
    let measure = form.measure(taps.map(|tap| (centre - tap).abs()));
    if softness > 0.0 { ink_ramp(measure - threshold, softness) } else { f64::from(u8::from(measure >= threshold)) }
}

/// A threshold 0..=1 in codes of a format whose largest is `most`, rounded up, so that `measure ≥ threshold` gives the
/// same result on codes.
pub fn depth_code_threshold(threshold: f32, most: u32) -> u32 {
    (f64::from(threshold) * f64::from(most)).ceil() as u32
}

/// The plain tests on codes of at most 16 bits, in integers.
pub fn ink_depth_plain_codes(centre: u32, taps: [u32; 4], form: DepthPlain, threshold: u32) -> bool {
    ink_depth_plain_measure(centre, taps, form) >= threshold
}

/// What the plain tests compare with their threshold, on codes of at most 16 bits.
pub fn ink_depth_plain_measure(centre: u32, taps: [u32; 4], form: DepthPlain) -> u32 {
    form.measure(taps.map(|tap| centre.abs_diff(tap)))
}

/// The test of second differences, on eye-space depths: ink 0..=1.
///
/// `parallel` says that the view has no perspective. With a `softness` s > 0 the ramp of each pair is s times as wide
/// as its threshold, and each pair and each tap across the border of the background adds `weight`.
pub fn ink_depth_bend(centre: f32, taps: [f32; 4], step: f64, parallel: bool, softness: f64, weight: f64) -> f64 {
    let is_surface = ink_is_surface(centre);
    let outside = taps.map(|tap| ink_is_surface(tap) != is_surface);
    let pair = |a: f32, b: f32| {
        if !is_surface || !ink_is_surface(a) || !ink_is_surface(b) {
            return 0.0;
        }
        let [a, centre, b] = [a, centre, b].map(|z| if parallel { f64::from(z) } else { 1.0 / f64::from(z) });
        ink_depth_pair(a, centre, b, step, parallel, softness)
    };
    let pairs = [pair(taps[0], taps[2]), pair(taps[1], taps[3])];
    if softness > 0.0 {
        let across = outside.iter().filter(|&&outside| outside).count() as f64;
        return (weight * across).max(weight * (pairs[0] + pairs[1])).min(1.0);
    }
    if outside.contains(&true) { 1.0 } else { pairs[0].max(pairs[1]) }
}

/// Ink of one pair of opposite taps, all three of them surfaces, from v = 1/z, or z in a parallel view.
fn ink_depth_pair(a: f64, centre: f64, b: f64, step: f64, parallel: bool, softness: f64) -> f64 {
    let second_difference = (a - centre - (centre - b)).abs();
    let threshold = if parallel { step } else { step * a.max(centre).max(b) };
    ink_ramp(second_difference - threshold, softness * threshold)
}

/// First differences with a share of the distance as the threshold, and the rules of [`ink_depth_bend`] otherwise:
/// ink where |1/z − 1/zᵢ| > t · max(1/z, 1/zᵢ) for any i. For comparison.
pub fn ink_depth_step(centre: f32, taps: [f32; 4], step: f64) -> bool {
    taps.iter().any(|&tap| ink_depth_step_tap(centre, tap, step))
}

/// [`ink_depth_step`] for one tap.
fn ink_depth_step_tap(centre: f32, tap: f32, step: f64) -> bool {
    match (ink_is_surface(centre), ink_is_surface(tap)) {
        (true, true) => {
            let (a, b) = (1.0 / f64::from(centre), 1.0 / f64::from(tap));
            (a - b).abs() > step * a.max(b)
        }
        (a, b) => a != b,
    }
}

/// The soft form of [`ink_depth_step`]: the ramp of each tap is `softness` times as wide as its threshold, and each
/// tap adds `weight`.
pub fn ink_depth_step_soft(centre: f32, taps: [f32; 4], step: f64, softness: f64, weight: f64) -> f64 {
    let across = taps.map(|tap| ink_depth_step_soft_tap(centre, tap, step, softness));
    (weight * across.iter().sum::<f64>()).min(1.0)
}

/// [`ink_depth_step_soft`] for one tap, before it is weighted.
fn ink_depth_step_soft_tap(centre: f32, tap: f32, step: f64, softness: f64) -> f64 {
    match (ink_is_surface(centre), ink_is_surface(tap)) {
        (true, true) => {
            let (a, b) = (1.0 / f64::from(centre), 1.0 / f64::from(tap));
            let threshold = step * a.max(b);
            ink_ramp((a - b).abs() - threshold, softness * threshold)
        }
        (a, b) => f64::from(u8::from(a != b)),
    }
}

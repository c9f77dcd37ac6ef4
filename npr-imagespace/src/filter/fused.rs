//! The three filters at once over packed texels, decided on whole numbers: the same pixels on every machine.
//!
//! For a pixel c and its taps 0–3 (0 opposite 2, 1 opposite 3), each with a normal a of integers, a region r and a
//! depth code q that is linear on the screen ([`crate::format::texel`]), a tap i lies *across* a border if
//!
//! - one of the two is background and the other is not (if both are, it does not, whatever else they hold); or
//! - regions are asked for and r ≠ rᵢ; or
//! - shadows are asked for, one of the two is lit and the other in a cast shadow ([`crate::shadow`]); or
//! - normals are asked for and a · aᵢ < t |a| |aᵢ|, which is decided as a · aᵢ < 0 or (a · aᵢ)² < t² |a|² |aᵢ|²: dot
//!   products of whole numbers, exact in f32 however they are summed, and three products, each rounded to the nearest;
//!   or
//! - the plain depth test is asked for and |q − qᵢ| > T;
//!
//! and a pair (i, i + 2) *bends* if none of the three is background, the test for bends is asked for and
//! |qᵢ − 2q + qᵢ₊₂| > T. T = max(slack, base + step · q'), where q' is the largest of the codes compared, base makes it
//! proportional to 1/z where the code 0 is not at infinity, and the slack is what rounding can amount to
//! ([`crate::format::texel::TexelLayout::depth_slack`]). Ink where any tap lies across or any pair bends.
//!
//! The slides multiply the white of the three filters, which is the same where they are hard. Soft, a pixel on an edge
//! of both normals and depth would come out darker than on either; here the larger ink of a tap counts.
//!
//! What is not asked for costs nothing but a uniform branch. The WGSL does the same to four taps side by side and
//! branches on nothing else, which on a software rasteriser is worth a third of the arithmetic's time.

use crate::ImageSpaceError;
use crate::filter::depth::BEND;
use crate::filter::ink_ramp;
use crate::filter::normal::COS_OS;
use crate::format::texel::{DepthCode, Tap, TexelLayout};
use crate::picture::Taps;
use crate::shadow::ink_shadow_differs;
use bytemuck::{Pod, Zeroable};
use glam::IVec3;

/// What the fused filter looks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FusedFilter {
    /// The cosine below which two normals differ, 0..=1.
    pub normal_cos: Option<f32>,
    /// Jumps of depth.
    pub depth: Option<DepthTest>,
    /// Borders of regions.
    pub regions: bool,
    /// Borders of shadows.
    pub shadows: ShadowTest,
    /// Where it looks.
    pub taps: Taps,
    /// 0 for hard lines; else the width of the transition, in cosines for normals and as a share of its threshold for
    /// depth. Above 2 (1 − cos), flat surfaces are no longer paper.
    pub softness: f32,
}

/// How the fused filter looks for jumps of depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthTest {
    /// The smallest jump that is a line: a share of the nearer side's distance; in a parallel view, units of depth.
    pub step: f32,
    /// First differences in place of second ones: the plain test, under which slanted planes turn to ink.
    pub plain: bool,
}

/// What texels say of shadows, and what becomes of it: see [`crate::shadow`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ShadowTest {
    /// They say nothing: all bits of a region's number are its own.
    #[default]
    Absent,
    /// They do, and it is left to another pass.
    Ignored,
    /// The borders of shadows are lines like the others.
    Lines,
    /// They alone are lines, where none of the others is: for shadow lines of another colour or width.
    Alone,
}

impl Default for DepthTest {
    fn default() -> Self {
        Self { step: BEND, plain: false }
    }
}

impl Default for FusedFilter {
    /// All three, hard, with diagonal taps.
    fn default() -> Self {
        Self {
            normal_cos: Some(COS_OS),
            depth: Some(DepthTest::default()),
            regions: true,
            shadows: ShadowTest::Absent,
            taps: Taps::Diagonal,
            softness: 0.0,
        }
    }
}

/// In [`FilterUniform::asked`]: normals.
pub const ASKED_NORMAL: u32 = 1;
/// In [`FilterUniform::asked`]: bends of depth.
pub const ASKED_BEND: u32 = 2;
/// In [`FilterUniform::asked`]: plain steps of depth.
pub const ASKED_STEP: u32 = 4;
/// In [`FilterUniform::asked`]: regions.
pub const ASKED_REGION: u32 = 8;
/// In [`FilterUniform::asked`]: borders of shadows.
const ASKED_SHADOW: u32 = 16;
/// In [`FilterUniform::asked`]: borders of shadows, and of the others only where they are not.
const ASKED_ALONE: u32 = 32;

/// A [`FusedFilter`] in the integers of a layout: `InkFilter` of the WGSL, 48 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct FilterUniform {
    /// Of the `ASKED_` bits.
    pub asked: u32,
    /// t².
    pub normal_cos2: f32,
    /// The smallest threshold on depth codes.
    pub depth_slack: u32,
    /// The threshold's part that does not grow with the code.
    pub depth_base: u32,
    /// The threshold's growth with the code, · 2^16.
    pub depth_step: u32,
    /// Bits that the code loses before it is multiplied.
    pub depth_shift: u32,
    /// Ink of one tap across, where lines are soft.
    pub weight: f32,
    /// t.
    pub normal_cos: f32,
    /// In cosines; 0 for hard lines.
    pub softness: f32,
    /// The bits of a region that number it.
    pub region_mask: u32,
    /// The bits of a region that say whether it is in shadow; 0 for none.
    pub shadow_bits: u32,
    /// Unused, 0.
    pub padding: u32,
}

impl FilterUniform {
    /// Checks the filter and brings it into the integers of texels with this layout and this code of depth.
    ///
    /// # Errors
    /// If a threshold is out of its range.
    pub fn new(filter: &FusedFilter, layout: TexelLayout, code: &DepthCode) -> Result<Self, ImageSpaceError> {
        let cos = filter.normal_cos.unwrap_or(0.0);
        if !(0.0..=1.0).contains(&cos) {
            return Err(ImageSpaceError::NormalThreshold { cos });
        }
        let test = filter.depth.unwrap_or_default();
        let step = f64::from(test.step);
        if !(step >= 0.0 && step.is_finite()) {
            return Err(ImageSpaceError::DepthStep { step: test.step });
        }
        if !(filter.softness >= 0.0 && filter.softness.is_finite()) {
            return Err(ImageSpaceError::Softness { softness: filter.softness });
        }
        // Parallel: units of depth in codes. Else the code 0 lies at 1/z = -bias / scale.
        let (base, growth) = if code.parallel != 0 {
            (step * f64::from(code.scale.abs()), 0.0)
        } else {
            (-step * f64::from(code.bias), step)
        };
        let most = f64::from(layout.depth_most());
        let shadow_bits = if filter.shadows == ShadowTest::Absent { 0 } else { layout.shadow_bits() };
        let asked_depth = if test.plain { ASKED_STEP } else { ASKED_BEND };
        Ok(Self {
            asked: filter.normal_cos.map_or(0, |_| ASKED_NORMAL)
                | filter.depth.map_or(0, |_| asked_depth)
                | if filter.regions { ASKED_REGION } else { 0 }
                | match filter.shadows {
                    ShadowTest::Absent | ShadowTest::Ignored => 0,
                    ShadowTest::Lines => ASKED_SHADOW,
                    ShadowTest::Alone => ASKED_SHADOW | ASKED_ALONE,
                },
            normal_cos2: cos * cos,
            depth_slack: layout.depth_slack(),
            // No difference of three codes exceeds twice the largest.
            depth_base: base.clamp(0.0, 2.0 * most).ceil() as u32,
            depth_step: (growth.min(1.0) * 65536.0).round() as u32,
            depth_shift: if layout == TexelLayout::Narrow { 0 } else { 8 },
            weight: filter.taps.weight(),
            normal_cos: cos,
            softness: filter.softness,
            region_mask: !shadow_bits,
            shadow_bits,
            padding: 0,
        })
    }
}

fn dot(a: IVec3, b: IVec3) -> i32 {
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// Whether two normals differ; zero is no normal.
pub fn ink_tap_normal_differs(settings: &FilterUniform, a: IVec3, b: IVec3) -> bool {
    let (no_a, no_b) = (a == IVec3::ZERO, b == IVec3::ZERO);
    if no_a || no_b {
        return no_a != no_b;
    }
    // Whole numbers below 2^24, so far exact; then three products, each rounded once.
    let cos = dot(a, b) as f32;
    cos < 0.0 || cos * cos < (dot(a, a) as f32 * dot(b, b) as f32) * settings.normal_cos2
}

/// The threshold on differences of depth codes of which `nearest` is the largest.
pub fn ink_tap_depth_threshold(settings: &FilterUniform, nearest: i32) -> i32 {
    let growth = ((nearest as u32 >> settings.depth_shift) * settings.depth_step) >> (16 - settings.depth_shift);
    settings.depth_slack.max(settings.depth_base + growth) as i32
}

/// By how much the plain depth test is exceeded.
fn step_excess(settings: &FilterUniform, a: &Tap, b: &Tap) -> (i32, i32) {
    let threshold = ink_tap_depth_threshold(settings, a.depth.max(b.depth));
    ((a.depth - b.depth).abs() - threshold, threshold)
}

/// Whether a tap shows a surface. A state of shadow without a region does not make one.
fn is_surface(settings: &FilterUniform, tap: &Tap) -> bool {
    tap.region & settings.region_mask != 0
}

/// Whether a tap lies across a border of shadows.
pub fn ink_tap_shadow_differs(settings: &FilterUniform, centre: &Tap, tap: &Tap) -> bool {
    settings.asked & ASKED_SHADOW != 0
        && is_surface(settings, centre)
        && is_surface(settings, tap)
        && ink_shadow_differs(
            centre.region & settings.shadow_bits,
            tap.region & settings.shadow_bits,
            settings.shadow_bits,
        )
}

/// Whether regions are asked for and differ.
fn region_differs(settings: &FilterUniform, a: &Tap, b: &Tap) -> bool {
    settings.asked & ASKED_REGION != 0 && (a.region ^ b.region) & settings.region_mask != 0
}

/// Whether a tap lies across a border, but for those of shadows.
pub fn ink_tap_across(settings: &FilterUniform, centre: &Tap, tap: &Tap) -> bool {
    if !(is_surface(settings, centre) && is_surface(settings, tap)) {
        return is_surface(settings, centre) != is_surface(settings, tap);
    }
    region_differs(settings, centre, tap)
        || (settings.asked & ASKED_STEP != 0 && step_excess(settings, centre, tap).0 > 0)
        || (settings.asked & ASKED_NORMAL != 0 && ink_tap_normal_differs(settings, centre.normal, tap.normal))
}

/// By how much a pair's bend exceeds its threshold, and the threshold; none beside the background.
fn bend_excess(settings: &FilterUniform, a: &Tap, centre: &Tap, b: &Tap) -> Option<(i32, i32)> {
    if settings.asked & ASKED_BEND == 0 || ![a, centre, b].into_iter().all(|tap| is_surface(settings, tap)) {
        return None;
    }
    let threshold = ink_tap_depth_threshold(settings, a.depth.max(centre.depth).max(b.depth));
    Some(((a.depth - centre.depth - (centre.depth - b.depth)).abs() - threshold, threshold))
}

/// Whether the depth bends between opposite taps.
pub fn ink_tap_bends(settings: &FilterUniform, a: &Tap, centre: &Tap, b: &Tap) -> bool {
    bend_excess(settings, a, centre, b).is_some_and(|(excess, _)| excess > 0)
}

/// Whether a pixel is a line.
pub fn ink_fused_hard(settings: &FilterUniform, centre: &Tap, taps: &[Tap; 4]) -> bool {
    let others = taps.iter().any(|tap| ink_tap_across(settings, centre, tap))
        || ink_tap_bends(settings, &taps[0], centre, &taps[2])
        || ink_tap_bends(settings, &taps[1], centre, &taps[3]);
    let shadows = taps.iter().any(|tap| ink_tap_shadow_differs(settings, centre, tap));
    if settings.asked & ASKED_ALONE != 0 { shadows && !others } else { shadows || others }
}

/// The soft form of [`ink_tap_normal_differs`].
pub fn ink_tap_normal_soft(settings: &FilterUniform, a: IVec3, b: IVec3) -> f64 {
    let (no_a, no_b) = (a == IVec3::ZERO, b == IVec3::ZERO);
    if no_a || no_b {
        return f64::from(u8::from(no_a != no_b));
    }
    let cos = f64::from(dot(a, b)) / f64::from(dot(a, a) * dot(b, b)).sqrt();
    ink_ramp(f64::from(settings.normal_cos) - cos, f64::from(settings.softness))
}

/// The soft form of an excess over a threshold.
fn depth_soft(settings: &FilterUniform, (excess, threshold): (i32, i32)) -> f64 {
    ink_ramp(f64::from(excess), f64::from(settings.softness) * f64::from(threshold))
}

/// The soft form of [`ink_tap_across`].
fn ink_tap_soft(settings: &FilterUniform, centre: &Tap, tap: &Tap) -> f64 {
    if !(is_surface(settings, centre) && is_surface(settings, tap)) {
        return f64::from(u8::from(is_surface(settings, centre) != is_surface(settings, tap)));
    }
    if region_differs(settings, centre, tap) {
        return 1.0;
    }
    let mut ink = 0.0f64;
    if settings.asked & ASKED_STEP != 0 {
        ink = depth_soft(settings, step_excess(settings, centre, tap));
    }
    if settings.asked & ASKED_NORMAL != 0 {
        ink = ink.max(ink_tap_normal_soft(settings, centre.normal, tap.normal));
    }
    ink
}

/// Ink of a pixel, 0..=1: weight · max(Σ taps, Σ pairs), at most 1. A border of shadows is one of taps; asked for alone,
/// its taps' ink fades where there is ink of others.
pub fn ink_fused_soft(settings: &FilterUniform, centre: &Tap, taps: &[Tap; 4]) -> f64 {
    let weight = f64::from(settings.weight);
    let shadow = |tap: &Tap| f64::from(u8::from(ink_tap_shadow_differs(settings, centre, tap)));
    let alone = settings.asked & ASKED_ALONE != 0;
    let across = |tap: &Tap| {
        let ink = ink_tap_soft(settings, centre, tap);
        if alone { ink } else { ink.max(shadow(tap)) }
    };
    let across: f64 = taps.iter().map(across).sum();
    let bends: f64 = [(0, 2), (1, 3)]
        .into_iter()
        .filter_map(|(a, b)| bend_excess(settings, &taps[a], centre, &taps[b]))
        .map(|excess| depth_soft(settings, excess))
        .sum();
    let ink = (weight * across.max(bends)).min(1.0);
    if alone { (weight * taps.iter().map(shadow).sum::<f64>()).min(1.0) * (1.0 - ink) } else { ink }
}

/// Ink of a pixel, 0..=1, hard or soft as the filter says.
pub fn ink_fused(settings: &FilterUniform, centre: &Tap, taps: &[Tap; 4]) -> f64 {
    if settings.softness > 0.0 {
        return ink_fused_soft(settings, centre, taps);
    }
    f64::from(u8::from(ink_fused_hard(settings, centre, taps)))
}

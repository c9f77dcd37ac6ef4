//! The three filters in one pass over packed texels, decided with integers, so that every machine inks the same pixels.
//!
//! For a pixel c and its taps 0–3 (0 opposite 2, 1 opposite 3), each with a normal a of integers, a region r and a
//! depth code q that is linear on the screen ([`crate::format::texel`]), a tap i lies *across* a border if
//!
//! - exactly one of the two is background (two background pixels never differ); or
//! - the region test is enabled and r ≠ rᵢ; or
//! - the shadow test is enabled, one of the two is lit and the other in a cast shadow ([`crate::shadow`]); or
//! - the normal test is enabled and a · aᵢ < t |a| |aᵢ|, decided as a · aᵢ < 0 or (a · aᵢ)² < t² |a|² |aᵢ|²: the dot
//!   products of integers are exact in f32 in any order of summation, and the three products are each rounded once; or
//! - the plain depth test is enabled and |q − qᵢ| > T;
//!
//! and the depth of a pair (i, i + 2) *bends* if none of the three is background, the test of second differences is
//! enabled and
//! |qᵢ − 2q + qᵢ₊₂| > T. T = max(slack, base + step · q'), where q' is the largest of the codes compared, base makes it
//! proportional to 1/z where the code 0 is not at infinity, and the slack is the largest effect of rounding
//! ([`crate::format::texel::TexelLayout::depth_slack`]). There is ink where any tap lies across a border or any pair
//! bends.
//!
//! The slides multiply the white images of the three filters, which has the same result for hard lines. With soft lines
//! a pixel on an edge of both normals and depth would be darker than on either; here the larger ink of each tap is
//! used.
//!
//! A test that is not enabled costs a uniform branch. The WGSL processes the four taps as vectors without other
//! branches, which on a software rasteriser saves a third of the arithmetic's time.

use crate::ImageSpaceError;
use crate::filter::depth::{BEND, check_depth_softness};
use crate::filter::ink_ramp;
use crate::filter::normal::{NORMAL_COS_OUTLINING_SKETCH, check_normal_softness};
use crate::format::texel::{DepthCode, Tap, TexelLayout};
use crate::picture::Taps;
use crate::shadow::ink_shadow_differs;
use bytemuck::{Pod, Zeroable};
use glam::IVec3;

/// The tests of the fused filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FusedFilter {
    /// The cosine below which two normals differ, 0..=1. `None` for no test of normals.
    pub normal_cos: Option<f32>,
    /// The test for jumps of depth, if any.
    pub depth: Option<DepthTest>,
    /// Whether borders of regions are lines.
    pub regions: bool,
    /// Whether borders of shadows are lines.
    pub shadows: ShadowTest,
    /// The neighbours that are compared.
    pub taps: Taps,
    /// 0 for hard lines; else the width of the transition, in cosines for normals and as a share of its threshold for
    /// depth. At most [`normal_softness_max`](crate::filter::normal::normal_softness_max) of the cosine with a test of
    /// normals, and [`DEPTH_SOFTNESS_MAX`](crate::filter::depth::DEPTH_SOFTNESS_MAX) with one of depth: beyond, flat
    /// faces would have ink.
    pub softness: f32,
}

/// The depth test of the fused filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthTest {
    /// The smallest jump that is a line: a share of the nearer side's distance; in a parallel view, units of depth.
    pub step: f32,
    /// Whether first differences are used instead of second ones: the plain test, with which slanted planes become ink.
    pub plain: bool,
}

/// Whether texels have shadow states, and how their borders are used: see [`crate::shadow`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ShadowTest {
    /// Texels have no shadow states: all bits of a region are its number.
    #[default]
    NoStates,
    /// Texels have shadow states, which this filter ignores.
    Ignored,
    /// Borders of shadows are lines like all others.
    Lines,
    /// Only borders of shadows are lines, and only where no other test finds one: for a separate pass with shadow lines
    /// of another colour or width.
    OnlyShadows,
}

impl Default for DepthTest {
    fn default() -> Self {
        Self { step: BEND, plain: false }
    }
}

impl Default for FusedFilter {
    /// Tests of normals, depth and regions, hard lines, diagonal taps.
    fn default() -> Self {
        Self {
            normal_cos: Some(NORMAL_COS_OUTLINING_SKETCH),
            depth: Some(DepthTest::default()),
            regions: true,
            shadows: ShadowTest::NoStates,
            taps: Taps::Diagonal,
            softness: 0.0,
        }
    }
}

/// In [`FilterUniform::tests`]: the test of normals.
pub const TEST_NORMAL: u32 = 1;
/// In [`FilterUniform::tests`]: second differences of depth.
pub const TEST_BEND: u32 = 2;
/// In [`FilterUniform::tests`]: first differences of depth.
pub const TEST_STEP: u32 = 4;
/// In [`FilterUniform::tests`]: borders of regions.
pub const TEST_REGION: u32 = 8;
/// In [`FilterUniform::tests`]: borders of shadows.
const TEST_SHADOW: u32 = 16;
/// In [`FilterUniform::tests`]: only borders of shadows, where no other test finds a line.
const TEST_ALONE: u32 = 32;

/// A [`FusedFilter`] in the integers of a layout: `InkFilter` of the WGSL, 48 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct FilterUniform {
    /// The enabled tests: a sum of `TEST_` bits.
    pub tests: u32,
    /// The square of the normal threshold, a cosine.
    pub normal_cos2: f32,
    /// The smallest threshold on depth codes.
    pub depth_slack: u32,
    /// The constant part of the threshold on depth codes.
    pub depth_base: u32,
    /// The growth of the threshold with the depth code, times 2^16.
    pub depth_step: u32,
    /// Bits by which a depth code is shifted right before the multiplication, so that it fits in 32 bits.
    pub depth_shift: u32,
    /// Ink of one tap across, where lines are soft.
    pub weight: f32,
    /// The normal threshold, a cosine.
    pub normal_cos: f32,
    /// As [`FusedFilter::softness`]; 0 for hard lines.
    pub softness: f32,
    /// The bits of a region that are its number.
    pub region_mask: u32,
    /// The bits of a region that are its shadow state; 0 for none.
    pub shadow_bits: u32,
    /// Unused, 0.
    pub padding: u32,
}

impl FilterUniform {
    /// Checks the filter and brings it into the integers of texels with this layout and this code of depth.
    ///
    /// # Errors
    /// If a threshold is out of its range, or the softness gives flat faces ink; [`ImageSpaceError::TapStep`].
    pub fn new(filter: &FusedFilter, layout: TexelLayout, code: &DepthCode) -> Result<Self, ImageSpaceError> {
        filter.taps.validate()?;
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
        if let Some(cos) = filter.normal_cos {
            check_normal_softness(cos, filter.softness)?;
        }
        if filter.depth.is_some() {
            check_depth_softness(filter.softness)?;
        }
        // Parallel: units of depth in codes. Else the code 0 lies at 1/z = -bias / scale.
        let (base, growth) = if code.parallel != 0 {
            (step * f64::from(code.scale.abs()), 0.0)
        } else {
            (-step * f64::from(code.bias), step)
        };
        let most = f64::from(layout.depth_max());
        let shadow_bits = if filter.shadows == ShadowTest::NoStates { 0 } else { layout.shadow_bits() };
        let depth_test = if test.plain { TEST_STEP } else { TEST_BEND };
        Ok(Self {
            tests: filter.normal_cos.map_or(0, |_| TEST_NORMAL)
                | filter.depth.map_or(0, |_| depth_test)
                | if filter.regions { TEST_REGION } else { 0 }
                | match filter.shadows {
                    ShadowTest::NoStates | ShadowTest::Ignored => 0,
                    ShadowTest::Lines => TEST_SHADOW,
                    ShadowTest::OnlyShadows => TEST_SHADOW | TEST_ALONE,
                },
            normal_cos2: cos * cos,
            depth_slack: layout.depth_slack(),
            // No difference of three codes exceeds twice the largest.
            depth_base: base.clamp(0.0, 2.0 * most).ceil() as u32,
            depth_step: (growth.min(1.0) * 65536.0).round() as u32,
            depth_shift: if layout == TexelLayout::Bits32 { 0 } else { 8 },
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

/// Whether two normals differ by more than the threshold; a zero vector is no normal and differs from every normal.
pub fn ink_tap_normal_differs(settings: &FilterUniform, a: IVec3, b: IVec3) -> bool {
    let (no_a, no_b) = (a == IVec3::ZERO, b == IVec3::ZERO);
    if no_a || no_b {
        return no_a != no_b;
    }
    // The dot products are integers below 2^24 and exact in f32; the three products after them are each rounded once.
    let cos = dot(a, b) as f32;
    cos < 0.0 || cos * cos < (dot(a, a) as f32 * dot(b, b) as f32) * settings.normal_cos2
}

/// The threshold on differences of depth codes of which `nearest` is the largest.
pub fn ink_tap_depth_threshold(settings: &FilterUniform, nearest: i32) -> i32 {
    let growth = ((nearest as u32 >> settings.depth_shift) * settings.depth_step) >> (16 - settings.depth_shift);
    settings.depth_slack.max(settings.depth_base + growth) as i32
}

/// By how much a first difference of depth exceeds its threshold, and the threshold, in codes.
fn step_excess(settings: &FilterUniform, a: &Tap, b: &Tap) -> (i32, i32) {
    let threshold = ink_tap_depth_threshold(settings, a.depth.max(b.depth));
    ((a.depth - b.depth).abs() - threshold, threshold)
}

/// Whether a tap shows a surface: whether its region number is not 0, whatever its shadow state.
fn is_surface(settings: &FilterUniform, tap: &Tap) -> bool {
    tap.region & settings.region_mask != 0
}

/// Whether a border of shadows lies between the centre and a tap. Background has no border of shadows, for want of a state,
/// unless it catches shadows ([`crate::shadow::ink_shadow_background`]).
pub fn ink_tap_shadow_differs(settings: &FilterUniform, centre: &Tap, tap: &Tap) -> bool {
    settings.tests & TEST_SHADOW != 0
        && ink_shadow_differs(
            centre.region & settings.shadow_bits,
            tap.region & settings.shadow_bits,
            settings.shadow_bits,
        )
}

/// Whether the region test is enabled and the regions differ.
fn region_differs(settings: &FilterUniform, a: &Tap, b: &Tap) -> bool {
    settings.tests & TEST_REGION != 0 && (a.region ^ b.region) & settings.region_mask != 0
}

/// Whether a border of background, regions, normals or plain depth lies between the centre and a tap.
pub fn ink_tap_across(settings: &FilterUniform, centre: &Tap, tap: &Tap) -> bool {
    if !(is_surface(settings, centre) && is_surface(settings, tap)) {
        return is_surface(settings, centre) != is_surface(settings, tap);
    }
    region_differs(settings, centre, tap)
        || (settings.tests & TEST_STEP != 0 && step_excess(settings, centre, tap).0 > 0)
        || (settings.tests & TEST_NORMAL != 0 && ink_tap_normal_differs(settings, centre.normal, tap.normal))
}

/// By how much a second difference of depth exceeds its threshold, and the threshold, in codes; `None` where the test
/// is not enabled or one of the three is background.
fn bend_excess(settings: &FilterUniform, a: &Tap, centre: &Tap, b: &Tap) -> Option<(i32, i32)> {
    if settings.tests & TEST_BEND == 0 || ![a, centre, b].into_iter().all(|tap| is_surface(settings, tap)) {
        return None;
    }
    let threshold = ink_tap_depth_threshold(settings, a.depth.max(centre.depth).max(b.depth));
    Some(((a.depth - centre.depth - (centre.depth - b.depth)).abs() - threshold, threshold))
}

/// Whether the second difference of depth over opposite taps exceeds its threshold.
pub fn ink_tap_bends(settings: &FilterUniform, a: &Tap, centre: &Tap, b: &Tap) -> bool {
    bend_excess(settings, a, centre, b).is_some_and(|(excess, _)| excess > 0)
}

/// Whether a pixel is a line.
pub fn ink_fused_hard(settings: &FilterUniform, centre: &Tap, taps: &[Tap; 4]) -> bool {
    let others = taps.iter().any(|tap| ink_tap_across(settings, centre, tap))
        || ink_tap_bends(settings, &taps[0], centre, &taps[2])
        || ink_tap_bends(settings, &taps[1], centre, &taps[3]);
    let shadows = taps.iter().any(|tap| ink_tap_shadow_differs(settings, centre, tap));
    if settings.tests & TEST_ALONE != 0 { shadows && !others } else { shadows || others }
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

/// The soft form of an excess over a threshold. The transition begins no lower than the effect of rounding, which is
/// all that a plane has; a threshold that is the effect of rounding is hard.
fn depth_soft(settings: &FilterUniform, (excess, threshold): (i32, i32)) -> f64 {
    let widest = 2 * (threshold - settings.depth_slack as i32);
    ink_ramp(f64::from(excess), (f64::from(settings.softness) * f64::from(threshold)).min(f64::from(widest)))
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
    if settings.tests & TEST_STEP != 0 {
        ink = depth_soft(settings, step_excess(settings, centre, tap));
    }
    if settings.tests & TEST_NORMAL != 0 {
        ink = ink.max(ink_tap_normal_soft(settings, centre.normal, tap.normal));
    }
    ink
}

/// Ink of a pixel, 0..=1: weight · max(Σ taps, Σ pairs), at most 1. Borders of shadows are among the taps; where only
/// they are lines, their ink is reduced by that of the other tests.
pub fn ink_fused_soft(settings: &FilterUniform, centre: &Tap, taps: &[Tap; 4]) -> f64 {
    let weight = f64::from(settings.weight);
    let shadow = |tap: &Tap| f64::from(u8::from(ink_tap_shadow_differs(settings, centre, tap)));
    let alone = settings.tests & TEST_ALONE != 0;
    let across = |tap: &Tap| {
        let ink = ink_tap_soft(settings, centre, tap);
        if alone { ink } else { ink.max(shadow(tap)) }
    };
    let across: f64 = taps.iter().map(across).sum();
    let pairs: f64 = [(0, 2), (1, 3)]
        .into_iter()
        .filter_map(|(a, b)| bend_excess(settings, &taps[a], centre, &taps[b]))
        .map(|excess| depth_soft(settings, excess))
        .sum();
    let ink = (weight * across.max(pairs)).min(1.0);
    if alone { (weight * taps.iter().map(shadow).sum::<f64>()).min(1.0) * (1.0 - ink) } else { ink }
}

/// Ink of a pixel, 0..=1, hard or soft as the filter says.
pub fn ink_fused(settings: &FilterUniform, centre: &Tap, taps: &[Tap; 4]) -> f64 {
    if settings.softness > 0.0 {
        return ink_fused_soft(settings, centre, taps);
    }
    f64::from(u8::from(ink_fused_hard(settings, centre, taps)))
}

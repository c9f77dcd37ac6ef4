//! The filters over a G-buffer with normals, depth and regions in separate textures, any of which may be missing.
//!
//! The enabled tests are [`ink_normal`], by one of the tests of [`crate::filter::depth`] and by
//! [`ink_region`]; the result is the largest ink of the three. Decisions are made on floats.
//!
//! # Depth buffers
//!
//! A depth buffer holds a number d. The quantity that is linear on the screen, 1/z of the eye-space depth z in a
//! perspective view and z itself in a parallel one, is v = d · scale + bias. With n and f the nearest and farthest
//! depths:
//!
//! | projection | d at n, f | scale | bias | |
//! | --- | --- | --- | --- | --- |
//! | Direct3D, Vulkan, wgpu; OpenGL with its usual `glDepthRange` | 0, 1 | 1/f − 1/n | 1/n | [`DepthSource::perspective`] |
//! | the same reversed | 1, 0 | 1/n − 1/f | 1/f | [`DepthSource::reversed`] |
//! | reversed, f infinite | 1, 0 | 1/n | 0 | [`DepthSource::reversed`] |
//! | parallel | 0, 1 | f − n | n | [`DepthSource::parallel`] |
//! | parallel, reversed | 1, 0 | n − f | f | [`DepthSource::parallel_reversed`] |
//!
//! Where d runs from −1 to 1, as OpenGL's normalised device coordinates do, the scale is half of that in the table, and
//! the bias is that in the table plus half the table's scale. For another matrix, with clip z = A · z + B and clip w =
//! z for eye-space depth z > 0: d = A + B/z, so that scale = 1/B and bias = −A/B.

use crate::ImageSpaceError;
use crate::filter::depth::{
    BEND, DepthPlain, check_depth_softness, ink_depth_bend, ink_depth_plain, ink_depth_step, ink_depth_step_soft,
};
use crate::filter::normal::{NORMAL_COS_OUTLINING_SKETCH, check_normal_softness, ink_normal};
use crate::filter::region::ink_region;
use crate::picture::{Taps, checked_len, filter_picture};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, UVec2, Vec3};

/// Which tests are enabled, and how the textures are read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeparateFilter {
    /// Borders of normals.
    pub normal: Option<SeparateNormal>,
    /// Jumps of depth.
    pub depth: Option<SeparateDepth>,
    /// Borders of regions; 0 is a number like any other.
    pub regions: bool,
    /// The neighbours that are compared.
    pub taps: Taps,
    /// 0 for hard lines; else the width of the transition, in cosines for normals and as a share of its threshold for
    /// depth. At most [`normal_softness_max`](crate::filter::normal::normal_softness_max) of the cosine with a test of
    /// normals, and [`DEPTH_SOFTNESS_MAX`](crate::filter::depth::DEPTH_SOFTNESS_MAX) with one of depth: beyond, flat
    /// faces would have ink.
    pub softness: f32,
}

/// How normals are read and compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeparateNormal {
    /// The cosine below which two normals differ, 0..=1.
    pub cos: f32,
    /// Whether a component n is stored as (n + 1) / 2. Then a texel of zeros is no normal; else a vector of zeros is.
    pub biased: bool,
}

/// How depth is read and compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeparateDepth {
    /// What the texture holds.
    pub source: DepthSource,
    /// Whether the view has no perspective.
    pub parallel: bool,
    /// Which jump of depth is a line.
    pub test: SeparateDepthTest,
}

/// What a depth texture holds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum DepthSource {
    /// Eye-space depth. What no surface can have ([`crate::format::ink_is_surface`]) is background.
    #[default]
    Linear,
    /// The value d of a depth buffer.
    Buffer {
        /// The factor from d to 1/z, or to z in a parallel view.
        scale: f32,
        /// 1/z, or z in a parallel view, at d = 0.
        bias: f32,
        /// The value that the buffer is cleared to, which is background.
        clear: f32,
    },
}

/// Which jump of depth is a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SeparateDepthTest {
    /// [`ink_depth_bend`], by second differences: slanted planes are no lines.
    Bend {
        /// A share of the nearer side's distance; in a parallel view, units of depth.
        step: f32,
    },
    /// [`ink_depth_step`], by first differences relative to the distance.
    Step {
        /// A share of the nearer side's distance.
        step: f32,
    },
    /// [`ink_depth_plain`], on the texture's values as they are.
    Plain {
        /// How the four differences are combined.
        form: DepthPlain,
        /// In the texture's units.
        threshold: f32,
    },
}

impl Default for SeparateFilter {
    /// All three, hard, with diagonal taps: signed normals, linear depth in a perspective view.
    fn default() -> Self {
        Self {
            normal: Some(SeparateNormal::default()),
            depth: Some(SeparateDepth::default()),
            regions: true,
            taps: Taps::Diagonal,
            softness: 0.0,
        }
    }
}

impl Default for SeparateNormal {
    fn default() -> Self {
        Self { cos: NORMAL_COS_OUTLINING_SKETCH, biased: false }
    }
}

impl Default for SeparateDepth {
    fn default() -> Self {
        Self { source: DepthSource::Linear, parallel: false, test: SeparateDepthTest::default() }
    }
}

impl Default for SeparateDepthTest {
    fn default() -> Self {
        Self::Bend { step: BEND }
    }
}

impl DepthSource {
    /// 0 at `near` and 1 at `far`, which may be infinite; cleared to 1.
    ///
    /// # Errors
    /// If not `0 < near < far`.
    pub fn perspective(near: f32, far: f32) -> Result<Self, ImageSpaceError> {
        let [near, far] = inverses(near, far)?;
        Ok(Self::Buffer { scale: (far - near) as f32, bias: near as f32, clear: 1.0 })
    }

    /// 1 at `near` and 0 at `far`, which may be infinite; cleared to 0.
    ///
    /// # Errors
    /// If not `0 < near < far`.
    pub fn reversed(near: f32, far: f32) -> Result<Self, ImageSpaceError> {
        let [near, far] = inverses(near, far)?;
        Ok(Self::Buffer { scale: (near - far) as f32, bias: far as f32, clear: 0.0 })
    }

    /// A parallel view, 0 at `near` and 1 at `far`; cleared to 1.
    ///
    /// # Errors
    /// If not `0 < near < far < ∞`.
    pub fn parallel(near: f32, far: f32) -> Result<Self, ImageSpaceError> {
        if !far.is_finite() {
            return Err(ImageSpaceError::DepthRange { near, far });
        }
        inverses(near, far)?;
        Ok(Self::Buffer { scale: far - near, bias: near, clear: 1.0 })
    }

    /// A parallel view, 1 at `near` and 0 at `far`; cleared to 0.
    ///
    /// # Errors
    /// If not `0 < near < far < ∞`.
    pub fn parallel_reversed(near: f32, far: f32) -> Result<Self, ImageSpaceError> {
        if !far.is_finite() {
            return Err(ImageSpaceError::DepthRange { near, far });
        }
        inverses(near, far)?;
        Ok(Self::Buffer { scale: near - far, bias: far, clear: 0.0 })
    }
}

fn inverses(near: f32, far: f32) -> Result<[f64; 2], ImageSpaceError> {
    if near > 0.0 && near < far && near.is_finite() {
        return Ok([near, far].map(|depth| 1.0 / f64::from(depth)));
    }
    Err(ImageSpaceError::DepthRange { near, far })
}

/// A [`SeparateFilter`] as `InkSeparate` of the WGSL, 48 bytes. Which tests are enabled is not in it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct SeparateUniform {
    /// As [`SeparateNormal::cos`].
    pub normal_cos: f32,
    /// 1: as [`SeparateNormal::biased`].
    pub normal_biased: u32,
    /// As [`SeparateFilter::softness`].
    pub softness: f32,
    /// Ink of one tap across, where lines are soft.
    pub weight: f32,
    /// Of [`SeparateDepthTest`].
    pub depth_threshold: f32,
    /// Of [`DepthSource::Buffer`].
    pub depth_scale: f32,
    /// Of [`DepthSource::Buffer`].
    pub depth_bias: f32,
    /// Of [`DepthSource::Buffer`].
    pub depth_clear: f32,
    /// 1: depth is that of a buffer.
    pub depth_is_buffer: u32,
    /// 1: as [`SeparateDepth::parallel`].
    pub parallel: u32,
    /// Of [`DepthPlain`]: 0 sum, 1 sum as printed, 2 any.
    pub plain_form: u32,
    /// Unused, 0.
    pub padding: u32,
}

impl SeparateUniform {
    /// Checks the filter.
    ///
    /// # Errors
    /// If a threshold is out of its range, the softness gives flat faces ink, or a depth buffer's numbers are not
    /// finite or its scale is 0; [`ImageSpaceError::TapStep`].
    pub fn new(filter: &SeparateFilter) -> Result<Self, ImageSpaceError> {
        filter.taps.validate()?;
        let normal = filter.normal.unwrap_or_default();
        if !(0.0..=1.0).contains(&normal.cos) {
            return Err(ImageSpaceError::NormalThreshold { cos: normal.cos });
        }
        let depth = filter.depth.unwrap_or_default();
        let (threshold, plain_form) = match depth.test {
            SeparateDepthTest::Bend { step } | SeparateDepthTest::Step { step } => (step, 0),
            SeparateDepthTest::Plain { form, threshold } => (threshold, form as u32),
        };
        if !(threshold >= 0.0 && threshold.is_finite()) {
            return Err(ImageSpaceError::DepthStep { step: threshold });
        }
        if !(filter.softness >= 0.0 && filter.softness.is_finite()) {
            return Err(ImageSpaceError::Softness { softness: filter.softness });
        }
        if filter.normal.is_some() {
            check_normal_softness(normal.cos, filter.softness)?;
        }
        if filter.depth.is_some() {
            check_depth_softness(filter.softness)?;
        }
        let (depth_scale, depth_bias, depth_clear) = match depth.source {
            DepthSource::Linear => (1.0, 0.0, 0.0),
            DepthSource::Buffer { scale, bias, clear } => (scale, bias, clear),
        };
        if !(depth_scale.is_finite() && depth_scale != 0.0 && depth_bias.is_finite() && depth_clear.is_finite()) {
            return Err(ImageSpaceError::DepthSource { scale: depth_scale, bias: depth_bias, clear: depth_clear });
        }
        Ok(Self {
            normal_cos: normal.cos,
            normal_biased: u32::from(normal.biased),
            softness: filter.softness,
            weight: filter.taps.weight(),
            depth_threshold: threshold,
            depth_scale,
            depth_bias,
            depth_clear,
            depth_is_buffer: u32::from(depth.source != DepthSource::Linear),
            parallel: u32::from(depth.parallel),
            plain_form,
            padding: 0,
        })
    }
}

/// A normal of any length from a texel: of unit length, or zero for no normal: a vector that is zero, shorter
/// than 2^−126 or not finite.
pub fn ink_separate_normal(texel: Vec3, biased: bool) -> DVec3 {
    let normal = if biased { texel * 2.0 - 1.0 } else { texel };
    let longest = normal.to_array().map(|v| v.to_bits() & 0x7fff_ffff).into_iter().fold(0, u32::max);
    // Compared as bits, so that NaN is not lost in the comparisons.
    if !is_normal_positive(longest) || (biased && texel == Vec3::ZERO) {
        return DVec3::ZERO;
    }
    normal.as_dvec3().normalize()
}

/// Whether the bits are those of a finite number of at least 2^−126, whose reciprocal is finite.
fn is_normal_positive(bits: u32) -> bool {
    bits.wrapping_sub(0x0080_0000) < 0x7f00_0000
}

/// Eye-space depth from a texel; 0 for background, which includes depths below 2^−126.
pub fn ink_separate_depth(texel: f32, settings: &SeparateUniform) -> f32 {
    let mut depth = texel;
    if settings.depth_is_buffer != 0 {
        let v = texel * settings.depth_scale + settings.depth_bias;
        depth = if settings.parallel != 0 { v } else { 1.0 / v };
        if texel == settings.depth_clear {
            depth = 0.0;
        }
    }
    if is_normal_positive(depth.to_bits()) { depth } else { 0.0 }
}

/// A pixel of the three textures. Only the values of enabled tests are read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeparateTexel {
    /// The normal as stored.
    pub normal: Vec3,
    /// The depth as stored.
    pub depth: f32,
    /// The region number.
    pub region: u32,
}

/// Ink of a pixel, 0..=1. `uniform` is that of `filter`.
pub fn ink_separate(
    filter: &SeparateFilter,
    uniform: &SeparateUniform,
    centre: &SeparateTexel,
    taps: &[SeparateTexel; 4],
) -> f64 {
    let (softness, weight) = (f64::from(filter.softness), f64::from(filter.taps.weight()));
    let mut ink = 0.0f64;
    if let Some(normal) = filter.normal {
        let read = |texel: &SeparateTexel| ink_separate_normal(texel.normal, normal.biased);
        let taps = taps.each_ref().map(read);
        ink = ink.max(ink_normal(read(centre), taps, f64::from(normal.cos), softness, weight));
    }
    if let Some(depth) = filter.depth {
        let read = |texel: &SeparateTexel| ink_separate_depth(texel.depth, uniform);
        let (own, read) = (read(centre), taps.each_ref().map(read));
        ink = ink.max(match depth.test {
            SeparateDepthTest::Bend { step } => {
                ink_depth_bend(own, read, f64::from(step), depth.parallel, softness, weight)
            }
            SeparateDepthTest::Step { step } if softness > 0.0 => {
                ink_depth_step_soft(own, read, f64::from(step), softness, weight)
            }
            SeparateDepthTest::Step { step } => f64::from(u8::from(ink_depth_step(own, read, f64::from(step)))),
            SeparateDepthTest::Plain { form, threshold } => {
                let (threshold, taps) = (f64::from(threshold), taps.each_ref().map(|tap| f64::from(tap.depth)));
                ink_depth_plain(f64::from(centre.depth), taps, form, threshold, softness * threshold)
            }
        });
    }
    if filter.regions {
        let regions = taps.each_ref().map(|tap| tap.region);
        ink = ink.max(ink_region(centre.region, regions, softness > 0.0, weight));
    }
    ink
}

/// Runs the filter over a picture, 8 bits of ink for each pixel.
///
/// # Errors
/// If a threshold is out of its range, or `texels` does not have one element for each pixel.
pub fn filter_separate(
    filter: &SeparateFilter,
    texels: &[SeparateTexel],
    size_px: UVec2,
) -> Result<Vec<u8>, ImageSpaceError> {
    checked_len(texels.len(), size_px)?;
    let uniform = SeparateUniform::new(filter)?;
    filter_picture(texels, size_px, filter.taps, |centre, taps| ink_separate(filter, &uniform, &centre, &taps) as f32)
}

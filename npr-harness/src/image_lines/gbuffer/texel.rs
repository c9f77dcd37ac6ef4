//! Unquantised texels, and how they are encoded. The twin of `texel.wgsl`.
//!
//! Four words of 32 bits: x and y of the unit normal as floats; the region number in the lowest 24 bits, and above them
//! [`GBUFFER_SHADOWED`], [`GBUFFER_NORMAL`] and [`GBUFFER_BEHIND`]; eye depth as a float. Zeros are background.

use super::plan::GBufferPlan;
use super::style::{Background, GBufferTarget};
use glam::{DVec3, Vec3};
use npr_imagespace::filter::separate::SeparateTexel;
use npr_imagespace::format::depth::DepthFormat;
use npr_imagespace::format::normal::NormalFormat;
use npr_imagespace::format::printed::{CLEAR, CLEAR_PRINTED, ink_printed_encode};
use npr_imagespace::shadow::ink_shadow_depth;

/// WGSL of this module: no bindings, no entry points.
#[cfg(feature = "gpu")]
pub(crate) const WGSL: &str = include_str!("texel.wgsl");

/// A texel.
pub type GBufferTexel = [u32; 4];

/// No surface.
pub const BACKGROUND: GBufferTexel = [0; 4];
/// The largest region number.
pub const GBUFFER_REGION_MAX: u32 = 0x00ff_ffff;
/// Set where the surface is in shadow, as printed: in a cast shadow, or facing away from the light.
pub const GBUFFER_SHADOWED: u32 = 1 << 29;
/// Set where there is a normal.
pub const GBUFFER_NORMAL: u32 = 1 << 30;
/// Set where z of the normal is negative.
pub const GBUFFER_BEHIND: u32 = 1 << 31;

/// A texel of a surface.
///
/// - `normal`: of any length, in world space; zero for none;
/// - `region`: at most [`GBUFFER_REGION_MAX`];
/// - `depth`: eye depth.
pub fn gbuffer_pack(normal: Vec3, region: u32, depth: f32, shadowed: bool) -> GBufferTexel {
    let unit = normal.as_dvec3().normalize_or_zero().as_vec3();
    let mut word = region;
    if shadowed {
        word |= GBUFFER_SHADOWED;
    }
    if unit != Vec3::ZERO {
        word |= GBUFFER_NORMAL;
    }
    if unit.z < 0.0 {
        word |= GBUFFER_BEHIND;
    }
    [unit.x.to_bits(), unit.y.to_bits(), word, depth.to_bits()]
}

/// The unit normal of a texel, zero for none.
pub fn gbuffer_normal(texel: GBufferTexel) -> Vec3 {
    if texel[2] & GBUFFER_NORMAL == 0 {
        return Vec3::ZERO;
    }
    let (x, y) = (f32::from_bits(texel[0]), f32::from_bits(texel[1]));
    let z = (1.0 - f64::from(x) * f64::from(x) - f64::from(y) * f64::from(y)).max(0.0).sqrt() as f32;
    Vec3::new(x, y, if texel[2] & GBUFFER_BEHIND == 0 { z } else { -z })
}

/// The colour that stands for a region: channels in steps of 4, scattered by a hash; white for
/// background.
pub fn gbuffer_region_color(region: u32) -> [u8; 3] {
    if region == 0 {
        return [255; 3];
    }
    // Two multiplications, so that neighbouring numbers have unrelated colours.
    let mixed = region.wrapping_mul(0x9e37_79b1);
    let hash = (mixed ^ mixed >> 15).wrapping_mul(0x85eb_ca6b);
    [26, 20, 14].map(|shift| ((hash >> shift & 63) * 4) as u8)
}

/// The number of a region that is compared by the sum of its colour's channels, from 1. Colours are in steps of 4, which
/// the printed threshold of 0.01 tells apart.
pub fn gbuffer_region_sum(region: u32) -> u32 {
    gbuffer_region_color(region).map(u32::from).iter().sum::<u32>() + 1
}

/// A normal as a format holds it; zero stays zero.
pub fn gbuffer_stored_normal(normal: Vec3, format: Option<NormalFormat>) -> Vec3 {
    match format {
        Some(format) if normal != Vec3::ZERO => format.decode(format.encode(normal)),
        _ => normal,
    }
}

impl GBufferPlan {
    /// The share of the depth range, as the target stores it.
    fn share(&self, depth: f32) -> f32 {
        (depth - self.range.near) / (self.range.far - self.range.near)
    }

    /// The texel of the RGBA8 target.
    pub(crate) fn rgba8(&self, texel: GBufferTexel) -> [u8; 4] {
        if texel == BACKGROUND {
            return if self.gbuffer.background == Background::PlusZ { CLEAR_PRINTED } else { CLEAR };
        }
        ink_printed_encode(gbuffer_normal(texel), self.share(f32::from_bits(texel[3])).clamp(0.0, 1.0))
    }

    /// Eye depth as the target stores it, without its sign.
    fn stored_depth(&self, texel: GBufferTexel) -> f32 {
        let depth = f32::from_bits(texel[3]);
        let format = match &self.gbuffer.target {
            GBufferTarget::Rgba8(_) => DepthFormat::Unorm8,
            GBufferTarget::Separate(separate) => separate.depth,
        };
        format.decode(format.encode(depth, &self.range), &self.range)
    }

    /// The texels of the three targets.
    pub(crate) fn separate(&self, texel: GBufferTexel) -> SeparateTexel {
        let GBufferTarget::Separate(separate) = &self.gbuffer.target else { return SeparateTexel::default() };
        let region_of = |region| if separate.region_sums { gbuffer_region_sum(region) } else { region };
        let is_plain = self.gbuffer.is_plain();
        if texel == BACKGROUND {
            let normal = if self.gbuffer.background == Background::PlusZ { Vec3::Z } else { Vec3::ZERO };
            return SeparateTexel { normal, depth: if is_plain { 1.0 } else { 0.0 }, region: region_of(0) };
        }
        let depth = self.stored_depth(texel);
        let negated = self.gbuffer.negated_depth && texel[2] & GBUFFER_SHADOWED != 0;
        SeparateTexel {
            normal: gbuffer_stored_normal(gbuffer_normal(texel), separate.normals),
            depth: if is_plain { ink_shadow_depth(self.share(depth), negated) } else { depth },
            region: region_of(texel[2] & GBUFFER_REGION_MAX),
        }
    }

    /// The normal as stored, as a colour.
    pub(crate) fn normal_color(&self, texel: GBufferTexel) -> DVec3 {
        let (normal, is_surface) = match &self.gbuffer.target {
            GBufferTarget::Rgba8(_) => {
                let [x, y, z, _] = self.rgba8(texel);
                return DVec3::new(f64::from(x), f64::from(y), f64::from(z)) / 255.0;
            }
            GBufferTarget::Separate(_) => {
                let normal = self.separate(texel).normal;
                (normal, normal != Vec3::ZERO)
            }
        };
        if is_surface { (normal.as_dvec3() * 0.5 + 0.5).clamp(DVec3::ZERO, DVec3::ONE) } else { DVec3::ZERO }
    }

    /// Depth as stored, as a colour.
    pub(crate) fn depth_color(&self, texel: GBufferTexel) -> DVec3 {
        if texel == BACKGROUND {
            return DVec3::ONE;
        }
        let negated = self.gbuffer.negated_depth && texel[2] & GBUFFER_SHADOWED != 0;
        let share = if negated { 0.0 } else { self.share(self.stored_depth(texel)).clamp(0.0, 1.0) };
        DVec3::splat(share.into())
    }

    /// The colour of a texel's region.
    pub(crate) fn region_color(&self, texel: GBufferTexel) -> DVec3 {
        DVec3::from(gbuffer_region_color(texel[2] & GBUFFER_REGION_MAX).map(f64::from)) / 255.0
    }
}

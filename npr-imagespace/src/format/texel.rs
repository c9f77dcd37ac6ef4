//! Packed G-buffer texels: normal, region and depth of a pixel in 32 or 64 bits, read by one load.
//!
//! | layout | texture | depth | region | normal |
//! | --- | --- | --- | --- | --- |
//! | [`TexelLayout::Bits32`] | `R32Uint` | bits 0–13 | bits 14–21 | bits 22–26, 27–31: octahedral 2 × 5 |
//! | [`TexelLayout::Bits64`] | `Rg32Uint` | x, bits 0–23 | x, bits 24–31 and y, bits 16–31 | y, bits 0–7, 8–15: octahedral 2 × 8 |
//!
//! A filter over five taps is limited by its loads and its arithmetic rather than by bandwidth. The bits follow from
//! the comparisons that the filter makes:
//!
//! - *Region*: whether two neighbours have the same number. 0 is background, and a texel of region 0 is all zeros;
//!   other numbers are folded to the available bits ([`ink_fold_region`]), and neighbours whose numbers differ by a
//!   multiple of 255 (or 16,777,215) are not distinguished.
//! - *Normal*: whether two directions differ by about 35°. With 5 bits a number the error is up to 8°, with 8 bits 1°,
//!   so that creases of 55° and more, or of 40° and more, are found reliably. For exact creases use regions, since
//!   interpolated smooth normals have no creases.
//! - *Depth*: whether three neighbours in a row lie on a plane. On the screen 1/z of a plane is linear, z is not, so
//!   what is stored is 1/z ([`DepthCode`]), or in a parallel view −z, which is linear there. The test is a
//!   second difference of integers, whose rounding error is at most 2 for any three points of a plane. 14 bits
//!   distinguish surfaces 1 % apart up to about 80 times the nearest distance of an infinite range; 24 bits, the
//!   precision of f32, up to 20,000 times.
//!
//! Larger depth codes are nearer; background has the farthest.

use crate::ImageSpaceError;
use crate::format::ink_is_surface;
use crate::format::normal::{ink_oct_encode, ink_oct_load};
use bytemuck::{Pod, Zeroable};
use glam::{IVec3, UVec2, Vec3};

/// The texel of a pixel that shows no surface, in both layouts.
pub const BACKGROUND: [u32; 2] = [0; 2];

/// The bits of a packed texel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TexelLayout {
    /// 32 bits: depth 14, region 8, normal 2 × 5.
    Bits32,
    /// 64 bits: depth 24, region 24, normal 2 × 8.
    #[default]
    Bits64,
}

impl TexelLayout {
    /// The largest code of depth.
    pub const fn depth_max(self) -> u32 {
        match self {
            TexelLayout::Bits32 => (1 << 14) - 1,
            TexelLayout::Bits64 => (1 << 24) - 1,
        }
    }

    /// The largest number of a region.
    pub const fn region_max(self) -> u32 {
        match self {
            TexelLayout::Bits32 => (1 << 8) - 1,
            TexelLayout::Bits64 => (1 << 24) - 1,
        }
    }

    /// The largest region number beside a shadow state, which takes two of its bits: [`crate::shadow`].
    pub const fn shadowed_region_max(self) -> u32 {
        self.region_max() >> 2
    }

    /// The two bits of a region that hold the shadow state, in texels with shadow states.
    pub const fn shadow_bits(self) -> u32 {
        self.region_max() & !self.shadowed_region_max()
    }

    /// The largest octahedral integer, m.
    pub const fn normal_max(self) -> i32 {
        match self {
            TexelLayout::Bits32 => 15,
            TexelLayout::Bits64 => 127,
        }
    }

    /// The largest second difference of codes that rounding causes on a plane: 2 from the rounding to codes, and with
    /// 24 bits 6 more from f32 arithmetic.
    pub const fn depth_slack(self) -> u32 {
        match self {
            TexelLayout::Bits32 => 2,
            TexelLayout::Bits64 => 8,
        }
    }
}

/// The conversion of eye-space depth to a code that is linear on the screen: round(v · scale + bias), clamped, where v
/// is 1/z, or z in a parallel view. `InkDepthCode` of the WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct DepthCode {
    /// Codes per unit of v; negative in a parallel view.
    pub scale: f32,
    /// The code at v = 0.
    pub bias: f32,
    /// The largest code.
    pub most: f32,
    /// 1: v is z.
    pub parallel: u32,
}

impl DepthCode {
    /// From eye-space depth `near` (the largest code) to `far` (0). Depths outside are clamped, and a clamped
    /// plane has a false second difference: the range should contain all visible depths. `far` may be infinite.
    ///
    /// # Errors
    /// If not `0 < near < far`.
    pub fn perspective(near: f32, far: f32, layout: TexelLayout) -> Result<Self, ImageSpaceError> {
        if !(near > 0.0 && near < far && near.is_finite()) {
            return Err(ImageSpaceError::DepthRange { near, far });
        }
        let most = layout.depth_max() as f32;
        let (inverse_near, inverse_far) = (1.0 / f64::from(near), 1.0 / f64::from(far));
        let scale = f64::from(most) / (inverse_near - inverse_far);
        Ok(Self { scale: scale as f32, bias: (-inverse_far * scale) as f32, most, parallel: 0 })
    }

    /// As [`DepthCode::perspective`], for a view without perspective; `far` is finite.
    ///
    /// # Errors
    /// If not `0 < near < far < ∞`.
    pub fn parallel(near: f32, far: f32, layout: TexelLayout) -> Result<Self, ImageSpaceError> {
        if !(near > 0.0 && near < far && far.is_finite()) {
            return Err(ImageSpaceError::DepthRange { near, far });
        }
        let most = layout.depth_max() as f32;
        let scale = f64::from(most) / (f64::from(far) - f64::from(near));
        Ok(Self { scale: -scale as f32, bias: (f64::from(far) * scale) as f32, most, parallel: 1 })
    }

    /// The same code computed from a depth-buffer value d, where the v of [`DepthCode`] is `v_at_0 + d · v_per_unit`.
    ///
    /// Depth buffers are linear on the screen, so that any can be used; in a fragment shader the value is `position.z`.
    /// v is 1/z in perspective: with reversed depth and no far plane d = near / z, so that v is d / near. In a parallel
    /// view v is z: far − d (far − near) with reversed depth.
    pub fn of_buffer(&self, v_at_0: f64, v_per_unit: f64) -> Self {
        let (scale, bias) = (f64::from(self.scale), f64::from(self.bias));
        Self { scale: (scale * v_per_unit) as f32, bias: (bias + scale * v_at_0) as f32, ..*self }
    }

    /// Eye-space depth of a code; infinite for 0 where the range is.
    pub fn depth(&self, code: u32) -> f64 {
        let v = (f64::from(code) - f64::from(self.bias)) / f64::from(self.scale);
        if self.parallel != 0 { v } else { 1.0 / v }
    }
}

/// A depth's code.
pub fn ink_depth_code(depth: f32, code: &DepthCode) -> u32 {
    ink_depth_code_of(if code.parallel != 0 { depth } else { 1.0 / depth }, code)
}

/// The code of the v of [`DepthCode`], for shaders that have 1/z already.
pub fn ink_depth_code_of(v: f32, code: &DepthCode) -> u32 {
    (v * code.scale + code.bias).clamp(0.0, code.most).round_ties_even() as u32
}

/// A region's number folded to 1..=`most`: consecutive numbers stay different. 0, background, stays 0.
pub fn ink_fold_region(region: u32, most: u32) -> u32 {
    if region == 0 { 0 } else { 1 + (region - 1) % most }
}

/// A decoded texel, as the filter compares it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Tap {
    /// As [`ink_oct_vector`](crate::format::normal::ink_oct_vector) has it; zero for no normal.
    pub normal: IVec3,
    /// The region number, with the shadow state if texels have one; 0 is background.
    pub region: u32,
    /// The depth code; larger is nearer.
    pub depth: i32,
}

/// A pixel as a 32-bit texel, `R32Uint`. `region` 0, and a depth that is not valid for a surface, give background.
pub fn ink_texel32_pack(normal: Vec3, region: u32, depth: f32, code: &DepthCode) -> u32 {
    if region == 0 || !ink_is_surface(depth) {
        return 0;
    }
    let region = ink_fold_region(region, TexelLayout::Bits32.region_max());
    ink_texel32_bits(normal, region, ink_depth_code(depth, code))
}

/// A surface as a 32-bit texel, from a depth code that is known already, for example from a depth buffer
/// ([`DepthCode::of_buffer`]), and a folded region ([`ink_fold_region`]), 1..=[`TexelLayout::region_max`]. Folding
/// regions in a fragment shader is expensive: on lavapipe the remainder took a twentieth of a whole frame.
pub fn ink_texel32_bits(normal: Vec3, folded: u32, depth_code: u32) -> u32 {
    let layout = TexelLayout::Bits32;
    let oct = ink_oct_encode(normal, layout.normal_max());
    depth_code | folded << 14 | oct.x << 22 | oct.y << 27
}

/// Decodes a 32-bit texel.
pub fn ink_texel32_tap(word: u32) -> Tap {
    let oct = UVec2::new(word >> 22 & 31, word >> 27);
    Tap {
        normal: ink_oct_load(oct, TexelLayout::Bits32.normal_max()),
        region: word >> 14 & 255,
        depth: (word & 0x3fff) as i32,
    }
}

/// A pixel as a 64-bit texel, `Rg32Uint`. `region` 0, and a depth that is not valid for a surface, give background.
pub fn ink_texel64_pack(normal: Vec3, region: u32, depth: f32, code: &DepthCode) -> [u32; 2] {
    if region == 0 || !ink_is_surface(depth) {
        return BACKGROUND;
    }
    let region = ink_fold_region(region, TexelLayout::Bits64.region_max());
    ink_texel64_bits(normal, region, ink_depth_code(depth, code))
}

/// A surface as a 64-bit texel, as [`ink_texel32_bits`].
pub fn ink_texel64_bits(normal: Vec3, folded: u32, depth_code: u32) -> [u32; 2] {
    let layout = TexelLayout::Bits64;
    let oct = ink_oct_encode(normal, layout.normal_max());
    [depth_code | folded << 24, oct.x | oct.y << 8 | folded >> 8 << 16]
}

/// Decodes a 64-bit texel.
pub fn ink_texel64_tap(words: [u32; 2]) -> Tap {
    let [x, y] = words;
    let oct = UVec2::new(y & 255, y >> 8 & 255);
    Tap {
        normal: ink_oct_load(oct, TexelLayout::Bits64.normal_max()),
        region: x >> 24 | y >> 16 << 8,
        depth: (x & 0x00ff_ffff) as i32,
    }
}

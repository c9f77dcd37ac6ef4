//! Normal, region and depth of a pixel in one word or two, to be read in one load.
//!
//! | layout | texture | depth | region | normal |
//! | --- | --- | --- | --- | --- |
//! | [`TexelLayout::Narrow`] | `R32Uint` | bits 0–13 | bits 14–21 | bits 22–26, 27–31: octahedral 2 × 5 |
//! | [`TexelLayout::Wide`] | `Rg32Uint` | x, bits 0–23 | x, bits 24–31 and y, bits 16–31 | y, bits 0–7, 8–15: octahedral 2 × 8 |
//!
//! A filter over five taps is bound by its loads and its arithmetic, and not by bytes, so that what it reads is
//! decided by what it asks:
//!
//! - *Region*: whether two neighbours are the same, no more. 0 is background, and a texel of region 0 is all zeros;
//!   others are folded to what there is room for ([`ink_fold_region`]), and neighbours whose numbers differ by a
//!   multiple of 255 (or 16,777,215) are not told apart.
//! - *Normal*: whether two directions are some 35° apart. 5 bits a number are wrong by up to 8°, 8 bits by 1°: enough
//!   for folds of 55° and more, and for all over 40°. Where creases should be exact it is regions that carry them,
//!   since smooth normals have none.
//! - *Depth*: whether three neighbours in a row lie on a plane. On the screen 1/z of a plane is linear, z is not, so
//!   what is stored is 1/z ([`DepthCode`]), or in a parallel view −z, which is linear there. Then the test is a
//!   second difference of integers, and its rounding is known: it is no more than 2 for any three points of a plane.
//!   14 bits part surfaces 1% apart up to some 80 times the distance of the near end of an infinite range; 24 bits,
//!   all that an f32 holds, up to 20,000 times.
//!
//! Larger is nearer, and background is farthest.

use crate::ImageSpaceError;
use crate::format::ink_is_surface;
use crate::format::normal::{ink_oct_encode, ink_oct_load};
use bytemuck::{Pod, Zeroable};
use glam::{IVec3, UVec2, Vec3};

/// The texel of a pixel that shows no surface, in both layouts.
pub const BACKGROUND: [u32; 2] = [0; 2];

/// How many bits are whose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TexelLayout {
    /// One word: depth 14, region 8, normal 2 × 5.
    Narrow,
    /// Two words: depth 24, region 24, normal 2 × 8.
    #[default]
    Wide,
}

impl TexelLayout {
    /// The largest code of depth.
    pub const fn depth_most(self) -> u32 {
        match self {
            Self::Narrow => (1 << 14) - 1,
            Self::Wide => (1 << 24) - 1,
        }
    }

    /// The largest number of a region.
    pub const fn region_most(self) -> u32 {
        match self {
            Self::Narrow => (1 << 8) - 1,
            Self::Wide => (1 << 24) - 1,
        }
    }

    /// The largest number of a region beside a state of shadow, which takes two bits of it: [`crate::shadow`].
    pub const fn shadowed_region_most(self) -> u32 {
        self.region_most() >> 2
    }

    /// Where a region's number holds a state of shadow, where it does.
    pub const fn shadow_bits(self) -> u32 {
        self.region_most() & !self.shadowed_region_most()
    }

    /// What the octahedral numbers run to.
    pub const fn normal_most(self) -> i32 {
        match self {
            Self::Narrow => 15,
            Self::Wide => 127,
        }
    }

    /// The largest second difference that rounding alone gives on a plane: 2 for the rounding to codes, and in 24
    /// bits as much again and more for the rounding of f32 on the way there.
    pub const fn depth_slack(self) -> u32 {
        match self {
            Self::Narrow => 2,
            Self::Wide => 8,
        }
    }
}

/// How eye-space depth becomes a code that is linear on the screen: round(v · scale + bias), clamped, where v is 1/z,
/// or z in a parallel view. `InkDepthCode` of the WGSL.
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
    /// From eye-space depth `near` (the largest code) to `far` (0). What lies outside is clamped, and a plane that is
    /// clamped has a bend there: let the range hold what is seen. `far` may be infinite.
    ///
    /// # Errors
    /// If not `0 < near < far`.
    pub fn perspective(near: f32, far: f32, layout: TexelLayout) -> Result<Self, ImageSpaceError> {
        if !(near > 0.0 && near < far && near.is_finite()) {
            return Err(ImageSpaceError::DepthRange { near, far });
        }
        let most = layout.depth_most() as f32;
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
        let most = layout.depth_most() as f32;
        let scale = f64::from(most) / (f64::from(far) - f64::from(near));
        Ok(Self { scale: -scale as f32, bias: (f64::from(far) * scale) as f32, most, parallel: 1 })
    }

    /// The same code from a depth buffer's value d, where what [`DepthCode`] calls v is `v_at_0 + d · v_per_unit`.
    ///
    /// A depth buffer is linear on the screen, so any can be used, and a fragment has its value at hand, in
    /// `position.z`. v is 1/z in perspective: with reversed depth and no far plane d = near / z, so that v is
    /// d / near. In a parallel view v is z: far − d (far − near) with reversed depth.
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

/// The code of what [`DepthCode`] calls v: for a shader that has 1/z at hand.
pub fn ink_depth_code_of(v: f32, code: &DepthCode) -> u32 {
    (v * code.scale + code.bias).clamp(0.0, code.most).round_ties_even() as u32
}

/// A region's number folded to 1..=`most`: neighbouring numbers stay apart. 0, background, stays 0.
pub fn ink_fold_region(region: u32, most: u32) -> u32 {
    if region == 0 { 0 } else { 1 + (region - 1) % most }
}

/// What a filter knows of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Tap {
    /// As [`ink_oct_vector`](crate::format::normal::ink_oct_vector) has it; zero for no normal.
    pub normal: IVec3,
    /// 0 is background.
    pub region: u32,
    /// A code; larger is nearer.
    pub depth: i32,
}

/// A pixel in one word: `R32Uint`. `region` 0, and a depth that no surface has, give background.
pub fn ink_narrow_pack(normal: Vec3, region: u32, depth: f32, code: &DepthCode) -> u32 {
    if region == 0 || !ink_is_surface(depth) {
        return 0;
    }
    let region = ink_fold_region(region, TexelLayout::Narrow.region_most());
    ink_narrow_word(normal, region, ink_depth_code(depth, code))
}

/// A surface in one word: for who has its depth code at hand, from a depth buffer, say ([`DepthCode::of_buffer`]), and
/// regions that are folded ([`ink_fold_region`]): 1..=[`TexelLayout::region_most`]. In a fragment shader a remainder
/// is dear: on lavapipe it took a twentieth of a whole frame.
pub fn ink_narrow_word(normal: Vec3, folded: u32, depth_code: u32) -> u32 {
    let layout = TexelLayout::Narrow;
    let oct = ink_oct_encode(normal, layout.normal_most());
    depth_code | folded << 14 | oct.x << 22 | oct.y << 27
}

/// A pixel of one word.
pub fn ink_narrow_tap(word: u32) -> Tap {
    let oct = UVec2::new(word >> 22 & 31, word >> 27);
    Tap {
        normal: ink_oct_load(oct, TexelLayout::Narrow.normal_most()),
        region: word >> 14 & 255,
        depth: (word & 0x3fff) as i32,
    }
}

/// A pixel in two words: `Rg32Uint`. `region` 0, and a depth that no surface has, give background.
pub fn ink_wide_pack(normal: Vec3, region: u32, depth: f32, code: &DepthCode) -> [u32; 2] {
    if region == 0 || !ink_is_surface(depth) {
        return BACKGROUND;
    }
    let region = ink_fold_region(region, TexelLayout::Wide.region_most());
    ink_wide_words(normal, region, ink_depth_code(depth, code))
}

/// A surface in two words, as [`ink_narrow_word`].
pub fn ink_wide_words(normal: Vec3, folded: u32, depth_code: u32) -> [u32; 2] {
    let layout = TexelLayout::Wide;
    let oct = ink_oct_encode(normal, layout.normal_most());
    [depth_code | folded << 24, oct.x | oct.y << 8 | folded >> 8 << 16]
}

/// A pixel of two words.
pub fn ink_wide_tap(words: [u32; 2]) -> Tap {
    let [x, y] = words;
    let oct = UVec2::new(y & 255, y >> 8 & 255);
    Tap {
        normal: ink_oct_load(oct, TexelLayout::Wide.normal_most()),
        region: x >> 24 | y >> 16 << 8,
        depth: (x & 0x00ff_ffff) as i32,
    }
}

//! 2D ramps: the diffuse term of one light along u, that of another along v.
//!
//! *The Evolution of a Cartoon Renderer* looks up the tone in an image (figure 2): dark in the upper left corner, where
//! both lights are dim, and lighter in steps to the right with the first light and downwards with the second. Here it is
//! computed from two 1D ramps ([`Ramp2d`], [`toon_ramp_2d`]), which can be converted to an image
//! ([`RampTable::from_ramps`]); painted images can be used as well.
//!
//! The article does not define how two ramps are combined. Here the result is the componentwise maximum,
//! max(a(u), b(v)). Where one light is off, the result is the other light's ramp; steps remain steps at the positions of
//! the two ramps; a second light never darkens; and the darkest tone is that of a single ramp. A sum would double the
//! darkest tone and create new tones where both lights contribute.
//!
//! A separate tone for strong light can be placed in the corner opposite to the dark one ([`Corner`]).

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, UVec2, Vec3};

use crate::error::is_color;
use crate::light::saturate;
use crate::ramp::{Ramp, RampBlend, RampUniform, toon_ramp};
use crate::row::{TexelFilter, from_texel, to_texel, toon_row_nearest, toon_row_taps};
use crate::{Bands, ToonError, toon_coverage};

/// A 2D ramp composed of two 1D ramps. Their stops are within 0..=1, except that the first stop of a hard ramp may be
/// lower, since a hard ramp is constant below its second stop.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case", deny_unknown_fields))]
pub struct Ramp2d {
    /// The ramp over the diffuse term of the first light.
    pub a: Ramp,
    /// The ramp over the diffuse term of the second light.
    pub b: Ramp,
    /// The tone for strong light.
    pub corner: Option<Corner>,
}

/// A tone that replaces those of the ramps where (u, v) is far from the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case", deny_unknown_fields))]
pub struct Corner {
    /// The minimum length of (u, v), each clamped to 0..=1, for this tone; above 0. Up to 1 a single light can reach it,
    /// above 1 both lights are needed, and above √2 the corner is empty.
    pub threshold: f32,
    /// A display-referred RGB factor on the surface's colour, as the colours of the ramps.
    pub color: Vec3,
}

impl Ramp2d {
    /// The same bands for both lights, without the highlight and without a corner.
    pub fn from_bands(bands: &Bands) -> Result<Self, ToonError> {
        let ramp = Ramp::from_bands(bands)?;
        let ramps = Self { a: ramp.clone(), b: ramp, corner: None };
        ramps.validate()?;
        Ok(ramps)
    }

    /// Checks all fields and returns the first violation.
    pub fn validate(&self) -> Result<(), ToonError> {
        for ramp in [&self.a, &self.b] {
            ramp.validate()?;
            // A ramp with a single stop is constant wherever the stop is.
            let begins_below = ramp.blend == RampBlend::Smooth && ramp.stops.len() > 1 && ramp.stops[0].at < 0.0;
            for (index, stop) in ramp.stops.iter().enumerate() {
                let is_outside = if index == 0 { begins_below } else { !(stop.at > 0.0 && stop.at <= 1.0) };
                if is_outside {
                    return Err(ToonError::StopOutside { index, value: stop.at });
                }
            }
        }
        if let Some(Corner { threshold, color }) = self.corner {
            if !(threshold > 0.0 && threshold.is_finite()) {
                return Err(ToonError::CornerThreshold { value: threshold });
            }
            if !is_color(color) {
                return Err(ToonError::CornerColor { value: color });
            }
        }
        Ok(())
    }
}

/// The colour of a 2D ramp at `uv`, the diffuse terms of the two lights ([`crate::painter::toon_painter_uv`]), which are
/// clamped to 0..=1.
///
/// `widths` are the changes of u and v across the pixel. Each ramp is antialiased over its own width, the corner over an
/// upper bound of the change of the length of (u, v), which may be wider than a pixel where u and v change in different
/// directions. Coverage is exact for one step per pixel and approximate where two steps cross.
pub fn toon_ramp_2d(ramps: &Ramp2d, uv: DVec2, widths: DVec2) -> DVec3 {
    let color = toon_ramp(&ramps.a, uv.x, widths.x).max(toon_ramp(&ramps.b, uv.y, widths.y));
    let Some(corner) = ramps.corner else { return color };
    let inside = toon_corner(uv, widths, f64::from(corner.threshold));
    color * (1.0 - inside) + corner.color.as_dvec3() * inside
}

/// The fraction of a pixel, 0..=1, that is in the corner: where the length of `uv`, clamped componentwise to 0..=1, is at
/// least `threshold`. Components above 1 are constant after clamping and do not contribute to the width of the border.
pub fn toon_corner(uv: DVec2, widths: DVec2, threshold: f64) -> f64 {
    let clamped = DVec2::new(saturate(uv.x), saturate(uv.y));
    let length = clamped.length();
    let widths = DVec2::select(uv.cmplt(DVec2::ONE), widths, DVec2::ZERO);
    let width = if length > 0.0 { clamped.dot(widths) / length } else { 0.0 };
    toon_coverage(length, threshold, width)
}

/// A 2D ramp as an image. u increases to the right and v downwards, both from 0 to 1. Each axis is sampled as in
/// [`crate::row`].
#[derive(Clone, Debug, PartialEq)]
pub struct RampTable {
    /// The numbers of columns and rows, at least 1 each.
    pub size: UVec2,
    /// RGBA texels row by row from the top left, which is the dark corner.
    pub texels: Vec<[u8; 4]>,
    /// The interpolation between texel centres.
    pub filter: TexelFilter,
}

impl RampTable {
    /// Samples the ramps at the centres of the texels, clamped to 0..=1 and rounded to 8 bits.
    pub fn from_ramps(ramps: &Ramp2d, size: UVec2, filter: TexelFilter) -> Result<Self, ToonError> {
        ramps.validate()?;
        let centre = |i: u32, count: u32| (f64::from(i) + 0.5) / f64::from(count);
        let texel = |x: u32, y: u32| DVec2::new(centre(x, size.x), centre(y, size.y));
        let texels = (0..size.y).flat_map(|y| (0..size.x).map(move |x| (x, y)));
        let texels = texels.map(|(x, y)| to_texel(toon_ramp_2d(ramps, texel(x, y), DVec2::ZERO))).collect();
        let table = Self { size, texels, filter };
        table.validate()?;
        Ok(table)
    }

    /// Checks that the size is not zero and that the number of texels matches it.
    pub fn validate(&self) -> Result<(), ToonError> {
        let (width, height, texels) = (self.size.x, self.size.y, self.texels.len());
        let area = u64::from(width) * u64::from(height);
        if area > 0 && area == texels as u64 { Ok(()) } else { Err(ToonError::Texels { width, height, texels }) }
    }
}

/// The display-referred RGB of the image at `uv`.
pub fn toon_table(table: &RampTable, uv: DVec2) -> DVec3 {
    let color = |x: u32, y: u32| {
        let index = y as usize * table.size.x as usize + x as usize;
        table.texels.get(index).map_or(DVec3::ZERO, |&texel| from_texel(texel))
    };
    match table.filter {
        TexelFilter::Nearest => {
            color(toon_row_nearest(uv.x, 0.0, 1.0, table.size.x), toon_row_nearest(uv.y, 0.0, 1.0, table.size.y))
        }
        TexelFilter::Linear => {
            let across = toon_row_taps(uv.x, 0.0, 1.0, table.size.x);
            let down = toon_row_taps(uv.y, 0.0, 1.0, table.size.y);
            let [[upper_left, upper_right], [lower_left, lower_right]] =
                [down.left, down.right].map(|y| [across.left, across.right].map(|x| color(x, y)));
            toon_table_mix(upper_left, upper_right, lower_left, lower_right, across.share, down.share)
        }
    }
}

/// Bilinear interpolation of four texels. `share_u` is the weight of the right texels, `share_v` that of the lower ones.
pub fn toon_table_mix(
    upper_left: DVec3,
    upper_right: DVec3,
    lower_left: DVec3,
    lower_right: DVec3,
    share_u: f64,
    share_v: f64,
) -> DVec3 {
    upper_left.lerp(upper_right, share_u).lerp(lower_left.lerp(lower_right, share_u), share_v)
}

/// `ToonRamp2d` of the WGSL, 304 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Ramp2dUniform {
    /// The ramp of the first light.
    pub a: RampUniform,
    /// The ramp of the second light.
    pub b: RampUniform,
    /// The colour and the threshold of the corner. Without a corner the threshold is 10,000.
    pub corner: [f32; 4],
}

impl Ramp2dUniform {
    /// Checks and packs `ramps`.
    pub fn new(ramps: &Ramp2d) -> Result<Self, ToonError> {
        ramps.validate()?;
        let corner = ramps.corner.map_or(Vec3::ZERO.extend(1e4), |corner| corner.color.extend(corner.threshold));
        Ok(Self { a: RampUniform::new(&ramps.a)?, b: RampUniform::new(&ramps.b)?, corner: corner.to_array() })
    }
}

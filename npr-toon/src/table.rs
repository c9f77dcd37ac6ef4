//! 2D ramps: one light across, another down.
//!
//! *The Evolution of a Cartoon Renderer* looks its shade up in an image, figure 2: dark in the upper left corner
//! where neither light reaches, and lighter in steps toward the right, where the first is bright, and the bottom, where
//! the second is. Here it is computed from two 1D ramps ([`Ramp2d`], [`toon_ramp_2d`]); it can be turned into an image
//! ([`RampTable::from_ramps`]) or come from one that was painted.
//!
//! How two ramps become one is not said there. Here the *lighter* one shows, component by component:
//! max(a(u), b(v)). Where one light does not reach, the other's ramp is seen as it is; steps stay steps, at the places
//! that the two ramps give them; a second light never darkens; and both in the dark is as dark as one of them.
//! (A sum would make the dark twice as light as it was chosen, and new tones wherever both reach.)
//!
//! An extra shade for bright lights lies in the corner away from the dark ([`Corner`]).

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, UVec2, Vec3};

use crate::error::is_color;
use crate::light::saturate;
use crate::ramp::{Ramp, RampBlend, RampUniform, toon_ramp};
use crate::row::{TexelFilter, from_texel, to_texel, toon_row_nearest, toon_row_taps};
use crate::{Bands, ToonError, toon_coverage};

/// A 2D ramp as two of one dimension. Their stops lie between 0 and 1, but for the first of a hard one, which may lie
/// lower: below 0 there is one colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Ramp2d {
    /// What the first light alone gives.
    pub a: Ramp,
    /// What the second light alone gives.
    pub b: Ramp,
    /// The shade of bright lights.
    pub corner: Option<Corner>,
}

/// A shade that replaces the ramps' where (u, v) is far from the dark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// The least length of (u, v), each clamped to 0..=1, that belongs to the corner. Up to 1 one light can own it, if
    /// it is at least this bright; above 1 it takes both; above √2 there is none.
    pub threshold: f32,
    /// Display-referred RGB, a factor on the surface's colour as all of the ramp's.
    pub color: Vec3,
}

impl Ramp2d {
    /// The same bands for both lights, without their highlight, and no corner.
    pub fn from_bands(bands: &Bands) -> Result<Self, ToonError> {
        let ramp = Ramp::from_bands(bands)?;
        let ramps = Self { a: ramp.clone(), b: ramp, corner: None };
        ramps.validate()?;
        Ok(ramps)
    }

    /// Which rule is broken, if one is; the first found.
    pub fn validate(&self) -> Result<(), ToonError> {
        for ramp in [&self.a, &self.b] {
            ramp.validate()?;
            // One stop alone is everywhere.
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

/// The shade at `uv`, the reach of the first and of the second light ([`crate::painter::toon_painter_uv`]), of any
/// value: below 0 is dark, above 1 as bright as it gets.
///
/// `widths` are the changes of u and v across the pixel; each ramp is antialiased by its own, and the corner by the
/// most that its distance can change. Where one step is in a pixel, its share is exact. Where two cross, be they of
/// two ramps or a ramp's and the corner's, the lighter of two means is not the mean of the lighter ones, nor a
/// product of shares the share of both; and the corner's border may be wider than a pixel where u and v change in
/// different directions.
pub fn toon_ramp_2d(ramps: &Ramp2d, uv: DVec2, widths: DVec2) -> DVec3 {
    let shade = toon_ramp(&ramps.a, uv.x, widths.x).max(toon_ramp(&ramps.b, uv.y, widths.y));
    let Some(corner) = ramps.corner else { return shade };
    let inside = toon_corner(uv, widths, f64::from(corner.threshold));
    shade * (1.0 - inside) + corner.color.as_dvec3() * inside
}

/// The share of a pixel, 0..=1, that is in the corner: where |uv|, each clamped to 0..=1, reaches `threshold`. What is
/// clamped changes no more, and takes no part in the border's width.
pub fn toon_corner(uv: DVec2, widths: DVec2, threshold: f64) -> f64 {
    let reach = DVec2::new(saturate(uv.x), saturate(uv.y));
    let length = reach.length();
    let moving = DVec2::select(uv.cmplt(DVec2::ONE), widths, DVec2::ZERO);
    let width = if length > 0.0 { reach.dot(moving) / length } else { 0.0 };
    toon_coverage(length, threshold, width)
}

/// A 2D ramp as an image. u goes right and v down, both from 0 to 1; sampling is that of [`crate::row`] on each axis.
#[derive(Clone, Debug, PartialEq)]
pub struct RampTable {
    /// Columns and rows, neither 0.
    pub size: UVec2,
    /// Row by row, from the top left, which is the dark corner.
    pub texels: Vec<[u8; 4]>,
    /// Between the texels' centres.
    pub filter: TexelFilter,
}

impl RampTable {
    /// The shades at the texels' centres, clamped to 0..=1 and rounded to 8 bits.
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

    /// Refuses an image without texels, and one with another number of them than its size says.
    pub fn validate(&self) -> Result<(), ToonError> {
        let (width, height, texels) = (self.size.x, self.size.y, self.texels.len());
        let area = u64::from(width) * u64::from(height);
        if area > 0 && area == texels as u64 { Ok(()) } else { Err(ToonError::Texels { width, height, texels }) }
    }
}

/// The image's colour at `uv`, without its alpha.
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
            let corners = [(down.left, across.left), (down.left, across.right)];
            let below = [(down.right, across.left), (down.right, across.right)];
            let [[upper_left, upper_right], [lower_left, lower_right]] =
                [corners, below].map(|row| row.map(|(y, x)| color(x, y)));
            toon_table_mix(upper_left, upper_right, lower_left, lower_right, across.share, down.share)
        }
    }
}

/// Four texels by the shares of the right and of the lower ones.
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
    /// For the first light.
    pub a: RampUniform,
    /// For the second.
    pub b: RampUniform,
    /// The corner's colour, and its threshold: 10,000, which nothing reaches, where there is none.
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

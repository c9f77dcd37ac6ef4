//! 1D ramps: light in, colour out.
//!
//! A ramp is looked up with N·L, with what [`crate::half_lambert`] makes of it, or with anything else that says how
//! much light there is; its stops' positions are in the same unit. [`crate::Bands`] are a hard ramp
//! ([`Ramp::from_bands`]); as an image there is [`crate::row`].
//!
//! Lake 2000 and the simplest painter of the cartoon renderer read such a ramp from a 1D texture, whose filter
//! antialiases the steps (over a part of a texel, wide or narrow as the surface lies). Computed from stops a hard step
//! is antialiased over one pixel, everywhere.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

use crate::error::is_color;
use crate::light::saturate;
use crate::{Bands, ToonError, toon_coverage};

/// How many stops a [`RampUniform`] holds.
pub const MAX_STOPS: usize = 8;

/// The name of the override in [`crate::WGSL`] that says how many stops `toon_ramp` looks at: 1..=[`MAX_STOPS`], at
/// least as many as any ramp has, by default all. Like [`crate::TOON_BANDS_OVERRIDE`] it makes a shader faster, and
/// changes nothing else.
pub const TOON_STOPS_OVERRIDE: &str = "toon_stops";

/// Finite, so that the shader meets no infinity; beyond the reach of any border's ramp.
const UNREACHED: f32 = 1e4;

/// A colour at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RampStop {
    /// Where, in the unit that the ramp is looked up with.
    pub at: f32,
    /// Display-referred RGB, a factor on the surface's colour.
    pub color: Vec3,
}

/// What is between two stops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum RampBlend {
    /// The first one's colour, up to the second.
    #[default]
    Hard,
    /// From the one to the other, linear in display space.
    Smooth,
}

/// Colours by light. Below the first stop is the first colour, above the last the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Ramp {
    /// Strictly ascending; at least one. A value equal to a stop's position has its colour.
    pub stops: Vec<RampStop>,
    /// What is between them.
    pub blend: RampBlend,
}

impl Ramp {
    /// The bands as a hard ramp over N·L, without their highlight. Its first stop is at -1, or 1 below the first
    /// threshold if that is lower.
    pub fn from_bands(bands: &Bands) -> Result<Self, ToonError> {
        bands.validate()?;
        let first = bands.thresholds.first().map_or(-1.0, |&threshold| (threshold - 1.0).min(-1.0));
        let places = std::iter::once(first).chain(bands.thresholds.iter().copied());
        let stops = places.zip(&bands.tones).map(|(at, &color)| RampStop { at, color }).collect();
        let ramp = Self { stops, blend: RampBlend::Hard };
        ramp.validate()?;
        Ok(ramp)
    }

    /// Which rule is broken, if one is; the first found.
    pub fn validate(&self) -> Result<(), ToonError> {
        if self.stops.is_empty() {
            return Err(ToonError::NoStops);
        }
        for (index, &RampStop { at: value, color }) in self.stops.iter().enumerate() {
            if !value.is_finite() {
                return Err(ToonError::StopNotFinite { index, value });
            }
            if index > 0 && value <= self.stops[index - 1].at {
                return Err(ToonError::StopOrder { index, value, before: self.stops[index - 1].at });
            }
            if !is_color(color) {
                return Err(ToonError::StopColor { index, value: color });
            }
        }
        Ok(())
    }
}

/// The ramp's colour at `x`.
///
/// A hard ramp gives the mean over a pixel across which `x` changes linearly by `width`, as [`crate::toon_band_smooth`]
/// does; width 0 is the colour at the pixel's centre. A smooth ramp has no borders, and takes no notice of `width`.
/// Not a number counts as dark.
///
/// ```
/// use glam::{DVec3, Vec3};
/// use npr_toon::ramp::{Ramp, RampBlend, RampStop, toon_ramp};
/// let stops = vec![RampStop { at: 0.0, color: Vec3::ZERO }, RampStop { at: 0.5, color: Vec3::ONE }];
/// let mut ramp = Ramp { stops, blend: RampBlend::Hard };
/// ramp.validate()?;
/// assert_eq!(toon_ramp(&ramp, 0.25, 0.0), DVec3::ZERO);
/// assert_eq!(toon_ramp(&ramp, 0.5, 0.1), DVec3::splat(0.5));
/// ramp.blend = RampBlend::Smooth;
/// assert_eq!(toon_ramp(&ramp, 0.25, 0.0), DVec3::splat(0.5));
/// # Ok::<(), npr_toon::ToonError>(())
/// ```
pub fn toon_ramp(ramp: &Ramp, x: f64, width: f64) -> DVec3 {
    let mut color = DVec3::ZERO;
    // How much of the colour is this stop's or a later one's; all of it at the first.
    let mut share = 1.0;
    for (i, stop) in ramp.stops.iter().enumerate() {
        let above = match (ramp.stops.get(i + 1), ramp.blend) {
            (None, _) => 0.0,
            (Some(next), RampBlend::Hard) => toon_coverage(x, f64::from(next.at), width),
            (Some(next), RampBlend::Smooth) => {
                saturate((x - f64::from(stop.at)) / (f64::from(next.at) - f64::from(stop.at)))
            }
        };
        color += (share - above) * stop.color.as_dvec3();
        share = above;
    }
    color
}

/// `ToonRamp` of the WGSL, 144 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct RampUniform {
    /// The stops' colours and positions. Those that are not in use repeat the last colour, at 10,000, which nothing
    /// reaches.
    pub stops: [[f32; 4]; MAX_STOPS],
    /// 1: [`RampBlend::Smooth`].
    pub is_smooth: u32,
    /// Unused, 0.
    pub padding: [u32; 3],
}

impl RampUniform {
    /// Checks and packs `ramp`.
    pub fn new(ramp: &Ramp) -> Result<Self, ToonError> {
        ramp.validate()?;
        if ramp.stops.len() > MAX_STOPS {
            return Err(ToonError::TooManyStops { stops: ramp.stops.len(), max: MAX_STOPS });
        }
        let last = ramp.stops[ramp.stops.len() - 1];
        let mut stops = [last.color.extend(UNREACHED).to_array(); MAX_STOPS];
        for (to, from) in stops.iter_mut().zip(&ramp.stops) {
            *to = from.color.extend(from.at).to_array();
        }
        Ok(Self { stops, is_smooth: u32::from(ramp.blend == RampBlend::Smooth), padding: [0; 3] })
    }
}

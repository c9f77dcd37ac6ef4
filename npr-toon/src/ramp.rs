//! 1D colour ramps over a diffuse term.
//!
//! A ramp is evaluated at N·L, at the result of [`crate::half_lambert`], or at any other scalar; the positions of its stops
//! are in the same unit. [`crate::Bands`] are a hard ramp ([`Ramp::from_bands`]). [`crate::row`] reads ramps from images.
//!
//! Lake et al. 2000 and the simplest painter of *The Evolution of a Cartoon Renderer* read such a ramp from a 1D texture.
//! Texture filtering then antialiases a step over a fraction of a texel, whose width in pixels depends on the surface.
//! Ramps that are computed from stops are antialiased over one pixel.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

use crate::error::is_color;
use crate::light::saturate;
use crate::{Bands, ToonError, toon_coverage};

/// The maximum number of stops of a [`RampUniform`].
pub const MAX_STOPS: usize = 8;

/// The name of the override in [`crate::WGSL`] for the number of stops that `toon_ramp` reads: 1..=[`MAX_STOPS`] and at
/// least the number of stops of any ramp. The default is [`MAX_STOPS`]. A smaller value only makes the shader faster, like
/// [`crate::TOON_BANDS_OVERRIDE`].
pub const TOON_STOPS_OVERRIDE: &str = "toon_stops";

/// The position of unused stops in the uniform: finite, and above any value that a ramp is evaluated at.
const UNUSED_POSITION: f32 = 1e4;

/// A colour at a position of a ramp.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case", deny_unknown_fields))]
pub struct RampStop {
    /// The position, in the unit of the ramp's argument.
    pub at: f32,
    /// A display-referred RGB factor on the surface's colour.
    pub color: Vec3,
}

/// The interpolation between two stops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum RampBlend {
    /// The colour of the lower stop, up to the next stop.
    #[default]
    Hard,
    /// Linear interpolation in display-referred values.
    Smooth,
}

/// A colour ramp. Below the first stop it has the colour of the first stop, above the last stop that of the last.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case", deny_unknown_fields))]
pub struct Ramp {
    /// The stops in strictly ascending order, at least one. A value equal to a stop's position has that stop's colour.
    pub stops: Vec<RampStop>,
    /// The interpolation between stops.
    #[cfg_attr(feature = "serde", serde(default))]
    pub blend: RampBlend,
}

impl Ramp {
    /// The bands as a hard ramp over N·L, without the highlight, of factors on the surface's colour. The first stop is at -1, or at 1 below the first threshold
    /// if the first threshold is negative.
    pub fn from_bands(bands: &Bands) -> Result<Self, ToonError> {
        bands.validate()?;
        let first = bands.thresholds.first().map_or(-1.0, |&threshold| (threshold - 1.0).min(-1.0));
        let positions = std::iter::once(first).chain(bands.thresholds.iter().copied());
        let stops = positions.zip(&bands.tones).map(|(at, &color)| RampStop { at, color }).collect();
        let ramp = Self { stops, blend: RampBlend::Hard };
        ramp.validate()?;
        Ok(ramp)
    }

    /// Checks all fields and returns the first violation.
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
/// For a hard ramp, the mean over a pixel across which `x` changes linearly by `width`, as for
/// [`crate::toon_band`]; width 0 gives the colour at the pixel's centre. A smooth ramp has no borders and ignores
/// `width`. NaN gives the colour of the first stop.
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
    // The total weight of this stop and all later stops; 1 for the first.
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
    /// The colours and positions of the stops. Unused entries repeat the last colour at position 10,000.
    pub stops: [[f32; 4]; MAX_STOPS],
    /// 1 for [`RampBlend::Smooth`], else 0.
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
        let mut stops = [last.color.extend(UNUSED_POSITION).to_array(); MAX_STOPS];
        for (to, from) in stops.iter_mut().zip(&ramp.stops) {
            *to = from.color.extend(from.at).to_array();
        }
        Ok(Self { stops, is_smooth: u32::from(ramp.blend == RampBlend::Smooth), padding: [0; 3] })
    }
}

//! Lights, and several of them taken as one.
//!
//! Brightness and colour are apart, because they act apart: brightness moves borders ([`crate::painter`]), colour does
//! not. There is no falloff with distance: neither of the papers has one, and a step that fades is none.

use glam::{DVec3, Vec3};

use crate::ToonError;
use crate::error::is_color;

/// Where a light is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightPlace {
    /// Far away: its direction is the same everywhere.
    Directional {
        /// From the surface to the light, of any length but zero.
        to_light: Vec3,
    },
    /// At a point.
    Positional {
        /// In the space of the surface's points.
        position: Vec3,
    },
}

/// One light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it is.
    pub place: LightPlace,
    /// Display-referred RGB, a factor on what the light falls on.
    pub color: Vec3,
    /// 1 is full, 0 is off; above 1 it reaches further around.
    pub brightness: f32,
}

impl Light {
    /// A white light of full brightness from a direction.
    pub fn directional(to_light: Vec3) -> Self {
        Self { place: LightPlace::Directional { to_light }, color: Vec3::ONE, brightness: 1.0 }
    }

    /// A white light of full brightness at a point.
    pub fn positional(position: Vec3) -> Self {
        Self { place: LightPlace::Positional { position }, color: Vec3::ONE, brightness: 1.0 }
    }
}

/// Refuses directions of no length, and what is negative or not finite, or whose square is not; the first found.
pub fn validate(lights: &[Light]) -> Result<(), ToonError> {
    for (index, light) in lights.iter().enumerate() {
        match light.place {
            LightPlace::Directional { to_light: value } => {
                // What a shader can normalise, too: see `toon_unit`.
                let squared = value.length_squared();
                if squared < 1e-30 || !squared.is_finite() {
                    return Err(ToonError::LightDirection { index, value });
                }
            }
            LightPlace::Positional { position: value } => {
                // So far away the shader's light would go out.
                if !value.length_squared().is_finite() {
                    return Err(ToonError::LightPosition { index, value });
                }
            }
        }
        if !is_color(light.color) {
            return Err(ToonError::LightColor { index, value: light.color });
        }
        if !(light.brightness >= 0.0 && light.brightness.is_finite()) {
            return Err(ToonError::LightBrightness { index, value: light.brightness });
        }
    }
    Ok(())
}

/// The unit vector from a point to a light; zero at the light's own position.
pub fn toon_to_light(place: LightPlace, at: DVec3) -> DVec3 {
    match place {
        LightPlace::Directional { to_light } => to_light.as_dvec3(),
        LightPlace::Positional { position } => position.as_dvec3() - at,
    }
    .normalize_or_zero()
}

/// One colour for all lights: the mean of theirs, each by its brightness. White where none is bright.
///
/// The cartoon renderer multiplies with one colour, since two colours that change places across a surface "create a
/// gradient that spoils the stepped shading", but does not say how it combines them. The mean, because: one light, or
/// several of one colour, keep it; it is no brighter than its lights, as brightness has acted on the
/// border's place already; it does not depend on the lights' order; and a light that fades out leaves no jump.
pub fn combined_color(lights: &[Light]) -> DVec3 {
    let brightness: f64 = lights.iter().map(|light| f64::from(light.brightness)).sum();
    if brightness > 0.0 {
        let sum: DVec3 = lights.iter().map(|light| light.color.as_dvec3() * f64::from(light.brightness)).sum();
        sum / brightness
    } else {
        DVec3::ONE
    }
}

/// Several lights as one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aggregate {
    /// Unit vector to the light; zero where the lights cancel out.
    pub to_light: DVec3,
    /// 0 where they cancel out, the sum of theirs where they come from one direction.
    pub brightness: f64,
    /// [`combined_color`].
    pub color: DVec3,
}

/// The one light that stands for all of them at a point, for instance an object's centre, so that it is one for all
/// of the object (Half-Life, after Card & Mitchell).
///
/// It is the sum A of the lights' directions, each by its brightness b. For light that is not clamped at zero, such as
/// [`crate::half_lambert`], nothing is lost by it: Σ b (N·L) = N·A for every normal. How the sum was formed is not said
/// in the chapter; this is the one for which that holds.
pub fn aggregate(lights: &[Light], at: DVec3) -> Aggregate {
    let sum: DVec3 = lights.iter().map(|l| toon_to_light(l.place, at) * f64::from(l.brightness)).sum();
    Aggregate { to_light: sum.normalize_or_zero(), brightness: sum.length(), color: combined_color(lights) }
}

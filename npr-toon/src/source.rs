//! Lights, and the aggregate of several lights.
//!
//! Brightness and colour are separate parameters because they have different effects: brightness moves the borders between
//! tones ([`crate::painter`]), colour does not. There is no falloff with distance, as in both sources.

use glam::{DVec3, Vec3};

use crate::ToonError;
use crate::error::is_color;

/// The direction or position of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case", rename_all_fields = "kebab-case", deny_unknown_fields))]
pub enum LightKind {
    /// A light at infinite distance.
    Directional {
        /// The direction from the surface to the light, of any non-zero length.
        to_light: Vec3,
    },
    /// A point light.
    Positional {
        /// Its position, in the space of the surface points.
        position: Vec3,
    },
}

/// A light.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case", deny_unknown_fields))]
pub struct Light {
    /// Its direction or position.
    pub place: LightKind,
    /// A display-referred RGB factor on the colours of lit surfaces.
    pub color: Vec3,
    /// The factor on N·L, finite and not negative; 0 switches the light off.
    pub brightness: f32,
}

impl Light {
    /// A white directional light of brightness 1.
    pub fn directional(to_light: Vec3) -> Self {
        Self { place: LightKind::Directional { to_light }, color: Vec3::ONE, brightness: 1.0 }
    }

    /// A white point light of brightness 1.
    pub fn positional(position: Vec3) -> Self {
        Self { place: LightKind::Positional { position }, color: Vec3::ONE, brightness: 1.0 }
    }
}

/// Checks all lights and returns the first violation: a direction that f32 cannot normalise, a position whose squared
/// length overflows f32, or a negative or non-finite colour or brightness.
pub fn validate(lights: &[Light]) -> Result<(), ToonError> {
    for (index, light) in lights.iter().enumerate() {
        match light.place {
            LightKind::Directional { to_light: value } => {
                // The bounds of `toon_unit` in the shader.
                let squared = value.length_squared();
                if squared < 1e-30 || !squared.is_finite() {
                    return Err(ToonError::LightDirection { index, value });
                }
            }
            LightKind::Positional { position: value } => {
                // The squared distance would overflow in the shader's f32 normalisation.
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

/// The unit vector from `position` to a light; zero at the position of a point light.
pub fn toon_to_light(light: LightKind, position: DVec3) -> DVec3 {
    match light {
        LightKind::Directional { to_light } => to_light.as_dvec3(),
        LightKind::Positional { position: light } => light.as_dvec3() - position,
    }
    .normalize_or_zero()
}

/// The common colour of several lights: the mean of their colours weighted by brightness. White if all are off.
///
/// *The Evolution of a Cartoon Renderer* multiplies by one colour, since two colours that vary across a surface "create a
/// gradient that spoils the stepped shading", but does not define the combination. The weighted mean keeps the colour of
/// a single light and of several lights of equal colour, is no brighter than its lights (brightness has already moved the
/// borders), does not depend on the order of the lights, and is continuous as a light fades out.
pub fn combined_color(lights: &[Light]) -> DVec3 {
    let brightness: f64 = lights.iter().map(|light| f64::from(light.brightness)).sum();
    if brightness > 0.0 {
        let sum: DVec3 = lights.iter().map(|light| light.color.as_dvec3() * f64::from(light.brightness)).sum();
        sum / brightness
    } else {
        DVec3::ONE
    }
}

/// One light that replaces several lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aggregate {
    /// The unit vector to the light; zero where the lights cancel.
    pub to_light: DVec3,
    /// The length of the sum of the unit vectors to the lights, each times its brightness.
    pub brightness: f64,
    /// The [`combined_color`] of the lights.
    pub color: DVec3,
}

/// The aggregate of several lights at one position, for instance the centre of an object (*Half-Life*, after Card &
/// Mitchell 2002, section "Gooch Lighting").
///
/// It is the sum A of the unit vectors to the lights, each times its brightness b. For a diffuse term that is not clamped
/// at zero, such as [`crate::half_lambert`], this is exact: Σ b (N·L) = N·A for every normal. Card & Mitchell do not state
/// how the sum is formed.
pub fn aggregate(lights: &[Light], position: DVec3) -> Aggregate {
    let sum: DVec3 = lights.iter().map(|l| toon_to_light(l.place, position) * f64::from(l.brightness)).sum();
    Aggregate { to_light: sum.normalize_or_zero(), brightness: sum.length(), color: combined_color(lights) }
}

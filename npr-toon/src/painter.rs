//! The painter of *The Evolution of a Cartoon Renderer* (listings 1 and 2): two lights, a 2D ramp, one light colour.
//!
//! 1. u and v are the diffuse terms of the first and the second light ([`toon_painter_uv`]): N·L times the brightness of
//!    the light, so that the lit area of a brighter light is larger. The listing scales the light vectors before the
//!    vertex shader; the product is the same.
//! 2. The ramp is evaluated at (u, v): [`crate::table::toon_ramp_2d`], or [`crate::table::toon_table`] from an image.
//! 3. The result is multiplied by the material's colour or a texture, selected by the material's alpha
//!    ([`toon_material`]).
//! 4. The result is multiplied by the common colour of the lights ([`crate::source::combined_color`]) and by 1.5
//!    ([`toon_overbright`]).
//!
//! # Details that the listings leave open
//!
//! - u and v are not clamped in listing 2, −b..=b for a light of brightness b; the sampler clamps them. The ramps here are
//!   constant outside 0..=1, which is equivalent. Derivatives for borders must be taken of the unclamped values: those of
//!   clamped values would be too small next to the terminator.
//! - The lights of the listing are directional although their registers are called `LIGHT_POSITION`. Here both directional
//!   and positional lights are possible.
//! - The listing normalises the normal with a cube map of 8 bits per component, this module exactly.
//! - `c1` is defined as "black" and never read.
//! - For the combination of the two light colours and the layout of the ramp image see [`crate::source::combined_color`]
//!   and [`crate::table`].

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, DVec4};

use crate::light::saturate;
use crate::source::{self, Light, LightKind, combined_color, toon_to_light};
use crate::{ToonError, toon_n_dot_l};

/// The maximum number of lights: one per axis of a 2D ramp.
pub const MAX_LIGHTS: usize = 2;

/// The lights of a painter and the scale of their colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Painter {
    /// Up to [`MAX_LIGHTS`] lights. A missing light is equivalent to one of brightness 0.
    pub lights: Vec<Light>,
    /// The factor on the light colour, finite and not negative, before the product is doubled. The 0.75 of the listing
    /// gives 1.5 times the colour; 0.5 leaves the colour unchanged.
    pub light_scale: f32,
}

impl Painter {
    /// The light scale of listing 2, constant `c0`.
    pub const LIGHT_SCALE: f32 = 0.75;

    /// A painter with these lights and the light scale of the listing. Checks the lights.
    pub fn new(lights: Vec<Light>) -> Result<Self, ToonError> {
        let painter = Self { lights, light_scale: Self::LIGHT_SCALE };
        painter.validate()?;
        Ok(painter)
    }

    /// Checks all fields and returns the first violation.
    pub fn validate(&self) -> Result<(), ToonError> {
        if self.lights.len() > MAX_LIGHTS {
            return Err(ToonError::TooManyLights { lights: self.lights.len(), max: MAX_LIGHTS });
        }
        source::validate(&self.lights)?;
        if self.light_scale >= 0.0 && self.light_scale.is_finite() {
            Ok(())
        } else {
            Err(ToonError::LightScale { value: self.light_scale })
        }
    }
}

/// The diffuse term of a light: N·L times its brightness, not clamped.
pub fn toon_diffuse(n_dot_l: f64, brightness: f64) -> f64 {
    n_dot_l * brightness
}

/// The coordinates in the 2D ramp: the diffuse terms of the first and of the second light, 0 for a missing light.
///
/// `position` is the surface point, relevant for positional lights only. `normal` may have any length. The result is not
/// clamped.
pub fn toon_painter_uv(painter: &Painter, position: DVec3, normal: DVec3) -> DVec2 {
    let diffuse = |index: usize| {
        painter.lights.get(index).map_or(0.0, |light| {
            toon_diffuse(toon_n_dot_l(normal, toon_to_light(light.place, position)), f64::from(light.brightness))
        })
    };
    DVec2::new(diffuse(0), diffuse(1))
}

/// The surface's colour and alpha: those of the material where its alpha is above 1/2, else those of the texture (`cnd`
/// in listing 2).
pub fn toon_material(material: DVec4, texel: DVec4) -> DVec4 {
    if material.w > 0.5 { material } else { texel }
}

/// The product 2 · (light_scale · light_color) · color, clamped to 0..=1.
///
/// Listing 2 scales by 0.75 and doubles in its last instruction because shader constants could not exceed 1.
pub fn toon_overbright(color: DVec3, light_color: DVec3, light_scale: f64) -> DVec3 {
    let bright = color * (light_color * light_scale) * 2.0;
    DVec3::from_array(bright.to_array().map(saturate))
}

/// The colour and alpha of a pixel: the colour of the ramp times the material's colour times the common light colour.
pub fn toon_paint(painter: &Painter, shade: DVec3, material: DVec4) -> DVec4 {
    let light_color = combined_color(&painter.lights);
    toon_overbright(material.truncate() * shade, light_color, f64::from(painter.light_scale)).extend(material.w)
}

/// `ToonPainter` of the WGSL, 64 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct PainterUniform {
    /// The first light: the direction to it and 0, or its position and 1.
    pub light_a: [f32; 4],
    /// The second light, likewise.
    pub light_b: [f32; 4],
    /// The common colour of the lights, and the light scale.
    pub light_color: [f32; 4],
    /// The brightness of the first and of the second light; 0 for a missing light.
    pub brightness: [f32; 2],
    /// Unused, 0.
    pub padding: [u32; 2],
}

impl PainterUniform {
    /// Checks and packs `painter`.
    pub fn new(painter: &Painter) -> Result<Self, ToonError> {
        painter.validate()?;
        Ok(Self::unchecked(&painter.lights, painter.light_scale))
    }

    /// Packs the first two lights without validation. This admits lights that [`Painter::validate`] refuses, such as the
    /// zero direction of an aggregate of two lights that cancel.
    pub fn unchecked(lights: &[Light], light_scale: f32) -> Self {
        let place = |index: usize| match lights.get(index).map(|light| light.place) {
            Some(LightKind::Directional { to_light }) => to_light.extend(0.0).to_array(),
            Some(LightKind::Positional { position }) => position.extend(1.0).to_array(),
            None => [0.0; 4],
        };
        let brightness = |index: usize| lights.get(index).map_or(0.0, |light| light.brightness);
        Self {
            light_a: place(0),
            light_b: place(1),
            light_color: combined_color(lights).as_vec3().extend(light_scale).to_array(),
            brightness: [brightness(0), brightness(1)],
            padding: [0; 2],
        }
    }
}

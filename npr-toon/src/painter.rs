//! The painter of *The Evolution of a Cartoon Renderer* (listings 1 and 2): two lights, a 2D ramp, one light colour.
//!
//! 1. u and v are N·L of the first and the second light, each times the light's brightness ([`toon_painter_uv`]), so
//!    that a bright light reaches further around. The listing scales the light vectors before the vertex shader; the
//!    product is the same.
//! 2. The ramp's shade at (u, v): [`crate::table::toon_ramp_2d`], or [`crate::table::toon_table`] from an image.
//! 3. Times the material's colour or a texture, whichever the material's alpha says ([`toon_material`]).
//! 4. Times the lights' one colour ([`crate::source::combined_color`]), brightened by a half
//!    ([`toon_overbright`]).
//!
//! # What the listings leave open
//!
//! - u and v come out of listing 2 as they are, −b..=b for a light of brightness b, and the sampler clamps them. The
//!   ramps here change nowhere outside of 0..=1, which is the same. Derivatives for borders are taken of these: once
//!   clamped, they would be too small beside the terminator.
//! - The listing's lights are directional though their registers are called `LIGHT_POSITION`. Here both are possible.
//! - The normal is brought to unit length by a cube map of 8 bits a component; here exactly.
//! - `c1` is defined, "black", and never read.
//! - How the two colours combine, and how the shade is laid out: see [`crate::source::combined_color`] and
//!   [`crate::table`].

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, DVec4};

use crate::light::saturate;
use crate::source::{self, Light, LightPlace, combined_color, toon_to_light};
use crate::{ToonError, toon_n_dot_l};

/// How many lights a 2D ramp has axes for.
pub const MAX_LIGHTS: usize = 2;

/// Lights and how bright they make their colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Painter {
    /// Up to [`MAX_LIGHTS`]. A light that is not there is one of brightness 0.
    pub lights: Vec<Light>,
    /// What the light's colour is multiplied with before the product is doubled. The listing's 0.75 makes 1.5 times the
    /// colour; 0.5 leaves it as it is.
    pub light_scale: f32,
}

impl Painter {
    /// The light scale of listing 2, `c0`.
    pub const LIGHT_SCALE: f32 = 0.75;

    /// Checks the lights, and takes the listing's scale.
    pub fn new(lights: Vec<Light>) -> Result<Self, ToonError> {
        let painter = Self { lights, light_scale: Self::LIGHT_SCALE };
        painter.validate()?;
        Ok(painter)
    }

    /// Which rule is broken, if one is; the first found.
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

/// How far a light reaches: N·L times its brightness.
pub fn toon_reach(n_dot_l: f64, brightness: f64) -> f64 {
    n_dot_l * brightness
}

/// Where in the 2D ramp a point is, u from the first light and v from the second; 0 for a light that is not there.
///
/// `at` is the surface's point, which counts for positional lights only; `normal` need not be of unit length.
pub fn toon_painter_uv(painter: &Painter, at: DVec3, normal: DVec3) -> DVec2 {
    let reach = |index: usize| {
        painter.lights.get(index).map_or(0.0, |light| {
            toon_reach(toon_n_dot_l(normal, toon_to_light(light.place, at)), f64::from(light.brightness))
        })
    };
    DVec2::new(reach(0), reach(1))
}

/// The surface's own colour: the material's where its alpha is above 1/2, else the texture's (`cnd` in listing 2).
/// The alpha of what was chosen comes with it, as in the listing.
pub fn toon_material(material: DVec4, texel: DVec4) -> DVec4 {
    if material.w > 0.5 { material } else { texel }
}

/// `color` under a light of `light_color`: 2 · (light_scale · light_color) · color, clamped to 0..=1.
///
/// Listing 2 scales by 0.75 and doubles in the last instruction, since a constant of its time could not exceed 1.
pub fn toon_overbright(color: DVec3, light_color: DVec3, light_scale: f64) -> DVec3 {
    let bright = color * (light_color * light_scale) * 2.0;
    DVec3::from_array(bright.to_array().map(saturate))
}

/// The pixel's colour and alpha: the ramp's shade on the surface's own colour, under the lights' one colour.
pub fn toon_paint(painter: &Painter, shade: DVec3, material: DVec4) -> DVec4 {
    let light_color = combined_color(&painter.lights);
    toon_overbright(material.truncate() * shade, light_color, f64::from(painter.light_scale)).extend(material.w)
}

/// `ToonPainter` of the WGSL, 64 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct PainterUniform {
    /// A direction and 0, or a position and 1.
    pub place_a: [f32; 4],
    /// The same for the second light.
    pub place_b: [f32; 4],
    /// The lights' one colour, and the scale.
    pub light_color: [f32; 4],
    /// Of the first and the second light; 0 for one that is not there.
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

    /// Packs the first two lights as they are: also those that [`Painter::validate`] refuses, such as the direction of
    /// two lights that cancel out, which is zero.
    pub fn unchecked(lights: &[Light], light_scale: f32) -> Self {
        let place = |index: usize| match lights.get(index).map(|light| light.place) {
            Some(LightPlace::Directional { to_light }) => to_light.extend(0.0).to_array(),
            Some(LightPlace::Positional { position }) => position.extend(1.0).to_array(),
            None => [0.0; 4],
        };
        let brightness = |index: usize| lights.get(index).map_or(0.0, |light| light.brightness);
        Self {
            place_a: place(0),
            place_b: place(1),
            light_color: combined_color(lights).as_vec3().extend(light_scale).to_array(),
            brightness: [brightness(0), brightness(1)],
            padding: [0; 2],
        }
    }
}

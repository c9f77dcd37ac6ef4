//! What a shade is: its functions on the CPU, and what it gives to the shader of surfaces.

use crate::error::HarnessError;
use glam::{DVec2, DVec3, DVec4};
use npr_toon::painter::{Painter, toon_diffuse};
use npr_toon::source::Light;

/// The data of a scene and a view that shades read besides the lights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShadeView {
    /// The plane (n, d) of which n · p + d is the eye depth of a point p.
    pub eye_depth: DVec4,
    /// The eye depths between which the scene lies.
    pub depth_range: (f64, f64),
}

/// A point of a surface under the lights. World space; vectors of any length, the normal on the viewer's side.
#[derive(Clone, Copy)]
pub(crate) struct LitPoint {
    pub(crate) normal: DVec3,
    pub(crate) at: DVec3,
    pub(crate) to_eye: DVec3,
}

/// How far a function of the two numbers that a shade is looked up with changes within the pixel.
pub(crate) type Widths<'a> = dyn Fn(&dyn Fn(DVec2) -> DVec2) -> DVec2 + 'a;

/// A sample of a surface as a shade colours it.
pub(crate) struct Shading<'a> {
    /// The surface's own colour, display-referred.
    pub(crate) base: DVec3,
    /// Of all lights together.
    pub(crate) light_color: DVec3,
    /// What the shade is looked up with: the diffuse term and the second number, shadow included.
    pub(crate) light: DVec2,
    /// The normal, negated in shadow, of unit length.
    pub(crate) normal: &'a dyn Fn() -> DVec3,
    /// How far a function of `light` changes within the pixel.
    pub(crate) widths: &'a Widths<'a>,
}

/// What a shade gives the shader of surfaces.
pub(crate) struct ShadeOnDevice {
    /// Parts of the shader, by name: libraries first, then the shade's own functions. See `shade/unlit.wgsl` for those that
    /// a shade has.
    pub(crate) wgsl: &'static [(&'static str, &'static str)],
    /// Values of the shader's overrides.
    pub(crate) constants: Vec<(&'static str, f64)>,
    /// The uniform `shade`, whole vectors; empty if there is none.
    pub(crate) uniform: Vec<u8>,
    /// The texture `shade_image`, if it is read: width, height, and texels row by row, display-referred.
    pub(crate) image: Option<(u32, u32, Vec<[u8; 4]>)>,
    /// What brings colours of more than 1 into range ([`Painter::light_scale`]).
    pub(crate) light_scale: f32,
}

impl ShadeOnDevice {
    pub(crate) fn new(wgsl: &'static [(&'static str, &'static str)]) -> Self {
        Self { wgsl, constants: Vec::new(), uniform: Vec::new(), image: None, light_scale: Painter::LIGHT_SCALE }
    }
}

/// What a shade does, on the CPU in f64 and on a device. The functions of numbers have twins of the same name, with the
/// prefix `shade_`, in the shade's WGSL.
pub(crate) trait ShadeModel {
    /// Whether all numbers are in their ranges.
    fn validate(&self) -> Result<(), HarnessError>;

    /// How many lights it knows; more are replaced by the one that stands for them all.
    fn lights(&self) -> usize {
        1
    }

    /// Whether a material is its colour *or* its texture, whichever its colour's alpha says.
    fn material_by_alpha(&self) -> bool {
        false
    }

    /// Whether colours are normals, which no light changes.
    fn is_normals(&self) -> bool {
        false
    }

    /// The diffuse term.
    fn diffuse(&self, n_dot_l: f64, brightness: f64) -> f64 {
        toon_diffuse(n_dot_l, brightness)
    }

    /// The second number at a point. `to_light`: to the first light, of unit length.
    fn second(&self, _point: &LitPoint, _to_light: DVec3, _lights: &[Light], _view: &ShadeView) -> f64 {
        0.0
    }

    /// The vector at a vertex that is interpolated for [`Self::second_interpolated`].
    fn second_vector(&self, _point: &LitPoint, _lights: &[Light], _view: &ShadeView) -> DVec3 {
        DVec3::ZERO
    }

    /// The second number of vectors as they were interpolated.
    fn second_interpolated(
        &self,
        _normal: DVec3,
        _to_light: DVec3,
        _second: DVec3,
        _lights: &[Light],
        _view: &ShadeView,
    ) -> f64 {
        0.0
    }

    /// The second number in a cast shadow.
    fn second_in_shadow(&self, _second: f64) -> f64 {
        -1.0
    }

    /// The display-referred colour.
    fn color(&self, shading: &Shading<'_>) -> DVec3;

    /// Whether [`Self::second`] depends on the position, whatever the light.
    fn needs_position(&self) -> bool {
        false
    }

    /// Its shader, and what that needs for a view.
    fn on_device(&self, view: &ShadeView) -> Result<ShadeOnDevice, HarnessError>;
}

/// A WGSL boolean as the value of an override.
pub(crate) fn flag(flag: bool) -> f64 {
    f64::from(u8::from(flag))
}

//! The interface of a shade: its functions on the CPU, and its contributions to the surface shader.

use crate::error::HarnessError;
use glam::{DVec2, DVec3, DVec4};
use npr_toon::painter::{Painter, toon_diffuse};
use npr_toon::source::Light;

/// The data of a scene and a view that shades use in addition to the lights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShadeView {
    /// The plane (n, d) such that n · p + d is the eye depth of a point p.
    pub eye_depth: DVec4,
    /// The range of eye depth that the scene occupies.
    pub depth_range: (f64, f64),
}

/// A surface point to be lit. World space; vectors of any length, the normal on the viewer's side.
#[derive(Clone, Copy)]
pub(crate) struct LitPoint {
    pub(crate) normal: DVec3,
    pub(crate) at: DVec3,
    pub(crate) to_eye: DVec3,
}

/// Returns the change within the pixel of a function of the two lookup coordinates.
pub(crate) type Widths<'a> = dyn Fn(&dyn Fn(DVec2) -> DVec2) -> DVec2 + 'a;

/// The inputs for shading a surface sample.
pub(crate) struct Shading<'a> {
    /// The surface's unshaded colour, display-referred.
    pub(crate) base: DVec3,
    /// The combined colour of all lights.
    pub(crate) light_color: DVec3,
    /// The lookup coordinates, including shadow: the diffuse term and the second coordinate.
    pub(crate) light: DVec2,
    /// The normal, negated in shadow, of unit length.
    pub(crate) normal: &'a dyn Fn() -> DVec3,
    /// Returns the change of a function of `light` within the pixel.
    pub(crate) widths: &'a Widths<'a>,
}

/// A shade's contributions to the surface shader.
pub(crate) struct ShadeOnDevice {
    /// Parts of the shader, by name: libraries first, then the shade's own functions, which are listed in
    /// `shade/unlit.wgsl`.
    pub(crate) wgsl: &'static [(&'static str, &'static str)],
    /// The values of the shader's override constants.
    pub(crate) constants: Vec<(&'static str, f64)>,
    /// The uniform `shade`, padded to whole vectors; empty if there is none.
    pub(crate) uniform: Vec<u8>,
    /// The texture `shade_image`, if it is used: width, height, and display-referred texels in row order.
    pub(crate) image: Option<(u32, u32, Vec<[u8; 4]>)>,
    /// The factor that brings colours above 1 into range ([`Painter::light_scale`]).
    pub(crate) light_scale: f32,
}

impl ShadeOnDevice {
    pub(crate) fn new(wgsl: &'static [(&'static str, &'static str)]) -> Self {
        Self { wgsl, constants: Vec::new(), uniform: Vec::new(), image: None, light_scale: Painter::LIGHT_SCALE }
    }
}

/// The functions of a shade, on the CPU in f64 and on the GPU. The numeric functions have WGSL versions of the same
/// name with the prefix `shade_`.
pub(crate) trait ShadeModel {
    /// Checks that all numbers are within their ranges.
    fn validate(&self) -> Result<(), HarnessError>;

    /// The number of lights that the shade supports; more lights are replaced by one that approximates them.
    fn lights(&self) -> usize {
        1
    }

    /// Whether the shade takes two of its lights for each object.
    fn pairs_lights(&self) -> bool {
        false
    }

    /// Whether the alpha of a material's colour selects either the colour or the texture.
    fn material_by_alpha(&self) -> bool {
        false
    }

    /// Whether the colours encode normals, which lighting does not change.
    fn is_normals(&self) -> bool {
        false
    }

    /// Whether the colour of the surface itself is part of the picture.
    fn shows_surface_color(&self) -> bool {
        true
    }

    /// The diffuse term.
    fn diffuse(&self, n_dot_l: f64, brightness: f64) -> f64 {
        toon_diffuse(n_dot_l, brightness)
    }

    /// The second coordinate at a point. `to_light` is the unit vector to the first light.
    fn second(&self, _point: &LitPoint, _to_light: DVec3, _lights: &[Light], _view: &ShadeView) -> f64 {
        0.0
    }

    /// The vector at a vertex that is interpolated as an input for [`Self::second_interpolated`].
    fn second_vector(&self, _point: &LitPoint, _lights: &[Light], _view: &ShadeView) -> DVec3 {
        DVec3::ZERO
    }

    /// The second coordinate, computed from interpolated vectors.
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

    /// The second coordinate in a cast shadow.
    fn second_in_shadow(&self, _second: f64) -> f64 {
        -1.0
    }

    /// The display-referred colour.
    fn color(&self, shading: &Shading<'_>) -> DVec3;

    /// Whether [`Self::second`] depends on the position even with directional light.
    fn needs_position(&self) -> bool {
        false
    }

    /// The shader and its data for a view.
    fn on_device(&self, view: &ShadeView) -> Result<ShadeOnDevice, HarnessError>;
}

/// A WGSL boolean as the value of an override.
pub(crate) fn flag(flag: bool) -> f64 {
    f64::from(u8::from(flag))
}

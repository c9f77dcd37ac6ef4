//! How surfaces are painted by light: one file for each shade, with its table in a style's file, its function on the CPU,
//! and its shader and uniform on a device.
//!
//! A shade is looked up with two numbers. The first is the *diffuse term*, N·L times the light's brightness. The second
//! is the shade's own: N·H for a highlight, the diffuse term of a second light, R·E for Gooch's highlight. Adding a shade
//! takes its file here, a variant of [`Shade`], and a line in each of the lists below.

pub mod gooch;
pub mod lambert;
mod normals;
pub mod painter;
pub mod ramp;
mod ramp_table;
pub mod toon;
mod unlit;
pub mod x_toon;

use crate::error::HarnessError;
use crate::hatch::HatchShade;
use crate::hatch::schema::HatchTable;
use crate::schema::StyleFile;
use glam::{DVec2, DVec3, DVec4};
use lambert::Lambert;
use npr_gooch::Gooch;
use npr_toon::Bands;
use npr_toon::painter::{Painter, toon_diffuse};
use npr_toon::source::Light;
use painter::PainterShade;
use ramp::RampShade;
use serde::{Deserialize, Serialize};
use x_toon::XToon;

/// How surfaces are painted.
#[derive(Clone, Debug, PartialEq)]
pub enum Shade {
    /// Surfaces are not painted; only lines are drawn.
    Paper,
    /// Ambient and diffuse light without bands: the plain renderer that others are timed against.
    Lambert(Lambert),
    /// Bands of light.
    Toon(Bands),
    /// Any colours by light, from a 1D ramp.
    Ramp(RampShade),
    /// Two lights, each an axis of a 2D ramp.
    Painter(PainterShade),
    /// Bands that fade with depth or near the silhouette.
    XToon(XToon),
    /// From cool to warm.
    Gooch(Gooch),
    /// Strokes of a tonal art map.
    Hatch(HatchShade),
    /// World-space normals as colours, n / 2 + 1/2, negated in shadow: what Card & Mitchell 2002 filter (fig. 10b).
    Normals,
}

/// The table `[shade]` of a style's file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) enum ShadeTable {
    Paper,
    Normals,
    Lambert(lambert::LambertTable),
    Toon(toon::ToonTable),
    Ramp(ramp::RampTable),
    Painter(painter::PainterTable),
    XToon(x_toon::XToonTable),
    Gooch(gooch::GoochTable),
    Hatch(HatchTable),
}

impl ShadeTable {
    pub(crate) fn new(shade: &Shade) -> Self {
        match shade {
            Shade::Paper => Self::Paper,
            Shade::Normals => Self::Normals,
            Shade::Lambert(lambert) => Self::Lambert(lambert::LambertTable::new(*lambert)),
            Shade::Toon(bands) => Self::Toon(toon::ToonTable::new(bands)),
            Shade::Ramp(ramp) => Self::Ramp(ramp::RampTable::new(ramp)),
            Shade::Painter(painter) => Self::Painter(painter::PainterTable::new(painter)),
            Shade::XToon(x_toon) => Self::XToon(x_toon::XToonTable::new(x_toon)),
            Shade::Gooch(gooch) => Self::Gooch(gooch::GoochTable::new(gooch)),
            Shade::Hatch(hatch) => Self::Hatch(HatchTable::new(hatch)),
        }
    }

    pub(crate) fn shade(self, file: &StyleFile<'_>) -> Result<Shade, HarnessError> {
        Ok(match self {
            Self::Paper => Shade::Paper,
            Self::Normals => Shade::Normals,
            Self::Lambert(table) => Shade::Lambert(table.lambert()),
            Self::Toon(table) => Shade::Toon(table.bands()),
            Self::Ramp(table) => Shade::Ramp(table.ramp(file)?),
            Self::Painter(table) => Shade::Painter(table.painter(file)?),
            Self::XToon(table) => Shade::XToon(table.x_toon(file)?),
            Self::Gooch(table) => Shade::Gooch(table.gooch()),
            Self::Hatch(table) => Shade::Hatch(table.hatch(file)?),
        })
    }
}

impl Shade {
    /// What light makes of a surface's own colour. Paper and hatching take only the diffuse term from it.
    pub(crate) fn model(&self) -> &dyn ShadeModel {
        match self {
            Self::Paper | Self::Hatch(_) => &unlit::Unlit,
            Self::Lambert(lambert) => lambert,
            Self::Toon(bands) => bands,
            Self::Ramp(ramp) => ramp,
            Self::Painter(painter) => painter,
            Self::XToon(x_toon) => x_toon,
            Self::Gooch(gooch) => gooch,
            Self::Normals => &normals::Normals,
        }
    }

    pub(crate) fn validate(&self) -> Result<(), HarnessError> {
        match self {
            Self::Hatch(hatch) => hatch.validate(),
            other => other.model().validate(),
        }
    }
}

/// What shades know of a scene in a view besides its lights.
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
    pub(crate) widths: &'a dyn Fn(&dyn Fn(DVec2) -> DVec2) -> DVec2,
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

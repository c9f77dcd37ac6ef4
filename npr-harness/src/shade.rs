//! Shades: how surfaces are painted depending on light. There is one file for each shade, with its table in a style
//! file, its CPU function, and its shader and uniform for the GPU.
//!
//! A shade has two lookup coordinates. The first is the *diffuse term*, N·L times the light's brightness. The second
//! depends on the shade: N·H for a highlight, the diffuse term of a second light, R·E for Gooch's highlight. Adding a
//! shade takes a file here, a variant of [`Shade`], and a line in each of the lists below.

pub mod gooch;
pub mod lambert;
mod model;
mod normals;
pub mod painter;
pub mod ramp;
mod ramp_table;
pub mod toon;
mod unlit;
mod variants;
pub mod x_toon;

pub use model::ShadeView;
pub(crate) use model::{LitPoint, ShadeModel, ShadeOnDevice, Shading, flag};
pub(crate) use variants::VARIANTS;

use crate::error::HarnessError;
use crate::hatch::HatchShade;
use crate::hatch::schema::HatchTable;
use crate::schema::StyleFile;
use lambert::Lambert;
use npr_gooch::Gooch;
use npr_toon::Bands;
use painter::PainterShade;
use ramp::RampShade;
use serde::{Deserialize, Serialize};
use x_toon::XToon;

/// How surfaces are painted.
#[derive(Clone, Debug, PartialEq)]
pub enum Shade {
    /// Surfaces are not painted; only lines are drawn.
    Paper,
    /// Ambient and diffuse light without bands: the baseline for performance comparisons.
    Lambert(Lambert),
    /// Bands of light.
    Toon(Bands),
    /// Colours from a 1D ramp.
    Ramp(RampShade),
    /// Two lights, each mapped to an axis of a 2D ramp.
    Painter(PainterShade),
    /// Bands that fade with depth or near the silhouette.
    XToon(XToon),
    /// Gooch shading, from cool to warm.
    Gooch(Gooch),
    /// Strokes of a tonal art map.
    Hatch(HatchShade),
    /// World-space normals as colours, n / 2 + 1/2, negated in shadow: what Card & Mitchell 2002 filter (fig. 10b).
    Normals,
}

/// The table `[shade]` of a style file.
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
    /// The shading model. Paper and hatching use only its diffuse term.
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

//! What a picture looks like, whatever it shows.

mod file;
mod form;
mod hatch;
mod presets;

pub use file::StyleFileError;
pub(crate) use hatch::six_tones;
pub use hatch::{HatchEncoding, HatchGround, HatchMap, HatchMapping, HatchShade, HatchSource, HatchTransfer};
pub use presets::{style, styles};

use crate::error::HarnessError;
use crate::image_ink::ImageInk;
use crate::light::StyleLight;
use crate::shadow::{ShadowLines, ShadowStyle};
use glam::Vec3;
use npr_gooch::{Gooch, GoochUniform};
use npr_imagespace::composite::Composite;
use npr_outline::line_look::LineLook;
use npr_toon::half_lambert::HalfLambert;
use npr_toon::normal::NormalUse;
use npr_toon::painter::Painter;
use npr_toon::ramp::{Ramp, RampUniform};
use npr_toon::row::RampRow;
use npr_toon::table::{Ramp2d, Ramp2dUniform, RampTable};
use npr_toon::{Bands, ToonUniform};

/// How surfaces are painted.
#[derive(Clone, Debug, PartialEq)]
pub enum Shade {
    /// Not at all: paper, with only lines on it.
    Paper,
    /// Ambient and diffuse light without bands: the plain renderer that others are timed against.
    Lambert {
        /// What is left where no light falls, 0..=1.
        ambient: f32,
    },
    /// Bands of light.
    Toon(Bands),
    /// Any colours by light.
    Ramp(RampShade),
    /// Two lights, each an axis of a 2D ramp.
    Painter(PainterShade),
    /// From cool to warm.
    Gooch(Gooch),
    /// Strokes.
    Hatch(HatchShade),
    /// World-space normals as colours, n / 2 + 1/2, negated in shadow: what Card & Mitchell 2002 filter (fig. 10b).
    Normals,
}

/// A 1D ramp, and what it is looked up with.
#[derive(Clone, Debug, PartialEq)]
pub struct RampShade {
    /// The colours, factors on the surface's own.
    pub ramp: RampSource,
    /// What becomes of N·L first; without it the ramp is looked up with N·L itself.
    pub half_lambert: Option<HalfLambert>,
}

/// Where a 1D ramp's colours come from.
#[derive(Clone, Debug, PartialEq)]
pub enum RampSource {
    /// Computed from stops.
    Stops(Ramp),
    /// Read from a row of texels.
    Image(RampRow),
}

/// The cartoon renderer's painter, without its lights, which are the style's.
#[derive(Clone, Debug, PartialEq)]
pub struct PainterShade {
    /// The shades.
    pub ramp: Ramp2dSource,
    /// [`Painter::light_scale`].
    pub light_scale: f32,
    /// Whether a material is its colour *or* its texture, whichever its colour's alpha says
    /// ([`npr_toon::painter::toon_material`]), as in listing 2; else the product of both, as files mean it.
    pub material_by_alpha: bool,
}

/// Where a 2D ramp's shades come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Ramp2dSource {
    /// Computed from the stops of two ramps.
    Ramps(Ramp2d),
    /// Read from an image.
    Image(RampTable),
}

/// How lines are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lines {
    /// Screen-aligned, antialiased, hidden where their centreline is.
    Fins(LineLook),
    /// As Card & Mitchell printed them, to be compared with.
    Printed {
        /// Width far away, px.
        width_px: f32,
        /// Display-referred colour.
        ink: Vec3,
    },
    /// Found in the image.
    Image(ImageInk),
}

/// A style.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// What `--style` calls it.
    pub name: String,
    /// One line.
    pub about: String,
    /// Display-referred colour of what no surface covers.
    pub paper: Vec3,
    /// How surfaces are painted.
    pub shade: Shade,
    /// What becomes of a triangle's three normals.
    pub normals: NormalUse,
    /// One or two. What knows only one light takes the two together, see [`crate::light::lights_in_world`]. A light's
    /// brightness multiplies its N·L, and its colour the surface's; Gooch's tones take notice of neither.
    pub lights: Vec<StyleLight>,
    /// Whether the first light casts shadows, and how.
    pub shadow: Option<ShadowStyle>,
    /// How lines are drawn, if they are.
    pub lines: Option<Lines>,
    /// Edges whose faces meet at more than this angle are lines.
    pub crease_angle_rad: f32,
}

impl Style {
    /// Which rule is broken, if one is; the first found. What lines ask of a scene is checked by
    /// [`crate::plan::Plan::new`].
    ///
    /// # Errors
    /// [`HarnessError::Toon`], [`HarnessError::Gooch`], [`HarnessError::Hatch`], [`HarnessError::SixTones`],
    /// [`HarnessError::NoThresholds`], [`HarnessError::MapEffort`], [`HarnessError::ImageSpace`], [`HarnessError::Range`],
    /// [`HarnessError::NoLight`], [`HarnessError::NoShadow`].
    pub fn validate(&self) -> Result<(), HarnessError> {
        for component in self.paper.to_array() {
            within("a component of the paper", component, 0.0, 1.0, "0..=1")?;
        }
        within("a crease's angle", self.crease_angle_rad.to_degrees(), 0.0, 180.0, "0..=180 degrees")?;
        if self.lights.is_empty() {
            return Err(HarnessError::NoLight);
        }
        // The most that any shade knows.
        Painter::new(self.lights.iter().map(|light| light.light).collect())?;
        let (widths, what) = match &self.lines {
            Some(Lines::Fins(look)) => (&look.width_px[..], "a line's width"),
            Some(Lines::Printed { width_px, .. }) => (std::slice::from_ref(width_px), "a fin's width"),
            Some(Lines::Image(_)) | None => (&[][..], ""),
        };
        for &width_px in widths {
            // Wider ones take as long as there are pixels, each.
            within(what, width_px, 0.0, 256.0, "0..=256 px")?;
        }
        let ink = match &self.lines {
            Some(Lines::Fins(look)) => look.ink,
            Some(Lines::Printed { ink, .. }) => ink.extend(1.0).to_array(),
            Some(Lines::Image(ImageInk { composite: Composite::Over { color, opacity }, .. })) => {
                color.extend(*opacity).to_array()
            }
            Some(Lines::Image(_)) | None => [0.0; 4],
        };
        for component in ink {
            within("a component of the lines' ink", component, 0.0, 1.0, "0..=1")?;
        }
        if let Some(Lines::Image(ink)) = &self.lines {
            ink.validate()?;
            if let ShadowLines::Apart { composite: Composite::Over { color, opacity }, .. } = ink.shadows {
                for component in color.extend(opacity).to_array() {
                    within("a component of the ink of shadows", component, 0.0, 1.0, "0..=1")?;
                }
            }
        }
        match &self.shade {
            Shade::Paper | Shade::Normals => {}
            Shade::Lambert { ambient } => within("ambient light", *ambient, 0.0, 1.0, "0..=1")?,
            Shade::Toon(bands) => {
                ToonUniform::new(bands)?;
            }
            Shade::Ramp(RampShade { ramp, half_lambert }) => {
                half_lambert.map_or(Ok(()), |how| how.validate())?;
                match ramp {
                    RampSource::Stops(ramp) => {
                        RampUniform::new(ramp)?;
                    }
                    RampSource::Image(row) => row.validate()?,
                }
            }
            Shade::Painter(PainterShade { ramp, light_scale, .. }) => {
                Painter { lights: Vec::new(), light_scale: *light_scale }.validate()?;
                match ramp {
                    Ramp2dSource::Ramps(ramps) => {
                        Ramp2dUniform::new(ramps)?;
                    }
                    Ramp2dSource::Image(table) => table.validate()?,
                }
            }
            Shade::Gooch(model) => {
                GoochUniform::new(model)?;
            }
            Shade::Hatch(hatch) => hatch.validate()?,
        }
        if let Some(shadow) = &self.shadow {
            shadow.validate()?;
        } else if matches!(&self.lines, Some(Lines::Image(ink)) if ink.shadows != ShadowLines::None) {
            return Err(HarnessError::NoShadow { style: self.name.clone() });
        }
        Ok(())
    }
}

fn within(what: &'static str, value: f32, low: f32, high: f32, range: &'static str) -> Result<(), HarnessError> {
    if (low..=high).contains(&value) {
        Ok(())
    } else {
        Err(HarnessError::Range { what, value: f64::from(value), range })
    }
}

//! Styles: the appearance of a picture, independent of the scene.

mod file;
mod presets;
mod schema;

pub use presets::{style, styles};

use crate::error::HarnessError;
use crate::image_lines::ImageInk;
use crate::lights::StyleLight;
use crate::printed_fins::PrintedLines;
use crate::schema::{within, within_colors};
use crate::shade::Shade;
use crate::shadow::{ShadowLines, ShadowStyle};
use glam::Vec3;
use npr_outline::line_style::LineStyle;
use npr_toon::normal::NormalUse;
use npr_toon::painter::Painter;

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
    /// How the three normals of a triangle are used.
    pub normals: NormalUse,
    /// One or two. A shade that knows one light takes the two together, see [`crate::lights::lights_in_world`]. A light's
    /// brightness multiplies its N·L, and its colour the surface's; Gooch shading ignores both.
    pub lights: Vec<StyleLight>,
    /// Whether the first light casts shadows, and how.
    pub shadow: Option<ShadowStyle>,
    /// Which lines are drawn.
    pub lines: Lines,
    /// Edges whose faces meet at more than this angle are lines.
    pub crease_angle_rad: f32,
}

/// The lines of a style: any kinds, drawn over each other in the order in which they stand here.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lines {
    /// Fins as Card & Mitchell printed them, to be compared with.
    pub printed: Option<PrintedLines>,
    /// Lines along edges: screen-aligned, antialiased, hidden where their centreline is.
    pub edges: Option<LineStyle>,
    /// Lines found in the image.
    pub image: Option<ImageInk>,
}

impl Lines {
    /// No lines.
    pub const NONE: Self = Self { printed: None, edges: None, image: None };

    /// Lines along edges alone.
    pub fn edges(style: LineStyle) -> Self {
        Self { edges: Some(style), ..Self::NONE }
    }

    /// Lines found in the image alone.
    pub fn image(ink: ImageInk) -> Self {
        Self { image: Some(ink), ..Self::NONE }
    }

    /// Printed fins alone.
    pub fn printed(style: PrintedLines) -> Self {
        Self { printed: Some(style), ..Self::NONE }
    }
}

impl Style {
    /// Whether all numbers are in their ranges. What lines need of a scene is checked by [`crate::plan::Plan::new`].
    ///
    /// # Errors
    /// The first broken rule: [`HarnessError::Toon`], [`HarnessError::Gooch`], [`HarnessError::Hatch`],
    /// [`HarnessError::SixTones`], [`HarnessError::NoThresholds`], [`HarnessError::MapEffort`],
    /// [`HarnessError::ImageSpace`], [`HarnessError::Range`], [`HarnessError::NoLight`], [`HarnessError::NoShadow`].
    pub fn validate(&self) -> Result<(), HarnessError> {
        within_colors("a component of the paper", &self.paper.to_array())?;
        within("a crease's angle", self.crease_angle_rad.to_degrees(), 0.0, 180.0, "0..=180 degrees")?;
        if self.lights.is_empty() {
            return Err(HarnessError::NoLight);
        }
        // The most that any shade knows.
        Painter::new(self.lights.iter().map(|light| light.light).collect())?;
        let Lines { printed, edges, image } = &self.lines;
        printed.as_ref().map_or(Ok(()), PrintedLines::validate)?;
        edges.as_ref().map_or(Ok(()), crate::edge_lines::plan::validate)?;
        image.as_ref().map_or(Ok(()), ImageInk::validate)?;
        self.shade.validate()?;
        if let Some(shadow) = &self.shadow {
            shadow.validate()?;
        } else if image.is_some_and(|ink| ink.shadows != ShadowLines::None) {
            return Err(HarnessError::NoShadow { style: self.name.clone() });
        }
        Ok(())
    }
}

//! Styles: the appearance of a picture, independent of the scene.

mod file;
mod normals_key;
mod presets;
mod schema;

pub use presets::{style, styles};

use crate::error::HarnessError;
use crate::hull_lines::HullLines;
use crate::image_lines::ImageInk;
use crate::lights::StyleLight;
use crate::printed_fins::PrintedLines;
use crate::scene::MAX_LIGHTS;
use crate::schema::{within, within_colors};
use crate::shade::Shade;
use crate::shadow::{ShadowLines, ShadowStyle};
use glam::Vec3;
use npr_outline::line_style::LineStyle;
use npr_toon::normal::NormalUse;

/// A style.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// The name that `--style` accepts.
    pub name: String,
    /// A description of one line.
    pub about: String,
    /// The display-referred background colour.
    pub paper: Vec3,
    /// How surfaces are painted.
    pub shade: Shade,
    /// How the normals of a face are used.
    pub normals: NormalUse,
    /// Whether normals are used as they are in the vertex buffer, untransformed, as the listings of Card & Mitchell 2002
    /// have them. They are world space only where an object's transform is the identity.
    pub mesh_normals: bool,
    /// One to [`MAX_LIGHTS`] lights. A shade that supports one replaces several by an approximation, see
    /// [`crate::lights::lights_in_world`]; of more than two, the painter takes two for each object, see
    /// [`crate::lights::LightPair`]. A light's brightness multiplies its N·L, and its colour the surface's
    /// colour; Gooch shading ignores both.
    pub lights: Vec<StyleLight>,
    /// Whether the first light casts shadows, and how.
    pub shadow: Option<ShadowStyle>,
    /// Which lines are drawn.
    pub lines: Lines,
    /// Edges at which the surface turns by more than this angle are creases.
    pub crease_angle_rad: f32,
    /// Whether a file that says which edges are lines ([`npr_mesh::SideVisibility`]) decides instead of the crease angle,
    /// for edge lines.
    pub file_edges: bool,
}

/// The lines of a style. Any kinds can be combined; they are drawn over each other in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lines {
    /// Inverted hulls: displaced back faces in ink, hidden by surfaces and hiding what is drawn after them.
    pub hull: Option<HullLines>,
    /// Fins as printed in Card & Mitchell 2002, for comparison.
    pub printed: Option<PrintedLines>,
    /// Edge lines: screen-aligned, antialiased, hidden where their centreline is hidden.
    pub edges: Option<LineStyle>,
    /// Image-space lines.
    pub image: Option<ImageInk>,
}

impl Lines {
    /// No lines.
    pub const NONE: Self = Self { hull: None, printed: None, edges: None, image: None };

    /// Only edge lines.
    pub fn edges(style: LineStyle) -> Self {
        Self { edges: Some(style), ..Self::NONE }
    }

    /// Only image-space lines.
    pub fn image(ink: ImageInk) -> Self {
        Self { image: Some(ink), ..Self::NONE }
    }

    /// Only inverted hulls.
    pub fn hull(style: HullLines) -> Self {
        Self { hull: Some(style), ..Self::NONE }
    }

    /// Only printed fins.
    pub fn printed(style: PrintedLines) -> Self {
        Self { printed: Some(style), ..Self::NONE }
    }
}

impl Style {
    /// Checks that all numbers are within their ranges. [`crate::plan::Plan::new`] checks what lines require of a
    /// scene.
    ///
    /// # Errors
    /// The first broken rule: [`HarnessError::Toon`], [`HarnessError::Gooch`], [`HarnessError::Hatch`],
    /// [`HarnessError::SixTones`], [`HarnessError::NoThresholds`], [`HarnessError::MapEffort`],
    /// [`HarnessError::ImageSpace`], [`HarnessError::Range`], [`HarnessError::NoLight`],
    /// [`HarnessError::TooManyLights`], [`HarnessError::NoShadow`].
    pub fn validate(&self) -> Result<(), HarnessError> {
        within_colors("a component of the paper", &self.paper.to_array())?;
        within("a crease's angle", self.crease_angle_rad.to_degrees(), 0.0, 180.0, "0..=180 degrees")?;
        if self.lights.is_empty() {
            return Err(HarnessError::NoLight);
        }
        self.normals.validate()?;
        if self.lights.len() > MAX_LIGHTS {
            return Err(HarnessError::TooManyLights { lights: self.lights.len(), max: MAX_LIGHTS });
        }
        let lights: Vec<_> = self.lights.iter().map(|light| light.light).collect();
        npr_toon::source::validate(&lights)?;
        let Lines { hull, printed, edges, image } = &self.lines;
        hull.as_ref().map_or(Ok(()), HullLines::validate)?;
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

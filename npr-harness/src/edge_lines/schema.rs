//! The table `[lines.edges]` of a style file.

use crate::schema::Color;
use glam::Vec3;
use npr_outline::LineKind;
use npr_outline::line_style::{LineStyle, widths_px};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(crate) struct EdgesTable {
    silhouette_px: f32,
    boundary_px: f32,
    crease_px: f32,
    material_border_px: f32,
    /// Lines that the file draws; as creases without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    authored_px: Option<f32>,
    ink: Color,
    opacity: f32,
}

/// The settings of the style `cartoon`, except for borders between materials.
impl Default for EdgesTable {
    fn default() -> Self {
        let style = LineStyle { width_px: widths_px(2.0, 2.0, 1.3, 0.0), ink: super::plan::INK };
        Self { authored_px: None, ..Self::new(&style) }
    }
}

impl EdgesTable {
    pub(crate) fn new(style: &LineStyle) -> Self {
        let width = |kind: LineKind| style.width_px[kind as usize];
        let [r, g, b, opacity] = style.ink;
        Self {
            silhouette_px: width(LineKind::Silhouette),
            boundary_px: width(LineKind::Boundary),
            crease_px: width(LineKind::Crease),
            material_border_px: width(LineKind::MaterialBorder),
            authored_px: Some(width(LineKind::Authored)),
            ink: Color(Vec3::new(r, g, b)),
            opacity,
        }
    }

    pub(crate) fn style(self) -> LineStyle {
        let mut width_px = widths_px(self.silhouette_px, self.boundary_px, self.crease_px, self.material_border_px);
        if let Some(authored_px) = self.authored_px {
            width_px[LineKind::Authored as usize] = authored_px;
        }
        LineStyle { width_px, ink: self.ink.0.extend(self.opacity).to_array() }
    }
}

//! The table `[lines.hull]` of a style file.

use super::plan::HullLines;
use crate::schema::Color;
use glam::Vec3;
use npr_outline::hull::HullNormals;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(crate) struct HullTable {
    width_px: f32,
    ink: Color,
    normals: NormalsName,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum NormalsName {
    Welded,
    Vertices,
}

impl Default for HullTable {
    fn default() -> Self {
        Self { width_px: 2.0, ink: Color(Vec3::ZERO), normals: NormalsName::Welded }
    }
}

impl HullTable {
    pub(crate) fn new(style: &HullLines) -> Self {
        let normals = match style.normals {
            HullNormals::Welded => NormalsName::Welded,
            HullNormals::Vertices => NormalsName::Vertices,
        };
        Self { width_px: style.width_px, ink: Color(style.ink), normals }
    }

    pub(crate) fn style(self) -> HullLines {
        let normals = match self.normals {
            NormalsName::Welded => HullNormals::Welded,
            NormalsName::Vertices => HullNormals::Vertices,
        };
        HullLines { width_px: self.width_px, ink: self.ink.0, normals }
    }
}

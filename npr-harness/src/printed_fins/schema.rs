//! The table `[lines.printed]` of a style file.

use super::plan::PrintedLines;
use crate::schema::Color;
use glam::Vec3;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(crate) struct PrintedTable {
    width_px: f32,
    ink: Color,
}

/// The settings of the style `printed-fins`.
impl Default for PrintedTable {
    fn default() -> Self {
        Self { width_px: 2.0, ink: Color(Vec3::ZERO) }
    }
}

impl PrintedTable {
    pub(crate) fn new(style: &PrintedLines) -> Self {
        Self { width_px: style.width_px, ink: Color(style.ink) }
    }

    pub(crate) fn style(self) -> PrintedLines {
        PrintedLines { width_px: self.width_px, ink: self.ink.0 }
    }
}

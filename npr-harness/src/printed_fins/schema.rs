//! The table `[lines.printed]` of a style file.

use super::plan::PrintedLines;
use crate::schema::Color;
use npr_outline::normal_format::NormalFormat;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(crate) struct PrintedTable {
    width_px: f32,
    ink: Color,
    depth: DepthName,
    reversed: bool,
    normals: NormalsName,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum DepthName {
    ClipZ,
    Eye,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum NormalsName {
    Float,
    Short,
    Byte,
    #[serde(rename = "octahedral-16")]
    Oct16,
    #[serde(rename = "octahedral-8")]
    Oct8,
}

/// The settings of the style `printed-fins`.
impl Default for PrintedTable {
    fn default() -> Self {
        Self::new(&PrintedLines::default())
    }
}

impl PrintedTable {
    pub(crate) fn new(style: &PrintedLines) -> Self {
        Self {
            width_px: style.width_px,
            ink: Color(style.ink),
            depth: if style.eye_depth { DepthName::Eye } else { DepthName::ClipZ },
            reversed: style.reversed,
            normals: match style.normals {
                NormalFormat::F32 => NormalsName::Float,
                NormalFormat::Snorm16 => NormalsName::Short,
                NormalFormat::Snorm8 => NormalsName::Byte,
                NormalFormat::Oct16 => NormalsName::Oct16,
                NormalFormat::Oct8 => NormalsName::Oct8,
            },
        }
    }

    pub(crate) fn style(self) -> PrintedLines {
        PrintedLines {
            width_px: self.width_px,
            ink: self.ink.0,
            eye_depth: matches!(self.depth, DepthName::Eye),
            reversed: self.reversed,
            normals: match self.normals {
                NormalsName::Float => NormalFormat::F32,
                NormalsName::Short => NormalFormat::Snorm16,
                NormalsName::Byte => NormalFormat::Snorm8,
                NormalsName::Oct16 => NormalFormat::Oct16,
                NormalsName::Oct8 => NormalFormat::Oct8,
            },
        }
    }
}

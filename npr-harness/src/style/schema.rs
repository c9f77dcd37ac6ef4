//! The serde schema of a style file.

use super::normals_key::NormalsKey;
use super::{Lines, Style};
use crate::edge_lines::schema::EdgesTable;
use crate::error::HarnessError;
use crate::hull_lines::schema::HullTable;
use crate::image_lines::schema::ImageTable;
use crate::lights::{LightFrame, StyleLight};
use crate::printed_fins::schema::PrintedTable;
use crate::schema::{Color, StyleFile, one, white};
use crate::shade::{Shade, ShadeTable};
use crate::shadow::schema::ShadowTable;
use glam::Vec3;
use npr_toon::Bands;
use npr_toon::normal::NormalUse;
use npr_toon::source::{Light, LightKind};
use serde::{Deserialize, Serialize};
use std::path::Path;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(super) struct StyleTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    about: String,
    paper: Color,
    crease_angle_deg: f32,
    file_edges: bool,
    normals: NormalsKey,
    normal_space: SpaceName,
    light: Vec<LightTable>,
    shade: ShadeTable,
    #[serde(skip_serializing_if = "Option::is_none")]
    shadow: Option<ShadowTable>,
    #[serde(skip_serializing_if = "LinesTable::is_empty")]
    lines: LinesTable,
}

impl Default for StyleTable {
    fn default() -> Self {
        Self {
            name: None,
            about: String::new(),
            paper: Color(Vec3::ONE),
            crease_angle_deg: 45.0,
            file_edges: true,
            normals: NormalsKey(NormalUse::PerPixel),
            normal_space: SpaceName::World,
            light: vec![LightTable::new(&StyleLight::KEY)],
            shade: ShadeTable::new(&Shade::Toon(Bands::default())),
            shadow: None,
            lines: LinesTable::default(),
        }
    }
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum SpaceName {
    World,
    Mesh,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct LightTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    direction: Option<[f32; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    position: Option<[f32; 3]>,
    #[serde(default)]
    frame: FrameName,
    #[serde(default = "white")]
    color: Color,
    #[serde(default = "one")]
    brightness: f32,
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum FrameName {
    #[default]
    View,
    World,
}

impl StyleTable {
    pub(super) fn new(style: &Style) -> Self {
        Self {
            name: Some(style.name.clone()),
            about: style.about.clone(),
            paper: Color(style.paper),
            crease_angle_deg: style.crease_angle_rad.to_degrees(),
            file_edges: style.file_edges,
            normals: NormalsKey(style.normals),
            normal_space: if style.mesh_normals { SpaceName::Mesh } else { SpaceName::World },
            light: style.lights.iter().map(LightTable::new).collect(),
            shade: ShadeTable::new(&style.shade),
            shadow: style.shadow.as_ref().map(ShadowTable::new),
            lines: LinesTable::new(&style.lines),
        }
    }

    /// `path` is that of the file; the paths of images are relative to it.
    pub(super) fn style(self, path: &Path) -> Result<Style, HarnessError> {
        let file = StyleFile { path };
        let lights = self.light.into_iter().enumerate().map(|(index, light)| light.light(index, &file));
        Ok(Style {
            name: self.name.unwrap_or_else(|| {
                path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
            }),
            about: self.about,
            paper: self.paper.0,
            shade: self.shade.shade(&file)?,
            normals: self.normals.0,
            mesh_normals: matches!(self.normal_space, SpaceName::Mesh),
            lights: lights.collect::<Result<_, _>>()?,
            shadow: self.shadow.map(ShadowTable::shadow).transpose().map_err(|what| file.wrong(what))?,
            lines: self.lines.lines().map_err(|what| file.wrong(what))?,
            crease_angle_rad: self.crease_angle_deg.to_radians(),
            file_edges: self.file_edges,
        })
    }
}

impl LightTable {
    fn new(StyleLight { light, frame }: &StyleLight) -> Self {
        let (direction, position) = match light.place {
            LightKind::Directional { to_light } => (Some(to_light.to_array()), None),
            LightKind::Positional { position } => (None, Some(position.to_array())),
        };
        let frame = match frame {
            LightFrame::View => FrameName::View,
            LightFrame::World => FrameName::World,
        };
        Self { direction, position, frame, color: Color(light.color), brightness: light.brightness }
    }

    fn light(self, index: usize, file: &StyleFile<'_>) -> Result<StyleLight, HarnessError> {
        let place = match (self.direction, self.position) {
            (Some(to_light), None) => LightKind::Directional { to_light: to_light.into() },
            (None, Some(position)) => LightKind::Positional { position: position.into() },
            _ => return Err(file.wrong(format!("light {index} needs either a direction or a position"))),
        };
        let frame = match self.frame {
            FrameName::View => LightFrame::View,
            FrameName::World => LightFrame::World,
        };
        Ok(StyleLight { light: Light { place, color: self.color.0, brightness: self.brightness }, frame })
    }
}

/// The table `[lines]`: any of its kinds, drawn over each other in this order.
#[derive(Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
struct LinesTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    hull: Option<HullTable>,
    #[serde(skip_serializing_if = "Option::is_none")]
    printed: Option<PrintedTable>,
    #[serde(skip_serializing_if = "Option::is_none")]
    edges: Option<EdgesTable>,
    #[serde(skip_serializing_if = "Option::is_none")]
    image: Option<ImageTable>,
}

impl LinesTable {
    fn is_empty(&self) -> bool {
        self.hull.is_none() && self.printed.is_none() && self.edges.is_none() && self.image.is_none()
    }

    fn new(lines: &Lines) -> Self {
        Self {
            hull: lines.hull.as_ref().map(HullTable::new),
            printed: lines.printed.as_ref().map(PrintedTable::new),
            edges: lines.edges.as_ref().map(EdgesTable::new),
            image: lines.image.as_ref().map(ImageTable::new),
        }
    }

    fn lines(self) -> Result<Lines, String> {
        Ok(Lines {
            hull: self.hull.map(HullTable::style),
            printed: self.printed.map(PrintedTable::style),
            edges: self.edges.map(EdgesTable::style),
            image: self.image.map(ImageTable::ink).transpose()?,
        })
    }
}

//! The table `[shade.hatch]` of a style file.

use super::style::{HatchEncoding, HatchGround, HatchMap, HatchMapping, HatchShade, HatchSource, HatchTransfer};
use crate::error::HarnessError;
use crate::schema::{Color, StyleFile};
use glam::Vec3;
use npr_hatch::{Placement, StrokeImage, TamParameters};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(crate) struct HatchTable {
    encoding: EncodingName,
    mapping: MappingName,
    ground: GroundName,
    ink: Color,
    tile: f32,
    texel_px: f32,
    /// The ambient term of the linear transfer.
    #[serde(skip_serializing_if = "Option::is_none")]
    ambient: Option<f32>,
    /// The brightness factor of listing 4.
    #[serde(skip_serializing_if = "Option::is_none")]
    brightness: Option<f32>,
    map: MapTable,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum EncodingName {
    SixTones,
    Thresholds,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum MappingName {
    Coordinates,
    Planes,
    Form,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum GroundName {
    Paper,
    Surface,
}

/// Either a file written by `npr tam`, or parameters for drawing a map; omitted ones are those of
/// [`TamParameters::default`].
#[derive(Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
struct MapTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<PathBuf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stroke: Option<PathBuf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    tones: Option<Vec<f32>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    side: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    seed: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    width_px: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    length: Option<[f32; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    angle_deg: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    jitter_deg: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bow: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    taper: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pressure: Option<[f32; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cross_from: Option<CrossValue>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cross_deg: Option<f32>,
    /// The number of candidates for each stroke; if omitted, the strokes are placed by a sequence.
    #[serde(skip_serializing_if = "Option::is_none")]
    candidates: Option<u32>,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "the number of a tone, or \"never\"")]
enum CrossValue {
    Tone(usize),
    Never(Never),
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Never {
    Never,
}

impl Default for HatchTable {
    fn default() -> Self {
        Self {
            encoding: EncodingName::Thresholds,
            mapping: MappingName::Form,
            ground: GroundName::Paper,
            ink: Color(Vec3::ZERO),
            tile: 0.5,
            texel_px: 1.0,
            ambient: None,
            brightness: None,
            map: MapTable::default(),
        }
    }
}

impl HatchTable {
    pub(crate) fn new(shade: &HatchShade) -> Self {
        let (ambient, brightness) = match shade.transfer {
            HatchTransfer::Linear { ambient } => (Some(ambient), None),
            HatchTransfer::Listing4 { brightness } => (None, Some(brightness)),
        };
        Self {
            encoding: match shade.encoding {
                HatchEncoding::SixTones => EncodingName::SixTones,
                HatchEncoding::Thresholds => EncodingName::Thresholds,
            },
            mapping: match shade.mapping {
                HatchMapping::Coordinates => MappingName::Coordinates,
                HatchMapping::Planes => MappingName::Planes,
                HatchMapping::Form => MappingName::Form,
            },
            ground: match shade.ground {
                HatchGround::Paper => GroundName::Paper,
                HatchGround::Surface => GroundName::Surface,
            },
            ink: Color(shade.ink),
            tile: shade.tile,
            texel_px: shade.texel_px,
            ambient,
            brightness,
            map: MapTable::new(shade.map.source()),
        }
    }

    pub(crate) fn hatch(self, style: &StyleFile<'_>) -> Result<HatchShade, HarnessError> {
        let transfer = match (self.ambient, self.brightness) {
            (None, Some(brightness)) => HatchTransfer::Listing4 { brightness },
            (ambient, None) => HatchTransfer::Linear { ambient: ambient.unwrap_or(0.0) },
            (Some(_), Some(_)) => {
                return Err(style.wrong("shade.hatch has either `ambient`, in proportion to light, or `brightness`"));
            }
        };
        Ok(HatchShade {
            map: self.map.map(style)?,
            encoding: match self.encoding {
                EncodingName::SixTones => HatchEncoding::SixTones,
                EncodingName::Thresholds => HatchEncoding::Thresholds,
            },
            mapping: match self.mapping {
                MappingName::Coordinates => HatchMapping::Coordinates,
                MappingName::Planes => HatchMapping::Planes,
                MappingName::Form => HatchMapping::Form,
            },
            transfer,
            tile: self.tile,
            texel_px: self.texel_px,
            ink: self.ink.0,
            ground: match self.ground {
                GroundName::Paper => HatchGround::Paper,
                GroundName::Surface => HatchGround::Surface,
            },
        })
    }
}

impl MapTable {
    fn new(source: &HatchSource) -> Self {
        match source {
            HatchSource::File { file, .. } => Self { file: Some(file.clone()), ..Self::default() },
            HatchSource::Parameters(parameters) => Self::of(parameters),
            HatchSource::Stroke { parameters, file, .. } => Self { stroke: Some(file.clone()), ..Self::of(parameters) },
        }
    }

    /// The parameters that differ from the defaults.
    fn of(parameters: &TamParameters) -> Self {
        let p = parameters.clone();
        let usual = TamParameters::default();
        Self {
            file: None,
            stroke: None,
            tones: (p.tones != usual.tones).then_some(p.tones),
            side: (p.side != usual.side).then_some(p.side),
            seed: (p.seed != usual.seed).then_some(p.seed),
            width_px: (p.width_px != usual.width_px).then_some(p.width_px),
            length: (p.length != usual.length).then_some(p.length),
            angle_deg: (p.angle_deg != usual.angle_deg).then_some(p.angle_deg),
            jitter_deg: (p.jitter_deg != usual.jitter_deg).then_some(p.jitter_deg),
            bow: (p.bow != usual.bow).then_some(p.bow),
            taper: (p.taper != usual.taper).then_some(p.taper),
            pressure: (p.pressure != usual.pressure).then_some(p.pressure),
            cross_from: (p.cross_from != usual.cross_from)
                .then(|| p.cross_from.map_or(CrossValue::Never(Never::Never), CrossValue::Tone)),
            cross_deg: (p.cross_deg != usual.cross_deg).then_some(p.cross_deg),
            candidates: match p.placement {
                Placement::BestOf { candidates } => Some(candidates),
                _ => None,
            },
        }
    }

    fn has_parameters(&self) -> bool {
        let Self { file: _, stroke, tones, side, seed, width_px, length, angle_deg, jitter_deg, .. } = self;
        let Self { bow, taper, pressure, cross_from, cross_deg, candidates, .. } = self;
        let first = [stroke.is_some(), tones.is_some(), side.is_some(), seed.is_some(), width_px.is_some()];
        let second = [length.is_some(), angle_deg.is_some(), jitter_deg.is_some(), bow.is_some(), taper.is_some()];
        let third = [pressure.is_some(), cross_from.is_some(), cross_deg.is_some(), candidates.is_some()];
        first.into_iter().chain(second).chain(third).any(|there| there)
    }

    fn map(self, style: &StyleFile<'_>) -> Result<HatchMap, HarnessError> {
        if let Some(file) = &self.file {
            if self.has_parameters() {
                return Err(style.wrong("shade.hatch.map has either a file or what a map is to be like"));
            }
            return HatchMap::read(&style.beside(file)).map_err(|error| style.rule(error));
        }
        let usual = TamParameters::default();
        let tones = self.tones.unwrap_or(usual.tones);
        // The default is the fourth of six tones, which a map with fewer tones may not have.
        let cross_from = usual.cross_from.filter(|&tone| tone < tones.len());
        let parameters = TamParameters {
            tones,
            side: self.side.unwrap_or(usual.side),
            seed: self.seed.unwrap_or(usual.seed),
            width_px: self.width_px.unwrap_or(usual.width_px),
            length: self.length.unwrap_or(usual.length),
            angle_deg: self.angle_deg.unwrap_or(usual.angle_deg),
            jitter_deg: self.jitter_deg.unwrap_or(usual.jitter_deg),
            bow: self.bow.unwrap_or(usual.bow),
            taper: self.taper.unwrap_or(usual.taper),
            pressure: self.pressure.unwrap_or(usual.pressure),
            cross_from: match self.cross_from {
                None => cross_from,
                Some(CrossValue::Tone(tone)) => Some(tone),
                Some(CrossValue::Never(Never::Never)) => None,
            },
            cross_deg: self.cross_deg.unwrap_or(usual.cross_deg),
            placement: self.candidates.map_or(usual.placement, |candidates| Placement::BestOf { candidates }),
        };
        let source = match self.stroke {
            None => HatchSource::Parameters(parameters),
            Some(file) => {
                let file = style.beside(&file);
                let stroke = StrokeImage::load(&file).map_err(|error| style.rule(error.into()))?;
                HatchSource::Stroke { parameters, file, stroke }
            }
        };
        Ok(HatchMap::new(source))
    }
}

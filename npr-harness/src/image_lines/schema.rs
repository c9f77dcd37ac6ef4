//! The table `[lines.image]` of a style file.

use super::gbuffer::schema::{GBufferTable, SharedKeys};
use super::style::{ImageInk, InkScale, Regions};
use crate::schema::{Color, black, one, yes};
use crate::shadow::ShadowLines;
use glam::IVec2;
use npr_imagespace::artist::ArtistRotation;
use npr_imagespace::composite::{AlphaTest, Composite};
use npr_imagespace::filter::fused::{DepthTest, FusedFilter, ShadowTest};
use npr_imagespace::format::texel::TexelLayout;
use npr_imagespace::morphology::disc::Disc;
use npr_imagespace::picture::Taps;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(crate) struct ImageTable {
    /// Whether normals are compared, and the cosine below which two differ.
    normals: bool,
    normal_cos: f32,
    depth: bool,
    depth_step: f32,
    depth_plain: bool,
    regions: RegionsName,
    taps: TapsValue,
    softness: f32,
    layout: LayoutName,
    artist: ArtistName,
    scale: ScaleName,
    shadows: ShadowsTable,
    #[serde(skip_serializing_if = "Option::is_none")]
    dilation: Option<DilationTable>,
    composite: CompositeTable,
    #[serde(skip_serializing_if = "Option::is_none")]
    gbuffer: Option<GBufferTable>,
}

impl Default for ImageTable {
    fn default() -> Self {
        Self::new(&ImageInk::default())
    }
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum RegionsName {
    None,
    One,
    Material,
    Mesh,
    Patch,
}

/// An arrangement, or the steps to two taps.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(untagged, expecting = "\"diagonal\", \"cross\", or two steps [[x, y], [x, y]] in px")]
enum TapsValue {
    Name(TapsName),
    Steps([[i32; 2]; 2]),
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum TapsName {
    Diagonal,
    Cross,
}

impl TapsValue {
    fn new(taps: Taps) -> Self {
        match taps {
            Taps::Diagonal => Self::Name(TapsName::Diagonal),
            Taps::Cross => Self::Name(TapsName::Cross),
            Taps::Steps(steps) => Self::Steps(steps.map(|step| step.to_array())),
        }
    }

    fn taps(self) -> Taps {
        match self {
            Self::Name(TapsName::Diagonal) => Taps::Diagonal,
            Self::Name(TapsName::Cross) => Taps::Cross,
            Self::Steps(steps) => Taps::Steps(steps.map(IVec2::from)),
        }
    }
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum LayoutName {
    #[serde(rename = "32-bit")]
    Narrow,
    #[serde(rename = "64-bit")]
    Wide,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(untagged, expecting = "true, false, \"per-pixel\", \"per-vertex\" or \"per-object\"")]
enum ArtistName {
    /// `true` is per pixel.
    Used(bool),
    Rotated(RotationName),
}

#[derive(Clone, Copy, Serialize, Deserialize)]
enum RotationName {
    #[serde(rename = "per-pixel")]
    Pixel,
    #[serde(rename = "per-vertex")]
    Vertex,
    #[serde(rename = "per-object")]
    Object,
}

impl ArtistName {
    fn new(rotation: Option<ArtistRotation>) -> Self {
        match rotation {
            None => Self::Used(false),
            Some(ArtistRotation::PerPixel) => Self::Used(true),
            Some(ArtistRotation::PerVertex) => Self::Rotated(RotationName::Vertex),
            Some(ArtistRotation::PerObject) => Self::Rotated(RotationName::Object),
        }
    }

    fn rotation(self) -> Option<ArtistRotation> {
        match self {
            Self::Used(used) => used.then_some(ArtistRotation::PerPixel),
            Self::Rotated(RotationName::Pixel) => Some(ArtistRotation::PerPixel),
            Self::Rotated(RotationName::Vertex) => Some(ArtistRotation::PerVertex),
            Self::Rotated(RotationName::Object) => Some(ArtistRotation::PerObject),
        }
    }
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ScaleName {
    Half,
    One,
    Double,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
enum ShadowsTable {
    None,
    Negated,
    Lines,
    Separate(SeparateTable),
}

/// Shadow lines with their own composite and dilation.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct SeparateTable {
    #[serde(skip_serializing_if = "Option::is_none")]
    dilation: Option<DilationTable>,
    composite: CompositeTable,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct DilationTable {
    radius_px: f32,
    #[serde(default = "yes")]
    antialias: bool,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
enum CompositeTable {
    Multiply,
    AlphaTested(AlphaTable),
    Over(OverTable),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct AlphaTable {
    less: bool,
    reference: u8,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct OverTable {
    #[serde(default = "black")]
    color: Color,
    #[serde(default = "one")]
    opacity: f32,
}

impl DilationTable {
    fn new(Disc { radius_px, antialias }: Disc) -> Self {
        Self { radius_px, antialias }
    }

    fn disc(self) -> Disc {
        Disc { radius_px: self.radius_px, antialias: self.antialias }
    }
}

impl CompositeTable {
    fn new(composite: Composite) -> Self {
        match composite {
            Composite::Multiply => Self::Multiply,
            Composite::AlphaTested(AlphaTest { less, reference }) => Self::AlphaTested(AlphaTable { less, reference }),
            Composite::Over { color, opacity } => Self::Over(OverTable { color: Color(color), opacity }),
        }
    }

    fn composite(self) -> Composite {
        match self {
            Self::Multiply => Composite::Multiply,
            Self::AlphaTested(AlphaTable { less, reference }) => Composite::AlphaTested(AlphaTest { less, reference }),
            Self::Over(OverTable { color, opacity }) => Composite::Over { color: color.0, opacity },
        }
    }
}

impl ImageTable {
    pub(crate) fn new(ink: &ImageInk) -> Self {
        let FusedFilter { mut normal_cos, mut depth, mut regions, mut taps, mut softness, .. } = ink.filter;
        if let Some(gbuffer) = &ink.gbuffer {
            let keys = SharedKeys::of(gbuffer);
            if !gbuffer.has_inker() {
                normal_cos = keys.normal_cos;
                depth = keys.depth_step.map(|step| DepthTest { step, plain: false });
            }
            (regions, taps, softness) = (keys.regions, keys.taps, keys.softness);
        }
        let fallback = FusedFilter::default();
        let test = depth.or(fallback.depth).unwrap_or_default();
        Self {
            normals: normal_cos.is_some(),
            normal_cos: normal_cos.or(fallback.normal_cos).unwrap_or_default(),
            depth: depth.is_some(),
            depth_step: test.step,
            depth_plain: test.plain,
            regions: match ink.regions {
                _ if !regions => RegionsName::None,
                Regions::One => RegionsName::One,
                Regions::Material => RegionsName::Material,
                Regions::Mesh => RegionsName::Mesh,
                Regions::Patch => RegionsName::Patch,
            },
            taps: TapsValue::new(taps),
            softness,
            layout: match ink.layout {
                TexelLayout::Bits32 => LayoutName::Narrow,
                TexelLayout::Bits64 => LayoutName::Wide,
            },
            artist: ArtistName::new(ink.artist),
            scale: match ink.scale {
                InkScale::Half => ScaleName::Half,
                InkScale::One => ScaleName::One,
                InkScale::Double => ScaleName::Double,
            },
            shadows: match ink.shadows {
                ShadowLines::None => ShadowsTable::None,
                ShadowLines::Negated => ShadowsTable::Negated,
                ShadowLines::Lines => ShadowsTable::Lines,
                ShadowLines::Separate { composite, dilation } => ShadowsTable::Separate(SeparateTable {
                    dilation: dilation.map(DilationTable::new),
                    composite: CompositeTable::new(composite),
                }),
            },
            dilation: ink.dilation.map(DilationTable::new),
            composite: CompositeTable::new(ink.composite),
            gbuffer: ink.gbuffer.as_ref().map(GBufferTable::new),
        }
    }

    /// An error says what contradicts what.
    pub(crate) fn ink(self) -> Result<ImageInk, String> {
        let fused = FusedFilter {
            normal_cos: self.normals.then_some(self.normal_cos),
            depth: self.depth.then_some(DepthTest { step: self.depth_step, plain: self.depth_plain }),
            regions: !matches!(self.regions, RegionsName::None),
            // Set by the plan.
            shadows: ShadowTest::NoStates,
            taps: self.taps.taps(),
            softness: self.softness,
        };
        let composite = self.composite.composite();
        let usual = FusedFilter::default();
        if let (Some(table), Some(_)) = (&self.gbuffer, &self.dilation)
            && !table.shows_lines()
        {
            return Err("a dilation needs lines: show = \"lines\"".into());
        }
        let gbuffer = match self.gbuffer {
            None => None,
            Some(_) if self.depth_plain => {
                return Err("`depth-plain` cannot be there beside `gbuffer`, whose `depth-test` says it".into());
            }
            Some(_) if !matches!(self.layout, LayoutName::Wide) => {
                return Err("`layout` cannot be there beside `gbuffer`, which has formats of its own".into());
            }
            Some(table) => Some(table.gbuffer(SharedKeys {
                normal_cos: fused.normal_cos,
                depth_step: fused.depth.map(|depth| depth.step),
                regions: fused.regions,
                named_regions: !matches!(self.regions, RegionsName::Patch | RegionsName::None),
                named_tests: fused.normal_cos != usual.normal_cos || fused.depth != usual.depth,
                taps: fused.taps,
                softness: fused.softness,
                alpha_test: match composite {
                    Composite::AlphaTested(test) => Some(test),
                    _ => None,
                },
            })?),
        };
        Ok(ImageInk {
            filter: if gbuffer.is_some() { FusedFilter::default() } else { fused },
            layout: match self.layout {
                LayoutName::Narrow => TexelLayout::Bits32,
                LayoutName::Wide => TexelLayout::Bits64,
            },
            regions: match self.regions {
                RegionsName::One => Regions::One,
                RegionsName::Material => Regions::Material,
                RegionsName::Mesh => Regions::Mesh,
                RegionsName::None | RegionsName::Patch => Regions::Patch,
            },
            artist: self.artist.rotation(),
            shadows: match self.shadows {
                ShadowsTable::None => ShadowLines::None,
                ShadowsTable::Negated => ShadowLines::Negated,
                ShadowsTable::Lines => ShadowLines::Lines,
                ShadowsTable::Separate(SeparateTable { dilation, composite }) => ShadowLines::Separate {
                    composite: composite.composite(),
                    dilation: dilation.map(DilationTable::disc),
                },
            },
            dilation: self.dilation.map(DilationTable::disc),
            scale: match self.scale {
                ScaleName::Half => InkScale::Half,
                ScaleName::One => InkScale::One,
                ScaleName::Double => InkScale::Double,
            },
            composite,
            gbuffer,
        })
    }
}

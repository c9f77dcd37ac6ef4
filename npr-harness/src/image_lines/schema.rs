//! The table `[lines.image]` of a style file.

use super::style::{ImageInk, InkScale, Regions};
use crate::schema::{Color, black, one, yes};
use crate::shadow::ShadowLines;
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
    taps: TapsName,
    softness: f32,
    layout: LayoutName,
    artist: ArtistName,
    scale: ScaleName,
    shadows: ShadowsTable,
    #[serde(skip_serializing_if = "Option::is_none")]
    dilation: Option<DilationTable>,
    composite: CompositeTable,
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

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum TapsName {
    Diagonal,
    Cross,
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
        let FusedFilter { normal_cos, depth, regions, taps, softness, .. } = ink.filter;
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
            taps: match taps {
                Taps::Diagonal => TapsName::Diagonal,
                Taps::Cross => TapsName::Cross,
            },
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
        }
    }

    pub(crate) fn ink(self) -> ImageInk {
        ImageInk {
            filter: FusedFilter {
                normal_cos: self.normals.then_some(self.normal_cos),
                depth: self.depth.then_some(DepthTest { step: self.depth_step, plain: self.depth_plain }),
                regions: !matches!(self.regions, RegionsName::None),
                // Set by the plan.
                shadows: ShadowTest::NoStates,
                taps: match self.taps {
                    TapsName::Diagonal => Taps::Diagonal,
                    TapsName::Cross => Taps::Cross,
                },
                softness: self.softness,
            },
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
            composite: self.composite.composite(),
        }
    }
}

//! The keys of lines.

use super::{Color, one, yes};
use crate::image_ink::{ImageInk, InkScale, Regions};
use crate::shadow::ShadowLines;
use crate::style::Lines;
use crate::style::presets::INK;
use glam::Vec3;
use npr_imagespace::composite::{AlphaTest, Composite};
use npr_imagespace::filter::fused::{DepthTest, FusedFilter, ShadowTest};
use npr_imagespace::format::texel::TexelLayout;
use npr_imagespace::morphology::disc::Disc;
use npr_imagespace::picture::Taps;
use npr_outline::LineKind;
use npr_outline::line_look::{LineLook, widths_px};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) enum LinesForm {
    Fins(FinsForm),
    Printed(PrintedForm),
    Image(Box<ImageForm>),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(super) struct FinsForm {
    silhouette_px: f32,
    boundary_px: f32,
    crease_px: f32,
    material_border_px: f32,
    ink: Color,
    opacity: f32,
}

/// As in the style `cartoon`, but for borders between materials.
impl Default for FinsForm {
    fn default() -> Self {
        let [r, g, b, opacity] = INK;
        Self {
            silhouette_px: 2.0,
            boundary_px: 2.0,
            crease_px: 1.3,
            material_border_px: 0.0,
            ink: Color(Vec3::new(r, g, b)),
            opacity,
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(super) struct PrintedForm {
    width_px: f32,
    ink: Color,
}

/// As in the style `printed-fins`.
impl Default for PrintedForm {
    fn default() -> Self {
        Self { width_px: 2.0, ink: Color(Vec3::ZERO) }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(super) struct ImageForm {
    /// Whether normals make lines, and the cosine below which two differ.
    normals: bool,
    normal_cos: f32,
    depth: bool,
    depth_step: f32,
    depth_plain: bool,
    regions: RegionsForm,
    taps: TapsForm,
    softness: f32,
    layout: LayoutForm,
    artist: bool,
    scale: ScaleForm,
    shadows: ShadowsForm,
    #[serde(skip_serializing_if = "Option::is_none")]
    brush: Option<BrushForm>,
    composite: CompositeForm,
}

impl Default for ImageForm {
    fn default() -> Self {
        Self::new(&ImageInk::default())
    }
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum RegionsForm {
    None,
    One,
    Material,
    Mesh,
    Patch,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum TapsForm {
    Diagonal,
    Cross,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum LayoutForm {
    Narrow,
    Wide,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ScaleForm {
    Half,
    One,
    Double,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
enum ShadowsForm {
    None,
    Negated,
    Lines,
    Apart(ApartForm),
}

/// Lines of shadows that look different.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct ApartForm {
    #[serde(skip_serializing_if = "Option::is_none")]
    brush: Option<BrushForm>,
    composite: CompositeForm,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct BrushForm {
    radius_px: f32,
    #[serde(default = "yes")]
    antialias: bool,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
enum CompositeForm {
    Multiply,
    AlphaTested(AlphaForm),
    Over(OverForm),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct AlphaForm {
    less: bool,
    reference: u8,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct OverForm {
    #[serde(default = "black")]
    color: Color,
    #[serde(default = "one")]
    opacity: f32,
}

fn black() -> Color {
    Color(Vec3::ZERO)
}

impl BrushForm {
    fn new(Disc { radius_px, antialias }: Disc) -> Self {
        Self { radius_px, antialias }
    }

    fn disc(self) -> Disc {
        Disc { radius_px: self.radius_px, antialias: self.antialias }
    }
}

impl CompositeForm {
    fn new(composite: Composite) -> Self {
        match composite {
            Composite::Multiply => Self::Multiply,
            Composite::AlphaTested(AlphaTest { less, reference }) => Self::AlphaTested(AlphaForm { less, reference }),
            Composite::Over { color, opacity } => Self::Over(OverForm { color: Color(color), opacity }),
        }
    }

    fn composite(self) -> Composite {
        match self {
            Self::Multiply => Composite::Multiply,
            Self::AlphaTested(AlphaForm { less, reference }) => Composite::AlphaTested(AlphaTest { less, reference }),
            Self::Over(OverForm { color, opacity }) => Composite::Over { color: color.0, opacity },
        }
    }
}

impl LinesForm {
    pub(super) fn new(lines: &Lines) -> Self {
        match lines {
            Lines::Fins(look) => {
                let width = |kind: LineKind| look.width_px[kind as usize];
                let [r, g, b, opacity] = look.ink;
                Self::Fins(FinsForm {
                    silhouette_px: width(LineKind::Silhouette),
                    boundary_px: width(LineKind::Boundary),
                    crease_px: width(LineKind::Crease),
                    material_border_px: width(LineKind::MaterialBorder),
                    ink: Color(Vec3::new(r, g, b)),
                    opacity,
                })
            }
            Lines::Printed { width_px, ink } => Self::Printed(PrintedForm { width_px: *width_px, ink: Color(*ink) }),
            Lines::Image(ink) => Self::Image(Box::new(ImageForm::new(ink))),
        }
    }

    pub(super) fn lines(self) -> Lines {
        match self {
            Self::Fins(fins) => Lines::Fins(LineLook {
                width_px: widths_px(fins.silhouette_px, fins.boundary_px, fins.crease_px, fins.material_border_px),
                ink: fins.ink.0.extend(fins.opacity).to_array(),
            }),
            Self::Printed(PrintedForm { width_px, ink }) => Lines::Printed { width_px, ink: ink.0 },
            Self::Image(image) => Lines::Image(image.ink()),
        }
    }
}

impl ImageForm {
    fn new(ink: &ImageInk) -> Self {
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
                _ if !regions => RegionsForm::None,
                Regions::One => RegionsForm::One,
                Regions::Material => RegionsForm::Material,
                Regions::Mesh => RegionsForm::Mesh,
                Regions::Patch => RegionsForm::Patch,
            },
            taps: match taps {
                Taps::Diagonal => TapsForm::Diagonal,
                Taps::Cross => TapsForm::Cross,
            },
            softness,
            layout: match ink.layout {
                TexelLayout::Narrow => LayoutForm::Narrow,
                TexelLayout::Wide => LayoutForm::Wide,
            },
            artist: ink.artist,
            scale: match ink.scale {
                InkScale::Half => ScaleForm::Half,
                InkScale::One => ScaleForm::One,
                InkScale::Double => ScaleForm::Double,
            },
            shadows: match ink.shadows {
                ShadowLines::None => ShadowsForm::None,
                ShadowLines::Negated => ShadowsForm::Negated,
                ShadowLines::Lines => ShadowsForm::Lines,
                ShadowLines::Apart { composite, brush } => ShadowsForm::Apart(ApartForm {
                    brush: brush.map(BrushForm::new),
                    composite: CompositeForm::new(composite),
                }),
            },
            brush: ink.brush.map(BrushForm::new),
            composite: CompositeForm::new(ink.composite),
        }
    }

    fn ink(self) -> ImageInk {
        ImageInk {
            filter: FusedFilter {
                normal_cos: self.normals.then_some(self.normal_cos),
                depth: self.depth.then_some(DepthTest { step: self.depth_step, plain: self.depth_plain }),
                regions: !matches!(self.regions, RegionsForm::None),
                // The plan says.
                shadows: ShadowTest::Absent,
                taps: match self.taps {
                    TapsForm::Diagonal => Taps::Diagonal,
                    TapsForm::Cross => Taps::Cross,
                },
                softness: self.softness,
            },
            layout: match self.layout {
                LayoutForm::Narrow => TexelLayout::Narrow,
                LayoutForm::Wide => TexelLayout::Wide,
            },
            regions: match self.regions {
                RegionsForm::One => Regions::One,
                RegionsForm::Material => Regions::Material,
                RegionsForm::Mesh => Regions::Mesh,
                RegionsForm::None | RegionsForm::Patch => Regions::Patch,
            },
            artist: self.artist,
            shadows: match self.shadows {
                ShadowsForm::None => ShadowLines::None,
                ShadowsForm::Negated => ShadowLines::Negated,
                ShadowsForm::Lines => ShadowLines::Lines,
                ShadowsForm::Apart(ApartForm { brush, composite }) => {
                    ShadowLines::Apart { composite: composite.composite(), brush: brush.map(BrushForm::disc) }
                }
            },
            brush: self.brush.map(BrushForm::disc),
            scale: match self.scale {
                ScaleForm::Half => InkScale::Half,
                ScaleForm::One => InkScale::One,
                ScaleForm::Double => InkScale::Double,
            },
            composite: self.composite.composite(),
        }
    }
}

//! The settings of image-space lines in a style.

use super::gbuffer::style::{GBuffer, Show};
use super::gbuffer::texel::GBUFFER_REGION_MAX;
use crate::error::HarnessError;
use crate::schema::within_colors;
use crate::shadow::ShadowLines;
use glam::UVec2;
use npr_imagespace::ImageSpaceError;
use npr_imagespace::artist::ArtistRotation;
use npr_imagespace::composite::Composite;
use npr_imagespace::filter::fused::{FilterUniform, FusedFilter};
use npr_imagespace::format::texel::{DepthCode, TexelLayout};
use npr_imagespace::morphology::disc::Disc;
use npr_imagespace::morphology::flood::{FloodPlan, flood};

/// The definition of a region; lines are drawn at region borders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Regions {
    /// All surfaces are one region.
    One,
    /// All faces of one material.
    Material,
    /// All faces of one mesh of the file.
    Mesh,
    /// Faces of one material that are connected by edges less sharp than the style's crease angle. Creases become
    /// borders for any shading normals, and so do meshes that share no edge.
    #[default]
    Patch,
}

/// The size of the target in which lines are found. Lines are 1 to 2 of its pixels wide, so it determines their width.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum InkScale {
    /// Half the picture's size, for lines twice as wide.
    Half,
    /// The picture's size. Surfaces are drawn once for both.
    #[default]
    One,
    /// Twice the picture's size, for fine antialiased lines.
    Double,
}

impl InkScale {
    /// The size of the target for a picture.
    pub fn size(self, (width, height): (u32, u32)) -> (u32, u32) {
        match self {
            Self::Half => (width.div_ceil(2), height.div_ceil(2)),
            Self::One => (width, height),
            Self::Double => (2 * width, 2 * height),
        }
    }
}

/// How lines are found in the image and composited over it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImageInk {
    /// The filter that detects lines. In a parallel view the smallest depth step is relative to the diagonal of the
    /// model's bounding box, so a style applies to models of any size.
    pub filter: FusedFilter,
    /// The packing of normal, region and depth.
    pub layout: TexelLayout,
    /// The definition of a region.
    pub regions: Regions,
    /// How the directions of an artist's lines are rotated where materials specify the source of their inner lines
    /// ([`Scene::line_kinds`](crate::scene::Scene::line_kinds)). `None`: normals are used for all materials.
    pub artist: Option<ArtistRotation>,
    /// How the borders of shadows are drawn.
    pub shadows: ShadowLines,
    /// The disc by which lines are dilated, if any.
    pub dilation: Option<Disc>,
    /// The size of the target in which lines are found.
    pub scale: InkScale,
    /// How lines are composited over the picture.
    pub composite: Composite,
    /// A G-buffer of other formats with filters of their own; [`ImageInk::filter`] and [`ImageInk::layout`] are not
    /// used then.
    pub gbuffer: Option<GBuffer>,
}

impl ImageInk {
    /// The largest region number that leaves room for the shadow state, if any.
    pub fn region_max(&self) -> u32 {
        if self.gbuffer.is_some() {
            return GBUFFER_REGION_MAX;
        }
        if self.shadows.has_states() { self.layout.shadowed_region_max() } else { self.layout.region_max() }
    }

    /// Whether thresholds, dilations and colours are within their ranges.
    ///
    /// # Errors
    /// An error for the first value that is out of range.
    pub fn validate(&self) -> Result<(), HarnessError> {
        if let Composite::Over { color, opacity } = self.composite {
            within_colors("a component of the lines' ink", &color.extend(opacity).to_array())?;
        }
        self.check_filters()?;
        if let Some(gbuffer) = &self.gbuffer {
            if self.shadows.has_states() {
                let needs = "shadows = \"none\" or \"negated\"";
                return Err(HarnessError::GBuffer { what: "lines over it", needs });
            }
            if gbuffer.show != Show::Lines && self.scale != InkScale::One {
                return Err(HarnessError::GBuffer { what: "to show it", needs: "scale = \"one\"" });
            }
            gbuffer.validate(self.shadows == ShadowLines::Negated)?;
        }
        if let ShadowLines::Separate { composite: Composite::Over { color, opacity }, .. } = self.shadows {
            within_colors("a component of the ink of shadows", &color.extend(opacity).to_array())?;
        }
        Ok(())
    }

    fn check_filters(&self) -> Result<(), ImageSpaceError> {
        // Checks the filter with an arbitrary depth range.
        FilterUniform::new(&self.filter, self.layout, &DepthCode::parallel(1.0, 2.0, self.layout)?)?;
        let of_shadows = if let ShadowLines::Separate { dilation, .. } = self.shadows { dilation } else { None };
        for disc in self.dilation.iter().chain(&of_shadows) {
            // Checks the radius, without a picture.
            flood(&[], UVec2::ZERO, disc, &FloodPlan { passes: Vec::new() })?;
        }
        Ok(())
    }
}

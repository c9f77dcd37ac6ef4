//! The settings of lines found in the image in a style.

use crate::error::HarnessError;
use crate::schema::within_colors;
use crate::shadow::ShadowLines;
use glam::UVec2;
use npr_imagespace::ImageSpaceError;
use npr_imagespace::composite::Composite;
use npr_imagespace::filter::fused::{FilterUniform, FusedFilter};
use npr_imagespace::format::texel::{DepthCode, TexelLayout};
use npr_imagespace::morphology::disc::Disc;
use npr_imagespace::morphology::flood::{FloodPlan, flood};

/// What a region is, between whose borders there are lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Regions {
    /// All surfaces are one.
    One,
    /// What is made of one material.
    Material,
    /// What is one mesh of the file.
    Mesh,
    /// What is connected by edges less sharp than the style's creases, and of one material: creases become borders,
    /// whatever the shading normals are, and so do meshes that no edge joins.
    #[default]
    Patch,
}

/// The size of the target in which lines are found. They are 1 to 2 of its pixels wide, so it decides on their width.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum InkScale {
    /// Half the picture's: lines twice as wide.
    Half,
    /// The picture's. The surfaces are drawn once for both.
    #[default]
    One,
    /// Twice the picture's: fine lines, antialiased.
    Double,
}

impl InkScale {
    /// The target's size for a picture's.
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
    /// What is a line. In a parallel view the smallest jump of depth is a share of the diagonal of the model's box: so a
    /// style suits models of any size.
    pub filter: FusedFilter,
    /// How normal, region and depth of a pixel are packed.
    pub layout: TexelLayout,
    /// What a region is.
    pub regions: Regions,
    /// Whether materials say where their inner lines come from ([`Scene::line_kinds`](crate::scene::Scene::line_kinds)); else all from their normals.
    pub artist: bool,
    /// How the borders of shadows are drawn.
    pub shadows: ShadowLines,
    /// Thickens the lines.
    pub dilation: Option<Disc>,
    /// Of the target in which they are found.
    pub scale: InkScale,
    /// How they are composited over the picture.
    pub composite: Composite,
}

impl ImageInk {
    /// The largest number of a region, beside a state of shadow where there is one.
    pub fn region_max(&self) -> u32 {
        if self.shadows.has_states() { self.layout.shadowed_region_max() } else { self.layout.region_max() }
    }

    /// Whether thresholds, dilations and colours are within their ranges.
    ///
    /// # Errors
    /// The first that is not.
    pub fn validate(&self) -> Result<(), HarnessError> {
        if let Composite::Over { color, opacity } = self.composite {
            within_colors("a component of the lines' ink", &color.extend(opacity).to_array())?;
        }
        self.check_filters()?;
        if let ShadowLines::Separate { composite: Composite::Over { color, opacity }, .. } = self.shadows {
            within_colors("a component of the ink of shadows", &color.extend(opacity).to_array())?;
        }
        Ok(())
    }

    fn check_filters(&self) -> Result<(), ImageSpaceError> {
        // Of any depth.
        FilterUniform::new(&self.filter, self.layout, &DepthCode::parallel(1.0, 2.0, self.layout)?)?;
        let of_shadows = if let ShadowLines::Separate { dilation, .. } = self.shadows { dilation } else { None };
        for disc in self.dilation.iter().chain(&of_shadows) {
            // Of no picture: only the radius is looked at.
            flood(&[], UVec2::ZERO, disc, &FloodPlan { passes: Vec::new() })?;
        }
        Ok(())
    }
}

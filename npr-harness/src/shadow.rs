//! Shadows that a style's first light casts: what a style says of them, and what a scene then needs.
//!
//! A point of a surface is *turned* away from the light, where its face is; *lit*; or in a *cast* shadow, turned towards the
//! light with something between. Only between the last two is there a border: [`npr_imagespace::shadow`]. For lines what
//! is nearly turned away counts as such: N·L of the shading normal is not above the style's terminator. So no line is
//! drawn where a surface turns away from the light by itself, nor around the shadows that the small faces of a coarse
//! model cast on each other there.
//!
//! In a cast shadow, where N·L is above 0, a surface is lit as if its normal were negated, which is what Card & Mitchell 2002 do to it for lines:
//! N·L becomes −|N·L|, and no highlight is seen. Bands get their darkest tone, Gooch's tones turn cool, strokes are as
//! dense as where no light falls, and at the terminator nothing jumps.
//!
//! What casts: every face that is not blended, whichever way it is wound, and whether or not a plane cuts it off for the
//! viewer. What is cut out by alpha casts the shadow of its whole faces. On blended surfaces no shadow falls.

use crate::camera::Camera;
use crate::error::HarnessError;
use crate::light::casting_light;
use crate::scene::Scene;
use crate::style::Style;
use glam::DVec4;
use npr_imagespace::composite::Composite;
use npr_imagespace::morphology::disc::Disc;
use npr_mesh::AlphaMode;
use npr_outline::shadow_volume::ShadowCasters;
use npr_toon::source::LightPlace;

/// How a device finds what is in shadow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ShadowMethod {
    /// Shadow volumes in a stencil buffer: exact.
    #[default]
    Volumes,
    /// A picture of depths as the light sees them: its cost does not depend on edges, its borders are as coarse as its
    /// texels.
    Map {
        /// Texels along a side, 16..=16384.
        side: u32,
    },
}

/// What a style says of shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowStyle {
    /// How a device finds them; the CPU follows rays.
    pub method: ShadowMethod,
    /// Where N·L is not above this, 0..1, shadows have no lines.
    pub terminator: f32,
}

impl Default for ShadowStyle {
    fn default() -> Self {
        Self { method: ShadowMethod::Volumes, terminator: 0.15 }
    }
}

impl ShadowStyle {
    pub(crate) fn validate(&self) -> Result<(), HarnessError> {
        let range = |what, value, range| Err(HarnessError::Range { what, value, range });
        if !(0.0..1.0).contains(&self.terminator) {
            return range("a shadow's terminator", f64::from(self.terminator), "0..1");
        }
        match self.method {
            ShadowMethod::Map { side } if !(16..=16_384).contains(&side) => {
                range("the side of a shadow map", f64::from(side), "16..=16384 texels")
            }
            _ => Ok(()),
        }
    }
}

/// How the borders of shadows are drawn, by styles whose lines are found in the image.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ShadowLines {
    /// Not at all.
    #[default]
    None,
    /// As Card & Mitchell 2002 have it: normals are negated in shadow, what is turned away included.
    Negated,
    /// Like the objects' lines, by the same pass.
    Lines,
    /// By a pass of their own, under the objects' lines.
    Apart {
        /// How they come over the picture.
        composite: Composite,
        /// Thickens them.
        brush: Option<Disc>,
    },
}

impl ShadowLines {
    /// Whether texels hold a state of shadow.
    pub fn has_states(self) -> bool {
        matches!(self, Self::Lines | Self::Apart { .. })
    }
}

/// What is decided about shadows before a picture is drawn.
#[derive(Clone, Debug)]
pub struct ShadowPlan {
    /// As the style says.
    pub style: ShadowStyle,
    /// What casts, for volumes; empty for a map.
    pub casters: ShadowCasters,
}

impl ShadowPlan {
    pub(crate) fn new(
        scene: &Scene,
        style: &Style,
        shadow: &ShadowStyle,
        camera: &Camera,
    ) -> Result<Self, HarnessError> {
        let casters = match shadow.method {
            ShadowMethod::Volumes => scene.casters().clone(),
            ShadowMethod::Map { .. } => {
                map_light(scene, casting_light(style, scene, camera))?;
                ShadowCasters::default()
            }
        };
        Ok(Self { style: *shadow, casters })
    }
}

/// Whether a face casts a shadow.
pub(crate) fn casts(scene: &Scene, face: u32) -> bool {
    scene.model.materials[scene.model.face_material[face as usize] as usize].alpha_mode != AlphaMode::Blend
}

/// The light as it is, if one picture of depths can hold all that it shines on: not from within the model's sphere, nor
/// from right beside it.
pub(crate) fn map_light(scene: &Scene, light: DVec4) -> Result<DVec4, HarnessError> {
    if light.w != 0.0 {
        let radii = light.truncate().distance(scene.middle()) / scene.radius();
        if radii.is_nan() || radii < MAP_LEAST_RADII {
            return Err(HarnessError::ShadowMapLight { radii, least: MAP_LEAST_RADII });
        }
    }
    Ok(light)
}

/// From here a sphere is seen under 133°.
const MAP_LEAST_RADII: f64 = 1.09;

/// A light as volumes and rays take it: a point with w = 1, or the unit direction to it with w = 0.
pub(crate) fn homogeneous(place: LightPlace) -> DVec4 {
    match place {
        LightPlace::Directional { to_light } => to_light.as_dvec3().normalize_or_zero().extend(0.0),
        LightPlace::Positional { position } => position.as_dvec3().extend(1.0),
    }
}

//! The part of a plan that is about shadows.

use super::style::{ShadowMethod, ShadowStyle};
use crate::error::HarnessError;
use crate::rays::Hit;
use crate::scene::{Mesh, Scene};
use glam::DVec4;
use npr_mesh::AlphaMode;
use npr_mesh::edges::{EdgeOptions, find};
use npr_outline::shadow_volume::{ShadowCasters, shadow_casters};
use std::convert::Infallible;
use std::sync::Arc;

/// Shadows of the first light.
#[derive(Clone, Debug)]
pub struct ShadowPlan {
    /// World space: a point with w = 1, or the unit direction to it with w = 0.
    pub light: DVec4,
    /// Where N·L is not above this, shadows have no lines.
    pub terminator: f32,
    /// How they are found.
    pub technique: ShadowTechnique,
    /// Whether they are seen in the picture, by its colours or by lines that are found with them.
    pub in_picture: bool,
    /// Whether they are seen by lines in the image that have surfaces of their own.
    pub in_lines: bool,
}

/// How shadows are found.
#[derive(Clone, Debug)]
pub enum ShadowTechnique {
    /// The CPU follows rays to the light.
    Rays,
    /// Shadow volumes, counted in a stencil buffer.
    Volumes {
        /// Per mesh the faces and edges that cast.
        casters: Vec<Arc<ShadowCasters>>,
        /// Who decides which faces and edges bound the volumes.
        method: VolumeMethod,
        /// Whether they are counted against depths of 32-bit floats, else of 24 bits.
        float_depth: bool,
    },
    /// A picture of depths as the light sees them.
    Map {
        /// Texels along a side.
        side: u32,
    },
}

/// Who decides which faces and edges bound shadow volumes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VolumeMethod {
    /// The device, in each frame.
    OnDevice,
    /// The CPU, once for a light.
    OnCpu,
}

/// The key of the casters among what is derived of a mesh.
#[derive(PartialEq)]
struct CastersKey;

/// The faces and edges of a mesh that cast shadows.
pub fn casters(mesh: &Mesh) -> Arc<ShadowCasters> {
    let found = mesh.derived().get(CastersKey, || {
        let model = mesh.model();
        if model.face_polygon.is_empty() {
            return Ok::<_, Infallible>(shadow_casters(model, mesh.edges()));
        }
        // With the diagonals of polygons, which may be warped.
        let edges = find(&model.positions, &model.faces, &[], &[], &EdgeOptions::default());
        Ok(shadow_casters(model, &edges))
    });
    let Ok(casters) = found;
    casters
}

impl ShadowTechnique {
    /// The light `light` is checked: a shadow map takes none from within. `device`: how it makes volumes, and whether it
    /// counts them against depths of 32-bit floats; `None` for the CPU.
    pub(crate) fn new(
        scene: &Scene,
        style: &ShadowStyle,
        light: DVec4,
        device: Option<(VolumeMethod, bool)>,
    ) -> Result<Self, HarnessError> {
        if let ShadowMethod::Map { side } = style.method {
            check_map_light(scene, light)?;
            return Ok(if device.is_some() { Self::Map { side } } else { Self::Rays });
        }
        let Some((method, float_depth)) = device else { return Ok(Self::Rays) };
        let casters = scene.meshes().iter().map(|mesh| casters(mesh)).collect();
        Ok(Self::Volumes { casters, method, float_depth })
    }
}

/// Whether what a ray hits casts a shadow.
pub(crate) fn casts(scene: &Scene, hit: &Hit) -> bool {
    scene.material(hit.object, hit.face).alpha_mode != AlphaMode::Blend
}

/// Whether one picture of depths can hold all that a light shines on: not from within the model's sphere, nor from right
/// beside it.
fn check_map_light(scene: &Scene, light: DVec4) -> Result<(), HarnessError> {
    if light.w != 0.0 {
        let radii = light.truncate().distance(scene.middle()) / scene.radius();
        if radii.is_nan() || radii < MAP_LEAST_RADII {
            return Err(HarnessError::ShadowMapLight { radii, least: MAP_LEAST_RADII });
        }
    }
    Ok(())
}

/// From here a sphere is seen under 133°.
const MAP_LEAST_RADII: f64 = 1.09;

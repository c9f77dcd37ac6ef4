//! The part of a plan for shadows.

use super::style::{ShadowMethod, ShadowStyle};
use crate::error::HarnessError;
use crate::ground::GroundPlan;
use crate::rays::Hit;
use crate::scene::{Mesh, Scene};
use glam::DVec4;
use npr_mesh::Model;
use npr_mesh::edges::find_welded;
use npr_outline::shadow_volume::{EDGES, ShadowCasters, shadow_casters};
use std::convert::Infallible;
use std::sync::Arc;

/// Shadows of the first light.
#[derive(Clone, Debug)]
pub struct ShadowPlan {
    /// The light in scene space: a point with w = 1, or the unit direction to it with w = 0.
    pub light: DVec4,
    /// The N·L at or below which shadows have no lines.
    pub terminator: f32,
    /// The technique.
    pub technique: ShadowTechnique,
    /// Whether shadows appear in the picture, in its colours or in lines found with it.
    pub in_picture: bool,
    /// Whether shadows appear in image-space lines that have their own geometry pass.
    pub in_lines: bool,
    /// The plane under the model that catches shadows.
    pub ground: Option<GroundPlan>,
    /// Why the technique is not the one that the style names, or what it lacks, if so.
    pub because: Option<&'static str>,
}

/// The reason for a map instead of volumes.
pub(crate) const MAP_FOR_ALPHA: &str = "volumes have no textures, and the shadows of some surfaces depend on alpha";

/// What volumes lack where no map can be made.
const WHOLE_FACES: &str = "a light casts shadows; it is too near for a map, so that cut-outs cast those of whole faces";

/// The side of the shadow map of a scene whose shadows depend on alpha, if the style names volumes; texels.
const ALPHA_MAP_SIDE: u32 = 2048;

/// How shadows are computed.
#[derive(Clone, Debug)]
pub enum ShadowTechnique {
    /// Shadow rays on the CPU.
    Rays,
    /// Shadow volumes, counted in a stencil buffer.
    Volumes {
        /// Per mesh: the faces and edges that cast shadows.
        casters: Vec<Arc<ShadowCasters>>,
        /// The executor that selects the faces and edges that bound shadow volumes.
        method: VolumeMethod,
        /// Whether the depth buffer holds 32-bit floats, else 24 bits.
        float_depth: bool,
    },
    /// A shadow map.
    Map {
        /// Its side in texels.
        side: u32,
        /// Whether casters are tested by alpha.
        alpha_test: bool,
    },
}

/// The executor that selects the faces and edges that bound shadow volumes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VolumeMethod {
    /// The GPU, in each frame.
    OnDevice,
    /// The CPU, once per light.
    OnCpu,
}

/// The cache key of the casters.
#[derive(PartialEq)]
struct CastersKey;

/// The faces and edges of a mesh that cast shadows.
pub fn casters(mesh: &Mesh) -> Arc<ShadowCasters> {
    let found = mesh.derived().get(CastersKey, || {
        let (model, drawn) = (mesh.model(), mesh.edges());
        if model.face_polygon.is_empty() && drawn.overlaps.is_empty() && drawn.skipped.is_empty() {
            return Ok::<_, Infallible>(shadow_casters(model, drawn));
        }
        // Includes the diagonals of polygons, which need not be planar, and all faces at an edge.
        let Model { positions, faces, .. } = model;
        let edges = find_welded(positions, faces, &[], &[], drawn.representative.clone(), drawn.tolerance, &EDGES);
        Ok(shadow_casters(model, &edges))
    });
    let Ok(casters) = found;
    casters
}

impl ShadowTechnique {
    /// Selects the technique for an executor, and checks that a shadow map can be rendered from `light`. `device` says
    /// how the GPU makes volumes, and whether it has a depth buffer of 32-bit floats; `None` for the CPU. Also returns why
    /// it is not as the style says, if so.
    ///
    /// Volumes consist of whole faces, so a map replaces them where only a part of a face casts.
    pub(crate) fn new(
        scene: &Scene,
        style: &ShadowStyle,
        light: DVec4,
        device: Option<(VolumeMethod, bool)>,
        texture_px: u32,
    ) -> Result<(Self, Option<&'static str>), HarnessError> {
        let by_alpha = scene.casts_by_alpha();
        if let ShadowMethod::Map { side } = style.method {
            check_map_light(scene, light)?;
            let alpha_test = by_alpha || scene.has_hiding_blend();
            return Ok((if device.is_some() { Self::Map { side, alpha_test } } else { Self::Rays }, None));
        }
        let Some((method, float_depth)) = device else { return Ok((Self::Rays, None)) };
        if by_alpha && check_map_light(scene, light).is_ok() {
            let side = ALPHA_MAP_SIDE.min(texture_px);
            return Ok((Self::Map { side, alpha_test: true }, Some(MAP_FOR_ALPHA)));
        }
        let casters = scene.meshes().iter().map(|mesh| casters(mesh)).collect();
        Ok((Self::Volumes { casters, method, float_depth }, by_alpha.then_some(WHOLE_FACES)))
    }
}

/// Whether the surface at a hit casts a shadow: by its alpha, and whichever side of it the light is on.
pub(crate) fn casts(scene: &Scene, hit: &Hit) -> bool {
    scene.hides_at(hit)
}

/// Checks that one shadow map can cover all that a light shines on: the light must not lie within the model's bounding
/// sphere, nor close to it.
fn check_map_light(scene: &Scene, light: DVec4) -> Result<(), HarnessError> {
    if light.w != 0.0 {
        let radii = light.truncate().distance(scene.middle()) / scene.radius();
        if radii.is_nan() || radii < MAP_LEAST_RADII {
            return Err(HarnessError::ShadowMapLight { radii, least: MAP_LEAST_RADII });
        }
    }
    Ok(())
}

/// The least distance of the light from the sphere's centre, in radii; there the sphere subtends 133°.
const MAP_LEAST_RADII: f64 = 1.09;

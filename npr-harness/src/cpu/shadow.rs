//! Shadows by rays: the reference. The twin of `gpu/surface_shadow.wgsl`.

use super::FrameContext;
use crate::camera::Camera;
use crate::light::casting_light;
use crate::rays::Hit;
use crate::scene::Scene;
use crate::shadow::{ShadowPlan, casts};
use crate::style::Style;
use glam::{DVec3, DVec4};
use npr_imagespace::shadow::ShadowState;

/// What casts shadows, and from where.
#[derive(Clone, Copy)]
pub(super) struct Casting {
    /// A point with w = 1, or the unit direction to it with w = 0.
    light: DVec4,
    terminator: f64,
    /// What is nearer than this is the surface itself, or a copy of it: world units.
    nearest: f64,
}

impl Casting {
    pub(super) fn new(shadow: &ShadowPlan, scene: &Scene, style: &Style, camera: &Camera) -> Self {
        Self {
            light: casting_light(style, scene, camera),
            terminator: f64::from(shadow.style.terminator),
            nearest: scene.radius() * 1e-9,
        }
    }
}

/// What shadows make of a hit. As it stands in no light that casts by [`Default`].
#[derive(Clone, Copy, Default, PartialEq)]
pub(crate) struct ShadowAt {
    /// For its light: in a cast shadow.
    pub(crate) dark: bool,
    /// For printed normals: in any shadow, its own included.
    pub(crate) negated: bool,
    /// For lines.
    pub(crate) state: ShadowState,
}

impl FrameContext<'_> {
    /// What shadows make of a hit.
    pub(super) fn shadow_at(&self, hit: &Hit) -> ShadowAt {
        let Some(casting) = self.casting.as_ref().filter(|_| !self.is_blended(hit)) else {
            return ShadowAt::default();
        };
        let surface = self.interpolate(hit, hit.barycentric);
        let way = casting.light.truncate() - surface.at * casting.light.w;
        let [a, b, c] =
            self.scene.model.faces[hit.face as usize].map(|v| self.scene.model.positions[v as usize].as_dvec3());
        let of_face = (b - a).cross(c - a) * if hit.front { 1.0 } else { -1.0 };
        if of_face.dot(way) <= 0.0 {
            return ShadowAt { negated: true, ..ShadowAt::default() };
        }
        let range = (casting.nearest / way.length(), if casting.light.w == 0.0 { f64::INFINITY } else { 1.0 });
        let is_caster = |other: &Hit| other.face != hit.face && casts(self.scene, other.face);
        let falls = self.scene.rays().any(surface.at, way, range, is_caster);
        let n_dot_l = surface.normal.normalize_or_zero().dot(way.normalize_or_zero());
        let state = match falls {
            _ if n_dot_l <= casting.terminator => ShadowState::Turned,
            true => ShadowState::Cast,
            false => ShadowState::Lit,
        };
        ShadowAt { dark: falls && n_dot_l > 0.0, negated: falls, state }
    }

    /// The normal as a colour.
    pub(super) fn normal_color(&self, hit: &Hit) -> DVec3 {
        let normal = self.interpolate(hit, hit.barycentric).normal.normalize_or_zero();
        (if self.shadow_at(hit).negated { -normal } else { normal }) * 0.5 + 0.5
    }
}

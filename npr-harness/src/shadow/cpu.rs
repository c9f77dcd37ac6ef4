//! Shadows by ray casting, the reference implementation. The GPU version is `shadow.wgsl`.

use super::plan::{ShadowPlan, casts};
use crate::rays::Hit;
use crate::scene::Scene;
use glam::DVec3;
use npr_imagespace::shadow::ShadowState;

/// The shadow state of a hit. [`Default`] is that of a surface that receives no shadows.
#[derive(Clone, Copy, Default, PartialEq)]
pub(crate) struct ShadowAt {
    /// For shading: whether it is in a cast shadow.
    pub(crate) dark: bool,
    /// For negated normals as printed: whether it is in a cast shadow or back-facing.
    pub(crate) negated: bool,
    /// For lines: the shadow state.
    pub(crate) state: ShadowState,
}

/// The shadow state of a hit at `at`, whose normal, of any length, is on the viewer's side.
pub(crate) fn shadow_at(shadow: &ShadowPlan, scene: &Scene, hit: &Hit, at: DVec3, normal: DVec3) -> ShadowAt {
    let light = shadow.light;
    let way = light.truncate() - at * light.w;
    let [a, b, c] = scene.face_corners(hit.object, hit.face);
    let is_turned = hit.front == scene.placed(hit.object).0.is_mirrored();
    let of_face = (b - a).cross(c - a) * if is_turned { -1.0 } else { 1.0 };
    if of_face.dot(way) <= 0.0 {
        return ShadowAt { negated: true, ..ShadowAt::default() };
    }
    let falls = falls(shadow, scene, Some(hit), at, way);
    let n_dot_l = normal.normalize_or_zero().dot(way.normalize_or_zero());
    let state = match falls {
        _ if n_dot_l <= f64::from(shadow.terminator) => ShadowState::BackFacing,
        true => ShadowState::Cast,
        false => ShadowState::Lit,
    };
    ShadowAt { dark: falls && n_dot_l > 0.0, negated: falls, state }
}

/// The shadow state of a point of the ground.
pub(crate) fn shadow_on_ground(shadow: &ShadowPlan, scene: &Scene, at: DVec3) -> ShadowAt {
    let way = shadow.light.truncate() - at * shadow.light.w;
    let falls = falls(shadow, scene, None, at, way);
    let state = match falls {
        _ if way.normalize_or_zero().y <= f64::from(shadow.terminator) => ShadowState::BackFacing,
        true => ShadowState::Cast,
        false => ShadowState::Lit,
    };
    ShadowAt { dark: falls, negated: falls, state }
}

/// Whether something between a point and the light, `way` from it, casts a shadow. `own` is the face that the point is on.
fn falls(shadow: &ShadowPlan, scene: &Scene, own: Option<&Hit>, at: DVec3, way: DVec3) -> bool {
    // Nearer hits are the surface itself or a duplicate of it.
    let nearest = scene.radius() * 1e-9;
    let range = (nearest / way.length(), if shadow.light.w == 0.0 { f64::INFINITY } else { 1.0 });
    let is_itself = |other: &Hit| own.is_some_and(|own| (other.object, other.face) == (own.object, own.face));
    scene.any(at, way, range, |other| !is_itself(other) && casts(scene, other))
}

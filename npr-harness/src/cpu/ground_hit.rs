//! A point of the ground.

use crate::shadow::cpu::ShadowAt;
use glam::DVec3;

/// A point of the ground that is seen.
#[derive(Clone, Copy)]
pub(super) struct GroundHit {
    pub(super) at: DVec3,
    pub(super) shadow: ShadowAt,
}

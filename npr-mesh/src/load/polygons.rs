//! What the loaders of PLY and STL have in common.

use super::far;
use crate::LoadError;
use glam::{DVec3, Vec3};
use std::path::Path;

/// Positions, relative to an origin where they are far from 0.
pub(super) struct Positions {
    pub positions: Vec<Vec3>,
    pub origin: DVec3,
}

impl Positions {
    /// Rounds positions to f32, relative to the centre of those that are `used`, if that is far from 0. Positions that are
    /// not used and not finite are 0.
    ///
    /// # Errors
    /// [`LoadError::Malformed`] for a used position that is not finite as f32.
    pub fn new(positions: Vec<DVec3>, used: &[bool], path: &Path) -> Result<Self, LoadError> {
        let is_bad = |(position, used): (&DVec3, &bool)| *used && !position.as_vec3().is_finite();
        if let Some(vertex) = positions.iter().zip(used).position(is_bad) {
            let fault = format!("vertex {vertex} is not finite, and it is used");
            return Err(LoadError::Malformed { path: path.to_owned(), fault });
        }
        let bounds = far::bounds(positions.iter().zip(used).filter(|(_, used)| **used).map(|(position, _)| *position));
        let offset = |from: DVec3| bounds.and_then(|(low, high)| far::offset(low - from, high - from));
        // The first offset is only as good as f32 at that distance, so there is a second one for tiny models.
        let first = offset(DVec3::ZERO).unwrap_or_default();
        let second = if first == DVec3::ZERO { first } else { offset(first).unwrap_or_default() };
        let origin = first + second;
        let here = |position: DVec3| (position - origin).as_vec3();
        let positions = positions.into_iter().map(here).map(|p| if p.is_finite() { p } else { Vec3::ZERO }).collect();
        Ok(Self { positions, origin })
    }
}

//! How files are loaded.

use crate::Limits;
use crate::weld::Weld;
use std::path::PathBuf;

/// Options of [`load`](crate::load()).
#[derive(Clone, Debug, PartialEq)]
pub struct LoadOptions {
    /// Limits on what is accepted.
    pub limits: Limits,
    /// An additional folder for files that the model refers to (textures, materials, buffers). A relative name that
    /// is not found beside the model is searched for in this folder. Without it, nothing outside the model's folder
    /// is read.
    pub asset_root: Option<PathBuf>,
    /// The crease angle in radians, 0..=π, for missing normals: they are split between faces that meet at more than
    /// this angle.
    pub normal_crease_angle_rad: f32,
    /// Which vertices are one vertex for missing normals, and for edges: [`Loaded::weld`](crate::Loaded::weld).
    pub weld: Weld,
}

/// The default crease angle.
pub(super) const CREASE_ANGLE_RAD: f32 = 45f32.to_radians();

impl Default for LoadOptions {
    fn default() -> Self {
        Self {
            limits: Limits::default(),
            asset_root: None,
            normal_crease_angle_rad: CREASE_ANGLE_RAD,
            weld: Weld::default(),
        }
    }
}

//! What is seen first through each pixel, which all styles that show a scene from one view have in common.

use super::CpuOptions;
use crate::camera::Camera;
use crate::rays::Hit;
use crate::scene::Scene;
use glam::DVec2;
use npr_mesh::AlphaMode;
use std::sync::{Arc, Mutex};

/// A view of a scene, and what was found through its pixels by pictures before.
pub struct Sight<'a> {
    /// What is shown.
    pub scene: &'a Scene,
    /// From where.
    pub camera: &'a Camera,
    /// Px.
    pub size: (u32, u32),
    most: usize,
    found: Mutex<Vec<Found>>,
}

struct Found {
    shift_px: DVec2,
    boundary_inset_px: f64,
    hits: Hits,
}

/// A hit per pixel, rows from the top.
pub(super) type Hits = Arc<Vec<Option<Hit>>>;

impl<'a> Sight<'a> {
    /// For one picture.
    pub fn new(scene: &'a Scene, camera: &'a Camera, size: (u32, u32)) -> Self {
        Self::kept(scene, camera, size, 0)
    }

    /// Keeps what is found for up to `most` places of the pixels' samples, [`CpuOptions::shift_px`]: 56 bytes a pixel and
    /// place.
    pub fn kept(scene: &'a Scene, camera: &'a Camera, size: (u32, u32), most: usize) -> Self {
        // What alpha cuts out is for the style to say.
        let cut_out = scene.model.materials.iter().any(|m| matches!(m.alpha_mode, AlphaMode::Mask { .. }));
        Self { scene, camera, size, most: if cut_out { 0 } else { most }, found: Mutex::new(Vec::new()) }
    }

    /// What was found for a picture of some size, or is by `find`.
    pub(super) fn hits(&self, size: (u32, u32), options: &CpuOptions, find: impl FnOnce() -> Hits) -> Option<Hits> {
        if size != self.size || options.samples > 1 || self.most == 0 {
            return None;
        }
        let mut found = self.found.lock().expect("no thread panics while it holds the lock");
        let same = |f: &&Found| f.shift_px == options.shift_px && f.boundary_inset_px == options.boundary_inset_px;
        if let Some(same) = found.iter().find(same) {
            return Some(Arc::clone(&same.hits));
        }
        if found.len() >= self.most {
            return None;
        }
        let CpuOptions { shift_px, boundary_inset_px, .. } = *options;
        let hits = find();
        found.push(Found { shift_px, boundary_inset_px, hits: Arc::clone(&hits) });
        Some(hits)
    }
}

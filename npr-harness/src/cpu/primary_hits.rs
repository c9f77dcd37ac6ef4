//! Primary visibility: what is seen first through each pixel, which all styles that show a scene in one view share.

use super::frame::CpuOptions;
use crate::rays::Hit;
use crate::scene::Scene;
use crate::view::View;
use glam::DVec2;
use npr_mesh::AlphaMode;
use std::sync::{Arc, Mutex};

/// Primary hits of a scene in a view, kept for the pictures that follow.
pub struct PrimaryHits<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The camera, the size and the samples.
    pub view: View,
    most: usize,
    found: Mutex<Vec<Found>>,
}

struct Found {
    shift_px: DVec2,
    boundary_inset_px: f64,
    hits: Hits,
}

/// A hit per pixel, rows from the top.
pub(crate) type Hits = Arc<Vec<Option<Hit>>>;

impl<'a> PrimaryHits<'a> {
    /// For one picture: nothing is kept.
    pub fn new(scene: &'a Scene, view: View) -> Self {
        Self::kept(scene, view, 0)
    }

    /// Keeps what is found for up to `most` places of the pixels' samples ([`CpuOptions::shift_px`]): 56 bytes a pixel
    /// and place.
    pub fn kept(scene: &'a Scene, view: View, most: usize) -> Self {
        // Which faces alpha cuts out depends on the style.
        let cut_out = scene.materials().iter().any(|m| matches!(m.alpha_mode, AlphaMode::Mask { .. }));
        Self { scene, view, most: if cut_out { 0 } else { most }, found: Mutex::new(Vec::new()) }
    }

    /// What was found for a view of the same camera, or is by `find`; `None` where nothing is kept.
    pub(super) fn hits(&self, view: &View, options: &CpuOptions, find: impl FnOnce() -> Hits) -> Option<Hits> {
        if view.size != self.view.size || view.samples > 1 || self.most == 0 {
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

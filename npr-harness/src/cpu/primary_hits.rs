//! Primary visibility: the first surface at each pixel, shared by all styles that render a scene in one view.

use super::frame::CpuOptions;
use crate::rays::Hit;
use crate::scene::Scene;
use crate::view::View;
use glam::DVec2;
use npr_mesh::AlphaMode;
use std::sync::{Arc, Mutex};

/// A cache of the primary hits of a scene in a view.
pub struct PrimaryHits<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The camera, the size and the samples per pixel.
    pub view: View,
    most: usize,
    found: Mutex<Vec<Found>>,
}

struct Found {
    shift_px: DVec2,
    boundary_inset_px: f64,
    hits: Hits,
}

/// A hit per pixel, in rows from the top.
pub(crate) type Hits = Arc<Vec<Option<Hit>>>;

impl<'a> PrimaryHits<'a> {
    /// Creates a cache for one picture, which stores nothing.
    pub fn new(scene: &'a Scene, view: View) -> Self {
        Self::kept(scene, view, 0)
    }

    /// Creates a cache that stores the hits for up to `most` sample offsets ([`CpuOptions::shift_px`]), 56 bytes per
    /// pixel and offset.
    pub fn kept(scene: &'a Scene, view: View, most: usize) -> Self {
        // Which faces alpha cuts out depends on the style.
        let cut_out = scene.materials().iter().any(|m| matches!(m.alpha_mode, AlphaMode::Mask { .. }));
        Self { scene, view, most: if cut_out { 0 } else { most }, found: Mutex::new(Vec::new()) }
    }

    /// Returns the cached hits of a view of the same camera, or computes them with `find`; `None` if nothing is cached.
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

//! The see-through surfaces that dim the edge lines behind them.

use super::FrameContext;
use super::frame::Veils;
use crate::rays::Hit;
use crate::scene::opacity::HIDES_FROM;
use glam::DVec4;
use npr_outline::segment::VEIL_LAYERS;

impl FrameContext<'_> {
    /// Per pixel, in rows from the top.
    pub(super) fn veils(&self, threads: usize) -> Vec<Veils> {
        let row = self.size.0 as usize;
        let mut veils = vec![[DVec4::ZERO; 2]; row * self.size.1 as usize];
        self.by_rows((0u32..).zip(veils.chunks_mut(row)), threads, |(y, veils)| {
            for (x, veils) in (0u32..).zip(veils) {
                *veils = self.veils_at(x, y);
            }
        });
        veils
    }

    fn veils_at(&self, x: u32, y: u32) -> Veils {
        let (origin, direction) = self.rays.through(self.sample_point(f64::from(x), f64::from(y)));
        let camera = &self.plan.view.camera;
        let is_veil = |hit: &Hit| {
            self.is_shown(hit)
                && self.scene.veils(self.scene.material_number(hit.object, hit.face))
                && self.opacity(hit, x, y) < HIDES_FROM
        };
        let mut veils = [DVec4::ZERO; 2];
        let mut hits = self.scene.all(origin, direction, camera.depth_range(), is_veil);
        // Surfaces at one place are one layer, as in a depth buffer.
        hits.dedup_by_key(|hit| hit.t);
        for (layer, hit) in hits.iter().take(VEIL_LAYERS).enumerate() {
            veils[0][layer] = camera.buffer_depth(hit.t);
            veils[1][layer] = self.opacity(hit, x, y).max(0.0);
        }
        veils
    }
}

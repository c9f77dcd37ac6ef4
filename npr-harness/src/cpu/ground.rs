//! The ground on the CPU. On the GPU it is drawn by `gpu/ground.rs`.

use super::FrameContext;
use super::ground_hit::GroundHit;
use crate::ground::GroundPlan;
use crate::hatch::cpu::Hatching;
use crate::image_lines::cpu::texel_of_ground;
use crate::image_lines::gbuffer::texel::{self, GBufferTexel};
use crate::rays::Hit;
use crate::shade::Shading;
use crate::shadow::cpu::shadow_on_ground;
use glam::{DVec2, DVec3};
use npr_toon::border::toon_border_width;

impl FrameContext<'_> {
    fn ground_plan(&self) -> Option<&GroundPlan> {
        self.plan.ground()
    }

    /// The point of the ground at a pixel, where it is in front of `solid`.
    pub(super) fn ground_at(&self, solid: Option<&Hit>, x: u32, y: u32) -> Option<GroundHit> {
        let ground = self.ground_plan()?;
        let (origin, direction) = self.rays.through(self.sample_point(f64::from(x), f64::from(y)));
        let (near, far) = self.plan.view.camera.depth_range();
        let t = ground.meets(origin, direction)?;
        if t < near || t > far || solid.is_some_and(|hit| hit.t <= t) {
            return None;
        }
        let at = origin + direction * t;
        let shadow = shadow_on_ground(self.plan.shadow.as_ref()?, self.scene, at);
        Some(GroundHit { at, shadow })
    }

    /// The display-referred colour of the ground: paper where it is lit, else that of paper in shadow.
    pub(super) fn paint_ground(&self, hit: &GroundHit, x: u32, y: u32) -> DVec3 {
        let paper = self.plan.paper.as_dvec3();
        let (Some(paint), Some(ground), true) = (&self.plan.paint, self.ground_plan(), hit.shadow.dark) else {
            return paper;
        };
        let model = paint.shade.model();
        let (lights, light_color) = match paint.light_pairs.first() {
            Some(pair) => (&pair.lights[..], pair.color),
            None => (&paint.lights[..], paint.light_color),
        };
        let light_at = |at: DVec3| {
            let light = self.light_at(paint, lights, model, &self.lit_point(DVec3::Y, at));
            DVec2::new(-light.x.abs(), model.second_in_shadow(light.y))
        };
        let light = light_at(hit.at);
        // The points at the neighbouring pixels of the 2×2 block, as for surfaces.
        let beside = |index: u32| if index.is_multiple_of(2) { 1.0 } else { -1.0 };
        let (dx, dy) = (beside(x), beside(y));
        let on_plane = |x: f64, y: f64| {
            let (origin, direction) = self.rays.through(self.sample_point(x, y));
            ground.on_plane(origin, direction).1
        };
        let (px, py) = (f64::from(x), f64::from(y));
        let (along_x, along_y) = (on_plane(px + dx, py), on_plane(px, py + dy));
        if let Some(strokes) = &self.strokes {
            let position = |at: DVec3| strokes.position(at, GroundPlan::uv(at, strokes.tile()));
            let at = position(hit.at);
            let hatching = Hatching {
                at,
                at_dx: (position(along_x) - at) * dx,
                at_dy: (position(along_y) - at) * dy,
                normal: DVec3::Y,
                mesh: None,
                octave: 0.0,
                corners: [0; 3],
                barycentric: [0.0; 3],
                diffuse: light.x,
                in_shadow: true,
                diffuse_of_corners: &|| None,
            };
            return strokes.color(&hatching, paper, paper);
        }
        let widths = |of: &dyn Fn(DVec2) -> DVec2| {
            let change = |at| of(light_at(at)) - of(light);
            let (dx, dy) = (change(along_x), change(along_y));
            DVec2::new(toon_border_width(dx.x, dy.x), toon_border_width(dx.y, dy.y))
        };
        let normal = || DVec3::NEG_Y;
        let shading = Shading { base: paper, light_color, light, normal: &normal, widths: &widths };
        // Clamped, as a render target clamps it.
        model.color(&shading).clamp(DVec3::ZERO, DVec3::ONE)
    }

    /// The packed texel of the ground: background with a shadow state.
    pub(super) fn ground_texel(&self, hit: &GroundHit) -> [u32; 2] {
        self.plan.image.as_ref().map_or([0; 2], |image| texel_of_ground(image, hit.shadow))
    }

    /// The unquantised texel of the ground, which has no room for a state without a surface.
    pub(super) fn ground_gbuffer_texel(&self) -> GBufferTexel {
        texel::BACKGROUND
    }
}

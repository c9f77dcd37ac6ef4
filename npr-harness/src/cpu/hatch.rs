//! Strokes on a hit. The twin of `gpu/surface_hatch.wgsl`.

use super::FrameContext;
use super::surface::Footprint;
use crate::hatch::{HatchPlan, HatchVertex};
use crate::rays::Hit;
use crate::style::{HatchGround, HatchMapping, HatchShade, HatchTransfer, six_tones};
use glam::{DVec2, DVec3};
use npr_hatch::lookup::{HatchFootprint, hatch_flat, hatch_footprint, hatch_ink, hatch_texels};
use npr_hatch::mapping::{
    HATCH_TURNS, hatch_doubled, hatch_moved, hatch_octave, hatch_plane, hatch_plane_weights, hatch_share, hatch_turn,
    hatch_turned,
};
use npr_hatch::{
    HatchWeights, Tam, Thresholds, hatch_blend, hatch_color, hatch_level, hatch_linear, hatch_shadowed, hatch_transfer,
    hatch_weights,
};
use npr_toon::normal::NormalUse;

/// A map as a frame looks it up.
pub(super) struct Strokes<'a> {
    shade: &'a HatchShade,
    plan: &'a HatchPlan,
    tam: &'a Tam,
    thresholds: Option<&'a Thresholds>,
    tones: (DVec3, DVec3),
    /// Texels for the side of the map, made less where they are to be larger than pixels.
    texels: f64,
    /// Whether weights of six tones are computed at the vertices.
    at_vertices: bool,
}

/// What is asked of strokes at a pixel.
struct Hatching {
    at: DVec3,
    at_dx: DVec3,
    at_dy: DVec3,
    normal: DVec3,
    vertex: ([DVec3; 2], f64),
    tone: f64,
    weights: HatchWeights,
}

impl<'a> Strokes<'a> {
    /// `samples`: along each axis of a pixel.
    pub(super) fn new(shade: &'a HatchShade, plan: &'a HatchPlan, normals: NormalUse, samples: u32) -> Self {
        let drawn = "a plan has its map drawn";
        let (tam, thresholds) = (plan.tam().expect(drawn), plan.drawn_thresholds().expect(drawn));
        let texel_px = f64::from(shade.texel_px) * f64::from(samples);
        Self {
            shade,
            plan,
            tam,
            thresholds,
            tones: six_tones(tam),
            texels: f64::from(tam.side) * texel_px,
            at_vertices: normals == NormalUse::PerVertex && thresholds.is_none(),
        }
    }

    /// The tone that the light asks for.
    fn tone(&self, reach: f64) -> f64 {
        match self.shade.transfer {
            HatchTransfer::Listing4 { brightness } => {
                hatch_transfer(self.tones.0, self.tones.1, hatch_level(f64::from(brightness), reach))
            }
            HatchTransfer::Linear { ambient } => {
                f64::from(ambient) + (1.0 - f64::from(ambient)) * reach.clamp(0.0, 1.0)
            }
        }
    }

    fn weights(&self, tone: f64) -> HatchWeights {
        hatch_weights(hatch_linear(self.tones.0, self.tones.1, tone))
    }

    /// What one hatching leaves as paper.
    fn once(&self, uv: DVec2, footprint: HatchFootprint, tone: f64, weights: HatchWeights) -> f64 {
        let flat = hatch_flat(footprint.level, self.last_level());
        let (strokes, mean) = if let Some(thresholds) = self.thresholds {
            (1.0 - hatch_ink(thresholds, uv, footprint, tone, HatchShade::WIDTH), tone)
        } else {
            let (light, dark) = hatch_texels(self.tam, uv, footprint);
            (hatch_blend(light, dark, weights), hatch_blend(self.tones.0, self.tones.1, weights))
        };
        strokes + (mean - strokes) * flat
    }

    fn last_level(&self) -> f64 {
        (self.tam.levels() - 1) as f64
    }

    /// What a hatching leaves that counts for a share, along with what those before it left.
    fn share(&self, before: f64, asked: &Hatching, uv: DVec2, footprint: HatchFootprint, share: f64) -> f64 {
        if share <= 0.0 {
            return before;
        }
        if self.at_vertices {
            // Weights that were interpolated are nobody's tone: what is left is their mean.
            return before + share * self.once(uv, footprint, asked.tone, asked.weights);
        }
        let tone = hatch_share(asked.tone, share);
        before * self.once(uv, footprint, tone, self.weights(tone))
    }

    fn footprint(&self, uv_dx: DVec2, uv_dy: DVec2) -> HatchFootprint {
        hatch_footprint(uv_dx, uv_dy, self.texels, self.last_level())
    }

    fn by_coordinates(&self, asked: &Hatching, nothing: f64) -> f64 {
        let step = hatch_octave(asked.vertex.1);
        (0..2).fold(nothing, |paper, i| {
            let scale = f64::from(step.first + i).exp2();
            let footprint = self.footprint(asked.at_dx.truncate() * scale, asked.at_dy.truncate() * scale);
            let share = if i == 1 { step.share } else { 1.0 - step.share };
            self.share(paper, asked, asked.at.truncate() * scale, footprint, share)
        })
    }

    fn by_planes(&self, asked: &Hatching, nothing: f64) -> f64 {
        let weights = hatch_plane_weights(asked.normal);
        let mut paper = nothing;
        for axis in 0..3 {
            let weight = weights[axis as usize];
            if weight <= 0.0 {
                continue;
            }
            let place = hatch_plane(asked.at, axis);
            let footprint = self.footprint(hatch_plane(asked.at_dx, axis), hatch_plane(asked.at_dy, axis));
            if self.plan.mapping == HatchMapping::Planes {
                paper = self.share(paper, asked, place + hatch_moved(axis as i32), footprint, weight);
                continue;
            }
            let [diagonal, others] = asked.vertex.0;
            let step = hatch_turn(hatch_doubled(diagonal, others, axis));
            let turns = HATCH_TURNS as i32;
            for i in 0..2 {
                let turn = (step.first + i) % turns;
                let turned = HatchFootprint { spread: hatch_turned(footprint.spread, turn), ..footprint };
                let uv = hatch_turned(place, turn) + hatch_moved(axis as i32 * turns + turn);
                let share = weight * if i == 1 { step.share } else { 1.0 - step.share };
                paper = self.share(paper, asked, uv, turned, share);
            }
        }
        paper
    }

    fn hatched(&self, asked: &Hatching) -> f64 {
        let nothing = if self.at_vertices { 0.0 } else { 1.0 };
        match self.plan.mapping {
            HatchMapping::Coordinates => self.by_coordinates(asked, nothing),
            HatchMapping::Planes | HatchMapping::Form => self.by_planes(asked, nothing),
        }
    }
}

impl FrameContext<'_> {
    /// Where on a hit's face strokes lie.
    fn stroke_place(&self, hit: &Hit, weights: [f64; 3], strokes: &Strokes<'_>) -> DVec3 {
        match strokes.plan.mapping {
            HatchMapping::Coordinates => self.interpolate_uv(hit, weights).extend(0.0),
            HatchMapping::Planes | HatchMapping::Form => self.interpolate(hit, weights).at / strokes.plan.tile,
        }
    }

    fn stroke_vertex(&self, hit: &Hit, strokes: &Strokes<'_>) -> ([DVec3; 2], f64) {
        let vertices = &strokes.plan.vertices;
        if vertices.is_empty() {
            return ([DVec3::ZERO; 2], 0.0);
        }
        let corners = self.scene.model.faces[hit.face as usize].map(|v| vertices[v as usize]);
        let mean = |of: fn(&HatchVertex) -> [f32; 3]| -> DVec3 {
            let corners = corners.iter().zip(hit.barycentric);
            corners.map(|(corner, weight)| DVec3::from(of(corner).map(f64::from)) * weight).sum()
        };
        let octave = corners.iter().zip(hit.barycentric).map(|(corner, weight)| f64::from(corner.octave) * weight);
        ([mean(|vertex| vertex.diagonal), mean(|vertex| vertex.others)], octave.sum())
    }

    /// The display-referred colour of a hit whose own is `base`, under a light of this reach.
    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own; a struct would only rename them")]
    pub(super) fn hatch(
        &self,
        hit: &Hit,
        base: DVec3,
        reach: f64,
        in_shadow: bool,
        x: u32,
        y: u32,
        strokes: &Strokes<'_>,
    ) -> DVec3 {
        let Footprint { along_x, dx, along_y, dy } = self.footprint(hit, x, y);
        let at = self.stroke_place(hit, hit.barycentric, strokes);
        let tone = hatch_shadowed(strokes.tone(reach), strokes.tone(0.0), if in_shadow { 0.0 } else { 1.0 });
        let weights = if strokes.at_vertices && hit.front && !in_shadow {
            let corners = self.lit_corners(hit).map(|reach| strokes.weights(strokes.tone(reach)));
            let mean = |of: fn(&HatchWeights) -> DVec3| -> DVec3 {
                corners.iter().zip(hit.barycentric).map(|(corner, weight)| of(corner) * weight).sum()
            };
            HatchWeights { light: mean(|weights| weights.light), dark: mean(|weights| weights.dark) }
        } else {
            strokes.weights(tone)
        };
        let paper = strokes.hatched(&Hatching {
            at,
            at_dx: (self.stroke_place(hit, along_x, strokes) - at) * dx,
            at_dy: (self.stroke_place(hit, along_y, strokes) - at) * dy,
            normal: self.interpolate(hit, hit.barycentric).normal.normalize_or_zero(),
            vertex: self.stroke_vertex(hit, strokes),
            tone,
            weights,
        });
        let ground = match strokes.shade.ground {
            HatchGround::Paper => self.style.paper.as_dvec3(),
            HatchGround::Surface => base,
        };
        hatch_color(paper, ground, strokes.shade.ink.as_dvec3())
    }
}

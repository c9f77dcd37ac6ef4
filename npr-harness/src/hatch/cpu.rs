//! Evaluates strokes at a point of a surface, in f64. The GPU version is `hatch.wgsl`.

use super::plan::{HatchPlan, HatchVertex};
use super::style::{HatchGround, HatchMapping, HatchShade, HatchTransfer, six_tones};
use glam::{DVec2, DVec3};
use npr_hatch::lookup::{HatchFootprint, hatch_flat_weight, hatch_footprint, hatch_ink, hatch_texels};
use npr_hatch::mapping::{
    HATCH_DIRECTIONS, hatch_direction_step, hatch_doubled_angle, hatch_octave, hatch_offset, hatch_plane,
    hatch_plane_weights, hatch_rotate, hatch_share_tone,
};
use npr_hatch::{
    HatchWeights, Tam, Thresholds, hatch_blend, hatch_color, hatch_level, hatch_level_of_tone, hatch_tone_in_shadow,
    hatch_transfer, hatch_weights,
};

/// A tonal art map, prepared for lookups in a frame.
#[derive(Clone, Copy)]
pub(crate) struct Strokes<'a> {
    plan: &'a HatchPlan,
    tam: &'a Tam,
    thresholds: Option<&'a Thresholds>,
    tones: (DVec3, DVec3),
    /// The side of the map in texels, times the size of a texel in px: the scale of footprints.
    texels: f64,
}

/// The inputs for hatching a pixel.
pub(crate) struct Hatching<'a> {
    /// The stroke coordinates ([`Strokes::position`]) and their derivatives per pixel.
    pub(crate) at: DVec3,
    pub(crate) at_dx: DVec3,
    pub(crate) at_dy: DVec3,
    /// The unit normal in mesh space.
    pub(crate) normal: DVec3,
    /// The index of the mesh, `None` for the ground, and log2 of the scale of the object's transform.
    pub(crate) mesh: Option<usize>,
    pub(crate) octave: f64,
    /// The corners of the face, and the point's barycentric weights.
    pub(crate) corners: [u32; 3],
    pub(crate) barycentric: [f64; 3],
    /// The diffuse term.
    pub(crate) diffuse: f64,
    pub(crate) in_shadow: bool,
    /// The diffuse terms at the corners, evaluated only if the weights of tones are computed there.
    pub(crate) diffuse_of_corners: &'a dyn Fn() -> Option<[f64; 3]>,
}

/// The inputs that all hatching layers of a pixel share.
struct Sampled {
    at: DVec3,
    at_dx: DVec3,
    at_dy: DVec3,
    normal: DVec3,
    tensor: [DVec3; 2],
    octave: f64,
    tone: f64,
    weights: HatchWeights,
}

impl<'a> Strokes<'a> {
    /// `samples` is the number of samples along each axis of a pixel.
    pub(crate) fn new(plan: &'a HatchPlan, samples: u32) -> Self {
        let drawn = "a plan has its map drawn";
        let (tam, thresholds) = (plan.tam().expect(drawn), plan.drawn_thresholds().expect(drawn));
        let texel_px = f64::from(plan.shade.texel_px) * f64::from(samples);
        Self { plan, tam, thresholds, tones: six_tones(tam), texels: f64::from(tam.side) * texel_px }
    }

    /// The stroke coordinates for a position in mesh space, in scene units, and texture coordinates.
    pub(crate) fn position(&self, at: DVec3, uv: DVec2) -> DVec3 {
        match self.plan.shade.mapping {
            HatchMapping::Coordinates => uv.extend(0.0),
            HatchMapping::Planes | HatchMapping::Form => at / self.plan.tile,
        }
    }

    /// The length of one side of the map on a surface, scene units.
    pub(crate) fn tile(&self) -> f64 {
        self.plan.tile
    }

    /// The tone for a diffuse term.
    fn tone(&self, diffuse: f64) -> f64 {
        match self.plan.shade.transfer {
            HatchTransfer::Listing4 { brightness } => {
                hatch_transfer(self.tones.0, self.tones.1, hatch_level(f64::from(brightness), diffuse))
            }
            HatchTransfer::Linear { ambient } => {
                f64::from(ambient) + (1.0 - f64::from(ambient)) * diffuse.clamp(0.0, 1.0)
            }
        }
    }

    fn weights(&self, tone: f64) -> HatchWeights {
        hatch_weights(hatch_level_of_tone(self.tones.0, self.tones.1, tone))
    }

    /// The fraction of the ground that one hatching layer leaves uncovered.
    fn once(&self, uv: DVec2, footprint: HatchFootprint, tone: f64, weights: HatchWeights) -> f64 {
        let flat = hatch_flat_weight(footprint.level, self.last_level());
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

    /// Combines the uncovered fraction of a hatching layer of weight `share` with that of the layers before it.
    fn share(&self, before: f64, sampled: &Sampled, uv: DVec2, footprint: HatchFootprint, share: f64) -> f64 {
        if share <= 0.0 {
            return before;
        }
        if self.plan.weights_at_vertices {
            // Interpolated weights do not correspond to a single tone, so the layers are averaged.
            return before + share * self.once(uv, footprint, sampled.tone, sampled.weights);
        }
        let tone = hatch_share_tone(sampled.tone, share);
        before * self.once(uv, footprint, tone, self.weights(tone))
    }

    fn footprint(&self, uv_dx: DVec2, uv_dy: DVec2) -> HatchFootprint {
        hatch_footprint(uv_dx, uv_dy, self.texels, self.last_level())
    }

    fn by_coordinates(&self, sampled: &Sampled, nothing: f64) -> f64 {
        let step = hatch_octave(sampled.octave);
        (0..2).fold(nothing, |paper, i| {
            let scale = f64::from(step.first + i).exp2();
            let footprint = self.footprint(sampled.at_dx.truncate() * scale, sampled.at_dy.truncate() * scale);
            let share = if i == 1 { step.share } else { 1.0 - step.share };
            self.share(paper, sampled, sampled.at.truncate() * scale, footprint, share)
        })
    }

    fn by_planes(&self, sampled: &Sampled, nothing: f64) -> f64 {
        let weights = hatch_plane_weights(sampled.normal);
        let mut paper = nothing;
        for axis in 0..3 {
            let weight = weights[axis as usize];
            if weight <= 0.0 {
                continue;
            }
            let place = hatch_plane(sampled.at, axis);
            let footprint = self.footprint(hatch_plane(sampled.at_dx, axis), hatch_plane(sampled.at_dy, axis));
            if self.plan.shade.mapping == HatchMapping::Planes {
                paper = self.share(paper, sampled, place + hatch_offset(axis as i32), footprint, weight);
                continue;
            }
            let [diagonal, others] = sampled.tensor;
            let step = hatch_direction_step(hatch_doubled_angle(diagonal, others, axis));
            let turns = HATCH_DIRECTIONS as i32;
            for i in 0..2 {
                let turn = (step.first + i) % turns;
                let turned = HatchFootprint { spread: hatch_rotate(footprint.spread, turn), ..footprint };
                let uv = hatch_rotate(place, turn) + hatch_offset(axis as i32 * turns + turn);
                let share = weight * if i == 1 { step.share } else { 1.0 - step.share };
                paper = self.share(paper, sampled, uv, turned, share);
            }
        }
        paper
    }

    fn hatched(&self, sampled: &Sampled) -> f64 {
        let nothing = if self.plan.weights_at_vertices { 0.0 } else { 1.0 };
        match self.plan.shade.mapping {
            HatchMapping::Coordinates => self.by_coordinates(sampled, nothing),
            HatchMapping::Planes | HatchMapping::Form => self.by_planes(sampled, nothing),
        }
    }

    /// The direction of the field and the octave of the texture coordinates at a point of a face.
    fn at_point(&self, mesh: Option<usize>, corners: [u32; 3], barycentric: [f64; 3]) -> ([DVec3; 2], f64) {
        let vertices = mesh.map(|mesh| &self.plan.vertices[mesh]).filter(|vertices| !vertices.is_empty());
        let Some(vertices) = vertices else { return ([DVec3::ZERO; 2], 0.0) };
        let corners = corners.map(|v| vertices[v as usize]);
        let mean = |of: fn(&HatchVertex) -> [f32; 3]| -> DVec3 {
            let corners = corners.iter().zip(barycentric);
            corners.map(|(corner, weight)| DVec3::from(of(corner).map(f64::from)) * weight).sum()
        };
        let octave = corners.iter().zip(barycentric).map(|(corner, weight)| f64::from(corner.octave) * weight);
        ([mean(|vertex| vertex.diagonal), mean(|vertex| vertex.others)], octave.sum())
    }

    /// The display-referred colour of a pixel. `base` is the surface's unshaded colour.
    pub(crate) fn color(&self, hatching: &Hatching<'_>, base: DVec3, paper: DVec3) -> DVec3 {
        let lit = if hatching.in_shadow { 0.0 } else { 1.0 };
        let tone = hatch_tone_in_shadow(self.tone(hatching.diffuse), self.tone(0.0), lit);
        let of_corners =
            if self.plan.weights_at_vertices && !hatching.in_shadow { (hatching.diffuse_of_corners)() } else { None };
        let weights = match of_corners {
            Some(diffuse) => {
                let corners = diffuse.map(|diffuse| self.weights(self.tone(diffuse)));
                let mean = |of: fn(&HatchWeights) -> DVec3| -> DVec3 {
                    corners.iter().zip(hatching.barycentric).map(|(corner, weight)| of(corner) * weight).sum()
                };
                HatchWeights { light: mean(|weights| weights.light), dark: mean(|weights| weights.dark) }
            }
            None => self.weights(tone),
        };
        let (tensor, octave) = self.at_point(hatching.mesh, hatching.corners, hatching.barycentric);
        let octave = octave + hatching.octave;
        let Hatching { at, at_dx, at_dy, normal, .. } = *hatching;
        let left = self.hatched(&Sampled { at, at_dx, at_dy, normal, tensor, octave, tone, weights });
        let ground = match self.plan.shade.ground {
            HatchGround::Paper => paper,
            HatchGround::Surface => base,
        };
        hatch_color(left, ground, self.plan.shade.ink.as_dvec3())
    }
}

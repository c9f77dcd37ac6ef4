//! Shading of a hit. The GPU version is `shade/lights.wgsl`.

use super::FrameContext;
use super::surface::Footprint;
use crate::hatch::cpu::{Hatching, Strokes};
use crate::plan::PaintPlan;
use crate::rays::Hit;
use crate::shade::{LitPoint, ShadeModel, Shading};
use glam::{DVec2, DVec3, Vec3};
use npr_toon::border::toon_border_width;
use npr_toon::normal::{NormalUse, toon_piece_centroid};
use npr_toon::source::{Light, toon_to_light};
use npr_toon::{toon_n_dot_l, toon_n_dot_l_interpolated};

impl FrameContext<'_> {
    /// The shaded display-referred colour of a hit; `base` is its unshaded colour.
    pub(super) fn shaded(&self, hit: &Hit, base: DVec3, x: u32, y: u32) -> DVec3 {
        let Some(paint) = &self.plan.paint else { return self.plan.paper.as_dvec3() };
        let model = paint.shade.model();
        let shadow = self.shadow_at(hit);
        let light = self.light(paint, model, hit, hit.barycentric, shadow.dark);
        if let Some(strokes) = &self.strokes {
            return self.hatched(paint, model, hit, base, light.x, shadow.dark, x, y, strokes);
        }
        let widths = |of: &dyn Fn(DVec2) -> DVec2| {
            if paint.lights_faces() {
                // Light is constant around the pixel, or else ends at the border of a face or piece, not of a band.
                return DVec2::splat(toon_border_width(0.0, 0.0));
            }
            let Footprint { along_x, along_y, .. } = self.footprint(hit, x, y);
            // Every pixel of the 2×2 block uses this hit's shadow state, so a shadow border is not a border between
            // bands.
            let at = |weights| of(self.light(paint, model, hit, weights, shadow.dark)) - of(light);
            let (dx, dy) = (at(along_x), at(along_y));
            DVec2::new(toon_border_width(dx.x, dy.x), toon_border_width(dx.y, dy.y))
        };
        let normal = || {
            let normal = self.interpolate(hit, hit.barycentric).normal.normalize_or_zero();
            if shadow.negated { -normal } else { normal }
        };
        let light_color = paint.lights_of(hit.object).1;
        model.color(&Shading { base, light_color, light, normal: &normal, widths: &widths })
    }

    /// The lookup coordinates of a shade: the diffuse term and the second coordinate. In a cast shadow the diffuse term
    /// is negated if positive, as if the surface faced away from the light by the same angle.
    fn light(&self, paint: &PaintPlan, model: &dyn ShadeModel, hit: &Hit, weights: [f64; 3], in_shadow: bool) -> DVec2 {
        let lights = paint.lights_of(hit.object).0;
        let found = match paint.normals {
            NormalUse::PerPixel => {
                let surface = self.interpolate(hit, weights);
                self.light_at(paint, lights, model, &self.lit_point(surface.normal, surface.at))
            }
            NormalUse::Interpolated => light_interpolated(paint, lights, model, &self.corners(hit), weights),
            NormalUse::PerVertex => {
                let corners = self.corners(hit);
                corners
                    .iter()
                    .zip(weights)
                    .map(|(corner, weight)| self.light_at(paint, lights, model, corner) * weight)
                    .sum()
            }
            NormalUse::PerFace => self.light_at(paint, lights, model, &self.lit_facet(paint, hit)),
            NormalUse::PerSubdividedFace(divisions) => {
                let centroid = toon_piece_centroid(weights.into(), divisions);
                let surface = self.interpolate(hit, centroid.to_array());
                self.light_at(paint, lights, model, &self.lit_point(surface.normal, surface.at))
            }
        };
        if in_shadow { DVec2::new(-found.x.abs(), model.second_in_shadow(found.y)) } else { found }
    }

    pub(super) fn lit_point(&self, normal: DVec3, at: DVec3) -> LitPoint {
        let camera = &self.plan.view.camera;
        let eye = camera.homogeneous_eye();
        LitPoint { normal, at, to_eye: eye.truncate() - at * eye.w }
    }

    /// The centroid of the hit's face, with the face's own normal.
    fn lit_facet(&self, paint: &PaintPlan, hit: &Hit) -> LitPoint {
        let (object, _) = self.scene.placed(hit.object);
        // There are none for a shade that does not depend on light.
        let facet = paint.facets.get(object.mesh()).map(|facets| facets[hit.face as usize]);
        let (normal, at) = facet
            .map_or_else(Default::default, |facet| (self.normal(object, facet.normal), object.point(facet.centroid)));
        self.lit_point(if hit.front { normal } else { -normal }, at)
    }

    fn corners(&self, hit: &Hit) -> [LitPoint; 3] {
        let (object, mesh) = self.scene.placed(hit.object);
        let model = mesh.model();
        model.faces[hit.face as usize].map(|v| {
            let normal = self.normal(object, model.normals[v as usize]);
            self.lit_point(if hit.front { normal } else { -normal }, object.point(model.positions[v as usize]))
        })
    }

    pub(super) fn light_at(
        &self,
        paint: &PaintPlan,
        lights: &[Light],
        model: &dyn ShadeModel,
        point: &LitPoint,
    ) -> DVec2 {
        let Some(first) = lights.first() else { return DVec2::ZERO };
        let to_light = toon_to_light(first.place, point.at);
        let diffuse = model.diffuse(toon_n_dot_l(point.normal, to_light), f64::from(first.brightness));
        DVec2::new(diffuse, model.second(point, to_light, lights, &paint.view))
    }

    /// The display-referred colour of a hatched hit; `base` is its unshaded colour.
    #[expect(clippy::too_many_arguments, reason = "private, and called once")]
    fn hatched(
        &self,
        paint: &PaintPlan,
        model: &dyn ShadeModel,
        hit: &Hit,
        base: DVec3,
        diffuse: f64,
        in_shadow: bool,
        x: u32,
        y: u32,
        strokes: &Strokes<'_>,
    ) -> DVec3 {
        // Strokes lie in mesh space, so they move with the mesh.
        let (object, mesh) = self.scene.placed(hit.object);
        let corners = mesh.model().faces[hit.face as usize];
        let sum = |of: &[Vec3], weights: [f64; 3]| -> DVec3 {
            (0..3).map(|i| of[corners[i] as usize].as_dvec3() * weights[i]).sum()
        };
        let position = |weights| {
            strokes.position(sum(&mesh.model().positions, weights) * object.scale(), self.interpolate_uv(hit, weights))
        };
        let Footprint { along_x, dx, along_y, dy } = self.footprint(hit, x, y);
        let at = position(hit.barycentric);
        // The light at the vertices is that of the front face, so it does not apply to the back.
        let diffuse_of_corners =
            || hit.front.then(|| self.corners(hit).map(|corner| self.light_at(paint, &paint.lights, model, &corner).x));
        let hatching = Hatching {
            at,
            at_dx: (position(along_x) - at) * dx,
            at_dy: (position(along_y) - at) * dy,
            normal: sum(&mesh.model().normals, hit.barycentric).normalize_or_zero(),
            mesh: Some(object.mesh()),
            octave: object.scale().log2(),
            corners,
            barycentric: hit.barycentric,
            diffuse,
            in_shadow,
            diffuse_of_corners: &diffuse_of_corners,
        };
        strokes.color(&hatching, base, self.plan.paper.as_dvec3())
    }
}

/// Interpolates the unit vectors at the corners and uses them without renormalizing.
fn light_interpolated(
    paint: &PaintPlan,
    lights: &[Light],
    model: &dyn ShadeModel,
    corners: &[LitPoint; 3],
    weights: [f64; 3],
) -> DVec2 {
    let Some(first) = lights.first() else { return DVec2::ZERO };
    let mean = |of: &dyn Fn(&LitPoint) -> DVec3| -> DVec3 {
        corners.iter().zip(weights).map(|(corner, weight)| of(corner) * weight).sum()
    };
    let normal = mean(&|point| point.normal.normalize_or_zero());
    let to_light = mean(&|point| toon_to_light(first.place, point.at));
    let diffuse = model.diffuse(toon_n_dot_l_interpolated(normal, to_light), f64::from(first.brightness));
    let second = mean(&|point| model.second_vector(point, lights, &paint.view));
    DVec2::new(diffuse, model.second_interpolated(normal, to_light, second, lights, &paint.view))
}

//! The appearance of a hit: interpolated attributes, textures, colour.

use super::FrameContext;
use crate::color::encode_rgb;
use crate::image_lines::ImagePlan;
use crate::image_lines::cpu::{InkSample, gbuffer_texel, texel};
use crate::image_lines::gbuffer::texel::GBufferTexel;
use crate::plan::{Emission, PaintPlan};
use crate::rays::Hit;
use crate::scene::Object;
use crate::shadow::cpu::{ShadowAt, shadow_at};
use glam::{DVec2, DVec3, DVec4, Vec3};
use npr_imagespace::artist::{ArtistRotation, LineKind};
use npr_mesh::{AlphaMode, Material};
use npr_toon::painter::toon_material;

/// The attributes that are interpolated over a face.
pub(super) struct Surface {
    pub(super) normal: DVec3,
    pub(super) at: DVec3,
}

/// Barycentric weights at the two neighbouring pixels with which a 2×2 block of fragments takes its differences, each
/// with the sign that turns the difference into a derivative.
pub(super) struct Footprint {
    pub(super) along_x: [f64; 3],
    pub(super) dx: f64,
    pub(super) along_y: [f64; 3],
    pub(super) dy: f64,
}

impl FrameContext<'_> {
    pub(super) fn material(&self, hit: &Hit) -> &Material {
        self.scene.material(hit.object, hit.face)
    }

    pub(super) fn is_shown(&self, hit: &Hit) -> bool {
        hit.front || self.scene.shows_back(hit.object, hit.face)
    }

    pub(super) fn is_blended(&self, hit: &Hit) -> bool {
        self.material(hit).alpha_mode == AlphaMode::Blend
    }

    pub(super) fn is_cut_out(&self, hit: &Hit, x: u32, y: u32) -> bool {
        match self.material(hit).alpha_mode {
            AlphaMode::Mask { cutoff } => self.base_color(hit, x, y).w < f64::from(cutoff),
            _ => false,
        }
    }

    /// The barycentric weights where the ray through a point of the picture meets the face's plane. They may lie
    /// outside the face, as in a rasteriser, which extrapolates for its derivatives.
    fn extrapolated(&self, hit: &Hit, point_px: DVec2) -> [f64; 3] {
        let (origin, direction) = self.rays.through(point_px);
        // Barycentric weights are the same in mesh space.
        let (object, mesh) = self.scene.placed(hit.object);
        let (origin, direction) = object.ray(origin, direction);
        let model = mesh.model();
        let [a, b, c] = model.faces[hit.face as usize].map(|v| model.positions[v as usize].as_dvec3());
        let (ab, ac, from_a) = (b - a, c - a, origin - a);
        let across = direction.cross(ac);
        let determinant = ab.dot(across);
        let v = from_a.dot(across) / determinant;
        let w = direction.dot(from_a.cross(ab)) / determinant;
        [1.0 - v - w, v, w]
    }

    /// Whether a hit lies within the boundary inset on the screen, where the face is treated as absent.
    pub(super) fn is_inset(&self, hit: &Hit, x: u32, y: u32) -> bool {
        if self.boundary_inset_px <= 0.0 {
            return false;
        }
        let boundaries = self.scene.placed(hit.object).1.boundary_sides()[hit.face as usize];
        if boundaries == 0 {
            return false;
        }
        let (x, y) = (f64::from(x), f64::from(y));
        let beside = [(x + 1.0, y), (x, y + 1.0)].map(|(x, y)| self.extrapolated(hit, self.sample_point(x, y)));
        (0..3).filter(|side| boundaries >> side & 1 != 0).any(|side| {
            // The weight of the corner opposite a side is 0 on that side and nearly linear on the screen.
            let opposite = (side + 2) % 3;
            let weight = hit.barycentric[opposite];
            let per_px = DVec2::new(beside[0][opposite] - weight, beside[1][opposite] - weight).length();
            weight < self.boundary_inset_px * per_px
        })
    }

    pub(super) fn footprint(&self, hit: &Hit, x: u32, y: u32) -> Footprint {
        let beside = |index: u32| if index.is_multiple_of(2) { 1.0 } else { -1.0 };
        let (dx, dy) = (beside(x), beside(y));
        let (px, py) = (f64::from(x), f64::from(y));
        let along_x = self.extrapolated(hit, self.sample_point(px + dx, py));
        let along_y = self.extrapolated(hit, self.sample_point(px, py + dy));
        Footprint { along_x, dx, along_y, dy }
    }

    pub(super) fn interpolate_uv(&self, hit: &Hit, weights: [f64; 3]) -> DVec2 {
        let model = self.scene.placed(hit.object).1.model();
        if model.uvs.is_empty() {
            return DVec2::ZERO;
        }
        let corners = model.faces[hit.face as usize];
        (0..3).map(|i| model.uvs[corners[i] as usize].as_dvec2() * weights[i]).sum()
    }

    /// A normal of a mesh, as the plan places it.
    pub(super) fn normal(&self, object: &Object, normal: Vec3) -> DVec3 {
        if self.plan.mesh_normals { normal.as_dvec3() } else { object.normal(normal) }
    }

    pub(super) fn interpolate(&self, hit: &Hit, weights: [f64; 3]) -> Surface {
        let (object, mesh) = self.scene.placed(hit.object);
        let model = mesh.model();
        let corners = model.faces[hit.face as usize].map(|v| v as usize);
        let normal: DVec3 = (0..3).map(|i| self.normal(object, model.normals[corners[i]]) * weights[i]).sum();
        let at = (0..3).map(|i| object.point(model.positions[corners[i]]) * weights[i]).sum();
        Surface { normal: if hit.front { normal } else { -normal }, at }
    }

    /// Linear colour and alpha: material × texture × vertex colour, excluding a texture or vertex colour that encodes
    /// lines. For shades that use the texture's alpha as a blend factor, see [`toon_material`].
    fn base_color(&self, hit: &Hit, x: u32, y: u32) -> DVec4 {
        let mut color = self.material(hit).base_color.as_dvec4();
        let kind = self.line_kind(hit);
        if kind != LineKind::VertexColor {
            color *= self.vertex_color(hit);
        }
        if kind == LineKind::Texture || self.material(hit).texture.is_none() {
            return color;
        }
        let texel = self.texture_color(hit, x, y);
        match &self.plan.paint {
            Some(paint) if paint.shade.model().material_by_alpha() => toon_material(color, texel),
            _ => color * texel,
        }
    }

    /// The alpha of a blended hit.
    pub(super) fn opacity(&self, hit: &Hit, x: u32, y: u32) -> f64 {
        self.base_color(hit, x, y).w
    }

    /// The linear vertex colour; white if there is none.
    pub(super) fn vertex_color(&self, hit: &Hit) -> DVec4 {
        if self.scene.placed(hit.object).1.model().colors.is_empty() {
            return DVec4::ONE;
        }
        let colors = self.corner_colors(hit);
        (0..3).map(|i| colors[i] * hit.barycentric[i]).sum()
    }

    /// The linear vertex colours of the hit's face; white if there are none.
    fn corner_colors(&self, hit: &Hit) -> [DVec4; 3] {
        let model = self.scene.placed(hit.object).1.model();
        let color = |vertex: u32| model.colors.get(vertex as usize).map_or(DVec4::ONE, |color| color.as_dvec4());
        model.faces[hit.face as usize].map(color)
    }

    /// The linear filtered texture colour; white if there is none.
    pub(super) fn texture_color(&self, hit: &Hit, x: u32, y: u32) -> DVec4 {
        self.material(hit).texture.map_or(DVec4::ONE, |texture| self.sampled(texture, hit, x, y))
    }

    /// The linear filtered colour of a texture.
    fn sampled(&self, texture: u32, hit: &Hit, x: u32, y: u32) -> DVec4 {
        let texture = self.scene.mip_mapped(texture);
        let Footprint { along_x, dx, along_y, dy } = self.footprint(hit, x, y);
        let uv = self.interpolate_uv(hit, hit.barycentric);
        let uv_dx = (self.interpolate_uv(hit, along_x) - uv) * dx;
        let uv_dy = (self.interpolate_uv(hit, along_y) - uv) * dy;
        texture.sample(uv, texture.level(uv_dx, uv_dy))
    }

    /// The source of the inner lines of the hit's material.
    pub(super) fn line_kind(&self, hit: &Hit) -> LineKind {
        let material = self.scene.material_number(hit.object, hit.face);
        self.plan.image.as_ref().map_or(LineKind::Normals, |image| image.line_kinds[material])
    }

    /// The display-referred colour that a hit emits. Light and shadow do not change it.
    fn emitted(&self, hit: &Hit, x: u32, y: u32) -> DVec3 {
        let material = self.material(hit);
        let emissive = material.emissive.as_dvec3();
        match (self.plan.emission(material), material.emissive_texture) {
            (Emission::None, _) => DVec3::ZERO,
            (Emission::Textured, Some(texture)) => encode_rgb(emissive * self.sampled(texture, hit, x, y).truncate()),
            _ => encode_rgb(emissive),
        }
    }

    /// The display-referred colour of a hit, and its opacity.
    pub(super) fn paint(&self, hit: &Hit, x: u32, y: u32) -> DVec4 {
        let number = self.scene.material_number(hit.object, hit.face);
        let material = &self.scene.materials()[number];
        let is_shown = material.alpha_mode == AlphaMode::Blend
            || self.plan.paint.as_ref().is_some_and(PaintPlan::shows_surface_color);
        let has_colors = || !self.scene.placed(hit.object).1.model().colors.is_empty();
        let plain = !is_shown || material.texture.is_none() && !has_colors();
        let (base, alpha) = if plain {
            (self.scene.material_colors[number], f64::from(material.base_color.w))
        } else {
            let linear = self.base_color(hit, x, y);
            (encode_rgb(linear.truncate()), linear.w)
        };
        // Clamped, as a render target clamps it before blending.
        let lit = (self.shaded(hit, base, x, y) + self.emitted(hit, x, y)).clamp(DVec3::ZERO, DVec3::ONE);
        let opacity = match material.alpha_mode {
            AlphaMode::Blend => alpha.clamp(0.0, 1.0),
            _ => 1.0,
        };
        lit.extend(opacity)
    }

    /// The shadow state of a hit. Blended surfaces receive no shadows.
    pub(super) fn shadow_at(&self, hit: &Hit) -> ShadowAt {
        let Some(shadow) = self.plan.shadow.as_ref().filter(|_| !self.is_blended(hit)) else {
            return ShadowAt::default();
        };
        let surface = self.interpolate(hit, hit.barycentric);
        shadow_at(shadow, self.scene, hit, surface.at, surface.normal)
    }

    /// The packed G-buffer value of a pixel, for lines in the image.
    pub(super) fn texel(&self, hit: Option<&Hit>, x: u32, y: u32) -> [u32; 2] {
        self.plan.image.as_ref().map_or([0; 2], |image| self.of_sample(image, hit, x, y, texel))
    }

    /// The unquantised G-buffer value of a pixel.
    pub(super) fn gbuffer_texel(&self, hit: Option<&Hit>, x: u32, y: u32) -> GBufferTexel {
        self.plan.image.as_ref().map_or([0; 4], |image| self.of_sample(image, hit, x, y, gbuffer_texel))
    }

    fn of_sample<T>(
        &self,
        image: &ImagePlan,
        hit: Option<&Hit>,
        x: u32,
        y: u32,
        texel: impl Fn(&ImagePlan, Option<&InkSample<'_>>) -> T,
    ) -> T {
        let Some(hit) = hit else { return texel(image, None) };
        let texture_bytes = || {
            let texture = self.material(hit).texture?;
            Some(self.scene.mip_mapped(texture).nearest_bytes(self.interpolate_uv(hit, hit.barycentric)))
        };
        let camera = &self.plan.view.camera;
        let eye = camera.homogeneous_eye();
        let from_eye = |point: DVec3| point * eye.w - eye.truncate();
        let rotation = image.artist_rotation(self.scene.material_number(hit.object, hit.face));
        let sample = InkSample {
            region: image.regions.of_face(self.scene, hit.object, hit.face),
            kind: self.line_kind(hit),
            normal: self.interpolate(hit, hit.barycentric).normal,
            depth: hit.t,
            vertex_color: &|| self.vertex_color(hit),
            texture_color: &|| self.texture_color(hit, x, y),
            texture_bytes: &texture_bytes,
            rotation,
            from_eye: &|| match rotation {
                ArtistRotation::PerObject => from_eye(self.scene.middle_of(hit.object)),
                _ => self.rays.through(self.sample_point(f64::from(x), f64::from(y))).1,
            },
            corners: &|| {
                let points = self.scene.face_corners(hit.object, hit.face);
                let colors = self.corner_colors(hit);
                [0, 1, 2].map(|i| (hit.barycentric[i], colors[i], from_eye(points[i])))
            },
            view_axes: camera.axes(),
            shadow: &|| self.shadow_at(hit),
        };
        texel(image, Some(&sample))
    }
}

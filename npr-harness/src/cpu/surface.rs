//! What a ray's hit looks like.

use super::FrameContext;
use crate::color::encode_rgb;
use crate::rays::Hit;
use crate::style::Shade;
use glam::{DVec2, DVec3, DVec4};
use npr_imagespace::artist::LineKind;
use npr_mesh::{AlphaMode, Material};
use npr_toon::{toon_n_dot_h, toon_n_dot_l, toon_shade, toon_width};

/// What is interpolated over a face.
pub(super) struct Surface {
    pub(super) normal: DVec3,
    to_eye: DVec3,
}

/// Weights of a face's corners at the two pixels beside a pixel with which a 2×2 block of fragments takes its
/// differences, each with the sign that makes the difference a derivative.
struct Footprint {
    along_x: [f64; 3],
    dx: f64,
    along_y: [f64; 3],
    dy: f64,
}

impl FrameContext<'_> {
    pub(super) fn material(&self, hit: &Hit) -> &Material {
        &self.scene.model.materials[self.scene.model.face_material[hit.face as usize] as usize]
    }

    pub(super) fn is_shown(&self, hit: &Hit) -> bool {
        hit.front || self.material(hit).double_sided
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

    /// The weights of a face's corners where the ray through a point of the picture meets the face's plane. Outside the
    /// face too: that is what a rasteriser extrapolates to for its derivatives.
    fn extrapolated(&self, hit: &Hit, point_px: DVec2) -> [f64; 3] {
        let (origin, direction) = self.camera.ray(point_px, self.size_px);
        let [a, b, c] =
            self.scene.model.faces[hit.face as usize].map(|v| self.scene.model.positions[v as usize].as_dvec3());
        let (ab, ac, from_a) = (b - a, c - a, origin - a);
        let across = direction.cross(ac);
        let determinant = ab.dot(across);
        let v = from_a.dot(across) / determinant;
        let w = direction.dot(from_a.cross(ab)) / determinant;
        [1.0 - v - w, v, w]
    }

    /// Whether a hit is so near to a boundary, on the screen, that the face is taken to end before it.
    pub(super) fn is_inset(&self, hit: &Hit, x: u32, y: u32) -> bool {
        if self.boundary_inset_px <= 0.0 {
            return false;
        }
        let boundaries = self.scene.boundary_sides()[hit.face as usize];
        if boundaries == 0 {
            return false;
        }
        let (x, y) = (f64::from(x), f64::from(y));
        let beside = [(x + 1.0, y), (x, y + 1.0)].map(|(x, y)| self.extrapolated(hit, self.sample_point(x, y)));
        (0..3).filter(|side| boundaries >> side & 1 != 0).any(|side| {
            // The weight of the corner opposite to a side is 0 on it and nearly linear on the screen.
            let opposite = (side + 2) % 3;
            let weight = hit.barycentric[opposite];
            let per_px = DVec2::new(beside[0][opposite] - weight, beside[1][opposite] - weight).length();
            weight < self.boundary_inset_px * per_px
        })
    }

    fn footprint(&self, hit: &Hit, x: u32, y: u32) -> Footprint {
        let beside = |index: u32| if index.is_multiple_of(2) { 1.0 } else { -1.0 };
        let (dx, dy) = (beside(x), beside(y));
        let (px, py) = (f64::from(x), f64::from(y));
        let along_x = self.extrapolated(hit, self.sample_point(px + dx, py));
        let along_y = self.extrapolated(hit, self.sample_point(px, py + dy));
        Footprint { along_x, dx, along_y, dy }
    }

    pub(super) fn interpolate_uv(&self, hit: &Hit, weights: [f64; 3]) -> DVec2 {
        let model = &self.scene.model;
        if model.uvs.is_empty() {
            return DVec2::ZERO;
        }
        let corners = model.faces[hit.face as usize];
        (0..3).map(|i| model.uvs[corners[i] as usize].as_dvec2() * weights[i]).sum()
    }

    pub(super) fn interpolate(&self, hit: &Hit, weights: [f64; 3]) -> Surface {
        let model = &self.scene.model;
        let corners = model.faces[hit.face as usize];
        let sum =
            |of: &[glam::Vec3]| -> DVec3 { (0..3).map(|i| of[corners[i] as usize].as_dvec3() * weights[i]).sum() };
        let normal = sum(&model.normals);
        let eye = self.camera.homogeneous_eye();
        Surface {
            normal: if hit.front { normal } else { -normal },
            to_eye: eye.truncate() - sum(&model.positions) * eye.w,
        }
    }

    /// Linear colour and alpha: material × texture × vertex colour, without what says where lines are.
    fn base_color(&self, hit: &Hit, x: u32, y: u32) -> DVec4 {
        let mut color = self.material(hit).base_color.as_dvec4();
        let kind = self.line_kind(hit);
        if kind != LineKind::VertexColor {
            color *= self.vertex_color(hit);
        }
        if kind != LineKind::Texture {
            color *= self.texture_color(hit, x, y);
        }
        color
    }

    /// Linear; white where there is none.
    pub(super) fn vertex_color(&self, hit: &Hit) -> DVec4 {
        let model = &self.scene.model;
        if model.colors.is_empty() {
            return DVec4::ONE;
        }
        let corners = model.faces[hit.face as usize];
        (0..3).map(|i| model.colors[corners[i] as usize].as_dvec4() * hit.barycentric[i]).sum()
    }

    /// Linear, filtered; white where there is none.
    pub(super) fn texture_color(&self, hit: &Hit, x: u32, y: u32) -> DVec4 {
        let Some(texture) = self.material(hit).texture else { return DVec4::ONE };
        let texture = &self.textures[texture as usize];
        let Footprint { along_x, dx, along_y, dy } = self.footprint(hit, x, y);
        let uv = self.interpolate_uv(hit, hit.barycentric);
        let uv_dx = (self.interpolate_uv(hit, along_x) - uv) * dx;
        let uv_dy = (self.interpolate_uv(hit, along_y) - uv) * dy;
        texture.sample(uv, texture.level(uv_dx, uv_dy))
    }

    /// Where a material's inner lines come from.
    pub(super) fn line_kind(&self, hit: &Hit) -> LineKind {
        let material = self.scene.model.face_material[hit.face as usize] as usize;
        self.plan.image.as_ref().map_or(LineKind::Normals, |image| image.line_kinds[material])
    }

    /// The display-referred colour of a hit, and its opacity.
    pub(super) fn paint(&self, hit: &Hit, x: u32, y: u32) -> DVec4 {
        let material = self.scene.model.face_material[hit.face as usize] as usize;
        let plain = self.scene.model.colors.is_empty() && self.scene.model.materials[material].texture.is_none();
        let (base, alpha) = if plain {
            (self.scene.material_colors[material], f64::from(self.scene.model.materials[material].base_color.w))
        } else {
            let linear = self.base_color(hit, x, y);
            (encode_rgb(linear.truncate()), linear.w)
        };
        let lit = match &self.style.shade {
            Shade::Paper => self.style.paper.as_dvec3(),
            Shade::Lambert { ambient } => {
                let here = self.interpolate(hit, hit.barycentric);
                let ambient = f64::from(*ambient);
                base * (ambient + (1.0 - ambient) * toon_n_dot_l(here.normal, self.to_light).max(0.0))
            }
            Shade::Toon(bands) => {
                let light = |weights| {
                    let here = self.interpolate(hit, weights);
                    let n_dot_h = if bands.highlight.is_some() {
                        toon_n_dot_h(here.normal, self.to_light, here.to_eye)
                    } else {
                        0.0
                    };
                    DVec2::new(toon_n_dot_l(here.normal, self.to_light), n_dot_h)
                };
                let here = light(hit.barycentric);
                let width = if bands.antialias {
                    let Footprint { along_x, along_y, .. } = self.footprint(hit, x, y);
                    let (dx, dy) = (light(along_x) - here, light(along_y) - here);
                    DVec2::new(toon_width(dx.x, dy.x), toon_width(dx.y, dy.y))
                } else {
                    DVec2::ZERO
                };
                toon_shade(bands, base, here.x, width.x, here.y, width.y)
            }
        };
        let opacity = match self.scene.model.materials[material].alpha_mode {
            AlphaMode::Blend => alpha.clamp(0.0, 1.0),
            _ => 1.0,
        };
        lit.extend(opacity)
    }
}

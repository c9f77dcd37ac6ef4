//! What a picture shows: a model, ready for both executors, and its light.

use crate::camera::Camera;
use crate::color::encode_rgb;
use crate::derived::Derived;
use crate::error::HarnessError;
use crate::rays::RayCaster;
use crate::suggest::nearest;
use crate::texture::MipMapped;
use glam::{DVec3, DVec4, Vec3};
use npr_imagespace::artist::LineKind;
use npr_mesh::edges::{self, EdgeKind, EdgeOptions, Edges};
use npr_mesh::{AlphaMode, Model};
use std::sync::OnceLock;

/// A model with everything that is derived from it once.
pub struct Scene {
    /// Its positions are relative to [`Scene::origin`], and multiplied by [`Scene::scale`]. It must not be changed: what is
    /// derived from it is kept.
    pub model: Model,
    /// What the positions are relative to, in the model's own units: 0, or the model's middle where that is far from 0,
    /// since f32 positions keep their precision only near 0.
    pub origin: DVec3,
    /// What the model's own units are multiplied by: 1, or a power of two where the half of the box's diagonal is not
    /// within 2⁻²⁰..=2²⁰ of them. Squares and products of lengths then stay within f32, on a device, too.
    pub scale: f64,
    /// For drawing: redundant faces left out.
    pub edges: Edges,
    /// Per material its colour without texture and vertex colour, display-referred.
    pub material_colors: Vec<DVec3>,
    /// Whether every edge has two faces, wound alike, so that no back of a face can be seen from outside.
    pub closed: bool,
    /// Cuts the scene: shown is where n · p + d >= 0 for the plane (n, d), for positions as they are here (see
    /// [`Scene::plane_here`]). The lines of a model's edges do not know of it; those found in the image do.
    pub clip: Option<DVec4>,
    /// Per material where its inner lines come from, in styles that ask: [`ImageInk::artist`]. All from their normals
    /// to begin with.
    ///
    /// [`ImageInk::artist`]: crate::image_lines::ImageInk::artist
    pub line_kinds: Vec<LineKind>,
    rays: OnceLock<RayCaster>,
    boundary_sides: OnceLock<Vec<u8>>,
    bounds: OnceLock<Option<(Vec3, Vec3)>>,
    /// What techniques derive from it.
    pub(crate) derived: Derived,
    mip_mapped: OnceLock<Vec<MipMapped>>,
}

impl Scene {
    /// Finds a model's edges and prepares it. Faces without material get [`npr_mesh::Material::default`].
    pub fn new(mut model: Model) -> Self {
        model.fill_face_material();
        let bounds = model.bounds();
        let (origin, scale) = normalize(&mut model, bounds);
        let moved = origin != DVec3::ZERO || scale != 1.0;
        let edges = edges::find(
            &model.positions,
            &model.faces,
            &model.face_polygon,
            &model.face_material,
            &EdgeOptions::default(),
        );
        let closed = !edges.edges.is_empty()
            && edges.skipped.is_empty()
            && edges.edges.iter().all(|edge| edge.kind() == EdgeKind::TwoFace && !edge.wound_oppositely())
            && signed_volume(&model) > 0.0;
        let material_colors = model.materials.iter().map(|m| encode_rgb(m.base_color.truncate().as_dvec3())).collect();
        let line_kinds = vec![LineKind::Normals; model.materials.len()];
        Self {
            model,
            origin,
            scale,
            edges,
            material_colors,
            closed,
            clip: None,
            line_kinds,
            rays: OnceLock::new(),
            boundary_sides: OnceLock::new(),
            bounds: if moved { OnceLock::new() } else { OnceLock::from(bounds) },
            derived: Derived::default(),
            mip_mapped: OnceLock::new(),
        }
    }

    /// Says where the inner lines of all materials of a name come from.
    ///
    /// # Errors
    /// [`HarnessError::UnknownMaterial`].
    pub fn set_line_kind(&mut self, material: &str, kind: LineKind) -> Result<(), HarnessError> {
        let mut known = false;
        for (of, line_kind) in self.model.materials.iter().zip(&mut self.line_kinds) {
            if of.name == material {
                (known, *line_kind) = (true, kind);
            }
        }
        if known {
            return Ok(());
        }
        let names = self.model.materials.iter().map(|m| format!("{:?}", m.name)).collect::<Vec<_>>().join(", ");
        let nearest = nearest(material, self.model.materials.iter().map(|m| m.name.as_str())).map(str::to_owned);
        Err(HarnessError::UnknownMaterial { name: material.to_owned(), nearest, known: names })
    }

    /// A place in the model's own space, in the space of the positions here.
    pub fn place_here(&self, place: DVec3) -> DVec3 {
        (place - self.origin) * self.scale
    }

    /// A plane (n, d) of the model's own space, n · p + d = 0, in the space of the positions here: the same plane, with
    /// the same sides, and n made unit. n must not be zero.
    pub fn plane_here(&self, plane: DVec4) -> DVec4 {
        // Of any size: first by the largest component, so that no square leaves the range of f64.
        let largest = plane.truncate().abs().max_element();
        let (normal, offset) = (plane.truncate() / largest, plane.w / largest);
        let length = normal.length();
        let (normal, offset) = (normal / length, offset / length);
        // A plane that is so far away cuts off all or nothing, and its number is an f32 on a device.
        let offset = ((normal.dot(self.origin) + offset) * self.scale).clamp(-FARTHEST, FARTHEST);
        normal.extend(offset)
    }

    /// Whether a point is on the side that is shown.
    pub fn keeps(&self, point: DVec3) -> bool {
        self.clip.is_none_or(|plane| plane.dot(point.extend(1.0)) >= 0.0)
    }

    /// The ray caster, built when it is first asked for.
    pub fn rays(&self) -> &RayCaster {
        self.rays.get_or_init(|| RayCaster::new(&self.model.positions, &self.model.faces))
    }

    /// Does `work` while other threads build the ray caster. On two cores a picture of 1.1 million faces whose plan is made
    /// so takes 0.94 of the time, one of 4.4 million 0.89.
    pub fn while_building_rays<R>(&self, work: impl FnOnce() -> R) -> R {
        if std::thread::available_parallelism().map_or(1, usize::from) == 1 {
            return work();
        }
        std::thread::scope(|scope| {
            scope.spawn(|| self.rays());
            work()
        })
    }

    /// The model's textures with their mip levels.
    pub fn mip_mapped(&self) -> &[MipMapped] {
        self.mip_mapped.get_or_init(|| self.model.textures.iter().map(MipMapped::new).collect())
    }

    /// Per face which of its sides no other face has: bit i for the side from corner i to the next.
    pub fn boundary_sides(&self) -> &[u8] {
        self.boundary_sides.get_or_init(|| {
            let mut sides = vec![0; self.model.faces.len()];
            for edge in self.edges.edges.iter().filter(|edge| edge.kind() == EdgeKind::Boundary) {
                let face = edge.faces()[0] as usize;
                let corners = self.model.faces[face].map(|v| self.edges.representative[v as usize]);
                for side in 0..3 {
                    if edge.ends.contains(&corners[side]) && edge.ends.contains(&corners[(side + 1) % 3]) {
                        sides[face] |= 1 << side;
                    }
                }
            }
            sides
        })
    }

    /// Whether any face is blended over what is behind it.
    pub fn has_blend(&self) -> bool {
        self.model.materials.iter().any(|m| m.alpha_mode == AlphaMode::Blend)
    }

    /// The positions of all vertices that are corners of faces, each once.
    pub fn corners(&self) -> impl Iterator<Item = Vec3> + Clone + '_ {
        let mut used = vec![false; self.model.positions.len()];
        for &vertex in self.model.faces.iter().flatten() {
            used[vertex as usize] = true;
        }
        self.model.positions.iter().zip(used).filter_map(|(&position, used)| used.then_some(position))
    }

    /// Of the model's box, found when it is first asked for; `None` without faces.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        *self.bounds.get_or_init(|| self.model.bounds())
    }

    /// The range of eye depth in which the scene lies, before the camera.
    pub(crate) fn depth_range(&self, camera: &Camera) -> (f64, f64) {
        let back = camera.axes()[2];
        let (low, high) = self.bounds().map_or((DVec3::ZERO, DVec3::ZERO), |(l, h)| (l.as_dvec3(), h.as_dvec3()));
        let depth = |corner: DVec3| (camera.eye - corner).dot(back);
        let nearest = depth(DVec3::select(back.cmpgt(DVec3::ZERO), high, low));
        let farthest = depth(DVec3::select(back.cmpgt(DVec3::ZERO), low, high));
        // A thousandth to spare, so that nothing of the scene is clamped to the range's ends.
        let spare = 1e-3 * (farthest - nearest);
        let near = (nearest - spare).max(camera.near * 0.999);
        (near, (farthest + spare).max(near * 1.001))
    }

    /// The middle of the bounding box.
    pub fn middle(&self) -> DVec3 {
        self.bounds().map_or(DVec3::ZERO, |(low, high)| low.as_dvec3().midpoint(high.as_dvec3()))
    }

    /// The half of the bounding box's diagonal.
    pub fn radius(&self) -> f64 {
        self.bounds().map_or(0.0, |(low, high)| f64::from((high - low).length()) / 2.0)
    }
}

/// Nothing of a scene is so far away that more would show. Its square is well within f32.
pub(crate) const FARTHEST: f64 = 1e15;

/// Beyond 2 to this, and below 2 to minus this, a scene is brought to another size.
const OCTAVES: i32 = 20;

/// Moves a model that is far from the origin, measured in its own size, to the origin; then brings one that is very large
/// or very small to a size of about 1, by a power of two, which rounds nothing. Returns what was subtracted, and then the
/// factor.
///
/// Others stay where they are: a subtraction could round two positions to one. Far away it cannot, since there
/// the difference of two f32 is exact.
///
/// `bounds`: the model's.
fn normalize(model: &mut Model, bounds: Option<(Vec3, Vec3)>) -> (DVec3, f64) {
    let Some((low, high)) = bounds else { return (DVec3::ZERO, 1.0) };
    let (low, high) = (low.as_dvec3(), high.as_dvec3());
    let (middle, diagonal) = (low.midpoint(high), (high - low).length());
    if !(middle.is_finite() && diagonal.is_finite()) {
        return (DVec3::ZERO, 1.0);
    }
    let origin = if middle.length() < 4.0 * diagonal { DVec3::ZERO } else { middle.as_vec3().as_dvec3() };
    let octave = if diagonal > 0.0 { (diagonal / 2.0).log2().floor() as i32 } else { 0 };
    let scale = if octave.abs() > OCTAVES { 2f64.powi(-octave) } else { 1.0 };
    if origin != DVec3::ZERO || scale != 1.0 {
        for position in &mut model.positions {
            let here = ((position.as_dvec3() - origin) * scale).as_vec3();
            // What no face uses may lie anywhere, and is not seen.
            *position = if here.is_finite() { here } else { Vec3::ZERO };
        }
    }
    (origin, scale)
}

fn signed_volume(model: &Model) -> f64 {
    let corner = |v: u32| model.positions[v as usize].as_dvec3();
    model.faces.iter().map(|&[a, b, c]| corner(a).dot(corner(b).cross(corner(c)))).sum::<f64>() / 6.0
}

//! Triangles as plain arrays.

use crate::SideVisibility;
use glam::{Vec2, Vec3, Vec4};
use std::sync::Arc;

/// Triangles in one vertex array, with their materials: a mesh, or several meshes in one space.
///
/// A *vertex* is a shading vertex: a position with its normal, texture coordinate and colour. Several vertices may
/// have one position, for instance at a texture seam; [`crate::edges`] treats them as one.
///
/// Parallel arrays have equal lengths or, where stated, may be empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// Per vertex: the position, right-handed, Y up.
    pub positions: Vec<Vec3>,
    /// Per vertex: the unit normal for shading.
    pub normals: Vec<Vec3>,
    /// Per vertex, or empty: the texture coordinate with the origin at the upper left of the image (v increases
    /// downwards).
    pub uvs: Vec<Vec2>,
    /// Per vertex, or empty: a linear RGBA factor on the material's colour.
    pub colors: Vec<Vec4>,
    /// Three vertex indices each, counter-clockwise seen from outside.
    pub faces: Vec<[u32; 3]>,
    /// Per face, or empty if faces have no material: an index into [`Model::materials`]. Faces without material are
    /// opaque.
    pub face_material: Vec<u32>,
    /// Per face, or empty if there is one mesh: the index of its mesh. A mesh is an object or group in an `.obj` file,
    /// and each of several objects in one model. Appended models keep their meshes.
    pub face_mesh: Vec<u32>,
    /// Per face, or empty if every face is a polygon of its own: the index of the polygon of the file that the face
    /// was cut from. Faces of one polygon are adjacent and the indices ascend. An edge between two faces of one
    /// polygon is a diagonal added by triangulation and never a line.
    pub face_polygon: Vec<u32>,
    /// Per face, or empty: whether only its front is shown, whatever its material says, since another face is at its place
    /// ([`crate::coplanar`]). No loader sets it.
    pub one_sided: Vec<bool>,
    /// The line segments that the file itself draws, each between two vertices: polylines of an `.obj` file, primitives
    /// of lines in glTF. They are drawn as lines wherever surfaces do not hide them, and are no edges of faces.
    pub lines: Vec<[u32; 2]>,
    /// Per face, or empty if the file says nothing: which of its sides (between corners 0 and 1, 1 and 2, 2 and 0) the
    /// file wants drawn as lines. See [`crate::edge_visibility`].
    pub side_visibility: Vec<[SideVisibility; 3]>,
    /// The materials; at least as many as [`Model::face_material`] refers to.
    pub materials: Vec<Material>,
    /// The images that the materials refer to.
    pub textures: Vec<Texture>,
}

/// A material, reduced to what flat shading needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name in the file, or empty.
    pub name: String,
    /// Linear RGBA. It is multiplied with the texture and the vertex colour in linear light; the product is encoded
    /// once.
    pub base_color: Vec4,
    /// Index into [`Model::textures`].
    pub texture: Option<u32>,
    /// The colour that the surface emits: linear RGB, at least 0, and above 1 for strong lights. It is multiplied with
    /// the emissive texture in linear light. Neither light nor shadow changes it; other surfaces are not lit by it.
    pub emissive: Vec3,
    /// Index into [`Model::textures`] of the texture of [`Material::emissive`], whose alpha has no meaning. It has the
    /// same texture coordinates as [`Material::texture`].
    pub emissive_texture: Option<u32>,
    /// The meaning of the alpha of the product.
    pub alpha_mode: AlphaMode,
    /// Whether back faces are shaded, with the normal negated, or culled.
    pub double_sided: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec4::new(0.8, 0.8, 0.8, 1.0),
            texture: None,
            emissive: Vec3::ZERO,
            emissive_texture: None,
            alpha_mode: AlphaMode::Opaque,
            double_sided: true,
        }
    }
}

impl Material {
    /// The material with other indices of its textures.
    #[must_use]
    pub fn with_textures(&self, mut number: impl FnMut(u32) -> u32) -> Self {
        let [texture, emissive_texture] = [self.texture, self.emissive_texture].map(|of| of.map(&mut number));
        Self { texture, emissive_texture, ..self.clone() }
    }
}

/// The meaning of a surface's alpha (glTF 2.0, 3.9.4 "Alpha Coverage").
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored; the surface is opaque.
    #[default]
    Opaque,
    /// Opaque where alpha is at least the cutoff, and invisible elsewhere.
    Mask {
        /// The minimum alpha that is visible, usually 0..=1; above 1 nothing is visible.
        cutoff: f32,
    },
    /// Blended over the surfaces behind; drawn after all others from back to front.
    Blend,
}

/// An image in memory and its sampling.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The origin of the image, for messages.
    pub name: String,
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// `width * height * 4` bytes, rows from the top: sRGB-encoded red, green, blue, and linear alpha.
    /// Textures of several models may share them.
    pub rgba8: Arc<[u8]>,
    /// The addressing outside 0..1 along u and v.
    pub wrap: [Wrap; 2],
    /// Whether magnification interpolates linearly or shows the nearest texel.
    pub smooth: bool,
}

/// The addressing of a texture outside 0..1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The texture repeats.
    #[default]
    Repeat,
    /// The texture repeats, mirrored in every other tile.
    Mirror,
    /// The border texels continue.
    Clamp,
}

impl Model {
    /// The material of a face, or `None` if it has none.
    pub fn material_of(&self, face: u32) -> Option<&Material> {
        self.materials.get(*self.face_material.get(face as usize)? as usize)
    }

    /// Whether a face is one of [`Model::one_sided`].
    pub fn is_one_sided(&self, face: u32) -> bool {
        self.one_sided.get(face as usize) == Some(&true)
    }

    /// Whether the back of a face is shown.
    pub fn shows_back(&self, face: u32) -> bool {
        !self.is_one_sided(face) && self.material_of(face).is_none_or(|material| material.double_sided)
    }

    /// If faces have no material ([`Model::face_material`] is empty), adds [`Material::default`] and assigns it to
    /// all faces.
    pub fn fill_face_material(&mut self) {
        if self.face_material.is_empty() && !self.faces.is_empty() {
            self.face_material = vec![self.materials.len() as u32; self.faces.len()];
            self.materials.push(Material::default());
        }
    }

    /// Appends another model.
    ///
    /// Optional arrays that only one of the models has are filled for the other: texture coordinates with zeros,
    /// colours with white, polygons with one per face, materials with [`Material::default`], sides with
    /// [`SideVisibility::Unstated`]. The meshes of both
    /// models remain distinct.
    pub fn append(&mut self, other: &Model) {
        let has_materials = !self.face_material.is_empty() || !other.face_material.is_empty();
        if has_materials {
            self.fill_face_material();
        }
        let first_material = self.materials.len() as u32;
        let first_texture = self.textures.len() as u32;
        if !self.faces.is_empty() || !other.face_mesh.is_empty() {
            self.face_mesh.resize(self.faces.len(), 0);
            let first_mesh = self.face_mesh.iter().max().map_or(0, |last| last + 1);
            let of = |face: usize| other.face_mesh.get(face).copied().unwrap_or(0);
            self.face_mesh.extend((0..other.faces.len()).map(|face| first_mesh + of(face)));
        }
        self.append_geometry(other);
        self.face_material.extend(other.face_material.iter().map(|m| m + first_material));
        self.materials.extend(other.materials.iter().map(|m| m.with_textures(|t| t + first_texture)));
        self.textures.extend_from_slice(&other.textures);
        if has_materials && other.face_material.is_empty() && !other.faces.is_empty() {
            self.face_material.resize(self.faces.len(), self.materials.len() as u32);
            self.materials.push(Material::default());
        }
    }

    /// Appends the vertices, faces, polygons and lines of another model, without its materials and meshes.
    pub(crate) fn append_geometry(&mut self, other: &Model) {
        let first_vertex = self.positions.len() as u32;
        append_optional(&mut self.uvs, self.positions.len(), &other.uvs, other.positions.len(), Vec2::ZERO);
        append_optional(&mut self.colors, self.positions.len(), &other.colors, other.positions.len(), Vec4::ONE);
        if !self.face_polygon.is_empty() || !other.face_polygon.is_empty() {
            if self.face_polygon.is_empty() {
                self.face_polygon = (0..self.faces.len() as u32).collect();
            }
            let first_polygon = self.face_polygon.last().map_or(0, |last| last + 1);
            if other.face_polygon.is_empty() {
                self.face_polygon.extend((0..other.faces.len() as u32).map(|p| first_polygon + p));
            } else {
                self.face_polygon.extend(other.face_polygon.iter().map(|p| first_polygon + p));
            }
        }
        let (ours, theirs) = (self.faces.len(), other.faces.len());
        append_optional(&mut self.one_sided, ours, &other.one_sided, theirs, false);
        if !self.side_visibility.is_empty() || !other.side_visibility.is_empty() {
            self.side_visibility.resize(self.faces.len(), Default::default());
            self.side_visibility.extend_from_slice(&other.side_visibility);
            self.side_visibility.resize(self.faces.len() + other.faces.len(), Default::default());
        }
        self.positions.extend_from_slice(&other.positions);
        self.normals.extend_from_slice(&other.normals);
        self.faces.extend(other.faces.iter().map(|f| f.map(|v| v + first_vertex)));
        self.lines.extend(other.lines.iter().map(|line| line.map(|v| v + first_vertex)));
    }

    /// The corners of the axis-aligned bounding box of all vertices that faces and lines use, or `None` without either.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let used = self.faces.iter().flatten().chain(self.lines.iter().flatten());
        let mut corners = used.map(|&v| self.positions[v as usize]);
        let first = corners.next()?;
        Some(corners.fold((first, first), |(low, high), p| (low.min(p), high.max(p))))
    }
}

fn append_optional<T: Copy>(ours: &mut Vec<T>, our_vertices: usize, theirs: &[T], their_vertices: usize, blank: T) {
    if ours.is_empty() && theirs.is_empty() {
        return;
    }
    ours.resize(our_vertices, blank);
    ours.extend_from_slice(theirs);
    ours.resize(our_vertices + their_vertices, blank);
}

//! The triangles of a scene, as plain arrays.

use glam::{Vec2, Vec3, Vec4};

/// A whole scene, flattened: every mesh instance in world space, posed, one vertex array.
///
/// A *vertex* here is a shading vertex: a position with the normal, texture coordinate and colour that go
/// with it. Several may stand at one position (at a UV seam, say); for edges they are one, which is
/// [`crate::edges`]'s business.
///
/// Arrays that run beside another have its length or, where stated, may be empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// Per vertex: where it is, world space, right-handed, Y up.
    pub positions: Vec<Vec3>,
    /// Per vertex: the unit normal for shading.
    pub normals: Vec<Vec3>,
    /// Per vertex, or empty: texture coordinate, origin at the image's upper left (v grows downwards).
    pub uvs: Vec<Vec2>,
    /// Per vertex, or empty: a factor on the material's colour, linear RGBA.
    pub colors: Vec<Vec4>,
    /// Three vertices each, counter-clockwise seen from outside.
    pub faces: Vec<[u32; 3]>,
    /// Per face, or empty where faces have no material: its material, an index into [`Model::materials`]. A face without
    /// material is opaque.
    pub face_material: Vec<u32>,
    /// Per face, or empty where all are of one: the mesh that it belongs to, from 0. In a glTF file a node's mesh, in
    /// an `.obj` an object or group; what is appended stays a mesh of its own.
    pub face_mesh: Vec<u32>,
    /// Per face, or empty where every face is a polygon by itself: the polygon of the file that the face was
    /// cut from. Faces of one polygon stand next to each other and their numbers ascend. An edge between two
    /// faces of one polygon is a diagonal that triangulation added: it is never a line.
    pub face_polygon: Vec<u32>,
    /// At least as many as [`Model::face_material`] refers to.
    pub materials: Vec<Material>,
    /// Images that the materials refer to.
    pub textures: Vec<Texture>,
}

/// What a face is made of, as far as a picture of flat tones needs it.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The file's name for it, or empty.
    pub name: String,
    /// Linear RGBA. Multiplied with the texture and the vertex colour in linear light, then encoded once.
    pub base_color: Vec4,
    /// Index into [`Model::textures`].
    pub texture: Option<u32>,
    /// What the alpha of the product means.
    pub alpha_mode: AlphaMode,
    /// Whether the back of a face is shaded too (with its normal turned round) or culled.
    pub double_sided: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec4::new(0.8, 0.8, 0.8, 1.0),
            texture: None,
            alpha_mode: AlphaMode::Opaque,
            double_sided: true,
        }
    }
}

/// What becomes of a surface's alpha (glTF 2.0, 3.9.4 "Alpha Coverage").
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Ignored: the surface is solid.
    #[default]
    Opaque,
    /// Solid where alpha is at least the cutoff, absent elsewhere.
    Mask {
        /// The least alpha that is kept, 0..=1 as a rule; above 1 nothing is.
        cutoff: f32,
    },
    /// Laid over what is behind it; drawn after everything else, from back to front.
    Blend,
}

/// An image in memory and how it is to be looked up.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Where it came from, for messages.
    pub name: String,
    /// Texels.
    pub width: u32,
    /// Texels.
    pub height: u32,
    /// `width * height * 4` bytes, rows from the top: sRGB-encoded red, green, blue, and linear alpha.
    pub rgba8: Vec<u8>,
    /// Outside 0..1, for u and v.
    pub wrap: [Wrap; 2],
    /// Whether magnification interpolates (`true`) or shows texels as squares.
    pub smooth: bool,
}

/// What a texture is outside 0..1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// Tiled.
    #[default]
    Repeat,
    /// Tiled, every other tile mirrored.
    Mirror,
    /// The border texel goes on.
    Clamp,
}

impl Model {
    /// The material of a face, or `None` where it has none.
    pub fn material_of(&self, face: u32) -> Option<&Material> {
        self.materials.get(*self.face_material.get(face as usize)? as usize)
    }

    /// Where faces have no material ([`Model::face_material`] is empty): adds [`Material::default`] and gives it to all of
    /// them.
    pub fn fill_face_material(&mut self) {
        if self.face_material.is_empty() && !self.faces.is_empty() {
            self.face_material = vec![self.materials.len() as u32; self.faces.len()];
            self.materials.push(Material::default());
        }
    }

    /// Adds all of `other` to this scene.
    ///
    /// Optional arrays that only one side has are filled up on the other: texture coordinates with zeros,
    /// colours with white, polygons with one per face, materials with [`Material::default`]. The other's meshes stay apart
    /// from those of this scene.
    pub fn append(&mut self, other: &Model) {
        let has_materials = !self.face_material.is_empty() || !other.face_material.is_empty();
        if has_materials {
            self.fill_face_material();
        }
        let first_vertex = self.positions.len() as u32;
        let first_material = self.materials.len() as u32;
        let first_texture = self.textures.len() as u32;
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
        if !self.faces.is_empty() || !other.face_mesh.is_empty() {
            self.face_mesh.resize(self.faces.len(), 0);
            let first_mesh = self.face_mesh.iter().max().map_or(0, |last| last + 1);
            let of = |face: usize| other.face_mesh.get(face).copied().unwrap_or(0);
            self.face_mesh.extend((0..other.faces.len()).map(|face| first_mesh + of(face)));
        }
        self.positions.extend_from_slice(&other.positions);
        self.normals.extend_from_slice(&other.normals);
        self.faces.extend(other.faces.iter().map(|f| f.map(|v| v + first_vertex)));
        self.face_material.extend(other.face_material.iter().map(|m| m + first_material));
        self.materials.extend(
            other.materials.iter().map(|m| Material { texture: m.texture.map(|t| t + first_texture), ..m.clone() }),
        );
        self.textures.extend_from_slice(&other.textures);
        if has_materials && other.face_material.is_empty() && !other.faces.is_empty() {
            self.face_material.resize(self.faces.len(), self.materials.len() as u32);
            self.materials.push(Material::default());
        }
    }

    /// The corners of the smallest axis-aligned box around all vertices that a face uses, or `None` without faces.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let mut corners = self.faces.iter().flatten().map(|&v| self.positions[v as usize]);
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

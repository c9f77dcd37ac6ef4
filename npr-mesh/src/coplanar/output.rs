//! Builds the model whose coplanar faces are separated.

use super::layers::VisibleSides;
use super::overlap::Projection;
use crate::{Model, SideVisibility};
use glam::{DVec3, Vec2, Vec3, Vec4};
use std::collections::HashMap;

/// A model whose coplanar faces are separated.
#[derive(Clone, Debug, PartialEq)]
pub struct Separated {
    /// The model.
    pub model: Model,
    /// Per face of it: the face that it is, or that it is a piece of.
    pub sources: Vec<u32>,
    /// The faces, ascending, of the model before that share their place with others that they hide, are hidden by or are
    /// visible through.
    pub coincident: Vec<u32>,
}

/// The faces of the result.
pub(super) struct Output {
    /// Whether any face is cut.
    is_cut: bool,
    /// What replaces the faces that do not remain as they are.
    replacements: HashMap<u32, Replacement>,
}

enum Replacement {
    /// The face as a whole.
    Whole(VisibleSides),
    Pieces(Vec<Piece>),
}

/// A part of a face.
pub(super) struct Part {
    /// In the winding of the face.
    pub corners: [DVec3; 3],
    pub visible: VisibleSides,
    /// Whether the opposite winding and normals replace its own, which change nothing if both its sides are visible.
    pub is_turned: bool,
}

struct Piece {
    corners: [Corner; 3],
    visible: VisibleSides,
    is_turned: bool,
}

/// A corner of a piece.
#[derive(Clone, Copy)]
struct Corner {
    position: Vec3,
    /// The weights of the corners of the face that it is on.
    weights: [f64; 3],
}

impl Output {
    pub fn new() -> Self {
        Self { is_cut: false, replacements: HashMap::new() }
    }

    /// Announces a face that shares its place with others. Nothing of it is there until it is kept or pieces are added.
    pub fn change(&mut self, face: u32, is_cut: bool) {
        self.replacements.insert(face, Replacement::Pieces(Vec::new()));
        self.is_cut |= is_cut;
    }

    /// Keeps a whole face as far as it is visible.
    pub fn keep(&mut self, face: u32, visible: VisibleSides) {
        self.replacements.insert(face, Replacement::Whole(visible));
    }

    /// Adds a piece of a face.
    pub fn add_piece(&mut self, model: &Model, face: u32, along: Projection, part: Part) {
        let of_face = model.faces[face as usize].map(|vertex| model.positions[vertex as usize].as_dvec3());
        let [a, b, c] = of_face.map(|corner| along.project(corner));
        let corner = |position: DVec3| {
            let at = along.project(position);
            let [u, v, w] = [(b - at).perp_dot(c - at), (c - at).perp_dot(a - at), (a - at).perp_dot(b - at)];
            Corner { position: position.as_vec3(), weights: [u, v, w].map(|x| (x / (u + v + w)).clamp(0.0, 1.0)) }
        };
        let piece = Piece { corners: part.corners.map(corner), visible: part.visible, is_turned: part.is_turned };
        if let Some(Replacement::Pieces(pieces)) = self.replacements.get_mut(&face) {
            pieces.push(piece);
        }
    }

    /// The result; `None` if it is the model itself.
    pub fn finish(mut self, model: &Model) -> Option<Separated> {
        let mut coincident: Vec<u32> = self.replacements.keys().copied().collect();
        coincident.sort_unstable();
        let mut builder = Builder::new(model);
        let mut sources = Vec::with_capacity(model.faces.len());
        for face in 0..model.faces.len() as u32 {
            let vertices = model.faces[face as usize];
            let is_one_sided = model.is_one_sided(face);
            let shows_back = model.shows_back(face);
            let sides = model.side_visibility.get(face as usize).copied().unwrap_or_default();
            match self.replacements.remove(&face) {
                None => builder.push(vertices, sides, is_one_sided),
                Some(Replacement::Whole(visible)) => {
                    builder.push_visible(vertices, sides, visible, is_one_sided, shows_back)
                }
                Some(Replacement::Pieces(pieces)) => {
                    for Piece { corners, visible, is_turned } in pieces {
                        if !(visible.front || visible.back) {
                            continue;
                        }
                        let vertices = corners.map(|corner| builder.vertex(vertices, corner));
                        let sides = sides_of_piece(&corners, sides);
                        if is_turned {
                            builder.push_turned(vertices, sides, false);
                        } else {
                            builder.push_visible(vertices, sides, visible, is_one_sided, shows_back);
                        }
                    }
                }
            }
            sources.resize(builder.made.faces.len(), face);
        }
        let mut made = builder.made;
        if !made.one_sided.contains(&true) {
            made.one_sided.clear();
        }
        if model.side_visibility.is_empty() {
            made.side_visibility.clear();
        }
        if made.faces == model.faces && made.one_sided == model.one_sided {
            return None;
        }
        let of_sources = |values: &[u32]| match values {
            [] => Vec::new(),
            _ => sources.iter().map(|&face| values[face as usize]).collect(),
        };
        made.face_material = of_sources(&model.face_material);
        made.face_mesh = of_sources(&model.face_mesh);
        made.face_polygon = of_sources(&model.face_polygon);
        if made.face_polygon.is_empty() && self.is_cut {
            made.face_polygon = sources.clone();
        }
        Some(Separated { model: made, sources, coincident })
    }
}

/// What is stated of the sides of a piece: of those on a side of the face the same, of cuts that they are hidden.
fn sides_of_piece(corners: &[Corner; 3], of_face: [SideVisibility; 3]) -> [SideVisibility; 3] {
    [0, 1, 2].map(|side| {
        let ends = [corners[side], corners[(side + 1) % 3]];
        let on = (0..3).find(|on| ends.iter().all(|end| end.weights[(on + 2) % 3] < 1e-6));
        match on {
            Some(on) => of_face[on],
            None if of_face == [SideVisibility::Unstated; 3] => SideVisibility::Unstated,
            None => SideVisibility::Hidden,
        }
    })
}

struct Builder<'a> {
    model: &'a Model,
    /// Without the arrays of faces other than the corners and sides.
    made: Model,
    /// The added vertices, by all that they consist of.
    added: HashMap<[u32; 12], u32>,
}

impl<'a> Builder<'a> {
    fn new(model: &'a Model) -> Self {
        let made = Model {
            faces: Vec::with_capacity(model.faces.len()),
            face_material: Vec::new(),
            face_mesh: Vec::new(),
            face_polygon: Vec::new(),
            one_sided: Vec::with_capacity(model.faces.len()),
            side_visibility: Vec::with_capacity(model.faces.len()),
            ..model.clone()
        };
        Self { model, made, added: HashMap::new() }
    }

    fn push(&mut self, vertices: [u32; 3], sides: [SideVisibility; 3], is_one_sided: bool) {
        self.made.faces.push(vertices);
        self.made.side_visibility.push(sides);
        self.made.one_sided.push(is_one_sided);
    }

    /// Adds a face with the opposite winding and normals.
    fn push_turned(&mut self, vertices: [u32; 3], sides: [SideVisibility; 3], is_one_sided: bool) {
        let [a, b, c] = vertices.map(|vertex| self.turned(vertex));
        self.push([a, c, b], SideVisibility::reversed(sides), is_one_sided);
    }

    /// Adds a face as far as it is visible. `is_one_sided` and `shows_back` are those of the face before.
    fn push_visible(
        &mut self,
        vertices: [u32; 3],
        sides: [SideVisibility; 3],
        visible: VisibleSides,
        is_one_sided: bool,
        shows_back: bool,
    ) {
        match visible {
            VisibleSides { front: true, back } => self.push(vertices, sides, is_one_sided || shows_back && !back),
            // Its back becomes the front of a one-sided face.
            VisibleSides { front: false, back: true } => self.push_turned(vertices, sides, true),
            VisibleSides { front: false, back: false } => {}
        }
    }

    /// The vertex at a corner of a piece of a face with these vertices.
    fn vertex(&mut self, of_face: [u32; 3], corner: Corner) -> u32 {
        let own = of_face.into_iter().find(|&vertex| self.model.positions[vertex as usize] == corner.position);
        own.unwrap_or_else(|| {
            let weights = corner.weights.map(|weight| weight as f32);
            let of = of_face.map(|vertex| vertex as usize);
            let (normals, uvs, colors) = (&self.model.normals, &self.model.uvs, &self.model.colors);
            let normal: Vec3 = (0..3).map(|i| normals[of[i]] * weights[i]).sum();
            let normal = normal.try_normalize().unwrap_or(normals[of[0]]);
            let uv = if uvs.is_empty() { Vec2::ZERO } else { (0..3).map(|i| uvs[of[i]] * weights[i]).sum() };
            let color = if colors.is_empty() { Vec4::ONE } else { (0..3).map(|i| colors[of[i]] * weights[i]).sum() };
            self.add(corner.position, normal, uv, color)
        })
    }

    /// A vertex like another, with the opposite normal.
    fn turned(&mut self, vertex: u32) -> u32 {
        let made = &self.made;
        let at = vertex as usize;
        let uv = made.uvs.get(at).copied().unwrap_or_default();
        let color = made.colors.get(at).copied().unwrap_or(Vec4::ONE);
        self.add(made.positions[at], -made.normals[at], uv, color)
    }

    fn add(&mut self, position: Vec3, normal: Vec3, uv: Vec2, color: Vec4) -> u32 {
        let all = [&position.to_array()[..], &normal.to_array(), &uv.to_array(), &color.to_array()].concat();
        let key = std::array::from_fn(|i| all[i].to_bits());
        let made = &mut self.made;
        *self.added.entry(key).or_insert_with(|| {
            made.positions.push(position);
            made.normals.push(normal);
            if !made.uvs.is_empty() {
                made.uvs.push(uv);
            }
            if !made.colors.is_empty() {
                made.colors.push(color);
            }
            made.positions.len() as u32 - 1
        })
    }
}

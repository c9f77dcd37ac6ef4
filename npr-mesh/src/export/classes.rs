//! The class of each side of each face.

use crate::edges::{Edge, EdgeKind, EdgeOptions, Edges, NO_FACE, find, triangle_normal};
use crate::{Model, SideVisibility, edge_visibility};
use glam::Vec3;
use std::collections::{HashMap, HashSet};

/// Up to this angle between its triangles an edge is flat. Some tens of the rounding errors of unit normals.
const FLAT_RAD: f32 = 2e-5;

/// What [`side_classes`] finds: per face the classes of its sides; and, by face, for each side that is a silhouette the
/// unit normals of the two faces there, in the order of the sides.
pub type SideClasses = (Vec<[SideVisibility; 3]>, HashMap<u32, Vec<[[f32; 3]; 2]>>);

/// The class of each side: what the model states ([`Model::side_visibility`]), and by these rules where it states nothing.
///
/// - Boundaries, edges of more than two faces and those whose faces differ by more than `crease_angle_rad` are hard.
/// - Edges and diagonals of polygons between triangles in one plane are hidden, others are silhouettes: a reader knows
///   triangles alone, and of a polygon that is bent only slightly one may be front-facing and the other back-facing.
/// - Each edge is stated once for each material, at the first of its faces; further faces have
///   [`SideVisibility::RepeatedHard`] or [`SideVisibility::Hidden`].
///
/// # Panics
/// As [`find`].
pub fn side_classes(model: &Model, crease_angle_rad: f32) -> SideClasses {
    let network = Network::new(model);
    let stated = edge_visibility(model, &network.edges);
    let class_of = |number: usize| match stated.get(number) {
        Some(SideVisibility::Unstated) | None => network.class(number, crease_angle_rad),
        Some(stated) => *stated,
    };
    let classes: Vec<SideVisibility> = (0..network.count()).map(class_of).collect();
    let mut sides = model.side_visibility.clone();
    sides.resize(model.faces.len(), Default::default());
    let material = |face: usize| model.face_material.get(face).copied().unwrap_or(0);
    // The edges that are stated already, for each material.
    let mut met: HashSet<(usize, u32)> = HashSet::new();
    let is_statement = |side| matches!(side, SideVisibility::Hard | SideVisibility::Silhouette);
    for (face, of_face) in sides.iter().enumerate() {
        for (side, _) in of_face.iter().enumerate().filter(|(_, class)| is_statement(**class)) {
            met.extend(network.edge_at(face, side).map(|edge| (edge, material(face))));
        }
    }
    for (face, of_face) in sides.iter_mut().enumerate() {
        for (side, class) in of_face.iter_mut().enumerate().filter(|(_, class)| **class == SideVisibility::Unstated) {
            let edge = network.edge_at(face, side);
            let of_edge = edge.map_or(SideVisibility::Hidden, |edge| classes[edge]);
            let is_first = edge.is_some_and(|edge| is_statement(of_edge) && met.insert((edge, material(face))));
            *class = match of_edge {
                _ if is_first => of_edge,
                SideVisibility::Hard => SideVisibility::RepeatedHard,
                _ => SideVisibility::Hidden,
            };
        }
    }
    let mut normals: HashMap<u32, Vec<[[f32; 3]; 2]>> = HashMap::new();
    for (face, of_face) in sides.iter().enumerate() {
        for (side, _) in of_face.iter().enumerate().filter(|(_, class)| **class == SideVisibility::Silhouette) {
            let pair = network.normals(face, side).map(|normal| normal.to_array());
            normals.entry(face as u32).or_default().push(pair);
        }
    }
    (sides, normals)
}

/// The edges and diagonals of a model.
struct Network<'a> {
    model: &'a Model,
    edges: Edges,
    /// The two faces of each diagonal, which are numbered after the edges.
    diagonals: Vec<[u32; 2]>,
    by_ends: HashMap<[u32; 2], usize>,
    /// Per face that of its triangle, zero without area.
    normals: Vec<Vec3>,
}

impl<'a> Network<'a> {
    fn new(model: &'a Model) -> Self {
        let Model { positions, faces, face_polygon, face_material, .. } = model;
        let edges = find(positions, faces, face_polygon, face_material, &EdgeOptions::default());
        let sorted = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let by_ends = edges.edges.iter().enumerate().map(|(number, edge)| (sorted(edge.ends), number)).collect();
        let normals = faces.iter().map(|face| triangle_normal(positions, face)).collect();
        let mut network = Self { model, edges, diagonals: Vec::new(), by_ends, normals };
        for face in 0..faces.len() {
            for side in 0..3 {
                let Some(ends) = network.ends_of(face, side) else { continue };
                let (next, known) = (network.count(), network.edges.edges.len());
                let number = *network.by_ends.entry(ends).or_insert(next);
                if number == next {
                    network.diagonals.push([face as u32; 2]);
                } else if number >= known {
                    network.diagonals[number - known][1] = face as u32;
                }
            }
        }
        network
    }

    fn count(&self) -> usize {
        self.edges.edges.len() + self.diagonals.len()
    }

    /// The ends of a side in ascending order; `None` of a side without length, which is no edge.
    fn ends_of(&self, face: usize, side: usize) -> Option<[u32; 2]> {
        let corners = self.model.faces[face].map(|vertex| self.edges.representative[vertex as usize]);
        let [a, b] = [corners[side], corners[(side + 1) % 3]];
        (a != b).then(|| [a.min(b), a.max(b)])
    }

    fn edge_at(&self, face: usize, side: usize) -> Option<usize> {
        self.by_ends.get(&self.ends_of(face, side)?).copied()
    }

    fn class(&self, number: usize, crease_angle_rad: f32) -> SideVisibility {
        let edge = self.edges.edges.get(number);
        if edge.is_some_and(|edge| edge.kind() != EdgeKind::TwoFace) {
            return SideVisibility::Hard;
        }
        if edge.and_then(|edge| self.edges.dihedral_rad(edge)).is_some_and(|angle_rad| angle_rad > crease_angle_rad) {
            return SideVisibility::Hard;
        }
        let faces = edge.map_or_else(|| self.diagonals[number - self.edges.edges.len()], Edge::faces);
        let [first, second] = faces.map(|face| self.normals[face as usize]);
        let second = if edge.is_some_and(Edge::wound_oppositely) { -second } else { second };
        // The sine, since the cosine of so small an angle is 1 in f32. A face without area is not flat.
        let is_flat = first.dot(second) > 0.0 && first.cross(second).length() <= FLAT_RAD;
        if is_flat { SideVisibility::Hidden } else { SideVisibility::Silhouette }
    }

    /// The normals of the two faces at a side, first that of its own.
    fn normals(&self, face: usize, side: usize) -> [Vec3; 2] {
        // A face of zero area has no normal but those of its vertices.
        let of_vertices = |face: usize| {
            let sum: Vec3 = self.model.faces[face].iter().map(|&vertex| self.model.normals[vertex as usize]).sum();
            sum.normalize_or(Vec3::Y)
        };
        let normal_of = |face: usize| match self.normals[face] {
            Vec3::ZERO => of_vertices(face),
            normal => normal,
        };
        let own = normal_of(face);
        let Some(number) = self.edge_at(face, side) else { return [own, -own] };
        let edge = self.edges.edges.get(number);
        let faces = edge.map_or_else(|| self.diagonals[number - self.edges.edges.len()], Edge::faces);
        let other = if faces[0] as usize == face { faces[1] } else { faces[0] };
        // Without another face it is a silhouette for every eye.
        if other == NO_FACE {
            return [own, -own];
        }
        let turned = edge.is_some_and(|edge| edge.kind() == EdgeKind::TwoFace && edge.wound_oppositely());
        let other = normal_of(other as usize);
        [own, if turned { -other } else { other }]
    }
}

//! The class of each side of each face.

use crate::edges::{Edge, EdgeKind, EdgeOptions, Edges, NO_FACE, find};
use crate::{Model, SideVisibility, edge_visibility};
use glam::Vec3;
use std::collections::HashMap;

/// Up to this angle between its faces an edge is flat, and never a silhouette that could be seen. Some tens of the rounding
/// errors of unit normals.
const FLAT_RAD: f32 = 2e-5;

/// What [`side_classes`] finds: per face the classes of its sides; and, by face, for each side that is a silhouette the
/// unit normals of the two faces there, in the order of the sides.
pub type SideClasses = (Vec<[SideVisibility; 3]>, HashMap<u32, Vec<[[f32; 3]; 2]>>);

/// The class of each side: what the model states ([`Model::side_visibility`]), and by these rules where it states nothing.
///
/// - Boundaries, edges of more than two faces and those whose faces differ by more than `crease_angle_rad` are hard.
/// - Diagonals of polygons and edges between faces in one plane are hidden, other edges are silhouettes, and so are the
///   diagonals of polygons that are folded.
/// - Each edge is stated once for each material, at the first of its faces; further faces have
///   [`SideVisibility::RepeatedHard`] or [`SideVisibility::Hidden`].
///
/// # Panics
/// As [`find`].
pub fn side_classes(model: &Model, crease_angle_rad: f32) -> SideClasses {
    let edges =
        find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &EdgeOptions::default());
    let stated = edge_visibility(model, &edges);
    let by_ends: HashMap<[u32; 2], usize> =
        edges.edges.iter().chain(&edges.folds).enumerate().map(|(number, edge)| (sorted(edge.ends), number)).collect();
    let class_of = |number: usize| match edges.edges.get(number) {
        Some(edge) => match stated.get(number) {
            Some(SideVisibility::Unstated) | None => by_angle(&edges, edge, crease_angle_rad),
            Some(stated) => *stated,
        },
        None => SideVisibility::Silhouette,
    };
    let classes: Vec<SideVisibility> = (0..edges.edges.len() + edges.folds.len()).map(class_of).collect();
    let mut sides = model.side_visibility.clone();
    sides.resize(model.faces.len(), Default::default());
    let edge_at = |face: usize, side: usize| {
        let corners = model.faces[face].map(|vertex| edges.representative[vertex as usize]);
        let ends = sorted([corners[side], corners[(side + 1) % 3]]);
        // A side of no length is no edge.
        if ends[0] == ends[1] { None } else { by_ends.get(&ends).copied() }
    };
    let material = |face: usize| model.face_material.get(face).copied().unwrap_or(0);
    // The edges that are stated already, for each material.
    let mut met: HashMap<(usize, u32), ()> = HashMap::new();
    let is_statement = |side| matches!(side, SideVisibility::Hard | SideVisibility::Silhouette);
    for (face, of_face) in sides.iter().enumerate() {
        for (side, _) in of_face.iter().enumerate().filter(|(_, class)| is_statement(**class)) {
            edge_at(face, side).map(|edge| met.insert((edge, material(face)), ()));
        }
    }
    for (face, of_face) in sides.iter_mut().enumerate() {
        for (side, class) in of_face.iter_mut().enumerate().filter(|(_, class)| **class == SideVisibility::Unstated) {
            let edge = edge_at(face, side);
            let of_edge = edge.map_or(SideVisibility::Hidden, |edge| classes[edge]);
            let is_first =
                edge.is_some_and(|edge| is_statement(of_edge) && met.insert((edge, material(face)), ()).is_none());
            *class = match of_edge {
                _ if is_first => of_edge,
                SideVisibility::Hard => SideVisibility::RepeatedHard,
                _ => SideVisibility::Hidden,
            };
        }
    }
    let normals = silhouette_normals(model, &edges, &sides, edge_at);
    (sides, normals)
}

fn by_angle(edges: &Edges, edge: &Edge, crease_angle_rad: f32) -> SideVisibility {
    if edge.kind() != EdgeKind::TwoFace {
        return SideVisibility::Hard;
    }
    let [first, second] = edge.faces().map(|face| edges.face_normals[face as usize]);
    match edges.dihedral_rad(edge) {
        Some(angle_rad) if angle_rad > crease_angle_rad => SideVisibility::Hard,
        // The sine, since the cosine of so small an angle is 1 in f32.
        Some(angle_rad) if angle_rad < 1.0 && first.cross(second).length() <= FLAT_RAD => SideVisibility::Hidden,
        _ => SideVisibility::Silhouette,
    }
}

fn silhouette_normals(
    model: &Model,
    edges: &Edges,
    sides: &[[SideVisibility; 3]],
    edge_at: impl Fn(usize, usize) -> Option<usize>,
) -> HashMap<u32, Vec<[[f32; 3]; 2]>> {
    let of_vertices = |face: usize| {
        let sum: Vec3 = model.faces[face].iter().map(|&vertex| model.normals[vertex as usize]).sum();
        sum.normalize_or(Vec3::Y)
    };
    // A face of zero area has no normal.
    let normal_of = |face: usize| match edges.face_normals[face] {
        Vec3::ZERO => of_vertices(face),
        normal => normal,
    };
    let mut normals: HashMap<u32, Vec<[[f32; 3]; 2]>> = HashMap::new();
    for (face, of_face) in sides.iter().enumerate() {
        for (side, _) in of_face.iter().enumerate().filter(|(_, class)| **class == SideVisibility::Silhouette) {
            let own = normal_of(face);
            let edge = edge_at(face, side);
            let edge = edge.map(|n| edges.edges.get(n).unwrap_or_else(|| &edges.folds[n - edges.edges.len()]));
            let other = edge.and_then(|edge| {
                let faces = edge.faces();
                let other = if faces[0] as usize == face { faces[1] } else { faces[0] };
                let turned = edge.wound_oppositely() && edge.kind() == EdgeKind::TwoFace;
                (other != NO_FACE).then(|| if turned { -normal_of(other as usize) } else { normal_of(other as usize) })
            });
            // Without another face it is a silhouette for every eye.
            let pair = [own, other.unwrap_or(-own)].map(|normal| normal.to_array());
            normals.entry(face as u32).or_default().push(pair);
        }
    }
    normals
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

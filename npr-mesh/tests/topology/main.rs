//! Edges of meshes whose topology is not what their shape is: seams within rounding, T-junctions, faces that overlap, faces
//! without area. What is right is known from how the meshes are made.

mod csg;
mod junctions;
mod order;
mod overlaps;
mod union;

use glam::{DQuat, DVec3, Quat, Vec3};
use npr_mesh::edges::{self, Edge, EdgeKind, EdgeOptions, Edges};
use proptest::prelude::*;

/// Polygons over vertices.
#[derive(Clone, Debug, Default)]
struct Mesh {
    positions: Vec<Vec3>,
    /// Convex, counter-clockwise seen from outside.
    polygons: Vec<Vec<u32>>,
}

impl Mesh {
    fn new(positions: &[[f32; 3]], polygons: &[&[u32]]) -> Self {
        Self {
            positions: positions.iter().map(|p| Vec3::from(*p)).collect(),
            polygons: polygons.iter().map(|polygon| polygon.to_vec()).collect(),
        }
    }

    /// The triangles of fans, and the polygon of each.
    fn triangles(&self) -> (Vec<[u32; 3]>, Vec<u32>) {
        let mut faces = Vec::new();
        let mut face_polygon = Vec::new();
        for (number, polygon) in (0u32..).zip(&self.polygons) {
            for pair in polygon[1..].windows(2) {
                faces.push([polygon[0], pair[0], pair[1]]);
                face_polygon.push(number);
            }
        }
        (faces, face_polygon)
    }

    /// The edges for drawing.
    fn edges(&self) -> Edges {
        let (faces, face_polygon) = self.triangles();
        edges::find(&self.positions, &faces, &face_polygon, &[], &EdgeOptions::default())
    }

    /// As [`Mesh::edges`], of a file of triangles.
    fn edges_of_triangles(&self) -> Edges {
        edges::find(&self.positions, &self.triangles().0, &[], &[], &EdgeOptions::default())
    }

    fn turned(&self, turn: impl Fn(Vec3) -> Vec3) -> Self {
        Self { positions: self.positions.iter().map(|&p| turn(p)).collect(), polygons: self.polygons.clone() }
    }

    /// Each polygon has vertices of its own.
    fn split(&self) -> Self {
        let positions = self.polygons.iter().flatten().map(|&v| self.positions[v as usize]).collect();
        let mut next = 0..;
        let polygons = self.polygons.iter().map(|polygon| next.by_ref().take(polygon.len()).collect()).collect();
        Self { positions, polygons }
    }
}

/// Edges that are lines from every side: those with an angle over 30° and those that have not two faces.
fn drawn(found: &Edges) -> impl Iterator<Item = &Edge> {
    let is_line = |edge: &&Edge| {
        edge.kind() != EdgeKind::TwoFace || found.dihedral_rad(edge).is_some_and(|angle| angle > 30f32.to_radians())
    };
    found.edges.iter().filter(is_line)
}

fn length(mesh: &Mesh, edge: &Edge) -> f64 {
    let [from, to] = edge.ends.map(|vertex| mesh.positions[vertex as usize].as_dvec3());
    from.distance(to)
}

fn drawn_length(mesh: &Mesh, found: &Edges) -> f64 {
    drawn(found).map(|edge| length(mesh, edge)).sum()
}

fn count(found: &Edges, kind: EdgeKind) -> usize {
    found.edges.iter().filter(|edge| edge.kind() == kind).count()
}

fn rotation() -> impl Strategy<Value = Quat> {
    let part = || -1f32..1.0;
    (part(), part(), part(), part()).prop_map(|(x, y, z, w)| Quat::from_xyzw(x, y, z, w).try_normalize_or_identity())
}

trait OrIdentity {
    fn try_normalize_or_identity(self) -> Self;
}

impl OrIdentity for Quat {
    fn try_normalize_or_identity(self) -> Self {
        if self.length() > 1e-3 { self.normalize() } else { Quat::IDENTITY }
    }
}

/// A tube around Y, whose last column is computed at an angle of 2π.
fn tube(columns: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for column in 0..=columns {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(column) / f64::from(columns)).sin_cos();
        mesh.positions.extend([-1.0, 1.0].map(|y| DVec3::new(sin, y, cos).as_vec3()));
    }
    mesh.polygons = (0..columns).map(|column| [0, 2, 3, 1].map(|corner| 2 * column + corner).to_vec()).collect();
    mesh
}

#[test]
fn a_tube_whose_last_column_is_at_two_pi_is_closed() {
    for columns in [8, 24, 100] {
        let tube = tube(columns);
        let found = tube.edges();
        assert_eq!(count(&found, EdgeKind::Boundary), 2 * columns as usize);
        assert_eq!(count(&found, EdgeKind::TwoFace), columns as usize);
        assert_eq!(
            count(
                &edges::find(&tube.positions, &tube.triangles().0, &tube.triangles().1, &[], &EdgeOptions::of_file()),
                EdgeKind::Boundary
            ),
            2 * columns as usize + 2
        );
    }
}

#[test]
fn vertices_that_the_file_keeps_apart_remain_apart() {
    for gap in [2e-6f32, 1e-5, 1e-3] {
        let mut open = tube(24);
        let last = open.positions.len() - 2;
        open.positions[last..].iter_mut().for_each(|p| p.x -= gap);
        assert_eq!(count(&open.edges(), EdgeKind::Boundary), 2 * 24 + 2, "{gap}");
    }
}

proptest! {
    #[test]
    fn a_tube_of_four_turned_quarters_is_closed(
        whole in rotation(),
        columns in 2u32..12,
        height in 0.1f32..10.0,
        offset in (-3f32..3.0, -3f32..3.0, -3f32..3.0),
        by_matrix: bool,
    ) {
        let quarter = |number: u32| Quat::from_rotation_y(number as f32 * std::f32::consts::FRAC_PI_2);
        let mut mesh = Mesh::default();
        for number in 0..4 {
            let first = mesh.positions.len() as u32;
            for column in 0..=columns {
                let (sin, cos) = (std::f32::consts::FRAC_PI_2 * column as f32 / columns as f32).sin_cos();
                mesh.positions.extend([-height, height].map(|y| {
                    let p = Vec3::new(sin, y, cos);
                    let turned = if by_matrix {
                        glam::Mat3::from_quat(whole) * glam::Mat3::from_quat(quarter(number)) * p
                    } else {
                        (whole * quarter(number)) * p
                    };
                    turned + Vec3::from(offset)
                }));
            }
            mesh.polygons.extend((0..columns).map(|column| [0, 2, 3, 1].map(|c| first + 2 * column + c).to_vec()));
        }
        let found = mesh.edges();
        prop_assert_eq!(count(&found, EdgeKind::Boundary), 8 * columns as usize);
        prop_assert_eq!(count(&found, EdgeKind::TwoFace), 4 * columns as usize);
    }
}

/// `DQuat` in f64, to place what is exact in f32 with no more than its own rounding.
fn exactly(turn: Quat) -> impl Fn(Vec3) -> Vec3 {
    let turn = DQuat::from_xyzw(turn.x.into(), turn.y.into(), turn.z.into(), turn.w.into()).normalize();
    move |p| (turn * p.as_dvec3()).as_vec3()
}

//! What is found does not depend on the order of faces and vertices.

use super::*;
use std::collections::BTreeMap;

/// Triangles over a coarse lattice, so that they overlap, meet at T-junctions, and have no area often.
fn soup() -> impl Strategy<Value = Mesh> {
    let place = || (0u8..3, 0u8..3, 0u8..2);
    let corners = prop::collection::vec((place(), place(), place()), 1..14);
    corners.prop_map(|triangles| {
        let mut mesh = Mesh::default();
        for (a, b, c) in triangles {
            let first = mesh.positions.len() as u32;
            mesh.positions.extend([a, b, c].map(|(x, y, z)| Vec3::new(x.into(), y.into(), z.into())));
            mesh.polygons.push(vec![first, first + 1, first + 2]);
        }
        mesh
    })
}

/// Each edge by the positions of its ends: its kind, whether it is surrounded, and its angle in hundredths of a degree.
fn described(mesh: &Mesh, found: &Edges) -> BTreeMap<[[i32; 3]; 2], (String, bool, Option<i32>)> {
    let place = |vertex: u32| mesh.positions[vertex as usize].to_array().map(|x| (x * 1024.0).round() as i32);
    let describe = |edge: &Edge| {
        let mut ends = edge.ends.map(place);
        ends.sort_unstable();
        let angle = found.dihedral_rad(edge).map(|angle| (angle.to_degrees() * 100.0).round() as i32);
        (ends, (format!("{:?}", edge.kind()), edge.is_surrounded(), angle))
    };
    let all: BTreeMap<_, _> = found.edges.iter().map(describe).collect();
    assert_eq!(all.len(), found.edges.len(), "an edge is there twice");
    all
}

/// The normals, up to their sign, of the first two faces of each edge that is non-manifold and not surrounded.
fn outer(mesh: &Mesh, found: &Edges) -> BTreeMap<[[i32; 3]; 2], Vec<[i32; 3]>> {
    let place = |vertex: u32| mesh.positions[vertex as usize].to_array().map(|x| (x * 1024.0).round() as i32);
    let describe = |edge: &Edge| {
        let mut ends = edge.ends.map(place);
        ends.sort_unstable();
        let mut normals = edge.faces().map(|face| {
            let normal = found.face_normals[face as usize].to_array().map(|x| (x * 1000.0).round() as i32);
            normal.max(normal.map(|x| -x))
        });
        normals.sort_unstable();
        (ends, normals.to_vec())
    };
    let is_outer = |edge: &&Edge| edge.kind() == EdgeKind::NonManifold && !edge.is_surrounded();
    found.edges.iter().filter(is_outer).map(describe).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn edges_are_the_same_for_any_order_of_faces_corners_and_vertices(
        mesh in soup(),
        keys in prop::collection::vec(any::<u32>(), 14 * 3),
        corners in prop::collection::vec(0usize..3, 14),
    ) {
        let found = mesh.edges_of_triangles();
        let mut other = mesh.clone();
        let mut order: Vec<usize> = (0..mesh.polygons.len()).collect();
        order.sort_by_key(|&face| keys[face]);
        other.polygons = order.iter().map(|&face| mesh.polygons[face].clone()).collect();
        for (polygon, turn) in other.polygons.iter_mut().zip(&corners) {
            polygon.rotate_left(*turn);
        }
        let mut vertices: Vec<usize> = (0..mesh.positions.len()).collect();
        vertices.sort_by_key(|&vertex| keys[vertex].rotate_left(7));
        other.positions = vertices.iter().map(|&vertex| mesh.positions[vertex]).collect();
        let mut number = vec![0; vertices.len()];
        for (new, &old) in (0u32..).zip(&vertices) {
            number[old] = new;
        }
        other.polygons.iter_mut().flatten().for_each(|vertex| *vertex = number[*vertex as usize]);
        let again = other.edges_of_triangles();
        prop_assert_eq!(described(&mesh, &found), described(&other, &again));
        prop_assert_eq!(outer(&mesh, &found), outer(&other, &again));
    }

    /// What is skipped and shared loses no point of an outline: each boundary point of the file's edges that no other face
    /// touches is still on an edge.
    #[test]
    fn sides_without_a_neighbour_remain(mesh in soup()) {
        let (faces, _) = mesh.triangles();
        let found = mesh.edges_of_triangles();
        let file = edges::find(&mesh.positions, &faces, &[], &[], &EdgeOptions::of_file());
        let place = |vertex: u32| mesh.positions[vertex as usize].as_dvec3();
        let touches = |p: DVec3, [a, b]: [DVec3; 2]| {
            let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            p.distance(a.lerp(b, t)) < 1e-6
        };
        for edge in file.edges.iter().filter(|edge| edge.kind() == EdgeKind::Boundary) {
            let face = faces[edge.faces()[0] as usize].map(place);
            if (face[1] - face[0]).cross(face[2] - face[0]).length() == 0.0 {
                continue;
            }
            let [a, b] = edge.ends.map(place);
            for step in 0..7 {
                let p = a.lerp(b, (f64::from(step) + 0.37) / 7.0);
                let is_on = found.edges.iter().any(|edge| touches(p, edge.ends.map(place)));
                prop_assert!(is_on, "{p} of {a} {b}");
            }
        }
    }
}

/// A round cap with faces that are there twice or have no area, as triangles.
fn cap(twice: &[usize], flat: &[usize]) -> Mesh {
    let sphere = npr_mesh::embedded::sphere(12);
    let mut mesh = Mesh { positions: sphere.positions, polygons: Vec::new() };
    let faces = &sphere.faces[..sphere.faces.len() / 2];
    mesh.polygons.extend(faces.iter().map(|face| face.to_vec()));
    mesh.polygons.extend(twice.iter().map(|&face| {
        let [a, b, c] = faces[face % faces.len()];
        if face.is_multiple_of(2) { vec![b, c, a] } else { vec![c, b, a] }
    }));
    mesh.polygons.extend(flat.iter().map(|&face| {
        let [a, b, _] = faces[face % faces.len()];
        vec![a, b, a]
    }));
    mesh
}

proptest! {
    #[test]
    fn computed_normals_are_the_same_for_any_order_of_faces_and_corners(
        twice in prop::collection::vec(0usize..500, 0..9),
        flat in prop::collection::vec(0usize..500, 0..9),
        keys in prop::collection::vec(any::<u32>(), 300),
        crease in 0.1f32..1.5,
    ) {
        let mesh = cap(&twice, &flat);
        // By the corners of each face in their cyclic order, from the lowest: the normals there.
        let normals_of = |mesh: &Mesh| {
            let mut model = npr_mesh::Model {
                positions: mesh.positions.clone(),
                faces: mesh.triangles().0,
                ..Default::default()
            };
            npr_mesh::normals::fill_missing(&mut model, crease);
            let corner = |&v: &u32| (model.positions[v as usize].to_array().map(f32::to_bits), model.normals[v as usize]);
            let with_area = model.faces.iter().filter(|face| !edges::has_zero_area(&model.positions, face));
            let mut all: Vec<[_; 3]> = with_area
                .map(|face| {
                    let mut corners = face.each_ref().map(corner);
                    let lowest = (0..3).min_by_key(|&i| corners[i].0).unwrap_or(0);
                    corners.rotate_left(lowest);
                    corners
                })
                .collect();
            all.sort_by_key(|corners| corners.map(|corner| corner.0));
            all
        };
        let mut other = mesh.clone();
        let mut order: Vec<usize> = (0..mesh.polygons.len()).collect();
        order.sort_by_key(|&face| keys[face % keys.len()].rotate_left(face as u32 / 300));
        other.polygons = order.iter().map(|&face| mesh.polygons[face].clone()).collect();
        for (polygon, key) in other.polygons.iter_mut().zip(&keys) {
            polygon.rotate_left(*key as usize % 3);
        }
        for (a, b) in normals_of(&mesh).iter().flatten().zip(normals_of(&other).iter().flatten()) {
            prop_assert_eq!(a.0, b.0);
            prop_assert!(a.1.distance(b.1) < 1e-5, "{} {}", a.1, b.1);
        }
    }
}

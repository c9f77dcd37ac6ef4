use super::*;
use glam::Vec3;

fn model(positions: &[[f32; 3]], faces: &[[u32; 3]]) -> Model {
    Model {
        positions: positions.iter().map(|&p| Vec3::from_array(p)).collect(),
        faces: faces.to_vec(),
        face_material: vec![0; faces.len()],
        materials: vec![npr_mesh::Material::default()],
        ..Model::default()
    }
}

fn cube() -> Model {
    let positions: Vec<[f32; 3]> =
        (0..8).map(|i| [(i & 1) as f32, (i >> 1 & 1) as f32 * 2.0, (i >> 2) as f32 * 3.0]).collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let faces: Vec<[u32; 3]> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    model(&positions, &faces)
}

#[test]
fn a_cube_has_twelve_creases() {
    let mut cube = cube();
    let counted = inspect("cube", &cube, vec!["a word".to_owned().into()]);
    assert_eq!((counted.faces, counted.edges, counted.two_face_edges), (12, 18, 18));
    assert_eq!((counted.creases_over_30_deg, counted.within_0_01_deg_of_30), (12, 0));
    assert_eq!((counted.vertices, counted.positions, counted.polygons), (8, 8, 12));
    assert_eq!((counted.closed, counted.wound_oppositely), (true, 0));
    assert_eq!((counted.extent, counted.min, counted.max), ([1.0, 2.0, 3.0], [0.0; 3], [1.0, 2.0, 3.0]));
    assert_eq!((counted.materials, counted.textures, counted.warnings.len()), (1, 0, 1));
    // As polygons, the cube has no diagonals.
    cube.face_polygon = (0..12).map(|face| face / 2).collect();
    let counted = inspect("cube", &cube, Vec::new());
    assert_eq!((counted.edges, counted.two_face_edges, counted.polygons), (12, 12, 6));
    assert_eq!((counted.creases_over_30_deg, counted.faces), (12, 12));
    // Flipping one face does not change the surface.
    cube.face_polygon.clear();
    cube.faces[0].swap(0, 1);
    let counted = inspect("cube", &cube, Vec::new());
    assert_eq!((counted.wound_oppositely, counted.creases_over_30_deg, counted.closed), (3, 12, true));
}

#[test]
fn faults_are_counted() {
    let mut faulty = cube();
    faulty.positions.extend([Vec3::ZERO, Vec3::new(0.5, 0.0, 0.0), Vec3::new(9.0, 9.0, 9.0)]);
    // Two duplicates of the first face (with vertex 8 at the position of vertex 0), one flipped; a collinear face; a
    // collapsed face twice.
    faulty.faces.extend([[4, 6, 8], [6, 4, 0], [0, 9, 1], [0, 8, 5], [0, 8, 5]]);
    faulty.face_material = vec![0; faulty.faces.len()];
    let counted = inspect("faulty", &faulty, Vec::new());
    assert_eq!((counted.duplicate_faces, counted.zero_area_faces), (2, 3));
    assert_eq!((counted.vertices, counted.positions), (11, 10));
    assert!(!counted.closed && counted.nonmanifold_edges > 0);
    assert_eq!(counted.edges, counted.boundary_edges + counted.two_face_edges + counted.nonmanifold_edges);
    // Unused vertices are not in the bounding box.
    assert_eq!(counted.max, [1.0, 2.0, 3.0]);
}

#[test]
fn polygons_are_duplicates_as_a_whole() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.4, 0.4, 1.0]];
    // Two quads whose triangulations share the triangle 0 2 1, then the first quad again with another triangulation.
    let mut quads = model(&corners, &[[0, 1, 2], [0, 2, 3], [0, 2, 1], [0, 4, 2], [1, 2, 3], [1, 3, 0]]);
    assert_eq!(inspect("", &quads, Vec::new()).duplicate_faces, 1);
    quads.face_polygon = vec![0, 0, 1, 1, 2, 2];
    assert_eq!(inspect("", &quads, Vec::new()).duplicate_faces, 2);
    quads.face_polygon = vec![0, 0, 1, 1, 2, 3];
    assert_eq!(inspect("", &quads, Vec::new()).duplicate_faces, 0);
}

#[test]
fn thirty_degrees_is_where_it_is() {
    for (angle_deg, over, near) in [
        (29.98, 0, 0),
        (29.995, 0, 1),
        (29.999, 0, 1),
        (30.001, 1, 1),
        (30.005, 1, 1),
        (30.02, 1, 0),
        (90.0, 1, 0),
        (179.0, 1, 0),
    ] {
        let (sin, cos) = f64::to_radians(angle_deg).sin_cos();
        // Two large wings whose hinge is a short edge: the positions' rounding turns them by 1e-7 only.
        let flat = model(
            &[[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.5, 0.0], [cos as f32, 0.5, sin as f32]],
            &[[0, 1, 2], [1, 0, 3]],
        );
        for size in [1.0, 1e-30, 1e30] {
            for turned in [false, true] {
                let mut flat = flat.clone();
                flat.positions.iter_mut().for_each(|p| *p *= size);
                if turned {
                    flat.faces[1].swap(0, 1);
                }
                let counted = inspect("hinge", &flat, Vec::new());
                assert_eq!((counted.creases_over_30_deg, counted.within_0_01_deg_of_30), (over, near), "{angle_deg}");
                assert_eq!(counted.wound_oppositely, usize::from(turned));
            }
        }
    }
}

#[test]
fn nothing_is_nothing() {
    let counted = inspect("", &Model::default(), Vec::new());
    assert_eq!((counted.faces, counted.edges, counted.closed, counted.extent), (0, 0, false, [0.0; 3]));
}

#[test]
fn it_prints_as_a_table_and_as_json() {
    let counted = inspect("cube", &cube(), ["first", "second"].map(|text| text.to_owned().into()).to_vec());
    let text = counted.to_string();
    let columns: Vec<usize> = text
        .lines()
        .map(|line| line.chars().count() - line.chars().skip(23).collect::<String>().chars().count())
        .collect();
    assert!(columns.iter().all(|&c| c == 23), "{text}");
    assert!(text.lines().all(|line| line.chars().nth(22) == Some(' ') && line.chars().nth(23) != Some(' ')), "{text}");
    assert_eq!(text.lines().filter(|line| line.starts_with("warning")).count(), 2);
    let json = serde_json::to_value(&counted).expect("plain numbers");
    assert_eq!(json["within_0.01_deg_of_30"], 0);
    assert_eq!(json["creases_over_30_deg"], 12);
    assert_eq!(json["closed"], true);
}

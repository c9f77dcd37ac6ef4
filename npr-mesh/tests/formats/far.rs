//! Models far from the origin.

use crate::{load_alone, warnings};
use glam::{DVec3, Vec3};
use npr_mesh::edges::{self, EdgeOptions};
use npr_mesh::{Loaded, Model};

/// Boxes of 10 to 30 units with decimal fractions, moved by whole numbers, each with a line along its roof.
fn city(x: i64, y: i64, z: i64, ending: &str) -> String {
    let mut obj = String::new();
    let number = |whole: i64, hundredths: i64, from: i64| {
        let all = from * 100 + whole * 100 + hundredths;
        format!("{}{}.{:02}", if all < 0 { "-" } else { "" }, all.abs() / 100, all.abs() % 100)
    };
    for block in 0..9i64 {
        let (east, north, height) = (block % 3 * 40, block / 3 * 40, 10 + block * 2);
        for corner in 0..8i64 {
            let of = |bit: i64, size: i64, odd: i64| if corner >> bit & 1 == 1 { (size, odd) } else { (0, odd / 2) };
            let ((w, wh), (d, dh), (h, hh)) = (of(0, 20, 31), of(1, 25, 77), of(2, height, 13));
            obj +=
                &format!("v {} {} {}{ending}\n", number(east + w, wh, x), number(north + d, dh, y), number(h, hh, z));
        }
        let first = 8 * block;
        for face in [[5, 6, 8, 7], [2, 4, 8, 6], [1, 3, 4, 2], [1, 5, 7, 3], [3, 7, 8, 4], [1, 2, 6, 5]] {
            obj += &format!("f {}\n", face.map(|corner| (corner + first).to_string()).join(" "));
        }
        obj += &format!("l {} {}\n", first + 5, first + 8);
    }
    obj
}

fn loaded(text: String) -> Loaded {
    load_alone("m.obj", text).expect("it loads")
}

/// Positions in the world, exactly.
fn world(loaded: &Loaded) -> Vec<DVec3> {
    let [object] = &loaded.objects[..] else { panic!("one object") };
    let positions = &loaded.meshes[object.mesh].positions;
    positions.iter().map(|p| object.world_from_mesh.transform_point3(p.as_dvec3())).collect()
}

fn counts(model: &Model) -> [usize; 4] {
    let Model { positions, faces, face_polygon, face_material, .. } = model;
    let found = edges::find(positions, faces, face_polygon, face_material, &EdgeOptions::default());
    let creases = found.edges.iter().filter(|edge| found.dihedral_rad(edge) > Some(0.5)).count();
    [faces.len(), found.edges.len(), creases, model.lines.len()]
}

#[test]
fn a_city_at_utm_coordinates_is_that_at_the_origin() {
    for ending in ["", " 0.5 0.25 1"] {
        let here = loaded(city(0, 0, 0, ending));
        assert_eq!(here.objects[0].world_from_mesh.translation, DVec3::ZERO, "near the origin nothing is moved");
        for (x, y, z) in [(500_000, 5_400_000, 0), (-500_000, 0, -5_400_000), (0, 0, 16_777_216)] {
            let far = loaded(city(x, y, z, ending));
            let at = DVec3::new(x as f64, y as f64, z as f64);
            assert_ne!(far.objects[0].world_from_mesh.translation, DVec3::ZERO);
            for (a, b) in world(&here).iter().zip(world(&far)) {
                assert!((b - at).distance(*a) < 1e-5, "{a} is {}", b - at);
            }
            let [a, b] = [&here.meshes[0], &far.meshes[0]];
            assert_eq!(
                (&a.faces, &a.face_polygon, &a.lines, &a.colors),
                (&b.faces, &b.face_polygon, &b.lines, &b.colors)
            );
            assert_eq!(counts(a), counts(b));
            assert!(a.normals.iter().zip(&b.normals).all(|(a, b)| a.distance(*b) < 1e-6));
            assert_eq!(warnings(&far), [""; 0]);
            let (local, origin) = far.clone().into_model_near();
            assert_eq!(counts(&local), counts(a));
            assert!(origin.distance(at) < 100.0);
        }
    }
}

#[test]
fn a_small_box_at_the_end_of_f32_keeps_its_size() {
    let mut text = String::new();
    for corner in 0..8 {
        let at = |bit: u32| if corner >> bit & 1 == 1 { 8 } else { 2 };
        text += &format!("v 8388608.{} {} 8388608.{}\n", at(0), f64::from(at(1)) / 10.0, at(2));
    }
    text += "f 5 6 8 7\nf 2 4 8 6\nf 1 3 4 2\nf 1 5 7 3\nf 3 7 8 4\nf 1 2 6 5\n";
    let loaded = loaded(text);
    assert_eq!(warnings(&loaded), [""; 0]);
    let (low, high) = loaded.meshes[0].bounds().unwrap();
    assert!((high - low).distance(Vec3::splat(0.6)) < 1e-6, "{}", high - low);
    // Smaller than a step of f32 there, so the first look sees a point.
    let tiny = "v 1e10 0 0\nv 10000000000.002 0 0\nv 1e10 0.001 0\nf 1 2 3\n";
    let tiny = load_alone("m.obj", tiny).expect("it loads");
    let [a, b, c] = [0, 1, 2].map(|vertex: usize| world(&tiny)[vertex]);
    assert!(((b - a).length() - 0.002).abs() < 1e-5 && ((c - a).length() - 0.001).abs() < 1e-5, "{}", b - a);
}

#[test]
fn vertices_with_weights_and_unused_ones() {
    let text = "v 2000000.2 0 0 2\nv 1000001.1 0 0\nv 1000000.1 1 0\nv 0 0 0\nv 1e300 0 0\nf 1 2 3\n";
    let loaded = load_alone("m.obj", text).expect("it loads");
    let corners = world(&loaded);
    assert!(corners[0].distance(DVec3::new(1_000_000.1, 0.0, 0.0)) < 1e-6, "{}", corners[0]);
    assert!(corners[1].distance(DVec3::new(1_000_001.1, 0.0, 0.0)) < 1e-6);
}

#[test]
fn digits_that_the_file_has_lost_are_warned_of() {
    let cube =
        |at: f32| -> Vec<[f32; 3]> { (0..3).map(|i| [at + 7.3 * i as f32, 0.1 * (i * i) as f32, 0.0]).collect() };
    let obj = |at: f32| {
        let lines: String = cube(at).iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
        load_alone("m.obj", lines + "f 1 2 3\n").expect("it loads")
    };
    let [warning] = &warnings(&obj(5_400_000.0))[..] else { panic!("one warning") };
    assert!(warning.contains("5.4e6 units from the origin") && warning.contains("a step of 0.5 units"), "{warning}");
    assert_eq!(warnings(&obj(0.0)), [""; 0]);
    let stl = |at: f32| {
        let mut bytes = vec![0; 80];
        bytes.extend(1u32.to_le_bytes());
        bytes.extend([0; 12]);
        cube(at).iter().flatten().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend([0; 2]);
        load_alone("m.stl", bytes).expect("it loads")
    };
    assert!(warnings(&stl(5_400_000.0))[0].contains("a step of 0.5 units"));
    assert_eq!(warnings(&stl(0.0)), [""; 0]);
    let ply = |kind: &str| {
        let header = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty {kind} x\nproperty {kind} y\nproperty {kind} z\n\
             element face 1\nproperty list uchar int vertex_index\nend_header\n"
        );
        let mut bytes = header.into_bytes();
        for x in [5_400_000.125f64, 0.0, 0.0, 5_400_001.0, 0.0, 0.0, 5_400_000.125, 0.25, 0.0] {
            if kind == "double" { bytes.extend(x.to_le_bytes()) } else { bytes.extend((x as f32).to_le_bytes()) }
        }
        bytes.extend([3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]);
        load_alone("m.ply", bytes).expect("it loads")
    };
    assert!(warnings(&ply("float")).iter().any(|line| line.contains("a step of 0.5 units")));
    assert_eq!(warnings(&ply("double")), [""; 0]);
    assert_eq!(world(&ply("double"))[1] - world(&ply("double"))[0], DVec3::new(0.875, 0.0, 0.0));
}

//! Comparison of the statistics of real models with those of two other programs, and statistics of far and huge models.
#![allow(clippy::print_stdout)]

use npr_harness::inspect::{Inspection, inspect, inspect_loaded};
use npr_mesh::weld::Weld;
use std::{fs, path::Path};

#[test]
fn the_counts_of_real_models_are_right() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    let Ok(table) = fs::read_to_string(folder.join("topology.tsv")) else {
        println!("skipped: no models at {}", folder.display());
        return;
    };
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let columns: Vec<&str> = lines.next().expect("a line of names").split('\t').collect();
    let mut models = 0;
    let mut faults = Vec::new();
    for line in lines {
        let row: Vec<&str> = line.split('\t').collect();
        let name = row[0];
        let loaded = npr_mesh::load(&folder.join(format!("{name}.obj")), &Default::default()).expect("a good file");
        let warnings = loaded.warnings.clone();
        let counted = serde_json::to_value(inspect(name, &loaded.into_model(), warnings)).expect("plain numbers");
        let slack: u64 =
            row[columns.iter().position(|&c| c == "within_0.01_deg_of_30").expect("there")].parse().expect("a number");
        for (&column, &expected) in columns.iter().zip(&row).skip(1) {
            let expected: u64 = expected.parse().expect("a number");
            let actual = counted[column].as_u64().unwrap_or_else(|| panic!("{column} is not counted"));
            // The order of additions decides on which side of 30° these edges are.
            let slack = if column == "creases_over_30_deg" { slack } else { 0 };
            if actual.abs_diff(expected) > slack {
                faults.push(format!("{name}: {column} is {actual}, not {expected}"));
            }
        }
        models += 1;
    }
    assert!(models > 0, "no model in the table");
    assert!(faults.is_empty(), "{faults:#?}");
}

fn inspected(name: &str, text: &str) -> Inspection {
    let folder = std::env::temp_dir().join(format!("npr-inspect-{}-{name}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join(name), text).expect("written");
    let loaded = npr_mesh::load(&folder.join(name), &Default::default()).expect("a good file");
    let _ = fs::remove_dir_all(&folder);
    inspect_loaded(name, loaded, Weld::Exact)
}

#[test]
fn extents_beyond_f32_are_numbers() {
    let huge = inspected("huge.obj", "v -3e38 0 0\nv 3e38 0 0\nv 0 1 0\nf 1 2 3\n");
    assert!((huge.extent[0] - 6e38).abs() < 1e32, "{:?}", huge.extent);
    let json: serde_json::Value = serde_json::from_str(&serde_json::to_string(&huge).expect("JSON")).expect("JSON");
    assert!(json["extent"][0].as_f64().is_some_and(|extent| (extent - 6e38).abs() < 1e32), "{json}");
    assert!(!huge.to_string().contains("inf"), "{huge}");
}

#[test]
fn objects_far_from_the_origin_keep_their_digits() {
    // A triangle with the corners (0, 0, 0), (1, 0, 0) and (0, 1, 0), whose normals are made from it.
    let file = |nodes: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"nodes":[{nodes}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}}],
            "buffers":[{{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}]}}"#
        )
    };
    let city = |[x, y]: [f64; 2]| {
        let node = |dx: f64, dy: f64| {
            format!(r#"{{"mesh":0,"translation":[{},{},0],"scale":[0.125,0.125,0.125]}}"#, x + dx, y + dy)
        };
        inspected("city.gltf", &file(&[node(0.0, 0.0), node(0.6, 0.0), node(0.0, 0.3)].join(",")))
    };
    let (near, far) = (city([0.0; 2]), city([500_000.25, 5_400_000.5]));
    assert_eq!((near.positions, near.edges, near.zero_area_faces), (9, 9, 0));
    assert_eq!((far.positions, far.edges, far.zero_area_faces), (9, 9, 0));
    for (near, far) in near.extent.iter().zip(far.extent) {
        assert!((near - far).abs() < 1e-6, "{near} {far}");
    }
    assert!((far.min[0] - 500_000.25).abs() < 1e-6 && (far.max[1] - 5_400_000.925).abs() < 1e-6, "{far}");
    assert_eq!(far.objects, 3);
    // Numbers have no more digits than they have.
    assert!(near.to_string().contains(" 0.725 0.425 0\n"), "{near}");
}

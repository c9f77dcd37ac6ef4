//! The rules for irregular topology on real models, if they are there: they change nothing where a model is clean.
#![cfg(all(feature = "obj", feature = "gltf"))]
#![allow(clippy::print_stdout)]

use npr_mesh::edges::{self, EdgeKind, EdgeOptions, Edges};
use npr_mesh::weld;
use std::path::Path;

/// Models with T-junctions, seams within rounding and faces without area.
const NOT_CLEAN: [&str; 1] = ["2CylinderEngine.glb"];

#[test]
fn clean_models_have_the_edges_of_their_file() {
    let data = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    let Ok(entries) = std::fs::read_dir(data) else {
        println!("skipped: no shared models here");
        return;
    };
    let mut models = 0;
    for path in entries.filter_map(|entry| entry.ok().map(|entry| entry.path())) {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        if !["obj", "glb", "gltf"].contains(&ending) {
            continue;
        }
        models += 1;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let loaded = npr_mesh::load(&path, &Default::default()).expect("a model loads");
        for (number, mesh) in loaded.meshes.iter().enumerate() {
            let (positions, faces) = (&mesh.positions, &mesh.faces);
            let find =
                |options: EdgeOptions| edges::find(positions, faces, &mesh.face_polygon, &mesh.face_material, &options);
            let plain = find(EdgeOptions { skip_redundant: true, ..EdgeOptions::of_file() });
            let drawn = find(EdgeOptions::default());
            if NOT_CLEAN.contains(&&*name) {
                let open = |found: &Edges| found.edges.iter().filter(|edge| edge.kind() == EdgeKind::Boundary).count();
                assert!(open(&drawn) <= open(&plain), "{name}, mesh {number}");
                continue;
            }
            assert_eq!(weld::weld_rounding(positions, faces), weld::weld_exact(positions), "{name}, mesh {number}");
            assert!(plain.edges == drawn.edges && plain.skipped == drawn.skipped, "{name}, mesh {number}");
        }
    }
    assert!(models > 5);
}

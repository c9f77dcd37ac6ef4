//! `npr export`.

mod common;

use common::Folder;
use serde_json::Value;
use std::fs;
use std::process::{Command, Output};

/// A cube of quads.
const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

fn npr(arguments: &[&str], folder: &Folder) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_npr"));
    command.args(arguments).env("NPR_GPU", "off").current_dir(&folder.0).output().expect("the command can be run")
}

fn done(arguments: &[&str], folder: &Folder) -> String {
    let output = npr(arguments, folder);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

fn with_cube() -> Folder {
    let folder = Folder::new();
    fs::write(folder.join("cube.obj"), CUBE).expect("written");
    folder
}

#[test]
fn a_model_is_written_with_its_edges_and_draws_the_same_lines() {
    let folder = with_cube();
    let said: Value =
        serde_json::from_str(&done(&["export", "cube.obj", "--edges", "-o", "cube.glb", "--json"], &folder))
            .expect("JSON");
    assert_eq!((&said["faces"], &said["edges"], &said["stated_sides"]), (&12.into(), &true.into(), &0.into()));
    let inspected: Value = serde_json::from_str(&done(&["inspect", "cube.glb", "--json"], &folder)).expect("JSON");
    // Without polygons the diagonals are edges, which the file hides.
    assert_eq!((&inspected["edges"], &inspected["stated_sides"]), (&18.into(), &36.into()));
    let lines = |model: &str, more: &[&str]| -> Value {
        let arguments =
            [&["render", model, "--size", "40x30", "--backend", "cpu", "-o", "a.png", "--json"], more].concat();
        serde_json::from_str::<Value>(&done(&arguments, &folder)).expect("JSON")["lines"].take()
    };
    assert_eq!(lines("cube.obj", &[]), lines("cube.glb", &[]));
    // An angle above 90° leaves silhouettes alone, and a style may have its own rules.
    done(&["export", "cube.obj", "--edges", "--crease-angle", "100", "-o", "smooth.GLB"], &folder);
    assert_eq!(lines("smooth.GLB", &[])["crease"], 0);
    let style = done(&["style", "cartoon"], &folder).replace("file-edges = true", "file-edges = false");
    fs::write(folder.join("own.toml"), style).expect("written");
    assert_eq!(lines("smooth.GLB", &["--style", "own.toml"]), lines("cube.obj", &[]));
    // What a file states is written as it is, at any angle.
    done(&["export", "smooth.GLB", "--edges", "--crease-angle", "10", "-o", "again.glb"], &folder);
    let [first, second] = ["smooth.GLB", "again.glb"].map(|name| fs::read(folder.join(name)).expect("it is there"));
    assert_eq!(first.len(), second.len());
    assert_eq!(lines("again.glb", &[])["crease"], 0);
    // Without edges nothing is stated.
    done(&["export", "cube.obj", "-o", "plain.glb"], &folder);
    assert!(!done(&["inspect", "plain.glb"], &folder).contains("sides that the file classes"));
}

#[test]
fn what_cannot_be_exported_is_one_line_and_writes_nothing() {
    let folder = with_cube();
    fs::create_dir(folder.join("dir.glb")).expect("made");
    done(&["export", "cube.obj", "-o", "a.glb"], &folder);
    let cases: [(&[&str], &str); 7] = [
        (&["export", "none.obj", "-o", "b.glb"], "model none.obj: no such file"),
        (&["export", "cube.obj", "-o", "b.gltf"], "b.gltf: a model is written as .glb"),
        (&["export", "cube.obj", "-o", "b"], "b: a model is written as .glb"),
        (&["export", "cube.obj", "-o", "dir.glb"], "output dir.glb: is a directory"),
        (&["export", "a.glb", "-o", "./a.glb"], "a.glb"),
        (&["export", "cube.obj", "-o", "none/b.glb"], "none/b.glb"),
        (&["export", "cube.obj", "--edges", "--crease-angle", "200", "-o", "b.glb"], "0..=180 degrees"),
    ];
    for (arguments, text) in cases {
        let output = npr(arguments, &folder);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(said.contains(text) && said.lines().count() == 1, "{arguments:?}: {said}");
    }
    assert!(!folder.join("b.glb").exists() && !folder.join("b").exists());
    // An angle without edges is a misunderstanding.
    assert_eq!(npr(&["export", "cube.obj", "--crease-angle", "20", "-o", "b.glb"], &folder).status.code(), Some(2));
}

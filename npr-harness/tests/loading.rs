//! Tests of the flags for loading models.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A temporary folder, deleted when dropped, with a model whose texture and material lie in a folder next to its own.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("npr-loading-{name}-{}", std::process::id()));
        fs::create_dir_all(path.join("model")).expect("a folder");
        fs::create_dir_all(path.join("assets")).expect("a folder");
        fs::write(path.join("assets/m.mtl"), "newmtl red\nKd 1 0 0\nmap_Kd t.png\n").expect("written");
        image::RgbaImage::new(2, 2).save(path.join("assets/t.png")).expect("written");
        let text =
            "mtllib ../assets/m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nusemtl red\nf 1//1 2//1 3//1 4//1\n";
        fs::write(path.join("model/m.obj"), text).expect("written");
        Self(path)
    }

    fn inspect(&self, flags: &[&str]) -> Output {
        let model = self.0.join("model/m.obj");
        let mut command = Command::new(env!("CARGO_BIN_EXE_npr"));
        command.arg("inspect").arg(model).arg("--json").args(flags).output().expect("npr runs")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn path(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

#[test]
fn files_outside_of_the_models_folder_are_read_with_an_asset_root_only() {
    let folder = Folder::new("root");
    let without = json(&folder.inspect(&[]));
    assert_eq!(without["textures"], 0);
    let warnings = without["warnings"].as_array().expect("a list");
    assert!(warnings.iter().any(|w| w["text"].as_str().is_some_and(|w| w.contains("leads out of the model's folder"))));

    let with = json(&folder.inspect(&["--asset-root", path(&folder.0.join("assets"))]));
    assert_eq!((&with["textures"], &with["materials"]), (&1.into(), &1.into()));
    assert!(with["warnings"].as_array().is_some_and(Vec::is_empty), "{}", with["warnings"]);
}

#[test]
fn limits_are_lowered_and_misspelt_ones_refused() {
    let folder = Folder::new("limit");
    let output = folder.inspect(&["--limit", "faces=1", "--limit", "vertices=100"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("2 faces, more than the limit of 1"), "{message}");
    for (wrong, said) in [
        ("face=1", "did you mean \"faces\"? there are: file-bytes, vertices, "),
        ("vertexes=1", "did you mean \"vertices\"?"),
        ("triangles=1", "\"triangles\" is no limit (there are: "),
        ("faces", "NAME=NUMBER"),
        ("faces=-1", "whole number"),
        ("faces=many", "whole number"),
    ] {
        let output = folder.inspect(&["--limit", wrong]);
        assert_eq!(output.status.code(), Some(2), "{wrong}");
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.contains(said), "{wrong}: {message}");
    }
    // Every name that the message lists is accepted.
    let listed = String::from_utf8_lossy(&folder.inspect(&["--limit", "=1"]).stderr).into_owned();
    let names = listed.split_once("there are: ").and_then(|(_, rest)| rest.split_once(')')).expect("a list").0;
    let all: Vec<String> =
        names.split(", ").flat_map(|name| ["--limit".to_owned(), format!("{name}=1000000")]).collect();
    assert_eq!(all.len(), 20, "{names}");
    json(&folder.inspect(&all.iter().map(String::as_str).collect::<Vec<_>>()));
}

#[test]
fn a_texture_may_be_webp() {
    let folder = Folder::new("webp");
    fs::write(folder.0.join("assets/m.mtl"), "newmtl red\nmap_Kd t.webp\n").expect("written");
    image::RgbaImage::new(2, 2).save(folder.0.join("assets/t.webp")).expect("written");
    let found = json(&folder.inspect(&["--asset-root", path(&folder.0.join("assets"))]));
    assert_eq!(found["textures"], 1);
}

//! The flags that say what of a model is read.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of its own, gone when dropped, with a model whose texture and material lie beside its folder.
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
    assert!(warnings.iter().any(|w| w.as_str().is_some_and(|w| w.contains("leads out of the model's folder"))));

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
    for wrong in ["face=1", "faces", "faces=-1", "faces=many"] {
        let output = folder.inspect(&["--limit", wrong]);
        assert_eq!(output.status.code(), Some(2), "{wrong}");
    }
}

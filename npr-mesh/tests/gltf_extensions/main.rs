//! Extensions of glTF, transforms in f64, and errors that name what is wrong.
#![cfg(feature = "gltf")]

#[allow(dead_code, reason = "shared with the hostile files")]
#[path = "../hostile/case.rs"]
mod case;
#[allow(dead_code, reason = "shared with the hostile files")]
#[path = "../hostile/doc.rs"]
mod doc;

mod compressed;
mod indices;
mod instances;
mod materials;
mod messages;

use doc::Doc;
use npr_mesh::{Limits, LoadError, LoadOptions, Loaded, load};
use std::sync::atomic::{AtomicU32, Ordering};

/// Writes the file into a temporary folder and loads it.
fn load_with(doc: &Doc, limits: Limits) -> Result<Loaded, LoadError> {
    load_bytes("m.glb", &doc.glb(), limits)
}

fn load_bytes(name: &str, bytes: &[u8], limits: Limits) -> Result<Loaded, LoadError> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let folder = std::env::temp_dir().join(format!("npr-mesh-extensions-{}-{number}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join(name), bytes).expect("written");
    let loaded = load(&folder.join(name), &LoadOptions { limits, ..LoadOptions::default() });
    let _ = std::fs::remove_dir_all(&folder);
    loaded
}

#[track_caller]
fn loaded(doc: &Doc) -> Loaded {
    load_with(doc, Limits::default()).expect("a good file")
}

#[track_caller]
fn assert_fails(doc: &Doc, fault: &str) {
    let error = load_with(doc, Limits::default()).expect_err(fault).to_string();
    assert!(error.contains(fault) && error.contains("m.glb"), "{error}\nexpected: {fault}");
}

fn warnings(loaded: &Loaded) -> Vec<String> {
    loaded.warnings.iter().map(ToString::to_string).collect()
}

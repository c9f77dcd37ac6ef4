//! What the loaders make of material files, smoothing groups, polylines, PLY, STL, files far from the origin, and
//! models in memory.
#![cfg(all(feature = "obj", feature = "gltf", feature = "ply", feature = "stl"))]

mod far;
mod folder;
mod materials;
mod memory;
mod ply;
mod polylines;
mod smoothing;
mod stl;

use npr_mesh::{LoadError, LoadOptions, Loaded, load_bytes};
use std::io;

/// A model in memory that refers to no file.
fn load_alone(name: &str, bytes: impl Into<Vec<u8>>) -> Result<Loaded, LoadError> {
    load_with(name, bytes, &[])
}

/// A model in memory, and the files that it may refer to.
fn load_with(name: &str, bytes: impl Into<Vec<u8>>, files: &[(&str, Vec<u8>)]) -> Result<Loaded, LoadError> {
    let resolver = |name: &str| match files.iter().find(|(known, _)| *known == name) {
        Some((_, bytes)) => Ok(bytes.clone()),
        None => Err(io::ErrorKind::NotFound.into()),
    };
    load_bytes(name, bytes.into(), &resolver, &LoadOptions::default())
}

fn warnings(loaded: &Loaded) -> Vec<String> {
    let of_normals = |line: &String| line.starts_with("no normals: ");
    loaded.warnings.iter().map(ToString::to_string).filter(|line| !of_normals(line)).collect()
}

//! Counts the edges of a model by kind: `cargo run -p npr-mesh --example topology -- model.obj`. Without a file it uses the
//! teapot.
#![allow(clippy::print_stdout)]

use npr_mesh::edges::{EdgeKind, find};
use npr_mesh::{LoadError, Model, embedded};
use std::path::PathBuf;

fn main() -> Result<(), LoadError> {
    let model = match std::env::args_os().nth(1).map(PathBuf::from) {
        Some(path) => read(path)?,
        None => embedded::teapot(12),
    };
    let found = find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &Default::default());
    println!("{} faces, {} edges", model.faces.len(), found.edges.len());
    for kind in [EdgeKind::Boundary, EdgeKind::TwoFace, EdgeKind::NonManifold] {
        println!("{:>8} {kind:?}", found.edges.iter().filter(|edge| edge.kind() == kind).count());
    }
    let is_crease = |cos: f32| cos < 30f32.to_radians().cos();
    let creases = found.edges.iter().filter(|edge| found.cos_dihedral(edge).is_some_and(is_crease));
    println!("{:>8} creases over 30°", creases.count());
    Ok(())
}

#[cfg(any(feature = "obj", feature = "gltf"))]
fn read(path: PathBuf) -> Result<Model, LoadError> {
    Ok(npr_mesh::load(&path, &Default::default())?.into_model())
}

/// Without loaders every format is unknown.
#[cfg(not(any(feature = "obj", feature = "gltf")))]
fn read(path: PathBuf) -> Result<Model, LoadError> {
    Err(LoadError::UnknownFormat { path })
}

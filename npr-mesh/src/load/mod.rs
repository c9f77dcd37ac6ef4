//! Loaders for each file format.
//!
//! A loader parses a file with the crate of its format, checks everything that is used afterwards (indices, lengths,
//! finite numbers, [`Limits`]), and then converts it.

mod external;
mod file;
#[cfg(feature = "gltf")]
mod gltf;
mod image_file;
mod loaded;
#[cfg(feature = "obj")]
mod obj;
mod options;
mod warning;

pub use loaded::Loaded;
pub use options::LoadOptions;
pub use warning::Warning;

use crate::{LoadError, Model, edges, normals};
use external::External;
use file::Parsed;
use glam::Vec3;
use std::path::Path;
use std::{fs, io};

/// Loads a model file. The format is determined by the file extension (`.obj`, `.gltf`, `.glb`, in any case).
///
/// # Errors
/// [`LoadError`] with the file and the fault.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, LoadError> {
    // Checked here, since a missing folder would otherwise give a warning for each file.
    if let Some(root) = &options.asset_root {
        let failed = |source| LoadError::Read { path: root.clone(), source };
        if !fs::metadata(root).map_err(failed)?.is_dir() {
            return Err(failed(io::ErrorKind::NotADirectory.into()));
        }
    }
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    let Parsed { mut meshes, objects, warnings } = match ending.as_str() {
        #[cfg(feature = "obj")]
        "obj" => obj::load(&External::new(path, options))?,
        #[cfg(feature = "gltf")]
        "gltf" | "glb" => gltf::load(&External::new(path, options))?,
        _ => return Err(LoadError::UnknownFormat { path: path.to_owned() }),
    };
    if objects.is_empty() {
        let why = Warning::counted(warnings).into_iter().next().map(|warning| warning.text);
        return Err(LoadError::Empty { path: path.to_owned(), why });
    }
    let mut warnings = Warning::counted(warnings);
    warnings.extend(report(&meshes).into_iter().map(Warning::from));
    let (crease_angle_rad, weld) = (options.normal_crease_angle_rad, options.weld);
    meshes.iter_mut().for_each(|mesh| normals::fill_missing_welded(mesh, crease_angle_rad, weld));
    Ok(Loaded { meshes, objects, warnings, weld })
}

/// Warns about missing normals and degenerate faces, for any format. Counts each mesh once.
fn report(meshes: &[Model]) -> Vec<String> {
    let [mut missing, mut vertices, mut flat, mut faces] = [0; 4];
    for mesh in meshes {
        let mut used = vec![false; mesh.positions.len()];
        mesh.faces.iter().flatten().for_each(|&vertex| used[vertex as usize] = true);
        let of_used = || mesh.normals.iter().zip(&used).filter(|(_, used)| **used);
        missing += of_used().filter(|(normal, _)| **normal == Vec3::ZERO || !normal.is_finite()).count();
        vertices += of_used().count();
        flat += mesh.faces.iter().filter(|face| edges::has_zero_area(&mesh.positions, face)).count();
        faces += mesh.faces.len();
    }
    let mut warnings = Vec::new();
    if missing > 0 && missing == vertices {
        warnings.push("no normals: they are made from the faces".to_owned());
    } else if missing > 0 {
        warnings.push(format!("{missing} of {vertices} vertices have no normal: it is made from the faces around"));
    }
    if flat > 0 {
        warnings.push(format!("{flat} of {faces} faces have no area"));
    }
    warnings
}

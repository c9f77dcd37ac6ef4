//! Loaders for each file format.
//!
//! A loader parses a file with the crate of its format, checks everything that is used afterwards (indices, lengths,
//! finite numbers, [`Limits`]), and then converts it.

mod external;
mod file;
#[cfg(feature = "gltf")]
mod gltf;
mod image_file;
#[cfg(feature = "obj")]
mod obj;
mod options;
mod warning;

pub use options::LoadOptions;
pub use warning::Warning;

use crate::{LoadError, Model, edges, normals};
use external::External;
use file::Parsed;
use glam::Vec3;
use std::path::Path;
use std::{fs, io};

/// A model, and the warnings of its loading.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loaded {
    /// The triangles; all normals are present.
    pub model: Model,
    /// Distinct warnings in the order of their first occurrence.
    pub warnings: Vec<Warning>,
}

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
    let Parsed { mut model, warnings } = match ending.as_str() {
        #[cfg(feature = "obj")]
        "obj" => obj::load(&External::new(path, options))?,
        #[cfg(feature = "gltf")]
        "gltf" | "glb" => gltf::load(&External::new(path, options))?,
        _ => return Err(LoadError::UnknownFormat { path: path.to_owned() }),
    };
    if model.faces.is_empty() {
        let why = Warning::counted(warnings).into_iter().next().map(|warning| warning.text);
        return Err(LoadError::Empty { path: path.to_owned(), why });
    }
    let mut of_model = Vec::new();
    report(&model, &mut of_model);
    let mut warnings = Warning::counted(warnings);
    warnings.extend(of_model.into_iter().map(Warning::from));
    normals::fill_missing(&mut model, options.normal_crease_angle_rad);
    Ok(Loaded { model, warnings })
}

/// Warns about missing normals and degenerate faces, for any format.
fn report(model: &Model, warnings: &mut Vec<String>) {
    let mut used = vec![false; model.positions.len()];
    model.faces.iter().flatten().for_each(|&vertex| used[vertex as usize] = true);
    let of_used = || model.normals.iter().zip(&used).filter(|(_, used)| **used);
    let missing = of_used().filter(|(normal, _)| **normal == Vec3::ZERO || !normal.is_finite()).count();
    match (missing, of_used().count()) {
        (0, _) => {}
        (missing, all) if missing == all => warnings.push("no normals: they are made from the faces".to_owned()),
        (missing, all) => {
            warnings.push(format!("{missing} of {all} vertices have no normal: it is made from the faces around"))
        }
    }
    let flat = model.faces.iter().filter(|face| edges::has_zero_area(&model.positions, face)).count();
    if flat > 0 {
        warnings.push(format!("{flat} of {} faces have no area", model.faces.len()));
    }
}

//! One guarded way in for each file format.
//!
//! A loader parses with the format's crate, checks everything that is then trusted (indices, lengths, finite
//! numbers, [`Limits`]), and only then converts.

mod external;
#[cfg(feature = "gltf")]
mod gltf;
mod image_file;
#[cfg(feature = "obj")]
mod obj;
mod warning;

pub use warning::Warning;

use crate::{Limits, LoadError, Model, edges, normals};
use external::External;
use glam::Vec3;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// How a file is to be read.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadOptions {
    /// Bounds on what is accepted.
    pub limits: Limits,
    /// A folder in which files that the model names (textures, materials, buffers) may lie besides the model's own. A
    /// relative name that is not found beside the model is looked for in this folder. Without it, nothing outside of the
    /// model's folder is read.
    pub asset_root: Option<PathBuf>,
    /// Where the file has no normals, they are made, and split between faces that meet at more than this angle.
    pub normal_crease_angle_rad: f32,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self { limits: Limits::default(), asset_root: None, normal_crease_angle_rad: 45f32.to_radians() }
    }
}

/// A model, and what had to be repaired or left out to get it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loaded {
    /// The triangles, every normal present.
    pub model: Model,
    /// Different ones, in the order in which they first came up.
    pub warnings: Vec<Warning>,
}

/// What the loader of a format returns: normals may be missing, faces too.
struct Parsed {
    model: Model,
    /// As they came up, the same one any number of times.
    warnings: Vec<String>,
}

/// Reads a model by its file's ending (`.obj`, `.gltf`, `.glb`, in any case).
///
/// # Errors
/// [`LoadError`], which names the file and the fault.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, LoadError> {
    // Said here: as a folder in which nothing is found it would be a warning for each file.
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

/// What of a model is repaired whatever its format: normals that are not there, faces that cannot be seen.
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

/// All of a regular file that is within [`Limits::file_bytes`].
fn read_file(path: &Path, limits: &Limits) -> Result<Vec<u8>, LoadError> {
    let failed = |source: io::Error| LoadError::Read { path: path.to_owned(), source };
    let too_large = |count| LoadError::TooLarge {
        path: path.to_owned(),
        what: "bytes in the file",
        count,
        limit: limits.file_bytes,
    };
    // Asked before opening: to open a pipe may wait for ever.
    let metadata = fs::metadata(path).map_err(failed)?;
    if !metadata.is_file() {
        return Err(failed(io::Error::other("not a regular file")));
    }
    if metadata.len() > limits.file_bytes {
        return Err(too_large(metadata.len()));
    }
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).unwrap_or(0));
    let file = fs::File::open(path).map_err(failed)?;
    // A file may grow between the question and the reading.
    file.take(limits.file_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > limits.file_bytes {
        return Err(too_large(bytes.len() as u64));
    }
    Ok(bytes)
}

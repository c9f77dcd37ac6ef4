//! Loaders for each file format.
//!
//! A loader parses a file with the crate of its format, checks everything that is used afterwards (indices, lengths,
//! finite numbers, [`Limits`]), and then converts it.

#[cfg(any(feature = "obj", feature = "ply"))]
mod color;
// Files of the other formats refer to no files.
#[cfg_attr(not(any(feature = "obj", feature = "gltf")), allow(dead_code))]
mod external;
mod far;
mod file;
mod format;
#[cfg(feature = "gltf")]
mod gltf;
#[cfg(any(feature = "obj", feature = "gltf"))]
mod image_file;
mod loaded;
#[cfg(feature = "obj")]
mod obj;
mod options;
#[cfg(feature = "ply")]
mod ply;
#[cfg(any(feature = "ply", feature = "stl"))]
mod polygons;
#[cfg(feature = "stl")]
mod stl;
mod warning;

pub use external::Resolver;
pub use loaded::Loaded;
pub use options::LoadOptions;
pub use warning::Warning;

use crate::{LoadError, Model, edges, normals};
use external::External;
use file::{Parsed, read_file};
use format::Format;
use glam::Vec3;
use std::path::Path;
use std::{fs, io};

/// Loads a model file. The format is determined by the file extension (`.obj`, `.gltf`, `.glb`, `.ply`, `.stl`, in any
/// case).
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
    let format = Format::of(path).ok_or_else(|| LoadError::UnknownFormat { path: path.to_owned() })?;
    let bytes = read_file(path, &options.limits)?;
    load_from(format, bytes, &External::new(path, options), options)
}

/// Loads a model from the bytes of its file, and all files that it refers to through a resolver: for archives, and
/// where there is no file system. Nothing is read from a disk.
///
/// `name` determines the format by its extension, or is an extension itself (`"obj"`); messages name the model by it.
/// `resolver` returns the bytes of materials, textures and buffers. It gets their names as in the model's file, after
/// percent-decoding, relative to the model, with `/` between folders; a material file's textures are first asked for
/// beside that file. Absolute names and names that lead out of the model's folder by `..` are refused, as on a disk, and
/// [`LoadOptions::asset_root`] has no effect. The limits are those of files on a disk.
///
/// ```
/// # #[cfg(feature = "obj")] {
/// use std::{collections::HashMap, io};
///
/// let archive = HashMap::from([("paint.mtl", &b"newmtl red\nKd 1 0 0\n"[..])]);
/// let resolver = |name: &str| match archive.get(name) {
///     Some(bytes) => Ok(bytes.to_vec()),
///     None => Err(io::ErrorKind::NotFound.into()),
/// };
/// let obj = "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
/// let loaded = npr_mesh::load_bytes("sheet.obj", obj.into(), &resolver, &Default::default())?;
/// assert_eq!(loaded.meshes[0].materials[0].base_color.to_array(), [1.0, 0.0, 0.0, 1.0]);
/// # }
/// # Ok::<(), npr_mesh::LoadError>(())
/// ```
///
/// # Errors
/// [`LoadError`] with the name and the fault. Where a file is missing or an error is returned for it, the result is as
/// for a missing file on a disk: a warning for materials and textures, an error for buffers that are needed.
pub fn load_bytes(name: &str, bytes: Vec<u8>, resolver: &Resolver, options: &LoadOptions) -> Result<Loaded, LoadError> {
    let path = Path::new(name);
    let format = Format::of(path).ok_or_else(|| LoadError::UnknownFormat { path: path.to_owned() })?;
    let (count, limit) = (bytes.len() as u64, options.limits.file_bytes);
    if count > limit {
        return Err(LoadError::TooLarge { path: path.to_owned(), what: "bytes in the file", count, limit });
    }
    load_from(format, bytes, &External::resolved_by(resolver, path, &options.limits), options)
}

fn load_from(format: Format, bytes: Vec<u8>, external: &External, options: &LoadOptions) -> Result<Loaded, LoadError> {
    let path = external.model;
    let Parsed { mut meshes, objects, warnings, smoothing } = match format {
        #[cfg(feature = "obj")]
        Format::Obj => obj::load(bytes, external)?,
        #[cfg(feature = "gltf")]
        Format::Gltf => gltf::load(bytes, external)?,
        #[cfg(feature = "ply")]
        Format::Ply => ply::load(&bytes, external)?,
        #[cfg(feature = "stl")]
        Format::Stl => stl::load(&bytes, external)?,
    };
    if objects.is_empty() {
        let why = Warning::counted(warnings).into_iter().next().map(|warning| warning.text);
        return Err(LoadError::Empty { path: path.to_owned(), why });
    }
    let mut warnings = Warning::counted(warnings);
    warnings.extend(report(&meshes).into_iter().map(Warning::from));
    let weld = options.weld;
    for (number, mesh) in meshes.iter_mut().enumerate() {
        let groups = smoothing.get(number).map_or(&[][..], Vec::as_slice);
        normals::fill_missing_in_groups(mesh, options.normal_crease_angle_rad, groups, weld);
    }
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
    // Meshes whose positions are relative to an offset are near their origin.
    let mut bounds = meshes.iter().filter_map(Model::bounds);
    warnings.extend(bounds.find_map(|(low, high)| far::lost_digits(low.as_dvec3(), high.as_dvec3())));
    warnings
}

//! Wavefront OBJ and MTL.
//!
//! tobj parses the file. What it would misread or cannot handle is corrected or rejected before ([`prepare`]): it
//! treats polylines of three and more points as faces, rejects files with a comment that is not UTF-8, a byte-order
//! mark or a continued line, assigns colours to the wrong vertices if only some have one, replaces a missing normal
//! by the preceding one, panics on some indices and on a `Kd` of two numbers, and reads material files of any size.
//! Materials are therefore read in [`mtl`]; tobj only gets their names.

mod builder;
mod far;
mod faults;
mod joined;
mod lines;
mod mtl;
mod polylines;
mod prepare;
mod texture_map;
mod textures;

use super::color::linear_from_srgb;
use super::external::{External, shortened};
use super::far as distant;
use super::file::Parsed;
use crate::triangulate::EAR_TESTS_OF_A_FILE;
use crate::{LoadError, Material, Model, Object};
use builder::Builder;
use glam::{DAffine3, DVec3, Vec3};
use mtl::{Library, Names};
use polylines::Polylines;
use prepare::{Prepared, prepare};
use std::io::Read;
use std::path::Path;
use textures::move_materials;

/// Loads an OBJ file, its `.mtl` files and their textures.
///
/// - Missing normals are zero. Texture coordinates are flipped vertically to the convention of [`Model::uvs`].
///   Normals that are not finite count as missing, and such texture coordinates become 0.
/// - `Kd` and vertex colours (`v x y z r g b`) are taken as sRGB-encoded and converted to linear values. Materials
///   are double-sided.
/// - Faces without a material, or with an undefined one, get [`Material::default`] as material 0.
/// - Missing normals are those of smoothing groups: within a group they are smooth whatever the angle, and with `s off`
///   those of the faces. Faces before any `s` follow the crease angle.
/// - Where the model is far from the origin, its positions are relative to an offset that is subtracted in f64, and the
///   object is translated by it.
/// - Polylines are [`Model::lines`]. Points, curves and surfaces are skipped with a warning.
/// - Materials may be used before the line that names their file. Of several materials with one name the first is
///   used.
/// - A missing or invalid material file or texture gives a warning. Textures of unused materials are not read.
///
/// # Errors
/// [`LoadError`] if the file cannot be read, is invalid, refers to missing or non-finite vertices, or exceeds a
/// limit. A file without faces is not an error here.
pub(super) fn load(bytes: Vec<u8>, external: &External) -> Result<Parsed, LoadError> {
    let (path, limits) = (external.model, external.limits);
    let mut prepared = prepare(bytes, path, limits)?;
    let mut warnings = std::mem::take(&mut prepared.warnings);
    if prepared.counts.triangles == 0 && prepared.lines.is_empty() {
        return Ok(Parsed { warnings, ..Parsed::default() });
    }

    let mut library = Library::default();
    for line in &prepared.material_files {
        library.read(external, line)?;
    }
    warnings.append(&mut library.warnings);
    let mut material_of = Vec::new();
    let mut used = vec![false; library.materials.len()];
    let names = Names::new(&library.materials);
    let mut undefined = Vec::new();
    for name in &prepared.materials_used {
        match names.find(name) {
            Some(number) => {
                material_of.push((name.clone(), number));
                used[number] = true;
            }
            None => undefined.push(name.as_str()),
        }
    }
    warnings.extend(without_definition(&undefined));

    let read = |text: &[u8]| {
        let options = tobj::LoadOptions { ignore_lines: true, ignore_points: true, ..tobj::LoadOptions::default() };
        // Materials may be used before the line that names their file.
        let mut reader = (&b"mtllib all\n"[..]).chain(text);
        tobj::load_obj_buf(&mut reader, &options, |_| {
            Ok((vec![tobj::Material::default(); library.materials.len()], material_of.iter().cloned().collect()))
        })
    };
    let Geometry { meshes, polylines, origin } = geometry(&mut prepared, path, &read, &mut warnings)?;
    drop(names);

    let mut model = Model::default();
    let needs_default = library.materials.is_empty()
        || meshes.iter().any(|m| m.mesh.material_id.is_none() && !m.mesh.indices.is_empty());
    if needs_default {
        model.materials.push(Material::default());
    }
    let first_material = model.materials.len();
    let placements = move_materials(library.materials, &used, &mut model, &mut warnings, external)?;

    let mut builder = Builder {
        model,
        path,
        limits,
        corners_before: 0,
        absent: &prepared.absent,
        objects: &prepared.objects,
        smoothing: &prepared.smoothing,
        face_group: Vec::new(),
        ear_tests: EAR_TESTS_OF_A_FILE,
        repaired: 0,
    };
    builder.model.faces.reserve(prepared.counts.triangles as usize);
    for mesh in &meshes {
        let material = mesh.mesh.material_id.map_or(0, |id| first_material + id);
        let Some(placement) = placements.get(material) else {
            return Err(builder.malformed(format!("material {material} is not there")));
        };
        builder.add(&mesh.mesh, material as u32, placement)?;
    }
    renumber(&mut builder.model.face_mesh);
    if builder.repaired > 0 {
        warnings.push(format!("{} texture coordinates or colours are not finite", builder.repaired));
    }
    let (mut model, face_group) = (builder.model, builder.face_group);
    polylines.add_to(&mut model);
    let (vertices, limit) = (model.positions.len() as u64, limits.vertices.min(u64::from(u32::MAX)));
    if vertices > limit {
        return Err(LoadError::TooLarge { path: path.to_owned(), what: "vertices", count: vertices, limit });
    }
    // Some files have colours in 0..=255.
    if model.colors.iter().any(|c| c.max_element() > 1.0) {
        warnings.push("vertex colours above 1 are taken as 0..=255".to_owned());
        for color in &mut model.colors {
            *color = (color.truncate() / 255.0).extend(1.0);
        }
    }
    let outside = model.colors.iter().filter(|c| c.min_element() < 0.0 || c.max_element() > 1.0).count();
    if outside > 0 {
        warnings.push(format!("{outside} vertex colours are not within their range"));
    }
    for color in &mut model.colors {
        *color = linear_from_srgb(color.truncate().clamp(Vec3::ZERO, Vec3::ONE)).extend(color.w);
    }
    let world_from_mesh = DAffine3::from_translation(origin);
    let objects = vec![Object { name: String::new(), mesh: 0, world_from_mesh }];
    Ok(Parsed { meshes: vec![model], objects, warnings, smoothing: vec![face_group] })
}

struct Geometry {
    meshes: Vec<tobj::Model>,
    polylines: Polylines,
    /// What is to be added to all positions.
    origin: DVec3,
}

/// Reads the vertices and faces, relative to an offset where they are far from the origin. The text is released, since
/// tobj allocates its own arrays.
fn geometry(
    prepared: &mut Prepared,
    path: &Path,
    read: &dyn Fn(&[u8]) -> tobj::LoadResult,
    warnings: &mut Vec<String>,
) -> Result<Geometry, LoadError> {
    /// The first offset is only as good as f32 at that distance, so there is a second one for tiny models.
    const MOST_OFFSETS: usize = 2;
    let malformed = |fault: String| LoadError::Malformed { path: path.to_owned(), fault };
    let original = std::mem::take(&mut prepared.text);
    let mut moved: Option<Vec<u8>> = None;
    let mut origin = DVec3::ZERO;
    for round in 0.. {
        let text = moved.as_ref().unwrap_or(&original);
        let (meshes, _) = read(text).map_err(|fault| malformed(faults::explain(text, fault)))?;
        let of_faces = || meshes.iter().flat_map(|mesh| mesh.mesh.positions.as_chunks::<3>().0);
        let is_finite = |vertex: &&[f32; 3]| vertex.iter().all(|x| x.is_finite());
        if let Some(vertex) = of_faces().find(|vertex| !is_finite(vertex)) {
            return Err(malformed(faults::not_finite(text, vertex)));
        }
        let polylines = Polylines::read(text, &prepared.lines);
        if let Some(vertex) = polylines.positions().find(|vertex| !is_finite(vertex)) {
            return Err(malformed(faults::not_finite(text, vertex)));
        }
        let positions = of_faces().chain(polylines.positions()).map(|p| Vec3::from_array(*p).as_dvec3());
        let offset = distant::bounds(positions).and_then(|(low, high)| distant::offset(low, high));
        let Some(offset) = offset.filter(|_| round < MOST_OFFSETS) else {
            return Ok(Geometry { meshes, polylines, origin });
        };
        origin += offset;
        let (text, written) = far::moved(&original, origin);
        moved = Some(text);
        if round == 0 {
            warnings.extend(written.lost_digits());
        }
    }
    unreachable!("the last round returns")
}

/// A single warning for all undefined materials.
fn without_definition(names: &[&str]) -> Option<String> {
    const MOST: usize = 3;
    if let [name] = names {
        return Some(format!("no material file defines \"{}\": the default material stands for it", shortened(name)));
    }
    let mut listed: Vec<_> = names.iter().take(MOST).map(|name| format!("\"{}\"", shortened(name))).collect();
    let last = match names.len() {
        0 => return None,
        count if count > MOST => format!("{} more", count - MOST),
        _ => listed.pop()?,
    };
    let (count, listed) = (names.len(), listed.join(", "));
    Some(format!(
        "no material file defines {listed} and {last} ({count} materials): the default material stands for them"
    ))
}

/// Renumbers meshes from 0 in the order of their first faces, without gaps. Empty if there is a single mesh.
fn renumber(face_mesh: &mut Vec<u32>) {
    let mut count = 0;
    let mut last = None;
    for mesh in face_mesh.iter_mut() {
        // An object that is continued later in the file counts as another object.
        if last.is_some_and(|last| last != *mesh) {
            count += 1;
        }
        last = Some(*mesh);
        *mesh = count;
    }
    if count == 0 {
        face_mesh.clear();
    }
}

//! Writes models as glTF 2.0 in one file, with the classes of their edges.
//!
//! The edges are written as [`EXT_mesh_primitive_edge_visibility`](https://github.com/KhronosGroup/glTF/pull/2479), by which
//! another program, or this crate, draws the same lines without searching for them.
//!
//! A model becomes one mesh, with a primitive for each of its materials and one of [`Model::lines`]. Faces keep their order
//! within a material. Positions, normals, texture coordinates and colours are written as floats, exactly; textures as PNG;
//! transforms as matrices, which other programs may refuse where they shear. Polygons are lost; the diagonals of flat ones
//! are written as hidden.

mod buffer;
mod classes;
mod error;
mod materials;

pub use classes::side_classes;
pub use error::ExportError;

use crate::{Model, Object, SideVisibility};
use buffer::{Buffer, Component};
use glam::DAffine3;
use materials::{Materials, STRENGTH};
use serde_json::{Map, Value, json};

/// The extension that the classes of edges are written in.
const EXTENSION: &str = "EXT_mesh_primitive_edge_visibility";

/// What is written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExportOptions {
    /// The angle in radians from which on an edge is hard, if the classes of edges are written. What the model states
    /// itself ([`Model::side_visibility`]) is written as it is.
    pub edges: Option<f32>,
}

/// The bytes of a `.glb` file of meshes and the objects that place them.
///
/// # Errors
/// [`ExportError`].
///
/// # Panics
/// If a face or line refers to a vertex or material that does not exist, or if an array does not have the length that
/// [`Model`] states.
pub fn glb(meshes: &[Model], objects: &[Object], options: &ExportOptions) -> Result<Vec<u8>, ExportError> {
    let mut buffer = Buffer::default();
    let mut materials = Materials::default();
    let mut written = Vec::with_capacity(meshes.len());
    for (number, model) in meshes.iter().enumerate() {
        check_finite(number, model)?;
        let of_mesh = materials.add(model, &mut buffer)?;
        written.push(json!({"primitives": primitives(model, &of_mesh, options, &mut buffer)}));
    }
    let nodes = objects.iter().enumerate().map(|object| node(object, meshes.len()));
    let nodes = nodes.collect::<Result<Vec<_>, _>>()?;
    let mut root = json!({
        "asset": {"version": "2.0", "generator": concat!("npr-mesh ", env!("CARGO_PKG_VERSION"))},
        "scene": 0,
        "scenes": [{"nodes": (0..nodes.len()).collect::<Vec<_>>()}],
        "nodes": nodes,
        "meshes": written,
    });
    let Value::Object(members) = &mut root else { unreachable!("made as an object") };
    let used = [(options.edges.is_some(), EXTENSION), (materials.have_strength(), STRENGTH)];
    let used: Vec<&str> = used.into_iter().filter(|(is_used, _)| *is_used).map(|(_, name)| name).collect();
    if !used.is_empty() {
        members.insert("extensionsUsed".to_owned(), json!(used));
    }
    materials.finish(members);
    let binary = buffer.finish(members);
    container(root.to_string().into_bytes(), binary)
}

fn check_finite(mesh: usize, model: &Model) -> Result<(), ExportError> {
    let all = [
        (model.positions.iter().all(|p| p.is_finite()), "a position"),
        (model.normals.iter().all(|n| n.is_finite()), "a normal"),
        (model.uvs.iter().all(|uv| uv.is_finite()), "a texture coordinate"),
        (model.colors.iter().all(|c| c.is_finite()), "a colour"),
    ];
    match all.iter().find(|(is_finite, _)| !is_finite) {
        Some(&(_, what)) => Err(ExportError::NotFinite { mesh, what }),
        None => Ok(()),
    }
}

fn node((number, object): (usize, &Object), meshes: usize) -> Result<Value, ExportError> {
    let Object { name, mesh, world_from_mesh } = object;
    if *mesh >= meshes {
        return Err(ExportError::Mesh { object: number, mesh: *mesh, meshes });
    }
    if !world_from_mesh.is_finite() {
        return Err(ExportError::NotFinite { mesh: *mesh, what: "the transform of an object" });
    }
    let mut node = json!({"mesh": mesh});
    if !name.is_empty() {
        node["name"] = json!(name);
    }
    if *world_from_mesh != DAffine3::IDENTITY {
        node["matrix"] = json!(glam::DMat4::from(*world_from_mesh).to_cols_array());
    }
    Ok(node)
}

/// The primitives of a model: one for each material that faces have, in the order of the materials, then one of lines.
///
/// `materials`: of the model's materials the numbers in the file.
fn primitives(model: &Model, materials: &[usize], options: &ExportOptions, buffer: &mut Buffer) -> Vec<Value> {
    let edges = options.edges.map(|crease_angle_rad| side_classes(model, crease_angle_rad));
    let mut primitives = Vec::new();
    for (material, faces) in by_material(model) {
        let corners = faces.iter().flat_map(|&face| model.faces[face as usize]);
        let mut primitive = geometry(model, corners.collect(), buffer);
        if let Some(material) = material {
            primitive["material"] = json!(materials[material as usize]);
        }
        if let Some((sides, normals)) = &edges {
            let of_faces = faces.iter().map(|&face| sides[face as usize]);
            let mut object = json!({"visibility": buffer.bytes(&packed(of_faces))});
            let normals: Vec<[f32; 3]> =
                faces.iter().flat_map(|face| normals.get(face).into_iter().flatten()).flatten().copied().collect();
            if !normals.is_empty() {
                object["silhouetteNormals"] = json!(buffer.floats(normals.as_flattened(), "VEC3"));
            }
            primitive["extensions"] = json!({EXTENSION: object});
        }
        primitives.push(primitive);
    }
    if !model.lines.is_empty() {
        let bare = Model { positions: model.positions.clone(), ..Model::default() };
        let mut primitive = geometry(&bare, model.lines.as_flattened().to_vec(), buffer);
        primitive["mode"] = json!(1);
        primitives.push(primitive);
    }
    primitives
}

/// The faces of each material, in the order of the materials and, within each, of the faces.
fn by_material(model: &Model) -> Vec<(Option<u32>, Vec<u32>)> {
    let all = 0..model.faces.len() as u32;
    if model.face_material.is_empty() {
        return if model.faces.is_empty() { Vec::new() } else { vec![(None, all.collect())] };
    }
    let mut groups = vec![Vec::new(); model.materials.len()];
    all.for_each(|face| groups[model.face_material[face as usize] as usize].push(face));
    (0u32..).zip(groups).filter(|(_, faces)| !faces.is_empty()).map(|(m, faces)| (Some(m), faces)).collect()
}

/// A primitive with these corners and the vertices that they use, in the order of the model's.
fn geometry(model: &Model, mut corners: Vec<u32>, buffer: &mut Buffer) -> Value {
    let mut number = vec![u32::MAX; model.positions.len()];
    corners.iter().for_each(|&corner| number[corner as usize] = 0);
    let mut used = Vec::new();
    for (vertex, number) in (0u32..).zip(&mut number) {
        if *number == 0 {
            *number = used.len() as u32;
            used.push(vertex as usize);
        }
    }
    corners.iter_mut().for_each(|corner| *corner = number[*corner as usize]);
    let mut attributes = Map::new();
    let positions: Vec<[f32; 3]> = used.iter().map(|&v| model.positions[v].to_array()).collect();
    attributes.insert("POSITION".to_owned(), json!(buffer.positions(&positions)));
    if !model.normals.is_empty() {
        let normals: Vec<[f32; 3]> = used.iter().map(|&v| model.normals[v].to_array()).collect();
        attributes.insert("NORMAL".to_owned(), json!(buffer.floats(normals.as_flattened(), "VEC3")));
    }
    if !model.uvs.is_empty() {
        let uvs: Vec<[f32; 2]> = used.iter().map(|&v| model.uvs[v].to_array()).collect();
        attributes.insert("TEXCOORD_0".to_owned(), json!(buffer.floats(uvs.as_flattened(), "VEC2")));
    }
    if !model.colors.is_empty() {
        let colors: Vec<[f32; 4]> = used.iter().map(|&v| model.colors[v].to_array()).collect();
        attributes.insert("COLOR_0".to_owned(), json!(buffer.floats(colors.as_flattened(), "VEC4")));
    }
    // The largest number of a type may not be an index.
    let indices = if used.len() < usize::from(u16::MAX) {
        buffer.integers(&corners.iter().map(|&corner| corner as u16).collect::<Vec<_>>(), Component::U16)
    } else {
        buffer.integers(&corners, Component::U32)
    };
    json!({"attributes": attributes, "indices": indices})
}

/// Two bits for each side, the first in the lowest.
fn packed(faces: impl Iterator<Item = [SideVisibility; 3]>) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (number, side) in faces.flatten().enumerate() {
        if number.is_multiple_of(4) {
            bytes.push(0);
        }
        let bits = match side {
            SideVisibility::Unstated | SideVisibility::Hidden => 0,
            SideVisibility::Silhouette => 1,
            SideVisibility::Hard => 2,
            SideVisibility::RepeatedHard => 3,
        };
        bytes[number / 4] |= bits << (2 * (number % 4));
    }
    bytes
}

/// The chunks of a `.glb` file (glTF 2.0, 4.4 "Binary glTF Layout").
fn container(mut json: Vec<u8>, mut binary: Vec<u8>) -> Result<Vec<u8>, ExportError> {
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let bytes = 28 + json.len() as u64 + binary.len() as u64;
    let total = u32::try_from(bytes).map_err(|_| ExportError::TooLarge { bytes })?;
    let mut file = Vec::with_capacity(total as usize);
    let word = |number: usize| (number as u32).to_le_bytes();
    file.extend([&b"glTF"[..], &2u32.to_le_bytes(), &total.to_le_bytes()].concat());
    file.extend([&word(json.len())[..], b"JSON"].concat());
    file.append(&mut json);
    file.extend([&word(binary.len())[..], b"BIN\0"].concat());
    file.append(&mut binary);
    Ok(file)
}

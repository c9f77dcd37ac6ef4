//! `EXT_mesh_primitive_edge_visibility`: which edges of a primitive of triangles the author wants drawn.
//!
//! P. Connelly, Bentley Systems, [KhronosGroup/glTF#2479](https://github.com/KhronosGroup/glTF/pull/2479). The object
//! at a primitive has
//!
//! - `visibility`: an accessor of `SCALAR` unsigned bytes, a bit field of two bits for each side of each triangle (v0 v1,
//!   v1 v2, v2 v0), the lowest bits first: 0 hidden, 1 silhouette, 2 hard, 3 hard and stated as 2 at another triangle;
//! - `silhouetteNormals`: for each 1 in `visibility` the outward normals of the two faces, `VEC3` of floats or normalised
//!   signed bytes. They are checked and not used: silhouettes are found from the faces themselves;
//! - `lineStrings`: hard edges as polylines instead, each with `indices` of any unsigned type, in which the largest number
//!   of the type separates one polyline from the next. They become [`crate::Model::lines`];
//! - `material`, here and at a line string: what the edges are drawn with. It is ignored with a warning, since a style
//!   states the colour of lines.

use super::accessor::{Accessor, Integers, Purpose};
use super::document::Document;
use super::extensions::EDGE_VISIBILITY;
use crate::SideVisibility;
use gltf::json::mesh::Primitive;
use gltf::json::{self, Index};
use serde_json::{Map, Value};

/// The sides by their two bits.
const CLASSES: [SideVisibility; 4] =
    [SideVisibility::Hidden, SideVisibility::Silhouette, SideVisibility::Hard, SideVisibility::RepeatedHard];

/// What the extension says of a primitive.
#[derive(Default)]
pub(super) struct PrimitiveEdges {
    /// Per triangle, or empty without `visibility`.
    pub sides: Vec<[SideVisibility; 3]>,
    /// Pairs of the primitive's vertices, from line strings.
    pub lines: Vec<[u32; 2]>,
    pub warnings: Vec<String>,
}

/// The number of indices of all line strings of a primitive, which bounds that of their segments.
pub(super) fn string_ends(document: &Document, primitive: &Primitive) -> u64 {
    let strings = of_primitive(primitive).and_then(|value| value.get("lineStrings")?.as_array());
    let count = |string: &Value| {
        let index = u32::try_from(string.get("indices")?.as_u64()?).ok()?;
        Some(document.root.get(Index::<json::Accessor>::new(index))?.count.0)
    };
    strings.into_iter().flatten().filter_map(count).fold(0, u64::saturating_add)
}

fn of_primitive(primitive: &Primitive) -> Option<&Value> {
    primitive.extensions.as_ref()?.others.get(EDGE_VISIBILITY)
}

/// Reads the extension of a primitive with so many triangles and vertices; `None` without it.
///
/// # Errors
/// An accessor or index that does not fit, or an object without edges.
pub(super) fn read(
    document: &Document,
    primitive: &Primitive,
    triangles: u64,
    vertices: usize,
) -> Result<Option<PrimitiveEdges>, String> {
    let Some(value) = of_primitive(primitive) else { return Ok(None) };
    let fail = |fault: String| format!("{EDGE_VISIBILITY}: {fault}");
    let Value::Object(object) = value else { return Err(fail("not an object".to_owned())) };
    let mut edges = PrimitiveEdges::default();
    if let Some(index) = index_of(object, "visibility").map_err(fail)? {
        edges.sides = sides(document, index, triangles).map_err(|fault| fail(format!("visibility: {fault}")))?;
        if let Some(index) = index_of(object, "silhouetteNormals").map_err(fail)? {
            let fault = |fault: String| fail(format!("silhouetteNormals: {fault}"));
            check_normals(document, index, &mut edges).map_err(fault)?;
        }
    } else if !object.contains_key("lineStrings") {
        return Err(fail("neither visibility nor lineStrings".to_owned()));
    }
    let has_material = |object: &Map<String, Value>| object.contains_key("material");
    let mut materials = has_material(object);
    match object.get("lineStrings") {
        None => {}
        Some(Value::Array(strings)) => {
            for (number, string) in strings.iter().enumerate() {
                let fault = |fault: String| fail(format!("lineStrings {number}: {fault}"));
                let Value::Object(string) = string else { return Err(fault("not an object".to_owned())) };
                let index = index_of(string, "indices").map_err(fault)?;
                let index = index.ok_or_else(|| fault("no indices".to_owned()))?;
                line_string(document, index, vertices, &mut edges.lines).map_err(fault)?;
                materials |= has_material(string);
            }
        }
        Some(_) => return Err(fail("lineStrings is not an array".to_owned())),
    }
    if materials {
        edges.warnings.push(format!("the materials of {EDGE_VISIBILITY} are ignored: lines have a style's ink"));
    }
    Ok(Some(edges))
}

/// The index of an accessor.
fn index_of(object: &Map<String, Value>, key: &str) -> Result<Option<Index<json::Accessor>>, String> {
    let Some(value) = object.get(key) else { return Ok(None) };
    let number = value.as_u64().and_then(|number| u32::try_from(number).ok());
    number.map(|number| Some(Index::new(number))).ok_or_else(|| format!("{key} is not the number of an accessor"))
}

fn sides(
    document: &Document,
    index: Index<json::Accessor>,
    triangles: u64,
) -> Result<Vec<[SideVisibility; 3]>, String> {
    let accessor = Accessor::new(document, index, Purpose::Bits)?;
    // Six bits for each triangle.
    let expected = triangles.saturating_mul(6).div_ceil(8);
    if accessor.count != expected {
        return Err(accessor.fault(&format!("{} bytes for {triangles} triangles, expected {expected}", accessor.count)));
    }
    let bytes = accessor.integers::<1>()?.into_flattened();
    let class = |side: usize| CLASSES[(bytes[side / 4] >> (2 * (side % 4))) as usize & 3];
    Ok((0..triangles as usize).map(|triangle| [0, 1, 2].map(|side| class(3 * triangle + side))).collect())
}

/// Checks that there are two normals for each silhouette.
fn check_normals(document: &Document, index: Index<json::Accessor>, edges: &mut PrimitiveEdges) -> Result<(), String> {
    let silhouettes = edges.sides.iter().flatten().filter(|side| **side == SideVisibility::Silhouette).count() as u64;
    let accessor = Accessor::new(document, index, Purpose::Direction)?;
    if accessor.count != 2 * silhouettes {
        let counts = format!("silhouetteNormals: {} normals for {silhouettes} silhouettes", accessor.count);
        edges.warnings.push(format!("{EDGE_VISIBILITY}: {counts}; the faces' own are used"));
        return Ok(());
    }
    accessor.floats::<3>(Integers::Normalized).map(drop)
}

fn line_string(
    document: &Document,
    index: Index<json::Accessor>,
    vertices: usize,
    lines: &mut Vec<[u32; 2]>,
) -> Result<(), String> {
    let accessor = Accessor::new(document, index, Purpose::Indices)?;
    if !accessor.stored {
        return Err(accessor.fault("no buffer view"));
    }
    let restart = accessor.largest_integer();
    let ends = accessor.integers::<1>()?.into_flattened();
    for (at, &end) in ends.iter().enumerate() {
        if end != restart && end as usize >= vertices {
            return Err(accessor.fault(&format!("element {at}: vertex {end} of {vertices}")));
        }
    }
    for string in ends.split(|&end| end == restart) {
        if string.len() < 2 {
            return Err(accessor.fault("a line string of less than two vertices"));
        }
        lines.extend(string.windows(2).map(|pair| [pair[0], pair[1]]));
    }
    Ok(())
}

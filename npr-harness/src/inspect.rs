//! Statistics of a model.

use glam::{DVec3, Vec3};
use npr_mesh::weld::Weld;
use npr_mesh::{
    Loaded, Model, SideVisibility, Warning,
    edges::{self, EdgeKind, EdgeOptions, Edges},
};
use std::{collections::HashMap, fmt, ops::Range};

/// The angle over which [`Inspection::creases_over_30_deg`] counts an edge.
const CREASE_DEG: f64 = 30.0;

/// Statistics of a model. Corners at equal positions count as one; edges are those of the file's polygons.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Inspection {
    /// The name of the model, usually that of the file without folder and extension.
    pub model: String,
    /// Meshes; a model in memory is one.
    pub meshes: usize,
    /// Objects, which place meshes.
    pub objects: usize,
    /// Triangles; a polygon of n corners makes n − 2.
    pub faces: usize,
    /// Faces whose corners are collinear or coincide.
    pub zero_area_faces: usize,
    /// Faces with the same three corners as an earlier one, in any order; for larger polygons, all faces of a polygon
    /// with the same corners as an earlier one. Triangles with two coinciding corners do not count.
    pub duplicate_faces: usize,
    /// Unique edges.
    pub edges: usize,
    /// Edges with one face.
    pub boundary_edges: usize,
    /// Edges with two faces.
    pub two_face_edges: usize,
    /// Edges with more than two faces.
    pub nonmanifold_edges: usize,
    /// Two-face edges at which the surface turns by more than 30°, without those of faces of zero area.
    pub creases_over_30_deg: usize,
    /// Two-face edges at which the surface turns by 30° to within 0.01°.
    #[serde(rename = "within_0.01_deg_of_30")]
    pub within_0_01_deg_of_30: usize,
    /// Line segments that the file draws, besides edges; not in the output where there are none.
    #[serde(skip_serializing_if = "is_zero")]
    pub lines: usize,
    /// Sides of faces of which the file says whether they are lines; not in the output where there are none.
    #[serde(skip_serializing_if = "is_zero")]
    pub stated_sides: usize,
    /// Shading vertices, including unused ones.
    pub vertices: usize,
    /// Distinct positions of the vertices.
    pub positions: usize,
    /// The file's polygons.
    pub polygons: usize,
    /// The number of materials.
    pub materials: usize,
    /// The number of images.
    pub textures: usize,
    /// Whether every edge has exactly two faces (and there is an edge).
    pub closed: bool,
    /// Two-face edges whose faces have opposite winding.
    pub wound_oppositely: usize,
    /// The size of the bounding box of all faces and lines, per axis; zeros without either. In f64, since the size may exceed f32 and
    /// positions may be far from 0; with as many decimal digits as the f32 numbers of the model have.
    pub extent: [f64; 3],
    /// The box's lower corner.
    pub min: [f64; 3],
    /// The box's upper corner.
    pub max: [f64; 3],
    /// The repairs and omissions of the loader; in JSON, objects of `text` and `count`.
    #[serde(serialize_with = "texts_and_counts")]
    pub warnings: Vec<Warning>,
}

/// Computes the statistics of a model.
///
/// The time is that of one edge search and one sort of the faces; the memory is that of the search plus at most 28
/// bytes per face.
///
/// # Panics
/// If a face refers to a vertex that does not exist, or a per-face array does not have the length stated in [`Model`].
pub fn inspect(name: &str, model: &Model, warnings: Vec<Warning>) -> Inspection {
    inspect_at(name, model, DVec3::ZERO, warnings, Weld::Exact)
}

/// Computes the statistics of a file: as [`inspect`] of all its objects in one model, where corners that a rule of welding
/// joins count as one.
pub fn inspect_loaded(name: &str, loaded: Loaded, weld: Weld) -> Inspection {
    let (meshes, objects, warnings) = (loaded.meshes.len(), loaded.objects.len(), loaded.warnings.clone());
    let (model, origin) = loaded.into_model_near();
    Inspection { meshes, objects, ..inspect_at(name, &model, origin, warnings, weld) }
}

/// [`inspect`] of a model whose positions are relative to an origin.
fn inspect_at(name: &str, model: &Model, origin: DVec3, warnings: Vec<Warning>, weld: Weld) -> Inspection {
    let options = EdgeOptions { weld, ..EdgeOptions::of_file() };
    let found = edges::find(&model.positions, &model.faces, &model.face_polygon, &model.face_material, &options);
    let of_kind = |kind| found.edges.iter().filter(|edge| edge.kind() == kind).count();
    let (boundary_edges, nonmanifold_edges) = (of_kind(EdgeKind::Boundary), of_kind(EdgeKind::NonManifold));
    let (creases_over_30_deg, within_0_01_deg_of_30) = creases(model, &found);
    let (min, max) = model.bounds().unwrap_or_default();
    Inspection {
        model: name.to_owned(),
        meshes: 1,
        objects: 1,
        faces: model.faces.len(),
        zero_area_faces: model.faces.iter().filter(|face| edges::has_zero_area(&model.positions, face)).count(),
        duplicate_faces: duplicate_faces(model, &found.representative),
        edges: found.edges.len(),
        boundary_edges,
        two_face_edges: of_kind(EdgeKind::TwoFace),
        nonmanifold_edges,
        creases_over_30_deg,
        within_0_01_deg_of_30,
        lines: model.lines.len(),
        stated_sides: model.side_visibility.iter().flatten().filter(|side| **side != SideVisibility::Unstated).count(),
        vertices: model.positions.len(),
        positions: (0u32..).zip(&found.representative).filter(|(vertex, first)| vertex == *first).count(),
        polygons: match model.face_polygon.is_empty() {
            true => model.faces.len(),
            false => model.face_polygon.chunk_by(|a, b| a == b).count(),
        },
        materials: model.materials.len(),
        textures: model.textures.len(),
        closed: boundary_edges == 0 && nonmanifold_edges == 0 && !found.edges.is_empty(),
        wound_oppositely: found
            .edges
            .iter()
            .filter(|edge| edge.kind() == EdgeKind::TwoFace && edge.wound_oppositely())
            .count(),
        extent: std::array::from_fn(|axis| match max[axis] - min[axis] {
            extent if extent.is_finite() => decimal(extent),
            // Beyond f32.
            _ => 2.0 * decimal(max[axis] / 2.0 - min[axis] / 2.0),
        }),
        min: placed(origin, min, max.abs().max(min.abs())),
        max: placed(origin, max, max.abs().max(min.abs())),
        warnings,
    }
}

/// The shortest decimal number that is a given f32.
fn decimal(number: f32) -> f64 {
    number.to_string().parse().unwrap_or(f64::NAN)
}

/// A position relative to an origin, with as many digits as f32 has where the model is largest.
fn placed(origin: DVec3, position: Vec3, largest: Vec3) -> [f64; 3] {
    let rounding = f64::from(largest.max_element()) * f64::from(f32::EPSILON);
    std::array::from_fn(|axis| {
        let (origin, here) = (origin[axis], position[axis]);
        if origin == 0.0 {
            return decimal(here);
        }
        let sum = origin + f64::from(here);
        let mut rounded = (0..17).filter_map(|digits| format!("{sum:.digits$}").parse::<f64>().ok());
        rounded.find(|rounded| (rounded - sum).abs() <= rounding).unwrap_or(sum)
    })
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_zero(count: &usize) -> bool {
    *count == 0
}

fn texts_and_counts<S: serde::Serializer>(warnings: &[Warning], to: S) -> Result<S::Ok, S::Error> {
    #[derive(serde::Serialize)]
    struct Counted<'a> {
        text: &'a str,
        count: u64,
    }
    to.collect_seq(warnings.iter().map(|Warning { text, count }| Counted { text, count: *count }))
}

/// Polygons are compared as a whole: the triangulations of two polygons that share three corners can have a triangle in
/// common without being duplicates.
fn duplicate_faces(model: &Model, representative: &[u32]) -> usize {
    let corner = |&v: &u32| representative[v as usize];
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    // The concatenated corners of all larger polygons, and per polygon its range in them and its face count.
    let mut corners: Vec<u32> = Vec::new();
    let mut larger: Vec<(Range<usize>, usize)> = Vec::new();
    let mut rest = model.faces.as_slice();
    let mut add = |faces: &[[u32; 3]]| {
        if let [face] = faces {
            let mut triangle = face.map(|v| corner(&v));
            triangle.sort_unstable();
            let [a, b, c] = triangle;
            if a != b && b != c {
                triangles.push(triangle);
            }
        } else {
            let mut polygon: Vec<u32> = faces.iter().flatten().map(corner).collect();
            polygon.sort_unstable();
            polygon.dedup();
            if polygon.len() > 2 {
                larger.push((corners.len()..corners.len() + polygon.len(), faces.len()));
                corners.extend(polygon);
            }
        }
    };
    if model.face_polygon.is_empty() {
        rest.iter().for_each(|face| add(std::slice::from_ref(face)));
    } else {
        for polygon in model.face_polygon.chunk_by(|a, b| a == b) {
            let (faces, others) = rest.split_at(polygon.len());
            add(faces);
            rest = others;
        }
    }
    triangles.sort_unstable();
    let of = |polygon: &(Range<usize>, usize)| &corners[polygon.0.clone()];
    larger.sort_unstable_by(|a, b| of(a).cmp(of(b)).then(a.0.start.cmp(&b.0.start)));
    let doubled = larger.windows(2).filter(|pair| of(&pair[0]) == of(&pair[1])).map(|pair| pair[1].1);
    triangles.windows(2).filter(|pair| pair[0] == pair[1]).count() + doubled.sum::<usize>()
}

/// Edges over 30°, and edges at 30° to within 0.01°.
fn creases(model: &Model, found: &Edges) -> (usize, usize) {
    let cos_of_crease = CREASE_DEG.to_radians().cos();
    let mut areas = HashMap::new();
    let (mut over, mut near) = (0, 0);
    for edge in &found.edges {
        let Some(cos) = found.cos_dihedral(edge).map(f64::from) else { continue };
        // The f32 cosine has errors of 1e-7, and 0.01° at 30° is 9e-5: only edges near that need a better one.
        if cos < cos_of_crease - 1e-3 {
            over += 1;
        } else if cos < cos_of_crease + 1e-3 {
            let [first, second] = edge.faces().map(|face| area_vector(model, face, &mut areas));
            let second = if edge.wound_oppositely() { -second } else { second };
            let angle_deg = first.cross(second).length().atan2(first.dot(second)).to_degrees();
            over += usize::from(angle_deg > CREASE_DEG);
            near += usize::from((angle_deg - CREASE_DEG).abs() <= 0.01);
        }
    }
    (over, near)
}

/// The area vector of the face's polygon, along its Newell normal, scaled so that its square is within f64.
///
/// `areas` caches the vectors by the polygon's first face, because a polygon can have many edges.
fn area_vector(model: &Model, face: u32, areas: &mut HashMap<usize, DVec3>) -> DVec3 {
    let face = face as usize;
    let faces = if model.face_polygon.is_empty() {
        face..face + 1
    } else {
        let polygon = model.face_polygon[face];
        let start = model.face_polygon.partition_point(|&p| p < polygon);
        start..start + model.face_polygon[start..].partition_point(|&p| p == polygon)
    };
    *areas.entry(faces.start).or_insert_with(|| {
        let area: DVec3 = model.faces[faces]
            .iter()
            .map(|face| {
                let [a, b, c] = face.map(|v| model.positions[v as usize].as_dvec3());
                (b - a).cross(c - a)
            })
            .sum();
        area / area.abs().max_element()
    })
}

impl fmt::Display for Inspection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let corner = |[x, y, z]: [f64; 3]| format!("{x} {y} {z}");
        let mut rows = vec![
            ("model", self.model.clone()),
            ("meshes", self.meshes.to_string()),
            ("objects", self.objects.to_string()),
            ("faces", self.faces.to_string()),
            ("polygons", self.polygons.to_string()),
            ("vertices", self.vertices.to_string()),
            ("different positions", self.positions.to_string()),
            ("edges", self.edges.to_string()),
            ("  of one face", self.boundary_edges.to_string()),
            ("  of two faces", self.two_face_edges.to_string()),
            ("  of more", self.nonmanifold_edges.to_string()),
            ("  over 30°", self.creases_over_30_deg.to_string()),
            ("  30° to within 0.01°", self.within_0_01_deg_of_30.to_string()),
            ("  wound oppositely", self.wound_oppositely.to_string()),
            ("closed", if self.closed { "yes" } else { "no" }.to_owned()),
            ("faces of zero area", self.zero_area_faces.to_string()),
            ("duplicate faces", self.duplicate_faces.to_string()),
            ("materials", self.materials.to_string()),
            ("textures", self.textures.to_string()),
            ("extent", corner(self.extent)),
            ("from", corner(self.min)),
            ("to", corner(self.max)),
        ];
        let of_file = [("lines of the file", self.lines), ("sides that the file classes", self.stated_sides)];
        rows.extend(of_file.iter().filter(|(_, count)| *count > 0).map(|(label, count)| (*label, count.to_string())));
        rows.extend(self.warnings.iter().map(|warning| ("warning", warning.to_string())));
        let width = rows.iter().map(|(label, _)| label.chars().count()).max().unwrap_or(0);
        for (number, (label, value)) in rows.iter().enumerate() {
            let end = if number == 0 { "" } else { "\n" };
            write!(f, "{end}{label:width$}  {value}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;

//! PLY, ASCII and binary (G. Turk, "The PLY Polygon File Format", 1994).
//!
//! ply-rs-bw is not used: it refuses numbers such as `.5` and `nan`, comments that are not UTF-8 and lists that go on
//! on the next line, and keeps an object with its own list for each face.

mod header;
mod values;

use super::color::linear_from_srgb;
use super::external::{External, shortened};
use super::far::{self, Written};
use super::file::Parsed;
use super::polygons::Positions;
use crate::edges::MOST_FACES;
use crate::triangulate::{EAR_TESTS_OF_A_FILE, triangulate_within};
use crate::{AlphaMode, Limits, LoadError, Material, Model, Object};
use glam::{DAffine3, DVec3, Vec2, Vec3, Vec4};
use header::{Element, Kind, Scalar};
use std::path::Path;
use values::Values;

/// Loads a PLY file: its faces, triangle strips and edges in one mesh.
///
/// - `vertex`: `x y z`; `nx ny nz`; `red green blue` and `alpha`, of which integers are 0 to their largest value and
///   floats 0 to 1, sRGB-encoded as in OBJ files; `s t`, `u v` or `texture_u texture_v`, with the origin at the lower
///   left.
/// - `face`: lists `vertex_indices` or `vertex_index`. `tristrips`: the same, with -1 between strips.
/// - `edge`: `vertex1 vertex2` are [`Model::lines`].
/// - Other elements and properties are skipped, with a warning for colours and texture coordinates of faces and for
///   textures.
/// - Where the model is far from the origin, its positions are relative to an offset that is subtracted in f64, and the
///   object is translated by it.
///
/// # Errors
/// [`LoadError`] if the file is invalid, cut off, refers to missing or non-finite vertices, or exceeds a limit. A file
/// without faces and edges is not an error here.
pub(super) fn load(bytes: &[u8], external: &External) -> Result<Parsed, LoadError> {
    let (path, limits) = (external.model, external.limits);
    let malformed = |fault: String| LoadError::Malformed { path: path.to_owned(), fault };
    let (header, body) = header::read(bytes).map_err(&malformed)?;
    let mut reader = Reader {
        path,
        limits,
        values: Values::new(body, header.encoding),
        vertices: Vertices::default(),
        polygons: Polygons::default(),
        segments: Vec::new(),
    };
    for element in &header.elements {
        reader.check(element)?;
        match element.name.as_str() {
            "vertex" => reader.vertices(element)?,
            "face" => reader.faces(element)?,
            "tristrips" => reader.strips(element)?,
            "edge" => reader.edges(element)?,
            _ => reader.skip(element)?,
        }
    }
    let Reader { vertices, polygons, segments, .. } = reader;
    let mut warnings = header.warnings();
    if polygons.short > 0 {
        warnings.push(format!("{} faces with fewer than 3 corners are left out", polygons.short));
    }
    if polygons.arities.is_empty() && segments.is_empty() {
        if !vertices.positions.is_empty() {
            let points = format!("it is a point cloud: {} vertices, and no face uses them", vertices.positions.len());
            warnings.insert(0, points);
        }
        return Ok(Parsed { warnings, ..Parsed::default() });
    }
    let (model, origin) = build(path, vertices, &polygons, segments, &mut warnings)?;
    let world_from_mesh = DAffine3::from_translation(origin);
    let objects = vec![Object { name: String::new(), mesh: 0, world_from_mesh }];
    Ok(Parsed { meshes: vec![model], objects, warnings, smoothing: Vec::new() })
}

/// Properties of vertices that are used, in the order of their slots.
const SLOTS: usize = 12;
const NAMES: [&[&str]; SLOTS] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx", "normal_x"],
    &["ny", "normal_y"],
    &["nz", "normal_z"],
    &["red", "r", "diffuse_red"],
    &["green", "g", "diffuse_green"],
    &["blue", "b", "diffuse_blue"],
    &["alpha", "a", "diffuse_alpha"],
    &["s", "u", "texture_u"],
    &["t", "v", "texture_v"],
];

#[derive(Default)]
struct Vertices {
    positions: Vec<DVec3>,
    /// Per vertex, or empty.
    normals: Vec<Vec3>,
    /// Per vertex, or empty: as in the file, floats 0..=1.
    colors: Vec<Vec4>,
    /// Per vertex, or empty: upwards.
    uvs: Vec<Vec2>,
    written: Written,
    /// Whether the numbers of the positions were f32 in the file.
    are_f32: bool,
}

#[derive(Default)]
struct Polygons {
    corners: Vec<u32>,
    /// Per polygon the number of its corners.
    arities: Vec<u32>,
    triangles: u64,
    /// The number of those left out.
    short: u64,
}

struct Reader<'a> {
    path: &'a Path,
    limits: &'a Limits,
    values: Values<'a>,
    vertices: Vertices,
    polygons: Polygons,
    segments: Vec<[u32; 2]>,
}

impl Reader<'_> {
    fn malformed(&self, fault: impl Into<String>) -> LoadError {
        LoadError::Malformed { path: self.path.to_owned(), fault: fault.into() }
    }

    fn within(&self, what: &'static str, count: u64, limit: u64) -> Result<(), LoadError> {
        if count <= limit {
            return Ok(());
        }
        Err(LoadError::TooLarge { path: self.path.to_owned(), what, count, limit })
    }

    /// Checks the number of elements before anything is allocated for them.
    fn check(&self, element: &Element) -> Result<(), LoadError> {
        let (limits, count) = (self.limits, element.count);
        match element.name.as_str() {
            "vertex" => self.within("vertices", count, limits.vertices.min(u32::MAX.into()))?,
            "face" => self.within("faces", count, limits.faces.min(MOST_FACES as u64))?,
            "edge" => self.within("line segments", count, limits.faces)?,
            _ => {}
        }
        let (least, left) = (self.values.least_bytes(element), self.values.left() as u64);
        if count.saturating_mul(least) > left {
            let name = shortened(&element.name);
            return Err(self.malformed(format!("cut off: {count} \"{name}\" by its header, {left} bytes for them")));
        }
        Ok(())
    }

    fn scalar(&mut self, of: (&Element, u64), scalar: Scalar) -> Result<f64, LoadError> {
        self.values.next(scalar).map_err(|fault| self.fault(of, fault))
    }

    fn fault(&self, (element, number): (&Element, u64), fault: &str) -> LoadError {
        self.malformed(format!("\"{}\" {number}: {fault}", shortened(&element.name)))
    }

    /// Reads a list, and calls `visit` with its numbers.
    fn list(
        &mut self,
        of: (&Element, u64),
        (count, item): (Scalar, Scalar),
        mut visit: impl FnMut(&mut Self, f64) -> Result<(), LoadError>,
    ) -> Result<(), LoadError> {
        let count = self.scalar(of, count)?;
        if count < 0.0 || count.fract() != 0.0 || count > self.values.left() as f64 {
            return Err(self.fault(of, "a list whose length is not that of a list"));
        }
        for _ in 0..count as u64 {
            let number = self.scalar(of, item)?;
            visit(self, number)?;
        }
        Ok(())
    }

    fn skip(&mut self, element: &Element) -> Result<(), LoadError> {
        // Elements without properties have no bytes.
        let count = if element.properties.is_empty() { 0 } else { element.count };
        for number in 0..count {
            for property in &element.properties {
                self.skip_property((element, number), property.kind)?;
            }
        }
        Ok(())
    }

    fn skip_property(&mut self, of: (&Element, u64), kind: Kind) -> Result<(), LoadError> {
        match kind {
            Kind::Scalar(scalar) => self.scalar(of, scalar).map(|_| ()),
            Kind::List(count, item) => self.list(of, (count, item), |_, _| Ok(())),
        }
    }

    fn vertices(&mut self, element: &Element) -> Result<(), LoadError> {
        let slot_of = |name: &str| NAMES.iter().position(|names| names.contains(&name));
        let slots: Vec<Option<usize>> = element.properties.iter().map(|p| slot_of(&p.name)).collect();
        let has = |slot: usize| slots.contains(&Some(slot));
        if !(has(0) && has(1) && has(2)) {
            return Err(self.malformed("vertices without x, y and z"));
        }
        let scalar_of = |slot: usize| {
            element.properties.iter().zip(&slots).find_map(|(property, of)| match property.kind {
                Kind::Scalar(scalar) if *of == Some(slot) => Some(scalar),
                _ => None,
            })
        };
        // Integers are parts of their largest value.
        let whole: [f64; SLOTS] = std::array::from_fn(|slot| match slot {
            6..10 => scalar_of(slot).map_or(1.0, Scalar::whole),
            _ => 1.0,
        });
        let is_f32 = |slot: usize| matches!(scalar_of(slot), Some(Scalar::F32));
        self.vertices.are_f32 = self.values.is_binary() && (0..3).all(is_f32);
        let [has_normal, has_color, has_uv] =
            [has(3) && has(4) && has(5), has(6) && has(7) && has(8), has(10) && has(11)];
        let count = element.count as usize;
        self.vertices.positions.reserve(count);
        for number in 0..element.count {
            let mut slot_values = [0.0; SLOTS];
            slot_values[9] = whole[9];
            for (property, slot) in element.properties.iter().zip(&slots) {
                match (property.kind, *slot) {
                    (Kind::Scalar(scalar), Some(slot)) => slot_values[slot] = self.scalar((element, number), scalar)?,
                    (kind, _) => self.skip_property((element, number), kind)?,
                }
            }
            let [x, y, z, nx, ny, nz, red, green, blue, alpha, u, v] = slot_values;
            let position = DVec3::new(x, y, z);
            let vertices = &mut self.vertices;
            vertices.positions.push(position);
            if !vertices.are_f32 {
                vertices.written.add(position);
            }
            if has_normal {
                vertices.normals.push(DVec3::new(nx, ny, nz).as_vec3());
            }
            if has_color {
                let color = [red / whole[6], green / whole[7], blue / whole[8], alpha / whole[9]];
                vertices.colors.push(Vec4::from_array(color.map(|channel| channel as f32)));
            }
            if has_uv {
                vertices.uvs.push(Vec2::new(u as f32, v as f32));
            }
        }
        Ok(())
    }

    fn index(&self, of: (&Element, u64), number: f64) -> Result<u32, LoadError> {
        let is_index = number >= 0.0 && number.fract() == 0.0 && number <= f64::from(u32::MAX);
        if is_index { Ok(number as u32) } else { Err(self.fault(of, &format!("{number} is no vertex"))) }
    }

    fn faces(&mut self, element: &Element) -> Result<(), LoadError> {
        for number in 0..if element.properties.is_empty() { 0 } else { element.count } {
            for property in &element.properties {
                let of = (element, number);
                match property.kind {
                    Kind::List(count, item) if matches!(property.name.as_str(), "vertex_indices" | "vertex_index") => {
                        let first = self.polygons.corners.len();
                        self.list(of, (count, item), |reader, index| {
                            let index = reader.index(of, index)?;
                            reader.polygons.corners.push(index);
                            let corners = (reader.polygons.corners.len() - first) as u64;
                            reader.within("corners of a polygon", corners, reader.limits.polygon_corners)
                        })?;
                        self.polygon(first)?;
                    }
                    kind => self.skip_property(of, kind)?,
                }
            }
        }
        Ok(())
    }

    /// Adds the polygon of the corners from `first`.
    fn polygon(&mut self, first: usize) -> Result<(), LoadError> {
        let arity = self.polygons.corners.len() - first;
        if arity < 3 {
            self.polygons.corners.truncate(first);
            self.polygons.short += 1;
            return Ok(());
        }
        self.polygons.arities.push(arity as u32);
        self.polygons.triangles += arity as u64 - 2;
        self.within("faces", self.polygons.triangles, self.limits.faces.min(MOST_FACES as u64))
    }

    fn strips(&mut self, element: &Element) -> Result<(), LoadError> {
        for number in 0..if element.properties.is_empty() { 0 } else { element.count } {
            for property in &element.properties {
                let of = (element, number);
                match property.kind {
                    Kind::List(count, item) if matches!(property.name.as_str(), "vertex_indices" | "vertex_index") => {
                        // The two corners before, and how many there were in this strip.
                        let (mut before, mut length) = ([0; 2], 0u64);
                        self.list(of, (count, item), |reader, index| {
                            if index == -1.0 {
                                length = 0;
                                return Ok(());
                            }
                            let index = reader.index(of, index)?;
                            let first = reader.polygons.corners.len();
                            if length >= 2 {
                                let [a, b] = if length.is_multiple_of(2) { before } else { [before[1], before[0]] };
                                // Repeated corners join strips, and are no faces.
                                if a != b && b != index && index != a {
                                    reader.polygons.corners.extend([a, b, index]);
                                    reader.polygon(first)?;
                                }
                            }
                            (before, length) = ([before[1], index], length + 1);
                            Ok(())
                        })?;
                    }
                    kind => self.skip_property(of, kind)?,
                }
            }
        }
        Ok(())
    }

    fn edges(&mut self, element: &Element) -> Result<(), LoadError> {
        let has = |name: &str| element.properties.iter().any(|property| property.name == name);
        if !(has("vertex1") && has("vertex2")) {
            return self.skip(element);
        }
        for number in 0..element.count {
            let mut ends = [0; 2];
            for property in &element.properties {
                let of = (element, number);
                match (property.kind, property.name.as_str()) {
                    (Kind::Scalar(scalar), name @ ("vertex1" | "vertex2")) => {
                        let index = self.scalar(of, scalar)?;
                        ends[usize::from(name == "vertex2")] = self.index(of, index)?;
                    }
                    (kind, _) => self.skip_property(of, kind)?,
                }
            }
            if ends[0] != ends[1] {
                self.segments.push(ends);
            }
        }
        Ok(())
    }
}

/// The model, relative to an origin.
fn build(
    path: &Path,
    vertices: Vertices,
    polygons: &Polygons,
    segments: Vec<[u32; 2]>,
    warnings: &mut Vec<String>,
) -> Result<(Model, DVec3), LoadError> {
    let Vertices { positions, normals, mut colors, uvs, written, are_f32 } = vertices;
    let mut used = vec![false; positions.len()];
    for (what, &index) in
        (polygons.corners.iter().map(|i| ("face", i))).chain(segments.iter().flatten().map(|i| ("edge", i)))
    {
        let count = positions.len();
        let Some(used) = used.get_mut(index as usize) else {
            let fault = format!("a {what} uses vertex {index}, and there are {count} (they count from 0)");
            return Err(LoadError::Malformed { path: path.to_owned(), fault });
        };
        *used = true;
    }
    warnings.extend(if are_f32 {
        let of_used = positions.iter().zip(&used).filter(|(_, used)| **used).map(|(position, _)| *position);
        far::bounds(of_used).and_then(|(low, high)| far::lost_digits(low, high))
    } else {
        written.lost_digits()
    });
    let Positions { positions, origin } = Positions::new(positions, &used, path)?;
    let mut model = Model { positions, normals, lines: segments, ..Model::default() };
    model.normals.resize(model.positions.len(), Vec3::ZERO);
    model.normals.iter_mut().filter(|normal| !normal.is_finite()).for_each(|normal| *normal = Vec3::ZERO);
    model.uvs = uvs.iter().map(|uv| if uv.is_finite() { Vec2::new(uv.x, 1.0 - uv.y) } else { Vec2::ZERO }).collect();
    model.faces.reserve(polygons.triangles as usize);
    let has_polygons = polygons.arities.iter().any(|&arity| arity > 3);
    let (mut rest, mut outline, mut triangles) = (&polygons.corners[..], Vec::new(), Vec::new());
    let mut ear_tests = EAR_TESTS_OF_A_FILE;
    for (polygon, &arity) in (0u32..).zip(&polygons.arities) {
        let (corners, others) = rest.split_at(arity as usize);
        rest = others;
        if let &[a, b, c] = corners {
            model.faces.push([a, b, c]);
        } else {
            outline.clear();
            outline.extend(corners.iter().map(|&vertex| model.positions[vertex as usize]));
            triangulate_within(&outline, &mut triangles, &mut ear_tests);
            model.faces.extend(triangles.iter().map(|triangle| triangle.map(|corner| corners[corner as usize])));
        }
        if has_polygons {
            model.face_polygon.resize(model.faces.len(), polygon);
        }
    }
    let mut material = Material::default();
    if !colors.is_empty() {
        material.base_color = Vec4::ONE;
        decode_colors(&mut colors, warnings);
        if colors.iter().any(|color| color.w < 1.0) {
            material.alpha_mode = AlphaMode::Blend;
        }
        model.colors = colors;
    }
    model.face_material = vec![0; model.faces.len()];
    model.materials.push(material);
    Ok((model, origin))
}

/// Makes colours linear.
fn decode_colors(colors: &mut [Vec4], warnings: &mut Vec<String>) {
    // Floats in 0..=255 occur.
    if colors.iter().any(|color| color.is_finite() && color.max_element() > 1.0) {
        warnings.push("vertex colours above 1 are taken as 0..=255".to_owned());
        for color in colors.iter_mut() {
            let alpha = if color.w > 1.0 { color.w / 255.0 } else { color.w };
            *color = (color.truncate() / 255.0).extend(alpha);
        }
    }
    let is_within = |color: &Vec4| color.is_finite() && color.min_element() >= 0.0 && color.max_element() <= 1.0;
    let outside = colors.iter().filter(|color| !is_within(color)).count();
    if outside > 0 {
        warnings.push(format!("{outside} vertex colours are not within their range"));
    }
    for color in colors {
        let known = if color.is_finite() { color.clamp(Vec4::ZERO, Vec4::ONE) } else { Vec4::ONE };
        *color = linear_from_srgb(known.truncate()).extend(known.w);
    }
}

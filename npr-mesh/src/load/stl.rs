//! STL, ASCII and binary.
//!
//! stl_io is not used: it ends at the first `endsolid` and loses all further solids of a file without a word, takes
//! binary files that begin with "solid" as text, and refuses capitals.

use super::external::{External, shortened};
use super::far;
use super::file::Parsed;
use super::polygons::Positions;
use crate::edges::MOST_FACES;
use crate::{Limits, LoadError, Material, Model, Object};
use glam::{DAffine3, DVec3};
use std::collections::HashMap;
use std::path::Path;

/// Bytes before the first triangle of a binary file, and bytes of a triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Loads an STL file: all solids in one mesh.
///
/// The normals of facets are ignored, since they often disagree with the order of the corners, and so are names and
/// attributes. Corners at equal positions are one vertex.
///
/// # Errors
/// [`LoadError`] if the file is neither kind, is cut off, has positions that are not finite, or exceeds a limit.
pub(super) fn load(bytes: &[u8], external: &External) -> Result<Parsed, LoadError> {
    let (path, limits) = (external.model, external.limits);
    let malformed = |fault: String| LoadError::Malformed { path: path.to_owned(), fault };
    let mut warnings = Vec::new();
    let mut solids = Solids { path, limits, vertices: HashMap::new(), positions: Vec::new(), faces: Vec::new() };
    let is_binary = is_binary(bytes).map_err(&malformed)?;
    let written = if is_binary {
        solids.read_binary(bytes, &mut warnings)?;
        None
    } else {
        Some(solids.read_text(bytes)?)
    };
    let Solids { positions, faces, .. } = solids;
    if faces.is_empty() {
        return Ok(Parsed { warnings, ..Parsed::default() });
    }
    let bounds = far::bounds(positions.iter().copied());
    warnings.extend(match written {
        Some(written) => written.lost_digits(),
        None => bounds.and_then(|(low, high)| far::lost_digits(low, high)),
    });
    let used = vec![true; positions.len()];
    let Positions { positions, origin } = Positions::new(positions, &used, path)?;
    let model = Model {
        face_material: vec![0; faces.len()],
        materials: vec![Material::default()],
        positions,
        faces,
        ..Model::default()
    };
    let world_from_mesh = DAffine3::from_translation(origin);
    let objects = vec![Object { name: String::new(), mesh: 0, world_from_mesh }];
    Ok(Parsed { meshes: vec![model], objects, warnings, smoothing: Vec::new() })
}

/// Whether the length is that of a binary file, which may begin with "solid", too; otherwise it must begin so.
fn is_binary(bytes: &[u8]) -> Result<bool, String> {
    let count = bytes.get(80..).and_then(|rest| rest.first_chunk()).map(|count| u32::from_le_bytes(*count));
    let wanted = |count: u32| HEADER as u64 + TRIANGLE as u64 * u64::from(count);
    if count.is_some_and(|count| wanted(count) == bytes.len() as u64) {
        return Ok(true);
    }
    if words(bytes).next().is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
        && words(bytes).any(|word| word.eq_ignore_ascii_case(b"facet") || word.eq_ignore_ascii_case(b"endsolid"))
    {
        return Ok(false);
    }
    match count {
        None => Err(format!("neither text nor binary STL: {} bytes", bytes.len())),
        // Some exporters add bytes at the end.
        Some(count) if wanted(count) < bytes.len() as u64 => Ok(true),
        Some(count) => {
            Err(format!("cut off: {count} triangles by its header, {} in the file", (bytes.len() - HEADER) / TRIANGLE))
        }
    }
}

struct Solids<'a> {
    path: &'a Path,
    limits: &'a Limits,
    vertices: HashMap<[u64; 3], u32>,
    positions: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
}

impl Solids<'_> {
    fn malformed(&self, fault: String) -> LoadError {
        LoadError::Malformed { path: self.path.to_owned(), fault }
    }

    fn add(&mut self, corners: [DVec3; 3]) -> Result<(), LoadError> {
        let face = corners.map(|corner| {
            let fresh = self.positions.len() as u32;
            // Adding 0 makes −0 and 0 equal.
            *self.vertices.entry((corner + 0.0).to_array().map(f64::to_bits)).or_insert_with(|| {
                self.positions.push(corner);
                fresh
            })
        });
        self.faces.push(face);
        let too_large = |what, count: usize, limit: u64| match count as u64 > limit {
            true => Err(LoadError::TooLarge { path: self.path.to_owned(), what, count: count as u64, limit }),
            false => Ok(()),
        };
        too_large("vertices", self.positions.len(), self.limits.vertices)?;
        too_large("faces", self.faces.len(), self.limits.faces.min(MOST_FACES as u64))
    }

    fn read_binary(&mut self, bytes: &[u8], warnings: &mut Vec<String>) -> Result<(), LoadError> {
        let count = bytes[80..].first_chunk().map_or(0, |count| u32::from_le_bytes(*count)) as usize;
        let (triangles, rest) = bytes[HEADER..].split_at(count * TRIANGLE);
        if !rest.is_empty() {
            warnings.push(format!("{} bytes behind the last triangle are passed over", rest.len()));
        }
        let limit = self.limits.faces.min(MOST_FACES as u64);
        if count as u64 > limit {
            return Err(LoadError::TooLarge { path: self.path.to_owned(), what: "faces", count: count as u64, limit });
        }
        self.faces.reserve(count);
        for (number, triangle) in triangles.chunks_exact(TRIANGLE).enumerate() {
            let float = |at: usize| f32::from_le_bytes([0, 1, 2, 3].map(|byte| triangle[at + byte]));
            let corners =
                [12, 24, 36].map(|at| DVec3::new(float(at).into(), float(at + 4).into(), float(at + 8).into()));
            if !corners.iter().all(|corner| corner.is_finite()) {
                return Err(self.malformed(format!("triangle {number} has a position that is not finite")));
            }
            self.add(corners)?;
        }
        Ok(())
    }

    /// Reads text. Line breaks have no meaning, and only the words `facet` and `vertex` have one: each `facet` has three
    /// vertices.
    fn read_text(&mut self, bytes: &[u8]) -> Result<far::Written, LoadError> {
        let mut written = far::Written::default();
        let mut corners = Vec::with_capacity(3);
        let mut in_facet = false;
        let mut facets = 0u64;
        let line_end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
        for (line, text) in (1u64..).zip(bytes.split(|byte| *byte == line_end)) {
            let bad = |fault: &str| format!("line {line}: {fault}");
            let mut words = words(text);
            let mut next = words.next();
            while let Some(word) = next {
                let is = |name: &str| word.eq_ignore_ascii_case(name.as_bytes());
                if is("solid") || (is("endsolid") && !in_facet) {
                    // A name follows, which may be anything.
                    break;
                }
                if is("facet") {
                    if in_facet {
                        return Err(self.malformed(bad("a facet within a facet")));
                    }
                    (in_facet, facets) = (true, facets + 1);
                } else if is("vertex") {
                    let mut number = || std::str::from_utf8(words.next()?).ok()?.parse::<f64>().ok();
                    let (Some(x), Some(y), Some(z)) = (number(), number(), number()) else {
                        return Err(self.malformed(bad("a vertex that is not three numbers")));
                    };
                    let corner = DVec3::new(x, y, z);
                    if !corner.as_vec3().is_finite() {
                        return Err(self.malformed(bad("a vertex that is not finite")));
                    }
                    if !in_facet {
                        return Err(self.malformed(bad("a vertex that is not in a facet")));
                    }
                    written.add(corner);
                    corners.push(corner);
                } else if is("endfacet") || is("endsolid") {
                    match corners[..] {
                        [a, b, c] if in_facet && is("endfacet") => self.add([a, b, c])?,
                        _ => return Err(self.malformed(bad("a facet that does not have three vertices"))),
                    }
                    corners.clear();
                    in_facet = false;
                } else if !["normal", "outer", "loop", "endloop"].iter().any(|name| is(name)) {
                    let is_number = std::str::from_utf8(word).is_ok_and(|word| word.parse::<f64>().is_ok());
                    if !is_number {
                        let word = shortened(&String::from_utf8_lossy(word));
                        return Err(self.malformed(bad(&format!("\"{word}\" is no word of an STL file"))));
                    }
                }
                next = words.next();
            }
        }
        if in_facet {
            return Err(self.malformed("cut off within a facet".to_owned()));
        }
        Ok(written)
    }
}

fn words(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    bytes.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

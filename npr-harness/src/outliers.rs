//! Stray parts far from the rest of a scene, which would make the rest a dot in a picture that frames everything.
//!
//! A part is a connected component of a mesh, as an object places it: faces that share vertices. Parts are *outliers* if
//! together they have at most a tenth of the faces and a tenth of the area, if they are farther from the rest than the
//! rest's own diameter, and if without them the diagonal of the bounding box is at most a quarter. A large plane or sky
//! around a small model has most of the area, and an antenna is not far from its car: neither is an outlier.

use crate::scene::{Mesh, Scene};
use glam::{DVec3, Vec3};
use npr_mesh::UpAxis;

/// The largest fraction of all faces, and of the whole area, that outliers have.
const LARGEST_SHARE: f64 = 0.1;

/// The least factor by which the diagonal of the bounding box is smaller without the outliers.
const LEAST_SHRINKING: f64 = 4.0;

/// The least distance of outliers from the centre of the rest, in radii of the rest: a diameter beyond its surface.
const LEAST_RADII: f64 = 3.0;

/// The number of faces from which it is guessed whether there may be outliers.
const SAMPLED_FACES: usize = 4096;

/// A part of a scene far from the rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Outlier {
    /// The index of its object.
    pub object: u32,
    /// The number of its faces.
    pub faces: usize,
    /// The centre of its bounding box, scene space.
    pub at: DVec3,
}

/// The outliers of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Outliers {
    /// From the nearest to the farthest; at least one.
    pub parts: Vec<Outlier>,
    /// The bounding box of everything else in scene space, for [`Scene::set_subject`]. No outlier is near it.
    pub rest: (Vec3, Vec3),
    /// The diagonal of the rest's bounding box over that of the whole scene, at most a quarter.
    pub rest_share: f64,
}

/// A connected component of an object, in scene space.
struct Part {
    object: u32,
    faces: usize,
    area: f64,
    low: DVec3,
    high: DVec3,
}

impl Part {
    fn middle(&self) -> DVec3 {
        self.low.midpoint(self.high)
    }

    /// The distances of the nearest and of the farthest point of its box.
    fn distances(&self, from: DVec3) -> (f64, f64) {
        let nearest = from.clamp(self.low, self.high).distance(from);
        let farthest = (from - self.low).abs().max((from - self.high).abs()).length();
        (nearest, farthest)
    }
}

/// Finds the outliers of a scene, if there are any. Where a sample of the faces spreads over the bounding box, which is
/// usual, no component is looked for.
pub fn find(scene: &Scene) -> Option<Outliers> {
    let (low, high) = scene.bounds()?;
    let diagonal = f64::from((high - low).length());
    if diagonal == 0.0 || spreads(scene, diagonal / LEAST_SHRINKING) {
        return None;
    }
    let mut parts = parts(scene);
    let center = center(&parts);
    parts.sort_by(|a, b| a.distances(center).1.total_cmp(&b.distances(center).1));
    // Of the parts from each one on: the distance of the nearest, faces and area.
    let mut beyond = vec![(f64::INFINITY, 0.0, 0.0); parts.len() + 1];
    for (number, part) in parts.iter().enumerate().rev() {
        let (nearest, faces, area) = beyond[number + 1];
        beyond[number] = (part.distances(center).0.min(nearest), faces + part.faces as f64, area + part.area);
    }
    let (_, all_faces, all_area) = beyond[0];
    let boxes = |parts: &[Part]| {
        let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        parts.iter().fold(empty, |(low, high), part| (low.min(part.low), high.max(part.high)))
    };
    let (low, high) = boxes(&parts);
    let diagonal = low.distance(high);
    let mut rest = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for number in 1..parts.len() {
        let last = &parts[number - 1];
        rest = (rest.0.min(last.low), rest.1.max(last.high));
        let (nearest, faces, area) = beyond[number];
        let (radius, size) = (last.distances(center).1, rest.0.distance(rest.1));
        let are_few = faces <= LARGEST_SHARE * all_faces && area <= LARGEST_SHARE * all_area;
        if are_few && size > 0.0 && nearest > LEAST_RADII * radius && diagonal >= LEAST_SHRINKING * size {
            let outlier = |part: &Part| Outlier { object: part.object, faces: part.faces, at: part.middle() };
            let rest = (rest.0.as_vec3(), rest.1.as_vec3());
            let parts = parts[number..].iter().map(outlier).collect();
            return Some(Outliers { parts, rest, rest_share: size / diagonal });
        }
    }
    None
}

/// Whether the middle three fifths of the faces spread over more than a length along an axis.
fn spreads(scene: &Scene, length: f64) -> bool {
    let stride = scene.face_count().div_ceil(SAMPLED_FACES).max(1);
    let mut sampled: Vec<DVec3> = Vec::with_capacity(SAMPLED_FACES);
    let mut next = 0;
    for (object, mesh) in scene.placed_objects() {
        let model = mesh.model();
        while let Some(face) = model.faces.get(next) {
            sampled.push(object.point(model.positions[face[0] as usize]));
            next += stride;
        }
        next -= model.faces.len();
    }
    (0..3).any(|axis| {
        let mut along: Vec<f64> = sampled.iter().map(|point| point[axis]).collect();
        along.sort_unstable_by(f64::total_cmp);
        let at = |fifths: usize| along.get(along.len() * fifths / 5).copied().unwrap_or_default();
        at(4) - at(1) > length
    })
}

/// The components of all objects.
fn parts(scene: &Scene) -> Vec<Part> {
    let of_meshes: Vec<Vec<Part>> = scene.meshes().iter().map(|mesh| components(mesh)).collect();
    let mut parts = Vec::new();
    for (number, object) in (0u32..).zip(scene.objects()) {
        for part in &of_meshes[object.mesh()] {
            let (low, high) = object.box_around((part.low.as_vec3(), part.high.as_vec3()));
            // Exact where the transform keeps angles.
            let area = part.area * object.scale() * object.scale();
            parts.push(Part { object: number, faces: part.faces, area, low, high });
        }
    }
    parts
}

/// The components of a mesh, in mesh space.
fn components(mesh: &Mesh) -> Vec<Part> {
    let (model, vertex) = (mesh.model(), &mesh.edges().representative);
    let mut parents: Vec<u32> = (0..model.positions.len() as u32).collect();
    let find = |parents: &mut Vec<u32>, mut vertex: u32| {
        while parents[vertex as usize] != vertex {
            let above = parents[parents[vertex as usize] as usize];
            parents[vertex as usize] = above;
            vertex = above;
        }
        vertex
    };
    for face in &model.faces {
        let [a, b, c] = face.map(|v| find(&mut parents, vertex[v as usize]));
        let least = a.min(b).min(c);
        for root in [a, b, c] {
            parents[root as usize] = least;
        }
    }
    let mut numbers = vec![u32::MAX; model.positions.len()];
    let mut parts: Vec<Part> = Vec::new();
    for face in &model.faces {
        let root = find(&mut parents, vertex[face[0] as usize]) as usize;
        if numbers[root] == u32::MAX {
            numbers[root] = parts.len() as u32;
            let (low, high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            parts.push(Part { object: 0, faces: 0, area: 0.0, low, high });
        }
        let part = &mut parts[numbers[root] as usize];
        let [a, b, c] = face.map(|v| model.positions[v as usize].as_dvec3());
        part.faces += 1;
        part.area += (b - a).cross(c - a).length() / 2.0;
        (part.low, part.high) = (part.low.min(a).min(b).min(c), part.high.max(a).max(b).max(c));
    }
    parts
}

/// The median of the parts along each axis, weighted by their faces and area.
fn center(parts: &[Part]) -> DVec3 {
    let faces: f64 = parts.iter().map(|part| part.faces as f64).sum();
    let area: f64 = parts.iter().map(|part| part.area).sum();
    let weight = |part: &Part| part.faces as f64 / faces + if area > 0.0 { part.area / area } else { 0.0 };
    let half = parts.iter().map(weight).sum::<f64>() / 2.0;
    let median = |axis: usize| {
        let mut along: Vec<(f64, f64)> = parts.iter().map(|part| (part.middle()[axis], weight(part))).collect();
        along.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut before = 0.0;
        for (at, weight) in along {
            before += weight;
            if before >= half {
                return at;
            }
        }
        0.0
    };
    DVec3::new(median(0), median(1), median(2))
}

impl Outliers {
    /// A sentence without a full stop: how many faces there are and where, and how much of the extent they take. Positions
    /// are those of the file, of which `up` points up.
    pub fn describe(&self, scene: &Scene, up: UpAxis) -> String {
        let faces: usize = self.parts.iter().map(|part| part.faces).sum();
        let count = |number: usize, what: &str| format!("{number} {what}{}", if number == 1 { "" } else { "s" });
        let farthest = self.parts.last().map_or_else(String::new, |part| {
            let at = up.turned_back(scene.place_in_file(part.at));
            let name = &scene.objects()[part.object as usize].name;
            let name = if name.is_empty() { String::new() } else { format!("{name:?} ") };
            format!("{name}at {}, {}, {}", short(at.x), short(at.y), short(at.z))
        });
        let (parts, farthest) = match self.parts.len() {
            1 => (String::new(), farthest),
            parts => (format!(" in {parts} parts"), format!("the farthest {farthest}")),
        };
        let all = scene.face_count();
        let take = if faces == 1 { "takes" } else { "take" };
        let percent = 100.0 * (1.0 - self.rest_share);
        format!(
            "{} of {all}{parts}, {farthest}, far from the rest, {take} {percent:.1} % of the extent",
            count(faces, "face")
        )
    }
}

/// A coordinate with four significant digits, or all digits before the point.
fn short(value: f64) -> String {
    let digits = if value == 0.0 { 0 } else { (3 - value.abs().log10().floor() as i32).clamp(0, 12) };
    let text = format!("{value:.*}", digits as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

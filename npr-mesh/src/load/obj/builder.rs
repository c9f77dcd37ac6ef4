//! Merges tobj's meshes into one [`Model`].

use super::prepare::{Runs, runs_within};
use super::texture_map::Placement;
use crate::normals::UNSTATED;
use crate::triangulate::triangulate_within;
use crate::{Limits, LoadError, Model};
use glam::{Vec2, Vec3, Vec4};
use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;

const NONE: u32 = u32::MAX;

/// Merges tobj's meshes.
pub(super) struct Builder<'a> {
    pub model: Model,
    pub path: &'a Path,
    pub limits: &'a Limits,
    /// The number of corners of the meshes added so far.
    pub corners_before: u64,
    pub absent: &'a [Runs; 2],
    /// The corners at which an object or group begins.
    pub objects: &'a [u64],
    /// The corners at which a smoothing group begins, and the group.
    pub smoothing: &'a [(u64, u32)],
    /// Per face its smoothing group; empty without groups.
    pub face_group: Vec<u32>,
    /// The remaining budget of ear tests for polygons that intersect themselves.
    pub ear_tests: usize,
    /// The number of texture coordinates and colours that were replaced.
    pub repaired: u64,
}

impl Builder<'_> {
    pub fn malformed(&self, fault: String) -> LoadError {
        LoadError::Malformed { path: self.path.to_owned(), fault }
    }

    /// Adds a mesh as returned by tobj without `single_index`: finite positions, and one index into each array per
    /// corner. Meshes share no vertices, so texture coordinates may be placed for the material.
    pub fn add(&mut self, mesh: &tobj::Mesh, material: u32, placement: &Placement) -> Result<(), LoadError> {
        let base = self.model.positions.len();
        let positions = mesh.positions.as_chunks::<3>().0;
        let corners = mesh.indices.len();
        if mesh.indices.iter().any(|&i| i as usize >= positions.len()) {
            return Err(self.malformed("a face uses a vertex that is not there".to_owned()));
        }

        let uvs = mesh.texcoords.as_chunks::<2>().0;
        let normals = mesh.normals.as_chunks::<3>().0;
        let range = self.corners_before..self.corners_before + corners as u64;
        let Some(uv_of) = attribute_indices(&mesh.texcoord_indices, uvs.len(), corners, &self.absent[0], range.clone())
        else {
            return Err(self.malformed("a face uses a texture coordinate that is not there".to_owned()));
        };
        let Some(normal_of) =
            attribute_indices(&mesh.normal_indices, normals.len(), corners, &self.absent[1], range.clone())
        else {
            return Err(self.malformed("a face uses a normal that is not there".to_owned()));
        };
        self.corners_before = range.end;

        // The position, texture coordinate and normal of each vertex, and the vertex of each corner.
        let split = (!uv_of.is_empty() || !normal_of.is_empty())
            .then(|| split_vertices(&mesh.indices, &uv_of, &normal_of, positions.len()));
        let (sources, vertex_of) = match &split {
            None => (None, &mesh.indices),
            Some((sources, vertex_of)) => (Some(sources), vertex_of),
        };
        let vertices = sources.map_or(positions.len(), Vec::len);
        let total = (base + vertices) as u64;
        if total > self.limits.vertices.min(u64::from(u32::MAX)) {
            return Err(LoadError::TooLarge {
                path: self.path.to_owned(),
                what: "vertices",
                count: total,
                limit: self.limits.vertices,
            });
        }

        let model = &mut self.model;
        match sources {
            None => {
                model.positions.extend(positions.iter().map(|p| Vec3::from_array(*p)));
                model.normals.resize(total as usize, Vec3::ZERO);
            }
            Some(sources) => {
                model.positions.extend(sources.iter().map(|s| Vec3::from_array(positions[s[0] as usize])));
                model.normals.extend(sources.iter().map(|s| {
                    let normal = normals.get(s[2] as usize).map_or(Vec3::ZERO, |n| Vec3::from_array(*n));
                    if normal.is_finite() { normal } else { Vec3::ZERO }
                }));
            }
        }
        if !uv_of.is_empty() || !model.uvs.is_empty() {
            model.uvs.resize(base, Vec2::ZERO);
            for source in sources.into_iter().flatten() {
                let [u, v] = uvs.get(source[1] as usize).map_or([0.0, 1.0], |uv| placement.place(*uv));
                let finite = u.is_finite() && v.is_finite();
                self.repaired += u64::from(!finite);
                model.uvs.push(if finite { Vec2::new(u, 1.0 - v) } else { Vec2::ZERO });
            }
            model.uvs.resize(total as usize, Vec2::ZERO);
        }
        let colors = mesh.vertex_color.as_chunks::<3>().0;
        if !colors.is_empty() || !model.colors.is_empty() {
            model.colors.resize(base, Vec4::ONE);
            for vertex in 0..vertices {
                let position = sources.map_or(vertex, |s| s[vertex][0] as usize);
                let color = colors.get(position).map_or(Vec3::ONE, |c| Vec3::from_array(*c));
                self.repaired += u64::from(!color.is_finite());
                model.colors.push(if color.is_finite() { color } else { Vec3::ONE }.extend(1.0));
            }
        }
        self.add_faces(mesh, base as u32, vertex_of, material, range.start)
    }

    fn add_faces(
        &mut self,
        mesh: &tobj::Mesh,
        base: u32,
        vertex_of: &[u32],
        material: u32,
        first_corner: u64,
    ) -> Result<(), LoadError> {
        let objects = self.objects;
        // With a single object, the array stays empty.
        let object_of = |corner: usize| objects.partition_point(|&begin| begin <= first_corner + corner as u64) as u32;
        let groups = self.smoothing;
        let group_of = |corner: usize| match groups.partition_point(|&(begin, _)| begin <= first_corner + corner as u64)
        {
            0 => UNSTATED,
            after => groups[after - 1].1,
        };
        let model = &mut self.model;
        let first_face = model.faces.len();
        if mesh.face_arities.is_empty() {
            let (triangles, rest) = vertex_of.as_chunks::<3>();
            if !rest.is_empty() {
                return Err(self.malformed("a face with fewer than 3 corners".to_owned()));
            }
            model.faces.extend(triangles.iter().map(|t| t.map(|v| base + v)));
            if !objects.is_empty() {
                model.face_mesh.extend((0..triangles.len()).map(|triangle| object_of(3 * triangle)));
            }
            if !groups.is_empty() {
                self.face_group.extend((0..triangles.len()).map(|triangle| group_of(3 * triangle)));
            }
            if !model.face_polygon.is_empty() {
                extend_polygons(&mut model.face_polygon, triangles.len());
            }
        } else {
            if model.face_polygon.is_empty() && mesh.face_arities.iter().any(|&n| n > 3) {
                extend_polygons(&mut model.face_polygon, first_face);
            }
            let counts_polygons = !model.face_polygon.is_empty() || mesh.face_arities.iter().any(|&n| n > 3);
            let mut polygon = model.face_polygon.last().map_or(0, |last| last + 1);
            let mut at = 0;
            let mut outline = Vec::new();
            let mut triangles = Vec::new();
            for &arity in &mesh.face_arities {
                let Some(corners) = vertex_of.get(at..at + arity as usize) else {
                    return Err(self.malformed("a face with corners that are not there".to_owned()));
                };
                let (object, group) = (object_of(at), group_of(at));
                at += arity as usize;
                if arity == 3 {
                    model.faces.push([base + corners[0], base + corners[1], base + corners[2]]);
                } else {
                    outline.clear();
                    outline.extend(corners.iter().map(|&v| model.positions[(base + v) as usize]));
                    triangulate_within(&outline, &mut triangles, &mut self.ear_tests);
                    model.faces.extend(triangles.iter().map(|t| t.map(|i| base + corners[i as usize])));
                }
                if !objects.is_empty() {
                    model.face_mesh.resize(model.faces.len(), object);
                }
                if !groups.is_empty() {
                    self.face_group.resize(model.faces.len(), group);
                }
                if counts_polygons {
                    model.face_polygon.resize(model.faces.len(), polygon);
                    polygon += 1;
                }
            }
        }
        model.face_material.resize(model.faces.len(), material);
        Ok(())
    }
}

/// Adds one polygon for each of `count` triangles.
fn extend_polygons(face_polygon: &mut Vec<u32>, count: usize) {
    let first = face_polygon.last().map_or(0, |last| last + 1);
    face_polygon.extend((0..count as u32).map(|i| first + i));
}

/// Per corner the index into an array, [`NONE`] for the corners in `absent`, or an empty slice if no corner has one.
/// `None` if an index is out of range.
fn attribute_indices<'a>(
    indices: &'a [u32],
    count: usize,
    corners: usize,
    absent: &Runs,
    range: Range<u64>,
) -> Option<Cow<'a, [u32]>> {
    if indices.is_empty() {
        return Some(Cow::Borrowed(&[]));
    }
    if indices.len() != corners || indices.iter().any(|&i| i as usize >= count) {
        return None;
    }
    let mut absent = runs_within(absent, &range).peekable();
    match absent.peek() {
        None => return Some(Cow::Borrowed(indices)),
        Some(run) if *run == range => return Some(Cow::Borrowed(&[])),
        Some(_) => {}
    }
    // tobj repeats a preceding index for these corners.
    let mut indices = indices.to_vec();
    for run in absent {
        indices[(run.start - range.start) as usize..(run.end - range.start) as usize].fill(NONE);
    }
    Some(Cow::Owned(indices))
}

/// The number of vertices per position above which a hash table is used.
const WALKED_PER_POSITION: u32 = 16;

/// One vertex for each combination of position, texture coordinate and normal ([`NONE`] if missing) in the order of
/// first use, and the vertex of each corner. The last two index arrays may be empty.
fn split_vertices(
    position_of: &[u32],
    uv_of: &[u32],
    normal_of: &[u32],
    positions: usize,
) -> (Vec<[u32; 3]>, Vec<u32>) {
    let mut sources: Vec<[u32; 3]> = Vec::with_capacity(positions);
    let mut vertex_of = Vec::with_capacity(position_of.len());
    // The vertices of a position form a linked list.
    let mut first = vec![NONE; positions];
    let mut next: Vec<u32> = Vec::with_capacity(positions);
    let mut overflow: HashMap<[u32; 3], u32> = HashMap::new();
    for (corner, &position) in position_of.iter().enumerate() {
        let key =
            [position, uv_of.get(corner).copied().unwrap_or(NONE), normal_of.get(corner).copied().unwrap_or(NONE)];
        let mut vertex = first[position as usize];
        let mut last = NONE;
        let mut walked = 0;
        while vertex != NONE && sources[vertex as usize] != key && walked < WALKED_PER_POSITION {
            last = vertex;
            vertex = next[vertex as usize];
            walked += 1;
        }
        let fresh = sources.len() as u32;
        if walked == WALKED_PER_POSITION {
            vertex = *overflow.entry(key).or_insert(fresh);
        } else if vertex == NONE {
            vertex = fresh;
            match last {
                NONE => first[position as usize] = fresh,
                last => next[last as usize] = fresh,
            }
        }
        if vertex == fresh {
            sources.push(key);
            next.push(NONE);
        }
        vertex_of.push(vertex);
    }
    (sources, vertex_of)
}

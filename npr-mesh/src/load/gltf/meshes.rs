//! Loads meshes, and places them.

use super::accessor::{Accessor, Integers, Purpose};
use super::compressed::refuse_unsupported;
use super::document::{self, Document};
use super::edge_visibility;
use super::extensions::INSTANCING;
use super::instancing::Instances;
use super::lines;
use super::materials::{Materials, UvSource};
use super::pose::{self, Influences};
use super::scene::Nodes;
use crate::edges::MOST_FACES;
use crate::transform::Turn;
use crate::{LoadError, Model, Object, SideVisibility};
use glam::{BVec3, DAffine3, DMat3, DMat4, DVec3, Vec2, Vec3, Vec4};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{self, Index};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// The maximum of a channel of a vertex colour.
const BRIGHTEST: f32 = 1000.0;

/// The meshes of the shown nodes, each once, and the nodes that place them. Without those that have neither faces nor lines.
///
/// # Errors
/// [`LoadError`] for invalid data that a shown mesh refers to, and for exceeded limits.
pub(super) fn load(
    document: &Document,
    nodes: &Nodes,
    warnings: &mut Vec<String>,
) -> Result<(Vec<Model>, Vec<Object>), LoadError> {
    let mut loader = Loader {
        document,
        meshes: Vec::new(),
        model: Model::default(),
        warnings,
        materials: Materials::default(),
        seen: vec![false; document.root.meshes.len()],
        placed: [0; 2],
        instances: 0,
        displacements: 0,
    };
    let mut objects = Vec::new();
    let mut skins: HashMap<usize, Vec<DMat4>> = HashMap::new();
    // By mesh and weights of a node, if they matter and differ from those of the mesh. `None` without faces and lines.
    let mut known: HashMap<(usize, Option<Vec<u32>>), Option<usize>> = HashMap::new();
    for &number in &nodes.shown {
        let node = &document.root.nodes[number];
        let Some(index) = node.mesh else { continue };
        let fail = |fault: String| document.malformed(format!("node {number}: {fault}"));
        let mesh = &document.root.meshes[index.value()];
        let mut instances = Instances::of_node(document, number).map_err(fail)?;
        if instances.is_some() && node.skin.is_some() {
            // A skin places its mesh in the world, whatever the node.
            loader.warnings.push(format!("node {number}: {INSTANCING} is ignored, since its mesh has a skin"));
            instances = None;
        }
        let count = instances.as_ref().map_or(1, |instances| instances.count);
        loader.count_primitives(mesh, count)?;
        if count == 0 {
            continue;
        }
        let is_morphed = mesh.primitives.iter().any(|primitive| primitive.targets.is_some());
        let of_node = node.weights.as_deref().filter(|_| is_morphed && node.weights != mesh.weights);
        let weights = of_node.or(mesh.weights.as_deref()).unwrap_or(&[]);
        let (slot, world_from_mesh) = match node.skin {
            Some(skin) => {
                let joints = match skins.entry(skin.value()) {
                    Entry::Occupied(known) => known.into_mut(),
                    Entry::Vacant(slot) => slot.insert(pose::joint_matrices(document, nodes, skin).map_err(fail)?),
                };
                let origin = pose::far_origin(document, mesh, joints);
                let near: Vec<DMat4>;
                let joints = if origin == DVec3::ZERO {
                    &joints[..]
                } else {
                    near = joints.iter().map(|joint| DMat4::from_translation(-origin) * *joint).collect();
                    &near
                };
                let slot = loader.mesh(index.value(), mesh, weights, Some(joints))?;
                (slot, DAffine3::from_translation(origin))
            }
            None => {
                let key = (index.value(), of_node.map(|weights| weights.iter().map(|w| w.to_bits()).collect()));
                let slot = match known.entry(key) {
                    Entry::Occupied(known) => {
                        known.get().map_or(Ok(()), |slot| loader.count_again(slot))?;
                        *known.get()
                    }
                    Entry::Vacant(slot) => *slot.insert(loader.mesh(index.value(), mesh, weights, None)?),
                };
                (slot, DAffine3::from_mat4(nodes.world_from_node[number]))
            }
        };
        let Some(slot) = slot else { continue };
        let transforms = match instances {
            Some(instances) => instances.transforms().map_err(fail)?,
            None => vec![DAffine3::IDENTITY],
        };
        let name = document::name(node.name.as_deref().filter(|name| !name.is_empty()).or(mesh.name.as_deref()));
        for (at, node_from_mesh) in transforms.into_iter().enumerate() {
            if at > 0 {
                loader.count_again(slot)?;
            }
            let world_from_mesh = world_from_mesh * node_from_mesh;
            if let Some(vertex) = loader.vertex_out_of_range(slot, &world_from_mesh) {
                let fault = format!("in world space the position of its mesh's vertex {vertex} is not finite");
                return Err(fail(fault));
            }
            objects.push(Object { name: name.clone(), mesh: slot, world_from_mesh });
        }
    }
    let meshes = loader.meshes.into_iter().map(|(mesh, _)| mesh).collect();
    Ok((meshes, objects))
}

struct Loader<'a> {
    document: &'a Document<'a>,
    /// With their bounds.
    meshes: Vec<(Model, (Vec3, Vec3))>,
    /// The current mesh. Its texture coordinates and colours may be shorter than the positions: they are filled up when
    /// some are added.
    model: Model,
    warnings: &'a mut Vec<String>,
    materials: Materials,
    /// Meshes that were loaded before, whose warnings are not repeated.
    seen: Vec<bool>,
    /// The numbers of vertices, and of faces and line segments, of all nodes before, each with its mesh.
    placed: [usize; 2],
    /// The number of primitives so far, and of displacements and weights that were read for them.
    instances: u64,
    displacements: u64,
}

/// A primitive and its name in messages.
struct Part<'a> {
    name: String,
    primitive: &'a Primitive,
    first_time: bool,
}

/// The number of faces and line segments.
fn drawn(model: &Model) -> usize {
    model.faces.len() + model.lines.len()
}

/// The vertices of faces and lines.
fn used(model: &Model) -> impl Iterator<Item = u32> + '_ {
    model.faces.iter().flatten().chain(model.lines.iter().flatten()).copied()
}

impl Part<'_> {
    fn attribute(&self, semantic: Semantic) -> Option<Index<json::Accessor>> {
        self.primitive.attributes.get(&Checked::Valid(semantic)).copied()
    }
}

impl Loader<'_> {
    fn count_primitives(&mut self, mesh: &json::Mesh, objects: u64) -> Result<(), LoadError> {
        let limit = self.document.limits.instances;
        self.instances = self.instances.saturating_add(objects.saturating_mul(mesh.primitives.len() as u64));
        if self.instances > limit { Err(self.document.too_large("primitives", self.instances, limit)) } else { Ok(()) }
    }

    /// Counts the vertices and faces of a mesh that another node places.
    fn count_again(&mut self, slot: usize) -> Result<(), LoadError> {
        let mesh = &self.meshes[slot].0;
        let [vertices, faces] = [mesh.positions.len(), drawn(mesh)];
        self.fits_vertices(vertices as u64)?;
        self.fits_faces(faces as u64)?;
        self.placed = [self.placed[0] + vertices, self.placed[1] + faces];
        Ok(())
    }

    /// Loads a mesh, in its own space or posed by the joints of a skin. `None` if it has neither faces nor
    /// lines.
    fn mesh(
        &mut self,
        number: usize,
        mesh: &json::Mesh,
        weights: &[f32],
        joints: Option<&[DMat4]>,
    ) -> Result<Option<usize>, LoadError> {
        let first_time = !std::mem::replace(&mut self.seen[number], true);
        self.materials.begin_mesh();
        for (at, primitive) in mesh.primitives.iter().enumerate() {
            refuse_unsupported(self.document, number, at, primitive)?;
            let part = Part { name: format!("mesh {number} primitive {at}"), primitive, first_time };
            self.primitive(&part, weights, joints)?;
        }
        let mut model = std::mem::take(&mut self.model);
        // Of many small meshes, spare capacity would take more memory than the data.
        model.materials.shrink_to_fit();
        model.textures.shrink_to_fit();
        let vertices = model.positions.len();
        // Meshes without faces count as well, since reading them takes time.
        self.placed = [self.placed[0] + vertices, self.placed[1] + drawn(&model)];
        if !model.uvs.is_empty() {
            model.uvs.resize(vertices, Vec2::ZERO);
        }
        if !model.colors.is_empty() {
            model.colors.resize(vertices, Vec4::ONE);
        }
        Ok(model.bounds().map(|bounds| {
            self.meshes.push((model, bounds));
            self.meshes.len() - 1
        }))
    }

    /// A vertex of a face or line whose position in world space is not within the range of f32.
    fn vertex_out_of_range(&self, slot: usize, world_from_mesh: &DAffine3) -> Option<u32> {
        let (mesh, (low, high)) = &self.meshes[slot];
        let is_finite = |p: Vec3| world_from_mesh.transform_point3(p.as_dvec3()).as_vec3().is_finite();
        let corner = |i: u32| Vec3::select(BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), *low, *high);
        if (0..8).all(|i| is_finite(corner(i))) {
            return None;
        }
        used(mesh).find(|&vertex| !is_finite(mesh.positions[vertex as usize]))
    }

    fn primitive(&mut self, part: &Part, weights: &[f32], joints: Option<&[DMat4]>) -> Result<(), LoadError> {
        let document = self.document;
        let fail = |fault: String| document.malformed(format!("{}: {fault}", part.name));
        let mode = match part.primitive.mode {
            Checked::Valid(Mode::Points) => {
                if part.first_time {
                    self.warnings.push("primitives of points are left out".to_owned());
                }
                return Ok(());
            }
            Checked::Valid(mode) => mode,
            Checked::Invalid => return Err(fail("unknown mode".to_owned())),
        };
        let Some(position_accessor) = part.attribute(Semantic::Positions) else {
            self.warn(part, "no POSITION, it is left out");
            return Ok(());
        };

        // All sizes are checked before memory is allocated.
        let accessor = Accessor::new(document, position_accessor, Purpose::Position)
            .map_err(|f| fail(format!("POSITION: {f}")))?;
        let first_vertex = self.model.positions.len();
        let vertices = self.fits_vertices(accessor.count)?;
        let indices = match part.primitive.indices {
            Some(index) => {
                Some(Accessor::new(document, index, Purpose::Indices).map_err(|f| fail(format!("indices: {f}")))?)
            }
            None => None,
        };
        let corners = indices.as_ref().map_or(accessor.count, |indices| indices.count);
        let is_lines = lines::are_lines(mode);
        let face_count = match mode {
            _ if is_lines => 0,
            Mode::Triangles => corners / 3,
            _ => corners.saturating_sub(2),
        };
        if is_lines {
            self.fits_lines(lines::count(mode, corners))?;
            if lines::leaves_a_rest(mode, corners) {
                self.warn(part, &format!("{corners} ends, which are no whole number of lines"));
            }
        } else {
            self.fits_faces(face_count)?;
            if corners < 3 || (mode == Mode::Triangles && corners % 3 != 0) {
                self.warn(part, &format!("{corners} corners, which are no whole number of triangles"));
            }
        }
        let strings = if is_lines { 0 } else { edge_visibility::string_ends(document, part.primitive) };
        self.fits_lines(face_count.saturating_add(strings))?;
        let edges = if is_lines {
            None
        } else {
            edge_visibility::read(document, part.primitive, face_count, vertices).map_err(fail)?
        };

        let reads = pose::targets_in_use(part.primitive, weights) + pose::influence_sets(part.primitive);
        self.displacements = self.displacements.saturating_add(reads.saturating_mul(accessor.count));
        if self.displacements > document.limits.displacements {
            let limit = document.limits.displacements;
            return Err(document.too_large("displacements and weights of joints", self.displacements, limit));
        }

        let mut positions = accessor.floats::<3>(Integers::AsStated).map_err(|f| fail(format!("POSITION: {f}")))?;
        let mut normals = self
            .read(part, Semantic::Normals, Purpose::Normal, vertices, |a| a.floats::<3>(Integers::AsStated))?
            .unwrap_or_default();
        pose::morph(document, part.primitive, weights, &mut positions, &mut normals).map_err(fail)?;
        self.model.positions.extend(positions.into_iter().map(Vec3::from_array));
        self.model.normals.extend(normals.into_iter().map(Vec3::from_array));
        self.model.normals.resize(self.model.positions.len(), Vec3::ZERO);
        let (positions, normals) = (&mut self.model.positions[first_vertex..], &mut self.model.normals[first_vertex..]);
        // Missing normals, and those without a direction, are zero afterwards.
        let mirrored = match joints {
            None => {
                let turn = Turn::new(&DMat3::IDENTITY);
                normals.iter_mut().for_each(|normal| *normal = turn.normal(*normal));
                Vec::new()
            }
            Some(joints) => {
                let influences = Influences::read(document, part.primitive, vertices).map_err(fail)?;
                let influences =
                    influences.ok_or_else(|| fail("a skin, and neither JOINTS_0 nor WEIGHTS_0".to_owned()))?;
                pose::skin(&influences, joints, positions, normals).map_err(fail)?
            }
        };

        let corners = match indices {
            None => None,
            Some(accessor) => Some(self.corners(part, &accessor, vertices)?),
        };
        let (first_face, first_line) = (self.model.faces.len(), self.model.lines.len());
        if is_lines {
            let has_color = part.primitive.material.is_some() || part.attribute(Semantic::Colors(0)).is_some();
            if has_color && part.first_time {
                self.warnings.push("colours of lines are ignored: lines have the style's ink".to_owned());
            }
            let segments = lines::segments(mode, vertices, corners.as_deref());
            self.model.lines.extend(segments.iter().map(|line| line.map(|vertex| first_vertex as u32 + vertex)));
            return self.check_positions(part, first_vertex, self.model.faces.len(), first_line);
        }
        let (material, uv) = self.materials.get(document, part.primitive.material, &mut self.model, self.warnings)?;
        self.uvs(part, first_vertex, vertices, uv)?;
        self.colors(part, first_vertex, vertices)?;
        self.faces(mode, first_vertex, vertices, corners.as_deref(), &mirrored);
        self.model.face_material.resize(self.model.faces.len(), material);
        if let Some(edges) = edges {
            edges.warnings.iter().for_each(|warning| self.warn(part, warning));
            self.model.lines.extend(edges.lines.iter().map(|line| line.map(|vertex| first_vertex as u32 + vertex)));
            self.add_sides(first_face, first_vertex, &edges.sides, &mirrored);
        }
        self.check_positions(part, first_vertex, first_face, first_line)
    }

    /// Adds what the file says of the sides of the faces from `first_face` on.
    fn add_sides(&mut self, first_face: usize, first_vertex: usize, sides: &[[SideVisibility; 3]], mirrored: &[bool]) {
        if sides.is_empty() {
            return;
        }
        let Model { faces, side_visibility, .. } = &mut self.model;
        side_visibility.resize(first_face, Default::default());
        side_visibility.extend(faces[first_face..].iter().zip(sides).map(|(face, &sides)| {
            // As for the face itself, its first vertex decides.
            let is_mirrored = mirrored.get(face[0] as usize - first_vertex) == Some(&true);
            if is_mirrored { SideVisibility::reversed(sides) } else { sides }
        }));
    }

    fn warn(&mut self, part: &Part, text: &str) {
        if part.first_time {
            self.warnings.push(format!("{}: {text}", part.name));
        }
    }

    /// Checks that additional vertices are within the limits, and returns their number.
    fn fits_vertices(&self, more: u64) -> Result<usize, LoadError> {
        self.fits("vertices", self.placed[0] + self.model.positions.len(), more, self.document.limits.vertices)
    }

    /// The same for faces.
    fn fits_faces(&self, more: u64) -> Result<usize, LoadError> {
        let limit = self.document.limits.faces.min(MOST_FACES as u64);
        self.fits("faces", self.placed[1] + drawn(&self.model), more, limit)
    }

    /// The same for line segments, which count as faces.
    fn fits_lines(&self, more: u64) -> Result<usize, LoadError> {
        self.fits("lines", self.placed[1] + drawn(&self.model), more, self.document.limits.faces)
    }

    fn fits(&self, what: &'static str, so_far: usize, more: u64, limit: u64) -> Result<usize, LoadError> {
        let limit = limit.min(u32::MAX.into());
        let count = (so_far as u64).saturating_add(more);
        let more = match usize::try_from(more) {
            Ok(more) if count <= limit => more,
            _ => return Err(self.document.too_large(what, count, limit)),
        };
        let limit = self.document.limits.repeated.saturating_add(self.document.bytes / 8);
        if count > limit {
            let what = match what {
                "faces" => "faces from a file so small",
                "lines" => "lines from a file so small",
                _ => "vertices from a file so small",
            };
            return Err(self.document.too_large(what, count, limit));
        }
        Ok(more)
    }

    /// Reads an attribute if the primitive has it.
    fn read<T>(
        &self,
        part: &Part,
        semantic: Semantic,
        purpose: Purpose,
        vertices: usize,
        read: impl Fn(&Accessor) -> Result<T, String>,
    ) -> Result<Option<T>, LoadError> {
        let Some(index) = part.attribute(semantic.clone()) else { return Ok(None) };
        let values = Accessor::new(self.document, index, purpose).and_then(|accessor| {
            if accessor.count != vertices as u64 {
                return Err(accessor.fault(&format!("{} elements for {vertices} vertices", accessor.count)));
            }
            read(&accessor)
        });
        let fail = |f| self.document.malformed(format!("{}: {}: {f}", part.name, semantic.to_string()));
        values.map(Some).map_err(fail)
    }

    fn corners(&self, part: &Part, accessor: &Accessor, vertices: usize) -> Result<Vec<u32>, LoadError> {
        let fail = |fault: String| self.document.malformed(format!("{}: indices: {fault}", part.name));
        let corners = accessor.integers::<1>().map_err(fail)?.into_flattened();
        // The largest value of each type would restart a strip in some graphics APIs; glTF forbids it.
        let largest = corners.iter().copied().max().unwrap_or(0);
        if !corners.is_empty() && largest as usize >= vertices {
            let at = corners.iter().position(|&c| c == largest).unwrap_or(0);
            return Err(fail(accessor.fault(&format!("element {at}: vertex {largest} of {vertices}"))));
        }
        Ok(corners)
    }

    fn uvs(&mut self, part: &Part, first: usize, vertices: usize, source: UvSource) -> Result<(), LoadError> {
        let semantic = Semantic::TexCoords(source.set);
        match self.read(part, semantic, Purpose::TexCoord, vertices, |a| a.floats::<2>(Integers::AsStated))? {
            Some(uvs) => {
                self.model.uvs.resize(first, Vec2::ZERO);
                // Texture coordinates that are not finite become zero.
                let finite = |uv: Vec2| if uv.is_finite() { uv } else { Vec2::ZERO };
                self.model.uvs.extend(uvs.into_iter().map(|uv| finite(source.apply(Vec2::from_array(uv)))));
            }
            None if source.wanted => {
                self.warn(part, &format!("no TEXCOORD_{}, which its texture asks for", source.set));
            }
            None => {}
        }
        Ok(())
    }

    fn colors(&mut self, part: &Part, first: usize, vertices: usize) -> Result<(), LoadError> {
        let read = |accessor: &Accessor| {
            // Colours are floats or normalised integers, with or without alpha.
            if accessor.lanes == 3 {
                let colors = accessor.floats::<3>(Integers::Normalized)?;
                return Ok(colors.into_iter().map(|c| Vec3::from_array(c).extend(1.0)).collect());
            }
            Ok(accessor.floats::<4>(Integers::Normalized)?.into_iter().map(Vec4::from_array).collect::<Vec<_>>())
        };
        if let Some(colors) = self.read(part, Semantic::Colors(0), Purpose::Fraction, vertices, read)? {
            self.model.colors.resize(first, Vec4::ONE);
            let limit = |c: Vec4| {
                // Values above 1 are allowed, but are limited so that products remain finite.
                let c = c.clamp(Vec4::ZERO, Vec4::splat(BRIGHTEST));
                c.truncate().extend(c.w.min(1.0))
            };
            let bad = colors.iter().filter(|c| !c.is_finite() || limit(**c) != **c).count();
            if bad > 0 {
                self.warn(part, &format!("{bad} colours are not finite or not within their range"));
            }
            self.model.colors.extend(colors.into_iter().map(|c| if c.is_finite() { limit(c) } else { Vec4::ONE }));
        }
        Ok(())
    }

    /// Assembles the triangles of a primitive (glTF 2.0, 3.7.2.1 "Overview"), reversed where the first vertex is
    /// mirrored. All corners are in range.
    fn faces(&mut self, mode: Mode, first: usize, vertices: usize, corners: Option<&[u32]>, mirrored: &[bool]) {
        let all: Vec<u32>;
        let corners = match corners {
            Some(corners) => corners,
            None => {
                all = (0..vertices as u32).collect();
                &all
            }
        };
        let first = first as u32;
        let wound = |[a, b, c]: [u32; 3]| {
            let [b, c] = if mirrored.get(a as usize) == Some(&true) { [c, b] } else { [b, c] };
            [first + a, first + b, first + c]
        };
        let faces = &mut self.model.faces;
        match mode {
            Mode::TriangleStrip => faces.extend(corners.windows(3).enumerate().map(|(i, w)| {
                // Every other triangle of a strip has the opposite winding.
                wound(if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] })
            })),
            Mode::TriangleFan => {
                let around = corners.get(1..).unwrap_or(&[]);
                faces.extend(around.windows(2).map(|w| wound([w[0], w[1], corners[0]])));
            }
            _ => faces.extend(corners.as_chunks::<3>().0.iter().map(|&face| wound(face))),
        }
    }

    /// A position that is not finite is an error if a face or line from these on uses it, and is replaced otherwise.
    fn check_positions(
        &mut self,
        part: &Part,
        first: usize,
        first_face: usize,
        first_line: usize,
    ) -> Result<(), LoadError> {
        let positions = &mut self.model.positions;
        if positions[first..].iter().all(|p| p.is_finite()) {
            return Ok(());
        }
        let used =
            self.model.faces[first_face..].iter().flatten().chain(self.model.lines[first_line..].iter().flatten());
        if let Some(&vertex) = used.into_iter().find(|&&v| !positions[v as usize].is_finite()) {
            let fault = format!("{}: the position of vertex {} is not finite", part.name, vertex as usize - first);
            return Err(self.document.malformed(fault));
        }
        let mut unused = 0;
        for position in positions[first..].iter_mut().filter(|p| !p.is_finite()) {
            *position = Vec3::ZERO;
            unused += 1;
        }
        self.warn(part, &format!("{unused} positions are not finite, and nothing uses them"));
        Ok(())
    }
}

//! Flattens mesh instances into one model.

use super::accessor::{Accessor, Integers, Purpose};
use super::document::Document;
use super::materials::{Materials, UvSource};
use super::pose::{self, Influences, Mirrored, Placement};
use super::scene::Nodes;
use crate::edges::MOST_FACES;
use crate::{LoadError, Model};
use glam::{DMat4, Vec2, Vec3, Vec4};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{self, Index, Node};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// The maximum of a channel of a vertex colour.
const BRIGHTEST: f32 = 1000.0;

/// All meshes of the shown nodes, in the order of the nodes.
///
/// # Errors
/// [`LoadError`] for invalid data that a shown mesh refers to, and for exceeded limits.
pub(super) fn flatten(document: &Document, nodes: &Nodes, warnings: &mut Vec<String>) -> Result<Model, LoadError> {
    let mut flattener = Flattener {
        document,
        model: Model::default(),
        warnings,
        materials: Materials::default(),
        seen: vec![false; document.root.meshes.len()],
        instances: 0,
        displacements: 0,
    };
    let mut meshes = 0;
    let mut skins: HashMap<usize, Vec<DMat4>> = HashMap::new();
    for &number in &nodes.shown {
        let node = &document.root.nodes[number];
        let Some(mesh) = node.mesh else { continue };
        let fail = |fault: String| document.malformed(format!("node {number}: {fault}"));
        let placement = match node.skin {
            None => Placement::Rigid(nodes.world_from_node[number]),
            Some(skin) => {
                let joints = match skins.entry(skin.value()) {
                    Entry::Occupied(known) => known.into_mut(),
                    Entry::Vacant(slot) => slot.insert(pose::joint_matrices(document, nodes, skin).map_err(fail)?),
                };
                Placement::Skinned(joints)
            }
        };
        flattener.mesh(number, node, mesh, &placement)?;
        let faces = flattener.model.faces.len();
        flattener.model.face_mesh.resize(faces, meshes);
        meshes += 1;
    }
    let mut model = flattener.model;
    if meshes < 2 {
        model.face_mesh.clear();
    }
    let vertices = model.positions.len();
    if !model.uvs.is_empty() {
        model.uvs.resize(vertices, Vec2::ZERO);
    }
    if !model.colors.is_empty() {
        model.colors.resize(vertices, Vec4::ONE);
    }
    Ok(model)
}

struct Flattener<'a> {
    document: &'a Document<'a>,
    /// Texture coordinates and colours may be shorter than the positions: they are filled up when some are added.
    model: Model,
    warnings: &'a mut Vec<String>,
    materials: Materials,
    /// Meshes that were added before, whose warnings are not repeated.
    seen: Vec<bool>,
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

impl Part<'_> {
    fn attribute(&self, semantic: Semantic) -> Option<Index<json::Accessor>> {
        self.primitive.attributes.get(&Checked::Valid(semantic)).copied()
    }
}

impl Flattener<'_> {
    fn mesh(
        &mut self,
        node_number: usize,
        node: &Node,
        index: Index<json::Mesh>,
        placement: &Placement,
    ) -> Result<(), LoadError> {
        let number = index.value();
        let mesh =
            self.document.root.get(index).ok_or_else(|| {
                self.document.malformed(format!("node {node_number}: its mesh {number} does not exist"))
            })?;
        let first_time = !std::mem::replace(&mut self.seen[number], true);
        // The node's weights override those of the mesh.
        let weights = node.weights.as_deref().or(mesh.weights.as_deref()).unwrap_or(&[]);
        for (at, primitive) in mesh.primitives.iter().enumerate() {
            let part = Part { name: format!("mesh {number} primitive {at}"), primitive, first_time };
            self.primitive(&part, weights, placement)?;
        }
        Ok(())
    }

    fn primitive(&mut self, part: &Part, weights: &[f32], placement: &Placement) -> Result<(), LoadError> {
        let document = self.document;
        let fail = |fault: String| document.malformed(format!("{}: {fault}", part.name));
        self.instances += 1;
        if self.instances > document.limits.instances {
            return Err(document.too_large("primitives", self.instances, document.limits.instances));
        }
        let mode = match part.primitive.mode {
            Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => mode,
            Checked::Valid(mode) => {
                self.warn(part, &format!("{mode:?} are left out"));
                return Ok(());
            }
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
        let vertices = self.fits("vertices", first_vertex, accessor.count, document.limits.vertices)?;
        let indices = match part.primitive.indices {
            Some(index) => {
                Some(Accessor::new(document, index, Purpose::Indices).map_err(|f| fail(format!("indices: {f}")))?)
            }
            None => None,
        };
        let corners = indices.as_ref().map_or(accessor.count, |indices| indices.count);
        let face_count = match mode {
            Mode::Triangles => corners / 3,
            _ => corners.saturating_sub(2),
        };
        self.fits("faces", self.model.faces.len(), face_count, document.limits.faces.min(MOST_FACES as u64))?;
        if corners < 3 || (mode == Mode::Triangles && corners % 3 != 0) {
            self.warn(part, &format!("{corners} corners, which are no whole number of triangles"));
        }

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
        let influences = match placement {
            Placement::Rigid(_) => None,
            Placement::Skinned(_) => Influences::read(document, part.primitive, vertices).map_err(fail)?,
        };
        let target = (&mut self.model.positions, &mut self.model.normals);
        let mirrored = pose::transform(placement, influences.as_ref(), &positions, &normals, target).map_err(fail)?;

        let corners = match indices {
            None => None,
            Some(accessor) => Some(self.corners(part, &accessor, vertices)?),
        };
        let (material, uv) = self.materials.get(document, part.primitive.material, &mut self.model, self.warnings)?;
        self.uvs(part, first_vertex, vertices, uv)?;
        self.colors(part, first_vertex, vertices)?;
        self.faces(mode, first_vertex, vertices, corners.as_deref(), &mirrored);
        self.model.face_material.resize(self.model.faces.len(), material);
        self.check_positions(part, first_vertex, face_count as usize)
    }

    fn warn(&mut self, part: &Part, text: &str) {
        if part.first_time {
            self.warnings.push(format!("{}: {text}", part.name));
        }
    }

    /// Checks that `more` additional elements are within the limits, and returns their number.
    fn fits(&self, what: &'static str, so_far: usize, more: u64, limit: u64) -> Result<usize, LoadError> {
        let limit = limit.min(u32::MAX.into());
        let count = (so_far as u64).saturating_add(more);
        let more = match usize::try_from(more) {
            Ok(more) if count <= limit => more,
            _ => return Err(self.document.too_large(what, count, limit)),
        };
        let limit = self.document.limits.repeated.saturating_add(self.document.bytes / 8);
        if count > limit {
            let what = if what == "faces" { "faces from a file so small" } else { "vertices from a file so small" };
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

    /// Assembles the triangles of a primitive (glTF 2.0, 3.7.2.1 "Overview"). All corners are in range.
    fn faces(&mut self, mode: Mode, first: usize, vertices: usize, corners: Option<&[u32]>, mirrored: &Mirrored) {
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
            let [b, c] = if mirrored.face(a) { [c, b] } else { [b, c] };
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

    /// A position that is not finite is an error if one of the last `faces` faces uses it, and is replaced otherwise.
    fn check_positions(&mut self, part: &Part, first: usize, faces: usize) -> Result<(), LoadError> {
        let positions = &mut self.model.positions;
        if positions[first..].iter().all(|p| p.is_finite()) {
            return Ok(());
        }
        let new_faces = &self.model.faces[self.model.faces.len() - faces..];
        if let Some(&vertex) = new_faces.iter().flatten().find(|&&v| !positions[v as usize].is_finite()) {
            let fault = format!("{}: the position of vertex {} is not finite", part.name, vertex as usize - first);
            return Err(self.document.malformed(fault));
        }
        let mut unused = 0;
        for position in positions[first..].iter_mut().filter(|p| !p.is_finite()) {
            *position = Vec3::ZERO;
            unused += 1;
        }
        self.warn(part, &format!("{unused} positions are not finite, and no face uses them"));
        Ok(())
    }
}

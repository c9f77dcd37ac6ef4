//! Poses meshes: morph targets, then the skin (glTF 2.0, 3.7).

use super::accessor::{Accessor, Integers, Purpose};
use super::document::Document;
use super::scene::Nodes;
use crate::transform::Turn;
use glam::{DMat3, DMat4, DVec3, Vec3};
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{self, Index};
use serde_json::Value;

/// The joint matrices: the world transform of each joint times its inverse bind matrix.
///
/// # Errors
/// An invalid accessor, or too few matrices.
pub(super) fn joint_matrices(
    document: &Document,
    nodes: &Nodes,
    index: Index<json::Skin>,
) -> Result<Vec<DMat4>, String> {
    let number = index.value();
    let skin = &document.root.skins[number];
    let fail = |fault: String| format!("skin {number}: {fault}");
    let inverse_binds = match skin.inverse_bind_matrices {
        None => Vec::new(),
        Some(accessor) => {
            let accessor = Accessor::new(document, accessor, Purpose::Matrices).map_err(fail)?;
            if !accessor.stored || accessor.count < skin.joints.len() as u64 {
                let fault = format!("{} inverse bind matrices for {} joints", accessor.count, skin.joints.len());
                return Err(fail(accessor.fault(&fault)));
            }
            accessor.first(skin.joints.len() as u64).floats::<16>(Integers::AsStated).map_err(fail)?
        }
    };
    let matrix = |(at, joint): (usize, &Index<json::Node>)| {
        let world = nodes.world_from_node[joint.value()];
        // Without the accessor all inverse bind matrices are the identity.
        inverse_binds.get(at).map_or(world, |bind| world * DMat4::from_cols_array(&bind.map(f64::from)))
    };
    Ok(skin.joints.iter().enumerate().map(matrix).collect())
}

/// The origin of a skinned mesh, which is subtracted in f64 so that its positions keep their digits far from 0: the place
/// of the middle of its box, by the first joint, rounded to f32. It is 0 where that is less than [`FAR`] times as far as
/// the box is large.
pub(super) fn far_origin(document: &Document, mesh: &json::Mesh, joints: &[DMat4]) -> DVec3 {
    let bounds = |primitive: &Primitive| {
        let index = primitive.attributes.get(&Checked::Valid(Semantic::Positions))?;
        let accessor = &document.root.accessors[index.value()];
        let vector = |corner: &Option<Value>| -> Option<DVec3> {
            let [x, y, z] = corner.as_ref()?.as_array()?.as_slice() else { return None };
            Some(DVec3::new(x.as_f64()?, y.as_f64()?, z.as_f64()?))
        };
        // The bounds of normalised integers are integers.
        let (low, high) = (vector(&accessor.min)?, vector(&accessor.max)?);
        (!accessor.normalized).then_some((low, high))
    };
    let all = mesh.primitives.iter().filter_map(bounds).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let (Some((low, high)), Some(joint)) = (all, joints.first()) else { return DVec3::ZERO };
    let [low, high] = [low, high].map(|corner| joint.transform_point3(corner));
    let middle = low.midpoint(high).as_vec3();
    let is_far = middle.is_finite() && f64::from(middle.length()) >= FAR * low.distance(high);
    if is_far { middle.as_dvec3() } else { DVec3::ZERO }
}

/// At this distance, in sizes of the mesh, a position in f32 has lost half of its 24 bits.
const FAR: f64 = 4096.0;

/// The maximum number of sets of four joints and weights per vertex.
const MOST_INFLUENCE_SETS: u32 = 8;

/// The number of accessors that [`morph`] reads.
pub(super) fn targets_in_use(primitive: &Primitive, weights: &[f32]) -> u64 {
    let targets = primitive.targets.as_deref().unwrap_or(&[]);
    2 * targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0).count() as u64
}

/// The number of accessors that [`Influences::read`] reads.
pub(super) fn influence_sets(primitive: &Primitive) -> u64 {
    let is_influence =
        |semantic: &&Checked<Semantic>| matches!(semantic, Checked::Valid(Semantic::Joints(_) | Semantic::Weights(_)));
    primitive.attributes.keys().filter(is_influence).count() as u64
}

/// Adds the displacements of the morph targets (3.7.2.2 "Morph Targets").
///
/// # Errors
/// An invalid accessor.
pub(super) fn morph(
    document: &Document,
    primitive: &Primitive,
    weights: &[f32],
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) -> Result<(), String> {
    let targets = primitive.targets.as_deref().unwrap_or(&[]);
    for (number, (target, &weight)) in targets.iter().zip(weights).enumerate() {
        if weight == 0.0 {
            continue;
        }
        for (what, accessor, values) in
            [("POSITION", target.positions, &mut *positions), ("NORMAL", target.normals, &mut *normals)]
        {
            // If the mesh has no normals, they are computed later from the displaced positions.
            let Some(accessor) = accessor.filter(|_| !values.is_empty()) else { continue };
            let fail = |fault: String| format!("{what} of morph target {number}: {fault}");
            let accessor = Accessor::new(document, accessor, Purpose::Displacement).map_err(fail)?;
            if accessor.count != values.len() as u64 {
                let fault = format!("{} elements for {} vertices", accessor.count, values.len());
                return Err(fail(accessor.fault(&fault)));
            }
            for (value, delta) in values.iter_mut().zip(accessor.floats::<3>(Integers::AsStated).map_err(fail)?) {
                for (v, d) in value.iter_mut().zip(delta) {
                    *v += weight * d;
                }
            }
        }
    }
    Ok(())
}

/// The joints that influence each vertex, and their weights: the sets `JOINTS_n` and `WEIGHTS_n`.
pub(super) struct Influences {
    sets: Vec<InfluenceSet>,
}

/// Four joints per vertex with their weights.
struct InfluenceSet {
    joints: Vec<[u32; 4]>,
    weights: Vec<[f32; 4]>,
}

impl Influences {
    /// `None` if the primitive has no joints and weights.
    ///
    /// # Errors
    /// An invalid accessor, or joints without weights.
    pub fn read(document: &Document, primitive: &Primitive, vertices: usize) -> Result<Option<Self>, String> {
        let mut sets = Vec::new();
        for number in 0.. {
            let find = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
            let (joints, weights) = match (find(Semantic::Joints(number)), find(Semantic::Weights(number))) {
                (None, None) => break,
                (Some(joints), Some(weights)) => (joints, weights),
                _ => return Err(format!("only one of JOINTS_{number} and WEIGHTS_{number}")),
            };
            if number >= MOST_INFLUENCE_SETS {
                return Err(format!("more than {MOST_INFLUENCE_SETS} sets of JOINTS and WEIGHTS"));
            }
            let open = |what: &str, index, purpose| {
                let fail = |fault: String| format!("{what}_{number}: {fault}");
                let accessor = Accessor::new(document, index, purpose).map_err(fail)?;
                if accessor.count != vertices as u64 {
                    let fault = format!("{} elements for {vertices} vertices", accessor.count);
                    return Err(fail(accessor.fault(&fault)));
                }
                Ok(accessor)
            };
            let fail = |fault: String| format!("joints and weights {number}: {fault}");
            sets.push(InfluenceSet {
                joints: open("JOINTS", joints, Purpose::Joints)?.integers::<4>().map_err(fail)?,
                weights: open("WEIGHTS", weights, Purpose::Fraction)?
                    .floats::<4>(Integers::Normalized)
                    .map_err(fail)?,
            });
        }
        Ok((!sets.is_empty()).then_some(Self { sets }))
    }

    /// The weighted mean of a vertex's joint matrices, for any sum of weights. A vertex without weights follows its
    /// first joint. A joint of weight zero need not exist.
    ///
    /// # Errors
    /// A missing joint, or a weight that is not finite.
    fn blend(&self, vertex: usize, joints: &[DMat4]) -> Result<DMat4, String> {
        let (mut sum, mut blended) = (0.0, DMat4::ZERO);
        let find = |joint: u32| {
            let found = joints.get(joint as usize);
            found.ok_or_else(|| format!("vertex {vertex}: joint {joint} of a skin with {}", joints.len()))
        };
        for set in &self.sets {
            for (&joint, &weight) in set.joints[vertex].iter().zip(&set.weights[vertex]) {
                if weight != 0.0 {
                    sum += f64::from(weight);
                    blended += *find(joint)? * f64::from(weight);
                }
            }
        }
        if !sum.is_finite() {
            return Err(format!("vertex {vertex}: a weight is not finite"));
        }
        if sum == 0.0 {
            return find(self.sets[0].joints[vertex][0]).copied();
        }
        // Dividing by 1 would add a rounding error.
        Ok(if sum == 1.0 { blended } else { blended * (1.0 / sum) })
    }
}

/// Transforms positions and normals to world space by the joint matrices of a skin; the transform of the mesh's node is
/// ignored (3.7.3.3 "Skinned Mesh Attributes").
///
/// Returns for each vertex whether its matrix mirrors. The winding of a face is then reversed (3.7.4
/// "Instantiation"), as stated by its first vertex: the specification does not cover joint matrices of different
/// orientations.
///
/// # Errors
/// A vertex with a missing joint.
pub(super) fn skin(
    influences: &Influences,
    joints: &[DMat4],
    positions: &mut [Vec3],
    normals: &mut [Vec3],
) -> Result<Vec<bool>, String> {
    let pose = |(vertex, (position, normal)): (usize, (&mut Vec3, &mut Vec3))| {
        let matrix = influences.blend(vertex, joints)?;
        let turn = Turn::new(&DMat3::from_mat4(matrix));
        *position = matrix.transform_point3(position.as_dvec3()).as_vec3();
        *normal = turn.normal(*normal);
        Ok(turn.mirrors)
    };
    positions.iter_mut().zip(normals).enumerate().map(pose).collect()
}

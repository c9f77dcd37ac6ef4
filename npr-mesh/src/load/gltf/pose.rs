//! Transforms vertices: morph targets, then the skin or the node (glTF 2.0, 3.7).

use super::accessor::{Accessor, Integers, Purpose};
use super::document::Document;
use super::scene::Nodes;
use glam::{DMat3, DMat4, DVec3, Vec3};
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{self, Index};

/// The transform of a mesh to world space.
pub(super) enum Placement<'a> {
    /// One matrix for the whole mesh.
    Rigid(DMat4),
    /// The joint matrices of a skin, blended per vertex. The transform of the mesh's node is ignored (3.7.3.3
    /// "Skinned Mesh Attributes").
    Skinned(&'a [DMat4]),
}

/// The faces whose orientation a transform mirrors, so that their winding must be reversed (3.7.4 "Instantiation").
pub(super) enum Mirrored {
    /// All faces, or none.
    All(bool),
    /// By the first vertex of a face. Joint matrices may differ in orientation; the specification does not cover this
    /// case.
    ByVertex(Vec<bool>),
}

impl Mirrored {
    pub fn face(&self, first_vertex: u32) -> bool {
        match self {
            Mirrored::All(all) => *all,
            Mirrored::ByVertex(vertices) => vertices[first_vertex as usize],
        }
    }
}

/// The joint matrices: the world transform of each joint times its inverse bind matrix.
///
/// # Errors
/// A missing joint or accessor, or too few matrices.
pub(super) fn joint_matrices(
    document: &Document,
    nodes: &Nodes,
    index: Index<json::Skin>,
) -> Result<Vec<DMat4>, String> {
    let number = index.value();
    let skin = document.root.get(index).ok_or_else(|| format!("skin {number} does not exist"))?;
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
        let joint = joint.value();
        let world =
            nodes.world_from_node.get(joint).ok_or_else(|| fail(format!("its joint {joint} does not exist")))?;
        // Without the accessor all inverse bind matrices are the identity.
        Ok(inverse_binds.get(at).map_or(*world, |bind| *world * DMat4::from_cols_array(&bind.map(f64::from))))
    };
    skin.joints.iter().enumerate().map(matrix).collect()
}

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

/// Transforms positions and normals (empty, or as many) to world space and appends them. Missing normals, and those
/// without a direction, become zero.
///
/// # Errors
/// A vertex with a missing joint.
pub(super) fn transform(
    placement: &Placement,
    influences: Option<&Influences>,
    positions: &[[f32; 3]],
    normals: &[[f32; 3]],
    (to_positions, to_normals): (&mut Vec<Vec3>, &mut Vec<Vec3>),
) -> Result<Mirrored, String> {
    let end = to_positions.len() + positions.len();
    to_positions.reserve(positions.len());
    to_normals.reserve(positions.len());
    let mirrored = match (placement, influences) {
        (Placement::Skinned(joints), Some(influences)) => {
            let mut mirrored = Vec::with_capacity(positions.len());
            for (vertex, position) in positions.iter().enumerate() {
                let matrix = influences.blend(vertex, joints)?;
                let turn = Turn::new(&matrix);
                to_positions.push(moved(&matrix, position));
                to_normals.extend(normals.get(vertex).map(|normal| turn.normal(normal)));
                mirrored.push(turn.mirrors);
            }
            Mirrored::ByVertex(mirrored)
        }
        (Placement::Rigid(matrix), _) => {
            let turn = Turn::new(matrix);
            to_positions.extend(positions.iter().map(|position| moved(matrix, position)));
            to_normals.extend(normals.iter().map(|normal| turn.normal(normal)));
            Mirrored::All(turn.mirrors)
        }
        (Placement::Skinned(_), None) => return Err("a skin, and neither JOINTS_0 nor WEIGHTS_0".to_owned()),
    };
    to_normals.resize(end, Vec3::ZERO);
    Ok(mirrored)
}

fn moved(matrix: &DMat4, position: &[f32; 3]) -> Vec3 {
    matrix.transform_point3(DVec3::from_array(position.map(f64::from))).as_vec3()
}

/// The effect of a matrix on directions.
struct Turn {
    /// The inverse transpose times a positive number, or zero if the matrix is singular.
    world_from_normal: DMat3,
    mirrors: bool,
}

impl Turn {
    fn new(matrix: &DMat4) -> Self {
        let linear = DMat3::from_mat4(*matrix);
        let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
        // The columns of the inverse transpose times the determinant.
        let cofactors = [y.cross(z), z.cross(x), x.cross(y)];
        let determinant = x.dot(cofactors[0]);
        let sign = if determinant == 0.0 || !determinant.is_finite() { 0.0 } else { determinant.signum() };
        let [x, y, z] = cofactors.map(|c| c * sign);
        Self { world_from_normal: DMat3::from_cols(x, y, z), mirrors: determinant < 0.0 }
    }

    fn normal(&self, normal: &[f32; 3]) -> Vec3 {
        let turned = self.world_from_normal * DVec3::from_array(normal.map(f64::from));
        turned.try_normalize().map_or(Vec3::ZERO, DVec3::as_vec3)
    }
}

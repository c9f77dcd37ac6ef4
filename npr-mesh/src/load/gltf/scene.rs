//! The node hierarchy (glTF 2.0, 3.5 "Scenes").

use super::document::Document;
use super::extra::ExtraNode;
use crate::LoadError;
use glam::{DMat4, DQuat, DVec3};
use gltf::json::Node;

/// The world transforms of the nodes, and the shown nodes.
pub(super) struct Nodes {
    /// For every node of the file, since joints may be outside the scene.
    pub world_from_node: Vec<DMat4>,
    /// The nodes of the scene, each once, parents before their children.
    pub shown: Vec<usize>,
}

/// Computes the world transforms of all nodes.
///
/// # Errors
/// A child with two parents, a cycle, or more nodes than the limit.
pub(super) fn pose(document: &Document) -> Result<Nodes, LoadError> {
    let nodes = &document.root.nodes;
    if nodes.len() as u64 > document.limits.nodes {
        return Err(document.too_large("nodes", nodes.len() as u64, document.limits.nodes));
    }
    let mut parents: Vec<Option<usize>> = vec![None; nodes.len()];
    for (parent, node) in nodes.iter().enumerate() {
        for child in children(node) {
            if let Some(other) = parents[child].replace(parent) {
                return Err(document.malformed(format!("node {child} is a child of node {other} and of node {parent}")));
            }
        }
    }
    let roots: Vec<usize> = (0..nodes.len()).filter(|&n| parents[n].is_none()).collect();

    let mut world_from_node = vec![DMat4::IDENTITY; nodes.len()];
    let order = descend(nodes, &roots);
    for &node in &order {
        let local = local_transform(&document.extra.nodes[node])
            .ok_or_else(|| document.malformed(format!("node {node}: its rotation has no length")))?;
        world_from_node[node] = parents[node].map_or(local, |parent| world_from_node[parent] * local);
    }
    // Every node has at most one parent, so nodes that are unreachable from the roots descend from a cycle, in which
    // this many steps upwards end.
    if order.len() < nodes.len() {
        let mut reached = vec![false; nodes.len()];
        order.iter().for_each(|&node| reached[node] = true);
        let lost = reached.iter().position(|r| !r).unwrap_or_default();
        let inside = (0..nodes.len()).fold(lost, |node, _| parents[node].unwrap_or(node));
        return Err(document.malformed(format!("node {inside} is its own ancestor")));
    }

    let scenes = &document.root.scenes;
    let scene = match document.root.scene {
        Some(index) => Some(&scenes[index.value()]),
        None => scenes.first(),
    };
    let shown = match scene {
        None => order,
        Some(scene) => {
            let roots: Vec<usize> = scene.nodes.iter().map(|n| n.value()).collect();
            descend(nodes, &roots)
        }
    };
    Ok(Nodes { world_from_node, shown })
}

fn children(node: &Node) -> impl DoubleEndedIterator<Item = usize> + '_ {
    node.children.iter().flatten().map(|child| child.value())
}

/// All nodes below and including `roots`, depth first in the order of the file. An explicit stack is used, since a
/// chain of nodes may exceed the call stack.
fn descend(nodes: &[Node], roots: &[usize]) -> Vec<usize> {
    let mut order = Vec::new();
    let mut seen = vec![false; nodes.len()];
    let mut stack: Vec<usize> = roots.iter().rev().copied().collect();
    while let Some(node) = stack.pop() {
        if !std::mem::replace(&mut seen[node], true) {
            order.push(node);
            stack.extend(children(&nodes[node]).rev());
        }
    }
    order
}

/// `None` if the rotation has no length.
fn local_transform(node: &ExtraNode) -> Option<DMat4> {
    if let Some(matrix) = &node.matrix {
        return Some(DMat4::from_cols_array(matrix));
    }
    trs(node.translation.as_deref(), node.rotation.as_deref(), node.scale.as_deref())
}

/// The matrix of a translation, a rotation as a quaternion xyzw, and a scale. `None` if the rotation has no length.
pub(super) fn trs(
    translation: Option<&[f64; 3]>,
    rotation: Option<&[f64; 4]>,
    scale: Option<&[f64; 3]>,
) -> Option<DMat4> {
    let rotation = rotation.map_or(DQuat::IDENTITY, |xyzw| DQuat::from_array(*xyzw));
    let length = rotation.length();
    if !length.is_finite() || length < 1e-6 {
        return None;
    }
    Some(DMat4::from_scale_rotation_translation(
        scale.map_or(DVec3::ONE, |scale| DVec3::from_array(*scale)),
        // The file's rotation has unit length only up to rounding.
        rotation / length,
        translation.map_or(DVec3::ZERO, |translation| DVec3::from_array(*translation)),
    ))
}

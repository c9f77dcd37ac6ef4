//! The node hierarchy (glTF 2.0, 3.5 "Scenes").

use super::document::Document;
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
/// A missing child, a child with two parents, a cycle, or more nodes than the limit.
pub(super) fn pose(document: &Document) -> Result<Nodes, LoadError> {
    let nodes = &document.root.nodes;
    if nodes.len() as u64 > document.limits.nodes {
        return Err(document.too_large("nodes", nodes.len() as u64, document.limits.nodes));
    }
    let mut parents: Vec<Option<usize>> = vec![None; nodes.len()];
    for (parent, node) in nodes.iter().enumerate() {
        for child in children(node) {
            let slot = parents
                .get_mut(child)
                .ok_or_else(|| document.malformed(format!("node {parent}: its child {child} does not exist")))?;
            if let Some(other) = slot.replace(parent) {
                return Err(document.malformed(format!("node {child} is a child of node {other} and of node {parent}")));
            }
        }
    }
    let roots: Vec<usize> = (0..nodes.len()).filter(|&n| parents[n].is_none()).collect();

    let mut world_from_node = vec![DMat4::IDENTITY; nodes.len()];
    let order = descend(nodes, &roots);
    for &node in &order {
        let local = local_transform(&nodes[node])
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
        Some(index) => Some(
            scenes
                .get(index.value())
                .ok_or_else(|| document.malformed(format!("scene {} does not exist", index.value())))?,
        ),
        None => scenes.first(),
    };
    let shown = match scene {
        None => order,
        Some(scene) => {
            let roots: Vec<usize> = scene.nodes.iter().map(|n| n.value()).collect();
            if let Some(missing) = roots.iter().find(|&&n| n >= nodes.len()) {
                return Err(document.malformed(format!("the scene's node {missing} does not exist")));
            }
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
fn local_transform(node: &Node) -> Option<DMat4> {
    if let Some(matrix) = node.matrix {
        return Some(DMat4::from_cols_array(&matrix.map(f64::from)));
    }
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let rotation = DQuat::from_array(node.rotation.unwrap_or_default().0.map(f64::from));
    let length = rotation.length();
    if !length.is_finite() || length < 1e-6 {
        return None;
    }
    Some(DMat4::from_scale_rotation_translation(
        node.scale.map_or(DVec3::ONE, vector),
        // The file's rotation has unit length only up to rounding.
        rotation / length,
        node.translation.map_or(DVec3::ZERO, vector),
    ))
}

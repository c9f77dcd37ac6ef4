//! The mesh of a field: one node per position, faces with non-zero area, and the sizes of connected components.

use glam::{DVec3, Vec3};

/// The node of a vertex that is in none of the used faces.
pub(super) const NO_NODE: u32 = u32::MAX;

/// A face with three different finite corners and a non-zero area.
pub(super) struct Face {
    /// Index into the input faces.
    pub given: u32,
    /// The nodes of its corners.
    pub nodes: [u32; 3],
    /// The unit normal.
    pub normal: DVec3,
    pub area: f64,
}

pub(super) struct Surface {
    pub faces: Vec<Face>,
    /// Per vertex its node, or [`NO_NODE`].
    pub node_of: Vec<u32>,
    /// Per node its connected component.
    pub part: Vec<u32>,
    /// Per component the square root of its area, the unit of all lengths. Unlike a bounding box it is invariant to
    /// rotation.
    pub size: Vec<f64>,
}

impl Surface {
    /// All indices must be in range.
    pub fn new(positions: &[Vec3], faces: &[[u32; 3]], representative: &[u32]) -> Self {
        let mut of_representative = vec![NO_NODE; positions.len()];
        let mut nodes = 0;
        let mut kept = Vec::with_capacity(faces.len());
        for (given, face) in faces.iter().enumerate() {
            let welded = face.map(|v| representative[v as usize]);
            let [a, b, c] = face.map(|v| positions[v as usize].as_dvec3());
            let twice = (b - a).cross(c - a);
            let area = twice.length() / 2.0;
            let distinct = welded[0] != welded[1] && welded[1] != welded[2] && welded[2] != welded[0];
            if !(distinct && area > 0.0 && area.is_finite()) {
                continue;
            }
            let nodes = welded.map(|v| {
                let node = &mut of_representative[v as usize];
                if *node == NO_NODE {
                    *node = nodes;
                    nodes += 1;
                }
                *node
            });
            kept.push(Face { given: given as u32, nodes, normal: twice / (2.0 * area), area });
        }
        let mut surface = Self {
            faces: kept,
            node_of: representative.iter().map(|&v| of_representative[v as usize]).collect(),
            part: Vec::new(),
            size: Vec::new(),
        };
        surface.find_parts(nodes);
        surface
    }

    pub fn nodes(&self) -> usize {
        self.part.len()
    }

    /// The size of the component that a face belongs to.
    pub fn size_at(&self, face: &Face) -> f64 {
        self.size[self.part[face.nodes[0] as usize] as usize]
    }

    fn find_parts(&mut self, nodes: u32) {
        let mut parent: Vec<u32> = (0..nodes).collect();
        for face in &self.faces {
            for node in &face.nodes[1..] {
                let (a, b) = (root(&mut parent, face.nodes[0]), root(&mut parent, *node));
                // The lower root is kept, so that components are numbered in the order of their first nodes.
                parent[a.max(b) as usize] = a.min(b);
            }
        }
        let mut number = vec![NO_NODE; nodes as usize];
        let mut parts = 0;
        for node in 0..nodes {
            let root = root(&mut parent, node) as usize;
            if number[root] == NO_NODE {
                number[root] = parts;
                parts += 1;
            }
            number[node as usize] = number[root];
        }
        let mut area = vec![0.0; parts as usize];
        for face in &self.faces {
            area[number[face.nodes[0] as usize] as usize] += face.area;
        }
        self.part = number;
        self.size = area.into_iter().map(f64::sqrt).collect();
    }
}

/// The root of a node in a union-find forest, with path halving.
fn root(parent: &mut [u32], mut node: u32) -> u32 {
    while parent[node as usize] != node {
        let above = parent[parent[node as usize] as usize];
        parent[node as usize] = above;
        node = above;
    }
    node
}

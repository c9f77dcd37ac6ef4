//! The mesh as the field sees it: one node for each position, faces that have an area, sizes of connected parts.

use glam::{DVec3, Vec3};

/// Where a vertex is in no face that counts.
pub(super) const NO_NODE: u32 = u32::MAX;

/// A face with three finite corners in three places and an area.
pub(super) struct Face {
    /// Into the faces as given.
    pub given: u32,
    /// The nodes of its corners.
    pub nodes: [u32; 3],
    /// Unit.
    pub normal: DVec3,
    pub area: f64,
}

pub(super) struct Surface {
    pub faces: Vec<Face>,
    /// Per vertex, or [`NO_NODE`].
    pub node_of: Vec<u32>,
    /// Per node the connected part that it belongs to.
    pub part: Vec<u32>,
    /// Per connected part the root of its area: what all lengths are measured by. (A box around it would depend on how
    /// it is turned.)
    pub size: Vec<f64>,
}

impl Surface {
    /// All indices must be in range.
    pub fn new(positions: &[Vec3], faces: &[[u32; 3]], representative: &[u32]) -> Self {
        let mut of_representative = vec![NO_NODE; positions.len()];
        let mut nodes = 0;
        let mut kept = Vec::with_capacity(faces.len());
        for (given, face) in faces.iter().enumerate() {
            let stands_for = face.map(|v| representative[v as usize]);
            let [a, b, c] = face.map(|v| positions[v as usize].as_dvec3());
            let twice = (b - a).cross(c - a);
            let area = twice.length() / 2.0;
            let apart =
                stands_for[0] != stands_for[1] && stands_for[1] != stands_for[2] && stands_for[2] != stands_for[0];
            if !(apart && area > 0.0 && area.is_finite()) {
                continue;
            }
            let nodes = stands_for.map(|v| {
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

    /// The size of the part that a face belongs to.
    pub fn size_at(&self, face: &Face) -> f64 {
        self.size[self.part[face.nodes[0] as usize] as usize]
    }

    fn find_parts(&mut self, nodes: u32) {
        let mut parent: Vec<u32> = (0..nodes).collect();
        for face in &self.faces {
            for node in &face.nodes[1..] {
                let (a, b) = (root(&mut parent, face.nodes[0]), root(&mut parent, *node));
                // The lower one leads, so that the numbers below ascend.
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

/// Union–find, halving paths.
fn root(parent: &mut [u32], mut node: u32) -> u32 {
    while parent[node as usize] != node {
        let above = parent[parent[node as usize] as usize];
        parent[node as usize] = above;
        node = above;
    }
    node
}

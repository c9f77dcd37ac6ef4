//! The part of a plan for hatching.

use super::style::{HatchEncoding, HatchMapping, HatchShade};
use crate::error::HarnessError;
use crate::scene::{Mesh, Scene};
use glam::Vec2;
use npr_hatch::field::{FieldOptions, LineTensor, direction_field};
use npr_hatch::{HatchError, Tam, Thresholds, density};
use npr_mesh::Model;
use std::sync::Arc;

/// The data of a vertex that positions strokes.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct HatchVertex {
    /// The diagonal of the tensor of the field's direction: xx, yy, zz.
    pub diagonal: [f32; 3],
    /// The off-diagonal elements of the tensor: xy, xz, yz.
    pub others: [f32; 3],
    /// log2 of the scale applied to the texture coordinates.
    pub octave: f32,
}

/// The part of a plan for hatching.
#[derive(Clone, Debug)]
pub struct HatchPlan {
    /// The hatching settings of the style, with a mapping that the model supports.
    pub shade: HatchShade,
    /// The length of one side of the map on the surface, in scene units.
    pub tile: f64,
    /// Per mesh and vertex; empty if the mapping needs no data. Strokes lie in mesh space, so they move with the mesh.
    pub vertices: Vec<Arc<Vec<HatchVertex>>>,
    /// Whether the weights of six tones are computed at the vertices and interpolated, as in listing 4.
    pub weights_at_vertices: bool,
}

/// The cache key of [`HatchPlan::vertices`]: the bits of the tile's length.
#[derive(PartialEq)]
enum VerticesKey {
    Form,
    Coordinates(u64),
}

impl HatchPlan {
    /// `at_vertices` is whether the style computes light at the vertices.
    pub(crate) fn new(scene: &Scene, shade: &HatchShade, at_vertices: bool) -> Result<Self, HarnessError> {
        let tile = f64::from(shade.tile) * if scene.reference_radius() > 0.0 { scene.reference_radius() } else { 1.0 };
        let mapping = match shade.mapping {
            HatchMapping::Coordinates if scene.meshes().iter().all(|mesh| mesh.model().uvs.is_empty()) => {
                HatchMapping::Planes
            }
            other => other,
        };
        let of_mesh = |mesh: &Arc<Mesh>| vertices(mesh, mapping, tile);
        let vertices = scene.meshes().iter().map(of_mesh).collect::<Result<_, _>>()?;
        let shade = HatchShade { mapping, ..shade.clone() };
        let plan = Self { tile, vertices, weights_at_vertices: false, shade };
        // Draws the map if it does not exist yet.
        plan.tam()?;
        let thresholds = plan.drawn_thresholds()?.is_some();
        Ok(Self { weights_at_vertices: at_vertices && !thresholds, ..plan })
    }

    /// The images of the tones.
    pub(crate) fn tam(&self) -> Result<&Tam, HatchError> {
        self.shade.map.tam()
    }

    /// The threshold map, if the style uses one.
    pub(crate) fn drawn_thresholds(&self) -> Result<Option<&Thresholds>, HatchError> {
        match self.shade.encoding {
            HatchEncoding::SixTones => Ok(None),
            HatchEncoding::Thresholds => self.shade.map.thresholds(),
        }
    }
}

/// Computes the per-vertex data for the strokes of a mesh.
fn vertices(mesh: &Mesh, mapping: HatchMapping, tile: f64) -> Result<Arc<Vec<HatchVertex>>, HatchError> {
    let (Model { positions, normals, uvs, faces, .. }, seams) = (mesh.model(), &mesh.edges().representative);
    match mapping {
        HatchMapping::Planes => Ok(Arc::default()),
        HatchMapping::Form => mesh.derived().get(VerticesKey::Form, || {
            let directions = direction_field(positions, normals, faces, seams, &FieldOptions::default())?;
            let vertex = |line: &LineTensor| HatchVertex { diagonal: line.diagonal, others: line.others, octave: 0.0 };
            Ok(directions.iter().map(vertex).collect())
        }),
        HatchMapping::Coordinates => mesh.derived().get(VerticesKey::Coordinates(tile.to_bits()), || {
            // A mesh without texture coordinates gets (0, 0) at every vertex.
            let none = if uvs.is_empty() { vec![Vec2::ZERO; positions.len()] } else { Vec::new() };
            let uvs = if uvs.is_empty() { &none } else { uvs };
            let octaves = density::octaves(positions, uvs, faces, seams, tile as f32)?;
            let vertex = |octave| HatchVertex { diagonal: [0.0; 3], others: [0.0; 3], octave };
            Ok(octaves.into_iter().map(vertex).collect())
        }),
    }
}

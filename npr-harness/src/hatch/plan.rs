//! The part of a plan that is about strokes.

use super::style::{HatchEncoding, HatchMapping, HatchShade};
use crate::error::HarnessError;
use crate::scene::Scene;
use npr_hatch::field::{FieldOptions, LineTensor, direction_field};
use npr_hatch::{HatchError, Tam, Thresholds, density};
use npr_mesh::Model;
use std::sync::Arc;

/// The data of a vertex that positions strokes.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct HatchVertex {
    /// Of the tensor of the field's direction: xx, yy, zz.
    pub diagonal: [f32; 3],
    /// xy, xz, yz.
    pub others: [f32; 3],
    /// log2 of what texture coordinates are multiplied by.
    pub octave: f32,
}

/// The part of a plan that is about strokes.
#[derive(Clone, Debug)]
pub struct HatchPlan {
    /// The style's, with the mapping that the model allows.
    pub shade: HatchShade,
    /// The length on the surface of one side of the map, in the units of the scene's positions.
    pub tile: f64,
    /// Per vertex; empty if the mapping needs nothing.
    pub vertices: Arc<Vec<HatchVertex>>,
    /// Whether the weights of six tones are computed at the vertices and interpolated, as listing 4 has them.
    pub weights_at_vertices: bool,
}

/// The key of [`HatchPlan::vertices`] among what is derived of a scene. The tile's bits.
#[derive(PartialEq)]
enum VerticesKey {
    Form,
    Coordinates(u64),
}

impl HatchPlan {
    /// `at_vertices`: whether the style computes light at the vertices.
    pub(crate) fn new(scene: &Scene, shade: &HatchShade, at_vertices: bool) -> Result<Self, HarnessError> {
        let tile = f64::from(shade.tile) * if scene.radius() > 0.0 { scene.radius() } else { 1.0 };
        let mapping = match shade.mapping {
            HatchMapping::Coordinates if scene.model.uvs.is_empty() => HatchMapping::Planes,
            other => other,
        };
        let derived = &scene.derived;
        let vertices = match mapping {
            HatchMapping::Planes => Arc::default(),
            HatchMapping::Form => derived.get(VerticesKey::Form, || {
                let Model { positions, normals, faces, .. } = &scene.model;
                let seams = &scene.edges.representative;
                let directions = direction_field(positions, normals, faces, seams, &FieldOptions::default())?;
                let vertex =
                    |line: &LineTensor| HatchVertex { diagonal: line.diagonal, others: line.others, octave: 0.0 };
                Ok::<_, HatchError>(directions.iter().map(vertex).collect())
            })?,
            HatchMapping::Coordinates => derived.get(VerticesKey::Coordinates(tile.to_bits()), || {
                let model = &scene.model;
                let seams = &scene.edges.representative;
                let octaves = density::octaves(&model.positions, &model.uvs, &model.faces, seams, tile as f32)?;
                let vertex = |octave| HatchVertex { diagonal: [0.0; 3], others: [0.0; 3], octave };
                Ok::<_, HatchError>(octaves.into_iter().map(vertex).collect())
            })?,
        };
        let shade = HatchShade { mapping, ..shade.clone() };
        let plan = Self { tile, vertices, weights_at_vertices: false, shade };
        // Draws the map, if it is not drawn yet.
        plan.tam()?;
        let thresholds = plan.drawn_thresholds()?.is_some();
        Ok(Self { weights_at_vertices: at_vertices && !thresholds, ..plan })
    }

    /// The images of the tones.
    pub(crate) fn tam(&self) -> Result<&Tam, HatchError> {
        self.shade.map.tam()
    }

    /// The thresholds, if they are what is looked up.
    pub(crate) fn drawn_thresholds(&self) -> Result<Option<&Thresholds>, HatchError> {
        match self.shade.encoding {
            HatchEncoding::SixTones => Ok(None),
            HatchEncoding::Thresholds => self.shade.map.thresholds(),
        }
    }
}

//! What strokes need of a scene.

use crate::error::HarnessError;
use crate::scene::Scene;
use crate::style::{HatchEncoding, HatchMap, HatchMapping, HatchShade};
use npr_hatch::files::read_file;
use npr_hatch::store::{self, Stored};
use npr_hatch::{HatchError, Tam, Thresholds, density};
use std::path::Path;

/// What of a vertex tells where strokes lie.
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

/// What is decided about strokes before a picture is drawn.
#[derive(Clone, Debug)]
pub struct HatchPlan {
    /// The mapping that the model allows.
    pub mapping: HatchMapping,
    /// The length on the surface of one side of the map, in the model's units.
    pub tile: f64,
    /// Per vertex; empty if the mapping asks for nothing.
    pub vertices: Vec<HatchVertex>,
    /// Drawn.
    map: HatchMap,
    encoding: HatchEncoding,
}

impl HatchPlan {
    pub(crate) fn new(scene: &Scene, shade: &HatchShade) -> Result<Self, HarnessError> {
        let map = shade.map.clone();
        let tile = f64::from(shade.tile) * if scene.radius() > 0.0 { scene.radius() } else { 1.0 };
        let mapping = match shade.mapping {
            HatchMapping::Coordinates if scene.model.uvs.is_empty() => HatchMapping::Planes,
            other => other,
        };
        let vertices = match mapping {
            HatchMapping::Planes => Vec::new(),
            HatchMapping::Form => {
                let lines = scene.directions()?.iter();
                lines.map(|line| HatchVertex { diagonal: line.diagonal, others: line.others, octave: 0.0 }).collect()
            }
            HatchMapping::Coordinates => {
                let model = &scene.model;
                let seams = &scene.edges.representative;
                let octaves = density::octaves(&model.positions, &model.uvs, &model.faces, seams, tile as f32)?;
                let vertex = |octave| HatchVertex { diagonal: [0.0; 3], others: [0.0; 3], octave };
                octaves.into_iter().map(vertex).collect()
            }
        };
        let plan = Self { mapping, tile, vertices, map, encoding: shade.encoding };
        plan.map.tam()?;
        plan.drawn_thresholds()?;
        Ok(plan)
    }

    /// The images of the tones.
    pub(crate) fn tam(&self) -> Result<&Tam, HatchError> {
        self.map.tam()
    }

    /// The thresholds, if they are what is looked up.
    pub(crate) fn drawn_thresholds(&self) -> Result<Option<&Thresholds>, HatchError> {
        match self.encoding {
            HatchEncoding::SixTones => Ok(None),
            HatchEncoding::Thresholds => self.map.thresholds(),
        }
    }
}

/// The longest map, of 64 tones at 4096² with thresholds, has 1.4 GiB.
const MOST_BYTES: u64 = 3 << 29;

/// Reads what `npr tam` wrote: a regular file of at most 1.5 GiB.
///
/// # Errors
/// [`HarnessError::Read`], [`HarnessError::Map`].
pub fn read_map(path: &Path) -> Result<Stored, HarnessError> {
    let bytes = read_file(path, MOST_BYTES).map_err(|source| HarnessError::Read { path: path.to_owned(), source })?;
    store::from_bytes(&bytes).map_err(|source| HarnessError::Map { path: path.to_owned(), source })
}

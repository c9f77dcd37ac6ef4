//! The part of a plan for printed fins.

use crate::camera::Camera;
use crate::error::HarnessError;
use crate::scene::{Mesh, Object, Scene};
use crate::schema::{within, within_colors};
use glam::{DMat4, DVec2, Vec3};
use npr_outline::fin_printed::{FinDepth, FinView, PrintedFins, printed_fins};
use npr_outline::normal_format::NormalFormat;
use std::convert::Infallible;
use std::sync::Arc;

/// The settings of printed fins in a style.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedLines {
    /// The width of distant fins, px.
    pub width_px: f32,
    /// Display-referred colour.
    pub ink: Vec3,
    /// Whether widths follow the distance from the eye's plane instead of clip z, so that they are the same at every
    /// distance. Parallel views always do.
    pub eye_depth: bool,
    /// Whether fins are displaced as the text on listing 1 has it, which is the reverse of the listing.
    pub reversed: bool,
    /// How the face normals of the edges are stored.
    pub normals: NormalFormat,
}

impl Default for PrintedLines {
    /// Those of the style `printed-fins`.
    fn default() -> Self {
        Self { width_px: 2.0, ink: Vec3::ZERO, eye_depth: false, reversed: false, normals: NormalFormat::F32 }
    }
}

impl PrintedLines {
    pub(crate) fn validate(&self) -> Result<(), HarnessError> {
        within("a fin's width", self.width_px, 0.0, 256.0, "0..=256 px")?;
        within_colors("a component of the lines' ink", &self.ink.to_array())
    }
}

/// The printed fins of a scene.
#[derive(Clone, Debug)]
pub struct PrintedFinPlan {
    /// Per mesh: a fin for every edge.
    pub fins: Vec<Arc<PrintedFins>>,
    /// Their width and colour.
    pub style: PrintedLines,
}

/// The cache key of the fins.
#[derive(PartialEq)]
struct FinsKey(NormalFormat);

impl PrintedFinPlan {
    pub(crate) fn new(scene: &Scene, style: PrintedLines) -> Self {
        let of_mesh = |mesh: &Arc<Mesh>| {
            let make = || Ok::<_, Infallible>(printed_fins(mesh.model(), mesh.edges()).quantised(style.normals));
            let Ok(fins) = mesh.derived().get(FinsKey(style.normals), make);
            fins
        };
        Self { fins: scene.meshes().iter().map(of_mesh).collect(), style }
    }

    /// The view for an object's fins, in mesh space except for depth. `None` without faces.
    ///
    /// `size_px` is the size of the target; `scale` is the number of its px per px of the picture.
    pub(crate) fn view(
        &self,
        scene: &Scene,
        object: &Object,
        camera: &Camera,
        size_px: DVec2,
        scale: f64,
    ) -> Option<FinView> {
        let view = camera.fin_view(size_px, f64::from(self.style.width_px) * scale, scene.bounds()?);
        Some(FinView {
            clip_from_world: view.clip_from_world * DMat4::from(*object.scene_from_mesh()),
            eye: object.homogeneous(view.eye.extend(1.0)).truncate(),
            thickness: view.thickness / object.scale(),
            reversed: self.style.reversed,
            depth: if self.style.eye_depth { FinDepth::Eye } else { view.depth },
        })
    }
}

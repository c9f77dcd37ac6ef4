//! The part of a plan for inverted hulls.

use crate::camera::Camera;
use crate::error::HarnessError;
use crate::scene::{Mesh, Object, ObjectLines, Scene};
use crate::schema::{within, within_colors};
use glam::{DMat3, DMat4, DVec2, Vec3};
use npr_outline::hull::{Hull, HullNormals, HullView};
use std::convert::Infallible;
use std::sync::Arc;

/// The settings of inverted hulls in a style.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HullLines {
    /// How far the ink extends beyond a surface, px.
    pub width_px: f32,
    /// Display-referred colour.
    pub ink: Vec3,
    /// The normals along which vertices are displaced.
    pub normals: HullNormals,
}

impl HullLines {
    pub(crate) fn validate(&self) -> Result<(), HarnessError> {
        within("a hull's width", self.width_px, 0.0, 256.0, "0..=256 px")?;
        within_colors("a component of the hull's ink", &self.ink.to_array())
    }
}

/// The inverted hulls of a scene.
#[derive(Clone, Debug)]
pub struct HullPlan {
    /// Per mesh: its hull.
    pub hulls: Vec<Arc<Hull>>,
    /// Their width and colour.
    pub style: HullLines,
}

/// The cache key of the hulls.
#[derive(PartialEq)]
struct HullKey(HullNormals);

impl HullPlan {
    pub(crate) fn new(scene: &Scene, style: HullLines) -> Self {
        let of_mesh = |mesh: &Arc<Mesh>| {
            let make = || Ok::<_, Infallible>(Hull::new(mesh.model(), mesh.edges(), style.normals));
            let Ok(hull) = mesh.derived().get(HullKey(style.normals), make);
            hull
        };
        Self { hulls: scene.meshes().iter().map(of_mesh).collect(), style }
    }

    /// The objects that have a hull.
    pub(crate) fn objects<'a>(&self, scene: &'a Scene) -> impl Iterator<Item = &'a Object> + use<'a> {
        scene.objects().iter().filter(|object| object.lines != ObjectLines::None)
    }

    /// The view for an object's hull, from mesh space.
    ///
    /// `size_px` is the size of the target; `scale` is the number of its px per px of the picture.
    pub(crate) fn view(&self, object: &Object, camera: &Camera, size_px: DVec2, scale: f64) -> HullView {
        let view = camera.line_view(size_px);
        let [right, up, back] = camera.axes();
        let view_from_scene = DMat3::from_cols(right, up, back).transpose();
        HullView {
            clip_from_world: view.clip_from_world * DMat4::from(*object.scene_from_mesh()),
            // Times the scale, so that numbers of a very small or large object stay within f32.
            view_from_normal: view_from_scene * object.normal_matrix() * object.scale(),
            viewport_px: view.viewport_px,
            depth_per_px: view.depth_per_px,
            width_px: f64::from(self.style.width_px) * scale,
            mirrored: object.is_mirrored(),
        }
    }
}

//! A mesh placed in a scene.

use super::mesh::Mesh;
use crate::derived::Derived;
use glam::{DAffine3, DMat3, DVec3, DVec4, Vec3};
use npr_outline::line_style::LineStyle;
use std::sync::Arc;

/// The lines along the edges of an object. Lines found in the image cannot be set per object.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ObjectLines {
    /// The edge lines of the picture's style.
    #[default]
    OfStyle,
    /// No edge lines.
    None,
    /// A line style for this object. It has no effect if the picture's style draws no edge lines.
    Own(LineStyle),
}

/// The largest number of lights of a style.
pub const MAX_LIGHTS: usize = 8;

/// What an object is made from, where it has a mesh of its own.
#[derive(Clone)]
pub(super) struct Unseparated {
    pub mesh: usize,
    pub scene_from_mesh: DAffine3,
}

/// A mesh placed in a scene.
#[derive(Clone)]
pub struct Object {
    /// The name of the node in the file, or empty.
    pub name: String,
    /// The lines along its edges.
    pub lines: ObjectLines,
    pub(super) mesh: usize,
    /// What it is made from, if its mesh is one of its own.
    pub(super) unseparated: Option<Unseparated>,
    /// The index of its first material in the scene, and whether all of its faces use that material.
    pub(super) first_material: usize,
    pub(super) one_material: bool,
    pub(super) lights: Option<[usize; 2]>,
    placement: Placement,
    /// Data that techniques derive from the mesh if the transform does not preserve angles; cleared when the metric
    /// changes.
    of_shape: Arc<Derived>,
    /// The metric that this data was derived with.
    shape: DMat3,
}

/// A transform and the data derived from it.
#[derive(Clone, Copy, Debug)]
struct Placement {
    scene_from_mesh: DAffine3,
    mesh_from_scene: DAffine3,
    is_identity: bool,
    is_mirrored: bool,
    scale: f64,
    /// AᵀA / scale² for the linear part A: the identity if the transform preserves angles.
    metric: DMat3,
    keeps_angles: bool,
}

impl Placement {
    fn new(scene_from_mesh: DAffine3) -> Self {
        let determinant = scene_from_mesh.matrix3.determinant();
        let is_identity = scene_from_mesh == DAffine3::IDENTITY;
        let scale = if is_identity { 1.0 } else { determinant.abs().cbrt() };
        let linear = scene_from_mesh.matrix3 * (1.0 / scale);
        let metric = linear.transpose() * linear;
        Self {
            scene_from_mesh,
            mesh_from_scene: if is_identity { scene_from_mesh } else { scene_from_mesh.inverse() },
            is_identity,
            is_mirrored: determinant < 0.0,
            scale,
            metric,
            keeps_angles: is_near(&metric, &DMat3::IDENTITY),
        }
    }
}

/// Whether two metrics are equal up to the rounding of the f32 numbers in a file.
fn is_near(a: &DMat3, b: &DMat3) -> bool {
    a.abs_diff_eq(*b, 1e-5)
}

/// Whether a transform has an inverse whose rounding in f64 is of no importance.
pub(super) fn is_invertible(transform: &DAffine3) -> bool {
    let linear = transform.matrix3.to_cols_array();
    let largest = linear.iter().fold(0.0f64, |largest, x| largest.max(x.abs()));
    if !transform.is_finite() || largest == 0.0 {
        return false;
    }
    // The condition number, of a matrix whose squares and products are within f64.
    let unit = transform.matrix3 * (1.0 / largest);
    let norm = |matrix: &DMat3| matrix.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
    norm(&unit) * norm(&unit.inverse()) < 1e12
}

impl Object {
    pub(super) fn new(name: String, mesh: usize, first_material: usize, scene_from_mesh: DAffine3) -> Self {
        let placement = Placement::new(scene_from_mesh);
        Self {
            name,
            lines: ObjectLines::OfStyle,
            mesh,
            unseparated: None,
            first_material,
            one_material: false,
            lights: None,
            shape: placement.metric,
            placement,
            of_shape: Arc::default(),
        }
    }

    pub(super) fn place(&mut self, scene_from_mesh: DAffine3) {
        self.placement = Placement::new(scene_from_mesh);
        if !is_near(&self.placement.metric, &self.shape) {
            (self.of_shape, self.shape) = (Arc::default(), self.placement.metric);
        }
    }

    /// The data that techniques derive from the mesh as this object transforms it, and the matrix that transforms
    /// normals for it. All objects with angle-preserving transforms share the data of the mesh.
    pub(crate) fn derived<'a>(&'a self, mesh: &'a Mesh) -> (&'a Derived, DMat3) {
        if self.placement.keeps_angles {
            (mesh.derived(), DMat3::IDENTITY)
        } else {
            (&self.of_shape, self.normal_matrix())
        }
    }

    /// The index of its first material in the scene, and whether all of its faces use that material.
    pub(crate) fn first_material(&self) -> (usize, bool) {
        (self.first_material, self.one_material)
    }

    /// The two lights of the picture's style that a shade with two lights takes for it, if they were set
    /// ([`Scene::set_lights`](super::Scene::set_lights)).
    pub fn lights(&self) -> Option<[usize; 2]> {
        self.lights
    }

    /// The index of its mesh in the scene.
    pub fn mesh(&self) -> usize {
        self.mesh
    }

    /// The transform from mesh space to scene space.
    pub fn scene_from_mesh(&self) -> &DAffine3 {
        &self.placement.scene_from_mesh
    }

    /// Whether the transform is a reflection. Front faces stay front faces.
    pub fn is_mirrored(&self) -> bool {
        self.placement.is_mirrored
    }

    /// The uniform scale of the transform: the cube root of its volume ratio.
    pub fn scale(&self) -> f64 {
        self.placement.scale
    }

    /// The largest factor of its transform for lengths along an axis of the mesh.
    pub(super) fn largest_scale(&self) -> f64 {
        let DMat3 { x_axis, y_axis, z_axis } = self.placement.scene_from_mesh.matrix3;
        [x_axis, y_axis, z_axis].map(DVec3::length).into_iter().fold(0.0, f64::max)
    }

    /// Transforms a position from mesh space to scene space.
    pub fn point(&self, position: Vec3) -> DVec3 {
        let position = position.as_dvec3();
        if self.placement.is_identity { position } else { self.placement.scene_from_mesh.transform_point3(position) }
    }

    /// Transforms a normal from mesh space to scene space by the inverse transpose, preserving its length.
    pub fn normal(&self, normal: Vec3) -> DVec3 {
        let normal = normal.as_dvec3();
        if self.placement.is_identity {
            return normal;
        }
        let turned = self.normal_matrix() * normal;
        let length = turned.length();
        if length > 0.0 { turned * (normal.length() / length) } else { turned }
    }

    /// The inverse transpose of the transform's linear part.
    pub(crate) fn normal_matrix(&self) -> DMat3 {
        self.placement.mesh_from_scene.matrix3.transpose()
    }

    /// Transforms a ray from scene space to mesh space. The direction is not normalized, so t is the same in both
    /// spaces.
    pub(crate) fn ray(&self, origin: DVec3, direction: DVec3) -> (DVec3, DVec3) {
        if self.placement.is_identity {
            return (origin, direction);
        }
        let mesh_from_scene = &self.placement.mesh_from_scene;
        (mesh_from_scene.transform_point3(origin), mesh_from_scene.transform_vector3(direction))
    }

    /// Transforms a homogeneous point, such as the eye or a light, from scene space to mesh space.
    pub(crate) fn homogeneous(&self, point: DVec4) -> DVec4 {
        if self.placement.is_identity {
            return point;
        }
        let DAffine3 { matrix3, translation } = self.placement.mesh_from_scene;
        (matrix3 * point.truncate() + translation * point.w).extend(point.w)
    }

    /// The scene-space bounding box of a mesh-space box; tight if the transform maps axes to axes.
    pub(crate) fn box_around(&self, (low, high): (Vec3, Vec3)) -> (DVec3, DVec3) {
        placed_box(&self.placement.scene_from_mesh, (low.as_dvec3(), high.as_dvec3()))
    }
}

/// The axis-aligned bounding box of a transformed box.
pub(super) fn placed_box(transform: &DAffine3, (low, high): (DVec3, DVec3)) -> (DVec3, DVec3) {
    let DAffine3 { matrix3, translation } = *transform;
    let axes = [(matrix3.x_axis, low.x, high.x), (matrix3.y_axis, low.y, high.y), (matrix3.z_axis, low.z, high.z)];
    axes.into_iter().fold((translation, translation), |(least, most), (axis, low, high)| {
        (least + (axis * low).min(axis * high), most + (axis * low).max(axis * high))
    })
}

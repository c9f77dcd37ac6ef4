//! A mesh, placed in a scene.

use super::mesh::Mesh;
use crate::derived::Derived;
use glam::{DAffine3, DMat3, DVec3, DVec4, Vec3};
use npr_outline::line_style::LineStyle;
use std::sync::Arc;

/// The lines along the edges of an object. Lines found in the image are the same for all objects.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ObjectLines {
    /// Those of the picture's style.
    #[default]
    OfStyle,
    /// None.
    None,
    /// In a line style of the object's own, where the picture's style draws lines along edges.
    Own(LineStyle),
}

/// A mesh, placed in a scene.
#[derive(Clone)]
pub struct Object {
    /// The node's name in the file, or empty.
    pub name: String,
    /// Its lines along edges.
    pub lines: ObjectLines,
    pub(super) mesh: usize,
    /// The number of its first material among the scene's, and whether all of its faces have that.
    pub(super) first_material: usize,
    pub(super) one_material: bool,
    placement: Placement,
    /// What techniques derive of a mesh whose angles the transform changes; emptied when they change.
    of_shape: Arc<Derived>,
}

/// A transform with what is derived of it.
#[derive(Clone, Copy, Debug)]
struct Placement {
    scene_from_mesh: DAffine3,
    mesh_from_scene: DAffine3,
    is_identity: bool,
    is_mirrored: bool,
    scale: f64,
    /// The product of the linear part's transpose with itself, divided by the square of the scale: the identity where
    /// the transform keeps all angles.
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

/// Whether metrics are the same but for the rounding of a file's f32 numbers.
fn is_near(a: &DMat3, b: &DMat3) -> bool {
    a.abs_diff_eq(*b, 1e-5)
}

/// Whether a transform has an inverse that f64 can hold.
pub(super) fn is_invertible(transform: &DAffine3) -> bool {
    let axes = [transform.matrix3.x_axis, transform.matrix3.y_axis, transform.matrix3.z_axis];
    let box_volume: f64 = axes.iter().map(|axis| axis.length()).product();
    transform.is_finite() && transform.matrix3.determinant().abs() > 1e-9 * box_volume
}

impl Object {
    pub(super) fn new(name: String, mesh: usize, first_material: usize, scene_from_mesh: DAffine3) -> Self {
        let placement = Placement::new(scene_from_mesh);
        Self {
            name,
            lines: ObjectLines::OfStyle,
            mesh,
            first_material,
            one_material: false,
            placement,
            of_shape: Arc::default(),
        }
    }

    pub(super) fn place(&mut self, scene_from_mesh: DAffine3) {
        let placement = Placement::new(scene_from_mesh);
        if !is_near(&placement.metric, &self.placement.metric) {
            self.of_shape = Arc::default();
        }
        self.placement = placement;
    }

    /// What techniques derive of the mesh in the object's shape, and the inverse transpose that its angles are measured
    /// with: what all objects share whose transforms keep angles.
    pub(crate) fn derived<'a>(&'a self, mesh: &'a Mesh) -> (&'a Derived, DMat3) {
        if self.placement.keeps_angles {
            (mesh.derived(), DMat3::IDENTITY)
        } else {
            (&self.of_shape, self.normal_matrix())
        }
    }

    /// The number of its first material among the scene's, and whether all of its faces have that one.
    pub(crate) fn first_material(&self) -> (usize, bool) {
        (self.first_material, self.one_material)
    }

    /// The number of its mesh in the scene.
    pub fn mesh(&self) -> usize {
        self.mesh
    }

    /// From the positions of the mesh to those of the scene.
    pub fn scene_from_mesh(&self) -> &DAffine3 {
        &self.placement.scene_from_mesh
    }

    /// Whether the transform mirrors. The front of a face stays its front then.
    pub fn is_mirrored(&self) -> bool {
        self.placement.is_mirrored
    }

    /// The cube root of what the transform multiplies volumes by.
    pub fn scale(&self) -> f64 {
        self.placement.scale
    }

    /// A position of the mesh in the scene.
    pub fn point(&self, position: Vec3) -> DVec3 {
        let position = position.as_dvec3();
        if self.placement.is_identity { position } else { self.placement.scene_from_mesh.transform_point3(position) }
    }

    /// A normal of the mesh in the scene, of the same length, by the inverse transpose.
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
    fn normal_matrix(&self) -> DMat3 {
        self.placement.mesh_from_scene.matrix3.transpose()
    }

    /// A ray of the scene in the space of the mesh; distances along it are in the same units of its direction.
    pub(crate) fn ray(&self, origin: DVec3, direction: DVec3) -> (DVec3, DVec3) {
        if self.placement.is_identity {
            return (origin, direction);
        }
        let mesh_from_scene = &self.placement.mesh_from_scene;
        (mesh_from_scene.transform_point3(origin), mesh_from_scene.transform_vector3(direction))
    }

    /// A homogeneous point of the scene, such as an eye or a light, in the space of the mesh.
    pub(crate) fn homogeneous(&self, point: DVec4) -> DVec4 {
        if self.placement.is_identity {
            return point;
        }
        let DAffine3 { matrix3, translation } = self.placement.mesh_from_scene;
        (matrix3 * point.truncate() + translation * point.w).extend(point.w)
    }

    /// The box in the scene around a box of the mesh: exact where axes map to axes.
    pub(super) fn box_around(&self, (low, high): (Vec3, Vec3)) -> (DVec3, DVec3) {
        placed_box(&self.placement.scene_from_mesh, (low.as_dvec3(), high.as_dvec3()))
    }
}

/// The box around a placed box.
pub(super) fn placed_box(transform: &DAffine3, (low, high): (DVec3, DVec3)) -> (DVec3, DVec3) {
    let DAffine3 { matrix3, translation } = *transform;
    let axes = [(matrix3.x_axis, low.x, high.x), (matrix3.y_axis, low.y, high.y), (matrix3.z_axis, low.z, high.z)];
    axes.into_iter().fold((translation, translation), |(least, most), (axis, low, high)| {
        (least + (axis * low).min(axis * high), most + (axis * low).max(axis * high))
    })
}

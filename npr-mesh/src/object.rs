//! A mesh, placed.

use glam::DAffine3;

/// A mesh, placed.
///
/// The front of a face remains its front in a mirrored object: corners that are counter-clockwise in the mesh, seen
/// from outside, are clockwise in world space where the determinant of the transform is negative.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// The name of the node in the file, or that of the mesh where the node has none, or empty. Long names are cut.
    pub name: String,
    /// The index of the mesh, in a file that of `Loaded::meshes`.
    pub mesh: usize,
    /// Finite and affine; may mirror, shear, or be singular.
    pub world_from_mesh: DAffine3,
}

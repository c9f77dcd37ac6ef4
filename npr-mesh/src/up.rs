//! Which axis of a file points up.

use crate::Model;
use glam::{DAffine3, DMat3, DVec3, Vec3};

/// The axis of a file that points up. Everything after loading has Y up.
///
/// An axis is turned to +Y by the shortest rotation: Z by a quarter turn about X, so that −Y of the file comes to the front
/// (+Z), as exporters turn models for glTF; X by a quarter turn about Z. −Y is turned by half a turn about Z. All of them
/// exchange coordinates and change signs, so that no number is rounded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum UpAxis {
    /// +X.
    X,
    /// +Y: nothing is turned.
    #[default]
    Y,
    /// +Z.
    Z,
    /// −X.
    NegativeX,
    /// −Y.
    NegativeY,
    /// −Z.
    NegativeZ,
}

impl UpAxis {
    /// The rotation from the file's space to the space with Y up.
    pub fn rotation(self) -> DMat3 {
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
        // The images of the file's axes.
        let [of_x, of_y, of_z] = match self {
            Self::X => [y, -x, z],
            Self::Y => [x, y, z],
            Self::Z => [x, -z, y],
            Self::NegativeX => [-y, x, z],
            Self::NegativeY => [-x, -y, z],
            Self::NegativeZ => [x, z, -y],
        };
        DMat3::from_cols(of_x, of_y, of_z)
    }

    /// A point or a direction of the file, with Y up.
    pub fn turned(self, vector: DVec3) -> DVec3 {
        // The sum with zero makes a positive zero of a negative one.
        self.rotation() * vector + 0.0
    }

    /// A point or a direction with Y up, as it is in the file: the inverse of [`Self::turned`].
    pub fn turned_back(self, vector: DVec3) -> DVec3 {
        self.rotation().transpose() * vector + 0.0
    }

    /// Turns meshes and the transforms that place them: positions and normals of each mesh, as if the file had been written
    /// with Y up, so that what depends on a mesh's own axes, such as hatching, is the same too. The transforms are those of
    /// [`Object::world_from_mesh`](crate::Object::world_from_mesh).
    pub fn turn<'a>(
        self,
        meshes: impl IntoIterator<Item = &'a mut Model>,
        transforms: impl IntoIterator<Item = &'a mut DAffine3>,
    ) {
        if self == Self::Y {
            return;
        }
        let turned = |vector: &mut Vec3| *vector = self.turned(vector.as_dvec3()).as_vec3();
        for mesh in meshes {
            mesh.positions.iter_mut().for_each(turned);
            mesh.normals.iter_mut().for_each(turned);
        }
        let rotation = self.rotation();
        for transform in transforms {
            transform.matrix3 = rotation * transform.matrix3 * rotation.transpose();
            transform.translation = self.turned(transform.translation);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [(UpAxis, DVec3); 6] = [
        (UpAxis::X, DVec3::X),
        (UpAxis::Y, DVec3::Y),
        (UpAxis::Z, DVec3::Z),
        (UpAxis::NegativeX, DVec3::NEG_X),
        (UpAxis::NegativeY, DVec3::NEG_Y),
        (UpAxis::NegativeZ, DVec3::NEG_Z),
    ];

    #[test]
    fn each_axis_is_turned_up_by_a_rotation_without_rounding() {
        let point = DVec3::new(0.1, -2.3e5, 7.7);
        for (up, axis) in ALL {
            assert_eq!(up.turned(axis), DVec3::Y, "{up:?}");
            assert_eq!(up.rotation().determinant(), 1.0, "{up:?}");
            assert_eq!(up.turned_back(up.turned(point)), point, "{up:?}");
        }
        // As exporters write a model with Z up for glTF.
        assert_eq!(UpAxis::Z.turned(point), DVec3::new(point.x, point.z, -point.y));
    }

    #[test]
    fn placed_meshes_are_where_their_placed_points_are_turned_to() {
        let mesh = crate::embedded::cube();
        let matrix3 = DMat3::from_cols_array(&[0.5, 2.0, -1.0, 0.25, -3.0, 1.5, 4.0, 0.0, 1.0]);
        let placed = DAffine3 { matrix3, translation: DVec3::new(3.0, -4.0, 5.0) };
        for (up, _) in ALL {
            let (mut turned, mut transform) = (mesh.clone(), placed);
            up.turn([&mut turned], [&mut transform]);
            for (before, after) in mesh.positions.iter().zip(&turned.positions) {
                let there = transform.transform_point3(after.as_dvec3());
                assert_eq!(there, up.turned(placed.transform_point3(before.as_dvec3())), "{up:?}");
            }
            let normals = mesh.normals.iter().map(|normal| up.turned(normal.as_dvec3()).as_vec3());
            assert!(turned.normals.iter().copied().eq(normals), "{up:?}");
            assert_eq!(turned.faces, mesh.faces);
        }
    }
}

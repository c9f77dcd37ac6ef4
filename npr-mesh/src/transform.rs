//! Affine transforms of models.

use crate::{Model, SideVisibility};
use glam::{DAffine3, DMat3, DVec3, Vec3};

impl Model {
    /// The model in another space.
    ///
    /// Positions are transformed in f64 and limited to the range of f32. Normals are transformed by the inverse
    /// transpose and normalised. If the transform is singular, they are zero ([`crate::normals::fill_missing`] makes
    /// new ones). If it mirrors, the second and the third corner of each face are exchanged, so that faces remain
    /// counter-clockwise seen from outside.
    #[must_use]
    pub fn transformed(mut self, transform: &DAffine3) -> Self {
        let largest = DVec3::splat(f32::MAX.into());
        for position in &mut self.positions {
            *position = transform.transform_point3(position.as_dvec3()).clamp(-largest, largest).as_vec3();
        }
        let turn = Turn::new(&transform.matrix3);
        self.normals.iter_mut().for_each(|normal| *normal = turn.normal(*normal));
        if turn.mirrors {
            self.faces.iter_mut().for_each(|face| face.swap(1, 2));
            self.side_visibility.iter_mut().for_each(|sides| *sides = SideVisibility::reversed(*sides));
        }
        self
    }
}

/// The effect of a linear map on directions.
pub(crate) struct Turn {
    /// The inverse transpose times a positive number, or zero if the map is singular.
    normal_from_normal: DMat3,
    pub mirrors: bool,
}

impl Turn {
    pub fn new(linear: &DMat3) -> Self {
        let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
        // The columns of the inverse transpose times the determinant.
        let cofactors = [y.cross(z), z.cross(x), x.cross(y)];
        let determinant = x.dot(cofactors[0]);
        let sign = if determinant == 0.0 || !determinant.is_finite() { 0.0 } else { determinant.signum() };
        let [x, y, z] = cofactors.map(|c| c * sign);
        Self { normal_from_normal: DMat3::from_cols(x, y, z), mirrors: determinant < 0.0 }
    }

    /// A unit normal, or zero without a direction.
    pub fn normal(&self, normal: Vec3) -> Vec3 {
        (self.normal_from_normal * normal.as_dvec3()).try_normalize().map_or(Vec3::ZERO, DVec3::as_vec3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    /// A face with the outward normal (1, 2, 2) / 3, and its normal by the order of its corners.
    fn model() -> Model {
        let normal = Vec3::new(1.0, 2.0, 2.0) / 3.0;
        let [a, b] = [Vec3::new(2.0, 1.0, -2.0), Vec3::new(-2.0, 2.0, -1.0)];
        let origin = Vec3::new(3.0, -1.0, 5.0);
        assert!(a.cross(b).normalize().distance(normal) < 1e-6);
        Model {
            positions: vec![origin, origin + a, origin + b],
            normals: vec![normal; 3],
            faces: vec![[0, 1, 2]],
            ..Model::default()
        }
    }

    fn normal_by_corners(model: &Model) -> Vec3 {
        let [a, b, c] = model.faces[0].map(|vertex| model.positions[vertex as usize].as_dvec3());
        (b - a).cross(c - a).normalize().as_vec3()
    }

    #[test]
    fn normals_remain_perpendicular_and_outside() {
        let shear = DMat3::from_cols(DVec3::X, dvec3(3.0, 1.0, 0.0), dvec3(-1.0, 0.5, 2.0));
        let mirror = DMat3::from_diagonal(dvec3(-1.0, 1.0, 1.0));
        for (linear, faces) in [
            (DMat3::IDENTITY, [0, 1, 2]),
            (shear, [0, 1, 2]),
            (mirror, [0, 2, 1]),
            (mirror * shear, [0, 2, 1]),
            (mirror * 1e-20, [0, 2, 1]),
            (-mirror * shear * 1e20, [0, 1, 2]),
        ] {
            let model = model().transformed(&DAffine3 { matrix3: linear, translation: DVec3::ZERO });
            assert_eq!(model.faces, [faces], "{linear}");
            for normal in &model.normals {
                assert!(normal.distance(normal_by_corners(&model)) < 1e-6, "{linear}: {normal}");
            }
        }
        assert_eq!(model().transformed(&DAffine3::IDENTITY).positions, model().positions);
    }

    #[test]
    fn positions_are_computed_in_f64() {
        // In f32 the sum of 1e9 and 3 would lose the 3.
        let far = DAffine3::from_translation(dvec3(1e9, 0.0, 0.0));
        let back = DAffine3::from_scale(DVec3::splat(2.0)) * DAffine3::from_translation(dvec3(-1e9, 0.0, 0.0)) * far;
        let expected: Vec<Vec3> = model().positions.iter().map(|p| *p * 2.0).collect();
        assert_eq!(model().transformed(&back).positions, expected);
        let beyond = model().transformed(&DAffine3::from_translation(dvec3(1e300, -1e300, 0.0)));
        assert_eq!(beyond.positions[0], Vec3::new(f32::MAX, -f32::MAX, 5.0));
    }

    #[test]
    fn a_singular_transform_leaves_no_normals() {
        let mut flat = model().transformed(&DAffine3::from_scale(dvec3(1.0, 0.0, 1.0)));
        assert_eq!((flat.normals.clone(), flat.faces.clone()), (vec![Vec3::ZERO; 3], vec![[0, 1, 2]]));
        crate::normals::fill_missing(&mut flat, 1.0);
        assert_eq!(flat.normals, [normal_by_corners(&flat); 3]);
        let point = model().transformed(&DAffine3::from_scale(DVec3::ZERO));
        assert_eq!((point.positions, point.normals), (vec![Vec3::ZERO; 3], vec![Vec3::ZERO; 3]));
    }
}

//! Lines as tensors, which can be interpolated.

use glam::{DMat3, DVec3, Vec3};

/// The tensor d dᵀ of a unit vector d: an undirected line, equal for d and -d.
///
/// Weighted sums, such as tensors interpolated over a triangle, are symmetric and positive semidefinite;
/// [`LineTensor::direction`] is their principal direction.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct LineTensor {
    /// The elements xx, yy, zz.
    pub diagonal: [f32; 3],
    /// The elements xy, xz, yz.
    pub others: [f32; 3],
}

/// The number of squarings in [`LineTensor::direction`], which give the 4096th power of the tensor. If the two largest
/// eigenvalues differ by 1 %, the contribution of the second is e^-40.
const SQUARINGS: u32 = 12;

impl LineTensor {
    /// The tensor of a unit vector.
    pub fn from_direction(d: Vec3) -> Self {
        Self { diagonal: (d * d).to_array(), others: [d.x * d.y, d.x * d.z, d.y * d.z] }
    }

    /// A unit eigenvector of the largest eigenvalue, of arbitrary sign. Zero if the tensor is zero or not finite.
    ///
    /// ```
    /// use glam::Vec3;
    /// use npr_hatch::field::LineTensor;
    /// let d = Vec3::new(0.6, 0.0, -0.8);
    /// let back = LineTensor::from_direction(d).direction();
    /// assert!((back.dot(d).abs() - 1.0).abs() < 1e-6);
    /// ```
    pub fn direction(&self) -> Vec3 {
        let ([xx, yy, zz], [xy, xz, yz]) = (self.diagonal.map(f64::from), self.others.map(f64::from));
        let mut power = DMat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz]);
        // The columns of high powers converge to the eigenvector.
        for _ in 0..SQUARINGS {
            let largest = power.abs().to_cols_array().into_iter().fold(0.0, f64::max);
            if !(largest > 0.0 && largest.is_finite()) {
                return Vec3::ZERO;
            }
            power *= 1.0 / largest;
            power *= power;
        }
        let longest = [power.x_axis, power.y_axis, power.z_axis]
            .into_iter()
            .fold(DVec3::ZERO, |a, b| if b.length_squared() > a.length_squared() { b } else { a });
        longest.normalize_or_zero().as_vec3()
    }
}

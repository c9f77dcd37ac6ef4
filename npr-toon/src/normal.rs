//! Where on a triangle the light is computed, and from which normal.
//!
//! A rasteriser interpolates linearly between a triangle's corners. A normal that is interpolated so is shorter than
//! 1: halfway between unit normals that are θ apart its length is cos(θ/2), and N·L shrinks by as much. At 60° the
//! 0.8 of Card & Mitchell's bright band is reached up to 22° from the light instead of 37°; from 74° on there is no
//! bright band in the middle of the edge at all. The cartoon renderer's figure 1 draws this; its normalising cube map
//! mends it, as does [`crate::toon_n_dot_l`].

use glam::DVec3;

use crate::{toon_n_dot_l, toon_n_dot_l_interpolated};

/// What becomes of a triangle's three normals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum NormalUse {
    /// N·L at the corners, interpolated. The cheapest: one dot product a vertex and one interpolated number. N·L is
    /// linear within each triangle, so borders are straight in it and bend at its edges, and a bright spot inside of
    /// a triangle is lost.
    PerVertex,
    /// Normals and light vectors of unit length at the corners, interpolated, and multiplied as they are (Card &
    /// Mitchell, listing 3). Six interpolated numbers, three for a directional light, and one dot product a pixel.
    /// Bright bands shrink between the corners.
    Interpolated,
    /// Interpolated, brought to unit length, multiplied (the cartoon renderer's listing 2). On top of
    /// [`NormalUse::Interpolated`] one dot product, one reciprocal root and three multiplications a vector and pixel.
    #[default]
    PerPixel,
}

/// N·L at a point of a triangle, -1..=1.
///
/// `normals` and `to_lights` are those of its corners, of any length; a zero vector gives 0 there. `weights` are
/// the point's barycentric coordinates, which sum to 1.
pub fn toon_n_dot_l_across(how: NormalUse, normals: [DVec3; 3], to_lights: [DVec3; 3], weights: [f64; 3]) -> f64 {
    let units = |vectors: [DVec3; 3]| vectors.map(DVec3::normalize_or_zero);
    let mean = |vectors: [DVec3; 3]| -> DVec3 { (0..3).map(|i| vectors[i] * weights[i]).sum() };
    let (normals, to_lights) = (units(normals), units(to_lights));
    match how {
        NormalUse::PerVertex => (0..3).map(|i| weights[i] * toon_n_dot_l(normals[i], to_lights[i])).sum(),
        NormalUse::Interpolated => toon_n_dot_l_interpolated(mean(normals), mean(to_lights)),
        NormalUse::PerPixel => toon_n_dot_l(mean(normals), mean(to_lights)),
    }
}

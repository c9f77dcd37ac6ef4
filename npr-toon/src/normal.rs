//! Diffuse lighting per vertex, from interpolated normals, and from renormalised normals.
//!
//! A rasteriser interpolates linearly between the corners of a triangle, which makes normals shorter than 1: halfway
//! between unit normals at an angle θ the length is cos(θ/2), and N·L decreases by the same factor. At θ = 60° the
//! threshold 0.8 of Card & Mitchell's bright band is reached up to 22° from the light instead of 37°; from θ = 74° on
//! there is no bright band in the middle of the edge. Figure 1 of *The Evolution of a Cartoon Renderer* shows this
//! effect. Its normalisation cube map corrects it, as does [`crate::toon_n_dot_l`].

use glam::DVec3;

use crate::{toon_n_dot_l, toon_n_dot_l_interpolated};

/// Where N·L is evaluated and whether normals are renormalised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum NormalUse {
    /// N·L is evaluated at the vertices and interpolated: one dot product per vertex and one interpolated scalar. N·L is
    /// then linear within each triangle, so borders are straight lines that bend at triangle edges, and highlights inside
    /// a triangle are lost.
    PerVertex,
    /// Unit normals and light vectors are interpolated and their dot product is taken per pixel without renormalisation
    /// (Card & Mitchell 2002, listing 3): six interpolated scalars, or three for a directional light. Bright bands shrink
    /// between the vertices.
    Interpolated,
    /// Interpolated vectors are renormalised per pixel (*The Evolution of a Cartoon Renderer*, listing 2). In addition to
    /// [`NormalUse::Interpolated`] this costs one dot product, one reciprocal square root and three multiplications per
    /// vector and pixel.
    #[default]
    PerPixel,
}

/// N·L at a point of a triangle, -1..=1.
///
/// `normals` and `to_lights` are the vectors at its corners, of any length; a zero vector contributes 0. `weights` are
/// the barycentric coordinates of the point, which sum to 1.
pub fn toon_n_dot_l_across(
    normal_use: NormalUse,
    normals: [DVec3; 3],
    to_lights: [DVec3; 3],
    weights: [f64; 3],
) -> f64 {
    let units = |vectors: [DVec3; 3]| vectors.map(DVec3::normalize_or_zero);
    let mean = |vectors: [DVec3; 3]| -> DVec3 { (0..3).map(|i| vectors[i] * weights[i]).sum() };
    let (normals, to_lights) = (units(normals), units(to_lights));
    match normal_use {
        NormalUse::PerVertex => (0..3).map(|i| weights[i] * toon_n_dot_l(normals[i], to_lights[i])).sum(),
        NormalUse::Interpolated => toon_n_dot_l_interpolated(mean(normals), mean(to_lights)),
        NormalUse::PerPixel => toon_n_dot_l(mean(normals), mean(to_lights)),
    }
}

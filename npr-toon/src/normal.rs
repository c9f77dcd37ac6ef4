//! Diffuse lighting per vertex, from interpolated normals, from renormalised normals, and per face.
//!
//! A rasteriser interpolates linearly between the corners of a triangle, which makes normals shorter than 1: halfway
//! between unit normals at an angle θ the length is cos(θ/2), and N·L decreases by the same factor. At θ = 60° the
//! threshold 0.8 of Card & Mitchell's bright band is reached up to 22° from the light instead of 37°; from θ = 74° on
//! there is no bright band in the middle of the edge. Figure 1 of *The Evolution of a Cartoon Renderer* shows this
//! effect. Its normalisation cube map corrects it, as does [`crate::toon_n_dot_l`].
//!
//! The same article names a way without any interpolation, after Claes: a constant colour for each polygon, better where
//! polygons are subdivided. [`NormalUse::PerFace`] has one value of N·L per face, [`NormalUse::PerSubdividedFace`] one per
//! piece of a triangle ([`toon_piece_centroid`]). Borders between tones then follow the edges of faces or pieces.

use glam::DVec3;

use crate::{ToonError, toon_n_dot_l, toon_n_dot_l_interpolated};

/// The largest number of divisions of [`NormalUse::PerSubdividedFace`].
pub const MAX_DIVISIONS: u32 = 64;

/// The default number of divisions of [`NormalUse::PerSubdividedFace`].
pub const DIVISIONS: u32 = 4;

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
    /// One value of N·L per face: of the face's own normal, at its centroid. A face is a polygon where the model has
    /// polygons, else a triangle.
    PerFace,
    /// One value of N·L per piece of a triangle. Each side is divided into this many parts, 1..=[`MAX_DIVISIONS`], which
    /// makes the square of it pieces of equal area. N·L is that of the interpolated and renormalised normal at the centroid
    /// of the piece. With more divisions the result approaches [`NormalUse::PerPixel`].
    PerSubdividedFace(u32),
}

impl NormalUse {
    /// Whether N·L is constant over a face or over pieces of it.
    pub fn is_constant(self) -> bool {
        matches!(self, Self::PerFace | Self::PerSubdividedFace(_))
    }

    /// Checks the number of divisions.
    pub fn validate(self) -> Result<(), ToonError> {
        match self {
            Self::PerSubdividedFace(divisions) if !(1..=MAX_DIVISIONS).contains(&divisions) => {
                Err(ToonError::Divisions { divisions, max: MAX_DIVISIONS })
            }
            _ => Ok(()),
        }
    }
}

/// The barycentric coordinates of the centroid of the piece of a triangle that contains a point.
///
/// The sides of the triangle are divided into `divisions` equal parts, at least 1; lines parallel to the sides through the
/// ends of the parts divide the triangle into `divisions`² congruent pieces, of which those along a side alternate between
/// upright and inverted. `weights` are the barycentric coordinates of the point. A point outside the triangle belongs to a
/// piece next to it.
///
/// ```
/// use glam::DVec3;
/// use npr_toon::normal::toon_piece_centroid;
/// let near = |weights: [f64; 3], divisions, centroid: [f64; 3]| {
///     let found = toon_piece_centroid(DVec3::from_array(weights), divisions);
///     assert!(found.abs_diff_eq(DVec3::from_array(centroid) / 6.0, 1e-15), "{found}");
/// };
/// near([0.9, 0.1, 0.0], 1, [2.0, 2.0, 2.0]);
/// // An upright piece at the first corner, and the inverted one in the middle.
/// near([0.9, 0.1, 0.0], 2, [4.0, 1.0, 1.0]);
/// near([0.4, 0.4, 0.2], 2, [2.0, 2.0, 2.0]);
/// ```
pub fn toon_piece_centroid(weights: DVec3, divisions: u32) -> DVec3 {
    let count = f64::from(divisions);
    // Columns and rows along the second and the third coordinate. Each cell of this grid is an upright and an inverted piece;
    // the last cell of each row has only the upright one.
    let (x, y) = (weights.y * count, weights.z * count);
    let column = x.floor().clamp(0.0, count - 1.0);
    let row = y.floor().clamp(0.0, count - 1.0 - column);
    let inverted = (x - column) + (y - row) > 1.0 && column + row < count - 1.0;
    let inset = if inverted { 2.0 / 3.0 } else { 1.0 / 3.0 };
    let (second, third) = ((column + inset) / count, (row + inset) / count);
    DVec3::new(1.0 - second - third, second, third)
}

/// N·L at a point of a triangle, -1..=1.
///
/// `normals` and `to_lights` are the vectors at its corners; a zero vector contributes 0. `weights` are the barycentric
/// coordinates of the point, which sum to 1. `face_normal` is the normal of the face's plane, which only
/// [`NormalUse::PerFace`] reads. Vectors may have any length, except that the two ways that light faces or pieces at their
/// centroids take the mean of `to_lights` as they are, which is the vector at the centroid if they reach from the corners to
/// the light. The centroid is here that of the triangle.
pub fn toon_n_dot_l_across(
    normal_use: NormalUse,
    face_normal: DVec3,
    normals: [DVec3; 3],
    to_lights: [DVec3; 3],
    weights: [f64; 3],
) -> f64 {
    let units = |vectors: [DVec3; 3]| vectors.map(DVec3::normalize_or_zero);
    let mean = |vectors: [DVec3; 3], weights: [f64; 3]| -> DVec3 { (0..3).map(|i| vectors[i] * weights[i]).sum() };
    let unit_normals = units(normals);
    match normal_use {
        NormalUse::PerVertex => (0..3).map(|i| weights[i] * toon_n_dot_l(normals[i], to_lights[i])).sum(),
        NormalUse::Interpolated => {
            toon_n_dot_l_interpolated(mean(unit_normals, weights), mean(units(to_lights), weights))
        }
        NormalUse::PerPixel => toon_n_dot_l(mean(unit_normals, weights), mean(units(to_lights), weights)),
        NormalUse::PerFace => toon_n_dot_l(face_normal, to_lights.iter().sum()),
        NormalUse::PerSubdividedFace(divisions) => {
            let centroid = toon_piece_centroid(weights.into(), divisions).to_array();
            toon_n_dot_l(mean(unit_normals, centroid), mean(to_lights, centroid))
        }
    }
}

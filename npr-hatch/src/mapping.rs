//! Texture coordinates for surfaces without, or with uneven, texture coordinates: seamless and tone-preserving.
//!
//! A surface is covered by several hatchings, each of which fits a part of it: one per projection plane, per direction and
//! per scale. Adjacent hatchings overlap. Alpha blending would draw gray strokes in the overlap, so every hatching is drawn
//! *lighter* instead: where the tone t is requested, a hatching of weight w gets the tone t^w ([`hatch_share_tone`]), and the
//! results are multiplied. Since the weights sum to 1, the product of the t^w is t, provided that the strokes of different
//! hatchings are placed independently, as in different sections and rotations of a map. In the transition the strokes of
//! one hatching become fewer while those of the other increase; no stroke fades. Strokes are nested, so those that remain
//! do not move.
//!
//! # Planes
//!
//! [`hatch_plane_weights`]: the weights of the projections along the three axes by the normal. A single projection is used
//! where the normal is within 23.6° of an axis.
//!
//! # Directions
//!
//! The strokes of a projection are parallel. To follow the form, they are rotated by one of [`HATCH_DIRECTIONS`] angles according
//! to a field of directions at the vertices ([`crate::field`]). The field consists of undirected lines, so it is given as
//! the tensor d dᵀ, which can be interpolated. Projected along an axis, an element and a difference of elements give the
//! doubled angle ([`hatch_doubled_angle`]), which is between two of the rotations ([`hatch_direction_step`]). Each rotated hatching covers
//! its whole plane, so strokes are not cut and no parametrisation is needed. Strokes are straight. At its centre a stroke
//! deviates from the field by at most 7.5° where its hatching has a weight of 1/2 or more, and by at most 9.4° elsewhere.
//!
//! # Scales
//!
//! The texel density of a model's texture coordinates varies. [`hatch_octave`] scales them by a power of two, which keeps
//! them seamless where they wrap, according to the density at the vertices ([`crate::density`]); mip levels do the rest.

use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// The number of stroke directions, 15° apart over half a turn.
pub const HATCH_DIRECTIONS: u32 = 12;

/// The weights of the projections along x, y and z for a unit normal: the cubes of the amounts by which its absolute
/// components exceed 0.4, normalised to a sum of 1. A zero normal gives (0, 0, 1).
pub fn hatch_plane_weights(normal: DVec3) -> DVec3 {
    let above = (normal.abs() - 0.4).max(DVec3::ZERO);
    let cubes = above * above * above;
    let sum = cubes.element_sum();
    if sum > 0.0 { cubes / sum } else { DVec3::Z }
}

/// The projection of a position or vector along an axis: 0 for x, 1 for y, 2 for z. In the planes that contain the y axis
/// the second coordinate is y.
pub fn hatch_plane(position: DVec3, axis: u32) -> DVec2 {
    match axis {
        0 => DVec2::new(position.z, position.y),
        1 => DVec2::new(position.x, position.z),
        _ => DVec2::new(position.x, position.y),
    }
}

/// The direction of a field projected along an axis, as the cosine and sine of twice its angle in [`hatch_plane`] times the
/// squared length of the projection. `diagonal` holds the elements xx, yy, zz of the tensor, `others` xy, xz, yz.
pub fn hatch_doubled_angle(diagonal: DVec3, others: DVec3, axis: u32) -> DVec2 {
    match axis {
        0 => DVec2::new(diagonal.z - diagonal.y, 2.0 * others.z),
        1 => DVec2::new(diagonal.x - diagonal.z, 2.0 * others.y),
        _ => DVec2::new(diagonal.x - diagonal.y, 2.0 * others.x),
    }
}

/// Two consecutive hatchings of a series and the weight of the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HatchBlend {
    /// The index of the first hatching; the second has the next index.
    pub first: i32,
    /// The weight of the second hatching, 0..=1.
    pub share: f64,
}

/// The two directions next to a doubled angle ([`hatch_doubled_angle`]). Indices are 0..[`HATCH_DIRECTIONS`], and the last direction is
/// followed by direction 0. A zero vector gives direction 0 with a share of 0.
pub fn hatch_direction_step(doubled: DVec2) -> HatchBlend {
    if doubled == DVec2::ZERO {
        return HatchBlend { first: 0, share: 0.0 };
    }
    // The angle is doubled, so a full turn covers each direction once. `turns` is within 6..=18.
    let turns = (doubled.y.atan2(doubled.x) / (2.0 * PI) + 1.0) * f64::from(HATCH_DIRECTIONS);
    let HatchBlend { first, share } = hatch_octave(turns);
    HatchBlend { first: first % HATCH_DIRECTIONS as i32, share }
}

/// The two integers next to a number, and the weight of the greater. The transition is limited to the middle quarter of
/// the interval, so that elsewhere a single hatching is drawn.
///
/// ```
/// use npr_hatch::mapping::hatch_octave;
/// let [before, at, after] = [2.3, 2.5, 2.7].map(|octave| hatch_octave(octave).share);
/// assert_eq!((before, at, after), (0.0, 0.5, 1.0));
/// ```
pub fn hatch_octave(octave: f64) -> HatchBlend {
    let whole = octave.floor();
    HatchBlend { first: whole as i32, share: ((octave - whole - 0.5) * 4.0 + 0.5).clamp(0.0, 1.0) }
}

/// A position of a plane rotated by -`turn` · 15°, so that the strokes of a map that is looked up there run in the
/// direction with the index `turn`.
pub fn hatch_rotate(position: DVec2, turn: i32) -> DVec2 {
    let angle = f64::from(turn) * (PI / f64::from(HATCH_DIRECTIONS));
    // The sine is computed as a cosine, so that a quarter turn is exact on every machine.
    let (sin, cos) = ((angle - FRAC_PI_2).cos(), angle.cos());
    DVec2::new(cos * position.x + sin * position.y, cos * position.y - sin * position.x)
}

/// The offset in the map of the hatching with this index, 0..1, so that different hatchings show different texels.
pub fn hatch_offset(number: i32) -> DVec2 {
    // Multiples of the reciprocal of the plastic number and of its square, a 2D low-discrepancy sequence (M. Roberts, "The
    // Unreasonable Effectiveness of Quasirandom Sequences", 2018).
    (DVec2::new(0.754_877_666_246_692_8, 0.569_840_290_998_053_3) * f64::from(number)).fract_gl()
}

/// The tone of a hatching of weight `share`, tone^share, so that the product over all hatchings has the tone. Both arguments
/// are within 0..=1.
pub fn hatch_share_tone(tone: f64, share: f64) -> f64 {
    if share < 1.0 { tone.max(1e-6).powf(share) } else { tone }
}

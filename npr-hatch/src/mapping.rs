//! Texture coordinates for surfaces that have none, or uneven ones, without tears and without changing the tone.
//!
//! A surface is covered by several hatchings, each of which is right for a part of it: one for each of three planes, for
//! each of twelve directions, for each scale. Where two meet, one goes over into the other. Blending them would draw both
//! at half strength, gray. Here every hatching is made *lighter*: one that counts for the share w of a place where the
//! tone t is wanted gets the tone t^w ([`hatch_share`]), and what one leaves as paper the next draws on, so that the
//! picture is their product. Since shares add up to 1, so do exponents: the product of the t^w is t, if strokes of different
//! hatchings lie independently of each other, as different cut-outs and rotations of a map do. So strokes do not fade
//! from one hatching into the other: those of one get fewer, while others come in between, and strokes are nested, so that
//! those that are there stay.
//!
//! # Planes
//!
//! [`hatch_plane_weights`]: shares of projections along the three axes by the normal; one alone wherever the normal
//! is within 23.6° of an axis.
//!
//! # Directions
//!
//! A projection's strokes run one way. For strokes that follow the form, turn them: by one of [`HATCH_TURNS`] angles, by a
//! field of directions ([`crate::field`]) at the vertices. A field has lines, not vectors (a direction and
//! its opposite are one), so it is given as the tensor d dᵀ, which may be interpolated; seen along an axis, two of its
//! elements and a difference are the doubled angle ([`hatch_doubled`]), and that is between two of the turns
//! ([`hatch_turn`]). Each turned hatching covers its whole plane, so nothing is cut, and no parametrisation has to be
//! found. A stroke is straight, and at its middle at most 7.5° off its direction where its hatching counts for half or
//! more, and 9.4° where it counts at all.
//!
//! # Scales
//!
//! Texture coordinates have as many texels for an area as whoever made them found right. [`hatch_octave`] multiplies
//! them by a power of two, so that they still close where they wrap, by what the vertices' density asks for
//! ([`crate::density`]); levels do the rest.

use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Into how many directions strokes are turned, 15° apart: half a turn has all of them.
pub const HATCH_TURNS: u32 = 12;

/// The share of each axis' projection at a normal of unit length: cubes of how far its component is above 0.4, together
/// 1. Without a normal, all of the last.
pub fn hatch_plane_weights(normal: DVec3) -> DVec3 {
    let above = (normal.abs() - 0.4).max(DVec3::ZERO);
    let cubes = above * above * above;
    let sum = cubes.element_sum();
    if sum > 0.0 { cubes / sum } else { DVec3::Z }
}

/// A point, or a vector, as it is seen along an axis, 0 x, 1 y, 2 z: horizontal, then vertical for the upright planes.
pub fn hatch_plane(at: DVec3, axis: u32) -> DVec2 {
    match axis {
        0 => DVec2::new(at.z, at.y),
        1 => DVec2::new(at.x, at.z),
        _ => DVec2::new(at.x, at.y),
    }
}

/// The direction of a field as it is seen along an axis: cosine and sine of twice its angle in [`hatch_plane`], times what
/// is left of its square. `diagonal` is xx, yy, zz of the tensor, `others` xy, xz, yz.
pub fn hatch_doubled(diagonal: DVec3, others: DVec3, axis: u32) -> DVec2 {
    match axis {
        0 => DVec2::new(diagonal.z - diagonal.y, 2.0 * others.z),
        1 => DVec2::new(diagonal.x - diagonal.z, 2.0 * others.y),
        _ => DVec2::new(diagonal.x - diagonal.y, 2.0 * others.x),
    }
}

/// Two hatchings that follow each other in a row of them, and the share of the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HatchStep {
    /// The first one's number; the second one's is the next.
    pub first: i32,
    /// 0..=1.
    pub share: f64,
}

/// The two turns on both sides of a direction, of [`hatch_doubled`]; numbers are 0..[`HATCH_TURNS`], and the one after
/// the last is 0. Without a direction, the first.
pub fn hatch_turn(doubled: DVec2) -> HatchStep {
    if doubled == DVec2::ZERO {
        return HatchStep { first: 0, share: 0.0 };
    }
    // Twice the angle, so a whole turn has them all once.
    let turns = (doubled.y.atan2(doubled.x) / (2.0 * PI) + 1.0) * f64::from(HATCH_TURNS);
    let HatchStep { first, share } = hatch_octave(turns);
    HatchStep { first: first % HATCH_TURNS as i32, share }
}

/// The two whole numbers on both sides of a number, and the share of the greater. The step from one to the other takes
/// the middle quarter alone: elsewhere there is one hatching, not two.
///
/// ```
/// use npr_hatch::mapping::hatch_octave;
/// let [before, at, after] = [2.3, 2.5, 2.7].map(|octave| hatch_octave(octave).share);
/// assert_eq!((before, at, after), (0.0, 0.5, 1.0));
/// ```
pub fn hatch_octave(octave: f64) -> HatchStep {
    let whole = octave.floor();
    HatchStep { first: whole as i32, share: ((octave - whole - 0.5) * 4.0 + 0.5).clamp(0.0, 1.0) }
}

/// Where a place of a plane is in the map of a turn: turned back, so that the map's strokes run in the turn's direction.
pub fn hatch_turned(place: DVec2, turn: i32) -> DVec2 {
    let angle = f64::from(turn) * (PI / f64::from(HATCH_TURNS));
    // The sine as a cosine, so that a quarter turn is one exactly on every machine.
    let (sin, cos) = ((angle - FRAC_PI_2).cos(), angle.cos());
    DVec2::new(cos * place.x + sin * place.y, cos * place.y - sin * place.x)
}

/// What a hatching's place in the map is moved by, so that no two of them show the same texels: by its number.
pub fn hatch_moved(number: i32) -> DVec2 {
    // Multiples of the plastic number's reciprocal and its square, which stay apart from each other best in two
    // dimensions (M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
    (DVec2::new(0.754_877_666_246_692_8, 0.569_840_290_998_053_3) * f64::from(number)).fract_gl()
}

/// The tone of a hatching that counts for a share of a place, so that the product of all has the tone: 0..=1 both.
pub fn hatch_share(tone: f64, share: f64) -> f64 {
    if share < 1.0 { tone.max(1e-6).powf(share) } else { tone }
}

//! Models far from the origin.
//!
//! f32 has 24 significant bits. Positions at a large distance from the origin would spend most of them on the distance,
//! so an offset is subtracted in f64 before positions become f32, and the object that places the mesh carries it.

#[cfg(any(feature = "obj", feature = "ply", feature = "stl"))]
mod written;

#[cfg(any(feature = "obj", feature = "ply", feature = "stl"))]
pub use written::Written;

use glam::DVec3;

/// Models are far from the origin where their centre is at least so many times their diagonal away.
const DIAGONALS: f64 = 4.0;

/// Digits count as lost where a model has fewer steps along its diagonal. A larger picture than of so many pixels would
/// show them.
const LEAST_STEPS: f64 = 65_536.0;

/// The offset to subtract from positions within a box, if they are far from the origin: the centre, rounded to f32.
pub fn offset(low: DVec3, high: DVec3) -> Option<DVec3> {
    let middle = low.midpoint(high).as_vec3();
    let diagonal = (high - low).length();
    let is_far = middle.is_finite()
        && diagonal.is_finite()
        && middle != glam::Vec3::ZERO
        && middle.as_dvec3().length() >= DIAGONALS * diagonal;
    is_far.then(|| middle.as_dvec3())
}

/// The box around positions; `None` without any.
#[cfg(any(feature = "obj", feature = "ply", feature = "stl"))]
pub fn bounds(positions: impl Iterator<Item = DVec3>) -> Option<(DVec3, DVec3)> {
    positions
        .fold(None, |bounds, p| Some(bounds.map_or((p, p), |(low, high): (DVec3, DVec3)| (low.min(p), high.max(p)))))
}

/// A warning about positions within a box that were stored as f32 before they were read.
pub fn lost_digits(low: DVec3, high: DVec3) -> Option<String> {
    let step = (0..3).map(|axis| ulp(low[axis].abs().max(high[axis].abs()))).fold(0.0, f64::max);
    warning(low, high, step)
}

fn warning(low: DVec3, high: DVec3, step: f64) -> Option<String> {
    offset(low, high)?;
    let diagonal = (high - low).length();
    let lost = step > 0.0 && diagonal > 0.0 && diagonal < LEAST_STEPS * step;
    let distance = low.midpoint(high).length();
    lost.then(|| {
        format!(
            "positions are {distance:.1e} units from the origin and stored with a step of {step} units: digits are lost"
        )
    })
}

/// The distance of two neighbouring f32 at a number.
fn ulp(number: f64) -> f64 {
    let number = number as f32;
    if number.is_finite() { f64::from(number.next_up()) - f64::from(number) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn the_offset_of_what_is_far() {
        let at = |x: f64, size: f64| offset(dvec3(x, 0.0, 0.0), dvec3(x + size, 0.0, 0.0));
        assert_eq!(at(0.0, 1.0), None);
        assert_eq!(at(3.0, 1.0), None);
        assert_eq!(at(3.5, 1.0), Some(dvec3(4.0, 0.0, 0.0)));
        assert_eq!(at(-4.5, 1.0), Some(dvec3(-4.0, 0.0, 0.0)));
        assert_eq!(at(5e6, 0.0), Some(dvec3(5e6, 0.0, 0.0)));
        assert_eq!(at(0.0, 0.0), None);
        assert_eq!(at(f64::MAX, 1.0), None);
        assert_eq!(at(f64::NAN, 1.0), None);
    }
}

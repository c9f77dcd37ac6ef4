//! Models far from the origin.
//!
//! f32 has 24 significant bits. Positions at a large distance from the origin would spend most of them on the distance,
//! so an offset is subtracted in f64 before positions become f32, and the object that places the mesh carries it.

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

/// Finds out whether decimal numbers are written from f32.
#[derive(Clone, Copy)]
pub struct Written {
    low: DVec3,
    high: DVec3,
    /// Per axis: whether all numbers are f32, and the value of the last binary digit of any of them.
    is_f32: [bool; 3],
    finest: DVec3,
}

impl Default for Written {
    fn default() -> Self {
        Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY, is_f32: [true; 3], finest: DVec3::INFINITY }
    }
}

impl Written {
    pub fn add(&mut self, position: DVec3) {
        (self.low, self.high) = (self.low.min(position), self.high.max(position));
        for axis in 0..3 {
            let number = position[axis];
            self.is_f32[axis] &= f64::from(number as f32) == number;
            self.finest[axis] = self.finest[axis].min(last_digit(number));
        }
    }

    /// A warning where along an axis all numbers are f32 and use its last digit, as exact numbers rarely do.
    pub fn lost_digits(&self) -> Option<String> {
        let largest = self.low.abs().max(self.high.abs());
        let step = (0..3)
            .filter(|&axis| self.is_f32[axis] && self.finest[axis] <= ulp(largest[axis]))
            .map(|axis| ulp(largest[axis]))
            // Of whole numbers it cannot be told.
            .filter(|step| *step != 1.0)
            .fold(0.0, f64::max);
        warning(self.low, self.high, step)
    }
}

/// The value of the last binary digit that is not 0; infinite for 0 and for what is not finite.
fn last_digit(number: f64) -> f64 {
    if number == 0.0 || !number.is_finite() {
        return f64::INFINITY;
    }
    let bits = number.abs().to_bits();
    let (exponent, fraction) = ((bits >> 52) as i32, bits & ((1 << 52) - 1));
    let (exponent, digits) = if exponent == 0 { (1, fraction) } else { (exponent, fraction | 1 << 52) };
    2f64.powi(exponent - 1075 + digits.trailing_zeros() as i32)
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

    #[test]
    fn last_digits() {
        for (number, digit) in
            [(1.0, 1.0), (-3.0, 1.0), (0.5, 0.5), (12.0, 4.0), (f64::MIN_POSITIVE / 4.0, f64::MIN_POSITIVE / 4.0)]
        {
            assert_eq!(last_digit(number), digit, "{number}");
        }
    }

    #[test]
    fn numbers_written_from_f32_are_told_from_decimal_ones() {
        let written = |numbers: &[f64]| {
            let mut written = Written::default();
            numbers.iter().for_each(|&number| written.add(dvec3(0.0, number, 0.0)));
            written.lost_digits()
        };
        let warning = written(&[5_400_000.0, 5_400_003.5, 5_400_020.0]).expect("digits are lost");
        assert!(warning.contains("5.4e6 units") && warning.contains("a step of 0.5 units"), "{warning}");
        assert_eq!(written(&[5_400_000.1, 5_400_003.5, 5_400_020.0]), None, "a number that is no f32");
        assert_eq!(written(&[5_400_000.0, 5_400_003.0, 5_400_020.0]), None, "whole numbers need no more digits");
        assert_eq!(written(&[1e7, 1e7 + 1.0, 1e7 + 3.0]), None, "whole numbers");
        assert_eq!(written(&[0.1f32.into(), 0.25]), None, "near the origin");
    }
}

//! Finds out whether decimal numbers are written from f32.

use super::{ulp, warning};
use glam::DVec3;

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

//! Seeded inputs, including difficult ones.

use glam::{Vec3, Vec4};
use std::cell::Cell;

/// SplitMix64, which gives the same numbers on every platform.
pub struct Random(Cell<u64>);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(Cell::new(seed))
    }

    fn next(&self) -> u64 {
        let state = self.0.get().wrapping_add(0x9e37_79b9_7f4a_7c15);
        self.0.set(state);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// 0..1, in steps of 2^-24.
    pub fn unit(&self) -> f32 {
        (self.next() >> 40) as f32 / 16_777_216.0
    }

    pub fn range(&self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// Log-uniform between two positive numbers.
    pub fn log_range(&self, low: f32, high: f32) -> f32 {
        self.range(low.ln(), high.ln()).exp()
    }

    pub fn below(&self, count: u32) -> u32 {
        (self.next() % u64::from(count)) as u32
    }

    pub fn pick<T: Copy>(&self, of: &[T]) -> T {
        of[self.below(of.len() as u32) as usize]
    }

    /// True with a probability of about 1 / `count`.
    pub fn one_in(&self, count: u32) -> bool {
        self.below(count) == 0
    }

    /// Components in 0..=1, or outside by up to 1.
    pub fn color(&self) -> Vec3 {
        let high = self.pick(&[1.0, 1.0, 2.0]);
        Vec3::new(self.range(0.0, high), self.range(0.0, high), self.range(0.0, high))
    }

    /// A unit vector, up to rounding.
    pub fn direction(&self) -> Vec3 {
        loop {
            let v = Vec3::new(self.range(-1.0, 1.0), self.range(-1.0, 1.0), self.range(-1.0, 1.0));
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    /// A vector for a function that normalises: any direction and length, or none.
    ///
    /// Lengths stay within 1e-14..1e18, as f32 has no squares of others (`toon_unit` and `gooch_unit` return
    /// what is shorter than 1e-15 too short, and zero for what is longer than 1e19; f64 normalises these).
    pub fn vector(&self) -> Vec3 {
        let direction = self.direction();
        match self.below(12) {
            0 => Vec3::ZERO,
            1 => self.pick(&[Vec3::X, Vec3::NEG_Y, Vec3::Z]),
            2 => direction * self.log_range(1e-14, 1e-3),
            3 => direction * self.log_range(1e3, 1e18),
            _ => direction * self.range(0.3, 2.0),
        }
    }

    /// A vector in a special relation to another: equal, opposite, of another length, nearly so, or perpendicular.
    pub fn beside(&self, other: Vec3) -> Vec3 {
        let away = self.direction() * other.length();
        match self.below(12) {
            0 => other,
            1 => -other,
            2 => other * self.range(0.5, 3.0),
            3 => -other * self.range(0.5, 3.0),
            4 => -other + away * self.log_range(1e-6, 0.1),
            5 => other + away * self.log_range(1e-6, 0.1),
            6 => other.normalize_or_zero().cross(away),
            _ => self.vector(),
        }
    }

    /// The width of a border: zero, below the least that counts, tiny, huge, or typical.
    ///
    /// Up to 1000: from 20,000 on, a border at 10,000, which means "none" in the uniforms, would be within the width.
    pub fn width(&self) -> f32 {
        match self.below(8) {
            0 => 0.0,
            1 => self.pick(&[f32::EPSILON, f32::EPSILON.next_up(), f32::EPSILON.next_down(), f32::MIN_POSITIVE]),
            2 => self.log_range(1e-12, 1e-4),
            3 => self.log_range(1.0, 1e3),
            _ => self.log_range(1e-4, 1.0),
        }
    }

    /// A number that may equal one of `places`, be a rounding error away, or within a width of it.
    ///
    /// 0 itself, but nothing else within 1e-22 of it: what is smaller is less than 1e-30 from its neighbours, which the
    /// hard `toon_coverage` takes for equal, and in the end a denormal number, which a device may take for 0.
    pub fn near(&self, places: &[f32], width: f32) -> f32 {
        let x = self.anywhere_near(places, width);
        if x == 0.0 { x } else { x.abs().max(1e-22).copysign(x) }
    }

    fn anywhere_near(&self, places: &[f32], width: f32) -> f32 {
        if places.is_empty() || self.one_in(3) {
            return self.range(-1.2, 1.2);
        }
        let place = self.pick(places);
        match self.below(6) {
            0 => place,
            1 => place.next_up(),
            2 => place.next_down(),
            3 => place + self.range(-1e-5, 1e-5),
            _ => place + width * self.range(-0.7, 0.7),
        }
    }
}

/// A vector with a fourth component.
pub fn with(v: Vec3, w: f32) -> Vec4 {
    v.extend(w)
}

//! Normals in five formats, and the octahedral codes that filters compare as integers.
//!
//! The octahedral formats unfold the octahedron |x| + |y| + |z| = 1 into a square (Meyer, Süßmuth, Sußner, Stamminger &
//! Greiner 2010, "On Floating-Point Normal Vectors") and store two integers −m..=m, rounded to the nearest, as
//! integer + m + 1. 0 is represented exactly, which `_bx2` cannot, and the unused code (0, 0) stands for no normal.
//!
//! The largest and the mean angle between a normal and the decoded one, over 100,000 directions (`tests/format.rs`):
//! bytes 0.38° and 0.17°, octahedral 2 × 5 bits 7.9° and 2.8°, 2 × 8 0.92° and 0.34°, 2 × 16 0.0036° and 0.0013°,
//! half floats 0.022° and 0.006°.
//!
//! Decoded to integers ([`ink_oct_vector`]) a code is a vector of integers with |x| + |y| + |z| = m in the direction of
//! the normal. Dot products of such vectors are exact on every machine, which is what the filters use.

use crate::format::half::{ink_half_decode, ink_half_encode};
use crate::format::ink_is_surface;
use glam::{IVec2, IVec3, UVec2, Vec2, Vec3};

/// How a normal is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NormalFormat {
    /// Three channels of 8 bits, (n + 1) / 2, as printed.
    Biased8,
    /// Octahedral, two numbers of 5 bits: that of [`crate::format::texel::TexelLayout::Bits32`].
    Oct5,
    /// Octahedral, two numbers of 8 bits.
    Oct8,
    /// Octahedral, two numbers of 16 bits.
    Oct16,
    /// Three half floats.
    Half,
}

/// m, the largest octahedral integer of a number of `bits`.
pub const fn oct_max(bits: u32) -> i32 {
    (1 << (bits - 1)) - 1
}

/// The octahedral code of a direction of any length as two unsigned numbers, 1..=2 `most` + 1; (0, 0) where the vector
/// has no direction: zero or not finite.
pub fn ink_oct_encode(normal: Vec3, most: i32) -> UVec2 {
    let sum = normal.x.abs() + normal.y.abs() + normal.z.abs();
    if !ink_is_surface(sum) {
        return UVec2::ZERO;
    }
    let mut flat = Vec2::new(normal.x / sum, normal.y / sum);
    if normal.z < 0.0 {
        let folded = Vec2::new(1.0 - flat.y.abs(), 1.0 - flat.x.abs());
        flat =
            Vec2::new(if flat.x < 0.0 { -folded.x } else { folded.x }, if flat.y < 0.0 { -folded.y } else { folded.y });
    }
    ((flat * most as f32 + 0.5).floor().as_ivec2() + most + 1).as_uvec2()
}

/// The direction of an octahedral code as integers with |x| + |y| + |z| = `most`.
pub fn ink_oct_vector(code: IVec2, most: i32) -> IVec3 {
    let z = most - code.x.abs() - code.y.abs();
    if z >= 0 {
        return code.extend(z);
    }
    let folded = IVec2::new(most - code.y.abs(), most - code.x.abs());
    IVec3::new(if code.x < 0 { -folded.x } else { folded.x }, if code.y < 0 { -folded.y } else { folded.y }, z)
}

/// The reverse of [`ink_oct_encode`]: the vector of integers of [`ink_oct_vector`], zero for (0, 0).
pub fn ink_oct_load(stored: UVec2, most: i32) -> IVec3 {
    if stored.x == 0 { IVec3::ZERO } else { ink_oct_vector(stored.as_ivec2() - most - 1, most) }
}

/// The reverse of [`ink_oct_encode`]: a unit vector, zero for (0, 0).
pub fn ink_oct_decode(stored: UVec2, most: i32) -> Vec3 {
    ink_oct_load(stored, most).as_dvec3().normalize_or_zero().as_vec3()
}

impl NormalFormat {
    /// All formats.
    pub const ALL: [Self; 5] = [Self::Biased8, Self::Oct5, Self::Oct8, Self::Oct16, Self::Half];

    /// Bits of a normal.
    pub fn bits(self) -> u32 {
        match self {
            Self::Biased8 => 24,
            Self::Oct5 => 10,
            Self::Oct8 => 16,
            Self::Oct16 => 32,
            Self::Half => 48,
        }
    }

    /// A unit normal, or a vector that is no normal, as a code in the lowest [`NormalFormat::bits`].
    pub fn encode(self, normal: Vec3) -> u64 {
        let oct = |bits: u32| {
            let stored = ink_oct_encode(normal, oct_max(bits));
            u64::from(stored.x) | u64::from(stored.y) << bits
        };
        match self {
            Self::Biased8 => {
                let [x, y, z, _] = super::printed::ink_printed_encode(normal, 0.0);
                u64::from(u32::from_le_bytes([x, y, z, 0]))
            }
            Self::Oct5 => oct(5),
            Self::Oct8 => oct(8),
            Self::Oct16 => oct(16),
            Self::Half => {
                let halves = normal.to_array().map(|v| u64::from(ink_half_encode(v)));
                halves[0] | halves[1] << 16 | halves[2] << 32
            }
        }
    }

    /// The normal of a code: unit length in the octahedral formats, to the format's precision in the others.
    /// A vector that is no normal is decoded to zero in the octahedral formats, to (−1, −1, −1) in bytes, and unchanged
    /// in half floats.
    pub fn decode(self, code: u64) -> Vec3 {
        let oct = |bits: u32| {
            let mask = (1 << bits) - 1;
            let stored = UVec2::new((code & mask) as u32, (code >> bits & mask) as u32);
            ink_oct_decode(stored, oct_max(bits))
        };
        let half = |shift: u32| ink_half_decode((code >> shift) as u16);
        match self {
            Self::Biased8 => super::printed::ink_printed_decode((code as u32).to_le_bytes()).0,
            Self::Oct5 => oct(5),
            Self::Oct8 => oct(8),
            Self::Oct16 => oct(16),
            Self::Half => Vec3::new(half(0), half(16), half(32)),
        }
    }
}

//! What the passes are tried on.

use glam::{IVec2, UVec2, Vec3};
use npr_imagespace::picture::Taps;
use std::f32::consts::TAU;

/// Free steps of a filter, longer than a pixel.
pub const LONG: Taps = Taps::Steps([IVec2::new(3, 1), IVec2::new(-1, 2)]);

/// Width and height: single pixels, rows and columns, odd ones, and such that fill words of 4 and 32 px and do not.
pub const SIZES: [[u32; 2]; 9] = [[1, 1], [1, 9], [70, 1], [2, 2], [3, 5], [33, 7], [64, 20], [7, 40], [61, 37]];

/// As the library has sizes.
pub fn px([width, height]: [u32; 2]) -> UVec2 {
    UVec2::new(width, height)
}

/// Numbers from a seed (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 32) as u32
    }

    pub fn below(&mut self, end: u32) -> u32 {
        ((u64::from(self.bits()) * u64::from(end)) >> 32) as u32
    }

    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * (self.bits() >> 8) as f32 / 16_777_216.0
    }

    pub fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len() as u32) as usize]
    }
}

/// Ink pictures of a size: empty, full, a pixel in each corner, shades, specks few and many, lines.
pub fn inks(size: [u32; 2], random: &mut Random) -> Vec<Vec<u8>> {
    let [width, height] = size;
    let len = (width * height) as usize;
    let mut corners = vec![0; len];
    for y in [0, height - 1] {
        for x in [0, width - 1] {
            corners[(y * width + x) as usize] = 255;
        }
    }
    let mut rare = |one_in: u32| (0..len).map(|_| if random.below(one_in) == 0 { 255 } else { 0 }).collect();
    let mut all = vec![vec![0; len], vec![255; len], corners, rare(2), rare(9), rare(90), rare(900)];
    all.push(all[4].iter().map(|ink: &u8| !ink).collect());
    // Just a line and just none, among all others.
    all.push((0..len).map(|_| random.one_of(&[126, 127, 128, 129])).collect());
    all.push((0..len).map(|_| random.bits() as u8).collect());
    all.push((0..height).flat_map(|y| (0..width).map(move |x| u8::from((x * 3 + y * 7) % 41 == 0) * 255)).collect());
    all
}

/// What a pixel of a scene shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// In eye space, x to the right, y up, z towards the eye; of unit length.
    pub normal: Vec3,
    /// Eye-space, above 0.
    pub depth: f32,
    /// Above 0.
    pub region: u32,
}

/// A ground plane that recedes, spheres on it that cut into one another, and sky.
pub fn scene([width, height]: [u32; 2]) -> Vec<Option<Surface>> {
    let spheres = [
        (Vec3::new(-0.6, -0.2, -4.0), 0.8, 2),
        (Vec3::new(0.3, -0.4, -3.6), 0.6, 3),
        (Vec3::new(0.9, 0.3, -6.0), 1.1, 2),
        (Vec3::new(0.0, 0.8, -9.0), 0.5, 70_000),
    ];
    let mut pixels = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let at = |i: u32, size: u32| 2.0 * (i as f32 + 0.5) / size as f32 - 1.0;
            let ray = Vec3::new(0.7 * at(x, width), -0.5 * at(y, height), -1.0);
            let mut nearest: Option<Surface> = None;
            let mut hit = |surface: Surface| {
                if surface.depth > 0.0 && nearest.is_none_or(|other| surface.depth < other.depth) {
                    nearest = Some(surface);
                }
            };
            // A plane 1 below the eye, to a depth of 40.
            if ray.y < -1.0 / 40.0 {
                hit(Surface { normal: Vec3::Y, depth: -1.0 / ray.y, region: 1 });
            }
            for (centre, radius, region) in spheres {
                let (a, b) = (ray.length_squared(), ray.dot(centre));
                let square = b * b - a * (centre.length_squared() - radius * radius);
                if square > 0.0 {
                    let depth = (b - square.sqrt()) / a;
                    let point = ray * depth;
                    // Patches, as artists paint them.
                    let patch = ((point - centre).x * 9.0).floor() as i32 & 1;
                    let region = region + 10 * patch as u32;
                    hit(Surface { normal: (point - centre).normalize(), depth, region });
                }
            }
            pixels.push(nearest);
        }
    }
    pixels
}

/// A uniformly distributed direction.
pub fn direction(random: &mut Random) -> Vec3 {
    let z = random.between(-1.0, 1.0);
    let (sin, cos) = (TAU * random.between(0.0, 1.0)).sin_cos();
    let off = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(off * cos, off * sin, z)
}

//! Mip-mapped textures, and their sampling, which both executors define alike.
//!
//! Filtering and mip levels are in linear light. The mip level is computed explicitly, because the precision of the
//! hardware's formula is not specified: log2 of the longer of the two footprint axes in texels.

use crate::color::{decode_srgb, encode_srgb, to_byte};
use glam::{DVec2, DVec4};
use npr_mesh::{Texture, Wrap};
use std::sync::LazyLock;

static DECODED: LazyLock<[f64; 256]> = LazyLock::new(|| std::array::from_fn(|byte| decode_srgb(byte as f64 / 255.0)));

/// An image and its mip levels.
#[derive(Clone, Debug)]
pub struct MipMapped {
    /// From the largest to 1×1: width, height, and rows of sRGB-encoded RGB with linear alpha.
    pub levels: Vec<(u32, u32, Vec<u8>)>,
    wrap: [Wrap; 2],
    smooth: bool,
}

impl MipMapped {
    /// Halves the image until one texel is left. Each texel of a level is the mean, in linear light, of those that it
    /// covers. At odd sizes, texels that two texels share contribute by area.
    pub fn new(texture: &Texture) -> Self {
        let mut levels = vec![(texture.width, texture.height, texture.rgba8.to_vec())];
        // The largest level is decoded on access, because it would take eight times as many bytes in f64.
        let decoded = |at: usize| {
            let texel = &texture.rgba8[4 * at..4 * at + 4];
            let d = |i: usize| DECODED[usize::from(texel[i])];
            DVec4::new(d(0), d(1), d(2), f64::from(texel[3]) / 255.0)
        };
        let mut linear: Option<Vec<DVec4>> = None;
        let (mut width, mut height) = (texture.width, texture.height);
        while width > 1 || height > 1 {
            let next = match &linear {
                None => halved(width, height, decoded),
                Some(linear) => halved(width, height, |at| linear[at]),
            };
            (width, height) = ((width / 2).max(1), (height / 2).max(1));
            let bytes =
                next.iter().flat_map(|t| [encode_srgb(t.x), encode_srgb(t.y), encode_srgb(t.z), t.w].map(to_byte));
            levels.push((width, height, bytes.collect()));
            linear = Some(next);
        }
        Self { levels, wrap: texture.wrap, smooth: texture.smooth }
    }

    /// The mip level for a footprint, given by the derivatives of uv along x and y, per px.
    pub fn level(&self, uv_dx: DVec2, uv_dy: DVec2) -> f64 {
        let size = DVec2::new(f64::from(self.levels[0].0), f64::from(self.levels[0].1));
        let longest = (uv_dx * size).length_squared().max((uv_dy * size).length_squared());
        (0.5 * longest.max(1e-30).log2()).clamp(0.0, (self.levels.len() - 1) as f64)
    }

    /// Linear RGBA at texture coordinates and a level, interpolated within and between levels.
    pub fn sample(&self, uv: DVec2, level: f64) -> DVec4 {
        if level <= 0.0 {
            return if self.smooth { self.bilinear(0, uv) } else { self.nearest(uv) };
        }
        let lower = level.floor().min((self.levels.len() - 1) as f64);
        let upper = (lower as usize + 1).min(self.levels.len() - 1);
        let fraction = level - lower;
        self.bilinear(lower as usize, uv) * (1.0 - fraction) + self.bilinear(upper, uv) * fraction
    }

    fn nearest(&self, uv: DVec2) -> DVec4 {
        let (width, height, _) = &self.levels[0];
        self.texel(0, (uv.x * f64::from(*width)).floor(), (uv.y * f64::from(*height)).floor())
    }

    /// The sRGB bytes of the nearest texel of the largest level.
    pub(crate) fn nearest_bytes(&self, uv: DVec2) -> [u8; 3] {
        let (width, height, texels) = &self.levels[0];
        let (x, y) = ((uv.x * f64::from(*width)).floor(), (uv.y * f64::from(*height)).floor());
        let (x, y) = (wrapped(x, *width, self.wrap[0]), wrapped(y, *height, self.wrap[1]));
        let at = 4 * (y as usize * *width as usize + x as usize);
        [texels[at], texels[at + 1], texels[at + 2]]
    }

    fn bilinear(&self, level: usize, uv: DVec2) -> DVec4 {
        let (width, height, _) = &self.levels[level];
        let place = uv * DVec2::new(f64::from(*width), f64::from(*height)) - 0.5;
        let corner = place.floor();
        let f = place - corner;
        let row = |y: f64| self.texel(level, corner.x, y) * (1.0 - f.x) + self.texel(level, corner.x + 1.0, y) * f.x;
        row(corner.y) * (1.0 - f.y) + row(corner.y + 1.0) * f.y
    }

    fn texel(&self, level: usize, x: f64, y: f64) -> DVec4 {
        let (width, height, texels) = &self.levels[level];
        let (x, y) = (wrapped(x, *width, self.wrap[0]), wrapped(y, *height, self.wrap[1]));
        let at = 4 * (y as usize * *width as usize + x as usize);
        let d = |i: usize| DECODED[usize::from(texels[at + i])];
        DVec4::new(d(0), d(1), d(2), f64::from(texels[at + 3]) / 255.0)
    }
}

/// Computes the next level of one of this size.
fn halved(width: u32, height: u32, texel: impl Fn(usize) -> DVec4) -> Vec<DVec4> {
    let (next_width, next_height) = ((width / 2).max(1), (height / 2).max(1));
    let (columns, rows) = (covered(width, next_width), covered(height, next_height));
    let mut next = Vec::with_capacity(next_width as usize * next_height as usize);
    for row in &rows {
        for column in &columns {
            let mut sum = DVec4::ZERO;
            for &(y, in_row) in row {
                for &(x, in_column) in column {
                    sum += texel(y as usize * width as usize + x as usize) * (in_row * in_column);
                }
            }
            next.push(sum);
        }
    }
    next
}

/// For each texel of a level: the texels of the larger level that it covers, with their weights.
fn covered(larger: u32, smaller: u32) -> Vec<Vec<(u32, f64)>> {
    let scale = f64::from(larger) / f64::from(smaller);
    (0..smaller)
        .map(|i| {
            let (from, to) = (f64::from(i) * scale, f64::from(i + 1) * scale);
            (from as u32..(to.ceil() as u32).min(larger))
                .map(|texel| {
                    let share = (f64::from(texel) + 1.0).min(to) - f64::from(texel).max(from);
                    (texel, share / scale)
                })
                .collect()
        })
        .collect()
}

/// The index of a texel within 0..size, from one anywhere.
pub(crate) fn wrapped(texel: f64, size: u32, wrap: Wrap) -> u32 {
    let size_f = f64::from(size);
    // A coordinate that is not finite reads the first texel.
    let texel = if texel.is_finite() { texel } else { 0.0 };
    let index = match wrap {
        Wrap::Repeat => texel.rem_euclid(size_f),
        Wrap::Clamp => texel.clamp(0.0, size_f - 1.0),
        Wrap::Mirror => {
            let folded = texel.rem_euclid(2.0 * size_f);
            if folded < size_f { folded } else { 2.0 * size_f - 1.0 - folded }
        }
    };
    (index as u32).min(size - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(width: u32, height: u32, rgba8: Vec<u8>) -> Texture {
        Texture {
            name: String::new(),
            width,
            height,
            rgba8: rgba8.into(),
            wrap: [Wrap::Repeat, Wrap::Mirror],
            smooth: true,
        }
    }

    #[test]
    fn halving_ends_at_one_texel_whatever_the_size() {
        let levels = MipMapped::new(&texture(5, 3, vec![200; 60])).levels;
        assert_eq!(levels.iter().map(|l| (l.0, l.1)).collect::<Vec<_>>(), [(5, 3), (2, 1), (1, 1)]);
        assert!(levels.iter().all(|l| l.2.iter().all(|&b| b == 200)));
    }

    #[test]
    fn black_and_white_average_in_linear_light() {
        let bytes = [0u8, 0, 0, 255, 255, 255, 255, 255];
        let mips = MipMapped::new(&texture(2, 1, bytes.to_vec()));
        assert_eq!(mips.levels[1].2, [188, 188, 188, 255]);
    }

    #[test]
    fn wrapping_repeats_and_mirrors() {
        assert_eq!([-1.0, 0.0, 3.0, 4.0].map(|x| wrapped(x, 4, Wrap::Repeat)), [3, 0, 3, 0]);
        assert_eq!([-1.0, 0.0, 3.0, 4.0, 8.0].map(|x| wrapped(x, 4, Wrap::Mirror)), [0, 0, 3, 3, 0]);
        assert_eq!([-1.0, 9.0].map(|x| wrapped(x, 4, Wrap::Clamp)), [0, 3]);
    }
}

//! Strokes, and the texels that they cover.

use crate::{HatchError, TamParameters};

/// The minimum drawn length of strokes in texels. Without it the coarsest levels would never become dark.
const MIN_LENGTH_PX: f32 = 2.0;

/// A stroke in a periodic map, in units of the side of the map and therefore independent of the level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// The centre, x and y in units of 2^-32 of the side. Integer arithmetic wraps like the map, and shifts by whole texels
    /// are exact.
    pub centre: [u32; 2],
    /// The direction, a unit vector.
    pub direction: [f32; 2],
    /// The length as a fraction of the side.
    pub length: f32,
    /// The sagitta, as a fraction of the length: the distance of the middle from the chord, positive to the left of the
    /// direction where y points up.
    pub bow: f32,
    /// The ink, 0..=1; 1 is black.
    pub pressure: f32,
}

/// A picture of a stroke that runs along x and is as wide as the picture is high.
#[derive(Clone, Debug, PartialEq)]
pub struct StrokeImage {
    width: u32,
    height: u32,
    /// The summed-area table (Crow 1984): `sums[y * (width + 1) + x]` is the ink above and to the left of a texel's corner.
    sums: Vec<u64>,
}

impl StrokeImage {
    /// The maximum number of texels.
    pub const MAX_TEXELS: usize = 1 << 26;

    /// A stroke from ink values row by row, 0 no ink and 65535 black.
    pub fn from_ink(width: u32, height: u32, ink: &[u16]) -> Result<Self, HatchError> {
        let texels = ink.len();
        let expected = u64::from(width) * u64::from(height);
        if expected != texels as u64 || texels == 0 || texels > Self::MAX_TEXELS {
            return Err(HatchError::Texels { width, height, texels });
        }
        // Values that round to 0 in 8 bits count as no ink.
        if ink.iter().all(|&ink| ink < 129) {
            return Err(HatchError::NoInk { width, height });
        }
        let stride = width as usize + 1;
        let mut sums = vec![0; stride * (height as usize + 1)];
        for (y, row) in ink.chunks_exact(width as usize).enumerate() {
            let mut sum = 0;
            for (x, &ink) in row.iter().enumerate() {
                sum += u64::from(ink);
                sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + sum;
            }
        }
        Ok(Self { width, height, sums })
    }

    /// The mean ink of the picture, 0..=1.
    fn mean_ink(&self) -> f64 {
        let texels = f64::from(self.width) * f64::from(self.height);
        self.sums.last().map_or(0.0, |&sum| sum as f64 / (65535.0 * texels))
    }

    /// The mean ink, 0..=1, of a box with centre (x, y) and size (w, h). The picture is the unit square, surrounded by paper.
    fn mean(&self, x: f32, y: f32, w: f32, h: f32) -> f32 {
        let (columns, rows) = (f64::from(self.width), f64::from(self.height));
        let end =
            |at: f32, size: f32, side: f32, count: f64| (f64::from(at + side * size * 0.5) * count).clamp(0.0, count);
        let (x0, x1) = (end(x, w, -1.0, columns), end(x, w, 1.0, columns));
        let (y0, y1) = (end(y, h, -1.0, rows), end(y, h, 1.0, rows));
        let ink = self.sum(x1, y1) - self.sum(x0, y1) - self.sum(x1, y0) + self.sum(x0, y0);
        let texels = f64::from(w) * columns * f64::from(h) * rows;
        ((ink / (texels * 65535.0)) as f32).clamp(0.0, 1.0)
    }

    fn sum(&self, x: f64, y: f64) -> f64 {
        let column = (x as usize).min(self.width as usize - 1);
        let row = (y as usize).min(self.height as usize - 1);
        let (fx, fy) = (x - column as f64, y - row as f64);
        let stride = self.width as usize + 1;
        let at = |row: usize| {
            let (left, right) = (self.sums[row * stride + column] as f64, self.sums[row * stride + column + 1] as f64);
            left + (right - left) * fx
        };
        let (above, below) = (at(row), at(row + 1));
        above + (below - above) * fy
    }
}

/// The properties that all strokes of a map share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pen<'a> {
    pub width_px: f32,
    is_tapered: bool,
    /// The reciprocal of the tapered fraction of a stroke.
    taper_slope: f32,
    pub image: Option<&'a StrokeImage>,
}

impl<'a> Pen<'a> {
    pub fn new(parameters: &TamParameters, image: Option<&'a StrokeImage>) -> Self {
        let TamParameters { width_px, taper, .. } = *parameters;
        Self { width_px, is_tapered: taper > 0.0, taper_slope: 1.0 / taper.max(1e-6), image }
    }

    /// The approximate mean ink in the bounding box of a stroke, 0..=1.
    pub fn mean_ink(&self) -> f64 {
        self.image.map_or(0.5, StrokeImage::mean_ink)
    }

    /// The ink, 0..=1, before pressure, at `along` (-1..=1 from start to end) and `across` (texels from the centre line).
    /// `half` is half of the stroke's length in texels.
    fn ink(&self, along: f32, across: f32, half: f32) -> f32 {
        if let Some(image) = self.image {
            let width = self.width_px;
            return image.mean(along * 0.5 + 0.5, across / width + 0.5, 0.5 / half, 1.0 / width);
        }
        let thick = if self.is_tapered {
            let t = ((2.0 + 2.0 * along).min(1.0 - along) * self.taper_slope).clamp(0.0, 1.0);
            t * (2.0 - t)
        } else {
            1.0
        };
        let half_width = 0.5 * self.width_px * thick;
        // The fraction of the texel that the stroke covers across, times the fraction along at the ends.
        let covered = (across + 0.5).min(half_width) - (across - 0.5).max(-half_width);
        covered.clamp(0.0, 1.0) * (half * (1.0 - along.abs()) + 0.5).clamp(0.0, 1.0)
    }
}

/// Replaces `covered` by the texels that a stroke covers, each once, with their ink, 1..=255, in the order of drawing; or
/// row by row if the stroke may wrap around and meet itself.
pub(crate) fn cover(stroke: &Stroke, pen: &Pen, side: u32, covered: &mut Vec<(u32, u8)>) {
    covered.clear();
    let half = (stroke.length * side as f32).max(MIN_LENGTH_PX) * 0.5;
    let per_half = 1.0 / half;
    let bow = stroke.bow * 2.0 * half;
    let [dx, dy] = stroke.direction;
    let is_steep = dy.abs() > dx.abs();
    let (x, y) = (split(stroke.centre[0], side), split(stroke.centre[1], side));
    // The outer loop runs along the axis that is closer to the stroke's direction, the inner loop across the stroke.
    let ((major, major_part), (minor, minor_part)) = if is_steep { (y, x) } else { (x, y) };
    let (main, other) = if is_steep { (dy, dx) } else { (dx, dy) };
    let half_width = 0.5 * pen.width_px + 0.71;
    let window = half_width / main.abs() + 0.25 + 2.0 * bow.abs() / half;
    let extent = half * main.abs() + (half_width + bow.abs()) * other.abs() + 1.0;
    let last = extent.ceil() as i32;
    let mask = side as i32 - 1;
    for step in -last..=last {
        // From the start of the stroke to its end.
        let i = if main < 0.0 { -step } else { step };
        let a = i as f32 + 0.5 - major_part;
        let along = (a / (main * half)).clamp(-1.0, 1.0);
        let off = bow * (1.0 / 3.0 - along * along);
        let middle = (a * other + if is_steep { -off } else { off }) / main + minor_part;
        for j in (middle - window).floor() as i32..=(middle + window).floor() as i32 {
            let b = j as f32 + 0.5 - minor_part;
            let (px, py) = if is_steep { (b, a) } else { (a, b) };
            let along = (px * dx + py * dy) * per_half;
            let across = py * dx - px * dy - bow * (1.0 / 3.0 - along * along);
            if along.abs() > 1.0 + 0.5 * per_half || across.abs() >= 0.5 * pen.width_px + 0.5 {
                continue;
            }
            let ink = pen.ink(along, across, half) * stroke.pressure;
            let ink = (ink * 255.0 + 0.5) as u8;
            if ink > 0 {
                let (p, q) = ((major + i) & mask, (minor + j) & mask);
                let (row, column) = if is_steep { (p, q) } else { (q, p) };
                covered.push(((row * side as i32 + column) as u32, ink));
            }
        }
    }
    // A stroke can cover a texel twice only if it is longer than the side.
    let bound = extent.max(half * other.abs() + bow.abs() + window) * 2.0 + 4.0;
    if bound >= side as f32 {
        covered.sort_unstable_by_key(|&(texel, ink)| (texel, 255 - ink));
        covered.dedup_by_key(|&mut (texel, _)| texel);
    }
}

/// A coordinate in texels: its integer and fractional parts.
fn split(at: u32, side: u32) -> (i32, f32) {
    let wide = u64::from(at) * u64::from(side);
    ((wide >> 32) as i32, ((wide as u32) >> 8) as f32 / (1 << 24) as f32)
}

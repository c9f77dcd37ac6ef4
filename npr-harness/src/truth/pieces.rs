//! The connected pieces of drawn lines, and the coverage that exact lines would have.

use super::lines::{TrueLines, distances_to_lines};
use glam::DVec2;

/// Pieces of fewer pixels count as short.
pub const SHORT_PX: usize = 6;
/// Samples along each axis of a pixel for coverage.
const SAMPLES: u32 = 4;

/// The connected pieces of a picture's lines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pieces {
    /// Their number.
    pub count: usize,
    /// The share of the line pixels that are in pieces of fewer than [`SHORT_PX`], 0..=1.
    pub short_share: f64,
}

/// The pieces of pixels at least half as dark as full ink that touch at a side or a corner.
///
/// - `darkness`: per pixel, in rows, 0..=1.
///
/// # Panics
/// If `darkness` does not have a value for each pixel.
pub fn pieces(darkness: &[f64], (width, height): (u32, u32)) -> Pieces {
    let (width, height) = (width as usize, height as usize);
    assert_eq!(darkness.len(), width * height);
    let mut waiting: Vec<bool> = darkness.iter().map(|&dark| dark >= 0.5).collect();
    let (mut count, mut short, mut all) = (0, 0, 0);
    let mut stack = Vec::new();
    for start in 0..waiting.len() {
        if !std::mem::take(&mut waiting[start]) {
            continue;
        }
        stack.push(start);
        let mut pixels = 0;
        while let Some(at) = stack.pop() {
            pixels += 1;
            let (x, y) = (at % width, at / width);
            for y in y.saturating_sub(1)..(y + 2).min(height) {
                for x in x.saturating_sub(1)..(x + 2).min(width) {
                    if std::mem::take(&mut waiting[y * width + x]) {
                        stack.push(y * width + x);
                    }
                }
            }
        }
        count += 1;
        all += pixels;
        short += if pixels < SHORT_PX { pixels } else { 0 };
    }
    Pieces { count, short_share: short as f64 / (all as f64).max(1.0) }
}

/// The coverage of each pixel, in rows, by true lines drawn with a width, 0..=1.
pub fn coverage(lines: &TrueLines, width_px: f64) -> Vec<f64> {
    let (width, height) = lines.size_px;
    let centre = |at: u32| DVec2::new(f64::from(at % width) + 0.5, f64::from(at / width) + 0.5);
    let centres: Vec<DVec2> = (0..width * height).map(centre).collect();
    // Half a pixel's diagonal.
    let reach = width_px / 2.0 + std::f64::consts::FRAC_1_SQRT_2;
    let near = distances_to_lines(lines, &centres, reach);
    let mut points = Vec::new();
    let cells: Vec<usize> = (0..centres.len()).filter(|&at| near[at].is_finite()).collect();
    for &at in &cells {
        let sample = |number: u32| (f64::from(number) + 0.5) / f64::from(SAMPLES) - 0.5;
        points
            .extend((0..SAMPLES * SAMPLES).map(|i| centres[at] + DVec2::new(sample(i % SAMPLES), sample(i / SAMPLES))));
    }
    let distances = distances_to_lines(lines, &points, reach);
    let mut covered = vec![0.0; centres.len()];
    for (&at, samples) in cells.iter().zip(distances.chunks((SAMPLES * SAMPLES) as usize)) {
        let inside = samples.iter().filter(|&&distance| distance <= width_px / 2.0).count();
        covered[at] = inside as f64 / f64::from(SAMPLES * SAMPLES);
    }
    covered
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::lines::{NO_EDGE, TrueSegment};
    use npr_outline::LineKind;

    fn line(ends_px: [DVec2; 2]) -> TrueLines {
        let segment = TrueSegment { ends_px, kind: LineKind::Crease, edge: NO_EDGE };
        TrueLines { segments: vec![segment], size_px: (32, 16) }
    }

    #[test]
    fn a_line_covers_its_length_times_its_width() {
        let covered = coverage(&line([DVec2::new(4.0, 8.2), DVec2::new(28.0, 8.2)]), 3.0);
        // Round ends.
        let area = 24.0 * 3.0 + std::f64::consts::PI * 2.25;
        assert!((covered.iter().sum::<f64>() / area - 1.0).abs() < 0.05);
        assert_eq!(covered[8 * 32 + 16], 1.0);
    }

    #[test]
    fn pieces_touch_at_corners_and_short_ones_are_told() {
        let mut darkness = vec![0.0; 16 * 8];
        // A diagonal of 6, and a pair.
        (0..6).for_each(|i| darkness[i * 16 + i] = 1.0);
        darkness[2 * 16 + 12] = 0.5;
        darkness[2 * 16 + 13] = 0.9;
        darkness[7 * 16 + 15] = 0.49;
        let found = pieces(&darkness, (16, 8));
        assert_eq!(found.count, 2);
        assert_eq!(found.short_share, 2.0 / 8.0);
    }
}
